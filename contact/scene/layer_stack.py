"""Several elastic layers on top of each other, on a rigid base or on an elastic half-space."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, ClassVar, Literal, Self, TypeAlias

from pydantic import Discriminator, Field, Tag, model_validator

from contact.records.record import Record, record
from contact.records.validation import PositiveLength, in_range, positive
from contact.scene.elastic_layer import ElasticLayer
from contact.scene.layer import Layer, Support

Interface: TypeAlias = Literal["bonded", "unbonded"]

# More sublayers are refused: a graded material is a `GradedLayer`.
MAX_SUBLAYERS = 1000


@record
class Sublayer(Record):
    """One uniform layer of a stack.

    Attributes:
        thickness: h_i [m].
        youngs_modulus: E_i [Pa].
        poissons_ratio: nu_i in [0, 0.5]; 0.5 is exactly incompressible.
    """

    thickness: PositiveLength
    youngs_modulus: Annotated[float, *positive("give Young's modulus in pascals", "Pa")]
    poissons_ratio: Annotated[float, *in_range(0.0, 0.5, "Poisson's ratio is 0.5 for an incompressible layer")]


@record
class ElasticBase(Record):
    """An elastic half-space below a layer.

    Attributes:
        youngs_modulus: E [Pa].
        poissons_ratio: nu in [0, 0.5].
        interface: "bonded", or "unbonded" (frictionless, no lift-off), between base and layer.
    """

    youngs_modulus: Annotated[float, *positive("give Young's modulus in pascals", "Pa")]
    poissons_ratio: Annotated[float, *in_range(0.0, 0.5, "Poisson's ratio is 0.5 for an incompressible base")]
    interface: Interface = "bonded"

    def scaled(self, modulus: float) -> Self:
        """The same base with its modulus over another one [Pa]."""
        return self.replace(youngs_modulus=self.youngs_modulus / modulus)


def _base(support: object) -> str:
    return "kind:elastic" if isinstance(support, Mapping | ElasticBase) else "kind:rigid"


Supported: TypeAlias = Annotated[
    Annotated[Support, Tag("kind:rigid")] | Annotated[ElasticBase, Tag("kind:elastic")], Discriminator(_base)
]
"""A rigid base, by how the layer holds on to it, or an elastic one."""


@record
class LayerStack(ElasticLayer):
    """Uniform layers on top of each other. A scene takes a stack of one on a rigid base as that `Layer`.

    Attributes:
        sublayers: From the top; the first touches the indenter.
        interfaces: One fewer than sublayers: "bonded", or "unbonded" (frictionless, no lift-off).
        support: "bonded" or "unbonded" to a rigid base, or an `ElasticBase`.
    """

    NAMED: ClassVar[bool] = True

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
        """All sublayers together [m]."""
        return math.fsum(one.thickness for one in self.sublayers)

    @property
    def surface(self) -> Sublayer:
        """The sublayer that touches the indenter."""
        return self.sublayers[0]

    @property
    def is_piecewise_uniform(self) -> bool:
        """Whether it is of one material, or of several on top of each other."""
        return True

    @property
    def is_incompressible(self) -> bool:
        """Whether nu = 1/2 in every sublayer and in an elastic base."""
        base = self.support.poissons_ratio if isinstance(self.support, ElasticBase) else 0.5
        return all(nu == 0.5 for nu in (base, *(one.poissons_ratio for one in self.sublayers)))

    @property
    def has_elastic_base(self) -> bool:
        """Whether it rests on an elastic half-space."""
        return isinstance(self.support, ElasticBase)

    @property
    def title(self) -> str:
        """As in: stack of 3, elastic base."""
        below = "elastic base" if self.has_elastic_base else f"{self.support}"
        return f"stack of {len(self.sublayers)}, {below}"

    def simplest(self) -> ElasticLayer:
        """A stack of one on a rigid base is a `Layer`."""
        if len(self.sublayers) > 1 or isinstance(self.support, ElasticBase):
            return self
        only = self.surface
        return Layer(
            thickness=only.thickness,
            youngs_modulus=only.youngs_modulus,
            poissons_ratio=only.poissons_ratio,
            support=self.support,
        )

    def in_own_units(self) -> Self:
        """The same stack with thickness 1 and E* = 1."""
        length, modulus, support = self.thickness, self.contact_modulus, self.support
        sublayers = tuple(
            one.replace(thickness=one.thickness / length, youngs_modulus=one.youngs_modulus / modulus)
            for one in self.sublayers
        )
        base = support.scaled(modulus) if isinstance(support, ElasticBase) else support
        return self.replace(sublayers=sublayers, support=base)

    def stretched(self, factor: float) -> Self:
        """The same stack with every sublayer so many times as thick."""
        return self.replace(sublayers=tuple(one.replace(thickness=one.thickness * factor) for one in self.sublayers))
