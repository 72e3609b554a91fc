"""The whole history of one impact: samples of motion, force and energies."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from contact import ImpactHistory, Scene, StageLog
from contact.answer.solution import Setting
from contact.records.validation import FloatArray
from mdr.impact.energies import samples
from mdr.impact.motion import Impacts
from mdr.impact.results import ImpactResults, results
from mdr.impact.units import ScaledImpacts

# Least time between two samples, in contact times: closer ones are one instant with rounding.
_SHORTEST = 1e-12
_SERIES = ("time", "indentation_depth", "velocity", "normal_force", "contact_radius")
_OUTCOMES = ("coefficient_of_restitution", "contact_time", "peak_force", "peak_depth", "peak_contact_radius")


def history(
    scene: Scene,
    problem: ScaledImpacts,
    motion: Impacts,
    log: StageLog,
    accuracy: float,
    *,
    settings: Mapping[str, Setting],
) -> ImpactHistory:
    """Samples of a single lane in SI units."""
    lanes = problem.lanes
    way_in, way_out = ([own for leg in way if (own := leg.of(0))] for way in (motion.way_in, motion.way_out))
    rows = samples(lanes, way_in, way_out)
    # The first sample is first touch and the last one the end itself, not the polynomials' rounded values there.
    rows[[0, 4], 0], rows[:3, -1], rows[4, -1] = 0.0, motion.end[1:4, 0], motion.end[0, 0]
    rows[:2, -1] += motion.drift[0] * np.array([1.0, rows[2, -1]])
    t, delta, v, f, y, held, lost = rows[:, distinct(rows[0])]
    outcome = results(problem, motion, accuracy)
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
        stored_energy=held * energy,
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
