"""Errors of the pressure that a flat-punch table gives: the whole field made of every coarser table as well.

A coarser table is off in stiffness, springs, profile and punch pressures together, and where depth or force are
prescribed the contact radius moves with it; in the pressure most of that cancels.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from bem.grid.error_model import TABLES
from bem.layer_equation.protocol import FlatPunchSolution
from contact import FlatPunch, Scene
from contact.records.validation import FloatArray
from mdr.springs.assembly import contact_fields
from mdr.springs.equivalent_system import LEAST_EXCESS, EquivalentSystem
from mdr.springs.table_errors import elastic_changes, size

# Radii at which pressures are compared.
RINGS: Final = 24
# A coarser table may move the excess over the flat radius by this factor, either way, at most.
LARGEST_MOVE: Final = 2.0


def pressure_errors(system: EquivalentSystem, scene: Scene, radius: FloatArray, depth: FloatArray) -> FloatArray:
    """Errors of the pressure under contacts of these radii [m] and depths [m], shape (n,) each.

    Under a punch the largest error of q, relative to its largest value; else in the norm weighted with 2 pi r.
    """
    if isinstance(scene.indenter, FlatPunch):
        return _punch_errors(system, radius / system.length_unit)
    changes = elastic_changes(system, scene.loading, radius, depth, is_punch=False)["contact_radius"]
    return np.array([_error(system, scene, *contact) for contact in zip(radius, depth, changes.T, strict=True)])


def _error(system: EquivalentSystem, scene: Scene, radius: float, depth: float, moved: FloatArray) -> float:
    """Of one contact, whose radius the variants move by some lengths [m], shares included.

    What no coarser table shows of q, Markov's inequality magnifies in the slope of a profile's polynomials.
    """
    rings = radius * np.sqrt((np.arange(RINGS) + 0.5) / RINGS)
    # The pressure is infinite at a kink, which a ring may meet.
    rings = rings[~np.isin(rings, scene.indenter.kinks)]
    least = max(radius - system.flat_radius, LEAST_EXCESS * radius)

    def pressure(table: FlatPunchSolution, way: float) -> FloatArray:
        """Pressure on the rings by one table, with the contact widened by a way."""
        end = min(LARGEST_MOVE * least, scene.indenter.max_radius - system.flat_radius, system.max_radius)
        excess = float(np.clip(least + way, least / LARGEST_MOVE, end))
        field = contact_fields(scene.layer, scene.indenter, table, excess=excess, depth=depth, edge=False)
        return field.pressure(rings)

    own = pressure(system.flat_punch, 0.0)
    changed = sum(
        share * float(np.linalg.norm(pressure(variant.flat_punch, way / share) - own))
        for (share, variant), way in zip(system.variants, moved, strict=False)
    )
    unseen = 2.0 * (system.flat_punch.nodes - 1) ** 2 * TABLES.pressure_floor
    return changed / float(np.linalg.norm(own)) + unseen


def _punch_errors(system: EquivalentSystem, ratio: FloatArray) -> FloatArray:
    """The largest of q under flat punches of these a/h."""
    rho = np.sin((np.arange(RINGS) + 0.5) * (np.pi / (2 * RINGS)))
    q = system.flat_punch.smooth_pressure(rho, ratio[:, None])
    changes = [share * (other.flat_punch.smooth_pressure(rho, ratio[:, None]) - q) for share, other in system.variants]
    return np.asarray(
        np.max((size(np.array(changes)) + TABLES.pressure_floor) / np.max(np.abs(q), axis=1)[:, None], axis=1)
    )
