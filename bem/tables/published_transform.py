"""MDR profile from tabulated flat punches, Eq. (11), as published.

With r = x cos(psi) and q = p_bar sqrt(1 - rho^2), Eq. (11) reads ``g = (1/c_bar) dM/dx``, ``M = rho M_hs``, where
``M_hs = int_0^x g_hs dx`` is the half-space's moment and

    rho(x) = k_bar(x/h) int 2 q(cos psi; x/h) f(x cos psi) cos psi dpsi / int f(x cos psi) cos psi dpsi

the layer's, relative to it. rho varies slowly and is 1 for thick layers; what is steep in the profile is known exactly:
``dM/dx = rho g_hs + rho' M_hs``. rho' is an integral over dq/dx and f', by the same nodes as rho.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import TypeAlias

import numpy as np

from bem.layer_equation.protocol import FlatPunchSolution
from bem.polynomials.gauss_panels import gauss_nodes
from bem.polynomials.mapped import TINY, MappedFunction
from contact import Profile
from contact.records.validation import FloatArray

# A function of r/a and a/h.
OfPunches: TypeAlias = Callable[[FloatArray, FloatArray], FloatArray]
# Gauss nodes between two breakpoints of the profile; chosen.
NODES = 32


def published_profile(
    solution: FlatPunchSolution, pressure_change: OfPunches, indenter: Profile, unit: float, half_space: MappedFunction
) -> MappedFunction:
    """g in units of `unit` by Eq. (11).

    Args:
        solution: Tabulated flat punches.
        pressure_change: dq/d(a/h) of their pressures at r/a and a/h.
        indenter: The profile.
        unit: Layer thickness [m].
        half_space: g_hs in units of the thickness.
    """
    grid, flat = half_space.grid, indenter.flat_radius / unit
    x = flat + grid.nodes
    (layer, plain), (layer_slope, plain_slope) = _weighted_heights(
        solution.smooth_pressure, pressure_change, indenter, unit, x
    )
    # As the risen part vanishes the quotient becomes its value at the edge; it is 0/0 where x is rounded to b.
    risen, there = 2 * np.asarray(solution.smooth_pressure(np.ones_like(x), x)), plain > 0
    np.divide(layer, plain, out=risen, where=there)
    risen_slope = np.divide(layer_slope - risen * plain_slope, plain, out=np.zeros_like(x), where=there)
    stiffness, springs = solution.normalized_contact_stiffness(x), solution.normalized_spring_stiffness(x)
    # rho' = k_bar' risen + k_bar risen', where c_bar = k_bar + x k_bar'.
    slope = (springs - stiffness) / x * risen + stiffness * risen_slope
    g = stiffness * risen * half_space.node_values + slope * half_space.integral().node_values  # d(rho M_hs)/dx
    return MappedFunction(grid, g / springs, half_space.lead)  # Eq. (11)


def _weighted_heights(
    smooth_pressure: OfPunches, pressure_change: OfPunches, indenter: Profile, unit: float, x: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """int 2 q f cos(psi) dpsi and int f cos(psi) dpsi over the risen part, lengths in thicknesses, and slopes by x."""
    flat = indenter.flat_radius / unit
    ends = [flat, *(k / unit for k in indenter.breakpoints if flat < k / unit < np.max(x)), np.inf]
    found = np.zeros((2, 2, *x.shape))
    for start, stop in pairwise(ends):
        psi, weights = _angles(x, start, stop, indenter.max_radius / unit)
        cosine = np.cos(psi)
        radius = unit * x[..., None] * cosine
        height, steepness = indenter.height(radius) / unit * cosine, indenter.slope_at(radius) * cosine**2
        q, change = (read(cosine, x[..., None]) for read in (smooth_pressure, pressure_change))
        integrands = [[2 * q * height, height], [2 * (q * steepness + change * height), steepness]]
        found += np.sum(np.array(integrands) * weights, axis=-1)
    return found[0], found[1]


def _angles(x: FloatArray, start: float, stop: float, end: float) -> tuple[FloatArray, FloatArray]:
    """Nodes psi and weights between r = x cos(psi) = `start` and `stop`, crowded at r = x as a profile's end asks.

    Beside an upright end profiles rise like the root of psi^2 + (end/x)^2 - 1, which is smooth in asinh of psi over it.
    """
    nodes, weights = gauss_nodes(NODES)
    widest, narrowest = (np.arccos(np.clip(np.minimum(r, x) / x, 0.0, 1.0))[..., None] for r in (start, stop))
    near = np.clip(np.sqrt((end - x) * (end + x)) / x, TINY, 1.0)[..., None]
    low, high = np.arcsinh(narrowest / near), np.arcsinh(widest / near)
    stretched = low + (high - low) * nodes
    return near * np.sinh(stretched), (high - low) * near * np.cosh(stretched) * weights
