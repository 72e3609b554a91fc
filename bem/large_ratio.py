"""Flat punches much wider than the layer is thick, up to a/h = 1000.

One factorisation on wide panels gives, for every radius at a panel's end, a few densities phi_i = A^-1 P_i(t^2/a^2).
Rounding and the panels' width have cost them up to nine digits where the layer is bonded and incompressible. Within
their span, however, the force is stationary: the Ritz value ``F = b^T G^-1 b`` with ``b_i = <1, phi_i>`` and the
energies ``G_ij = <phi_i, A phi_j>``, computed without cancellation (`fourier_energy`), is wrong only by the square of
what the span lacks. k_bar is then interpolated by a polynomial of ln k_bar in ln(a/h); its derivative gives c_bar.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial import Chebyshev
from numpy.typing import ArrayLike

from bem.fourier_energy import energy_matrix
from bem.fredholm_kernel import FredholmKernel
from bem.kernels import Support
from bem.panels import gauss_nodes
from bem.triangular import cholesky_lower, solve_lower
from contact import InvalidInput
from contact.validation import FloatArray

if TYPE_CHECKING:
    from bem.integral_equation import IntegralEquationSolution

LARGEST_RATIO = 1000.0
ROUNDING = 1e-12  # a quotient of two lengths meant as 1000 may come out above it
FIRST_RATIO = 80.0  # answers of the wide panels are made from here on,
OVERLAP = 120.0  # compared with the narrow panels' from here on, and used where those end
PANEL_WIDTH = 8.0
PANEL_NODES = 32
RITZ_DENSITIES = 5
RADII = 34
DEGREE = 20  # of ln k_bar in ln(a/h): nearly incompressible layers turn from film to bed within the range


@dataclass(frozen=True, eq=False)
class LargeRatioSolution:
    """k_bar and c_bar up to a/h = 1000, made when first asked for; the pressure up to where `near` ends.

    Attributes:
        support: "bonded" or "unbonded".
        poissons_ratio: nu.
        make_near: Gives the solution for smaller ratios, which must reach beyond `OVERLAP`.
    """

    support: Support
    poissons_ratio: float
    make_near: Callable[[], IntegralEquationSolution]

    @property
    def max_ratio(self) -> float:
        """Largest a/h that is covered."""
        return LARGEST_RATIO

    @property
    def unknowns(self) -> int:
        """Size of the larger system that was factorised."""
        return int(LARGEST_RATIO / PANEL_WIDTH) * PANEL_NODES

    def normalized_contact_stiffness(self, ratio: ArrayLike) -> FloatArray:
        """k_bar."""
        ratio = self._covered(ratio)
        within = self.near.normalized_contact_stiffness(np.minimum(ratio, self.near.max_ratio))
        return np.where(ratio <= self.near.max_ratio, within, self._stiffness(ratio))

    def normalized_spring_stiffness(self, ratio: ArrayLike) -> FloatArray:
        """c_bar = k_bar (1 + d ln k_bar/d ln ratio), Eq. (10)."""
        ratio = self._covered(ratio)
        within = self.near.normalized_spring_stiffness(np.minimum(ratio, self.near.max_ratio))
        return np.where(
            ratio <= self.near.max_ratio, within, self.wide_spring_stiffness(np.maximum(ratio, FIRST_RATIO))
        )

    def wide_spring_stiffness(self, ratio: FloatArray) -> FloatArray:
        """c_bar from the wide panels alone, `FIRST_RATIO` <= ratio."""
        stiffness: FloatArray = self._stiffness(ratio) * (1 + self.log_stiffness.deriv()(np.log(ratio)))
        return stiffness

    def reach(self, ratio: float) -> float:
        """The smallest ratio with a known density that is not below the given one."""
        return min(known for known in self.densities if known >= ratio * (1 - 1e-12))

    @property
    def densities(self) -> dict[float, FloatArray]:
        """Unit flat punch's density at some ratios, by values at the nodes of wide panels, shape (panels, nodes)."""
        return self._punches[3]

    def smooth_pressure(self, rho: ArrayLike, ratio: ArrayLike) -> FloatArray:
        """q as from `near`.

        Raises:
            InvalidInput: Beyond `near`, where only stiffnesses are known.
        """
        ratio = self._covered(ratio)
        if np.any(ratio > self.near.max_ratio):
            raise InvalidInput(
                f"a/h = {np.max(ratio):g}: pressures are known up to a/h = {self.near.max_ratio:g}; depth, force and "
                f"stiffness up to {LARGEST_RATIO:g}"
            )
        return self.near.smooth_pressure(rho, ratio)

    def relative_error(self, ratio: ArrayLike) -> FloatArray:
        """Bound of the relative error of k_bar and c_bar."""
        ratio = self._covered(ratio)
        within = self.near.relative_error(np.minimum(ratio, self.near.max_ratio))
        return np.where(ratio <= self.near.max_ratio, within, self.error)

    def moment_error(self, ratio: ArrayLike, start: ArrayLike = 0.0) -> FloatArray:
        """As that of the stiffnesses."""
        return self.relative_error(ratio)

    @cached_property
    def near(self) -> IntegralEquationSolution:
        """Solution for smaller ratios."""
        return self.make_near()

    @cached_property
    def log_stiffness(self) -> Chebyshev:
        """ln k_bar over ln(a/h)."""
        ratios, stiffness, *_ = self._punches
        return Chebyshev.fit(np.log(ratios), np.log(stiffness), DEGREE)

    @cached_property
    def error(self) -> float:
        """Bound of the relative error of both stiffnesses: twice what overlap and Ritz values show."""
        overlap = np.linspace(OVERLAP, self.near.max_ratio, 9)
        k = self._stiffness(overlap)
        c = self.wide_spring_stiffness(overlap)
        k_error = np.abs(k / self.near.normalized_contact_stiffness(overlap) - 1)
        c_error = np.abs(c / self.near.normalized_spring_stiffness(overlap) - 1)
        return 2 * (float(np.max(np.maximum(k_error, c_error))) + self._punches[2])

    @cached_property
    def _punches(self) -> tuple[FloatArray, FloatArray, float, dict[float, FloatArray]]:
        return _wide_punches(self.support, self.poissons_ratio)

    def _stiffness(self, ratio: FloatArray) -> FloatArray:
        stiffness: FloatArray = np.exp(self.log_stiffness(np.log(np.maximum(ratio, FIRST_RATIO))))
        return stiffness

    def _covered(self, ratio: ArrayLike) -> FloatArray:
        ratio = np.asarray(ratio, dtype=float)
        covered = (ratio >= 0) & (ratio <= LARGEST_RATIO * (1 + ROUNDING))
        if not np.all(covered):
            raise InvalidInput(f"a/h = {ratio[~covered].flat[0]:g}: this solution covers [0, {LARGEST_RATIO:g}]")
        limited: FloatArray = np.minimum(ratio, LARGEST_RATIO)
        return limited


