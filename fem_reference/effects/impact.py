r"""A rigid body hits a (visco)elastic layer: Newton's equation with the contact set solved in every step.

The trapezoidal rule for the body makes kinetic energy and work balance exactly.  It gives
``delta_1 = delta_0 + dt v_0 - dt^2 (F_0 + F_1) / (4 M)``, linear in F_1 = w . p_1; inserted into the contact conditions
the depth disappears, and a step is one complementarity problem with the matrix

    A + kappa w w^T,      kappa = dt^2 / (4 M).
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from contact import NotConvergedError, Relaxation
from fem_reference.active_set import solve_complementarity
from fem_reference.effects.relaxation_step import relaxation_step
from fem_reference.effects.stage import Stage
from fem_reference.unknown_contact import edge_radius

Array = NDArray[np.float64]

MAX_STEPS = 200_000


@dataclass(frozen=True, kw_only=True)
class Body:
    """The impacting body in the units of its stage.

    Attributes:
        mass: M / (G_0 L) [s^2].
        velocity: v_0 / L [1/s].
    """

    mass: float
    velocity: float


@dataclass
class Record:
    """Samples of a history, in the units of its stage."""

    time: list[float] = field(default_factory=list)
    depth: list[float] = field(default_factory=list)
    velocity: list[float] = field(default_factory=list)
    force: list[float] = field(default_factory=list)
    radius: list[float] = field(default_factory=list)
    stored: list[float] = field(default_factory=list)
    dissipated: list[float] = field(default_factory=list)

    def add(self, **sample: float) -> None:
        """Append one sample."""
        for name, value in sample.items():
            getattr(self, name).append(value)


def simulate_impact(stage: Stage, body: Body, relaxation: Relaxation, duration: float) -> Record:
    """Steps of ``duration`` [s] from first touch to the loss of contact.

    Raises:
        NotConvergedError: the body never comes off (a layer without long-term elasticity may hold it).
    """
    surface = stage.surface
    step = relaxation_step(relaxation, duration)
    kappa = duration**2 / (4 * body.mass)
    w = surface.resultants
    depth, velocity = 0.0, body.velocity
    force = first_force(stage, body, relaxation, duration)
    record = Record()
    record.add(time=0.0, depth=0.0, velocity=velocity, force=force, radius=0.0, stored=0.0, dissipated=0.0)
    active = None
    for n in range(1, MAX_STEPS):
        matrix, offset = surface.begin(step)
        ballistic = depth + duration * velocity - kappa * force
        approach = ballistic * w - stage.profile - offset
        state = solve_complementarity(matrix + kappa * np.outer(w, w), approach, active)
        active = state.active
        following = float(w @ state.pressure)
        mean = (force + following) / 2
        depth += duration * velocity - duration**2 * mean / (2 * body.mass)
        velocity -= duration * mean / body.mass
        surface.accept(step, state.pressure)
        if following == 0 and velocity < 0:
            fraction = _release_fraction(record.force)
            record.add(
                time=record.time[-1] + fraction * duration,
                depth=record.depth[-1] + fraction * (depth - record.depth[-1]),
                velocity=record.velocity[-1] + fraction * (velocity - record.velocity[-1]),
                force=0.0,
                radius=0.0,
                stored=surface.stored_energy,
                dissipated=surface.dissipated_energy,
            )
            return record
        record.add(
            time=n * duration,
            depth=depth,
            velocity=velocity,
            force=following,
            radius=edge_radius(stage.radii, state.pressure),
            stored=surface.stored_energy,
            dissipated=surface.dissipated_energy,
        )
        force = following
    raise NotConvergedError("the body does not come off", {"last_force": force, "last_velocity": velocity})


def first_force(stage: Stage, body: Body, relaxation: Relaxation, duration: float) -> float:
    """Force at first touch: that of the dashpots under the part of the profile that is flat."""
    if relaxation.viscosity == 0:
        return 0.0
    instant = relaxation_step(relaxation, 1e-9 * duration)
    surface = stage.surface
    matrix, offset = surface.begin(instant)
    approach = 1e-9 * duration * body.velocity * surface.resultants - stage.profile - offset
    return float(surface.resultants @ solve_complementarity(matrix, approach).pressure)


def _release_fraction(force: list[float]) -> float:
    """Part of the last step after which contact is lost: where the force, continued in a straight line, vanishes."""
    falling = force[-2] - force[-1] if len(force) > 1 else 0.0
    return min(1.0, force[-1] / falling) if falling > 0 else 1.0
