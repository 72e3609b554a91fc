"""Equilibria over the contact radius: folds, stability, what is met under a control, and where contact is lost.

Depth and force are functions of the contact radius a, from any method. Under a control q - the depth, the force or the
displacement depth + force/K of a machine of stiffness K - an equilibrium is stable where q grows with a. The whole
branch is sampled and its folds are extrema of q, so no fold is ever stepped over.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.polynomial import Chebyshev
from scipy.optimize import brentq

from contact import CriticalPoint
from contact.records.validation import BoolArray, FloatArray
from contact.scene.loading import Controlled

CONTROLS: Final[tuple[Controlled, ...]] = ("displacement", "force", "machine")
DEPTH, FORCE, MACHINE = range(3)
# Samples between two breaks, geometrically from this share of the way on: neighbours are 6 % apart. Half as many see
# the same folds of all layers known; twice as many only take longer.
SAMPLES: Final = 401
NEAREST: Final = 1e-10
# Degree of the polynomial about a fold, and the largest imaginary part of a root that counts as real.
FOLD_DEGREE: Final = 16
IMAGINARY: Final = 1e-6
# Change of q over its largest value that is rounding, and relative step beside a state that shows its stability.
ROUNDING: Final = 1e-13
ASIDE: Final = 1e-6


@dataclass(frozen=True, eq=False)
class Branch:
    """All equilibria with radii in (0, end].

    Attributes:
        values: Depth [m] and force [N], shape (2, n), at contact radii [m], shape (n,).
        breaks: Radii [m] between zero and the end where these are not smooth: rims, kinks.
        end: Largest radius [m].
        compliance: 1/K [m/N] of a machine; zero if nothing gives way.
    """

    values: Callable[[FloatArray], FloatArray]
    breaks: tuple[float, ...]
    end: float
    compliance: float = 0.0

    @property
    def controls(self) -> tuple[int, ...]:
        """All that may be controlled."""
        return (DEPTH, FORCE, MACHINE) if self.compliance else (DEPTH, FORCE)

    def controlled(self, control: int, radius: FloatArray) -> FloatArray:
        """q [m, N or m] at radii > 0 [m], shape (n,)."""
        return self._chosen(control, self.values(radius))

    def at(self, control: int, radius: float) -> float:
        """q at one radius; zero at the tip."""
        return float(self.controlled(control, np.array([radius]))[0]) if radius > 0.0 else 0.0

    def state(self, radius: float) -> tuple[float, float, float]:
        """Radius, depth and force."""
        return radius, self.at(DEPTH, radius), self.at(FORCE, radius)

    def stable(self, control: int, radius: FloatArray) -> BoolArray:
        """Whether q grows with the radius, at radii [m] below the end."""
        more, less = radius * (1.0 + ASIDE), radius * (1.0 - ASIDE)
        return np.asarray(self.controlled(control, np.minimum(more, self.end)) > self.controlled(control, less))

    def folds(self, control: int) -> list[float]:
        """Radii [m] at which q turns, increasing."""
        return self._folds[control]

    def solutions(self, control: int, value: float) -> list[float]:
        """Radii [m] of all stable equilibria with this q, increasing."""
        found = []
        for low, high in pairwise([0.0, *self.folds(control), self.end]):
            least, largest = self.at(control, low), self.at(control, high)
            if least <= value <= largest and least < largest:
                found.append(brentq(lambda a: self.at(control, a) - value, low, high, xtol=1e-15 * high))
        return found

    def loss(self, control: int, start: float) -> float:
        """Radius [m] at which a withdrawal from `start` loses contact.

        Contact holds as long as some state of smaller or equal radius bears what is prescribed: from an unstable state
        the front runs inwards to the next stable one. So it is lost at the smallest q within the start.
        """
        return min([0.0, *self._within(control, start), start], key=lambda a: self.at(control, a))

    def largest_tension(self, control: int, start: float) -> float:
        """Radius [m] of the smallest force on the way to the loss of contact.

        A jump lands under less tension than it left with.
        """
        lost = self.loss(control, start)
        if control == FORCE:
            return lost
        points = [lost, start, *(a for a in self._within(FORCE, start) if a > lost)]
        return min((a for a in points if self._is_met(control, a, start)), key=lambda a: self.at(FORCE, a))

    def critical_points(self, start: float, *, pinned: bool) -> tuple[CriticalPoint, ...]:
        """Where the front sets off, all folds on the way in, and where first touch lands.

        Args:
            start: Radius [m] from which the indenter is withdrawn.
            pinned: Whether the front rests at a sharp edge, of a flat punch, until the branch's depth is reached.
        """
        points = [(c, "start", start) for c in self.controls if pinned]
        points += [(c, self._kind(c, a), a) for c in self.controls for a in self._within(c, start)[::-1]]
        if not pinned:
            points += [(c, "snap-in", a) for c in self.controls for a in self.solutions(c, 0.0)[:1] if a > 0.0]
        return tuple(self._critical_point(*point) for point in points)

    @property
    def strength(self) -> float:
        """Largest tension at a fold [N], infinite without a fold: pressing as hard shows all of the way back."""
        folds = self.folds(FORCE)
        return max((-self.at(FORCE, a) for a in folds), default=np.inf) if folds else np.inf

    def _chosen(self, control: int, values: FloatArray) -> FloatArray:
        depth, force = values
        return np.asarray((depth, force, depth + self.compliance * force)[control])

    @cached_property
    def _samples(self) -> tuple[FloatArray, FloatArray]:
        """Radii [m], from zero on, and depth and force there."""
        ends = [0.0, *sorted(b for b in set(self.breaks) if 0.0 < b < self.end), self.end]
        # The last but one shows whether q turns just before a break or the end.
        way = np.concatenate([[0.0], np.geomspace(NEAREST, 1.0, SAMPLES), [1.0 - ASIDE]])
        radius = np.unique(np.concatenate([low + (high - low) * way for low, high in pairwise(ends)] + [ends]))
        radius = radius[radius <= self.end]
        return radius, np.concatenate([np.zeros((2, 1)), self.values(radius[1:])], axis=1)

    @cached_property
    def _folds(self) -> tuple[list[float], ...]:
        return tuple(self._extrema(control) for control in self.controls)

    def _extrema(self, control: int) -> list[float]:
        radius, values = self._samples
        q = self._chosen(control, values)
        # Where a rounding is all that changes no fold is seen.
        kept = np.append(True, np.abs(np.diff(q)) > ROUNDING * np.abs(q).max())
        radius, q = radius[kept], q[kept]
        grows = np.diff(q) > 0.0
        turns = np.flatnonzero(grows[1:] != grows[:-1]) + 1
        return [self._extremum(control, *radius[i - 1 : i + 2], grows=bool(grows[i - 1])) for i in turns]

    def _extremum(self, control: int, low: float, middle: float, high: float, *, grows: bool) -> float:
        """Between two samples, or at the middle one where the slope jumps."""
        candidates = [middle]
        for left, right in pairwise((low, middle, high) if middle in self.breaks else (low, high)):
            fit = Chebyshev.interpolate(lambda a: self.controlled(control, a), FOLD_DEGREE, [left, right])
            roots = fit.deriv().roots()
            real = roots.real[np.abs(roots.imag) < IMAGINARY * (right - left)]
            candidates += [float(a) for a in real if left < a < right]
        return (max if grows else min)(candidates, key=lambda a: self.at(control, a))

    def _within(self, control: int, start: float) -> list[float]:
        return [a for a in self.folds(control) if a < start]

    def _is_met(self, control: int, radius: float, start: float) -> bool:
        """Whether a withdrawal comes by: every state farther out has a larger q."""
        outside = [a for a in (*self._within(control, start), start) if a > radius]
        return all(self.at(control, a) >= self.at(control, radius) for a in outside)

    def _kind(self, control: int, radius: float) -> str:
        """Withdrawing, a fold is met from above: what is stable there loses its stability."""
        beyond = np.array([min(radius * (1.0 + 2.0 * ASIDE), self.end)])
        return "pull-off" if bool(self.stable(control, beyond)[0]) else "snap-in"

    def _critical_point(self, control: int, kind: str, radius: float) -> CriticalPoint:
        a, depth, force = self.state(radius)
        return CriticalPoint(
            control=CONTROLS[control], kind=kind, contact_radius=a, indentation_depth=depth, normal_force=force
        )