def _wide_punches(
    support: Support, poissons_ratio: float
) -> tuple[FloatArray, FloatArray, float, dict[float, FloatArray]]:
    """Ratios, k_bar there, the largest relative difference that the last Ritz density makes, and the densities."""
    ratios = _radii_at_panel_ends()
    root = np.sqrt(PANEL_WIDTH * np.tile(gauss_nodes(PANEL_NODES)[1], int(LARGEST_RATIO / PANEL_WIDTH)))
    lower = _factorise(support, poissons_ratio, root)
    punches = [_ritz_punch(lower, root, float(a), support, poissons_ratio) for a in ratios]
    best, fewer = (np.array([punch[item] for punch in punches]) for item in (0, 1))
    densities = {float(a): punch[2] for a, punch in zip(ratios, punches, strict=True)}
    return ratios, best / ratios, float(np.max(np.abs(fewer / best - 1))), densities


def _radii_at_panel_ends() -> FloatArray:
    """Panel ends nearest to the Chebyshev points of ln(a/h) from `FIRST_RATIO` to `LARGEST_RATIO`."""
    middle, half = np.log(FIRST_RATIO * LARGEST_RATIO) / 2, np.log(LARGEST_RATIO / FIRST_RATIO) / 2
    points = np.exp(middle - half * np.cos(np.pi * np.arange(RADII) / (RADII - 1)))
    return np.unique(PANEL_WIDTH * np.rint(points / PANEL_WIDTH))


def _factorise(support: Support, poissons_ratio: float, root: FloatArray) -> FloatArray:
    """Lower factor of I - sqrt(w) K sqrt(w) on wide panels."""
    panels = root.size // PANEL_NODES
    matrix = FredholmKernel.of_layer(support, poissons_ratio).panel_matrix(panels, PANEL_WIDTH, PANEL_NODES)
    matrix *= -2 / np.pi * root
    matrix *= root[:, None]
    matrix[np.diag_indices_from(matrix)] += 1
    return cholesky_lower(matrix, LARGEST_RATIO)


def _ritz_punch(
    lower: FloatArray, root: FloatArray, ratio: float, support: Support, poissons_ratio: float
) -> tuple[float, float, FloatArray]:
    """F/(2 E*) of a flat punch pressed in by 1, from all Ritz densities and from one less, and its density."""
    panels = int(ratio / PANEL_WIDTH)
    n, nodes = panels * PANEL_NODES, gauss_nodes(PANEL_NODES)[0]
    t = PANEL_WIDTH * (np.arange(panels)[:, None] + nodes).ravel()
    loads = root[:n, None] * np.polynomial.legendre.legvander(2 * (t / ratio) ** 2 - 1, RITZ_DENSITIES - 1)
    half = solve_lower(lower[:n, :n], loads)
    densities = solve_lower(lower[:n, :n], half, transposed=True) / root[:n, None]
    energy = energy_matrix(densities.T.reshape(-1, panels, PANEL_NODES), PANEL_WIDTH, support, poissons_ratio)
    load = densities.T @ root[:n] ** 2
    shares, fewer = _stationary(energy, load), _stationary(energy[:-1, :-1], load[:-1])
    return float(load @ shares), float(load[:-1] @ fewer), (densities @ shares).reshape(panels, PANEL_NODES)


def _stationary(energy: FloatArray, load: FloatArray) -> FloatArray:
    """G^-1 b with unit diagonal of G, since the densities differ by orders of magnitude."""
    scale = 1 / np.sqrt(np.diag(energy))
    shares: FloatArray = scale * np.linalg.solve(energy * np.multiply.outer(scale, scale), load * scale)
    return shares
