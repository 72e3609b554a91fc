"""Flat punches much wider than the layer is thick, up to a/h = 1000.

One factorisation on wide panels gives, for every radius at a panel's end, a few densities phi_i = A^-1 P_i(t^2/a^2).
Rounding has cost them up to nine digits where the layer is bonded and incompressible. Within
their span, however, the force is stationary: the Ritz value ``F = b^T G^-1 b`` with ``b_i = <1, phi_i>`` and the
energies ``G_ij = <phi_i, A phi_j>``, computed without cancellation (`fourier_energy`), is wrong only by the square of
what the span lacks. k_bar is then interpolated by a polynomial of ln k_bar in ln(a/h); its derivative gives c_bar.
Stated errors add up what the span lacks, what the energies leave out, and what the polynomial misses.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.polynomial import Chebyshev
from numpy.typing import ArrayLike

from bem.kernels.of_layer import UniformKernel
from bem.layer_equation.error_model import WIDE_FACTOR, FactorCoefficients
from bem.layer_equation.flat_punch_solution import IntegralEquationSolution
from bem.layer_equation.fourier_energy import energy_matrix, tail_left_out
from bem.layer_equation.fredholm_kernel import FredholmKernel
from bem.layer_equation.one_factorisation import VolterraFactor
from bem.layer_equation.profiles.edge_values import gain_within
from bem.layer_equation.profiles.thin_layers import LAST_TERMS, WidePanels
from bem.layer_equation.protocol import FITTED_SHARE, FlatPunchSolution
from bem.polynomials.gauss_panels import gauss_nodes
from bem.polynomials.mapped import MappedFunction, apart
from contact.records.errors import InvalidInput
from contact.records.validation import FloatArray
from contact.scene.layer import Support
from contact.scene.profiles import Profile

# Largest a/h. A quotient of two lengths meant as it may come out above it by this much, relative.
LARGEST_RATIO = 1000.0
ROUNDING = 1e-12
# The solution on wide panels is computed from this a/h on. It is returned where the narrow panels end.
FIRST_RATIO = 80.0
# Width of the wide panels in thicknesses, and their Gauss nodes.
PANEL_WIDTH = 8.0
PANEL_NODES = 36
# Relative error of a density by these panels: 1.618^-36, since densities are analytic within 2 of panels 8 wide.
DENSITY_TRUNCATION = 3e-8
# Densities that span the Ritz solution at each radius.
RITZ_DENSITIES = 4
# Radii solved, and degree of the polynomial ln k_bar in ln(a/h) through them. The degree is high because a nearly
# incompressible layer turns from an incompressible one into a compressible one within the range.
RADII = 42
DEGREE = 26
# Samples of what the polynomial misses for each of its degrees, and how many of them, either way, its largest value is
# taken over: half a wave of its last term, because it crosses zero twice in each wave.
SAMPLES = 4
NEARBY = 3 * SAMPLES
# Times what the fall of errors from one number of terms to the next lets expect of the last; chosen. At nu = 0.4999
# c_bar states 27 times its error in the median without that fall, 16 times with 4 for this factor (60 radii, against 60
# radii and degree 36, 2026-11-22).
FALL_SAFETY = 2.0


@dataclass(frozen=True, eq=False)
class LargeRatioSolution(FlatPunchSolution):
    """k_bar and c_bar up to a/h = 1000, made when first asked for.

    Attributes:
        support: "bonded" or "unbonded".
        poissons_ratio: nu.
        make_near: Gives the solution for smaller ratios, which must reach beyond those of `COMPARED`.
    """

    support: Support
    poissons_ratio: float
    make_near: Callable[[], IntegralEquationSolution]
    displacement_known: ClassVar[bool] = True

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

    def profile_source(self, ratio: float, last_break: float) -> tuple[FlatPunchSolution, float]:
        """Itself, up to the next ratio with a known density; the wide panels alone for breakpoints far out."""
        if last_break > FIRST_RATIO / 2:
            return self.wide_alone, ratio
        return self, min(known for known in self.densities if known >= ratio * (1 - 1e-12))

    def error_steepness(self, ratio: FloatArray) -> FloatArray:
        """That of `near` within its reach."""
        ratio = self._covered(ratio)
        within = self.near.error_steepness(np.minimum(ratio, self.near.max_ratio))
        return np.where(ratio <= self.near.max_ratio, within, np.inf)

    @property
    def nodes(self) -> int:
        """As many as `near` has on a panel."""
        return self.near.nodes

    @property
    def fitted_from(self) -> float:
        """Where `near` ends."""
        return self.near.max_ratio

    def panel_ends(self, ratio: float) -> FloatArray:
        """Of the narrow panels, its own end included, and of the wide ones."""
        narrow = self.near.panel_ends(self.near.max_ratio * (1 + ROUNDING))
        return np.sort(np.append(narrow, apart(np.arange(PANEL_WIDTH, ratio, PANEL_WIDTH), narrow)))

    def profile_of(
        self, indenter: Profile, unit: float, load: MappedFunction, springs: FloatArray
    ) -> tuple[MappedFunction, float]:
        """From `near` within its reach, and fitted to the known densities beyond."""
        panels = WidePanels(self.near, self.densities, self.wide_spring_stiffness, PANEL_WIDTH, FIRST_RATIO)
        return panels.profile(load, indenter.flat_radius / unit)

    def contact_pressure_error(self, ratio: FloatArray, depth_error: FloatArray) -> FloatArray:
        """As where all is fitted, with what the density solved for has lost."""
        return np.asarray(FITTED_SHARE * (depth_error + self.density_error(ratio)))

    @property
    def densities(self) -> dict[float, FloatArray]:
        """Unit flat punch's density at some ratios, by values at the nodes of wide panels, shape (panels, nodes)."""
        return self._punches[3]

    def smooth_pressure(self, rho: ArrayLike, ratio: ArrayLike) -> FloatArray:
        """q from `near` or `wide`."""
        rho, ratio = np.broadcast_arrays(np.asarray(rho, dtype=float), self._covered(ratio))
        q, beyond = np.empty(rho.shape), ratio > self.near.max_ratio
        for solution, there in ((self.near, ~beyond), (self.wide, beyond)):
            q[there] = solution.smooth_pressure(rho[there], ratio[there])
        return q

    def one_contact(self, ratio: float) -> IntegralEquationSolution:
        """The factor that solves for the pressure under one contact."""
        return self.near if ratio <= self.near.max_ratio else self.wide

    def density_error(self, ratio: ArrayLike) -> FloatArray:
        """Relative error of pressures beyond that of the stiffness: what `wide` makes of k_bar, and its polynomials."""
        ratio = self._covered(ratio)
        return np.where(ratio <= self.near.max_ratio, 0.0, self._lost(ratio) + DENSITY_TRUNCATION)

    def relative_error(self, ratio: ArrayLike) -> FloatArray:
        """Bound of the relative error of k_bar."""
        ratio = self._covered(ratio)
        within = self.near.relative_error(np.minimum(ratio, self.near.max_ratio))
        return np.where(ratio <= self.near.max_ratio, within, self._wide_error(ratio)[0])

    def spring_error(self, ratio: ArrayLike) -> FloatArray:
        """Bound of the relative error of c_bar."""
        ratio = self._covered(ratio)
        within = self.near.spring_error(np.minimum(ratio, self.near.max_ratio))
        return np.where(ratio <= self.near.max_ratio, within, self._wide_error(ratio)[1])

    def profile_error(self, ratio: ArrayLike, start: ArrayLike = 0.0) -> FloatArray:
        """As that of the springs beyond; what the fits of the moment add is stated with the profile."""
        ratio = self._covered(ratio)
        within = self.near.profile_error(np.minimum(ratio, self.near.max_ratio))
        return np.where(ratio <= self.near.max_ratio, within, self._wide_error(ratio)[1])

    @cached_property
    def near(self) -> IntegralEquationSolution:
        """Solution for smaller ratios."""
        return self.make_near()

    @cached_property
    def wide(self) -> IntegralEquationSolution:
        """Solution on wide panels, which has lost digits where the layer is nearly incompressible."""
        kernel, panels = FredholmKernel.of_layer(self.support, self.poissons_ratio), int(LARGEST_RATIO / PANEL_WIDTH)
        factor = VolterraFactor.of_kernel(kernel, panels, PANEL_WIDTH, PANEL_NODES)
        return IntegralEquationSolution(kernel, factor)

    @cached_property
    def wide_alone(self) -> WideSolution:
        """The wide panels for all radii: seven digits, but for profiles with breakpoints anywhere."""
        positions = np.linspace(0.0, 1.0, SAMPLES * PANEL_NODES + 1)
        first, last = (start + PANEL_WIDTH * positions for start in (FIRST_RATIO, self.near.max_ratio - PANEL_WIDTH))
        before, after = (self._springs_missed(ratios) for ratios in (first, last))
        stiffness = [float(self.near.normalized_contact_stiffness(ratios[0])) for ratios in (first, last)]
        growth = float(np.abs(np.mean(after - before))) / (2 * (stiffness[1] - stiffness[0]))
        # Two waves of the first order that is left out, since errors vanish in between.
        seen = _largest_nearby(before, 2 * SAMPLES)
        return WideSolution(self.wide.kernel, self.wide.factor, self._lost, (positions, seen), growth)

    def _springs_missed(self, ratio: FloatArray) -> FloatArray:
        """What `wide` makes of c_bar, relative, where `near` reaches."""
        return np.asarray(
            self.wide.normalized_spring_stiffness(ratio) / self.near.normalized_spring_stiffness(ratio) - 1
        )

    def _lost(self, ratio: FloatArray) -> FloatArray:
        """What `wide` makes of k_bar."""
        stiffness = self.normalized_contact_stiffness(ratio)
        return np.abs(self.wide.normalized_contact_stiffness(ratio) / stiffness - 1)

    @cached_property
    def log_stiffness(self) -> Chebyshev:
        """ln k_bar over ln(a/h)."""
        return self._fitted(DEGREE)

    def _wide_error(self, ratio: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Relative errors of k_bar and c_bar beyond the narrow panels, shape of `ratio` each.

        What the Ritz values lack falls with the square of the ratio, so in c_bar = k_bar (1 + d ln k_bar/d ln ratio),
        whose second factor is at least two, it counts twice at most. An error of the fit counts by its slope, and what
        the fit misses at its radii by the largest slope of such a polynomial there (Bernstein's and Markov's bounds).
        """
        ratios, stiffness, lacking, _ = self._punches
        log_ratio = np.log(np.maximum(ratio, self.near.max_ratio))
        missed = np.max(np.abs(self.log_stiffness(np.log(ratios)) - np.log(stiffness)))
        samples, *misfit = self._misfit
        value, slope = (np.interp(log_ratio, samples, error) for error in misfit)
        ritz, growth = np.interp(log_ratio, np.log(ratios), lacking), 1 + self.log_stiffness.deriv()(log_ratio)
        offset, scale = self.log_stiffness.mapparms()
        steepest = DEGREE * scale / np.sqrt(np.maximum(1 - (offset + scale * log_ratio) ** 2, DEGREE**-2.0))
        return ritz + missed + value, 2 * ritz + missed + value + (slope + missed * steepest) / growth

    @cached_property
    def _misfit(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """What the fit leaves of ln k_bar and of its slope around some ln(a/h), which come first.

        Its last terms say what the fit without them leaves; from there on errors fall as they did up to there.
        """
        log_ratio = np.linspace(np.log(self.near.max_ratio), np.log(LARGEST_RATIO), SAMPLES * DEGREE)
        shorter = self._fitted(DEGREE - LAST_TERMS)
        last, before = self.log_stiffness - shorter, shorter - self._fitted(DEGREE - 2 * LAST_TERMS)
        share = min(1.0, FALL_SAFETY * float(np.max(np.abs(last(log_ratio))) / np.max(np.abs(before(log_ratio)))))
        value, slope = (share * _largest_nearby(error(log_ratio), NEARBY) for error in (last, last.deriv()))
        return log_ratio, value, slope

    def _fitted(self, degree: int) -> Chebyshev:
        """The polynomial, and that of what roundings of the least-squares problem have left in it."""
        ratios, stiffness, *_ = self._punches
        log_ratio, log_stiffness = np.log(ratios), np.log(stiffness)
        first = Chebyshev.fit(log_ratio, log_stiffness, degree)
        return first + Chebyshev.fit(log_ratio, log_stiffness - first(log_ratio), degree)

    @cached_property
    def _punches(self) -> tuple[FloatArray, FloatArray, FloatArray, dict[float, FloatArray]]:
        return _wide_punches(self.wide, UniformKernel(self.support, self.poissons_ratio))

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


@dataclass(frozen=True)
class WideSolution(IntegralEquationSolution):
    """One factor on wide panels, judged by Ritz values and by narrow panels.

    Attributes:
        lost: Relative error of its k_bar at each ratio.
        seen: Positions on a panel in [0, 1], and the largest relative error of c_bar about each. The kernel makes the
            same on every panel.
        growth: Relative error of k_bar over k_bar, besides what each panel makes.
    """

    lost: Callable[[FloatArray], FloatArray]
    seen: tuple[FloatArray, FloatArray]
    growth: float
    shares: ClassVar[FactorCoefficients] = WIDE_FACTOR

    def ending_at(self, ratio: float) -> None:
        """None: it is judged as one with the panels it has."""

    def _spring_truncation(self, ratio: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The kernel's share as it was seen at this place of a panel."""
        own, _ = super()._spring_truncation(ratio)
        return own, np.interp(self._panels.locate(ratio)[1], *self.seen)

    def relative_error(self, ratio: ArrayLike) -> FloatArray:
        """Bound of the relative error of k_bar."""
        return super().relative_error(ratio) + 2 * self.lost(np.asarray(ratio, dtype=float))

    def spring_error(self, ratio: ArrayLike) -> FloatArray:
        """Bound of the relative error of c_bar, which has twice what grows with k_bar in it."""
        return super().spring_error(ratio) + 2 * self._grown(self._covered(ratio))

    def profile_error(self, ratio: ArrayLike, start: ArrayLike = 0.0) -> FloatArray:
        """Bound of the relative error of g under any load."""
        return super().profile_error(ratio) + 2 * self._grown(self._covered(ratio))

    def error_of_profile(self, ratio: FloatArray, profile: MappedFunction, flat_radius: float) -> FloatArray:
        """What the edge values of both loads have in common cancels; the rest falls with the distance from the rim.

        The kernel errs like a polynomial that oscillates along the panel, so that of its error there is left what the
        density gains in half a wave. What comes from all panels together does not fall.
        """
        gain = gain_within(profile, ratio - flat_radius, PANEL_WIDTH / (2 * PANEL_NODES))
        return self._edge_error(self._covered(ratio), gain, self.shares.profile_safety * gain) + 2 * self._grown(ratio)

    def kernel_errors(self, ratio: FloatArray) -> FloatArray:
        """None: `error_of_profile` tells already what of them cancels in g."""
        return np.zeros((2, *np.shape(ratio)))

    def _grown(self, ratio: FloatArray) -> FloatArray:
        """Relative error of k_bar by small errors of the factor on all panels, which grows with the condition."""
        return np.asarray(self.growth * self.normalized_contact_stiffness(ratio))


def _largest_nearby(error: FloatArray, samples: int) -> FloatArray:
    """The largest absolute value within so many samples on either side."""
    padded = np.pad(np.abs(error), samples, mode="edge")
    return np.asarray(sliding_window_view(padded, 2 * samples + 1).max(axis=1))


def _wide_punches(
    wide: IntegralEquationSolution, surface: UniformKernel
) -> tuple[FloatArray, FloatArray, FloatArray, dict[float, FloatArray]]:
    """Ratios, k_bar there, its relative errors by what span and energies lack, and the densities."""
    ratios = _radii_at_panel_ends()
    punches = [_ritz_punch(trial, wide, surface) for trial in _trial_densities(wide.factor, ratios)]
    best, lacking = (np.array([punch[item] for punch in punches]) for item in (0, 1))
    densities = {float(a): punch[2] for a, punch in zip(ratios, punches, strict=True)}
    return ratios, best / ratios, lacking, densities


def _radii_at_panel_ends() -> FloatArray:
    """Panel ends nearest to the Chebyshev points of ln(a/h) from `FIRST_RATIO` to `LARGEST_RATIO`."""
    middle, half = np.log(FIRST_RATIO * LARGEST_RATIO) / 2, np.log(LARGEST_RATIO / FIRST_RATIO) / 2
    points = np.exp(middle - half * np.cos(np.pi * np.arange(RADII) / (RADII - 1)))
    return np.unique(PANEL_WIDTH * np.rint(points / PANEL_WIDTH))


def _trial_densities(factor: VolterraFactor, ratios: FloatArray) -> list[FloatArray]:
    """phi_i = A^-1 P_i(t^2/a^2) for every radius a, each of shape (RITZ_DENSITIES, panels, nodes).

    A load that ends at a leaves nothing beyond in C^-T, so one solution serves the leading sections of all radii.
    """
    panels, width = np.arange(factor.panels)[:, None], factor.panel_width
    t, root = width * (panels + gauss_nodes(factor.count)[0]).ravel(), np.sqrt(np.tile(factor.weights, factor.panels))
    inside = (t[:, None] < ratios)[..., None]
    loads = np.polynomial.legendre.legvander(2 * np.minimum(t[:, None] / ratios, 1.0) ** 2 - 1, RITZ_DENSITIES - 1)
    half = factor.lower.solve(root[:, None] * (loads * inside).reshape(t.size, -1)).reshape(loads.shape) * inside
    densities = factor.lower.solve(half.reshape(t.size, -1), transposed=True) / root[:, None]
    by_radius = np.moveaxis(densities.reshape(panels.size, -1, ratios.size, RITZ_DENSITIES), (2, 3), (0, 1))
    return [density[:, : round(a / width)] for density, a in zip(by_radius, ratios, strict=True)]


def _ritz_punch(
    trial: FloatArray, wide: IntegralEquationSolution, surface: UniformKernel
) -> tuple[float, float, FloatArray]:
    """F/(2 E*) of a flat punch pressed in by 1, its relative error, and its density.

    The error is what the last Ritz density makes, and what is left out of the energy, which is F itself.
    """
    energy = energy_matrix(trial, wide.factor.panel_width, surface.support, surface.poissons_ratio)
    load = np.sum(trial @ wide.factor.weights, axis=1)
    shares, fewer = _stationary(energy, load), _stationary(energy[:-1, :-1], load[:-1])
    force, density = float(load @ shares), np.tensordot(shares, trial, axes=1)
    lacking = abs(float(load[:-1] @ fewer) - force) + tail_left_out(density, wide.factor.panel_width)
    return force, lacking / force, density


def _stationary(energy: FloatArray, load: FloatArray) -> FloatArray:
    """G^-1 b with unit diagonal of G, since the densities differ by orders of magnitude."""
    scale = 1 / np.sqrt(np.diag(energy))
    shares: FloatArray = scale * np.linalg.solve(energy * np.multiply.outer(scale, scale), load * scale)
    return shares
