"""Zero depth and zero force without adhesion: nothing touches, and no method need compute it."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable
from typing import Any, TypeVar, cast

import numpy as np

from contact.answer.inside import InteriorFields, KnownContact
from contact.answer.paths import ContactPath
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
            return _nothing(method.name, scene, presses.size)
        path = solve(method, scene.replace(loading=loading.replace(values=loading.values[presses])))
        return _with_zeros(path, scene, presses)

    return cast(F, wrapped)


class _PressedFields:
    """Fields of the steps that press; surface fields are zero at the others."""

    def __init__(self, fields: Any, number: list[int]) -> None:
        """`number` is that of each step among the pressed ones, -1 for no contact."""
        self._fields, self._number = fields, number

    def __getattr__(self, name: str) -> Callable[..., FloatArray]:
        """A surface field of the method, such as `pressure`, zero without contact."""
        if name.startswith("_"):
            raise AttributeError(name)
        of_method = getattr(self._fields, name)

        def field(radius: FloatArray, step: int, *angle: FloatArray) -> FloatArray:
            """Values at radii [m], zero without contact."""
            pressed = self._number[step]
            return np.zeros_like(radius) if pressed < 0 else np.asarray(of_method(radius, pressed, *angle))

        return field

    def inside(self, step: int, known: KnownContact) -> InteriorFields:
        """The body under one step that presses.

        Raises:
            InvalidInput: If the step has no contact, or the method no fields inside.
        """
        if self._number[step] < 0 or not hasattr(self._fields, "inside"):
            raise InvalidInput(f"step = {step}: nothing is known inside the body; ask mdr for a step that presses")
        found: InteriorFields = self._fields.inside(self._number[step], known)
        return found


def _nothing(method: str, scene: Scene, count: int) -> ContactPath:
    """A path without any contact."""
    zeros: dict[str, Any] = dict.fromkeys(ContactPath.ARRAYS, np.zeros(count))
    cost = StageLog().cost(unknowns=0)
    return ContactPath(scene=scene, method=method, settings={}, **zeros, error_estimate=zeros, cost=cost)


def _with_zeros(path: ContactPath, scene: Scene, presses: BoolArray) -> ContactPath:
    """The path with zeros at the steps that do not press."""

    def filled(values: FloatArray) -> FloatArray:
        """One value per step, zero in steps without contact."""
        if np.size(values) != presses.sum():
            return values
        found = np.zeros(presses.size)
        found[presses] = values
        return found

    arrays: dict[str, Any] = {name: filled(getattr(path, name)) for name in path.ARRAYS}
    errors = {name: filled(np.atleast_1d(error)) for name, error in path.error_estimate.items()}
    number = np.where(presses, np.cumsum(presses) - 1, -1).tolist()
    fields: Any = None if path.fields is None else _PressedFields(path.fields, number)
    return dataclasses.replace(path, scene=scene, error_estimate=errors, fields=fields, **arrays)
