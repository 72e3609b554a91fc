"""Depth under a prescribed force.

Forces f of a spring and displacements u of its end obey u = J * df with the compliance J, in contact or free, so their
sums do: the springs' displacements, each times its stiffness, add up to F_e = J * dF, a sum of exponentials while F
moves linearly. No end of a spring stands above the indenter, and a free one only creeps back. So where F_e has never
been larger all springs ever touched are touched, and F_e is the elastic force of the depth (Lee and Radok 1960,
J. Appl. Mech. 27, 438; Ting 1966, J. Appl. Mech. 33, 845).

Elsewhere the depth is less than F_e would make it. There it is a quadratic in time on each substep, whose two
coefficients follow from the sum of displacements at the middle and at the end of the substep,

    2 E* int u(x, t) y_1^2(x) dx = F_e(t),   u = delta - g in contact.

Springs in contact take part with their depth alone, whatever the path to it, so that substeps err only by what free
springs keep of it. Panels of springs end at the fronts of the last march, so that these sums are Gauss rules, and the
march is repeated until the depth stays.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.numerics import EPS
from contact import ForceHistory, NotConvergedError
from contact.records.validation import FloatArray
from mdr.history.spring_bed import Path, SpringBed, followed
from mdr.history.spring_law import SpringLaw

# Times as many substeps where the depth is known: they cost little, and what springs keep of them is as accurate.
_MORE = 3
# Newton steps of a substep; five are usual.
_MOST_STEPS = 60
# Share of the largest F_e to which it is met, and that may be missed.
_TOLERANCE, _ACCEPTABLE = 1e-13, 1e-9
# Springs among which the lowest is sought, and how often: each round comes twenty times closer.
_AMONG, _ROUNDS = 41, 4
# Share of all springs whose stiffness starts a substep in which hardly any touch.
_LEAST = 1e-3


class Steps(NamedTuple):
    """Instants at which depths are determined: two per substep.

    Attributes:
        time: [s], shape (1 + 2 substeps,).
        force: F there [N].
        given: Indices of the instants of the history, shape (n,).
    """

    time: FloatArray
    force: FloatArray
    given: NDArray[np.intp]


def steps_of(law: SpringLaw, loading: ForceHistory, substeps: int, times: int) -> Steps:
    """Substeps of each interval, shorter after each change of rate and before a release.

    Args:
        law: Of the springs.
        loading: The force.
        substeps: Number of them. Half are shared out by duration, half to all intervals alike: short ones may be steep.
        times: Multiplies the number in each interval.
    """
    durations = np.diff(loading.time)
    share = (durations / durations.sum() + 1 / durations.size) / 2
    load = law.elastic_force(loading.time, loading.force)
    closed = never_larger(law, load)
    counts = times * np.maximum(np.ceil(substeps * share), 2).astype(int)
    instants = [loading.time[:1]]
    for k, fewest in enumerate(counts.tolist()):
        count = fewest * (_MORE if closed[k] and closed[k + 1] else 1)
        s = np.arange(count + 1) / count
        fades = loading.force[k + 1] <= 0 < loading.force[k]
        way = s * s * (6 - 8 * s + 3 * s * s) if fades else s**1.5 if load[k] > 0 else s**4
        ends = loading.time[k] + durations[k] * way
        ends[-1] = loading.time[k + 1]
        counts[k] = count
        instants.append(np.column_stack([(ends[:-1] + ends[1:]) / 2, ends[1:]]).ravel())
    time = np.concatenate(instants)
    given = np.append(0, 2 * np.cumsum(counts))
    return Steps(time, np.interp(time, loading.time, loading.force), given)


def never_larger(law: SpringLaw, load: FloatArray) -> NDArray[np.bool_]:
    """At which instants F_e [N] has never been larger, but for rounding, shape (n,)."""
    rounding = EPS * (load.size + 4.0 * (law.times.size + 1))
    return np.asarray(load >= np.maximum.accumulate(load) * (1 - rounding))


@dataclass
class March:
    """Depths under a force on one bed of springs.

    Attributes:
        law: Of the springs.
        bed: The springs.
        weight: Stiffness of each in contact [N/m], shape (n,).
        steps: Instants and forces.
        load: F_e [N] at the instants.
        closed: Depths [m] of the elastic layer under it.
        known: Where these are the depths, of the same shape.
        before: The path of an earlier march, from which each substep starts.
    """

    law: SpringLaw
    bed: SpringBed
    weight: FloatArray
    steps: Steps
    load: FloatArray
    closed: FloatArray
    known: NDArray[np.bool_]
    before: Path | None = None

    def path(self) -> Path:
        """Depths at all instants.

        Raises:
            NotConvergedError: If no depth carries the force.
        """
        time, count = self.steps.time, self.steps.time.size
        depth, speed, acceleration = np.zeros(count), np.zeros(count - 1), np.zeros(count - 1)
        free, pace = np.zeros(count - 1, dtype=np.bool_), np.zeros(2)
        depth[0] = self.closed[0]
        for k in range(0, count - 1, 2):
            first, whole = float(time[k + 1] - time[k]), float(time[k + 2] - time[k])
            if not self.known[k + 1 : k + 3].all() and self.steps.force[k + 2] <= 0:
                free[k : k + 2], pace = True, np.zeros(2)
                for i, span in ((k + 1, first), (k + 2, whole - first)):
                    self.bed.release(span)
                    depth[i] = np.min(self.bed.surface + self.bed.g)
                continue
            if self.known[k + 1 : k + 3].all():
                risen = (self.closed[k + 1 : k + 3] - depth[k]) / [first, whole]
                a = 2 * (risen[1] - risen[0]) / (whole - first)
                pace = np.array([risen[1] - whole * a / 2, a])
                _, self.bed = self._displaced(float(depth[k]), pace, (first, whole))
            else:
                if self.before is not None and not self.before.free[k]:
                    pace = np.array([self.before.speed[k], self.before.acceleration[k]])
                pace, self.bed = self._met(float(depth[k]), pace, self.load[k + 1 : k + 3], (first, whole))
            v, a = pace
            speed[k : k + 2], acceleration[k : k + 2] = (v, v + a * first), a
            depth[k + 1 : k + 3] = depth[k] + first * (v + first * a / 2), depth[k] + whole * (v + whole * a / 2)
            pace = np.array([v + a * whole, 0.0])
        return Path(time, depth, speed, acceleration, free)

    def _displaced(self, depth: float, pace: FloatArray, spans: tuple[float, float]) -> tuple[FloatArray, SpringBed]:
        """F_e [N] at the middle and the end of a substep and stiffness in contact [N/m], shape (2, 2), and the bed."""
        bed, (v, a), found, before = self.bed.copy(), pace.tolist(), np.empty((2, 2)), 0.0
        for i, span in enumerate(spans):
            bed.advance(depth + before * (v + before * a / 2), (v + a * before, a), span - before)
            found[:, i] = self.weight @ bed.surface, self.weight @ bed.touching
            before = span
        return found, bed

    def _met(
        self, depth: float, pace: FloatArray, target: FloatArray, spans: tuple[float, float]
    ) -> tuple[FloatArray, SpringBed]:
        """Speed and acceleration that meet F_e [N] twice, by Newton's rule with Broyden's corrections, and the bed."""
        largest, t = float(self.load.max()), np.array(spans)
        scale = np.array([1 / t[1], 2 / t[1] ** 2])  # unknowns are parts of the way [m]
        ways = np.column_stack([t * scale[0], t * t / 2 * scale[1]])
        x, slopes, before, best = pace / scale, np.empty((2, 2)), np.zeros(2), (np.inf, pace, self.bed)
        move = np.zeros(2)
        for number in range(_MOST_STEPS):
            (reached, stiffness), bed = self._displaced(depth, x * scale, spans)
            missed = reached - target
            worst = float(np.abs(missed).max()) / largest
            if worst < best[0]:
                best = worst, x * scale, bed
            if worst <= _TOLERANCE:
                break
            if number == 0:
                slopes = np.maximum(stiffness, _LEAST * self.weight.sum())[:, None] * ways
            else:
                slopes += np.outer(missed - before - slopes @ move, move) / (move @ move)
            move = -np.linalg.solve(slopes, missed)
            move *= min(1.0, 0.3 * self.bed.g.max() / max(float(np.abs(move).max()), 1e-300))
            if float(np.abs(move).max()) <= EPS * abs(depth):
                break
            x, before = x + move, missed
        if best[0] > _ACCEPTABLE:
            raise NotConvergedError("no depth carries the prescribed force", {"force": best[0]})
        return best[1], best[2]


def resting_depth(law: SpringLaw, g: FloatArray, path: Path, k: int) -> float:
    """Depth [m] of an indenter that rests on the surface at a free instant k: the least u + g.

    Args:
        law: Of the springs.
        g: Springs to begin with [m], increasing.
        path: Depths.
        k: Number of the instant.
    """
    until = Path(path.time[: k + 1], path.depth[: k + 1], path.speed[:k], path.acceleration[:k], path.free[:k])
    for _ in range(_ROUNDS):
        *_, bed = followed(law, g, until)
        height = bed.surface + g
        lowest = int(height.argmin())
        g = np.linspace(g[max(lowest - 1, 0)], g[min(lowest + 1, g.size - 1)], _AMONG)
    return float(height.min())
