"""Fields inside with errors by comparison: with those of finer data, whose own errors are added."""

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
        length = self.own.unit * min(self.own.density.radius, self.own.scene.layer.thickness / self.own.unit)
        scales = scales_of(finer, length, self.own.unit * self.own.depth)
        error = {
            kind: (1.0 + LEFT) * change(found, finer, names) / (scale or np.inf) + finer.error_estimate[kind]
            for kind, (names, scale) in scales.items()
        }
        return replace(found, error_estimate=error)


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


def change(one: InsideFields, other: InsideFields, names: tuple[str, ...]) -> float:
    """Largest difference of some fields."""
    return max(float(np.abs(getattr(one, name) - getattr(other, name)).max(initial=0.0)) for name in names)
