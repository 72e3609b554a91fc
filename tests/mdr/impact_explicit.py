"""The paper's explicit scheme: one rheological element per spring, Eqs. (51) and (52), Euler steps in time.

First order in spring distance and time step. It shares with `impact` the springs and nothing else, and is there to
check it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from contact import NotConvergedError
from contact.records.validation import FloatArray
from contact.scene.effects import Relaxation


class Springs(Protocol):
    """What the scheme asks of an equivalent system."""

    def spring_stiffness(self, x: FloatArray) -> FloatArray:
        """c_N(x) [Pa]."""

    def mdr_profile(self, x: FloatArray) -> FloatArray:
        """g(x) [m]."""


@dataclass(frozen=True, kw_only=True)
class ExplicitImpact:
    """Outcome of the explicit scheme.

    Attributes:
        coefficient_of_restitution: [-].
        contact_time: [s].
        peak_force: [N].
        peak_depth: [m].
    """

    coefficient_of_restitution: float
    contact_time: float
    peak_force: float
    peak_depth: float


def explicit_impact(
    springs: Springs,
    relaxation: Relaxation,
    *,
    mass: float,
    velocity: float,
    radius: float,
    count: int,
    time_step: float,
    max_steps: int = 1_000_000,
) -> ExplicitImpact:
    """March an impact in time.

    Args:
        springs: The equivalent system, for the instantaneous modulus of the layer.
        relaxation: Shear relaxation; a bare dashpot and Maxwell elements may stand together.
        mass: M [kg].
        velocity: v0 [m/s].
        radius: Where the outermost spring stands [m]; beyond the largest contact radius.
        count: Number of springs on [0, radius].
        time_step: [s].
        max_steps: Refuse an impact that lasts longer.

    Raises:
        NotConvergedError: If contact is not lost within `max_steps`.
    """
    width = radius / count
    x: FloatArray = width * (np.arange(count, dtype=np.float64) + 0.5)
    modulus = relaxation.instantaneous_modulus
    stiffness = 2.0 * width * springs.spring_stiffness(x) / modulus  # 2 * 4 dx c_bar of Eq. (51), both sides of x = 0
    profile = springs.mdr_profile(x)
    inner = np.zeros((relaxation.moduli.size, count))  # displacement of the inner points, Eq. (52)
    touching, released = np.zeros(count, dtype=np.bool_), np.zeros(count, dtype=np.bool_)
    depth, speed, peak_force, peak_depth = 0.0, velocity, 0.0, 0.0
    for step in range(1, max_steps + 1):
        depth += speed * time_step
        touching |= (depth > profile) & ~released
        rate = speed - inner / relaxation.times[:, None]  # Eq. (52)
        inner += np.where(touching, rate * time_step, 0.0)
        force = _spring_forces(relaxation, depth - profile, speed, inner)
        released |= touching & (force < 0.0)
        touching &= ~released
        total = float(stiffness @ np.where(touching, force, 0.0))
        speed -= total / mass * time_step
        peak_force, peak_depth = max(peak_force, total), max(peak_depth, depth)
        if not touching.any():
            return ExplicitImpact(
                coefficient_of_restitution=-speed / velocity,
                contact_time=step * time_step,
                peak_force=peak_force,
                peak_depth=peak_depth,
            )
    raise NotConvergedError(f"the indenter is still in contact after {max_steps} steps; lengthen the time step")


def _spring_forces(relaxation: Relaxation, w: FloatArray, speed: float, inner: FloatArray) -> FloatArray:
    """Eq. (51) without its factor 4 dx c_bar, w_inner' eliminated by Eq. (52)."""
    return np.asarray(relaxation.long_term_modulus * w + relaxation.viscosity * speed + relaxation.moduli @ inner)
