"""Which effects, and which finite thickness, a scene needs at a wanted accuracy: solved with and without."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from cases.declare.quantities import IMPACT_NUMBERS, single_numbers, values_of
from cases.run.timing import forget
from contact import (
    Adhesion,
    ContactError,
    ContactPath,
    DepthHistory,
    Detachment,
    DetachmentPath,
    ElasticBase,
    ElasticLayer,
    ForceHistory,
    GradedLayer,
    Impact,
    ImpactHistory,
    IndentationDepths,
    InvalidInput,
    Layer,
    LayerStack,
    Method,
    NotConvergedError,
    Paraboloid,
    Scene,
    Shape,
    Solution,
    Sphere,
    UnsupportedSceneError,
    Viscoelasticity,
)
from contact.records.validation import FloatArray
from mdr import Mdr
from mdr.friction.statement import friction_effect

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
    """Largest change without all droppable parts at once, and these; while it is too large, the largest is needed."""
    while len(droppable) > 1:
        change = change_without(method, whole, [part.part for part in droppable])
        if change <= accuracy:
            return change, droppable
        most = max(droppable, key=lambda part: part.largest_change)
        droppable = tuple(part for part in droppable if part is not most)
    return max((part.largest_change for part in droppable), default=0.0), droppable


# A solution of more seconds than this hides the imports.
_IMPORTS_COUNT = 2.0
NOTHING_PULLS = "without it nothing pulls, and there is no detachment"
# Compared are the single numbers of impacts and detachments, else the path.
SINGLE = (*IMPACT_NUMBERS, *DetachmentPath.SCALARS)
STATIC = ("contact_radius", "indentation_depth", "normal_force")


def first_solution(method: Method, scene: Scene) -> Solution:
    """The answer at the cost it has without anything kept from earlier scenes; without imports where they count."""
    forget()
    answer = method.solve(scene)
    if answer.cost.cpu_seconds > _IMPORTS_COUNT:
        return answer
    forget()
    return method.solve(scene)


def parts_of(scene: Scene) -> tuple[str, ...]:
    """What can be left out: each listed effect, and the parts of a layer, its finite thickness among them."""
    return (*(type(effect).__name__ for effect in scene.effects), *layer_parts(scene.layer))


def nothing_left(scene: Scene, part: str) -> bool:
    """Whether nothing is left to solve without the part: the adhesion of a detachment."""
    return part == Adhesion.__name__ and isinstance(scene.loading, Detachment)


def change_without(method: Method, whole: Solution, parts: Sequence[str]) -> float:
    """Largest relative change of any quantity with all these parts left out at once."""
    less = method.solve(without(whole.scene, parts))
    return max(changes(_numbers(whole), _numbers(less)).values(), default=0.0)


def without(scene: Scene, parts: Sequence[str]) -> Scene:
    """The scene with these parts left out."""
    effects = tuple(effect for effect in scene.effects if type(effect).__name__ not in parts)
    layer: ElasticLayer = scene.layer
    for part in layer_parts(layer):
        layer = simpler(layer, part) if part in parts else layer
    return scene.replace(effects=effects, layer=layer)


def ablation(method: Method, whole: Solution, part: str) -> Effect:
    """The change of a solved scene when it is solved without a part."""
    from cases.studies import Effect  # noqa: PLC0415 - a single answer needs no records of runs

    entry = Effect(case="", scene="", method=method.name, part=part, seconds=whole.cost.cpu_seconds)
    if nothing_left(whole.scene, part):
        return replace(entry, remark=NOTHING_PULLS)
    try:
        forget()
        less = method.solve(without(whole.scene, [part]))
    except ContactError as error:
        return replace(entry, remark=f"no answer without it ({error!s:.120})")
    return replace(entry, changes=changes(_numbers(whole), _numbers(less)), seconds_without=less.cost.cpu_seconds)


def changes(whole: Mapping[str, FloatArray], less: Mapping[str, FloatArray]) -> dict[str, float]:
    """Largest change over the steps relative to the largest value, of the single numbers of an answer or of its path.

    A quantity that is zero, or has another number of steps without the part, is left out.
    """
    names = [name for name in SINGLE if name in whole] or STATIC
    pairs = {name: (whole[name], less[name]) for name in names if name in whole and name in less}
    return {
        name: float(np.max(np.abs(values - others)) / np.max(np.abs(values)))
        for name, (values, others) in pairs.items()
        if values.shape == others.shape and np.any(values)
    }


def _numbers(answer: Solution) -> dict[str, FloatArray]:
    return {name: values_of(answer, name) for name in single_numbers(answer) or STATIC}


THICKNESS = "finite thickness"
ELASTIC_BASE = "elastic base (rigid instead)"
GRADING = "grading (the surface's material instead)"


def layer_parts(layer: ElasticLayer) -> tuple[str, ...]:
    """Names of the simplifications of a layer that can be tried, infinite thickness last; empty for a half-space."""
    return tuple(name for name, _ in _simpler_layers(layer))


def simpler(layer: ElasticLayer, part: str) -> ElasticLayer:
    """The layer without one part; parts that it does not have change nothing."""
    return dict(_simpler_layers(layer)).get(part, layer)


def _simpler_layers(layer: ElasticLayer) -> Iterator[tuple[str, ElasticLayer]]:
    """Each part by name, with the layer without it."""
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


# That of soft layers [kg/m^3]; a scene knows none.
TYPICAL_DENSITY = 1000.0
ATOMIC_RANGE = 0.3e-9  # m
# From this multiple of the accuracy on, an error of a half-space is much larger.
_MUCH = 10.0
_HALF_SPACE_MOVES = (0.4, 1.2)  # times a/h
_ADHESION_MOVES = 2.0  # times dl/delta
_DASHPOT_MOVES = 6.5  # times tau/T
# dl/z0 at a Tabor parameter of 5, with the contact radius at no load.
_JKR_HOLDS = 20.0
_SMALL_INERTIA = 0.1
# Coefficient of friction between wet soft layers and smooth indenters, as an order of magnitude.
_TYPICAL_FRICTION = 0.1
# Relative accuracy of the notes of an answer: that of careful indentation tests.
_USUAL_ACCURACY = 0.01
# Shares of the force for which notes state the largest coefficient of friction that changes less.
_GOOD_TO = (0.01, 0.05)


FRICTION = "friction"


# -- dimensionless numbers: estimates that say beforehand which effects a scene calls for, each with its limit ---------
# Each bounds a relative change of depth, force or restitution while it is small, for punches, cones, paraboloids,
# truncated ones and r^6. A half-space in place of a layer changes them by 0.4 to 1.2 times a/h, neglected adhesion by
# at most 2 times dl/delta, and a neglected dashpot by at most 6.5 times tau/T.
@dataclass(frozen=True, kw_only=True)
class Number:
    """One dimensionless number.

    Attributes:
        name: What it compares.
        value: Its value.
        meaning: What it says at the accuracy wanted, and where the estimate ends.
    """

    name: str
    value: float
    meaning: str

    @property
    def line(self) -> str:
        """Name, value and meaning; of friction the meaning alone, which states the value."""
        return self.meaning if self.name == FRICTION else f"{self.name} = {self.value:.3g}: {self.meaning}"


def validity_lines(scene: Scene, answer: Solution) -> list[str]:
    """How far the theory of an answer reaches, in sentences; none for other layers than a plain one, or no contact."""
    if (
        not isinstance(scene.layer, Layer)
        or "contact_radius" not in answer.ARRAYS
        or not _largest(answer, "contact_radius")
    ):
        return []
    statements = [_tip_share(scene, answer)]
    try:
        statements += numbers(scene, answer, _USUAL_ACCURACY)
    except (UnsupportedSceneError, NotConvergedError) as error:
        return [f"how far the theory reaches is not known: {error}"]
    return [number.line for number in statements if number is not None]


def numbers(scene: Scene, answer: Solution, accuracy: float) -> list[Number]:
    """The dimensionless numbers of a solved scene; an indenter that is not round counts as its round substitute."""
    if isinstance(scene.indenter, Shape):
        scene = scene.replace(indenter=scene.indenter.substitute)
    statements = [_thickness(scene, answer, accuracy), _strain(scene, answer), _friction(scene, answer)]
    if scene.effect(Adhesion) is not None:
        statements += _adhesion(scene, answer, accuracy)
    if isinstance(scene.loading, Impact | DepthHistory | ForceHistory):
        statements += _relaxation(scene, _duration(answer), accuracy)
    if isinstance(answer, ImpactHistory):
        statements.append(_inertia(scene, answer))
    return [number for number in statements if number is not None]


def _thickness(scene: Scene, answer: Solution, accuracy: float) -> Number | None:
    ratio = _largest(answer, "contact_radius") / scene.layer.thickness
    if not ratio or not scene.layer.is_uniform:
        return None
    low, high = (share * ratio for share in _HALF_SPACE_MOVES)
    wrong = "are wrong by less than" if high <= accuracy else "are wrong by about"
    if low > accuracy:
        wrong = f"would be wrong by {'much ' * (low > _MUCH * accuracy)}more than"
    return Number(name="a/h", value=ratio, meaning=f"half-space formulas {wrong} {100 * accuracy:g} %.")


def _strain(scene: Scene, answer: Solution) -> Number:
    depth, radius = _largest(answer, "indentation_depth"), _largest(answer, "contact_radius")
    strain = depth / min(radius, scene.layer.thickness)
    meaning = "typical strain. Beyond about 0.1 linear elasticity is an approximation."
    return Number(name="delta/min(a, h)", value=strain, meaning=meaning)


def _tip_share(scene: Scene, answer: Solution) -> Number | None:
    """For round tips: where a paraboloid no longer is a sphere, or a sphere comes near its equator."""
    match scene.indenter:
        case Paraboloid(radius_of_curvature=radius):
            remedy = "contact radius over tip radius. At 0.4 a Sphere is 4 % higher than the Paraboloid."
        case Sphere(radius=radius):
            remedy = (
                "contact radius over tip radius. Small slopes are assumed, and at 1 the contact reaches the equator."
            )
        case _:
            return None
    return Number(name="a/R", value=_largest(answer, "contact_radius") / radius, meaning=remedy)


def _friction(scene: Scene, answer: Solution) -> Number | None:
    """Change of the force at the largest depth by dry friction, bounded from the frictionless answer."""
    if scene.effects or not isinstance(answer, ContactPath) or not isinstance(scene.layer, Layer | LayerStack):
        return None
    path = Mdr().solve(scene.replace(loading=IndentationDepths([_largest(answer, "indentation_depth")])))
    effect = friction_effect(path, _TYPICAL_FRICTION)
    low, high = float(effect.lower[0]), float(effect.upper[0])
    if high == 0.0:  # no point of an incompressible half-space moves in the radial direction
        return None
    order = f", to first order by {100 * effect.first_order[0]:+.2g} %" if effect.one_direction[0] else ""
    # The bound at a coefficient mu is mu U/(1 - mu U).
    slip = high / (1 + high) / _TYPICAL_FRICTION if math.isfinite(high) else 1 / _TYPICAL_FRICTION
    below = " and ".join(f"less than {100 * s:g} % if mu < {s / (1 + s) / slip:.2g}" for s in _GOOD_TO)
    meaning = (
        f"Friction with mu = {_TYPICAL_FRICTION:g} changes the force at this depth by {100 * low:.2g} to "
        f"{100 * high:+.2g} %{order}. Neglecting friction costs {below}. Finite elements solve the effect Friction."
    )
    return Number(name=FRICTION, value=max(-low, high), meaning=meaning)


def _adhesion(scene: Scene, answer: Solution, accuracy: float) -> list[Number]:
    """dl/delta compares the critical elongation with the depth; the half-space's spring stiffness is E*."""
    adhesion = scene.effect(Adhesion)
    work = 0.0 if adhesion is None else adhesion.work_of_adhesion
    radius, depth = _largest(answer, "contact_radius"), _largest(answer, "indentation_depth")
    # Eq. (40) with c_N = E*.
    elongation = math.sqrt(2 * math.pi * work * radius / scene.layer.contact_modulus)
    share, range_ = elongation / depth if depth else math.inf, elongation / ATOMIC_RANGE
    holds = "JKR is valid" if range_ >= _JKR_HOLDS else "JKR is in doubt, adhesion acts at a distance"
    return [
        Number(
            name="JKR number dl/delta",
            value=share,
            meaning=_neglected("adhesion", _ADHESION_MOVES * share, accuracy),
        ),
        Number(
            name="Tabor-like number dl/z0",
            value=range_,
            meaning=f"{holds}. dl is the elongation at the edge, z0 = 0.3 nm the range of atomic forces. JKR needs "
            f"about {_JKR_HOLDS:g}, a Tabor parameter of 5 (Johnson, Greenwood 1997).",
        ),
    ]


