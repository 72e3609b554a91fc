r"""A rigid body hits a (visco)elastic layer: Newton's equation with the contact set solved in every step.

The trapezoidal rule for the body makes kinetic energy and work balance exactly.  It gives
``delta_1 = delta_0 + dt v_0 - dt^2 (F_0 + F_1) / (4 M)``, linear in F_1 = w . p_1; inserted into the contact conditions
the depth disappears, and a step is one complementarity problem with the matrix

    A + kappa w w^T,      kappa = dt^2 / (4 M).
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from contact import NotConvergedError
from fem_reference.elastic.active_set import solve_complementarity
from fem_reference.elastic.contact_search import edge_radius
from fem_reference.in_time.condensed_layer import CondensedLayer
from fem_reference.in_time.relaxation import ShearRelaxation
from fem_reference.in_time.relaxation_step import RelaxationStep, relaxation_step

# Steps after which a body counts as held by the layer: five hundred times what an impact at the default settings takes.
MAX_STEPS = 200_000


@dataclass(frozen=True, kw_only=True)
class FallingBody:
    """The impacting body in the units of its condensed layer.

    Attributes:
        mass: M / (G_0 L) [s^2].
        velocity: v_0 / L [1/s].
    """

    mass: float
    velocity: float


@dataclass
class HistorySamples:
    """Samples of a history, in the units of its condensed layer."""

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


def simulate_impact(
    condensed: CondensedLayer, body: FallingBody, relaxation: ShearRelaxation, duration: float
) -> HistorySamples:
    """Steps of ``duration`` [s] from first touch to the loss of contact.

    Raises:
        NotConvergedError: the body never comes off (a layer without long-term elasticity may hold it).
    """
    surface = condensed.surface
    step = relaxation_step(relaxation, duration)
    force = touch(condensed, body, step)
    kappa = duration**2 / (4 * body.mass)
    w = surface.resultants
    depth, velocity = 0.0, body.velocity
    record = HistorySamples()
    record.add(time=0.0, depth=0.0, velocity=velocity, force=force, radius=0.0, stored=0.0, dissipated=0.0)
    active, overlaps = None, (0.0, 0.0, 0.0)
    for n in range(1, MAX_STEPS):
        now = step.first if n == 1 else step
        matrix, offset = surface.begin(now)
        ballistic = depth + duration * velocity - kappa * force
        approach = ballistic * w - condensed.profile - offset
        state = solve_complementarity(matrix + kappa * np.outer(w, w), approach, active)
        surface.accept(now, state.pressure)
        following, overlaps = float(w @ state.pressure), (*overlaps[1:], float((approach / w).max()))
        mean, active = (force + following) / 2, state.active
        is_free = following == 0 and velocity - duration * mean / body.mass < 0
        part = duration * (_release_fraction(*overlaps) if is_free else 1.0)
        depth += part * velocity - part * duration * mean / (2 * body.mass)
        velocity -= part * mean / body.mass
        force = following
        record.add(
            time=record.time[-1] + part,
            depth=depth,
            velocity=velocity,
            force=force,
            radius=edge_radius(condensed.radii, state.pressure),
            stored=surface.stored_energy,
            dissipated=surface.dissipated_energy,
        )
        if is_free:
            return record
    raise NotConvergedError("the body does not come off", {"last_force": force, "last_velocity": velocity})


def touch(condensed: CondensedLayer, body: FallingBody, step: RelaxationStep) -> float:
    """Force at first touch: that of the dashpots under the part of the profile that is flat."""
    if step.dashpot == 0:
        return 0.0
    instant, surface = step.instant, condensed.surface
    matrix, offset = surface.begin(instant)
    approach = instant.duration * body.velocity * surface.resultants - condensed.profile - offset
    pressure = solve_complementarity(matrix, approach).pressure
    surface.accept(instant, pressure)
    return float(surface.resultants @ pressure)


def _release_fraction(earlier: float, before: float, after: float) -> float:
    """Part of the last step after which contact is lost, from the overlap at its ends and one step earlier.

    The overlap of the indenter with the surface as it would be without pressure passes zero there, and smoothly, while
    the force of a round indenter vanishes like its power 3/2. The zero is that of the parabola through the three: a
    straight line would err by the second order of the step times a factor that moves with the place of the zero.
    """
    if not before > 0 > after:
        return 1.0
    slope, bend = (after - earlier) / 2, (after - 2 * before + earlier) / 2
    return float(2 * before / (-slope + np.sqrt(slope**2 - 4 * bend * before)))
