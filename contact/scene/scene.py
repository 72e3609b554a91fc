"""The scene: a layer, an indenter, a loading and effects, without meshes and methods."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Any, Generic, Self, TypeAlias, overload

import numpy as np
from pydantic import AfterValidator, BeforeValidator, StrictBool, field_validator, model_validator
from typing_extensions import TypeVar

from contact.records.record import OneOf, Record
from contact.scene.effects import EFFECTS, Adhesion, Effect, Friction, Viscoelasticity
from contact.scene.graded_layer import GradedLayer
from contact.scene.layer import ElasticLayer, Layer, LayerStack
from contact.scene.loading import LOADINGS, ContactRadii, Detachment, IndentationDepths, Loading, NormalForces
from contact.scene.profiles import PROFILES, FlatPunch, Profile
from contact.scene.shapes import SHAPES, Shape

# Largest relative difference of the moduli of layer and effect: E = 2 (1 + nu) G is rounded to 1e-15, and numbers that
# agree to fewer than nine digits are two different materials.
_MODULUS_AGREEMENT = 1e-9

E = TypeVar("E", bound=Effect)
L = TypeVar("L", bound=Loading)

# Type of the loading, which determines the type of the answer of `solve`; `Scene` without parameters has any loading.
LoadingT_co = TypeVar("LoadingT_co", bound=Loading, default=Loading, covariant=True)
# Type of the layer; `Scene` without parameters has a `Layer`.
LayerT_co = TypeVar("LayerT_co", bound=ElasticLayer, default=Layer, covariant=True)


def _listed(effects: Any) -> Any:
    """Tuple of effects from a tuple, a list or a single effect."""
    if isinstance(effects, Effect):
        return (effects,)
    if isinstance(effects, str | bytes | Mapping) or not isinstance(effects, Sequence):
        raise ValueError("must be a list of tables; write [[effects]]")
    if len(effects) > len(EFFECTS):
        raise ValueError(f"{len(effects)} are listed, but each of the {len(EFFECTS)} kinds stands only once")
    return tuple(effects)


class Scene(Record, Generic[LoadingT_co, LayerT_co]):
    """One contact problem.

    Attributes:
        layer: Elastic layer: a `Layer`, `LayerStack` or `GradedLayer`; a stack of one becomes a `Layer`.
        indenter: Rigid profile pressed into the layer.
        loading: Prescribed radii, depths, forces, detachment, impact or history.
        effects: Effects beyond elastic frictionless contact, each kind at most once; zero friction is omitted.
        beyond_small_strains: Whether depths of the thickness or more are solved by the linear equations, else refused.
    """

    if TYPE_CHECKING:
        layer: LayerT_co
        indenter: Profile
        loading: LoadingT_co
        effects: tuple[Effect, ...] = ()
    else:
        layer: Annotated[
            ElasticLayer,
            OneOf(LayerStack, GradedLayer, Layer, plain=Layer),
            AfterValidator(lambda layer: layer.simplest()),
        ]
        indenter: Annotated[Profile, OneOf(*PROFILES, *SHAPES)]
        loading: Annotated[Loading, OneOf(*LOADINGS)]
        effects: Annotated[tuple[Annotated[Effect, OneOf(*EFFECTS)], ...], BeforeValidator(_listed)] = ()
    beyond_small_strains: StrictBool = False

    def effect(self, kind: type[E]) -> E | None:
        """The effect of this kind, or None."""
        return next((effect for effect in self.effects if isinstance(effect, kind)), None)

    if TYPE_CHECKING:  # at run time `Record.replace` does it

        @overload
        def replace(self, *, loading: L, **changes: Any) -> Scene[L, LayerT_co]: ...
        @overload
        def replace(self, **changes: Any) -> Self: ...
        def replace(self, **changes: Any) -> Any:
            """A copy with some fields changed, validated like a new one."""

    @field_validator("effects")
    @classmethod
    def _without_zero_friction(cls, effects: tuple[Effect, ...]) -> tuple[Effect, ...]:
        return tuple(e for e in effects if not (isinstance(e, Friction) and e.coefficient == 0.0))

    @model_validator(mode="after")
    def _check(self) -> Self:
        _check_effects(self)
        _check_radii(self)
        _check_signs(self)
        _check_moduli(self)
        return self


# A scene with any kind of layer.
AnyScene: TypeAlias = Scene[Loading, ElasticLayer]


def _check_effects(scene: AnyScene) -> None:
    """Refuse repeated effects, and a detachment without adhesion."""
    kinds = [Viscoelasticity if isinstance(effect, Viscoelasticity) else type(effect) for effect in scene.effects]
    if len(set(kinds)) < len(kinds):
        names = ", ".join(type(effect).__name__ for effect in scene.effects)
        raise ValueError(f"effects = {names}: each effect, and one viscoelastic model, may stand only once")
    if isinstance(scene.loading, Detachment) and scene.effect(Adhesion) is None:
        raise ValueError("loading = Detachment needs adhesion; add Adhesion(work_of_adhesion=...) to the effects")


def _check_radii(scene: AnyScene) -> None:
    """Refuse prescribed contact radii that the indenter cannot have."""
    if isinstance(scene.loading, ContactRadii):
        if isinstance(scene.indenter, Shape):
            raise ValueError("loading = ContactRadii: this contact is no circle; give depths or forces")
        if isinstance(scene.indenter, FlatPunch):
            raise ValueError("loading = ContactRadii: a flat punch's contact radius is its own; give depths or forces")
        _check_radius(scene, float(scene.loading.values[0]), "loading.values")
        _check_radius(scene, float(scene.loading.values[-1]), "loading.values")
    start = scene.loading.initial_contact_radius if isinstance(scene.loading, Detachment) else None
    if start is not None:
        if isinstance(scene.indenter, FlatPunch) and start != scene.indenter.radius:
            raise ValueError(
                f"loading.initial_contact_radius = {start:g}: a flat punch starts at its own; leave it out"
            )
        _check_radius(scene, start, "loading.initial_contact_radius")


def _check_radius(scene: AnyScene, radius: float, place: str) -> None:
    """Refuse a radius [m] within the flat end or beyond the end of the profile; ``place`` is its path."""
    flat, end = scene.indenter.flat_radius, scene.indenter.max_radius
    if radius < flat or (radius == flat and not isinstance(scene.indenter, FlatPunch) and not scene.effects):
        raise ValueError(f"{place} = {radius:g}: the indenter's flat end already touches out to {flat:g} m; go beyond")
    if radius > end:
        raise ValueError(f"{place} = {radius:g}: the indenter ends at {end:g} m; stay within")


def _check_signs(scene: AnyScene) -> None:
    """Refuse negative depths and forces without adhesion."""
    if scene.effect(Adhesion) is not None or not isinstance(scene.loading, IndentationDepths | NormalForces):
        return
    if np.any(scene.loading.values < 0.0):
        worst = float(scene.loading.values.min())
        raise ValueError(
            f"loading.values = {worst:g}: without adhesion only positive values press; list Adhesion or press"
        )


def _check_moduli(scene: AnyScene) -> None:
    """Refuse a viscoelastic effect whose instantaneous modulus differs from that of the layer."""
    model = scene.effect(Viscoelasticity)
    if model is None:
        return
    modulus = model.relaxation.instantaneous_modulus
    expected = scene.layer.shear_modulus
    if not math.isclose(modulus, expected, rel_tol=_MODULUS_AGREEMENT):
        raise ValueError(
            f"effects: the instantaneous shear modulus of {type(model).__name__} is {modulus:.10g} Pa, but that of the "
            f"layer, E/(2(1+nu)), is {expected:.10g} Pa; make them agree (Layer.incompressible takes a shear modulus)"
        )
