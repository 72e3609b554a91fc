"""Zero depth and zero force without adhesion: the indenter just does not touch, which no method need compute."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable
from typing import Any, TypeVar, cast

import numpy as np

from contact.answer.inside import InteriorFields, KnownContact
from contact.answer.solution import ContactPath, Fields
from contact.answer.stages import StageLog
from contact.records.errors import InvalidInput
from contact.records.validation import BoolArray, FloatArray
from contact.scene.effects import Adhesion
from contact.scene.loading import IndentationDepths, NormalForces
from contact.scene.scene import Scene

F = TypeVar("F", bound=Callable[..., Any])


def without_contact(solve: F) -> F:
    """A `solve` that is asked for the steps that press only, and answers zeros for the others."""

    @functools.wraps(solve)
    def wrapped(method: Any, scene: Scene) -> Any:
        """The method's answer with the steps that do not press filled in."""
        loading = scene.loading
        adheres = scene.effect(Adhesion) is not None
        if adheres or not isinstance(loading, IndentationDepths | NormalForces) or np.all(loading.values):
            return solve(method, scene)
        presses = loading.values > 0.0
        if not presses.any():
            return _nothing(method.name, scene)
        path = solve(method, scene.replace(loading=loading.replace(values=loading.values[presses])))
        return _with_zeros(path, scene, presses)

    return cast(F, wrapped)


@dataclasses.dataclass(frozen=True)
class _PressedFields:
    """Fields of the steps that press; zero at the others.

    Attributes:
        fields: Of the pressed steps.
        number: Of each step among the pressed ones, -1 for no contact.
    """

    fields: Fields
    number: tuple[int, ...]

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """p(r) [Pa], zero without contact."""
        known = self.number[step]
        return np.zeros_like(radius) if known < 0 else self.fields.pressure(radius, known)

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """w(r) [m], zero without contact."""
        known = self.number[step]
        return np.zeros_like(radius) if known < 0 else self.fields.surface_displacement(radius, known)

    def tangential_traction(self, radius: FloatArray, step: int) -> FloatArray:
        """q(r) [Pa] where the method gives it, zero without contact."""
        return self._of_friction("tangential_traction", radius, step)

    def slip(self, radius: FloatArray, step: int) -> FloatArray:
        """How far the surface slid [m] where the method gives it, zero without contact."""
        return self._of_friction("slip", radius, step)

    def _of_friction(self, name: str, radius: FloatArray, step: int) -> FloatArray:
        known = self.number[step]
        return np.zeros_like(radius) if known < 0 else np.asarray(getattr(self.fields, name)(radius, known))

    def inside(self, step: int, known: KnownContact) -> InteriorFields:
        """The body under one step that presses.

        Raises:
            InvalidInput: If the step has no contact, or the method no fields inside.
        """
        of_method = getattr(self.fields, "inside", None)
        if self.number[step] < 0 or of_method is None:
            raise InvalidInput(f"step = {step}: nothing is known inside the body; ask mdr for a step that presses")
        found: InteriorFields = of_method(self.number[step], known)
        return found


def _nothing(method: str, scene: Scene) -> ContactPath:
    """A path without any contact."""
    arrays: dict[str, Any] = dict.fromkeys(
        ContactPath.ARRAYS,
        np.zeros(len(scene.loading.values)),  # type: ignore[attr-defined]
    )
    return ContactPath(
        scene=scene,
        method=method,
        settings={},
        **arrays,
        error_estimate=arrays,
        cost=StageLog().cost(unknowns=0),
    )


def _with_zeros(path: ContactPath, scene: Scene, presses: BoolArray) -> ContactPath:
    """The path with zeros at the steps that do not press."""

    def filled(values: FloatArray) -> FloatArray:
        """One value a step, zero where nothing presses."""
        if np.size(values) != presses.sum():
            return values
        found = np.zeros(presses.size)
        found[presses] = values
        return found

    arrays: dict[str, Any] = {name: filled(getattr(path, name)) for name in path.ARRAYS}
    number = np.where(presses, np.cumsum(presses) - 1, -1)
    return dataclasses.replace(
        path,
        scene=scene,
        error_estimate={name: filled(np.atleast_1d(error)) for name, error in path.error_estimate.items()},
        fields=None if path.fields is None else _PressedFields(path.fields, tuple(number.tolist())),
        **arrays,
    )
