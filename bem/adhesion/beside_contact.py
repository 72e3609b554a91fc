"""Refusal of adhering contacts beside which the indenter would touch the surface."""

from __future__ import annotations

from typing import Final

import numpy as np

from bem.adhesion.fields import AdheringFields
from contact import Scene
from contact.answer.one_circle import Circle, refuse_touching
from contact.records.validation import FloatArray

# States of a branch that are looked at, evenly spread: each takes a disc of its own.
STATES: Final = 20
# Cells of those discs, at most.
CELLS: Final = 256
# What their displacements may be off, relative to the larger of depth and height: three times the largest change of w
# beside 16 adhering contacts of random tables, 0.0042 from 128 to 256 cells and 0.0036 from 64 to 128 (seed 2,
# 2026-11-22).
ERROR: Final = 0.0125


def refuse_touching_beside(scene: Scene, radius: FloatArray, depth: FloatArray, points: int, threads: int) -> None:
    """Refuse contacts of radii [m] under depths [m] if the indenter would touch beside one of them.

    Raises:
        UnsupportedSceneError: With the contact radius and the radius of the deepest overlap.
    """
    if scene.indenter.is_convex:
        return
    chosen = np.linspace(0, radius.size - 1, min(radius.size, STATES)).round().astype(int)
    held = ((float(radius[i]), float(depth[i])) for i in chosen if radius[i] > 0.0)
    refuse_touching(scene, (_circle(scene, *state, min(points, CELLS), threads) for state in held))


def _circle(scene: Scene, radius: float, depth: float, cells: int, threads: int) -> Circle:
    fields = AdheringFields(scene, radius, depth, cells, threads)
    height = max(abs(depth), float(scene.indenter.height(radius)))
    return Circle(radius, depth, fields.surface_displacement, ERROR * height)
