"""The equilibrium branch of an adhering indenter, parametrised by the contact radius, Eqs. (40)-(46).

Along a = b + (y - y_b)^2, b the last breakpoint, depth and force are smooth functions of y: both the elongation, which
starts like sqrt(a), and g, which starts like sqrt(a - b) behind a kink. Folds are roots of polynomials, all of which
are found; nothing is stepped. MDR and boundary elements each tell depth and force, and share the rest.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import TypeAlias

import numpy as np
from numpy.polynomial import chebyshev as series
from numpy.typing import ArrayLike, NDArray

from bem.polynomials import chebyshev
from bem.polynomials.adaptive import NODES, Piecewise, SampledPanel, resolved_panels
from bem.polynomials.root_steps import MOST_STEPS
from contact.records.validation import FloatArray

DEPTH, FORCE = 0, 1
# Share of the largest y below which depth and force have left the tip with a known sign; chosen.
_TIP = 1e-5
# How far outside its panel a root may lie, and how close two of them are one, for roundings make up pairs where a
# section begins with no slope. Whether it is one is decided by the signs beside it. Chosen.
_EDGE = 1e-6
# Relative Newton step that ends an inversion: a step this short has squared its error already.
_ROUNDING = 1e-13
# Relative rounding of a position: half of its own, half of the middle of its panel.
EPS = float(np.finfo(float).eps)

# Depth [m] and force [N], shape (2, n), from the radius [m] where a section begins and how far beyond it [m].
Sampler: TypeAlias = Callable[[float, FloatArray], FloatArray]


@dataclass(frozen=True)
class EquilibriumBranch:
    """Depth and force of all equilibria up to a largest radius: folds, stability, inversion.

    Attributes:
        functions: delta, F, and their first and second derivatives by y.
        coefficients: Chebyshev coefficients of the two slopes, shape (count, 2, panels).
        section_ends: y at zero, at the breakpoints and at the largest radius, shape (sections + 1,).
        section_radii: a [m] there.
        tails: What the polynomials of each panel leave out of delta [m] and F [N], shape (2, panels).
        rounding: What the rounding of y moves in them, shape (2, panels).
    """

    functions: Piecewise
    coefficients: FloatArray
    section_ends: FloatArray
    section_radii: FloatArray
    tails: FloatArray
    rounding: FloatArray

    @classmethod
    def sampled(
        cls,
        sample: Sampler,
        *,
        breakpoints: tuple[float, ...],
        radius: float,
        error: float = 0.0,
        seams: ArrayLike = (),
    ) -> EquilibriumBranch:
        """All equilibria with contact radii in (0, radius].

        Args:
            sample: Depth and force of the equilibria.
            breakpoints: Radii [m] where the profile is not analytic, its flat end included.
            radius: Largest contact radius [m].
            error: Relative error of the samples.
            seams: Radii [m] at which the samples pass from one polynomial to another.

        Raises:
            NotConvergedError: If the samples are rougher than that.
        """
        radii = np.array([0.0, *(b for b in sorted(set(breakpoints)) if 0.0 < b < radius), radius])
        ends = np.concatenate([[0.0], np.cumsum(np.sqrt(np.diff(radii)))])
        panels: list[SampledPanel] = []
        for start, low, high in zip(radii, ends, ends[1:], strict=False):
            beyond = np.sqrt(np.maximum(np.asarray(seams, dtype=float) - start, 0.0))
            panels += resolved_panels(_section(sample, start, low), low, high, error, low + beyond)
        # Of shape (panels, 2, nodes).
        values = np.stack([panel.values @ chebyshev.analysis(NODES).T for panel in panels])
        derivative = chebyshev.differentiation(NODES).T / np.array([panel.half for panel in panels])[:, None, None]
        slopes = values @ derivative
        rows = np.transpose(np.concatenate([values, slopes, slopes @ derivative], axis=1), (2, 1, 0))
        return cls(
            functions=Piecewise.of(panels, rows),
            coefficients=rows[:, 2:4],
            section_ends=ends,
            section_radii=radii,
            tails=np.array([panel.tails for panel in panels]).T,
            rounding=EPS * ends[-1] * _steepest(panels),
        )

    def radius(self, y: FloatArray) -> FloatArray:
        """a [m] at y."""
        return self.excess(y, 0.0)

    def excess(self, y: FloatArray, flat_radius: float) -> FloatArray:
        """a - b [m] at y over the radius b of a flat end, with the digits that the rounded a loses close to it."""
        section = self._section(y)
        return np.asarray((self.section_radii[section] - flat_radius) + (y - self.section_ends[section]) ** 2)

    def position(self, radius: FloatArray) -> FloatArray:
        """The y of contact radii [m]."""
        section = np.clip(np.searchsorted(self.section_radii, radius, side="right") - 1, 0, self.section_ends.size - 2)
        return np.asarray(self.section_ends[section] + np.sqrt(radius - self.section_radii[section]))

    def truncation(self, y: FloatArray) -> FloatArray:
        """What the polynomials leave out of delta [m] and F [N] at y, and roundings of y, shape (2, n)."""
        return np.asarray((self.tails + self.rounding)[:, self.functions.panel(y)])

    def through_machine(self, compliance: float) -> EquilibriumBranch:
        """The branch with the displacement delta + F/K of a machine in place of the depth; its compliance is 1/K."""
        powers, coefficients, tails = self.functions.powers.copy(), self.coefficients.copy(), self.tails.copy()
        powers[:, 0::2] += compliance * powers[:, 1::2]
        coefficients[:, DEPTH] += compliance * coefficients[:, FORCE]
        tails[DEPTH] += compliance * tails[FORCE]
        rounding = np.array([self.rounding[DEPTH] + compliance * self.rounding[FORCE], self.rounding[FORCE]])
        functions = replace(self.functions, powers=powers)
        return replace(self, functions=functions, coefficients=coefficients, tails=tails, rounding=rounding)

    def _section(self, y: FloatArray) -> NDArray[np.intp]:
        return np.clip(np.searchsorted(self.section_ends, y, side="right") - 1, 0, self.section_ends.size - 2)

    def values(self, y: FloatArray) -> FloatArray:
        """delta [m] and F_N [N], shape (2, n)."""
        return self.functions(y, slice(2))

    def slopes(self, y: FloatArray) -> FloatArray:
        """d(delta)/dy and dF/dy; a state is stable under prescribed depth, or force, where they are positive."""
        return self.functions(y, slice(2, 4))

    def curvatures(self, y: FloatArray) -> FloatArray:
        """Second derivatives of depth and force by y."""
        return self.functions(y, slice(4, 6))

    def folds(self, quantity: int) -> FloatArray:
        """All y > 0 where the slope of depth or force changes sign, increasing."""
        return self._folds[quantity]

    def solutions(self, quantity: int, target: FloatArray) -> FloatArray:
        """For each target the smallest y on a stable part of the branch with that depth or force; NaN where none."""
        found = np.full(target.shape, np.nan)
        # From the outermost part inwards, so that the smallest is written last.
        for part in self.stable_solutions(quantity, target)[::-1]:
            found = np.where(np.isnan(part), found, part)
        return found

    def stable_solutions(self, quantity: int, target: FloatArray) -> FloatArray:
        """The y of each target on each stable part of the branch, from the tip outwards, shape (parts, n); or NaN."""
        ends = np.concatenate([[0.0], self.folds(quantity), self.section_ends[-1:]])
        found = []
        for low, high in pairwise(ends.tolist()):
            if self.slopes(np.array([0.5 * (low + high)]))[quantity, 0] > 0.0:
                # What lies in a step of rounded or fitted values at a kink is held there.
                before, least, largest = self.values(np.array([np.nextafter(low, 0.0), low, high]))[quantity]
                inside = (target >= min(before, least)) & (target <= largest)
                found.append(np.full(target.shape, np.nan))
                found[-1][inside] = self._inverted(quantity, target[inside], low, high)
        return np.array(found).reshape(-1, *target.shape)

    @property
    def strength(self) -> float:
        """Largest tension at a fold [N], infinite if there is none: pressing as hard shows all of the way back."""
        folds = self.folds(FORCE)
        return -float(self.values(folds)[FORCE].min(initial=0.0)) if folds.size else np.inf

    @cached_property
    def _folds(self) -> tuple[FloatArray, ...]:
        kinks, both = self.section_ends[1:-1], (DEPTH, FORCE)
        return tuple(self._sign_changes(np.concatenate([kinks, self._jumps(q), *self._roots(q)]), q) for q in both)

    def _jumps(self, quantity: int) -> FloatArray:
        """Where the slope changes sign from one panel to the next, so that neither has a root."""
        own = self.coefficients[:, quantity]
        before, after = own.sum(axis=0)[:-1], np.asarray(series.chebval(-1.0, own))[1:]
        return np.asarray(self.functions.edges[1:-1][before * after < 0.0])

    def _roots(self, quantity: int) -> list[FloatArray]:
        """Real roots of the slope on every panel where its mean does not exclude them."""
        own = self.coefficients[:, quantity]
        doubtful = np.flatnonzero(np.abs(own[0]) <= np.abs(own[1:]).sum(axis=0))
        return [self._panel_roots(own[:, i], int(i)) for i in doubtful]

    def _panel_roots(self, coefficients: FloatArray, panel: int) -> FloatArray:
        size = np.abs(coefficients).max()
        if size == 0.0:
            return np.empty(0)
        roots = series.chebroots(series.chebtrim(coefficients, 1e-15 * size))
        z = roots.real[(np.abs(roots.imag) < _EDGE) & (np.abs(roots.real) < 1.0 + _EDGE)]
        slope = series.chebder(coefficients)
        # A double root has no slope: it is no change of sign and stays where it is.
        with np.errstate(divide="ignore", invalid="ignore"):
            polished = z - series.chebval(z, coefficients) / series.chebval(z, slope)
        z = np.where(np.abs(polished - z) < _EDGE, polished, z)
        return np.asarray(self.functions.centres[panel] + z / self.functions.scales[panel])

    def _sign_changes(self, candidates: FloatArray, quantity: int) -> FloatArray:
        end = self.section_ends[-1]
        inside = candidates[(candidates > _TIP * end) & (candidates < end)]
        points = np.sort(np.concatenate([[0.0], inside, [end]]))
        points = points[np.append(True, np.diff(points) > _EDGE * points[-1])]
        signs = np.sign(self.slopes(0.5 * (points[1:] + points[:-1]))[quantity])
        return np.asarray(points[1:-1][signs[1:] != signs[:-1]])

    def _inverted(self, quantity: int, target: FloatArray, low: float, high: float) -> FloatArray:
        """The y of each target on a part where the quantity increases; a Newton step out of its bracket is halved."""
        left, right = np.full(target.shape, low), np.full(target.shape, high)
        y = 0.5 * (left + right)
        for _ in range(MOST_STEPS):
            both = self.functions(y, slice(4))
            excess, slope = both[quantity] - target, both[2 + quantity]
            left, right = np.where(excess <= 0.0, y, left), np.where(excess >= 0.0, y, right)
            step = y - excess / np.where(slope > 0.0, slope, np.inf)
            new = np.where((step >= left) & (step <= right) & (slope > 0.0), step, 0.5 * (left + right))
            if np.all(np.abs(new - y) <= _ROUNDING * high):
                return np.asarray(new)
            y = new
        return np.asarray(y)


def _steepest(panels: list[SampledPanel]) -> FloatArray:
    """Slopes by y, shape (2, panels): a section beside a flat end hardly outgrown is short and steep."""
    return np.array([np.ptp(panel.values, axis=1) / (2.0 * panel.half) for panel in panels]).T


def _section(sample: Sampler, start: float, low: float) -> Callable[[FloatArray], FloatArray]:
    """Depth and force by y along the section that begins at the radius `start`, where y = low."""
    return lambda y: sample(start, (y - low) ** 2)
