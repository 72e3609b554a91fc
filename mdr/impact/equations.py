"""Equations of motion of many impacts, Eqs. (47), (51) and (52), in the units of each impact.

Springs of one layer share their history S_j: a spring x that was touched at t_c(x) carries
s_j = S_j(t) - E_j S_j(t_c), E_j = exp(-(t - t_c)/tau_j). All springs in contact together carry k S_j - M_j, with one
integral M_j = int E_j S_j(t_c) dk per branch. While the front recedes, M_j(t) = E_j M_j(t_c(a)):
unloading visits the same radii in reverse, so M_j is looked up by radius. The state holds the relaxed part,
g_j delta - S_j and g_j P - M_j: it is small, so the stiff elastic part of the force stays exact.

Many impacts are integrated together; a lane is the last index of an array, the number of an impact.

Depth is measured in D, time in D/v0, stiffness in k_e, force in k_e D; kappa = k_e D^2 / (M v0^2). The independent
variable sigma has dt = g_y d(sigma): then dy = v d(sigma) while pressing, and nothing is singular at first touch, at
the turn, or at the loss of contact.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contact.records.validation import FloatArray, IntArray
from mdr.impact.collocation_step import Chain, Derivative
from mdr.impact.memory import Memory
from mdr.springs.table import MOMENT, PROFILE, SLOPE, STIFFNESS, SpringTable


@dataclass(frozen=True)
class ImpactBatch:
    """Dimensionless impacts that share a spring table and a number of Prony branches.

    Attributes:
        table: The springs of all lanes.
        units: What g, dg/dy, k, dk/dy, P, Q and y of the table are measured in, shape (7, lanes).
        long_term: G_inf / G_0, shape (lanes,).
        viscosity: Dashpot eta / G_0 over the unit of time, shape (lanes,).
        weights: G_j / G_0, shape (branches, 1, lanes).
        rates: Unit of time over tau_j, shape (branches, 1, lanes).
        inertia: kappa, shape (lanes,).
    """

    table: SpringTable
    units: FloatArray
    long_term: FloatArray
    viscosity: FloatArray
    weights: FloatArray
    rates: FloatArray
    inertia: FloatArray

    @property
    def count(self) -> int:
        """Number of impacts."""
        return int(self.inertia.size)

    @property
    def branches(self) -> int:
        """Number of Prony branches."""
        return int(self.weights.shape[0])

    def take(self, lanes: IntArray) -> ImpactBatch:
        """Some of the lanes."""
        if lanes.size == self.count and np.array_equal(lanes, np.arange(self.count)):
            return self
        return ImpactBatch(
            self.table,
            self.units[:, lanes],
            self.long_term[lanes],
            self.viscosity[lanes],
            self.weights[..., lanes],
            self.rates[..., lanes],
            self.inertia[lanes],
        )

    def springs(self, y: FloatArray, section: int, rows: int) -> FloatArray:
        """g, dg/dy, k, dk/dy, P, Q in the lanes' units, shape (rows, stages, lanes)."""
        return self.springs_within(section, rows)(y)

    def springs_within(self, section: int, rows: int) -> Derivative:
        """The same as a function of y."""
        within, length, units = self.table.within(section, rows), self.units[6], self.units[:rows, None]
        return lambda y: within(y * length) / units


def outline(branches: int) -> tuple[slice, slice]:
    """Where g_j delta - S_j and g_j P - M_j stand in the state of the way in, behind y, t and v."""
    return slice(3, 3 + branches), slice(3 + branches, 3 + 2 * branches)


@dataclass(frozen=True)
class Pressing:
    """From first touch to the turn. State: y, t - g, v, and per branch what has relaxed of S_j and of M_j.

    A body that nothing slowed down would be at depth g at t = g. What is left of t is as smooth as its loss of speed,
    while t itself, the integral of dg/dy, would ask short steps of every tip whose power is no integer.
    """

    lanes: ImpactBatch
    section: int

    @property
    def chain(self) -> Chain:
        """dy = v d(sigma)."""
        return 0, 2, None

    def derivative(self, lanes: IntArray) -> Derivative:
        """d(state)/d(sigma)."""
        own = self.lanes.take(lanes)
        springs_at, (shared, memory) = own.springs_within(self.section, 5), outline(own.branches)
        slowing = -own.inertia

        def rhs(state: FloatArray) -> FloatArray:
            """d(state)/d(sigma) on the way in, shape of the state."""
            v, relaxed, faded = state[2], state[shared], state[memory]
            springs = springs_at(state[0])
            g, g_y, k, k_y, moment = springs
            gaps = moment + np.add.reduce(k * relaxed - faded)
            relaxation = own.rates * g_y
            slopes = np.empty_like(state)
            slopes[0] = v
            slopes[1] = g_y * (1.0 - v)
            # Eq. (48) for any profile.
            slopes[2] = force(own, springs, g, v, gaps) * (g_y * slowing)
            slopes[shared] = relaxation * (own.weights * g - relaxed)
            slopes[memory] = k_y * v * relaxed + relaxation * (own.weights * moment - faded)
            return slopes

        return rhs


