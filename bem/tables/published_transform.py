"""MDR profile from tabulated flat punches, Eq. (11), as published.

With r = x cos(psi) and q = p_bar sqrt(1 - rho^2), Eq. (11) reads ``g = (1/c_bar) dM/dx``, ``M = rho M_hs``, where
``M_hs = int_0^x g_hs dx`` is the half-space's moment and

    rho(x) = k_bar(x/h) int 2 q(cos psi; x/h) f(x cos psi) cos psi dpsi / int f(x cos psi) cos psi dpsi

the layer's, relative to it. rho varies slowly and is 1 for thick layers. Only rho is differentiated, as a fitted
polynomial; what is steep in the profile is differentiated exactly: ``dM/dx = rho g_hs + rho' M_hs``.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from bem.layer_equation.protocol import FlatPunchSolution
from bem.polynomials.gauss_panels import gauss_nodes
from bem.polynomials.mapped import MappedFunction
from contact import Profile
from contact.records.validation import FloatArray

# Gauss nodes between two breakpoints of the profile; chosen.
NODES = 32


def published_profile(
    solution: FlatPunchSolution, indenter: Profile, unit: float, half_space: MappedFunction
) -> MappedFunction:
    """g in units of `unit` by Eq. (11).

    Args:
        solution: Tabulated flat punches.
        indenter: The profile.
        unit: Layer thickness [m].
        half_space: g_hs in units of the thickness.
    """
    grid, flat = half_space.grid, indenter.flat_radius / unit
    x = flat + grid.nodes
    layer, plain = _weighted_heights(solution, indenter, unit, x)
    # As the risen part vanishes the quotient becomes its value at the edge; it is 0/0 where x is rounded to b.
    at_edge = 2 * np.asarray(solution.smooth_pressure(np.ones_like(x), x))
    risen = np.divide(layer, plain, out=at_edge, where=plain > 0)
    share = MappedFunction(grid, solution.normalized_contact_stiffness(x) * risen, 0.0)
    moment = half_space.integral()
    slope = share.derivative(grid.nodes)
    g = share.node_values * half_space.node_values + slope * moment.node_values  # d(rho M_hs)/dx
    return MappedFunction(grid, g / solution.normalized_spring_stiffness(x), half_space.lead)  # Eq. (11)


def _weighted_heights(
    solution: FlatPunchSolution, indenter: Profile, unit: float, x: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """int 2 q f cos(psi) dpsi and int f cos(psi) dpsi over the risen part of the profile, lengths in thicknesses."""
    nodes, weights = gauss_nodes(NODES)
    flat = indenter.flat_radius / unit
    ends = [flat, *(k / unit for k in indenter.breakpoints if flat < k / unit < np.max(x)), np.inf]
    layer, plain = np.zeros_like(x), np.zeros_like(x)
    for start, stop in pairwise(ends):
        widest, narrowest = (np.arccos(np.clip(np.minimum(r, x) / x, 0.0, 1.0)) for r in (start, stop))
        psi = narrowest[..., None] + (widest - narrowest)[..., None] * nodes
        height = indenter.height(unit * x[..., None] * np.cos(psi)) * np.cos(psi)
        q = solution.smooth_pressure(np.cos(psi), np.broadcast_to(x[..., None], psi.shape))
        layer += (widest - narrowest) * ((2 * q * height) @ weights)
        plain += (widest - narrowest) * (height @ weights)
    return layer, plain
