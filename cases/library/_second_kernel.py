"""A second kernel of stacks and graded layers, by Airy's stress functions in one global linear system.

For a wavenumber k the stress function of a layer is a sum of four exponentials in depth, with unknown amplitudes. The
conditions at surface, interfaces and base give as many equations. No code is shared with `bem.kernels`, where layers
are added one by one. With q = k z and stresses sigma_zz = -psi, sigma_xz = psi', displacements times 2 G k are

    u = (1 - nu) psi'' + nu psi,    w = (1 - nu) psi''' - (2 - nu) psi'

in a uniform layer, psi = (A + B q) exp(-q) + (C + D q) exp(q). Where G grows like exp(b z), psi = exp(m q) with
``m (m - b/k) = 1 +- i (b/k) sqrt(nu/(1 - nu))``, both displacements are divided by the growth, and so differentiated.
"""

from itertools import pairwise

import numpy as np

from contact import ElasticBase, ElasticLayer, ExponentialDepth, GradedLayer, InvalidInput, LayerStack, Sublayer
from contact.records.validation import FloatArray

# Rows of a state: shear stress, normal stress, u and w times k, shape (4, columns) for every wavenumber.
SHEAR, NORMAL, SIDEWAYS, DOWN = range(4)


def surface_compliance(layer: ElasticLayer, wavenumber: FloatArray) -> FloatArray:
    """Displacement of the surface by a unit pressure times k [1/Pa], at wavenumbers k [1/m] of shape (n,)."""
    if isinstance(layer, LayerStack):
        sheets = [_uniform(sublayer, wavenumber) for sublayer in layer.sublayers]
        slips = [face == "unbonded" for face in layer.interfaces]
    elif isinstance(layer, GradedLayer):
        sheets, slips = [_exponential(layer, wavenumber)], []
    else:
        raise InvalidInput(f"layer = {type(layer).__name__}: only stacks and graded layers have this kernel")
    base = layer.support
    if isinstance(base, ElasticBase):
        slips.append(base.interface == "unbonded")
        top, _ = _uniform(base, wavenumber)
        sheets.append((top[..., :2], np.zeros_like(top[..., :2])))
    return _solved(sheets, slips, base)


def _solved(sheets: list[tuple[FloatArray, FloatArray]], slips: list[bool], base: object) -> FloatArray:
    """k w at the surface by a unit pressure [1/Pa], shape (n,), from the equations of all faces.

    ``sheets`` has the states at the top and the bottom of each layer, ``slips`` whether each interface is unbonded.
    """
    size = sum(top.shape[-1] for top, _ in sheets)
    rows, start = [_placed(sheets[0][0][:, [SHEAR, NORMAL]], 0, size)], 0
    for (upper, lower), slip in zip(pairwise(sheets), slips, strict=True):
        above, width = upper[1], upper[1].shape[-1]
        upper_state, lower_state = _placed(above, start, size), _placed(lower[0], start + width, size)
        jump = upper_state - lower_state
        free = [jump[:, [NORMAL, DOWN]], upper_state[:, [SHEAR]], lower_state[:, [SHEAR]]]
        rows += free if slip else [jump]
        start += width
    if not isinstance(base, ElasticBase):
        vanishing = [SHEAR if base == "unbonded" else SIDEWAYS, DOWN]
        rows.append(_placed(sheets[-1][1][:, vanishing], start, size))
    matrix = np.concatenate(rows, axis=1)
    # Rows are scaled, since moduli and displacements differ by orders of magnitude.
    scale = np.abs(matrix).max(axis=2, keepdims=True)
    load = np.zeros((len(matrix), size, 1), dtype=matrix.dtype)
    load[:, 1, 0] = -1 / scale[:, 1, 0]
    amplitudes = np.linalg.solve(matrix / scale, load)[:, :, 0]
    first = sheets[0][0][:, DOWN]
    return np.asarray(np.sum(first * amplitudes[:, : first.shape[-1]], axis=1).real)


def _placed(rows: FloatArray, start: int, size: int) -> FloatArray:
    """Rows of a layer among the columns of all layers."""
    placed = np.zeros((*rows.shape[:2], size), dtype=rows.dtype)
    placed[:, :, start : start + rows.shape[-1]] = rows
    return placed


def _uniform(layer: Sublayer | ElasticBase, k: FloatArray) -> tuple[FloatArray, FloatArray]:
    """States at the top and the bottom of the four exponentials of a uniform layer, shape (n, 4, 4) each.

    The first two decay from the top, the others from the bottom; a half-space has the first two alone.
    """
    nu, G = layer.poissons_ratio, layer.youngs_modulus / (2 * (1 + layer.poissons_ratio))
    depth = k * getattr(layer, "thickness", 0.0)

    def states(q: FloatArray) -> FloatArray:
        """Displacements and tractions of the four Airy functions at depth q."""
        columns = []
        for sign, at in ((-1.0, q), (1.0, q - depth)):
            fall = np.exp(sign * at)
            for slope in (0.0, 1.0):
                # Derivatives of (1 - slope + slope q) exp(sign q), from the zeroth to the third.
                d = [((1 - slope + slope * at) * sign**n + slope * n * sign ** (n - 1)) * fall for n in range(4)]
                u, w = (1 - nu) * d[2] + nu * d[0], (1 - nu) * d[3] - (2 - nu) * d[1]
                columns.append(np.stack([d[1], -d[0], u / (2 * G), w / (2 * G)], axis=1))
        return np.stack(columns, axis=2)

    return states(np.zeros_like(k)), states(depth)


def _exponential(layer: GradedLayer, k: FloatArray) -> tuple[FloatArray, FloatArray]:
    """States of the four solutions at the top and the bottom of a layer with exponential modulus and constant nu.

    Shapes are (n, 4, 4); the first two solutions decay from the top, the others from the bottom.
    """
    modulus, nu = layer.youngs_modulus, layer.poissons_ratio
    if not isinstance(modulus, ExponentialDepth) or not isinstance(nu, float):
        raise InvalidInput("youngs_modulus: this kernel is that of an exponential modulus and a constant nu")
    G = modulus.surface / (2 * (1 + nu))
    growth = np.log(modulus.base / modulus.surface) / (layer.thickness * k)
    turn = 1j * growth * np.sqrt(nu / (1 - nu))
    roots = [
        growth / 2 + sign * np.sqrt(growth**2 / 4 + 1 + side * turn) for sign in (-1.0, 1.0) for side in (1.0, -1.0)
    ]

    def states(share: float) -> FloatArray:
        """Displacements and tractions of the four solutions at a share of the thickness."""
        q = share * k * layer.thickness
        columns = []
        for m in roots:
            fall = np.exp(m * (q - np.where(m.real > 0, k * layer.thickness, 0.0)))
            softer = fall * np.exp(-growth * q) / (2 * G)
            u = ((1 - nu) * m**2 + nu) * softer
            columns.append(np.stack([m * fall, -fall, u, (m - growth) * u - 2 * m * softer], axis=1))
        return np.stack(columns, axis=2)

    return states(0.0), states(1.0)
