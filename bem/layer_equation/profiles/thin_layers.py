"""MDR profile on layers much thinner than the contact is wide, of `bem.layer_equation.thin_layers`.

By Betti's theorem the profile's moment is the flat punch's density weighted with the half-space profile,

    M(x) = int_0^x c_bar g dx = <phi_1(.; x), g_hs>,    so    g = M'/c_bar.

The densities are known at some thirty radii. There ln M is fitted by a polynomial in ln x, and the fit is
differentiated; profiles with breakpoints at such radii take the wide panels alone. Lengths count in layer thicknesses.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Chebyshev

from bem.layer_equation.flat_punch_solution import IntegralEquationSolution
from bem.layer_equation.profiles.edge_values import edge_values
from bem.polynomials.gauss_panels import lagrange_matrix
from bem.polynomials.mapped import MappedFunction, MappedGrid
from contact.records.validation import FloatArray

# Degree of the polynomial ln M(ln x), unless fewer than 26 radii lie within the profile: then two less than these. With
# 32 the errors move within what they state (test_wide_profile).
DEGREE = 24
# Number of last coefficients that a fit is judged by: the fit without them is compared with the whole, both of ln M and
# of ln k_bar.
LAST_TERMS = 2
# Size of coefficients of ln M that is rounding: sums over hundreds of nodes, of densities that have lost digits.
NOISE = 1e-12
# Multiplies the sum of two differences: of the fit and the narrow panels where they overlap, and of the fit and one
# `LAST_TERMS` degrees shorter beyond, times the decay of the coefficients. For cones and paraboloids on layers of
# nu = 0.49, 0.4999 and 0.5 and radii up to 168, 328 and 704 thicknesses, against fits over all radii, the error so
# stated is 1.5 to 24 times the true one (measured 2026-11-22); without the decay it was up to 180 times.
SAFETY = 1.5


@dataclass(frozen=True, eq=False)
class WidePanels:
    """What a profile on a thin layer is made of.

    Attributes:
        near: The solution for smaller ratios.
        densities: Unit flat punch's density at some ratios, by values at the nodes of wide panels, (panels, nodes).
        springs: c_bar beyond the narrow panels.
        width: Of the wide panels.
        first_ratio: The ratio from which `springs` holds.
    """

    near: IntegralEquationSolution
    densities: dict[float, FloatArray]
    springs: Callable[[FloatArray], FloatArray]
    width: float
    first_ratio: float

    def profile(self, load: MappedFunction, flat_radius: float) -> tuple[MappedFunction, float]:
        """g on the load's grid, and its relative error: from the overlap of narrow and wide panels, and the fit's end.

        Args:
            load: g_hs on a grid that ends at a known radius; ends of wide panels, and the end of `near`, are piece
                ends.
            flat_radius: b, well below `first_ratio`, as all breakpoints.
        """
        grid = load.grid
        x = flat_radius + grid.nodes
        within = x[:, 0] < self.near.max_ratio
        inner = MappedGrid(grid.left[within], grid.width[within], grid.power[within], grid.count)
        edge = edge_values(self.near.factor, MappedFunction(inner, load.node_values[within], load.lead), flat_radius)
        values = np.empty_like(x)
        values[within] = edge / self.near.edge_density(np.minimum(x[within], self.near.max_ratio))
        far, shorter = self._moment_fits(load, flat_radius)
        values[~within] = self._slope_over_springs(far, x[~within])
        overlap = within & (x[:, 0] > 1.5 * self.first_ratio)
        seen = np.max(np.abs(self._slope_over_springs(far, x[overlap]) / values[overlap] - 1))
        seen += _decay(far) * np.max(np.abs(self._slope_over_springs(shorter, x[~within]) / values[~within] - 1))
        return MappedFunction(grid, values, load.lead), SAFETY * float(seen)

    def _moment_fits(self, load: MappedFunction, flat_radius: float) -> list[Chebyshev]:
        """ln M over ln x from the densities at the known radii, and the same with a few terms less, to judge it."""
        grid = load.grid
        x = flat_radius + grid.nodes
        panel = np.floor(x[:, 0] / self.width).astype(np.intp)
        weighted = load.node_values * grid.weights
        radii = [ratio for ratio in self.densities if ratio <= flat_radius + grid.end + self.width / 2]
        count = self.densities[radii[0]].shape[1]
        onto_nodes = np.einsum("qi,qij->qj", weighted, lagrange_matrix(count, x / self.width - panel[:, None]))
        moments = []
        for ratio in radii:
            inside = panel < round(ratio / self.width)
            moments.append(float(np.sum(onto_nodes[inside] * self.densities[ratio][panel[inside]])))
        degree = min(DEGREE, len(radii) - 2)
        return [Chebyshev.fit(np.log(radii), np.log(moments), n) for n in (degree, degree - LAST_TERMS)]

    def _slope_over_springs(self, fit: Chebyshev, x: FloatArray) -> FloatArray:
        """g = M'/c_bar."""
        log = np.log(x)
        g: FloatArray = np.exp(fit(log)) * fit.deriv()(log) / x / self.springs(x)
        return g


def _decay(fit: Chebyshev) -> float:
    """By how much less a fit errs than the shorter one: its last coefficients over those before, per order.

    The next two orders would allow for its square; where coefficients are rounding nothing falls.
    """
    last, before = (
        max(float(np.abs(part).max()), NOISE)
        for part in (fit.coef[-LAST_TERMS:], fit.coef[-2 * LAST_TERMS : -LAST_TERMS])
    )
    return min(1.0, float(np.sqrt(last / before)))
