"""Pressure of one elastic contact of given radius by formulas of its own, for campaigns over thousands of fields.

    p(r) = (E*/pi) [phi(a)/sqrt(a^2 - r^2) + int_r^a g'(t)/sqrt(t^2 - r^2) dt - int_r^a psi'(t)/sqrt(t^2 - r^2) dt]

g' is written out in `referee_profiles`, psi is the layer's share of the density of `referee`, a sum of cosines that is
differentiated term by term. The integrals are taken in u = sqrt(t - hi), hi the larger of r and the
start of the stretch, on panels that double with their distance from u = 0 and from a sphere's equator. Against 40-digit
arithmetic: `tests/cases/measurements/stability/test_pressures.py`.
"""

import math
from itertools import pairwise
from typing import Final

import numpy as np

from contact import FlatPunch, Layer, Profile
from contact.records.validation import FloatArray
from tests.referees.profiles import equivalent_slope
from tests.referees.second_opinion import direct_density

# Gauss nodes of a panel as long as its distance from the singularity, where the error of n nodes is 5.8^(-2n).
_NODES: Final = 16
# Panels of the layer's share for each thickness: psi is analytic within two thicknesses of the real axis.
_PANELS_PER_THICKNESS: Final = 2
# First panel towards the square root at u = 0 relative to the distance of the next singularity.
_FIRST: Final = 0.5


def reference_pressure(
    layer: Layer, indenter: Profile, excess: float, depth: float | None, radius: FloatArray
) -> FloatArray:
    """p [Pa] at radii [m] within the contact of radius b + excess.

    Args:
        layer: Layer or half-space.
        indenter: The profile.
        excess: a - b [m] over the radius b of the flat end.
        depth: delta [m] of a flat punch; None where phi(a) = 0 gives it.
        radius: r [m], shape (n,).
    """
    a = indenter.flat_radius + excess
    offset = radius - indenter.flat_radius
    bracket = np.array([_profile_integral(indenter, excess, *pair) for pair in zip(radius, offset, strict=True)])
    edge = 0.0 if depth is None else depth
    if not layer.is_half_space:
        density, h = direct_density(layer, indenter, excess), layer.thickness
        amplitudes = density.amplitudes @ [density.depth if depth is None else depth / h, -1.0]
        bracket += _cosine_integrals(density.wavenumbers, amplitudes, radius / h, a / h)
        edge += h * float(amplitudes @ np.cos(density.wavenumbers * density.contact_radius))
    if depth is not None:
        bracket += edge / np.sqrt((excess - offset) * (a + radius))
    modulus = layer.youngs_modulus / (1 - layer.poissons_ratio**2)
    pressure: FloatArray = modulus / math.pi * bracket
    return pressure


def _profile_integral(indenter: Profile, excess: float, radius: float, offset: float) -> float:
    """int g'(t)/sqrt(t^2 - r^2) dt over the stretches beyond r."""
    flat = indenter.flat_radius
    breaks = [k - flat for k in indenter.breakpoints if 0 < k - flat < excess]
    if isinstance(indenter, FlatPunch):
        return 0.0
    return sum(
        _over_stretch(indenter, (start, stop), excess, radius, offset)
        for start, stop in pairwise([0.0, *breaks, excess])
        if stop > offset
    )


def _over_stretch(
    indenter: Profile, stretch: tuple[float, float], excess: float, radius: float, offset: float
) -> float:
    """The integral over one stretch, given with its ends as offsets from b."""
    start, stop = max(stretch[0], offset), stretch[1]
    apart = start - offset
    length, flat = stop - start, indenter.flat_radius
    room = indenter.max_radius - flat - excess if stop == excess else math.inf
    nearest = apart or (offset - stretch[0]) or length
    if stretch[0] + flat == 0:
        nearest = min(radius, length) or 1e-30 * length
    u, left, weight = _panels(math.sqrt(length), _FIRST * math.sqrt(nearest), room)
    beyond = u**2
    t = flat + start + beyond
    slope = equivalent_slope(indenter, start + beyond, left * (math.sqrt(length) + u) + room)
    if apart:
        return float(np.sum(weight * 2 * u * slope / np.sqrt((apart + beyond) * (t + radius))))
    return float(np.sum(weight * 2 * slope / np.sqrt(t + radius)))


def _panels(end: float, first: float, room: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """u, end - u and weights on [0, end]: doubling from zero, halving with the distance from the pole.

    The pole lies at u^2 = end^2 + room. Both distances of a node keep their digits.
    """
    to_pole = room / (math.sqrt(end**2 + room) + end) if room < math.inf else math.inf
    x, w = np.polynomial.legendre.leggauss(_NODES)
    here, left, nodes = 0.0, end, []
    while left > 0:
        size = min(max(here, first), (left + to_pole) / 2)
        size = size if size < left else left
        nodes.append((here + size * (1 + x) / 2, (left - size) + size * (1 - x) / 2, size / 2 * w))
        here, left = here + size, left - size
    u, before, weight = (np.concatenate(column) for column in zip(*nodes, strict=True))
    return u, before, weight


def _cosine_integrals(k: FloatArray, amplitudes: FloatArray, radius: FloatArray, a: float) -> FloatArray:
    """-int psi'/sqrt(t^2 - r^2) dt = sum A k int sin(kt)/t ds for psi = sum A cos(kt), t^2 = r^2 + s^2, h = 1."""
    count = _PANELS_PER_THICKNESS * math.ceil(a)
    x, w = np.polynomial.legendre.leggauss(_NODES)
    nodes = ((np.arange(count)[:, None] + (1 + x) / 2) / count).ravel()
    reach = np.sqrt((a - radius) * (a + radius))
    t = np.hypot(radius[:, None], reach[:, None] * nodes)
    values = np.sinc(t[..., None] * k / math.pi) @ (k**2 * amplitudes)
    integrals: FloatArray = reach / count * (values @ np.tile(w / 2, count))
    return integrals
