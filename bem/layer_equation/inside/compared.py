"""Fields inside with errors by comparison: with those of finer data, whose own errors are added, or of coarser."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from bem.layer_equation.inside.interior import ContactInterior
from contact.answer.inside import InsideFields
from contact.records.validation import FloatArray

STRESSES = ("radial_stress", "hoop_stress", "axial_stress", "shear_stress", "hydrostatic_pressure")
SLOPES = ("pressure_gradient_radial", "pressure_gradient_axial")
# The share of the change that finer data may still be off by beside what they state: four times what was seen (0.014,
# 8 nodes, `campaign inside`, seed 9, scene 22 of 100, 4e-5 thicknesses below the free surface; 2026-11-22).
LEFT = 1.0 / 16.0
DISPLACEMENTS = ("radial_displacement", "axial_displacement")


@dataclass(frozen=True, eq=False)
class ComparedInterior:
    """Fields of one contact, and of the same by finer data.

    Attributes:
        own: What is returned.
        finer: What tells its error.
    """

    own: ContactInterior
    finer: ContactInterior

    def at(self, radius: FloatArray, depth: FloatArray) -> InsideFields:
        """At points [m] of shape (n,)."""
        found, finer = self.own.at(radius, depth), self.finer.at(radius, depth)
        changed = _changes(self.own, found, finer, of=finer)
        error = {kind: (1.0 + LEFT) * change + finer.error_estimate[kind] for kind, change in changed.items()}
        return replace(found, error_estimate=error)


@dataclass(frozen=True, eq=False)
class HalvedInterior:
    """Fields of one contact, and of the same by data half as fine.

    Attributes:
        own: What is returned, with the errors that both share.
        coarser: What tells the rest of its error.
        left: Share of the change that is left as error beside the edge, kinks and a tip.
        near: Length over which it falls to the change itself away from them, over the contact radius.
    """

    own: ContactInterior
    coarser: ContactInterior
    left: float
    near: float

    def at(self, radius: FloatArray, depth: FloatArray) -> InsideFields:
        """At points [m] of shape (n,)."""
        found, coarser = self.own.at(radius, depth), self.coarser.at(radius, depth)
        away = np.hypot(np.subtract.outer(self.own.rims, radius), depth).min(axis=0)
        times = 1.0 + (self.left - 1.0) * np.exp(-away / (self.near * self.own.known.radius))
        changed = _changes(self.own, found, coarser, of=found, times=times)
        error = {kind: change + found.error_estimate[kind] for kind, change in changed.items()}
        return replace(found, error_estimate=error)


def _changes(
    own: ContactInterior, found: InsideFields, other: InsideFields, of: InsideFields, times: FloatArray | float = 1.0
) -> dict[str, float]:
    """Differences of each kind of field, each point's so many times, over what errors are stated over."""
    length = own.unit * min(own.density.radius, own.scene.layer.thickness / own.unit)
    scales = scales_of(of, length, own.unit * own.depth)
    return {kind: change(found, other, names, times) / (scale or np.inf) for kind, (names, scale) in scales.items()}


def scales_of(found: InsideFields, length: float, depth: float) -> dict[str, tuple[tuple[str, ...], float]]:
    """Fields of each kind and what their errors are stated over.

    Args:
        found: The fields.
        length: The smaller of contact radius and thickness [m].
        depth: delta [m].
    """
    stress, steep = largest(found, STRESSES[:-1]), largest(found, SLOPES)
    return {
        "displacement": (DISPLACEMENTS, abs(depth)),
        "stress": (STRESSES, stress),
        "hydrostatic_pressure": (STRESSES, stress),
        "pressure_gradient": (SLOPES, max(steep, stress / length)),
    }


def largest(found: InsideFields, names: tuple[str, ...]) -> float:
    """Largest magnitude of some fields."""
    return max(float(np.abs(getattr(found, name)).max(initial=0.0)) for name in names)


def change(one: InsideFields, other: InsideFields, names: tuple[str, ...], times: FloatArray | float = 1.0) -> float:
    """Largest difference of some fields, each point's so many times."""
    return max(float((times * np.abs(getattr(one, name) - getattr(other, name))).max(initial=0.0)) for name in names)
