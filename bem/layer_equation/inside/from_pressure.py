"""The density of a contact whose pressure is known: the half-space's own answer, and a smooth share of the layer.

Abel's transform of the pressure is ``phi(t) = (2/E*) int_t^a r p(r)/sqrt(r^2 - t^2) dr``. What it is more than that of
the half-space under the same depth, ``delta - g_hs(t)``, is even and smooth, and kinks belong to the rest: it is fitted
by a polynomial, so that the noise of a grid's pressure does not reach its slope.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.polynomial import chebyshev

from bem.kernels.moduli import contact_modulus
from bem.layer_equation.inside.density import Density, Piece
from bem.layer_equation.one_radius import DirectDensity, half_space_load
from bem.polynomials.gauss_panels import gauss_nodes
from contact import ElasticLayer, FlatPunch, Layer, Profile
from contact.records.validation import FloatArray

# Nodes of Abel's transform, and radii at which it is taken: pressures of grids have four digits.
_NODES = 48
# Orders of the share in t^2: so many, and for each thickness of the radius as many more, up to the last; chosen so that
# fits follow a share that varies over a thickness.
_ORDERS, _MORE, _MOST = 4, 2, 12


def density_of_pressure(
    layer: ElasticLayer,
    indenter: Profile,
    pressure: Callable[[FloatArray], FloatArray],
    *,
    contact_radius: float,
    depth: float,
    singular_edge: bool,
) -> tuple[Density, float]:
    """phi, lengths in the unit [m] that is returned with it.

    Args:
        layer: What is pressed.
        indenter: Profile of revolution.
        pressure: p [Pa] at radii [m] inside the contact.
        contact_radius: a [m].
        depth: delta [m].
        singular_edge: Whether the pressure is singular at the edge.
    """
    a, surface = contact_radius, layer.surface
    half = Layer.half_space(youngs_modulus=surface.youngs_modulus, poissons_ratio=surface.poissons_ratio)
    alone = DirectDensity.solve(half, indenter, a - indenter.flat_radius, 0.5, _NODES // 2).inside(
        0.0, singular_edge=False
    )
    share = _share(layer, indenter, pressure, a, depth)
    slopes = chebyshev.chebder(share)
    unit = a if layer.is_half_space else surface.thickness
    size = a / unit

    def slope(piece: Piece, offset: FloatArray) -> FloatArray:
        """phi', the same in all units."""
        t = np.minimum((piece.start + offset) / size, 1.0)
        own = alone.slope(Piece(piece.start / size, piece.length / size, piece.power), offset / size)
        return np.asarray(own + 4.0 * t * chebyshev.chebval(2.0 * t**2 - 1.0, slopes))

    pieces = tuple(Piece(one.start * size, one.length * size, one.power) for one in alone.pieces)
    edge = 0.0
    if singular_edge:
        edge = (depth - _height(indenter, np.array([a]))[0]) / unit + size * float(np.sum(share))
    return Density(size, edge, pieces, slope, min(1.0, size)), unit


def _share(
    layer: ElasticLayer, indenter: Profile, pressure: Callable[[FloatArray], FloatArray], a: float, depth: float
) -> FloatArray:
    """Chebyshev coefficients of psi/a over 2 (t/a)^2 - 1."""
    u, w = gauss_nodes(_NODES)
    # Crowded towards the edge, where the pressure ends like a root.
    t = a * np.sin(math.pi / 2.0 * u)
    angle = math.pi / 2.0 * u
    r = np.sqrt(t[:, None] ** 2 + (a**2 - t[:, None] ** 2) * np.sin(angle) ** 2)
    values = pressure(np.minimum(r, a * (1.0 - 1e-12)).ravel()).reshape(r.shape)
    phi = np.sqrt(a**2 - t**2) * ((values * np.cos(angle)) @ w) * math.pi / contact_modulus(layer)
    orders = min(_ORDERS + math.ceil(_MORE * a / layer.thickness), _MOST)
    return np.asarray(chebyshev.chebfit(2.0 * (t / a) ** 2 - 1.0, (phi - depth + _height(indenter, t)) / a, orders))


def _height(indenter: Profile, t: FloatArray) -> FloatArray:
    """g_hs [m]."""
    risen = np.zeros_like(t)
    beyond = t > indenter.flat_radius
    if not isinstance(indenter, FlatPunch) and beyond.any():
        risen[beyond] = half_space_load(indenter, t[beyond] - indenter.flat_radius)
    return risen
