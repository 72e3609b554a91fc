"""A requested accuracy: settings in a fixed order, from cheap to fine, until the stated error is small enough."""

import inspect
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final, Generic, overload

import numpy as np
from typing_extensions import TypeVar

from cases.declare.methods import build, load
from contact import (
    ContactPath,
    Detachment,
    DetachmentPath,
    HistoryPath,
    Impact,
    ImpactHistory,
    InvalidInput,
    Method,
    NotConvergedError,
    Scene,
    Solution,
    Unsupported,
    UnsupportedSceneError,
)
from contact.answer.accuracy import number_errors, shortfalls, with_accuracy_note
from contact.scene.loading import EquilibriumLoading, HistoryLoading

AnswerT = TypeVar("AnswerT", bound=Solution, default=Solution)

# Methods, the fastest first: the direct equation takes tens of times as long as MDR, finite elements hundreds.
ORDER: Final = ("mdr", "integral_equation", "fem")
# Refinements of a method before the next, slower one is tried.
REFINEMENTS: Final = 2


@dataclass(frozen=True, kw_only=True)
class Outcome(Generic[AnswerT]):
    """An answer whose stated error is at most the requested accuracy.

    Attributes:
        method: Name in the method table.
        settings: Settings that the answer reports.
        answer: The solution.
        stated_error: Largest relative error that the answer states for the quantities of `Solution.ACCURACY_OF`.
    """

    method: str
    settings: Mapping[str, Any]
    answer: AnswerT
    stated_error: float


@overload
def solve(
    scene: Scene[EquilibriumLoading], *, accuracy: float, pressure_accuracy: float | None = None
) -> Outcome[ContactPath]: ...
@overload
def solve(
    scene: Scene[Detachment], *, accuracy: float, pressure_accuracy: float | None = None
) -> Outcome[DetachmentPath]: ...
@overload
def solve(
    scene: Scene[Impact], *, accuracy: float, pressure_accuracy: float | None = None
) -> Outcome[ImpactHistory]: ...
@overload
def solve(
    scene: Scene[HistoryLoading], *, accuracy: float, pressure_accuracy: float | None = None
) -> Outcome[HistoryPath]: ...
@overload
def solve(scene: Scene[Any, Any], *, accuracy: float, pressure_accuracy: float | None = None) -> Outcome[Solution]: ...
def solve(scene: Scene[Any, Any], *, accuracy: float, pressure_accuracy: float | None = None) -> Outcome[Any]:
    """Return the first answer whose stated error is at most the requested accuracy.

    Args:
        scene: Scene to solve.
        accuracy: Largest relative error of radius, depth, force and stiffness, or of critical numbers, or of
            restitution and peaks (`Solution.ACCURACY_OF`). Notes name other quantities with larger stated errors.
        pressure_accuracy: Largest relative error of the contact pressure; None if it does not matter.

    Raises:
        InvalidInput: If an accuracy does not lie between 0 and 1.
        UnsupportedSceneError: If no method models the scene.
        NotConvergedError: If every answer states a larger error.
    """
    for wanted in (accuracy, pressure_accuracy):
        if wanted is not None and not 0.0 < wanted < 1.0:
            raise InvalidInput(f"accuracy = {wanted:g}: must lie between 0 and 1; it is a relative error")
    smallest_stated = np.inf
    refusals: list[str] = []
    for method in _methods(scene, accuracy, pressure_accuracy, refusals):
        try:
            answer: Any = method.solve(scene)
        except NotConvergedError as error:
            refusals.append(str(error))
            continue
        except UnsupportedSceneError as error:
            refusals.append(f"{method.name}: {error}")
            continue
        stated = max(number_errors(answer).values(), default=np.inf)
        if not shortfalls(answer, accuracy, pressure_accuracy):
            noted = with_accuracy_note(answer, accuracy, pressure_accuracy)
            return Outcome(method=method.name, settings=answer.settings, answer=noted, stated_error=stated)
        smallest_stated = min(smallest_stated, stated)
    if smallest_stated < np.inf:
        message = f"accuracy = {accuracy:g}: answers to this scene state {smallest_stated:.1e} at best; ask for less"
        raise NotConvergedError(message, {"stated_error": smallest_stated})
    raise UnsupportedSceneError(f"accuracy = {accuracy:g}: no method answers this scene: {'; '.join(refusals)}")


def _methods(
    scene: Scene[Any, Any], accuracy: float, pressure_accuracy: float | None, refusals: list[str]
) -> Iterator[Method]:
    """Yield each method that models the scene, with the accuracies as settings or its defaults, then refined."""
    accuracies = {"accuracy": accuracy, "pressure_accuracy": pressure_accuracy}
    for name in ORDER:
        settable = inspect.signature(load(name)).parameters
        settings = {key: value for key, value in accuracies.items() if key in settable and value is not None}
        try:
            method = build(name, settings)
        except InvalidInput:
            # The method refuses this accuracy as a setting: its default is tried instead.
            method = build(name, {})
        support = method.supports(scene)
        if isinstance(support, Unsupported):
            refusals.append(f"{name}: {support.reason}")
            continue
        for _ in range(REFINEMENTS + 1):
            yield method
            method = method.refined()
