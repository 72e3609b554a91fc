"""Which effects, and which finite thickness, a scene needs at a wanted accuracy: solved with and without."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from cases.measurements.advice.ablation import ablations_of, change_without, first_solution
from cases.measurements.advice.dimensionless_numbers import Number, numbers
from contact import InvalidInput, Method, Scene, Solution

if TYPE_CHECKING:
    from cases.studies import Effect


@dataclass(frozen=True, kw_only=True)
class Advice:
    """Which parts of a scene matter.

    Attributes:
        accuracy: Wanted relative accuracy.
        needed: Parts of the scene without which a quantity changes by more than that.
        droppable: Parts that may be left out, each by itself.
        together: Largest relative change with all droppable parts left out at once; zero if there are none.
        numbers: Dimensionless numbers of the scene, with their meaning.
    """

    accuracy: float
    needed: tuple[Effect, ...]
    droppable: tuple[Effect, ...]
    together: float
    numbers: tuple[Number, ...]

    @property
    def lines(self) -> list[str]:
        """The advice in sentences."""
        found = [
            f"{part.part[:1].upper()}{part.part[1:]} {verdict} at {100 * self.accuracy:g} %: {part.line}"
            for verdict, parts in (("matters", self.needed), ("may be left out", self.droppable))
            for part in parts
        ]
        if len(self.droppable) > 1:
            found.append(f"Without all of these at once a quantity changes by {100 * self.together:.2g} %.")
        return [*found, *(number.line for number in self.numbers)]


def advise(method: Method, scene: Scene, accuracy: float) -> Advice:
    """Solve the scene with and without each of its parts.

    Args:
        method: What to solve with.
        scene: The whole scene.
        accuracy: Largest relative change that does not matter.

    Raises:
        InvalidInput: If the accuracy is no relative error.
        ContactError: If the method does not solve the whole scene.
    """
    if not 0.0 < accuracy < 1.0:
        raise InvalidInput(f"accuracy = {accuracy:g}: must lie between 0 and 1; it is a relative change")
    whole = first_solution(method, scene)
    parts = ablations_of(method, whole)
    droppable = tuple(part for part in parts if part.may_be_dropped(accuracy))
    together, droppable = _together(method, whole, droppable, accuracy)
    needed = tuple(part for part in parts if part not in droppable)
    found = numbers(scene, whole, accuracy)
    return Advice(accuracy=accuracy, needed=needed, droppable=droppable, together=together, numbers=tuple(found))


def _together(
    method: Method, whole: Solution, droppable: tuple[Effect, ...], accuracy: float
) -> tuple[float, tuple[Effect, ...]]:
    """Largest change without all droppable parts at once, and these; while it is too large, the largest is needed."""
    while len(droppable) > 1:
        change = change_without(method, whole, [part.part for part in droppable])
        if change <= accuracy:
            return change, droppable
        most = max(droppable, key=lambda part: part.largest_change)
        droppable = tuple(part for part in droppable if part is not most)
    return max((part.largest_change for part in droppable), default=0.0), droppable
