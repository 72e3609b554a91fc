"""The whole history of one impact: samples of motion, force and energies."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from contact import ImpactHistory, Scene, StageLog
from contact.solution import Setting
from contact.validation import FloatArray
from mdr.effects.collocation import states
from mdr.effects.collocation_step import STAGES
from mdr.effects.impact_lanes import ImpactLanes, force, outline, remembered, stored
from mdr.effects.impact_results import ImpactResults, results
from mdr.effects.impact_solver import Impacts, Leg
from mdr.effects.impact_units import ScaledImpacts
from mdr.effects.spring_table import PROFILE, STIFFNESS

_Z = -np.cos(np.pi * np.arange(2 * STAGES + 1) / (2 * STAGES))  # samples on each step, both ends among them

_SHORTEST = 1e-12  # of the contact time: between two samples
_SERIES = ("time", "indentation_depth", "velocity", "normal_force", "contact_radius")
_OUTCOMES = ("coefficient_of_restitution", "contact_time", "peak_force", "peak_depth", "peak_contact_radius")


def history(
    scene: Scene, problem: ScaledImpacts, motion: Impacts, log: StageLog, *, settings: Mapping[str, Setting]
) -> ImpactHistory:
    """Samples of a single lane in SI units."""
    lanes = problem.lanes
    legs = [_pressing(lanes, own) for leg in motion.way_in if (own := leg.of(0))]
    legs += [_receding(lanes, own) for leg in motion.way_out if (own := leg.of(0))]
    samples = np.concatenate(legs, axis=1)
    t, delta, v, f, y, held, lost = samples[:, distinct(samples[0])]
    outcome = results(problem, motion)
    energy = float(problem.mass[0] * problem.velocity[0] ** 2)
    return ImpactHistory(
        scene=scene,
        method="mdr",
        settings=settings,
        error_estimate=estimates(outcome, float(motion.within[0]), t.size),
        cost=log.cost(unknowns=int(motion.turn.shape[0])),
        stages=log.records,
        time=t * problem.time[0],
        indentation_depth=delta * problem.depth[0],
        velocity=v * problem.velocity[0],
        normal_force=f * problem.stiffness[0] * problem.depth[0],
        contact_radius=lanes.table.radius(y * lanes.units[6, 0]) * problem.length[0],
        kinetic_energy=0.5 * v**2 * energy,
        stored_energy=lanes.inertia[0] * held * energy,
        dissipated_energy=lost * energy,
        peak_force=float(outcome.peak_force[0]),
        peak_depth=float(outcome.peak_depth[0]),
        peak_contact_radius=float(outcome.peak_contact_radius[0]),
    )


def estimates(outcome: ImpactResults, within: float, samples: int) -> dict[str, FloatArray]:
    """Errors of a single impact: of its outcome, and of its samples, which lie within steps too."""
    found = {name: outcome.relative_error[row] for row, name in enumerate(_OUTCOMES)}
    worst = float(max(error[0] for name, error in found.items() if name != "contact_time"))
    return found | dict.fromkeys(_SERIES, np.full(samples, worst + within))


def distinct(time: FloatArray) -> NDArray[np.bool_]:
    """Samples that are a visible time before the next one: steps share their ends."""
    return np.append(np.diff(time) > _SHORTEST * time[-1], True)


def _sampled(leg: Leg) -> FloatArray:
    """States at the samples in order of time, shape (m, n, 1)."""
    state = states(leg.trajectory, _Z)
    return np.swapaxes(state, 1, 2).reshape(state.shape[0], -1, 1)


def _pressing(lanes: ImpactLanes, leg: Leg) -> FloatArray:
    """Rows t, delta, v, force, y, stored and dissipated energy on the way in."""
    state = _sampled(leg)
    shared, memory, squares = outline(lanes.branches)
    springs = lanes.springs(state[0], leg.section, 6)
    g, k, own, past = springs[PROFILE], springs[STIFFNESS], state[shared], state[memory]
    f = force(lanes, springs, g, state[2], k * own - past)
    held = stored(lanes, springs, g, k * own**2 - 2.0 * own * past + state[squares])
    return np.stack([state[1], g, state[2], f, state[0], held, state[-1]])[..., 0]


def _receding(lanes: ImpactLanes, leg: Leg) -> FloatArray:
    """The same rows on the way out."""
    state = _sampled(leg)
    recall = leg.memory.recall(leg.step, np.arange(1)) if leg.memory is not None else None
    springs = lanes.springs(state[0], leg.section, 6)
    branches, _, _, strain = remembered(recall, lanes, state, springs[STIFFNESS])
    f = force(lanes, springs, state[2], state[3], branches)
    held = stored(lanes, springs, state[2], strain)
    return np.stack([state[1], state[2], state[3], f, state[0], held, state[-1]])[..., 0]
