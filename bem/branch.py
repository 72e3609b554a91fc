"""Equilibria over the contact radius: folds, stability, path of a withdrawal, loss of contact, Eqs. (40)-(46).

Depth and force are functions of the contact radius a, from springs or from discs of cells. The controlled quantity q is
the depth, the force, or the displacement depth + force/K of a machine of stiffness K. An equilibrium is stable where q
increases with a. With a = b + (y - y_b)^2, b the last breakpoint, depth and force are smooth functions of y, although
the elongation starts like sqrt(a), and g starts like sqrt(a - b) at a kink. Folds are all roots of polynomials in y.

In a slow withdrawal contact persists while some state of smaller or equal radius has the prescribed q, since the front
of an unstable state moves inwards to the next stable one. So contact is lost at the smallest q of all smaller radii.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, reduce
from itertools import pairwise
from typing import Final, TypeAlias

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from bem.piecewise import Piecewise
from contact import CriticalPoint
from contact.records.validation import BoolArray, FloatArray
from contact.scene.loading import Controlled

CONTROLS: Final[tuple[Controlled, ...]] = ("displacement", "force", "machine")
DEPTH, FORCE, MACHINE = range(3)
# y over its largest value below which folds are ignored: closer to the tip rounding errors dominate.
TIP: Final = 1e-5
# Distance over half a panel by which a root may lie outside of it, and below which two roots coincide. A hundredth of
# it treats rounding errors as folds where a section begins with zero slope.
EDGE: Final = 1e-6
# Largest number of steps of a bracketed inversion; bisection alone needs 53.
MOST_STEPS: Final = 60

# Depth [m] and force [N], shape (2, n), at radii b + d: b [m] at the start of a section, d [m] beyond it, shape (n,).
Sampler: TypeAlias = Callable[[float, FloatArray], FloatArray]


@dataclass(frozen=True, eq=False)
class Branch:
    """All equilibria with contact radii in (0, radii[-1]].

    Attributes:
        functions: Depth [m], force [N] and displacement of the machine [m] over y.
        section_ends: y at zero, at the breakpoints and at the largest radius, shape (sections + 1,).
        radii: a [m] at `section_ends`.
        compliance: 1/K [m/N] of a machine; zero without a machine.
    """

    functions: Piecewise
    section_ends: FloatArray
    radii: FloatArray
    compliance: float

    @classmethod
    def sampled(
        cls, sample: Sampler, breakpoints: tuple[float, ...], radius: float, error: float = 0.0, compliance: float = 0.0
    ) -> Branch:
        """All equilibria up to a contact radius.

        Args:
            sample: Returns depth [m] and force [N] of the equilibria.
            breakpoints: Radii [m] where the profile is not analytic, its flat end included.
            radius: Largest contact radius [m].
            error: Relative error of the samples.
            compliance: 1/K [m/N] of a machine.

        Raises:
            NotConvergedError: If the errors of the samples exceed `error`.
        """

        def section(start: float, low: float, high: float) -> Piecewise:
            """Depth, force and displacement of the machine over y in [low, high], at a = start + (y - low)^2."""

            def values(y: FloatArray) -> FloatArray:
                depth, force = sample(start, (y - low) ** 2)
                return np.stack([depth, force, depth + compliance * force])

            # Short sections between many breakpoints are smooth.
            return Piecewise.resolved(values, low, high, error, parts=max(1, 4 // (radii.size - 1)))

        radii = np.array([0.0, *(b for b in sorted(set(breakpoints)) if 0.0 < b < radius), radius])
        ends = np.concatenate([[0.0], np.cumsum(np.sqrt(np.diff(radii)))])
        sections = (section(*part) for part in zip(radii.tolist(), ends[:-1].tolist(), ends[1:].tolist(), strict=False))
        return cls(reduce(Piecewise.followed_by, sections), ends, radii, compliance)

    @property
    def end(self) -> float:
        """y at the largest radius."""
        return float(self.section_ends[-1])

    @property
    def controls(self) -> tuple[int, ...]:
        """Indices in `functions` of the quantities that may be controlled."""
        return (DEPTH, FORCE, MACHINE) if self.compliance else (DEPTH, FORCE)

    def radius(self, y: FloatArray, flat_radius: float = 0.0) -> FloatArray:
        """Contact radius a [m] at y, or a - flat_radius [m] without cancellation, shape (n,)."""
        section = np.clip(self.section_ends.searchsorted(y, side="right") - 1, 0, self.radii.size - 2)
        excess = (self.radii[section] - flat_radius) + (y - self.section_ends[section]) ** 2
        return np.asarray(np.minimum(excess, self.radii[-1] - flat_radius))

    def position(self, radius: FloatArray) -> FloatArray:
        """y at contact radii [m], shape (n,)."""
        section = np.clip(self.radii.searchsorted(radius, side="right") - 1, 0, self.radii.size - 2)
        return np.asarray(self.section_ends[section] + np.sqrt(np.maximum(radius - self.radii[section], 0.0)))

    def values(self, y: FloatArray) -> FloatArray:
        """Depth [m] and force [N] at y, shape (2, n)."""
        return self.functions(y)[:MACHINE]

    def at(self, control: int, y: float) -> float:
        """q [m, N or m] at y: zero at y = 0; at a breakpoint the limit from smaller radii."""
        return float(self.functions(np.array([y]))[control, 0]) if y > 0.0 else 0.0

    def state(self, y: float) -> tuple[float, float, float]:
        """Contact radius [m], depth [m] and force [N] at y."""
        return float(self.radius(np.array([y]))[0]), self.at(DEPTH, y), self.at(FORCE, y)

    def stable(self, control: int, y: FloatArray) -> BoolArray:
        """Whether q increases with the radius at y, so that the equilibrium is stable, shape (n,)."""
        return np.asarray(self.functions.slope(y)[control] > 0.0)

    def folds(self, control: int) -> list[float]:
        """All y > 0 where dq/dy changes its sign, increasing."""
        return self._folds[control]

    def solutions(self, control: int, target: FloatArray) -> FloatArray:
        """y with q = target on each stable part of the branch, from the tip outwards, or NaN, shape (parts, n)."""
        places = []
        for low, high in pairwise([0.0, *self.folds(control), self.end]):
            if self.stable(control, np.array([0.5 * (low + high)]))[0]:
                # Values may jump by rounding at a breakpoint; for targets within the jump it is the solution.
                ends = self.functions(np.array([low, np.nextafter(low, high), high]))[control]
                inside = (target >= ends[:2].min()) & (target <= ends[2])
                places.append(np.full(target.shape, np.nan))
                places[-1][inside] = self._inverted(control, target[inside], low, high)
        return np.array(places).reshape(-1, *target.shape)

    def smallest(self, control: int, target: FloatArray) -> FloatArray:
        """Smallest y of a stable equilibrium with each q, shape (n,); NaN where there is none."""
        return np.asarray(np.fmin.reduce(self.solutions(control, target), axis=0, initial=np.nan))

    def widest(self, control: int, target: float) -> float:
        """Largest radius [m] of a stable equilibrium with q = target, or of the whole branch if there is none."""
        y = self.solutions(control, np.array([target]))
        widest = np.fmax.reduce(y, axis=0, initial=np.nan)
        return float(self.radius(np.where(np.isnan(widest), self.end, widest))[0])

    @property
    def strength(self) -> float:
        """Largest tension at a fold [N], infinite without a fold."""
        return max((-self.at(FORCE, y) for y in self.folds(FORCE)), default=np.inf)

    def loss(self, control: int, start: float) -> float:
        """y at which a withdrawal from y = start loses contact."""
        return min([0.0, *self._within(control, start), start], key=lambda y: self.at(control, y))

    def largest_tension(self, control: int, start: float) -> float:
        """y of the largest tension (smallest force) in a withdrawal from y = start, up to the loss of contact.

        States that jumps of the front skip do not count.
        """
        lost = self.loss(control, start)
        if control == FORCE:
            return lost
        points = [lost, start, *(y for y in self._within(FORCE, start) if y > lost)]
        return min((y for y in points if self._is_met(control, y, start)), key=lambda y: self.at(FORCE, y))

    def pull_off(self, control: int, start: float) -> dict[str, float]:
        """State at the loss of contact, and largest tension before it, with the names of a `DetachmentPath`."""
        radius, depth, force = self.state(self.loss(control, start))
        return {
            "pull_off_force": self.at(FORCE, self.largest_tension(control, start)),
            "pull_off_depth": depth,
            "pull_off_contact_radius": radius,
            "force_at_loss": force,
        }

    def critical_points(self, start: float, *, pinned: bool) -> tuple[CriticalPoint, ...]:
        """All folds at radii below the start, and the start of a flat punch, or of others the state after snap-in.

        Args:
            start: y from which the indenter is withdrawn.
            pinned: Whether the edge of the contact is first fixed at that of a flat punch.
        """
        points = [(c, "start", start) for c in self.controls if pinned]
        points += [(c, self._kind(c, y), y) for c in self.controls for y in self._within(c, start)[::-1]]
        if not pinned:
            landings = [(c, float(self.smallest(c, np.zeros(1))[0])) for c in self.controls]
            points += [(c, "snap-in", y) for c, y in landings if y > 0.0]
        states = ((c, kind, *self.state(y)) for c, kind, y in points)
        return tuple(
            CriticalPoint(control=CONTROLS[c], kind=kind, contact_radius=a, indentation_depth=depth, normal_force=force)
            for c, kind, a, depth, force in states
        )

    def _within(self, control: int, start: float) -> list[float]:
        return [y for y in self.folds(control) if y < start]

    def _is_met(self, control: int, y: float, start: float) -> bool:
        """Whether a withdrawal reaches the state at y: all states of larger radius up to the start have a larger q."""
        outside = [fold for fold in (*self._within(control, start), start) if fold > y]
        return all(self.at(control, fold) >= self.at(control, y) for fold in outside)

    def _kind(self, control: int, y: float) -> str:
        """Kind of a fold: "pull-off" if the states of slightly larger radius are stable, else "snap-in"."""
        return "pull-off" if bool(self.stable(control, np.array([y * (1.0 + EDGE)]))[0]) else "snap-in"

    @cached_property
    def _folds(self) -> tuple[list[float], ...]:
        return tuple(self._turns(control) for control in self.controls)

    def _turns(self, control: int) -> list[float]:
        """y of breakpoints and roots of dq/dy at which dq/dy changes its sign, increasing."""
        points = np.concatenate([self.section_ends[1:-1], *self._roots(control)])
        inside = points[(points > TIP * self.end) & (points < self.end)]
        points = np.sort(np.concatenate([[0.0], inside, [self.end]]))
        points = points[np.append(True, np.diff(points) > EDGE * self.end)]
        grows = self.stable(control, 0.5 * (points[1:] + points[:-1]))
        return list(points[1:-1][grows[1:] != grows[:-1]].tolist())

    def _roots(self, control: int) -> list[FloatArray]:
        """y of sign changes of dq/dy between panels, and of its roots in panels whose coefficients allow a root."""
        slope, edges = self.functions.slope.series[:, control], self.functions.edges
        before, after = slope.sum(axis=0)[:-1], np.asarray(chebyshev.chebval(-1.0, slope))[1:]
        possible: NDArray[np.intp] = np.flatnonzero(np.abs(slope[0]) <= np.abs(slope[1:]).sum(axis=0))
        return [edges[1:-1][before * after < 0.0], *(_roots(slope[:, i], *edges[i : i + 2]) for i in possible)]

    def _inverted(self, control: int, target: FloatArray, low: float, high: float) -> FloatArray:
        """y with q = target on a part [low, high] where q increases, by Newton's method within a bracket."""
        low_end, high_end = np.full(target.shape, low), np.full(target.shape, high)
        y = 0.5 * (low_end + high_end)
        for _ in range(MOST_STEPS):
            excess, slope = self.functions(y)[control] - target, self.functions.slope(y)[control]
            low_end, high_end = np.where(excess <= 0.0, y, low_end), np.where(excess >= 0.0, y, high_end)
            step = y - excess / np.where(slope > 0.0, slope, np.inf)
            before, y = (
                y,
                np.where((step >= low_end) & (step <= high_end) & (slope > 0.0), step, 0.5 * (low_end + high_end)),
            )
            if np.all(np.abs(y - before) <= 1e-13 * high):
                break
        return np.asarray(y)


def _roots(series: FloatArray, low: float, high: float) -> FloatArray:
    """Real roots of a Chebyshev series on the panel [low, high], improved by one Newton step."""
    size = np.abs(series).max()
    if size == 0.0:
        return np.empty(0)
    roots = chebyshev.chebroots(chebyshev.chebtrim(series, 1e-15 * size))
    z = roots.real[(np.abs(roots.imag) < EDGE) & (np.abs(roots.real) < 1.0 + EDGE)]
    # At a double root the slope is zero. It is no change of sign, and is not improved.
    with np.errstate(divide="ignore", invalid="ignore"):
        step = chebyshev.chebval(z, series) / chebyshev.chebval(z, chebyshev.chebder(series))
    return np.asarray(0.5 * (low + high) + 0.5 * (high - low) * (z - np.where(np.abs(step) < EDGE, step, 0.0)))
