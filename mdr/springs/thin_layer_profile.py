"""MDR profile on layers much thinner than the contact is wide, with `bem.layer_equation.thin_layers`.

By Betti's theorem the profile's moment is the flat punch's density weighted with the half-space profile,

    M(x) = int_0^x c_bar g dx = <phi_1(.; x), g_hs>,    so    g = M'/c_bar.

The densities are known at some thirty radii. There ln M is fitted by a polynomial in ln x, and the fit is
differentiated; profiles with breakpoints at such radii take the wide panels alone. Lengths count in layer thicknesses.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import Chebyshev

from bem.layer_equation.thin_layers import FIRST_RATIO, LAST_TERMS, PANEL_WIDTH, LargeRatioSolution
from bem.polynomials.gauss_panels import lagrange_matrix
from bem.polynomials.mapped import MappedFunction, MappedGrid
from contact.records.validation import FloatArray
from mdr.springs.layer_profile import edge_values

DEGREE = 24  # of ln M in ln x, or two less than the number of radii within reach
# Size of coefficients of ln M that is rounding: sums over hundreds of nodes, of densities that have lost digits.
NOISE = 1e-12
# Multiplies what overlap and decay show. For cones and paraboloids on layers of nu = 0.49, 0.4999 and 0.5 and radii up
# to 168, 328 and 704 thicknesses, against fits over all radii, the product is 1.5 to 24 times the true error
# (measured 2026-11-22); what the shorter fit misses was up to 180 times it.
SAFETY = 1.5


def wide_profile(
    solution: LargeRatioSolution, load: MappedFunction, flat_radius: float
) -> tuple[MappedFunction, float]:
    """g on the load's grid, and its relative error, seen where narrow and wide panels overlap and in the fit's end.

    Args:
        solution: Flat punches up to large ratios.
        load: g_hs on a grid that ends at a known radius; ends of wide panels, and the end of `solution.near`, are piece
            ends.
        flat_radius: b, well below `FIRST_RATIO`, as all breakpoints.
    """
    near, grid = solution.near, load.grid
    x = flat_radius + grid.nodes
    within = x[:, 0] < near.max_ratio
    inner = MappedGrid(grid.left[within], grid.width[within], grid.power[within], grid.count)
    edge = edge_values(near.factor, MappedFunction(inner, load.node_values[within], load.lead), flat_radius)
    values = np.empty_like(x)
    values[within] = edge / near.edge_density(np.minimum(x[within], near.max_ratio))
    far, shorter = _moment_fits(solution, load, flat_radius)
    values[~within] = _slope_over_springs(solution, far, x[~within])
    overlap = within & (x[:, 0] > 1.5 * FIRST_RATIO)
    seen = np.max(np.abs(_slope_over_springs(solution, far, x[overlap]) / values[overlap] - 1))
    seen += _decay(far) * np.max(np.abs(_slope_over_springs(solution, shorter, x[~within]) / values[~within] - 1))
    return MappedFunction(grid, values, load.lead), SAFETY * float(seen)


def _decay(fit: Chebyshev) -> float:
    """By how much less a fit errs than the shorter one: its last coefficients over those before, per order.

    The next two orders would allow for its square; where coefficients are rounding nothing falls.
    """
    last, before = (
        max(float(np.abs(part).max()), NOISE)
        for part in (fit.coef[-LAST_TERMS:], fit.coef[-2 * LAST_TERMS : -LAST_TERMS])
    )
    return min(1.0, float(np.sqrt(last / before)))


def _moment_fits(solution: LargeRatioSolution, load: MappedFunction, flat_radius: float) -> list[Chebyshev]:
    """ln M over ln x from the densities at the known radii, and the same with a few terms less, to judge it."""
    grid = load.grid
    x = flat_radius + grid.nodes
    panel = np.floor(x[:, 0] / PANEL_WIDTH).astype(np.intp)
    weighted = load.node_values * grid.weights
    radii = [ratio for ratio in solution.densities if ratio <= flat_radius + grid.end + PANEL_WIDTH / 2]
    count = solution.densities[radii[0]].shape[1]
    onto_nodes = np.einsum("qi,qij->qj", weighted, lagrange_matrix(count, x / PANEL_WIDTH - panel[:, None]))
    moments = []
    for ratio in radii:
        inside = panel < round(ratio / PANEL_WIDTH)
        moments.append(float(np.sum(onto_nodes[inside] * solution.densities[ratio][panel[inside]])))
    degree = min(DEGREE, len(radii) - 2)
    return [Chebyshev.fit(np.log(radii), np.log(moments), n) for n in (degree, degree - LAST_TERMS)]


def _slope_over_springs(solution: LargeRatioSolution, fit: Chebyshev, x: FloatArray) -> FloatArray:
    """g = M'/c_bar."""
    log = np.log(x)
    g: FloatArray = np.exp(fit(log)) * fit.deriv()(log) / x / solution.wide_spring_stiffness(x)
    return g
