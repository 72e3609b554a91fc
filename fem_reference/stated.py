"""Stated errors of finite elements, and settings that are refined until they are below a requested accuracy.

The rule is that of `contact.stated`: ``SAFETY |answer - companion| + floor``. Cells, edge cell, outer edge, half-space,
narrow rings, nodes of a branch and time steps are all coarser in the companion.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
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
    NotConvergedError,
    Scene,
    Solution,
)
from contact.answer.accuracy import shortfalls
from contact.records.validation import FloatArray
from contact.stated import SAFETY, stated_error
from fem_reference.equilibria import FemEquilibrium, outside_change
from fem_reference.prescribed_contact import PrescribedContact
from fem_reference.settings import Discretisation

S = TypeVar("S", bound=Solution)

# Rounding of every number, relative: a hundred times the backward error of linear solves.
FLOOR = 1e-12
# Least change of a number of a state, over the largest of them: two meshes may agree in one number by accident. With a
# tenth one stiffness in a hundred is missed by three, twice of it widens half of all stated errors.
LEAST_SHARE = 0.3
# Power of the growth with which stated errors of P4P3 fall on graded meshes. It determines the next mesh only: a wrong
# value costs attempts, no accuracy.
ERROR_ORDER = 7.0
# Stated error of P4P3 at growth 1/2 on punches, cones and paraboloids. It determines the first mesh only.
ERROR_AT_HALF = 2e-5
# Truncation at the outer edge over the accuracy. At a load most other errors cancel to a hundredth of the accuracy, the
# truncation error does not: with a hundred times as much it dominates the stated error of unbonded layers.
FAR_SHARE = 1e-5
# Power of the growth with which the error of the pressure falls.
PRESSURE_ORDER = 3.0
# Growth of the first mesh of a motion: its cells and steps err like powers of one to two.
MOTION_GROWTH = 1.0
# Largest number of meshes that are tried for an accuracy.
ATTEMPTS = 6
# A finer mesh is in vain if its excess over the accuracy is more than this share of the last excess. After two in a row
# the accuracy is refused, before a mesh fills the memory.
LEFT, IN_VAIN = 0.8, 2
# Quantity that a loading prescribes.
PRESCRIBED = {
    ContactRadii: "contact_radius",
    IndentationDepths: "indentation_depth",
    NormalForces: "normal_force",
    DepthHistory: "indentation_depth",
    ForceHistory: "normal_force",
}


def exact_names(scene: Scene) -> set[str]:
    """Names of the quantities that loading or geometry prescribes; their stated error is zero."""
    names = {PRESCRIBED[type(scene.loading)]} if type(scene.loading) in PRESCRIBED else set()
    return names | ({"contact_radius", "peak_contact_radius"} if isinstance(scene.indenter, FlatPunch) else set())


def path_with_errors(
    answer: ContactPath,
    companion: ContactPath,
    states: Sequence[FemEquilibrium],
    coarser: Sequence[FemEquilibrium],
) -> ContactPath:
    """The path with its relative stated errors, one per state.

    Args:
        answer: path of the answer.
        companion: the same path on coarser cells.
        states: equilibria of the answer.
        coarser: equilibria of the companion.
    """
    errors = {
        name: stated_error(getattr(answer, name), getattr(companion, name), scale=answer.scale(name), floor=FLOOR)
        for name in answer.ARRAYS
    }
    least_error = LEAST_SHARE * np.max([errors[name] for name in errors if name != "contact_radius"], axis=0)
    # At a load the error of the radius changes the stiffness, too.
    by_radius = LEAST_SHARE * errors["contact_radius"]
    errors["contact_stiffness"] = np.maximum(errors["contact_stiffness"], by_radius)
    prescribed = set() if answer.scene.effect(Adhesion) is not None else exact_names(answer.scene)
    errors = {
        name: 0.0 * error if name in prescribed else np.maximum(error, least_error) for name, error in errors.items()
    }
    pairs = list(zip(states, coarser, strict=True))
    displacements = SAFETY * np.array([outside_change(*pair) for pair in pairs]) / answer.scale("indentation_depth")
    errors["pressure"] = SAFETY * np.array([pressure_change(*pair) for pair in pairs]) + FLOOR
    errors["surface_displacement"] = np.maximum(displacements + FLOOR, errors["indentation_depth"])
    return replace(answer, error_estimate={**answer.error_estimate, **errors})


def pressure_change(state: FemEquilibrium, other: FemEquilibrium) -> float:
    """L2 distance of two pressures as functions of r / a, over the norm of the first, with weight ``2 pi r``.

    Under flat punches and with adhesion p grows like ``(a - r)^(-1/2)`` at the edge, and p^2 is not integrable. There
    the weight is ``2 pi r (1 - r^2 / a^2)``.
    """
    radius, weight = contact_rule(state.contact)
    if abs(state.depth - state.contact.smooth_depth) > 1e-2 * abs(state.depth):
        weight = weight * (1.0 - radius**2)
    fine, coarse = (each.pressure(radius * each.contact_radius) for each in (state, other))
    return l2_change(weight, fine, coarse, fine)


def contact_rule(contact: PrescribedContact) -> tuple[FloatArray, FloatArray]:
    """Radii r / a and weights ``2 pi r dr`` of a quadrature rule over the contact, shape (n,) each."""
    radius, weight = contact.contact_trace.gauss(contact.layer.pair.degree + 2)
    return np.minimum(radius.ravel(), 1.0), weight.ravel()


def l2_change(weight: FloatArray, fine: FloatArray, coarse: FloatArray, size: FloatArray) -> float:
    """L2 distance of two fields over the norm of a third one, from values (n,) at points with quadrature weights."""
    return float(np.sqrt(weight @ (fine - coarse) ** 2 / (weight @ size**2)))


def settings_for(accuracy: float) -> Discretisation:
    """A discretisation that usually meets ``accuracy`` (relative) at the first attempt."""
    # Beyond a growth of one a mesh has fewer than a hundred triangles, on which errors follow no law.
    growth = float(np.clip(0.5 * (accuracy / ERROR_AT_HALF) ** (1 / ERROR_ORDER), 0.05, 1.0))
    return Discretisation(
        order=4,
        growth=growth,
        edge_cell=float(np.clip(accuracy / 20, 1e-11, 1e-3)),
        truncation=max(FAR_SHARE * accuracy, 1e-13),
        half_space_thickness=float(np.clip(1000 / accuracy, 1e3, 1e12)),
    )


def solve_to_accuracy(
    attempt: Callable[[Discretisation], S], accuracy: float, pressure_accuracy: float | None, *, moves: bool
) -> S:
    """First answer whose stated errors are all within the required accuracy.

    Args:
        attempt: function that solves the scene with given settings.
        accuracy: required relative accuracy of the numbers.
        pressure_accuracy: required relative accuracy of the pressure, or None.
        moves: whether the scene is a motion, whose errors fall slowly.

    Raises:
        NotConvergedError: `ATTEMPTS` did not suffice, or finer meshes do not lessen the error.
    """
    settings = settings_for(accuracy)
    if moves:
        settings = replace(settings, growth=MOTION_GROWTH)
    last_excess, in_vain = np.inf, 0
    for attempts_left in reversed(range(ATTEMPTS)):
        try:
            answer = attempt(settings)
        except NotConvergedError:
            # On coarse meshes the radius of a load near a flat end may not settle.
            in_vain += 1
            if not attempts_left or in_vain == IN_VAIN:
                raise
            settings = _finer(settings, 0.5, moves=False)
            continue
        missed = shortfalls(answer, accuracy, pressure_accuracy)
        if not missed:
            return answer
        excess = {n: e / (accuracy if n != "pressure" else pressure_accuracy or accuracy) for n, e in missed.items()}
        worst = max(excess, key=lambda name: excess[name])
        in_vain, last_excess = in_vain + 1 if excess[worst] > LEFT * last_excess else 0, excess[worst]
        if in_vain == IN_VAIN:
            break
        order = PRESSURE_ORDER if worst == "pressure" else ERROR_ORDER
        settings = _finer(settings, float(np.clip(0.9 * excess[worst] ** (-1 / order), 0.5, 0.9)), moves=moves)
    why = "; finer meshes do not lessen its error" if in_vain == IN_VAIN else ""
    required = pressure_accuracy if worst == "pressure" else accuracy
    raise NotConvergedError(
        f"accuracy {required:g} of the {worst.replace('_', ' ')} was not reached{why}",
        {"estimated_error": missed[worst]},
    )


def _finer(settings: Discretisation, factor: float, *, moves: bool) -> Discretisation:
    """Settings for the next attempt: the growth times a factor, in a motion, whose cells and steps are halved, 1/2."""
    if moves:
        return replace(settings, growth=settings.growth / 2)
    return replace(
        settings,
        growth=max(settings.growth * factor, 0.02),
        # Near the edge the error of the pressure falls like the root of the edge cell.
        edge_cell=max(settings.edge_cell / 16, 1e-12),
        truncation=max(settings.truncation / 10, 1e-13),
    )
