"""Adhered flat punches of all radii from one factorisation, for any Poisson's ratio: what single radii are tested by.

The half-space's operator has a triangular factor C that acts on waves in closed form: with ``Hf(z) = exp(iz)
1F1(i eps; 1; -2iz)`` and ``y_0 = sqrt(pi eps/eta)``, ``C^-1 (cos kx, 0) = y_0 e_1(kx)`` and ``C^-1 (0, sin kx) = y_0
e_2(kx)`` with the even and odd parts e_1 and e_2 of Hf, complex numbers read as pairs. The layer then is

    I + B,   B(x, x') = y_0^2 (2/pi) int [D_WW e_1 e_1^T + D_UU e_2 e_2^T + D_UW (e_1 e_2^T + e_2 e_1^T)] dk,

smooth at every edge. Its Cholesky factor L serves all radii: with ``y_1 = L^-1 (y_0, 0)``,

    k_stick(a) = 4 beta E* int_0^a |y_1|^2 dx,    c_stick(a) = 2 beta E* |y_1(a)|^2.

Inside a panel the earlier panels are eliminated exactly and what is left is solved for an edge at each of its nodes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from bem.kernels.stack import StackKernel as StickingKernel
from bem.layer_equation.stick.adhered_punch import LARGEST_Q, Material, halvings
from bem.layer_equation.stick.coulomb import coulomb_functions, gamma_squared, phases
from bem.layer_equation.triangular import equation_factor, solve_lower
from bem.polynomials.gauss import halved_panels, legendre_rule
from bem.polynomials.gauss_panels import PANEL_NODES, gauss_nodes, lagrange_matrix, partial_panel_interpolation
from contact.records.validation import FloatArray

# Hf is interpolated on panels of this width with so many nodes: it turns once in 2 pi.
_WAVE_WIDTH = 2.5
_WAVE_NODES = 22


@dataclass(frozen=True)
class AdheredPunches:
    """Adhered punches of every radius up to `max_ratio` on one layer; lengths in its surface material's thickness.

    Attributes:
        material: What the layer is made of.
        edge_values: y_1 at each panel's nodes as pairs, shape (panels, nodes, 2).
    """

    material: Material
    edge_values: FloatArray

    @property
    def max_ratio(self) -> float:
        """Largest a/h."""
        return float(len(self.edge_values))

    def stiffness(self, ratio: FloatArray) -> FloatArray:
        """k_stick/(2 E* a) at 0 < a/h <= max_ratio, shape (n,)."""
        panel, within = _place(ratio)
        nodes, weights = gauss_nodes(PANEL_NODES)
        full = np.concatenate([[0.0], np.cumsum(self._square @ weights)])[panel]
        part = np.empty_like(ratio)
        for i, (p, end) in enumerate(zip(panel, within, strict=True)):
            values = lagrange_matrix(PANEL_NODES, end * nodes) @ self.edge_values[p]
            part[i] = end * (weights @ (values**2).sum(-1))
        return 2.0 * self.material.beta * (full + part) / ratio

    def spring_stiffness(self, ratio: FloatArray) -> FloatArray:
        """c_stick/E* = 2 beta |y_1|^2 at 0 <= a/h <= max_ratio, shape (n,)."""
        panel, within = _place(ratio)
        values = np.einsum("ij,ijk->ik", lagrange_matrix(PANEL_NODES, within), self.edge_values[panel])
        return np.asarray(2.0 * self.material.beta * (values**2).sum(-1))

    @property
    def _square(self) -> FloatArray:
        return np.asarray((self.edge_values**2).sum(-1))


def adhered_punches(max_ratio: float, kernel: StickingKernel) -> AdheredPunches:
    """Factorise for all radii up to `max_ratio` thicknesses, rounded up to a whole number of them."""
    material, panels = Material.of(kernel.poissons_ratio), math.ceil(max_ratio)
    nodes, weights = gauss_nodes(PANEL_NODES)
    x = (np.arange(panels)[:, None] + nodes).ravel()
    B = _layer_kernel(x, kernel, material)
    root = np.sqrt(np.repeat(np.tile(weights, panels), 2))
    own = np.array([B[s : s + 2 * PANEL_NODES, s : s + 2 * PANEL_NODES] for s in range(0, len(B), 2 * PANEL_NODES)])
    lower = equation_factor(-math.pi / 2.0 * B, root, max_ratio)
    y0 = math.sqrt(math.pi * material.charge_over_eta)
    load = np.tile([y0, 0.0], x.size)
    z = solve_lower(lower, root * load)
    values = np.empty((panels, PANEL_NODES, 2))
    for p in range(panels):
        start, stop = 2 * PANEL_NODES * p, 2 * PANEL_NODES * (p + 1)
        row = lower[start:stop, :start] / root[start:stop, None]
        # What the earlier panels leave of kernel and load.
        rest, left = own[p] - row @ row.T, load[start:stop] - row @ z[:start]
        values[p] = _edge_values(rest, left.reshape(PANEL_NODES, 2))
    return AdheredPunches(material, values)


def _edge_values(kernel: FloatArray, load: FloatArray) -> FloatArray:
    """phi(x; x) for an edge x at each node of a panel: (I + B~ w) phi = load on [X, x]."""
    tau, omega = gauss_nodes(PANEL_NODES)
    E = partial_panel_interpolation(PANEL_NODES)
    blocks = kernel.reshape(PANEL_NODES, 2, PANEL_NODES, 2)
    half = np.einsum("ijk,kalb->ijalb", E, blocks)
    full = np.einsum("ijalb,iml->ijamb", half, E)
    weights = np.multiply.outer(tau, omega)
    system = (full * weights[:, None, None, :, None]).reshape(PANEL_NODES, 2 * PANEL_NODES, 2 * PANEL_NODES)
    right = np.einsum("ijk,ka->ija", E, load).reshape(PANEL_NODES, 2 * PANEL_NODES, 1)
    phi = np.linalg.solve(np.eye(2 * PANEL_NODES) + system, right).reshape(PANEL_NODES, PANEL_NODES, 2)
    # Kernel between the edge, which is the panel's own node, and the nodes of the integral.
    to_edge = np.einsum("iakb,imk->iamb", blocks, E)
    return np.asarray(load - np.einsum("iamb,im,imb->ia", to_edge, weights, phi))


def _place(ratio: FloatArray) -> tuple[NDArray[np.intp], FloatArray]:
    """Panel of one thickness, and where in it, (0, 1]."""
    panel = np.maximum(np.ceil(ratio).astype(np.intp) - 1, 0)
    return panel, ratio - panel


def _layer_kernel(x: FloatArray, kernel: StickingKernel, material: Material) -> FloatArray:
    """B between pairs at x, shape (2 n, 2 n)."""
    width = min(1.0, 2.0 * math.pi / x[-1])
    nodes, weights = legendre_rule(PANEL_NODES)
    panels = math.ceil(LARGEST_Q / width)
    starts, widths = halved_panels(panels, halvings(width * kernel.longest))
    k = (width * (starts[:, None] + widths[:, None] * ((1.0 + nodes) / 2.0))).ravel()
    w = 2.0 * material.charge_over_eta * width / 2.0 * np.multiply.outer(widths, weights).ravel()
    waves, mirrored = half_space_waves(material.charge, np.multiply.outer(x, k))
    even, odd = _pairs((waves + mirrored) / 2.0), _pairs((waves - mirrored) / 2.0)
    extra = kernel.beyond_half_space(k)
    coupling = (even * (w * extra.uw)) @ odd.T
    B = (even * (w * extra.ww)) @ even.T + (odd * (w * extra.uu)) @ odd.T
    return np.asarray(B + coupling + coupling.T)


def _pairs(waves: NDArray[np.complex128]) -> FloatArray:
    """Complex rows as two real ones each."""
    return np.stack([waves.real, waves.imag], axis=1).reshape(-1, waves.shape[1])


def half_space_waves(charge: float, z: FloatArray) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
    """Hf(z) and Hf(-z) at z >= 0, any shape."""
    panels = math.ceil(float(z.max()) / _WAVE_WIDTH)
    table = _wave_table(charge, panels)
    panel = np.minimum((z / _WAVE_WIDTH).astype(np.intp), panels - 1)
    rows = lagrange_matrix(_WAVE_NODES, z / _WAVE_WIDTH - panel)
    both = np.einsum("...j,...js->...s", rows, table[panel])
    return both[..., 0], both[..., 1]


@lru_cache(maxsize=8)
def _wave_table(charge: float, panels: int) -> NDArray[np.complex128]:
    """Hf and its mirror image at the nodes of the panels, shape (panels, nodes, 2)."""
    nodes, _ = gauss_nodes(_WAVE_NODES)
    z = (_WAVE_WIDTH * (np.arange(panels)[:, None] + nodes)).ravel()
    return np.stack([_waves(charge, z), _waves(-charge, z).conj()], axis=-1).reshape(panels, _WAVE_NODES, 2)


def _waves(charge: float, z: FloatArray) -> NDArray[np.complex128]:
    """Sum (2n+1) i^n exp(-i th_n) a_n(eps, z)/|Gamma(1 + i eps)|; its terms vanish beyond n = z."""
    count = math.ceil(z.max() + 40 + 6.0 * np.cbrt(z.max()))
    n = np.arange(count)
    factors = (2 * n + 1) * (1j) ** (n % 4) * np.exp(-1j * phases(charge, count))
    return np.asarray(factors @ coulomb_functions(charge, z, count).values / math.sqrt(gamma_squared(charge)))
