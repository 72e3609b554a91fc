"""Impacts of flat punches, Eq. (48): from scenes to histories and results."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from bem.kernels.moduli import relaxation_of
from bem.layer_equation.protocol import FlatPunchSource
from bem.polynomials import chebyshev
from contact import ImpactHistory, Scene, StageLog
from contact.answer.solution import Setting
from contact.records.validation import FloatArray
from mdr.impact.collocation import EndCondition, Integrate, Trajectory, states
from mdr.impact.collocation_step import STAGES
from mdr.impact.energies import SAMPLES
from mdr.impact.flat_punch_equations import FlatPunchBatch
from mdr.impact.history import distinct, estimates
from mdr.impact.motion import COARSER
from mdr.impact.results import ImpactResults, fine_and_change, refuse_rest
from mdr.impact.units import impact_of
from mdr.springs.assembly import equivalent_system
from mdr.springs.error_model import DEFAULT_ACCURACY, EPS

# First step for a tolerance of one, in units of time; with the tolerance it goes as its tenth root. Chosen.
_FIRST_STEP = 1.4


@dataclass(frozen=True)
class _Problem:
    """Flat punches in units of depth v0 T, T the shorter of the elastic 1/omega and the dashpot's M/c."""

    lanes: FlatPunchBatch
    time: FloatArray
    stiffness: FloatArray
    velocity: FloatArray
    mass: FloatArray
    radius: FloatArray
    error: FloatArray


def flat_punch_results(
    scenes: Sequence[Scene],
    flat_punch: FlatPunchSource,
    integrate: Integrate,
    accuracy: float,
    *,
    tolerance: Callable[[float], float],
) -> ImpactResults:
    """Many flat punches with the same number of relaxation times; ``tolerance`` is that of steps for an accuracy."""
    problem = _problem(scenes, flat_punch)
    return _results(problem, _motion(problem, integrate, accuracy, tolerance), accuracy)


def flat_punch_history(
    scene: Scene,
    flat_punch: FlatPunchSource,
    log: StageLog,
    accuracy: float,
    *,
    integrate: Integrate,
    tolerance: Callable[[float], float],
    settings: Mapping[str, Setting],
) -> ImpactHistory:
    """One flat punch with its whole history."""
    with log.stage("equivalent_system"):
        problem = _problem([scene], flat_punch)
    with log.stage("impact"):
        motion = _motion(problem, integrate, accuracy, tolerance)
    log.count("steps", int(motion.counts.sum()))
    log.count("sweeps", motion.sweeps)
    outcome = _results(problem, motion, accuracy)
    motion = motion.of(0)
    _, t, delta, v, *branches, lost = _samples(motion)
    depth, force_unit = problem.velocity * problem.time, _force_unit(problem)
    energy = problem.mass * problem.velocity**2
    lanes = problem.lanes
    strain = [s**2 / weight for s, weight in zip(branches, lanes.weights[:, 0, 0], strict=True)]
    force = lanes.long_term * delta + lanes.viscosity * v + sum(branches)
    return ImpactHistory(
        scene=scene,
        method="mdr",
        settings=settings,
        error_estimate=estimates(outcome, float(motion.error[0]), t.size),
        cost=log.cost(unknowns=int(motion.final.shape[0])),
        stages=log.records,
        time=t * problem.time,
        indentation_depth=delta * depth,
        velocity=v * problem.velocity,
        normal_force=force * force_unit,
        contact_radius=np.full(t.size, problem.radius[0]),
        kinetic_energy=0.5 * v**2 * energy,
        stored_energy=0.5 * lanes.inertia * (lanes.long_term * delta**2 + sum(strain)) * energy,
        dissipated_energy=lost * energy,
        peak_force=float(outcome.peak_force[0]),
        peak_depth=float(outcome.peak_depth[0]),
        peak_contact_radius=float(outcome.peak_contact_radius[0]),
    )


