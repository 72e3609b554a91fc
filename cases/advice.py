"""Which effects of a scene, and whether its finite thickness, change the answer by more than an accuracy."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from cases.declare.quantities import IMPACT_NUMBERS, single_numbers, values_of
from cases.run.timing import clear_caches
from cases.studies import Effect
from cases.validity import Number, numbers
from contact import (
    Adhesion,
    ContactError,
    Detachment,
    DetachmentPath,
    ElasticBase,
    ElasticLayer,
    GradedLayer,
    InvalidInput,
    Layer,
    LayerStack,
    Method,
    Scene,
    Solution,
)
from contact.records.validation import FloatArray

# Processor time of a solution [s] beyond which the time of imports is negligible.
IMPORTS_HIDDEN = 2.0
NOTHING_PULLS = "without it nothing pulls, and there is no detachment"
# Single numbers of impacts and detachments, which are compared; otherwise the quantities of the path.
SINGLE = (*IMPACT_NUMBERS, *DetachmentPath.SCALARS)
STATIC = ("contact_radius", "indentation_depth", "normal_force")
THICKNESS = "finite thickness"
ELASTIC_BASE = "elastic base (rigid instead)"
GRADING = "grading (the surface's material instead)"


@dataclass(frozen=True, kw_only=True)
class Advice:
    """Which parts of a scene matter.

    Attributes:
        accuracy: Largest relative change that does not matter.
        needed: Parts of the scene without which a quantity changes by more than the accuracy.
        droppable: Parts that may be left out, all at once.
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
        sentences = [
            f"{part.part[:1].upper()}{part.part[1:]} {verdict} at {100 * self.accuracy:g} %: {part.line}"
            for verdict, parts in (("matters", self.needed), ("may be left out", self.droppable))
            for part in parts
        ]
        if len(self.droppable) > 1:
            sentences.append(f"Without all of these at once a quantity changes by {100 * self.together:.2g} %.")
        return [*sentences, *(number.line for number in self.numbers)]


def advise(method: Method, scene: Scene, accuracy: float) -> Advice:
    """Solve the scene with and without each of its parts.

    Args:
        method: Method that solves.
        scene: The whole scene.
        accuracy: Largest relative change that does not matter.

    Raises:
        InvalidInput: If the accuracy is no relative error.
        ContactError: If the method does not solve the whole scene.
    """
    if not 0.0 < accuracy < 1.0:
        raise InvalidInput(f"accuracy = {accuracy:g}: must lie between 0 and 1; it is a relative change")
    whole = first_solution(method, scene)
    parts = tuple(ablation(method, whole, part) for part in parts_of(scene))
    droppable = tuple(part for part in parts if part.may_be_dropped(accuracy))
    together, droppable = _together(method, whole, droppable, accuracy)
    needed = tuple(part for part in parts if part not in droppable)
    scene_numbers = numbers(scene, whole, accuracy)
    return Advice(
        accuracy=accuracy, needed=needed, droppable=droppable, together=together, numbers=tuple(scene_numbers)
    )


def _together(
    method: Method, whole: Solution, droppable: tuple[Effect, ...], accuracy: float
) -> tuple[float, tuple[Effect, ...]]:
    """Largest relative change without the returned parts; until it is small enough, the largest one is removed."""
    while len(droppable) > 1:
        change = change_without(method, whole, [part.part for part in droppable])
        if change <= accuracy:
            return change, droppable
        most = max(droppable, key=lambda part: part.largest_change)
        droppable = tuple(part for part in droppable if part is not most)
    return max((part.largest_change for part in droppable), default=0.0), droppable


def first_solution(method: Method, scene: Scene) -> Solution:
    """The answer with its cost from empty caches; a fast solution is repeated, so that imports do not count."""
    for _ in range(2):
        clear_caches()
        answer = method.solve(scene)
        if answer.cost.cpu_seconds > IMPORTS_HIDDEN:
            break
    return answer


def parts_of(scene: Scene) -> tuple[str, ...]:
    """Names of all that can be left out of a scene: its effects, and the parts of `layer_parts`."""
    return (*(type(effect).__name__ for effect in scene.effects), *layer_parts(scene.layer))


