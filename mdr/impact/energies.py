"""Samples of one impact, with the energies that its motion does not feel: they are integrated along it afterwards.

What a branch stores and loses asks for the integral of s_j^2 over the springs in contact, k S_j^2 - 2 S_j M_j + N_j
with N_j = int E_j^2 S_j(t_c)^2 dk.
"""

from __future__ import annotations

import numpy as np

from bem.polynomials.chebyshev import powers
from contact.records.validation import FloatArray
from mdr.impact.collocation import Trajectory
from mdr.impact.collocation_step import CHANGE, POINTS, STAGES, TO_END, TO_STAGES
from mdr.impact.equations import ImpactBatch, force, missing, outline, remembered
from mdr.impact.memory import Memory
from mdr.impact.motion import Leg
from mdr.springs.table import MOMENT, PROFILE, SECOND_MOMENT, SLOPE, STIFFENING, STIFFNESS

# Places of the samples on each step, z in [-1, 1], both ends among them.
SAMPLES = -np.cos(np.pi * np.arange(2 * STAGES + 1) / (2 * STAGES))
_POWERS = powers(np.concatenate([POINTS, SAMPLES]), STAGES + 1)
_RATES = np.arange(1.0, STAGES + 1.0)[:, None] * powers(POINTS, STAGES)
# Matrix from derivatives by z at the Gauss points to the change since z = -1.
_INTEGRALS = 2.0 * CHANGE.T @ _POWERS


def samples(lanes: ImpactBatch, way_in: list[Leg], way_out: list[Leg]) -> FloatArray:
    """Rows t, delta, v, force, y, stored and dissipated energy of a single lane, shape (7, n)."""
    squares, lost = np.zeros(lanes.branches), np.zeros(1)
    memories: dict[int, Memory] = {}
    found: list[FloatArray] = []
    for leg in way_in:
        rows, power, slopes = _pressing(lanes, leg, squares)
        if leg.memory is not None:
            memories[leg.section] = _memory_of_squares(leg.memory, slopes, squares)
        squares = _along(slopes, squares)[1]
        lost = _with_losses(found, rows, power, lost)
    for leg in way_out:
        lost = _with_losses(found, *_receding(lanes, leg, memories.get(leg.section)), lost)
    return np.concatenate(found, axis=1)


def dissipation(lanes: ImpactBatch, k: FloatArray, v: FloatArray, strain: FloatArray) -> FloatArray:
    """Power lost in the dashpots; `strain` holds the integrals of s_j^2."""
    branches = np.add.reduce(lanes.rates / lanes.weights * strain)
    return np.asarray(lanes.inertia * (lanes.viscosity * k * v**2 + branches))


def stored(lanes: ImpactBatch, springs: FloatArray, delta: FloatArray, strain: FloatArray) -> FloatArray:
    """Energy of the springs in contact, in units of M v0^2."""
    long_term = (springs[STIFFNESS] * delta - 2.0 * springs[MOMENT]) * delta + springs[SECOND_MOMENT]
    return np.asarray(0.5 * lanes.inertia * (lanes.long_term * long_term + np.add.reduce(strain / lanes.weights)))


