"""Steps of zero depth or force without adhesion: there is no contact, and all quantities are zero."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable
from typing import Any, TypeVar, cast

import numpy as np

from contact.answer.paths import ContactPath
from contact.answer.stages import StageLog
from contact.records.validation import BoolArray, FloatArray
from contact.scene.effects import Adhesion
from contact.scene.loading import IndentationDepths, NormalForces
from contact.scene.scene import Scene

F = TypeVar("F", bound=Callable[..., Any])


def without_contact(solve: F) -> F:
    """A `solve` that computes only steps of positive depth or force, and returns zeros for the others."""

    @functools.wraps(solve)
    def wrapped(method: Any, scene: Scene) -> Any:
        """The answer of the method, with zeros at steps of zero depth or force."""
        loading = scene.loading
        adheres = scene.effect(Adhesion) is not None
        if adheres or not isinstance(loading, IndentationDepths | NormalForces) or np.all(loading.values):
            return solve(method, scene)
        presses = loading.values > 0.0
        if not presses.any():
            zeros: dict[str, Any] = dict.fromkeys(ContactPath.ARRAYS, np.zeros(presses.size))
            cost = StageLog().cost(unknowns=0)
            return ContactPath(scene=scene, method=method.name, settings={}, **zeros, error_estimate=zeros, cost=cost)
        path = solve(method, scene.replace(loading=loading.replace(values=loading.values[presses])))
        return _with_zeros(path, scene, presses)

    return cast(F, wrapped)


@dataclasses.dataclass(frozen=True)
class _PressedFields:
    """Fields of the steps with contact, by their index in the whole path.

    Attributes:
        fields: Fields of the method, which solved the steps with contact only.
        numbers: Index of each step of the path among those with contact; unused for a step without contact.
    """

    fields: Any
    numbers: list[int]

    def __getattr__(self, name: str) -> Callable[..., Any]:
        """A field of the method, such as `pressure(radius, step)`, or its `inside(step, known)`."""
        if name.startswith("_"):
            raise AttributeError(name)
        field = getattr(self.fields, name)
        if name == "inside":
            return lambda step, known: field(self.numbers[step], known)
        return lambda place, step, *angle: field(place, self.numbers[step], *angle)


def _with_zeros(path: ContactPath, scene: Scene, presses: BoolArray) -> ContactPath:
    """The path with zeros at the steps without contact."""

    def with_zeros(values: FloatArray) -> FloatArray:
        """One value per step of the scene from one per step with contact; other arrays are returned unchanged."""
        if np.size(values) != presses.sum():
            return values
        every = np.zeros(presses.size)
        every[presses] = values
        return every

    arrays: dict[str, Any] = {name: with_zeros(getattr(path, name)) for name in path.ARRAYS}
    errors = {name: with_zeros(np.atleast_1d(error)) for name, error in path.error_estimate.items()}
    fields: Any = path.fields and _PressedFields(path.fields, (np.cumsum(presses) - 1).tolist())
    return dataclasses.replace(path, scene=scene, error_estimate=errors, fields=fields, **arrays)
