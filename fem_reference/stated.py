"""Stated errors of finite elements: an answer compared with its companion on coarser cells.

The rule is that of `contact.stated`: ``SAFETY |answer - companion| + floor``.  Cells, edge cell, outer edge,
half-space, narrow rings, nodes of a branch and time steps are all coarser in the companion.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TypeVar

import numpy as np

from contact import (
    Adhesion,
    ContactPath,
    ContactRadii,
    DepthHistory,
    FlatPunch,
    ForceHistory,
    IndentationDepths,
    NormalForces,
    Scene,
    Solution,
)
from contact.records.validation import FloatArray
from contact.stated import SAFETY
from fem_reference.equilibria import FemEquilibrium, change_beside
from fem_reference.settings import NARROW

S = TypeVar("S", bound=Solution)

# Rounding of every number, relative: a hundred times the backward error of linear solves.
FLOOR = 1e-12
# Least change of a number of a state, over the largest of them: two meshes may agree in one number by accident. With a
# tenth one stiffness in a hundred is missed by three, twice of it widens half of all stated errors.
LEAST_SHARE = 0.3
# Factor on changes next to an upright end nearer than `NARROW`, where meshes are uneven. With half of it a sphere
# 1e-7 before its equator is missed.
BEFORE_END = 2.0
# Which number a loading prescribes.
PRESCRIBED = {
    ContactRadii: "contact_radius",
    IndentationDepths: "indentation_depth",
    NormalForces: "normal_force",
    DepthHistory: "indentation_depth",
    ForceHistory: "normal_force",
}


def exact_names(scene: Scene) -> set[str]:
    """Quantities that are input."""
    names = {PRESCRIBED[type(scene.loading)]} if type(scene.loading) in PRESCRIBED else set()
    return names | ({"contact_radius", "peak_contact_radius"} if isinstance(scene.indenter, FlatPunch) else set())


def path_with_errors(
    answer: ContactPath,
    companion: ContactPath,
    states: Sequence[FemEquilibrium],
    coarser: Sequence[FemEquilibrium],
) -> ContactPath:
    """The path with its stated errors; the states are those of both paths."""
    uneven = np.array([BEFORE_END if s.contact.indenter.left_to_upright_end < NARROW else 1.0 for s in states])
    changes = {name: uneven * _with_neighbours(relative_change(answer, companion, name)) for name in answer.ARRAYS}
    exact = set() if answer.scene.effect(Adhesion) is not None else exact_names(answer.scene)
    least = LEAST_SHARE * np.max([changes[name] for name in answer.ARRAYS if name != "contact_radius"], axis=0)
    errors = {
        name: np.zeros(len(answer)) if name in exact else SAFETY * np.maximum(change, least) + FLOOR
        for name, change in changes.items()
    }
    pairs = list(zip(states, coarser, strict=True))
    pressures = np.array([pressure_change(*pair) for pair in pairs])
    moved = np.array([change_beside(*pair) for pair in pairs]) / answer.scale("indentation_depth")
    errors["pressure"] = SAFETY * pressures + FLOOR
    errors["surface_displacement"] = np.maximum(SAFETY * moved + FLOOR, errors["indentation_depth"])
    return replace(answer, error_estimate={**answer.error_estimate, **errors})


def _with_neighbours(change: FloatArray) -> FloatArray:
    """The largest change of a state and its neighbours along a path, in which one may vanish by accident."""
    return np.asarray(np.max([change, np.append(change[1:], 0.0), np.append(0.0, change[:-1])], axis=0))


def relative_change(answer: Solution, companion: Solution, name: str) -> FloatArray:
    """|answer - companion| of one quantity over its scale, zero where that is zero."""
    change = np.abs(np.atleast_1d(getattr(answer, name)) - np.atleast_1d(getattr(companion, name)))
    scale = np.broadcast_to(answer.scale(name), change.shape)
    return np.asarray(np.divide(change, scale, out=np.zeros_like(change), where=scale > 0))


def pressure_change(state: FemEquilibrium, other: FemEquilibrium) -> float:
    """Distance of two pressures over the norm of the first: L2 with the weight ``2 pi r``, each by its own radius.

    A pressure that is singular at the edge, under flat punches and with adhesion, takes the weight
    ``2 pi r (1 - r^2 / a^2)``.
    """
    contact, a, b = state.contact, state.contact_radius, other.contact_radius
    radius, weight = (values.ravel() for values in contact.contact_trace.gauss(contact.layer.pair.degree + 2))
    fine, coarse = state.pressure(radius * a), other.pressure(radius * b)
    if abs(state.depth - contact.smooth_depth) > 1e-2 * abs(state.depth):
        weight = weight * np.maximum(1.0 - radius**2, 0.0)
    return float(np.sqrt(weight @ (fine - coarse) ** 2 / (weight @ fine**2)))