def _pressing(lanes: ImpactBatch, leg: Leg, squares: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The rows but the last on the way in, the power lost, and the slopes of N_j, the latter two at Gauss points."""
    state, rate = _points(leg.trajectory), _rates(leg.trajectory)
    shared, memory = outline(lanes.branches)
    springs = lanes.springs(state[0], leg.section, 6)
    g, k = springs[PROFILE], springs[STIFFNESS]
    passing = rate[1] + rate[0] * _at_gauss(springs[SLOPE])
    history, past = lanes.weights * g - state[shared], lanes.weights * springs[MOMENT] - state[memory]
    slopes = _fading(rate[0] * _at_gauss(springs[STIFFENING] * history**2), 2.0 * lanes.rates * passing, squares)
    met = _along(slopes, squares)[0].reshape(history.shape)
    strain = k * history**2 - 2.0 * history * past + met
    f = force(lanes, springs, g, state[2], springs[MOMENT] + np.add.reduce(k * state[shared] - state[memory]))
    rows = np.stack([state[1] + g, g, state[2], f, state[0], stored(lanes, springs, g, strain)])
    return rows, _at_gauss(dissipation(lanes, k, state[2], strain)) * passing, slopes


def _receding(lanes: ImpactBatch, leg: Leg, squares: Memory | None) -> tuple[FloatArray, FloatArray]:
    """The same on the way out, where springs that let go lose what they hold."""
    state, rate, own = _points(leg.trajectory), _rates(leg.trajectory), np.arange(1)
    springs = lanes.springs(state[0], leg.section, 6)
    g, k, delta = springs[PROFILE], springs[STIFFNESS], state[2]
    recall = leg.memory.recall(leg.step, own) if leg.memory is not None else None
    history, front, memory, fading = remembered(recall, lanes, state, springs)
    taken = missing(lanes, springs, state[4:], memory)
    met = fading**2 * squares.recall(leg.step, own)(state[0]) if squares is not None else history
    strain = k * history**2 - 2.0 * history * memory + met
    f, held = force(lanes, springs, delta, state[3], taken), stored(lanes, springs, delta, strain)
    rows = np.stack([state[1], delta, state[3], f, state[0], held])
    tip = 0.5 * lanes.inertia * (lanes.long_term * (delta - g) ** 2 + np.add.reduce(front**2 / lanes.weights))
    power = _at_gauss(dissipation(lanes, k, state[3], strain)) * rate[1]
    return rows, power - _at_gauss(tip * springs[STIFFENING]) * rate[0]


def _points(trajectory: Trajectory) -> FloatArray:
    """States at the Gauss points and samples of all steps in order, shape (m, n, 1)."""
    change = trajectory.steps[..., 0].transpose(1, 2, 0) @ _POWERS
    return np.asarray((trajectory.starts + change).reshape(change.shape[0], -1, 1))


def _rates(trajectory: Trajectory) -> FloatArray:
    """d(state)/dz at the Gauss points, shape (m, steps, stages)."""
    return np.asarray(trajectory.steps[1:, ..., 0].transpose(1, 2, 0) @ _RATES)


def _at_gauss(values: FloatArray) -> FloatArray:
    """Those of all points, shape (..., n, 1), that are Gauss points, shape (..., steps, stages)."""
    each = _POWERS.shape[1]
    return values.reshape(*values.shape[:-2], values.shape[-2] // each, each)[..., :STAGES]


def _along(slopes: FloatArray, start: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Integral over z of slopes at Gauss points, shape (..., steps, stages), at all points and at the end."""
    each = 2.0 * slopes @ TO_END
    ends = start[..., None] + np.cumsum(each, axis=-1)
    return (ends - each)[..., None] + slopes @ _INTEGRALS, ends[..., -1]


def _fading(source: FloatArray, decay: FloatArray, start: FloatArray) -> FloatArray:
    """Slopes at Gauss points of u with du/dz = source - decay u, each of shape (n, steps, stages)."""
    driven = 2.0 * source @ TO_STAGES.T
    matrix = np.eye(STAGES) + 2.0 * TO_STAGES * decay[..., None, :]
    both = np.linalg.solve(matrix, np.stack([np.ones_like(driven), driven], axis=-1))
    slopes, value = np.empty_like(source), start
    for step in range(source.shape[1]):
        u = value[:, None] * both[:, step, :, 0] + both[:, step, :, 1]
        slopes[:, step] = source[:, step] - decay[:, step] * u
        value = value + 2.0 * slopes[:, step] @ TO_END
    return slopes


def _memory_of_squares(memory: Memory, slopes: FloatArray, start: FloatArray) -> Memory:
    """N_j as the front met it; the memory may have room for steps that another lane took."""
    each = 2.0 * slopes @ TO_END
    starts = start[:, None] + np.cumsum(each, axis=-1) - each
    steps = 2.0 * (slopes @ CHANGE.T).transpose(2, 0, 1)
    return memory.first(slopes.shape[1]).remembering(starts[..., None], steps[..., None])


def _with_losses(found: list[FloatArray], rows: FloatArray, power: FloatArray, lost: FloatArray) -> FloatArray:
    """Append the samples of a leg with the dissipated energy as their last row; that energy at the leg's end."""
    losses, end = _along(power, lost)
    whole = np.concatenate([rows[..., 0], losses.reshape(1, -1)])
    found.append(whole.reshape(len(whole), -1, _POWERS.shape[1])[..., STAGES:].reshape(len(whole), -1))
    return end