def nothing_left(scene: Scene, part: str) -> bool:
    """Whether the scene cannot be solved without the part: adhesion in a detachment."""
    return part == Adhesion.__name__ and isinstance(scene.loading, Detachment)


def change_without(method: Method, whole: Solution, parts: Sequence[str]) -> float:
    """Largest relative change of any quantity with all these parts left out at once."""
    reduced = method.solve(without(whole.scene, parts))
    return max(changes(_numbers(whole), _numbers(reduced)).values(), default=0.0)


def without(scene: Scene, parts: Sequence[str]) -> Scene:
    """The scene with these parts left out."""
    effects = tuple(effect for effect in scene.effects if type(effect).__name__ not in parts)
    layer: ElasticLayer = scene.layer
    for part in layer_parts(layer):
        layer = simpler(layer, part) if part in parts else layer
    return scene.replace(effects=effects, layer=layer)


def ablation(method: Method, whole: Solution, part: str) -> Effect:
    """Changes of the quantities of a solved scene without a part, and both run times."""
    entry = Effect(case="", scene="", method=method.name, part=part, seconds=whole.cost.cpu_seconds)
    if nothing_left(whole.scene, part):
        return replace(entry, remark=NOTHING_PULLS)
    try:
        clear_caches()
        reduced = method.solve(without(whole.scene, [part]))
    except ContactError as error:
        return replace(entry, remark=f"no answer without it ({error!s:.120})")
    return replace(entry, changes=changes(_numbers(whole), _numbers(reduced)), seconds_without=reduced.cost.cpu_seconds)


def changes(whole: Mapping[str, FloatArray], reduced: Mapping[str, FloatArray]) -> dict[str, float]:
    """Largest change of each quantity over the steps, relative to its largest value, by name.

    Compared are the single numbers of an answer, or the quantities of its path where there are none.
    A quantity that is zero, or has another number of steps without the part, is left out.
    """
    names = [name for name in SINGLE if name in whole] or STATIC
    pairs = {name: (whole[name], reduced[name]) for name in names if name in whole and name in reduced}
    return {
        name: float(np.max(np.abs(values - others)) / np.max(np.abs(values)))
        for name, (values, others) in pairs.items()
        if values.shape == others.shape and np.any(values)
    }


def _numbers(answer: Solution) -> dict[str, FloatArray]:
    """Single numbers of an answer, or else radius, depth and force along its steps, by name."""
    return {name: values_of(answer, name) for name in single_numbers(answer) or STATIC}


def layer_parts(layer: ElasticLayer) -> tuple[str, ...]:
    """Names of the simplifications of a layer that can be tried, infinite thickness last; empty for a half-space."""
    return tuple(name for name, _ in _simpler_layers(layer))


def simpler(layer: ElasticLayer, part: str) -> ElasticLayer:
    """The layer without one part, or the layer itself if it has no such part."""
    return dict(_simpler_layers(layer)).get(part, layer)


def _simpler_layers(layer: ElasticLayer) -> Iterator[tuple[str, ElasticLayer]]:
    """Yield the name of each part and the layer without that part."""
    if layer.is_half_space:
        return
    if isinstance(layer, LayerStack | GradedLayer) and isinstance(layer.support, ElasticBase):
        yield ELASTIC_BASE, layer.replace(support=layer.support.interface)
    if isinstance(layer, LayerStack):
        for n, (above, below) in enumerate(pairwise(layer.sublayers)):
            alike = above.replace(thickness=below.thickness)
            if alike != below:
                sublayers = (*layer.sublayers[: n + 1], alike, *layer.sublayers[n + 2 :])
                yield f"sublayer {n + 2} (the material above it instead)", layer.replace(sublayers=sublayers)
        for n, face in enumerate(layer.interfaces):
            if face == "unbonded":
                faces = (*layer.interfaces[:n], "bonded", *layer.interfaces[n + 1 :])
                yield f"slip below sublayer {n + 1} (bonded instead)", layer.replace(interfaces=faces)
    if isinstance(layer, GradedLayer):
        yield GRADING, LayerStack(sublayers=(layer.surface,), support=layer.support).simplest()
    top = layer.surface
    yield THICKNESS, Layer.half_space(youngs_modulus=top.youngs_modulus, poissons_ratio=top.poissons_ratio)
