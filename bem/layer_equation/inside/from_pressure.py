"""The density of a contact whose pressure is known: the half-space's own answer, and a smooth share of the layer.

Abel's transform of the pressure is ``phi(t) = (2/E*) int_t^a r p(r)/sqrt(r^2 - t^2) dr``. What it is more than that of
the half-space under the same depth, ``delta - g_hs(t)``, is even and smooth, and kinks belong to the rest: it is fitted
by a polynomial, so that the noise of a grid's pressure does not reach its slope.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable

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
# fits follow a share that varies over a thickness. With four fewer 5 of 885 errors on 128 cells were beyond, now 1 (60
# contacts, `campaign inside`, seed 79, 2026-11-26).
_ORDERS, _MORE, _MOST = 8, 3, 18


def density_of_pressure(
    layer: ElasticLayer,
    indenter: Profile,
    pressure: Callable[[FloatArray], FloatArray],
    *,
    contact_radius: float,
    depth: float,
    force: float,
    edge_value: float | None,
    halved: bool = False,
) -> tuple[Density, float]:
    """phi, lengths in the unit [m] that is returned with it.

    Args:
        layer: What is pressed.
        indenter: Profile of revolution.
        pressure: p [Pa] at radii [m] inside the contact.
        contact_radius: a [m].
        depth: delta [m].
        force: F_N [N], which the density is made to carry: it has more digits than the pressure.
        edge_value: phi(a) [m], zero in a smooth contact; None under a flat punch, where the pressure tells it.
        halved: Fit the layer's share with half as many orders, which tells how far it follows the pressure's noise.
    """
    a, surface = contact_radius, layer.surface
    half = Layer.half_space(youngs_modulus=surface.youngs_modulus, poissons_ratio=surface.poissons_ratio)
    alone = DirectDensity.solve(half, indenter, a - indenter.flat_radius, 0.5, _NODES // 2).inside(
        0.0, singular_edge=False
    )
    t, phi = _transformed(indenter, pressure, a, singular=edge_value != 0.0)
    psi = (2.0 / contact_modulus(layer) * phi - depth + _height(indenter, t)) / a
    end = None if edge_value is None else float(edge_value - depth + _height(indenter, np.array([a]))[0]) / a
    orders = min(_ORDERS + math.ceil(_MORE * a / layer.thickness), _MOST)
    share = _fitted(t / a, psi, end, orders // 2 if halved else orders)
    carried = a * (depth - _mean_height(indenter, a, alone.pieces) + a * _mean(share))
    lacking = (force / (2.0 * contact_modulus(layer)) - carried) / a**2
    # Where the pressure has lost some of the load is not known: a smooth share that keeps the edge carries it.
    free = np.array([1.0]) if end is None else np.array([1.0, -1.0])
    share = np.asarray(chebyshev.chebadd(share, lacking / _mean(free) * free))
    slopes = chebyshev.chebder(share)
    unit = a if layer.is_half_space else surface.thickness
    size = a / unit

    def slope(piece: Piece, offset: FloatArray) -> FloatArray:
        """phi', the same in all units."""
        t = np.minimum((piece.start + offset) / size, 1.0)
        own = alone.slope(Piece(piece.start / size, piece.length / size, piece.power), offset / size)
        return np.asarray(own + 4.0 * t * chebyshev.chebval(2.0 * t**2 - 1.0, slopes))

    pieces = tuple(Piece(one.start * size, one.length * size, one.power) for one in alone.pieces)
    edge = (depth + a * float(np.sum(share)) if edge_value is None else edge_value) / unit
    return Density(size, edge, pieces, slope, min(1.0, size)), unit


def _fitted(s: FloatArray, psi: FloatArray, end: float | None, orders: int) -> FloatArray:
    """Chebyshev coefficients of psi over 2 s^2 - 1, with a value at the end s = 1 if one is known."""
    x = 2.0 * s**2 - 1.0
    if end is None:
        return np.asarray(chebyshev.chebfit(x, psi, orders))
    below = 2.0 * (1.0 - s) * (1.0 + s)
    rest = chebyshev.chebfit(x, (psi - end) / below, orders - 1, w=below)
    return np.asarray(chebyshev.chebadd([end], chebyshev.chebmul([1.0, -1.0], rest)))


def _transformed(
    indenter: Profile, pressure: Callable[[FloatArray], FloatArray], a: float, *, singular: bool
) -> tuple[FloatArray, FloatArray]:
    """Radii t, crowded towards the edge, where the pressure ends like a root, and Abel's transform there."""
    t = a * np.sin(math.pi / 2.0 * gauss_nodes(_NODES)[0])
    return t, np.array([_transform(indenter, pressure, a, one, singular=singular) for one in t])


def _transform(
    indenter: Profile, pressure: Callable[[FloatArray], FloatArray], a: float, t: float, *, singular: bool
) -> float:
    """``int_t^a r p(r)/sqrt(r^2 - t^2) dr`` over angles with r^2 = t^2 + (a^2 - t^2) sin^2, cut where p bends."""
    way = (a - t) * (a + t)
    bends = sorted(one for one in {indenter.flat_radius, *indenter.breakpoints} if t < one < a)
    cuts = np.array([0.0, *(math.asin(math.sqrt((one - t) * (one + t) / way)) for one in bends), math.pi / 2.0])
    u, w = gauss_nodes(_NODES)
    # Nodes crowd at both ends of each part: at a rim the pressure has a logarithm.
    angle = (cuts[:-1, None] + np.diff(cuts)[:, None] * u**2 * (3.0 - 2.0 * u)).ravel()
    weight = (np.diff(cuts)[:, None] * 6.0 * u * (1.0 - u) * w).ravel()
    r = np.minimum(np.sqrt(t**2 + way * np.sin(angle) ** 2), a * (1.0 - 1e-12))
    # Of a singular pressure the root of the rounded radius is taken: close to the edge that of the angle is 1e-4 off.
    root = np.sqrt((a - r) * (a + r)) if singular else math.sqrt(way) * np.cos(angle)
    return float(weight @ (pressure(r) * root))


def _mean(share: FloatArray) -> float:
    """Of a series in 2 s^2 - 1 over s from 0 to 1."""
    s, w = gauss_nodes(_NODES)
    return float(w @ chebyshev.chebval(2.0 * s**2 - 1.0, share))


def _mean_height(indenter: Profile, a: float, pieces: Iterable[Piece]) -> float:
    """Of g_hs [m] over t from 0 to a, in pieces of a."""
    u, w = gauss_nodes(_NODES)
    found = 0.0
    for piece in pieces:
        t = a * (piece.start + piece.length * u**piece.power)
        found += piece.length * float((w * piece.power * u ** (piece.power - 1.0)) @ _height(indenter, t))
    return found


def _height(indenter: Profile, t: FloatArray) -> FloatArray:
    """g_hs [m]."""
    risen = np.zeros_like(t)
    beyond = t > indenter.flat_radius
    if not isinstance(indenter, FlatPunch) and beyond.any():
        risen[beyond] = half_space_load(indenter, t[beyond] - indenter.flat_radius)
    return risen