@dataclass(frozen=True)
class Receding:
    """From the turn to the loss of contact. State: y, t, delta, v, and per branch what has relaxed of S_j."""

    lanes: ImpactBatch
    section: int
    memory: Memory | None
    step: int

    @property
    def chain(self) -> Chain:
        """d(delta) = v dt."""
        return 2, 3, 1

    def derivative(self, lanes: IntArray) -> Derivative:
        """d(state)/d(sigma)."""
        own = self.lanes.take(lanes)
        springs_at, branches = own.springs_within(self.section, 5), slice(4, 4 + own.branches)
        recall = self.memory.recall(self.step, lanes) if self.memory is not None else None
        slowing = -own.inertia

        def rhs(state: FloatArray) -> FloatArray:
            """d(state)/d(sigma) on the way back, shape of the state."""
            delta, v = state[2], state[3]
            springs = springs_at(state[0])
            g_y = springs[SLOPE]
            history, front, memory, fading = remembered(recall, own, state, springs)
            slowed = slowing * force(own, springs, delta, v, missing(own, springs, state[branches], memory))
            change = _change_in_front(own, v, slowed, front)
            slopes = np.empty_like(state)
            # The front moves so that the force of the outermost spring stays zero.
            slopes[0] = change / (own.long_term + np.add.reduce(own.weights * fading))
            slopes[1] = g_y
            slopes[2] = v * g_y
            slopes[3] = slowed * g_y
            slopes[branches] = own.rates * history * g_y
            return slopes

        return rhs


def _change_in_front(own: ImpactBatch, v: FloatArray, slowed: FloatArray, front: FloatArray) -> FloatArray:
    """d/dt of the outermost spring's force."""
    change = own.long_term * v + own.viscosity * slowed
    return np.asarray(change + np.add.reduce(own.weights * v - own.rates * front))


def drift(own: ImpactBatch, memory: Memory | None, end: FloatArray) -> FloatArray:
    """The time from the end of a motion to where the last spring's force is zero, by Newton's method, shape (lanes,).

    While the front recedes that force is kept at zero by its derivative, as well as steps are; a layer that is soft in
    the long term needs a long way to make up for little of it.
    """
    state, recall = end[:, None], memory.recall(0, np.arange(own.count)) if memory is not None else None
    springs = own.springs(state[0], 0, 5)
    _, front, faded, _ = remembered(recall, own, state, springs)
    delta, v = state[2], state[3]
    slowed = -own.inertia * force(own, springs, delta, v, missing(own, springs, state[4:], faded))
    left = own.long_term * (delta - springs[PROFILE]) + own.viscosity * v + np.add.reduce(front)
    change = _change_in_front(own, v, slowed, front)
    # A body at rest has no end of contact.
    later = np.divide(-left, change, out=np.zeros_like(left), where=v < 0.0)
    return np.asarray(later[0])


def remembered(
    recall: Derivative | None, own: ImpactBatch, state: FloatArray, springs: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Per branch while the front recedes: S, the outermost spring's s, M, and E."""
    n = own.branches
    history = own.weights * state[2] - state[4 : 4 + n]
    if recall is None:
        # Without branches these are four empty arrays.
        return history, history, history, history
    past = recall(state[0])
    fading = np.exp((past[0] + springs[PROFILE] - state[1]) * own.rates)
    front = history - fading * (own.weights * springs[PROFILE] - past[1 : 1 + n])
    return history, front, fading * (own.weights * springs[MOMENT] - past[1 + n :]), fading


def missing(own: ImpactBatch, springs: FloatArray, relaxed: FloatArray, memory: FloatArray) -> FloatArray:
    """What gaps and relaxation take from k delta while the front recedes."""
    return np.asarray(own.long_term * springs[MOMENT] + np.add.reduce(springs[STIFFNESS] * relaxed + memory))


def force(lanes: ImpactBatch, springs: FloatArray, delta: FloatArray, v: FloatArray, taken: FloatArray) -> FloatArray:
    """Normal force, Eqs. (47) and (51); `taken` is what gaps and relaxation take from k delta."""
    return np.asarray(springs[STIFFNESS] * (delta + lanes.viscosity * v) - taken)
