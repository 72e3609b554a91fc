"""Cost of each part of a scene, and the change of the answer without it."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING

from cases.declare.quantities import relative_change, single_numbers, values_of
from cases.measurements.advice.simpler_layers import layer_parts, simpler
from cases.run.empty_caches import forget
from contact import Adhesion, ContactError, Detachment, ElasticLayer, Method, Scene, Solution

if TYPE_CHECKING:
    from cases.studies import Effect

# A solution of more seconds than this hides the imports.
_IMPORTS_COUNT = 2.0
NOTHING_PULLS = "without it nothing pulls, and there is no detachment"
STATIC = ("contact_radius", "indentation_depth", "normal_force")


def first_solution(method: Method, scene: Scene) -> Solution:
    """The answer at the cost it has without anything kept from earlier scenes; without imports where they count."""
    forget()
    answer = method.solve(scene)
    if _seconds(answer) > _IMPORTS_COUNT:
        return answer
    forget()
    return method.solve(scene)


def ablations_of(method: Method, whole: Solution) -> list[Effect]:
    """Cost and change of each part of a solved scene, left out in turn."""
    return [_ablation(method, whole, part) for part in parts_of(whole.scene)]


def parts_of(scene: Scene) -> tuple[str, ...]:
    """What can be left out: each listed effect, and the parts of a layer, its finite thickness among them."""
    return (*(type(effect).__name__ for effect in scene.effects), *layer_parts(scene.layer))


def nothing_left(scene: Scene, part: str) -> bool:
    """Whether nothing is left to solve without the part: the adhesion of a detachment."""
    return part == Adhesion.__name__ and isinstance(scene.loading, Detachment)


def change_without(method: Method, whole: Solution, parts: Sequence[str]) -> float:
    """Largest relative change of any quantity with all these parts left out at once."""
    less = method.solve(without(whole.scene, parts))
    return max(_changes(whole, less).values())


def without(scene: Scene, parts: Sequence[str]) -> Scene:
    """The scene with these parts left out."""
    effects = tuple(effect for effect in scene.effects if type(effect).__name__ not in parts)
    layer: ElasticLayer = scene.layer
    for part in layer_parts(layer):
        layer = simpler(layer, part) if part in parts else layer
    return scene.replace(effects=effects, layer=layer)


def _ablation(method: Method, whole: Solution, part: str) -> Effect:
    from cases.studies import Effect  # noqa: PLC0415 - a single answer needs no records of runs

    entry = partial(Effect, case="", scene="", method=method.name, part=part, seconds=_seconds(whole))
    if nothing_left(whole.scene, part):
        return entry(seconds_without=None, remark=NOTHING_PULLS)
    try:
        forget()
        less = method.solve(without(whole.scene, [part]))
    except ContactError as error:
        return entry(seconds_without=None, remark=f"no answer without it ({error!s:.120})")
    return entry(changes=_changes(whole, less), seconds_without=_seconds(less))


def _changes(whole: Solution, less: Solution) -> dict[str, float]:
    """Relative change of what the answer ends with, or of its path."""
    names = single_numbers(whole) or STATIC
    return {name: relative_change(values_of(whole, name), values_of(less, name)) for name in names}


def _seconds(answer: Solution) -> float:
    return answer.cost.cpu_seconds
