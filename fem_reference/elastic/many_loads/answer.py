"""The answer to many loads: radii are doubled until those in between are foretold well enough.

What they were missed by is the error that is stated of the interpolation.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from contact import ContactPath, IndentationDepths, Scene, StageLog
from contact.answer.friction import told_of_friction
from contact.records.validation import FloatArray
from fem_reference.discrete_layer.material import contact_modulus
from fem_reference.discrete_layer.settings import narrowest_radius
from fem_reference.elastic.error_estimate import ContactWithErrors
from fem_reference.elastic.many_loads.curve import LoadCurve, grid
from fem_reference.elastic.many_loads.fields import FieldsOnDemand
from fem_reference.elastic.path import OWN_CHECKS, ContactSolver, FemEquilibrium

# Solved radii, each grid with the one before in it; at most half as many as there are loads.
GRIDS = (5, 9, 17, 33)
# Share of an accuracy that interpolation may cost; chosen.
SHARE = 0.3
# The largest radius exceeds the smallest, both from the flat end, by this factor at least: closer loads are solved one
# by one.  Chosen.
WIDE = 1.01


def interpolated_path(
    scene: Scene,
    at_load: Callable[[float], FemEquilibrium],
    solve: ContactSolver,
    *,
    accuracy: float | None,
    settings: Mapping[str, bool | int | float | str | None],
    log: StageLog,
) -> ContactPath | None:
    """The states of a scene that `are_many`; None where interpolation does not reach what single states do.

    Args:
        scene: the scene.
        at_load: solves one load: a depth [m], or a force / E* [m^2].
        solve: contact of a given radius [m].
        accuracy: relative accuracy wanted; without one, interpolation errs less than elements.
        settings: of the method, to be told in the answer.
        log: of the stages.
    """
    by_depth, modulus = isinstance(scene.loading, IndentationDepths), contact_modulus(scene.layer)
    loads = scene.loading.values / (1.0 if by_depth else modulus)  # type: ignore[attr-defined]
    curve, errors = _curve_through(scene, loads, at_load, solve, accuracy)
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
    at_load: Callable[[float], FemEquilibrium],
    solve: ContactSolver,
    accuracy: float | None,
) -> tuple[LoadCurve | None, dict[str, FloatArray]]:
    """The curve and its errors at loads; no curve where the profile is broken or the accuracy out of reach."""
    by_depth = isinstance(scene.loading, IndentationDepths)
    ends = [at_load(float(end)).contact for end in (loads.min(), loads.max())]
    low, high = (end.indenter.contact_radius for end in ends)
    flat = scene.indenter.flat_radius
    is_broken = any(low < r < high for r in scene.indenter.breakpoints)
    if is_broken or low <= narrowest_radius(scene.layer, scene.indenter) or high - flat < WIDE * (low - flat):
        return None, {}
    curve, missed = _interpolated(_Grids(flat, by_depth, ends, solve), len(loads) // 2, accuracy)
    if curve is None:
        return None, {}
    errors = dict(curve.errors(loads))
    errors |= {name: errors[name] + error for name, error in zip(ContactPath.ARRAYS, missed, strict=True)}
    errors["indentation_depth" if by_depth else "normal_force"] = np.zeros(len(loads))
    meets = accuracy is None or max(float(errors[name].max()) for name in ContactPath.ASKED) <= accuracy
    return (curve if meets else None), errors


@dataclass(frozen=True)
class _Grids:
    """Curves on finer and finer grids between two solved radii [m]; no radius is solved twice."""

    flat: float
    by_depth: bool
    ends: Sequence[ContactWithErrors]
    solve: ContactSolver

    @cached_property
    def _known(self) -> dict[float, ContactWithErrors]:
        return dict(zip((0.0, 1.0), self.ends, strict=True))

    def curve(self, count: int) -> LoadCurve:
        """That of so many radii."""
        low, high = (end.indenter.contact_radius - self.flat for end in self.ends)
        for share in grid(count):
            # Both grids' points agree to a rounding.
            place = round(float(share), 12)
            if place not in self._known:
                self._known[place] = self.solve(self.flat + low * (high / low) ** float(share))
        contacts = [self._known[round(float(share), 12)] for share in grid(count)]
        return LoadCurve(flat=self.flat, by_depth=self.by_depth, contacts=contacts)


def _interpolated(grids: _Grids, most: int, accuracy: float | None) -> tuple[LoadCurve | None, FloatArray]:
    """The first curve that interpolates well enough, and by how much its radius, depth, force and stiffness may err."""
    curve, before = grids.curve(GRIDS[0]), None
    for count in GRIDS[1:]:
        if count > most:
            break
        finer = grids.curve(count)
        missed = curve.missed(finer)
        # The finer curve errs at most like the fall of two grids goes on; doubling the radii squares an error.
        left = missed if before is None else missed * np.minimum(1.0, missed / before)
        stated = np.array([max(state.error[name] for state in finer.states) for name in ContactPath.ARRAYS])
        allowed = SHARE * (stated if accuracy is None else np.full(4, accuracy))
        if np.all((left <= allowed) | (stated == 0.0)):
            return finer, left
        curve, before = finer, missed
    return None, np.full(4, np.inf)
