"""The answer to many loads: radii are added until interpolation errs less than the solved contacts do."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from contact import ContactPath, IndentationDepths, Scene, StageLog
from contact.answer.friction import told_of_friction
from contact.records.validation import FloatArray
from fem_reference.discrete_layer.material import contact_modulus
from fem_reference.discrete_layer.settings import narrowest_radius
from fem_reference.elastic.answer import OWN_CHECKS
from fem_reference.elastic.at_load import Load
from fem_reference.elastic.error_estimate import ContactWithErrors
from fem_reference.elastic.many_loads.curve import LoadCurve, leja_points
from fem_reference.elastic.many_loads.fields import FieldsOnDemand
from fem_reference.elastic.path import ContactSolver

# Radii of the first curve, and how many each next one has more.  Chosen.
FIRST, STEP = 3, 2
# The error of a curve over its change from the one before is this times the fall of these changes, within the bounds
# after it.  Measured on exact data (MDR, curves of random layers and profiles through 7 to 17 radii, seeds 51 and 52,
# 2026-11-23): 95 of 100 errors are below, and stated 9.5 times too large in the median; by the change itself, 26 times.
PER_FALL, BOUNDS = 4.0, (0.3, 1.0)
# Share of an accuracy that interpolation may cost; chosen.
SHARE = 0.5
# Solved radii go beyond those found for the first and last load by this factor of a - b.  Chosen: coarse solutions find
# them to 1e-3, and all loads have to lie between solved radii.
MARGIN = 1.01


def interpolated_path(
    scene: Scene,
    found: Callable[[float], Load],
    solve: ContactSolver,
    *,
    accuracy: float | None,
    settings: Mapping[str, bool | int | float | str | None],
    log: StageLog,
) -> ContactPath | None:
    """The states of a scene that `are_many`; None where interpolation does not reach what single states do.

    Args:
        scene: the scene.
        found: finds the contact radius of one load, a depth [m] or a force / E* [m^2], to a per cent of a - b.
        solve: contact of a given radius [m].
        accuracy: relative accuracy wanted; without one, interpolation errs less than elements.
        settings: of the method, to be told in the answer.
        log: of the stages.
    """
    by_depth, modulus = isinstance(scene.loading, IndentationDepths), contact_modulus(scene.layer)
    loads = scene.loading.values / (1.0 if by_depth else modulus)  # type: ignore[attr-defined]
    curve, errors = _curve_through(scene, loads, found, solve, accuracy)
    if curve is None:
        return None
    contacts = curve.contacts
    radius, depth, force, stiffness = curve.at(loads)
    checks = {name: np.full(len(loads), max(getattr(c.answer, name) for c in contacts)) for name in OWN_CHECKS}
    note = f"{len(loads)} states interpolated between {len(contacts)} solved contact radii"
    return ContactPath(
        scene=scene,
        method="fem",
        settings={**settings, "mesh": ", ".join(dict.fromkeys(c.layer_mesh.fingerprint for c in contacts))},
        error_estimate={**errors, **checks},
        cost=log.cost(unknowns=max(c.answer.unknowns for c in contacts)),
        stages=log.records,
        notes=(note, *told_of_friction(scene.layer, radius)),
        contact_radius=radius,
        indentation_depth=depth,
        normal_force=modulus * force,
        contact_stiffness=modulus * stiffness,
        fields=FieldsOnDemand(solve, tuple(radius.tolist()), tuple(loads.tolist()), by_depth, modulus),
    )


def _curve_through(
    scene: Scene,
    loads: FloatArray,
    found: Callable[[float], Load],
    solve: ContactSolver,
    accuracy: float | None,
) -> tuple[LoadCurve | None, dict[str, FloatArray]]:
    """The curve and its errors at loads; no curve where the profile is broken or the accuracy out of reach."""
    by_depth = isinstance(scene.loading, IndentationDepths)
    flat = scene.indenter.flat_radius
    ends = [found(float(end)).radius - flat for end in (loads.min(), loads.max())]
    low, high = flat + ends[0] / MARGIN, min(flat + ends[1] * MARGIN, scene.indenter.max_radius)
    is_broken = any(low < r < high for r in scene.indenter.breakpoints)
    if is_broken or low <= narrowest_radius(scene.layer, scene.indenter):
        return None, {}
    curve, missed = _interpolated(flat, by_depth, (low, high), solve, most=len(loads) // 2, accuracy=accuracy)
    if curve is None:
        return None, {}
    errors = dict(curve.errors(loads))
    between = zip(ContactPath.ARRAYS, missed, strict=True)
    errors |= {name: errors[name] + error for name, error in between}
    errors["indentation_depth" if by_depth else "normal_force"] = np.zeros(len(loads))
    meets = accuracy is None or max(float(errors[name].max()) for name in ContactPath.ASKED) <= accuracy
    return (curve if meets else None), errors


def _interpolated(
    flat: float, by_depth: bool, ends: tuple[float, float], solve: ContactSolver, *, most: int, accuracy: float | None
) -> tuple[LoadCurve | None, FloatArray]:
    """The first curve between two radii [m] that interpolates well enough, with its errors."""
    low, high = (end - flat for end in ends)
    contacts: list[ContactWithErrors] = []
    changes: list[FloatArray] = []
    curve, errors = None, np.full(4, np.inf)
    for count in range(FIRST, most + 1, STEP):
        added = leja_points(count)[len(contacts) :]
        contacts += [solve(flat + low * (high / low) ** share) for share in added.tolist()]
        in_order = sorted(contacts, key=lambda contact: contact.indenter.contact_radius)
        coarser, curve = curve, LoadCurve(flat=flat, by_depth=by_depth, contacts=in_order)
        if coarser is None:
            continue
        changes.append(curve.change_from(coarser))
        if len(changes) == 1:
            continue
        fall = changes[-1].max() / max(changes[-2].max(), np.finfo(float).tiny)
        errors = changes[-1] * np.clip(PER_FALL * fall, *BOUNDS)
        stated = np.array([max(state.error[name] for state in curve.states) for name in ContactPath.ARRAYS])
        allowed = SHARE * (stated if accuracy is None else np.full(4, accuracy))
        if np.all((errors <= allowed) | (stated == 0.0)):
            return curve, errors
    return None, errors
