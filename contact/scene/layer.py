"""Elastic layers: one uniform slab, its limit the half-space, or several slabs on a rigid or an elastic base."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self, TypeAlias

from pydantic import Discriminator, Field, Tag, model_validator

from contact.records.errors import refused, shown
from contact.records.record import Record
from contact.records.validation import Modulus, PoissonsRatio, PositiveLength, Scalar, number

Support: TypeAlias = Literal["bonded", "unbonded"]
Interface: TypeAlias = Literal["bonded", "unbonded"]
# Largest number of sublayers; materials of more are described by a `GradedLayer`.
MAX_SUBLAYERS = 1000


class Sublayer(Record):
    """One uniform layer of a stack.

    Attributes:
        thickness: Thickness h_i [m].
        youngs_modulus: Young's modulus E_i [Pa].
        poissons_ratio: Poisson's ratio nu_i in [0, 0.5]; 0.5 is exactly incompressible.
    """

    thickness: PositiveLength
    youngs_modulus: Modulus
    poissons_ratio: PoissonsRatio


class ElasticBase(Record):
    """An elastic half-space below a layer.

    Attributes:
        youngs_modulus: Young's modulus E [Pa].
        poissons_ratio: Poisson's ratio nu in [0, 0.5].
        interface: "bonded", or "unbonded" (frictionless, no lift-off), between base and layer.
    """

    youngs_modulus: Modulus
    poissons_ratio: PoissonsRatio
    interface: Interface = "bonded"

    def scaled(self, modulus: float) -> Self:
        """Copy of the base with its modulus divided by ``modulus`` [Pa]."""
        return self.replace(youngs_modulus=self.youngs_modulus / modulus)


class ElasticLayer(Record):
    """Base of `Layer`, `LayerStack` and `GradedLayer`, with their common properties."""

    if TYPE_CHECKING:  # at run time properties would hide fields of these names

        @property
        def thickness(self) -> float:
            """Thickness h [m] of all sublayers together; infinite for a half-space."""

        @property
        def support(self) -> Support | ElasticBase:
            """Interface to a rigid base, "bonded" or "unbonded", or an elastic base."""

    @property
    def surface(self) -> Layer | Sublayer:
        """Uniform layer with the material that touches the indenter."""
        raise TypeError(f"{type(self).__name__} declares no surface")

    def in_own_units(self) -> Self:
        """Copy of the layer in units of its thickness and E*; a half-space stays infinite."""
        raise TypeError(f"{type(self).__name__} has no units of its own")

    def stretched(self, factor: float) -> ElasticLayer:
        """Copy of the layer with all depths multiplied by the factor."""
        raise TypeError(f"{type(self).__name__} cannot be stretched")

    def simplest(self) -> ElasticLayer:
        """The layer as an object of the simplest class that describes it."""
        return self

    @property
    def is_half_space(self) -> bool:
        """Whether the layer is infinitely thick and uniform."""
        return math.isinf(self.thickness)

    @property
    def is_uniform(self) -> bool:
        """Whether the layer is of one material."""
        return isinstance(self, Layer)

    @property
    def is_piecewise_uniform(self) -> bool:
        """Whether the layer is one uniform material or a stack of uniform layers."""
        return isinstance(self, Layer | LayerStack)

    @property
    def has_elastic_base(self) -> bool:
        """Whether the base is an elastic half-space of another material, not rigid."""
        return isinstance(self.support, ElasticBase)

    @property
    def is_incompressible(self) -> bool:
        """Whether nu = 1/2 everywhere, an elastic base included."""
        base = self.support.poissons_ratio if isinstance(self.support, ElasticBase) else 0.5
        return all(nu == 0.5 for nu in (base, *self._ratios()))

    def _ratios(self) -> tuple[float, ...]:
        return (self.surface.poissons_ratio,)

    @property
    def contact_modulus(self) -> float:
        """Contact modulus E* = E / (1 - nu^2) [Pa] at the surface."""
        nu = self.surface.poissons_ratio
        return self.surface.youngs_modulus / ((1.0 - nu) * (1.0 + nu))

    @property
    def shear_modulus(self) -> float:
        """Shear modulus G = E / (2 (1 + nu)) [Pa] at the surface."""
        return self.surface.youngs_modulus / (2.0 * (1.0 + self.surface.poissons_ratio))

    @property
    def title(self) -> str:
        """Short name of the layer for titles."""
        return type(self).__name__


_THICKNESS = "give the thickness in metres; for an infinite one half_space = true in a file, Layer.half_space in Python"
Thickness = Annotated[Scalar, *number(_THICKNESS, "m", above=True, infinite=True)]


class Layer(ElasticLayer):
    """An elastic layer on a rigid base.

    Attributes:
        thickness: Thickness h [m]; infinite for a half-space (see `Layer.half_space`).
        youngs_modulus: Young's modulus E [Pa]; for a viscoelastic layer the instantaneous (glassy) value.
        poissons_ratio: Poisson's ratio nu in [0, 0.5]; 0.5 is exactly incompressible.
        support: "bonded" (no displacement at the base) or "unbonded" (frictionless base, no lift-off).
    """

    SHORTHANDS: ClassVar[Mapping[str, Any]] = {
        "half_space": {"type": "boolean", "description": "instead of a thickness"}
    }
    REPLACED: ClassVar[Mapping[str, str]] = {"thickness": "half_space", "youngs_modulus": ""}

    thickness: Thickness
    youngs_modulus: Modulus
    poissons_ratio: PoissonsRatio
    support: Support = "bonded"

    @model_validator(mode="before")
    @classmethod
    def _half_space(cls, given: Any) -> Any:
        """A table with an infinite thickness from one with `half_space = true`."""
        if not isinstance(given, Mapping) or "half_space" not in given:
            return given
        rest = {name: value for name, value in given.items() if name != "half_space"}
        if not isinstance(given["half_space"], bool):
            raise refused(f"half_space = {shown(given['half_space'])}: must be true or false")
        if given["half_space"] and "thickness" in rest:
            raise refused(f"thickness = {shown(rest['thickness'])}: a half-space has none; drop one of the two")
        return rest | ({"thickness": math.inf} if given["half_space"] else {})

    @classmethod
    def half_space(cls, *, youngs_modulus: float, poissons_ratio: float) -> Self:
        """A layer of infinite thickness; its support has no effect."""
        return cls(thickness=math.inf, youngs_modulus=youngs_modulus, poissons_ratio=poissons_ratio)

    @classmethod
    def incompressible(cls, *, thickness: float, shear_modulus: float, support: Support = "bonded") -> Self:
        """A layer with nu = 1/2 given by its shear modulus G [Pa]: E = 3 G."""
        return cls(thickness=thickness, youngs_modulus=3.0 * shear_modulus, poissons_ratio=0.5, support=support)

    @property
    def surface(self) -> Self:
        """The layer itself, since it is uniform."""
        return self

    @property
    def title(self) -> str:
        """Short name of the layer for titles, such as "bonded layer, nu = 0.45"."""
        below = "half-space" if self.is_half_space else f"{self.support} layer"
        return f"{below}, nu = {self.poissons_ratio:g}"

    def in_own_units(self) -> Self:
        """Copy of the layer with thickness 1 and E* = 1; a half-space stays infinite."""
        nu = self.poissons_ratio
        return self.replace(thickness=math.inf if self.is_half_space else 1.0, youngs_modulus=(1.0 - nu) * (1.0 + nu))

    @property
    def confined_modulus(self) -> float:
        """Modulus of uniaxial strain, E (1-nu) / ((1+nu)(1-2nu)) [Pa], Eq. (16); infinite at nu = 1/2."""
        nu = self.poissons_ratio
        return math.inf if nu == 0.5 else self.youngs_modulus * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))


Supported: TypeAlias = Annotated[
    Annotated[Support, Tag("kind:rigid")] | Annotated[ElasticBase, Tag("kind:elastic")],
    Discriminator(lambda support: "kind:elastic" if isinstance(support, Mapping | ElasticBase) else "kind:rigid"),
]
"""Interface to a rigid base, or an elastic base."""


class LayerStack(ElasticLayer):
    """Uniform layers on top of each other. In a scene a stack of one on a rigid base becomes a `Layer`.

    Attributes:
        sublayers: Layers from the top; the first touches the indenter.
        interfaces: Interfaces, one fewer than sublayers: "bonded", or "unbonded" (frictionless, no lift-off).
        support: "bonded" or "unbonded" to a rigid base, or an `ElasticBase`.
    """

    NAMED = True

    sublayers: Annotated[tuple[Sublayer, ...], Field(max_length=MAX_SUBLAYERS, strict=False)]
    interfaces: Annotated[tuple[Interface, ...], Field(strict=False)] = ()
    support: Supported = "bonded"

    @model_validator(mode="after")
    def _check(self) -> Self:
        count = len(self.sublayers)
        if not 1 <= count <= MAX_SUBLAYERS:
            raise ValueError(f"sublayers: a stack has 1 to {MAX_SUBLAYERS}, got {count}; list them from the top")
        if len(self.interfaces) != count - 1:
            raise ValueError(
                f"interfaces: {count} sublayers meet at {count - 1} interfaces, got {len(self.interfaces)}; "
                'write "bonded" or "unbonded" for each, from the top'
            )
        return self

    @property
    def thickness(self) -> float:
        """Thickness [m] of all sublayers together."""
        return math.fsum(part.thickness for part in self.sublayers)

    @property
    def surface(self) -> Sublayer:
        """The sublayer that touches the indenter."""
        return self.sublayers[0]

    def _ratios(self) -> tuple[float, ...]:
        return tuple(part.poissons_ratio for part in self.sublayers)

    @property
    def title(self) -> str:
        """Short name of the layer for titles, such as "stack of 3, elastic base"."""
        return f"stack of {len(self.sublayers)}, {'elastic base' if self.has_elastic_base else self.support}"

    def simplest(self) -> ElasticLayer:
        """The `Layer` that a stack of one on a rigid base is; other stacks are returned unchanged."""
        if len(self.sublayers) > 1 or isinstance(self.support, ElasticBase):
            return self
        return Layer(**vars(self.surface), support=self.support)

    def in_own_units(self) -> Self:
        """Copy of the stack with thickness 1 and E* = 1."""
        length, modulus, support = self.thickness, self.contact_modulus, self.support
        sublayers = tuple(
            part.replace(thickness=part.thickness / length, youngs_modulus=part.youngs_modulus / modulus)
            for part in self.sublayers
        )
        base = support.scaled(modulus) if isinstance(support, ElasticBase) else support
        return self.replace(sublayers=sublayers, support=base)

    def stretched(self, factor: float) -> Self:
        """Copy of the stack with all thicknesses multiplied by the factor."""
        return self.replace(sublayers=tuple(part.replace(thickness=part.thickness * factor) for part in self.sublayers))
