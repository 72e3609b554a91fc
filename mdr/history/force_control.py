"""Depth under a prescribed force.

Forces f of a spring and displacements u of its end obey u = J * df with the compliance J, in contact or free, so their
sums do: the springs' displacements, each times its stiffness, add up to F_e = J * dF, a sum of exponentials while F
is linear in time. No end of a spring stands above the indenter, and a free one only creeps back. So where F_e has never
been larger all springs ever touched are touched, and F_e is the elastic force of the depth (Lee and Radok 1960,
J. Appl. Mech. 27, 438; Ting 1966, J. Appl. Mech. 33, 845).

Elsewhere the depth is less than F_e would make it. There it is a polynomial in time on each substep, whose values at
Chebyshev's points t_i follow from the sums of displacements at these instants,

    2 E* int u(x, t_i) y_1^2(x) dx = F_e(t_i),   u = delta - g in contact.

Panels of springs end at the fronts of the last march, so that these sums are Gauss rules, and the march is repeated
until the depth converges: the sum is stationary in the fronts. Without force the indenter rests on the spring g = 0.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.numerics import EPS
from contact import ForceHistory, NotConvergedError
from contact.records.validation import BoolArray, FloatArray
from mdr.history.fronts import Layout, panel_ends
from mdr.history.spring_bed import Passage, Path, SpringBed
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
# Least stiffness for corrections, over that of all springs, in substeps in which hardly any touch.
_LEAST = 1e-3
# Ratio of neighbouring substeps while a force decreases to zero; the second half of the interval has twice as many as
# the degree. With half of these the error is 1e-4.
_SHORTER = 0.35


class Steps(NamedTuple):
    """Substeps of a force history, n of them with q nodes each.

    Attributes:
        time: Ends of substeps [s], shape (n + 1,).
        force: F [N] at `time`.
        given: Indices in `time` of the instants of the history.
        nodes: Shares of a substep at which depths are determined, shape (q,).
        instants: First instant and nodes of all substeps [s], shape (1 + n q,).
        load: F_e [N] at `instants`.
    """

    time: FloatArray
    force: FloatArray
    given: NDArray[np.intp]
    nodes: FloatArray
    instants: FloatArray
    load: FloatArray

    @property
    def powers(self) -> FloatArray:
        """Powers 1 to q of the nodes, shape (q, q)."""
        return np.vander(self.nodes, self.nodes.size + 1, increasing=True)[:, 1:]

    def polynomials(self, start: FloatArray, depth: FloatArray) -> FloatArray:
        """Coefficients, shape (n, q + 1), from depths [m] at starts, shape (n,), and at nodes, shape (n, q)."""
        return np.column_stack([start, np.linalg.solve(self.powers, (depth - start[:, None]).T).T])


def steps_of(law: SpringLaw, loading: ForceHistory, substeps: int, degree: int) -> Steps:
    """Substeps of each interval, and of its parts before and after a turn of F_e.

    Args:
        law: Law of the springs.
        loading: Forces in time.
        substeps: Total number. Half are distributed by duration, half equally: short intervals may be steep.
        degree: Degree of the depth in each substep.
    """
    ends = np.sort(np.append(loading.time, turns(law, loading)))
    force = np.interp(ends, loading.time, loading.force)
    load, durations = law.elastic_force(ends, force), np.diff(ends)
    counts = np.ceil(substeps * (durations / durations.sum() + 1 / durations.size) / 2).astype(int)
    time = [ends[:1]]
    for k, count in enumerate(counts.tolist()):
        share = (np.arange(1, count + 1) / count) ** (2 if min(load[k], force[k]) > 0 else 4)
        if force[k + 1] <= 0 < force[k]:
            share = np.concatenate([share / 2, 1 - 0.5 * _SHORTER ** np.arange(1, 2 * degree), [1.0]])
        elif force[k + 1] <= 0:
            share = np.ones(1)
        time.append(np.append(ends[k] + durations[k] * share[:-1], ends[k + 1]))
    every = np.concatenate(time)
    nodes = (1 - np.cos(np.pi * np.arange(1, degree + 1) / degree)) / 2
    instants = np.append(every[0], every[:-1, None] + np.diff(every)[:, None] * nodes)
    return Steps(
        time=every,
        force=np.interp(every, loading.time, loading.force),
        given=np.searchsorted(every, loading.time),
        nodes=nodes,
        instants=instants,
        load=law.elastic_force(instants, np.interp(instants, loading.time, loading.force)),
    )


def turns(law: SpringLaw, loading: ForceHistory) -> FloatArray:
    """Instants [s] between those of the history where F_e leaves, or passes again, its largest value so far."""
    count = int(np.clip(_SAMPLES // loading.time.size, 3, _MOST_SAMPLES))
    grid = np.unique(np.linspace(loading.time[:-1], loading.time[1:], count))
    turn = np.zeros(0)
    for _ in range(_ZOOMS):
        is_largest = never_larger(law, law.elastic_force(grid, np.interp(grid, loading.time, loading.force)))
        change = np.flatnonzero(is_largest[1:] != is_largest[:-1])
        turn = np.where(is_largest[change], grid[change], grid[change + 1])
        grid = np.unique(np.append(grid, np.linspace(grid[change], grid[change + 1], 17)))
    interval = np.clip(np.searchsorted(loading.time, turn) - 1, 0, loading.time.size - 2)
    share = (turn - loading.time[interval]) / np.diff(loading.time)[interval]
    return np.unique(turn[np.minimum(share, 1 - share) > _APART])


def never_larger(law: SpringLaw, load: FloatArray) -> BoolArray:
    """Whether F_e [N] is its largest value so far, within rounding, at each instant, shape (n,)."""
    rounding = EPS * (load.size + 4.0 * (law.times.size + 1))
    return np.asarray(load >= np.maximum.accumulate(load) * (1 - rounding))


class March(NamedTuple):
    """Depths under a force on one layout of springs.

    Attributes:
        path: Depth as a polynomial of time in each substep.
        instants: `Steps.instants` [s], shape (1 + n q,).
        depth: Depth at `instants` [m].
        front: Contact radius at `instants` [m], -1 without contact.
        load_error: Largest error of F_e over the largest F_e.
    """

    path: Path
    instants: FloatArray
    depth: FloatArray
    front: FloatArray
    load_error: float

    def panel_ends(self, law: SpringLaw) -> FloatArray:
        """Radii [m] at which the panels of springs end in the next march, shape (n,)."""
        return panel_ends(law, self.instants, self.front)


def march(law: SpringLaw, springs: Layout, steps: Steps, closed: FloatArray, guess: FloatArray) -> March:
    """Depths that balance F_e, computed in one substep after the other.

    Args:
        law: Law of the springs.
        springs: Springs, whose weights are stiffnesses [N/m].
        steps: Substeps.
        closed: Depths [m] of the elastic layer under F_e at `Steps.instants`. They are inserted in substeps in which
            F_e has never been larger.
        guess: First guess of the depths at `Steps.instants` [m].

    Raises:
        NotConvergedError: If the depths of a substep do not converge.
    """
    count, q = steps.time.size - 1, steps.nodes.size
    is_known = np.asarray(never_larger(law, steps.load)[1:].reshape(count, q).all(axis=1))
    is_free = np.asarray(~is_known & (steps.force[1:] <= 0))
    bed = SpringBed.undeformed(law, springs.g, float(closed[0]))
    depth, front, polynomials, load_error = closed.copy(), np.full(closed.size, -1.0), np.zeros((count, q + 1)), 0.0
    for k, span in enumerate(np.diff(steps.time).tolist()):
        nodes, start = slice(1 + k * q, 1 + (k + 1) * q), depth[[k * q]]
        if is_free[k]:
            bed.release(span)
            depth[nodes] = bed.surface[0]
            continue
        balance = Balance(bed, springs.weight, steps, span, start, steps.load[nodes], float(steps.load.max()))
        if is_known[k]:
            bed, passage, _ = balance.after(depth[nodes])
        else:
            depth[nodes], bed, passage, error = balance.solved(start + guess[nodes] - guess[k * q])
            load_error = max(load_error, error)
        polynomials[k], front[nodes] = steps.polynomials(start, depth[None, nodes])[0], _fronts(springs.radius, passage)
    path = Path(steps.time, depth[::q], polynomials, is_free)
    return March(path, steps.instants, depth, front, load_error)


class Balance(NamedTuple):
    """Balance of F_e at the nodes of one substep.

    Attributes:
        bed: Springs at the start of the substep.
        stiffness: Stiffness of each spring [N/m], shape (n,).
        steps: All substeps.
        span: Duration of this one [s].
        start: Depth at its start [m], shape (1,).
        load: F_e [N] at its nodes, shape (q,).
        scale: Largest F_e [N].
    """

    bed: SpringBed
    stiffness: FloatArray
    steps: Steps
    span: float
    start: FloatArray
    load: FloatArray
    scale: float

    def after(self, depth: FloatArray) -> tuple[SpringBed, Passage, FloatArray]:
        """Springs at the end of the substep, springs and errors of F_e [N] at its nodes, from depths [m] at these."""
        bed = self.bed.copy()
        passage = bed.advance(self.steps.polynomials(self.start, depth[None])[0], self.span, self.steps.nodes)
        return bed, passage, passage.surface @ self.stiffness - self.load

    def solved(self, depth: FloatArray) -> tuple[FloatArray, SpringBed, Passage, float]:
        """Depths [m] at the nodes from a guess, springs at the end and at the nodes, and the error of F_e over `scale`.

        Broyden's method: the first Jacobian is the stiffness of the springs in contact.
        """
        bed, passage, errors = self.after(depth)
        stiffness = passage.touching @ self.stiffness
        least = max(_LEAST * self.stiffness.sum(), stiffness.max() / 4)
        inverse, halvings = np.diag(1 / np.maximum(stiffness, least)), 0
        step = -inverse @ errors
        for _ in range(_MOST_STEPS):
            if np.abs(errors).max() <= _TOLERANCE * self.scale or halvings > _MOST_HALVINGS:
                break
            trial = self.after(depth + step)
            change = inverse @ (trial[2] - errors)
            if np.abs(step @ change) > 1e-3 * (step @ step):
                inverse += np.outer(step - change, step @ inverse) / (step @ change)
            if np.abs(trial[2]).max() < np.abs(errors).max():
                depth, (bed, passage, errors) = depth + step, trial
                halvings, step = 0, -inverse @ errors
            else:
                halvings, step = halvings + 1, step / 2
        error = float(np.abs(errors).max()) / self.scale
        if not error <= _ACCEPTABLE:
            raise NotConvergedError("no depth carries the prescribed force", {"force": error})
        return depth, bed, passage, error


def _fronts(radius: FloatArray, passage: Passage) -> FloatArray:
    """Contact radii [m] at the nodes, -1 without contact, linear in `Passage.edge` between two springs, shape (q,)."""
    touching, edge = passage.touching, passage.edge
    free = np.argmin(np.column_stack([touching, np.zeros(len(touching), dtype=np.bool_)]), axis=1)
    i, row = np.clip(free, 1, radius.size - 1), np.arange(free.size)
    share = edge[row, i - 1] / np.maximum(edge[row, i - 1] - edge[row, i], 1e-300)
    front = radius[i - 1] + np.clip(share, 0, 1) * (radius[i] - radius[i - 1])
    return np.where(free == 0, -1.0, np.where(free == radius.size, radius[-1], front))
