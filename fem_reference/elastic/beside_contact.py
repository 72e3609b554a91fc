"""Refusal of contacts beside which the indenter would touch the surface."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from contact import Scene, StageLog
from contact.answer.one_circle import Circle, refuse_touching
from fem_reference.elastic.at_load import quick_solution
from fem_reference.elastic.error_estimate import ContactWithErrors
from fem_reference.elastic.prescribed_radius import PrescribedContact

Array = NDArray[np.float64]

# Relative error of the depth in a quick solution: three times the largest difference to MDR, 6e-5, on 16 random tables
# (seed 2, 2026-11-22).
QUICK_ERROR = 2e-4


def refuse_touching_contacts(scene: Scene, states: Iterable[tuple[ContactWithErrors, float]]) -> None:
    """Refuse contacts, each with its depth / a, if the indenter would touch beside one of them.

    Raises:
        UnsupportedSceneError: With the contact radius and the radius of the deepest overlap.
    """
    circles = (
        _circle(contact.answer, contact.indenter.contact_radius, depth, contact.error["smooth_depth"])
        for contact, depth in states
    )
    refuse_touching(scene, circles)


def refuse_touching_at(scene: Scene, radius: float, log: StageLog) -> None:
    """The same for the largest contact [m] of a motion: while it grew, the surface moved as on an elastic layer.

    A compressible layer that relaxes changes its Poisson's ratio meanwhile; here it keeps that of the scene.

    Raises:
        UnsupportedSceneError: With the contact radius and the radius of the deepest overlap.
    """
    if scene.indenter.is_convex or radius <= scene.indenter.flat_radius:
        return
    contact = quick_solution(scene, radius, log)
    refuse_touching(scene, [_circle(contact, radius, contact.smooth_depth, QUICK_ERROR)])


def _circle(contact: PrescribedContact, radius: float, depth: float, error: float) -> Circle:
    """In SI units. Pressed deeper than smooth contact, as a last correction leaves it, the edge overlaps by as much."""

    def displacement(r: Array) -> Array:
        return radius * contact.surface_displacement(r / radius, depth)

    tolerance = error * max(abs(depth), contact.smooth_depth) + max(depth - contact.smooth_depth, 0.0)
    return Circle(radius, radius * depth, displacement, radius * tolerance)