def _neglected(effect: str, change: float, accuracy: float) -> str:
    """What leaving an effect out changes, from the bound of the relative change."""
    verdict = "changes no quantity" if change <= accuracy else "may change a quantity"
    return f"leaving {effect} out {verdict} by more than {100 * accuracy:g} %."


def _duration(answer: Solution) -> float:
    """T [s]: of the contact, or of a whole history."""
    if isinstance(answer, ImpactHistory):
        return answer.contact_time
    time: FloatArray = np.asarray(getattr(answer, "time", (0.0, math.inf)))
    return float(time[-1] - time[0])


def _relaxation(scene: Scene, duration: float, accuracy: float) -> list[Number]:
    """Whether a dashpot counts; branches are judged by `advise`, which solves without them."""
    model = scene.effect(Viscoelasticity)
    if model is None or not model.relaxation.viscosity:
        return []
    share = model.relaxation.viscosity / model.relaxation.instantaneous_modulus / duration
    return [Number(name="tau/T", value=share, meaning=_neglected("the dashpot", _DASHPOT_MOVES * share, accuracy))]


def _inertia(scene: Scene, answer: ImpactHistory) -> Number:
    """Over the contact radius or the thickness, whichever is less: that is as deep as the layer moves."""
    wave = math.sqrt(scene.layer.shear_modulus / TYPICAL_DENSITY)
    depth = min(scene.layer.thickness, answer.peak_contact_radius)
    value = depth / (wave * answer.contact_time)
    verdict = "small enough to neglect" if value <= _SMALL_INERTIA else "not small, and neglected all the same"
    meaning = (
        f"{verdict}. Estimate: time of a shear wave through the deformed depth over the contact time, for a density of "
        f"{TYPICAL_DENSITY:g} kg/m^3."
    )
    return Number(name="inertia of the layer", value=value, meaning=meaning)


def _largest(answer: Solution, quantity: str) -> float:
    return float(np.max(np.abs(getattr(answer, quantity))))
