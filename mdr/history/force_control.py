"""Depth under a prescribed force.

Forces f of a spring and displacements u of its end obey u = J * df with the compliance J, in contact or free, so their
sums do: the springs' displacements, each times its stiffness, add up to F_e = J * dF, a sum of exponentials while F
moves linearly. No end of a spring stands above the indenter, and a free one only creeps back. So where F_e has never
been larger all springs ever touched are touched, and F_e is the elastic force of the depth (Lee and Radok 1960,
J. Appl. Mech. 27, 438; Ting 1966, J. Appl. Mech. 33, 845).

Elsewhere the depth is less than F_e would make it. There it is a polynomial in time on each substep, whose values at
Chebyshev's points t_i follow from the sums of displacements at these instants,

    2 E* int u(x, t_i) y_1^2(x) dx = F_e(t_i),   u = delta - g in contact.

Springs in contact take part with their depth alone, whatever the path to it. Panels of springs end at the fronts of the
last march, so that these sums are Gauss rules, and the march is repeated until the depth converges: the sum is
stationary in the fronts.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.numerics import EPS
from contact import ForceHistory, NotConvergedError
from contact.records.validation import FloatArray
from mdr.history.fronts import Layout
from mdr.history.spring_bed import Path, SpringBed, followed
from mdr.history.spring_law import SpringLaw

# Samples of F_e in all intervals of a history and in each, and refinements by 16 of its turns. An error of a turn of
# 1e-6 of the interval changes the depth by 1e-9.
_SAMPLES, _MOST_SAMPLES, _ZOOMS = 2000, 33, 5
# Distance over the length of an interval below which a turn coincides with its end.
_APART = 1e-6
# Largest numbers of corrections of a substep, and of halvings of a correction; eight and none are usual.
_MOST_STEPS, _MOST_HALVINGS = 60, 6
# Relative tolerance of F_e, and the largest error that is accepted, which is stated. Before a contact ends free springs
# alone may exceed F_e by the accumulated errors.
_TOLERANCE, _ACCEPTABLE = 1e-13, 1e-5
# Springs among which the lowest is selected, and number of refinements, each by a factor of twenty.
_AMONG, _ROUNDS = 41, 4
# Least stiffness for corrections, over that of all springs, in substeps in which hardly any touch.
_LEAST = 1e-3
# Ratio of neighbouring substeps while a force decreases to zero; the second half of the interval has twice as many as
# the degree. With half of these the error is 1e-4.
_SHORTER = 0.35


class Steps(NamedTuple):
    """Substeps of a force history.

    Attributes:
        time: Ends of substeps [s], shape (n + 1,).
        force: F [N] at `time`.
        given: Indices of the instants of the history.
        nodes: Shares of a substep at which depths are determined, shape (q,).
        instants: Nodes of all substeps [s], shape (n, q).
        load: F_e [N] at `instants`, shape (n, q).
        start: F_e [N] at the first instant.
        from_rises: Matrix from depth increases at the nodes to coefficients of a polynomial in the share of a substep,
            without the constant, shape (q, q).
    """

    time: FloatArray
    force: FloatArray
    given: NDArray[np.intp]
    nodes: FloatArray
    instants: FloatArray
    load: FloatArray
    start: float
    from_rises: FloatArray

    def ways(self, depth: FloatArray) -> FloatArray:
        """Coefficients of the depth in substeps [m], from depths at the first instant and all nodes."""
        start, inner = depth[:: self.nodes.size][:-1, None], depth[1:].reshape(-1, self.nodes.size)
        return np.column_stack([start, (inner - start) @ self.from_rises.T])


def steps_of(law: SpringLaw, loading: ForceHistory, substeps: int, degree: int) -> Steps:
    """Substeps of each interval, and of its parts before and after a turn of F_e.

    Args:
        law: Law of the springs.
        loading: The force.
        substeps: Their number. Half are distributed by duration, half equally: short intervals may be steep.
        degree: Degree of the depth in each substep.
    """
    ends = np.sort(np.append(loading.time, turns(law, loading)))
    force = np.interp(ends, loading.time, loading.force)
    load = law.elastic_force(ends, force)
    durations = np.diff(ends)
    share = (durations / durations.sum() + 1 / durations.size) / 2
    time = [ends[:1]]
    for k, count in enumerate(np.ceil(substeps * share).astype(int).tolist()):
        s = np.arange(1, count + 1) / count
        way = s**2 if min(load[k], force[k]) > 0 else s**4
        if force[k + 1] <= 0:
            ends_at_zero = np.concatenate([way / 2, 1 - 0.5 * _SHORTER ** np.arange(1, 2 * degree), [1.0]])
            way = ends_at_zero if force[k] > 0 else np.ones(1)
        time.append(np.append(ends[k] + durations[k] * way[:-1], ends[k + 1]))
    every = np.concatenate(time)
    nodes = (1 - np.cos(np.pi * np.arange(1, degree + 1) / degree)) / 2
    instants = every[:-1, None] + np.diff(every)[:, None] * nodes
    all_instants = np.append(every[0], instants)
    found = law.elastic_force(all_instants, np.interp(all_instants, loading.time, loading.force))
    return Steps(
        time=every,
        force=np.interp(every, loading.time, loading.force),
        given=np.searchsorted(every, loading.time),
        nodes=nodes,
        instants=instants,
        load=found[1:].reshape(-1, degree),
        start=float(found[0]),
        from_rises=np.asarray(np.linalg.inv(np.vander(nodes, degree + 1, increasing=True)[:, 1:])),
    )


def turns(law: SpringLaw, loading: ForceHistory) -> FloatArray:
    """Instants [s] between those of the history where F_e leaves, or passes again, its largest value so far."""
    count = int(np.clip(_SAMPLES // loading.time.size, 3, _MOST_SAMPLES))
    grid = np.unique(np.linspace(loading.time[:-1], loading.time[1:], count))
    turn = np.zeros(0)
    for _ in range(_ZOOMS):
        closed = never_larger(law, law.elastic_force(grid, np.interp(grid, loading.time, loading.force)))
        change = np.flatnonzero(closed[1:] != closed[:-1])
        turn = np.where(closed[change], grid[change], grid[change + 1])
        grid = np.unique(np.append(grid, np.linspace(grid[change], grid[change + 1], 17)))
    interval = np.clip(np.searchsorted(loading.time, turn) - 1, 0, loading.time.size - 2)
    share = (turn - loading.time[interval]) / np.diff(loading.time)[interval]
    return np.unique(turn[np.minimum(share, 1 - share) > _APART])


def never_larger(law: SpringLaw, load: FloatArray) -> NDArray[np.bool_]:
    """Whether F_e [N] is its largest value so far, within rounding, at each instant, shape (n,)."""
    rounding = EPS * (load.size + 4.0 * (law.times.size + 1))
    return np.asarray(load >= np.maximum.accumulate(load) * (1 - rounding))


@dataclass
class March:
    """Depths under a force on one bed of springs.

    Attributes:
        law: Law of the springs.
        layout: Positions of the springs.
        weight: Stiffness of each spring [N/m], shape (n,).
        steps: Substeps.
        closed: Depths [m] of the elastic layer under F_e at the first instant and all nodes, shape (1 + n q,).
        known: Whether `closed` is the depth in the whole substep, shape (n,).
        before: First guess of the depths at nodes, e.g. of an earlier march, shape (n, q).
        missed: Largest error of F_e over the largest F_e.
        depth: Depths at nodes [m], shape (n, q).
        fronts: Radii [m] at which contact ends at all nodes, negative where nothing touches, shape (n, q).
    """

    law: SpringLaw
    layout: Layout
    weight: FloatArray
    steps: Steps
    closed: FloatArray
    known: NDArray[np.bool_]
    before: FloatArray
    missed: float = 0.0
    depth: FloatArray = field(init=False)
    fronts: FloatArray = field(init=False)

    def path(self) -> Path:
        """Depths at all ends of substeps.

        Raises:
            NotConvergedError: If no depth is found for a force.
        """
        (count, degree), steps = self.steps.load.shape, self.steps
        bed = SpringBed.undeformed(self.law, self.layout.g, float(self.closed[0]))
        ways, depth = np.zeros((count, degree + 1)), np.full(count + 1, self.closed[0])
        free = ~self.known & (steps.force[1:] <= 0)
        self.depth = np.zeros((count, degree))
        touched, passed = np.zeros((count, degree), dtype=np.bool_), [np.zeros((2, 1))]
        for k, span in enumerate(np.diff(steps.time).tolist()):
            if free[k]:
                bed.release(span)
                touching = np.zeros((degree, bed.g.size), dtype=np.bool_)
            elif self.known[k]:
                ways[k] = self._way(float(depth[k]), self.closed[1 + k * degree : 1 + (k + 1) * degree])
                _, touching = bed.advance(ways[k], span, steps.nodes)
            else:
                ways[k], bed, touching = self._met(bed, float(depth[k]), k, span)
            pressed = steps.force[k + 1] > 0 or self.known[k]
            depth[k + 1] = ways[k].sum() if pressed else np.min(bed.surface + bed.g)
            self.depth[k] = np.vander(steps.nodes, degree + 1, increasing=True) @ ways[k] if pressed else depth[k + 1]
            touched[k] = touching.any(axis=1)
            for share, spring in bed.events:
                passed.append(np.stack([steps.time[k] + span * share, self.layout.radius[spring]]))
        time, radius = np.concatenate(passed, axis=1)
        order = np.argsort(time, kind="stable")
        self.fronts = np.where(touched, _fronts(time[order], radius[order], steps.instants), -1.0)
        return Path(steps.time, depth, ways, free)

    @cached_property
    def _dashpots(self) -> tuple[FloatArray, FloatArray]:
        """Matrices from values at start and nodes to integrals up to the nodes, and from depth increases to slopes."""
        nodes, order = np.append(0.0, self.steps.nodes), np.arange(1, self.steps.nodes.size + 2)
        powers = np.vander(nodes, nodes.size, increasing=True)
        slopes = powers[:, :-1] * order[:-1] @ self.steps.from_rises
        return (nodes[1:, None] * powers[1:] / order) @ np.linalg.inv(powers), slopes

    def _correction(self, missed: FloatArray, touching: NDArray[np.bool_], before: SpringBed) -> FloatArray:
        """Change of depths at the nodes that changes F_e there by -missed, to first order.

        Without dashpots a spring that loses contact no longer counts; with them dF_e = int K(t) dv(t) dt.
        """
        stiffness = np.append(before.touching @ self.weight, touching @ self.weight)
        stiffness = np.maximum(stiffness, max(_LEAST * self.weight.sum(), stiffness.max() / 4))
        if not self.law.viscosity:
            return np.asarray(-missed / stiffness[1:])
        integral, slope = self._dashpots
        return -np.linalg.solve(integral @ (stiffness[:, None] * slope), missed)

    def _way(self, start: float, depth: FloatArray) -> FloatArray:
        """Coefficients of the polynomial through a depth at the start and depths at the nodes."""
        return np.append(start, self.steps.from_rises @ (depth - start))

    def _met(
        self, before: SpringBed, start: float, k: int, span: float
    ) -> tuple[FloatArray, SpringBed, NDArray[np.bool_]]:
        """Solve substep k for the depth at which the force is F_e at its nodes, by damped Newton steps.

        Returns the coefficients of the depth, the bed at the end, and which springs touch at the nodes.
        """
        steps = self.steps
        target, largest = steps.load[k], float(steps.load.max())
        y = start + self.before[k] - (self.before[k - 1, -1] if k else self.closed[0])
        halvings, best, move = 0, (np.inf, np.zeros(0), before, np.zeros(0, dtype=np.bool_)), np.zeros(y.size)
        for _ in range(_MOST_STEPS):
            bed, way = before.copy(), self._way(start, y + move)
            surface, touching = bed.advance(way, span, steps.nodes)
            load_error = surface @ self.weight - target
            relative = float(np.abs(load_error).max()) / largest
            if relative < best[0]:
                best, y = (relative, way, bed, touching), y + move
                move = self._correction(load_error, touching, before)
                halvings = 0
            else:
                move, halvings = move / 2, halvings + 1
            if relative <= _TOLERANCE or halvings > _MOST_HALVINGS:
                break
        if best[0] > _ACCEPTABLE:
            raise NotConvergedError("no depth carries the prescribed force", {"force": best[0]})
        self.missed = max(self.missed, best[0])
        return best[1], best[2], best[3]


def _fronts(time: FloatArray, radius: FloatArray, instants: FloatArray) -> FloatArray:
    """Front [m] at instants [s], linear between the instants when springs at given radii [m] touch or lose contact.

    A front that turns passes the same spring twice. In between it moves with its speed before and after.
    """
    apart = time[-1] + instants.max()
    time, radius = np.concatenate([[-2 * apart, -apart], time, [apart, 2 * apart]]), np.pad(radius, 2, mode="edge")
    i = np.clip(np.searchsorted(time, instants) - 1, 1, time.size - 3)
    with np.errstate(all="ignore"):  # springs that touch at one instant have an infinite pace, which times zero is zero
        pace = np.nan_to_num(np.diff(radius) / np.diff(time), posinf=1e150, neginf=-1e150)
    turns = (pace[i] == 0) & (pace[i - 1] * pace[i + 1] < 0)
    beyond = np.minimum(np.abs(pace[i - 1]) * (instants - time[i]), np.abs(pace[i + 1]) * (time[i + 1] - instants))
    return np.interp(instants, time, radius) + np.where(turns, np.sign(pace[i - 1]) * np.maximum(beyond, 0.0), 0.0)


def resting_depth(law: SpringLaw, g: FloatArray, path: Path, k: int) -> float:
    """Depth [m] of an indenter that rests on the surface at a free instant k: the least u + g.

    Args:
        law: Law of the springs.
        g: g(x) of the first springs [m], increasing.
        path: Depths over time.
        k: Number of the instant.
    """
    for _ in range(_ROUNDS):
        *_, bed = followed(law, g, path.until(k))
        height = bed.surface + g
        lowest = int(height.argmin())
        g = np.linspace(g[max(lowest - 1, 0)], g[min(lowest + 1, g.size - 1)], _AMONG)
    return float(height.min())