def _problem(scenes: Sequence[Scene], flat_punch: FlatPunchSource) -> _Problem:
    radius = np.array([scene.indenter.max_radius for scene in scenes])
    systems = [equivalent_system(s.layer, s.indenter, s.indenter.max_radius, flat_punch) for s in scenes]
    stiffness = np.array([float(system.contact_stiffness(a)) for system, a in zip(systems, radius, strict=True)])
    mass = np.array([impact_of(scene).mass for scene in scenes])
    relaxations = [relaxation_of(scene) for scene in scenes]
    modulus = np.array([r.instantaneous_modulus for r in relaxations])
    lag = np.array([r.viscosity for r in relaxations]) / modulus
    time = 1.0 / (np.sqrt(stiffness / mass) + lag * stiffness / mass)
    lanes = FlatPunchBatch(
        long_term=np.array([r.long_term_modulus for r in relaxations]) / modulus,
        viscosity=lag / time,
        weights=np.stack([r.moduli for r in relaxations], axis=1)[:, None] / modulus,
        rates=time / np.stack([r.times for r in relaxations], axis=1)[:, None],
        inertia=stiffness * time**2 / mass,
    )
    velocity = np.array([impact_of(scene).velocity for scene in scenes])
    error = np.array([system.relative_error["contact_stiffness"] for system in systems])
    return _Problem(lanes, time, stiffness, velocity, mass, radius, error)


def _accuracy(problem: _Problem, accuracy: float) -> FloatArray:
    """Of each impact, shape (n,): beyond critical damping at least the default one.

    A dashpot then lets the force end at so flat an angle that the contact time loses four digits.
    """
    damping = 0.5 * problem.lanes.viscosity * np.sqrt(problem.lanes.inertia)
    return np.asarray(np.where(damping >= 1.0, min(accuracy, DEFAULT_ACCURACY), accuracy))


def _motion(
    problem: _Problem, integrate: Integrate, accuracy: float, tolerance: Callable[[float], float]
) -> Trajectory:
    """From first touch to the return of the force to zero, each impact once as asked and once more coarsely."""
    count = problem.mass.size
    lanes = problem.lanes.take(np.tile(np.arange(count), 2))
    fine = np.array([tolerance(float(own)) for own in _accuracy(problem, accuracy)])
    tolerances = np.append(fine, COARSER * fine)
    released = EndCondition(0, np.zeros(2 * count), -1)
    return integrate(
        lanes, lanes.start(), (released,), tolerance=tolerances, first_step=_FIRST_STEP * tolerances ** (1.0 / STAGES)
    )


def _force_unit(problem: _Problem) -> FloatArray:
    return problem.stiffness * problem.velocity * problem.time


def _results(problem: _Problem, motion: Trajectory, accuracy: float) -> ImpactResults:
    refuse_rest(motion.final[3, : problem.mass.size], problem.lanes.long_term)
    radius = np.tile(problem.radius, 2)
    both = np.stack([-motion.final[3], motion.final[1], _peak(motion, 0), _peak(motion, 2), radius])
    values, change = fine_and_change(both, _accuracy(problem, accuracy))
    # Force and speed carry a rounding of what they began with, eta and one; at no force v = -G_inf delta/eta is left.
    change[0] += 2.0 * EPS / values[0]
    return ImpactResults(
        # Rounded as the quotient of two speeds [m/s], which it is in a history.
        coefficient_of_restitution=values[0] * problem.velocity / problem.velocity,
        contact_time=values[1] * problem.time,
        peak_force=values[2] * _force_unit(problem),
        peak_depth=values[3] * problem.velocity * problem.time,
        peak_contact_radius=problem.radius.copy(),
        relative_error=change + problem.error,
    )


def _samples(motion: Trajectory) -> FloatArray:
    """States of a single lane in order of time, shape (m, n)."""
    state = np.swapaxes(states(motion, SAMPLES), 1, 2)[..., 0].reshape(motion.final.shape[0], -1)
    # The first sample is first touch and the last one the end itself, not the polynomials' rounded values there.
    state[1, 0], state[3, 0], state[:, -1] = 0.0, 1.0, motion.final[:, 0]
    return state[:, distinct(state[1])]


def _peak(motion: Trajectory, component: int) -> FloatArray:
    """Largest value of one component of the state, between samples too."""
    present = np.arange(motion.steps.shape[2])[:, None] < motion.counts
    powers = motion.steps[:, component].copy()
    powers[0] += motion.starts[component]
    return chebyshev.largest(powers, present)
