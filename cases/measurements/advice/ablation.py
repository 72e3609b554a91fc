"""What each listed effect costs and what it moves, from one cheap solution without it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from cases.declare.quantities import relative_change, single_numbers, values_of
from cases.run.empty_caches import forget
from contact import ContactError, Detachment, Layer, Method, Scene, Solution

THICKNESS = "finite thickness"
_IMPORTS_COUNT = 2.0  # seconds: a longer solution hides them
STATIC = ("contact_radius", "indentation_depth", "normal_force")


@dataclass(frozen=True, kw_only=True)
class Ablation:
    """One part of the scene left out.

    Attributes:
        part: "Adhesion", "StandardSolid", .., or "finite thickness".
        changes: Largest relative change of each quantity without it; empty where the scene has no answer without it.
        seconds_with: Processor time of the whole scene [s], the stages of its own log.
        seconds_without: The same without the part [s].
        remark: Why there is no change to tell, or "".
    """

    part: str
    changes: dict[str, float]
    seconds_with: float
    seconds_without: float
    remark: str = ""

    @property
    def largest_change(self) -> float:
        """Over all quantities; infinite where nothing is left without the part."""
        return max(self.changes.values(), default=float("inf"))

    @property
    def share_of_time(self) -> float:
        """How much of the time goes into it, not below zero."""
        return max(0.0, 1.0 - self.seconds_without / self.seconds_with) if self.seconds_with else 0.0

    def matters(self, accuracy: float) -> bool:
        """Whether leaving it out would move a quantity by more than the accuracy."""
        return self.largest_change > accuracy

    @property
    def line(self) -> str:
        """For the report: "viscosity: 61 % of the time, moves peak force by 0.02 %"."""
        if not self.changes:
            return f"{self.part}: {self.remark}"
        quantity = max(self.changes, key=lambda name: self.changes[name])
        moved = f"moves {quantity.replace('_', ' ')} by {100 * self.changes[quantity]:.2g} %"
        return f"{self.part}: {100 * self.share_of_time:.0f} % of the time, {moved}"


def ablations(method: Method, scene: Scene) -> list[Ablation]:
    """Each listed effect, and the layer's finite thickness, left out in turn.

    Raises:
        ContactError: If the method does not solve the whole scene.
    """
    return ablations_of(method, first_solution(method, scene))


def first_solution(method: Method, scene: Scene) -> Solution:
    """The answer at the cost it has without anything kept from earlier scenes; without imports where they count."""
    forget()
    answer = method.solve(scene)
    if _seconds(answer) > _IMPORTS_COUNT:
        return answer
    forget()
    return method.solve(scene)


def ablations_of(method: Method, whole: Solution) -> list[Ablation]:
    """The same for a scene that was solved."""
    return [_ablation(method, whole, part) for part in parts_of(whole.scene)]


def parts_of(scene: Scene) -> tuple[str, ...]:
    """What can be left out: each listed effect, and the finite thickness of a layer."""
    effects = tuple(type(effect).__name__ for effect in scene.effects)
    return effects if scene.layer.is_half_space else (*effects, THICKNESS)


def change_without(method: Method, whole: Solution, parts: Sequence[str]) -> float:
    """Largest relative change of any quantity with all these parts left out at once."""
    less = method.solve(without(whole.scene, parts))
    return max(_changes(whole, less).values())


def without(scene: Scene, parts: Sequence[str]) -> Scene:
    """The scene with these parts left out."""
    effects = tuple(effect for effect in scene.effects if type(effect).__name__ not in parts)
    left = scene.replace(effects=effects)
    return on_half_space(left) if THICKNESS in parts else left


def on_half_space(scene: Scene) -> Scene:
    """The scene on a half-space of the same material."""
    layer = scene.layer
    return scene.replace(
        layer=Layer.half_space(youngs_modulus=layer.youngs_modulus, poissons_ratio=layer.poissons_ratio)
    )


def _ablation(method: Method, whole: Solution, part: str) -> Ablation:
    spent = _seconds(whole)
    if part == "Adhesion" and isinstance(whole.scene.loading, Detachment):
        remark = "without it nothing pulls; the whole detachment is its work"
        return Ablation(part=part, changes={}, seconds_with=spent, seconds_without=0.0, remark=remark)
    try:
        forget()
        less = method.solve(without(whole.scene, [part]))
    except ContactError as error:
        remark = f"no answer without it ({error!s:.120})"
        return Ablation(part=part, changes={}, seconds_with=spent, seconds_without=0.0, remark=remark)
    changes = _changes(whole, less)
    return Ablation(part=part, changes=changes, seconds_with=spent, seconds_without=_seconds(less))


def _changes(whole: Solution, less: Solution) -> dict[str, float]:
    """Relative change of what the answer ends with, or of its path."""
    names = single_numbers(whole) or STATIC
    return {name: relative_change(values_of(whole, name), values_of(less, name)) for name in names}


def _seconds(answer: Solution) -> float:
    return answer.cost.cpu_seconds
