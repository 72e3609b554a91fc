"""From scenes to dimensionless impacts and back."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bem.kernels.moduli import relaxation_of, shear_modulus
from bem.layer_equation.protocol import FlatPunchSource
from contact import FlatPunch, Impact, Scene, UnsupportedSceneError
from contact.records.validation import FloatArray
from mdr.impact.equations import ImpactBatch
from mdr.springs.shared_tables import (
    SharedTable,
    contact_scale,
    coordinate_at,
    reference,
    table_for_energy,
)
from mdr.springs.table import PROFILE, STIFFNESS, SpringTable

# Long-term shares of the instantaneous modulus to which a layer is assumed to soften on the way in. A table made for
# the first is made anew for the next if the front runs beyond it.
SOFTEST = (0.02, 1e-3, 1e-5)


@dataclass(frozen=True)
class ScaledImpacts:
    """Impacts on one spring table.

    Attributes:
        lanes: Their dimensionless equations.
        length: Unit of the table's radii [m], shape (lanes,).
        depth: Unit of depth [m].
        time: Unit of time [s].
        stiffness: Unit of stiffness [N/m].
        velocity: v0 [m/s].
        mass: M [kg].
    """

    lanes: ImpactBatch
    length: FloatArray
    depth: FloatArray
    time: FloatArray
    stiffness: FloatArray
    velocity: FloatArray
    mass: FloatArray


def impact_of(scene: Scene) -> Impact:
    """The scene's loading, which must be an impact."""
    if not isinstance(scene.loading, Impact):
        raise UnsupportedSceneError(f"loading = {type(scene.loading).__name__}: an impact batch needs Impact")
    return scene.loading


def table_of(scene: Scene, flat_punch: FlatPunchSource, softest: float = SOFTEST[0]) -> tuple[SharedTable, SpringTable]:
    """The shared problem of one scene and a table for its impact on a layer that gets no softer than that meanwhile."""
    impact, layer = impact_of(scene), scene.layer
    energy = 0.5 * impact.mass * impact.velocity**2
    scale = contact_scale(layer, scene.indenter, energy)
    shared = reference(layer, scene.indenter, scale)
    soft = max(relaxation_of(scene).long_term_modulus / shear_modulus(layer), softest)
    needed = energy / (soft * shared.stiffness * shared.depth**2)
    return shared, table_for_energy(shared.layer, shared.indenter, scale / shared.length, needed, flat_punch)


def scaled(scenes: Sequence[Scene], references: Sequence[SharedTable], table: SpringTable) -> ScaledImpacts:
    """The dimensionless impacts of scenes that share a table and a number of Prony branches.

    The unit of depth is the smaller of the depths at which an elastic impact of the same energy, and a body that only
    dashpots slow down, come to rest: their impulse is eta/G times the elastic force there, since dF = k d(delta).
    """
    mass = np.array([impact_of(scene).mass for scene in scenes])
    velocity = np.array([impact_of(scene).velocity for scene in scenes])
    length, depth, stiffness = (
        np.array([getattr(r, name) for r in references]) for name in ("length", "depth", "stiffness")
    )
    relaxations = [relaxation_of(scene) for scene in scenes]
    modulus = np.array([r.instantaneous_modulus for r in relaxations])
    lag = np.array([r.viscosity for r in relaxations]) / modulus
    y = coordinate_at(table.survey.energy, table, 0.5 * mass * velocity**2 / (stiffness * depth**2))
    impulse = mass * velocity / (stiffness * depth)
    force = np.divide(impulse, lag, out=np.full(lag.shape, np.inf), where=lag > 0.0)
    y = np.minimum(y, coordinate_at(table.survey.force, table, force))
    rows = table.evaluate(y)
    g, k = rows[PROFILE], rows[STIFFNESS]
    units = np.stack([g, g / y, k, k / y, k * g, k * g**2, y])
    time = depth * g / velocity
    lanes = ImpactBatch(
        table=table,
        units=units,
        long_term=np.array([r.long_term_modulus for r in relaxations]) / modulus,
        viscosity=lag / time,
        weights=np.stack([r.moduli for r in relaxations], axis=1)[:, None] / modulus,
        rates=time / np.stack([r.times for r in relaxations], axis=1)[:, None],
        inertia=stiffness * k * (depth * g / velocity) ** 2 / mass,
    )
    return ScaledImpacts(lanes, length, depth * g, time, stiffness * k, velocity, mass)


def is_flat(scene: Scene) -> bool:
    """Whether the indenter is a flat punch, whose contact radius never changes."""
    return isinstance(scene.indenter, FlatPunch)
