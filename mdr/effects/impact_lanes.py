"""Equations of motion of many impacts, Eqs. (47), (51) and (52), in the units of each impact.

Springs of one layer share their history S_j: a spring x that was touched at t_c(x) carries
s_j = S_j(t) - E_j S_j(t_c), E_j = exp(-(t - t_c)/tau_j). All springs in contact together carry k S_j - M_j, with one
integral M_j = int E_j S_j(t_c) dk per branch. While the front recedes, M_j(t) = E_j M_j(t_c(a)):
what the front once passed it passes again.

Depth is measured in D, time in D/v0, stiffness in k_e, force in k_e D; kappa = k_e D^2 / (M v0^2). The independent
variable sigma has dt = g_y d(sigma): then dy = v d(sigma) while pressing, and nothing is singular at first touch, at
the turn, or at the loss of contact.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contact.validation import FloatArray
from mdr.effects.collocation_step import Chain, Derivative, Lanes
from mdr.effects.impact_memory import Memory
from mdr.effects.spring_table import MOMENT, SECOND_MOMENT, STIFFNESS, SpringTable


@dataclass(frozen=True)
class ImpactLanes:
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

    def take(self, lanes: Lanes) -> ImpactLanes:
        """Some of the lanes."""
        if lanes.size == self.count and np.array_equal(lanes, np.arange(self.count)):
            return self
        return ImpactLanes(
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
        return self.table.evaluate(y * self.units[6], rows, section) / self.units[:rows, None]


def outline(branches: int) -> tuple[slice, slice, slice]:
    """Where S_j, M_j and N_j = int E_j^2 S_j(t_c)^2 dk stand in the state y, t, v, S, M, N, dissipated."""
    return slice(3, 3 + branches), slice(3 + branches, 3 + 2 * branches), slice(3 + 2 * branches, 3 + 3 * branches)


@dataclass(frozen=True)
class Pressing:
    """From first touch to the turn. State: y, t, v, S_j, M_j, N_j and the dissipated energy."""

    lanes: ImpactLanes
    section: int

    @property
    def controlled(self) -> int:
        """All of them."""
        return 4 + 3 * self.lanes.branches

    @property
    def chain(self) -> Chain:
        """dy = v d(sigma)."""
        return 0, 2, None

    def derivative(self, lanes: Lanes) -> Derivative:
        """d(state)/d(sigma)."""
        own, section = self.lanes.take(lanes), self.section
        shared, memory, squares = outline(own.branches)

        def rhs(state: FloatArray) -> FloatArray:
            v, history, past = state[2], state[shared], state[memory]
            springs = own.springs(state[0], section, 5)
            g, g_y, k, k_y = springs[:4]
            slopes = np.empty_like(state)
            slopes[0] = v
            slopes[1] = g_y
            slopes[2] = -own.inertia * force(own, springs, g, v, k * history - past) * g_y  # Eq. (48) for any profile
            slopes[shared] = (own.weights * v - own.rates * history) * g_y
            slopes[memory] = k_y * v * history - own.rates * past * g_y
            left = k * history**2 - 2.0 * history * past + state[squares]
            slopes[squares] = k_y * v * history**2 - 2.0 * own.rates * state[squares] * g_y
            slopes[-1] = own.inertia * dissipation(own, k, v, left) * g_y
            return slopes

        return rhs


@dataclass(frozen=True)
class Receding:
    """From the turn to the loss of contact. State: y, t, delta, v, S_j and the dissipated energy."""

    lanes: ImpactLanes
    section: int
    memory: Memory | None
    step: int

    @property
    def controlled(self) -> int:
        """All of them."""
        return 5 + self.lanes.branches

    @property
    def chain(self) -> Chain:
        """d(delta) = v dt."""
        return 2, 3, 1

    def derivative(self, lanes: Lanes) -> Derivative:
        """d(state)/d(sigma)."""
        own, section = self.lanes.take(lanes), self.section
        recall = self.memory.recall(self.step, lanes) if self.memory is not None else None
        branches = own.branches

        def rhs(state: FloatArray) -> FloatArray:
            delta, v, history = state[2], state[3], state[4 : 4 + branches]
            springs = own.springs(state[0], section, 5)
            g, g_y, k, k_y = springs[:4]
            branch_force, front, fading, left = remembered(recall, own, state, k)
            acceleration = -own.inertia * force(own, springs, delta, v, branch_force)
            change = own.long_term * v + own.viscosity * acceleration
            change = change + np.add.reduce(own.weights * v - own.rates * front)  # of the outermost spring's force
            slopes = np.empty_like(state)
            slopes[0] = change / (own.long_term + np.add.reduce(own.weights * fading))  # it stays zero
            slopes[1] = g_y
            slopes[2] = v * g_y
            slopes[3] = acceleration * g_y
            slopes[4 : 4 + branches] = (own.weights * v - own.rates * history) * g_y
            released = 0.5 * (own.long_term * (delta - g) ** 2 + np.add.reduce(front**2 / own.weights))
            slopes[-1] = own.inertia * (dissipation(own, k, v, left) * g_y - k_y * slopes[0] * released)
            return slopes

        return rhs


def remembered(
    recall: Derivative | None, own: ImpactLanes, state: FloatArray, k: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Per branch: k S - M, the outermost spring's s, E, and the integral of s^2 while the front recedes."""
    n = own.branches
    history = state[4 : 4 + n]
    if recall is None:
        return history, history, history, history  # no branches: four empty arrays
    past = recall(state[0])
    fading = np.exp(-(state[1] - past[0]) * own.rates)
    front = history - fading * past[1 : 1 + n]
    memory = fading * past[1 + n : 1 + 2 * n]
    squares = fading**2 * past[1 + 2 * n :]
    return k * history - memory, front, fading, k * history**2 - 2.0 * history * memory + squares


def force(
    lanes: ImpactLanes, springs: FloatArray, delta: FloatArray, v: FloatArray, branches: FloatArray
) -> FloatArray:
    """Normal force, Eqs. (47) and (51); `branches` holds k S_j - M_j."""
    elastic_and_viscous = springs[STIFFNESS] * (lanes.long_term * delta + lanes.viscosity * v)
    return np.asarray(elastic_and_viscous - lanes.long_term * springs[MOMENT] + np.add.reduce(branches))


def dissipation(lanes: ImpactLanes, k: FloatArray, v: FloatArray, squares: FloatArray) -> FloatArray:
    """Power lost in the dashpots; `squares` holds the integrals of s_j^2."""
    return np.asarray(lanes.viscosity * k * v**2 + np.add.reduce(lanes.rates / lanes.weights * squares))


def stored(lanes: ImpactLanes, springs: FloatArray, delta: FloatArray, squares: FloatArray) -> FloatArray:
    """Energy of the springs in contact; divide by the unit M v0^2 / kappa to compare with the kinetic energy."""
    long_term = (springs[STIFFNESS] * delta - 2.0 * springs[MOMENT]) * delta + springs[SECOND_MOMENT]
    return np.asarray(0.5 * (lanes.long_term * long_term + np.add.reduce(squares / lanes.weights)))
