"""The layer: an isotropic linear elastic slab on a rigid base, or its limit, the half-space."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import model_validator

from contact.records.errors import refused, shown
from contact.records.record import record
from contact.records.validation import in_range, positive, positive_or_infinite
from contact.scene.elastic_layer import ElasticLayer

Support = Literal["bonded", "unbonded"]


@record
class Layer(ElasticLayer):
    """An elastic layer on a rigid base.

    Attributes:
        thickness: h [m]; infinite for a half-space (see `Layer.half_space`).
        youngs_modulus: E [Pa]; for a viscoelastic layer the instantaneous (glassy) value.
        poissons_ratio: nu in [0, 0.5]; 0.5 is exactly incompressible.
        support: "bonded" (no displacement at the base) or "unbonded" (frictionless base, no lift-off).
    """

    WRITTEN: ClassVar[Mapping[str, Any]] = {
        "properties": {"half_space": {"type": "boolean", "description": "instead of a thickness"}},
        # A viscoelastic effect may give the modulus.
        "replaced": ("thickness", "youngs_modulus"),
        "oneOf": [
            {"required": ["thickness"]},
            {"properties": {"half_space": {"const": True}}, "required": ["half_space"]},
        ],
    }

    thickness: Annotated[
        float, *positive_or_infinite("give the thickness in metres, or use Layer.half_space for an infinite one", "m")
    ]
    youngs_modulus: Annotated[float, *positive("give Young's modulus in pascals", "Pa")]
    poissons_ratio: Annotated[float, *in_range(0.0, 0.5, "Poisson's ratio is 0.5 for an incompressible layer")]
    support: Support = "bonded"

    @model_validator(mode="before")
    @classmethod
    def _half_space(cls, given: Any) -> Any:
        """In files `half_space = true` stands for an infinite thickness."""
        if not isinstance(given, Mapping) or "half_space" not in given:
            return given
        rest = {name: value for name, value in given.items() if name != "half_space"}
        if not isinstance(given["half_space"], bool):
            raise refused(f"half_space = {shown(given['half_space'])}: must be true or false")
        if not given["half_space"]:
            return rest
        if "thickness" in rest:
            raise refused(f"thickness = {shown(rest['thickness'])}: a half-space has none; drop one of the two")
        return rest | {"thickness": math.inf}

    @classmethod
    def half_space(cls, *, youngs_modulus: float, poissons_ratio: float) -> Self:
        """A layer of infinite thickness; its support no longer matters."""
        return cls(thickness=math.inf, youngs_modulus=youngs_modulus, poissons_ratio=poissons_ratio)

    @classmethod
    def incompressible(cls, *, thickness: float, shear_modulus: float, support: Support = "bonded") -> Self:
        """A layer with nu = 1/2 given by its shear modulus G [Pa]: E = 3 G."""
        return cls(thickness=thickness, youngs_modulus=3.0 * shear_modulus, poissons_ratio=0.5, support=support)

    @property
    def is_half_space(self) -> bool:
        """Whether the layer is infinitely thick."""
        return math.isinf(self.thickness)

    @property
    def surface(self) -> Self:
        """The layer itself: it is uniform."""
        return self

    @property
    def is_uniform(self) -> bool:
        """Whether it is of one material."""
        return True

    @property
    def is_piecewise_uniform(self) -> bool:
        """Whether it is of one material, or of several on top of each other."""
        return True

    @property
    def is_incompressible(self) -> bool:
        """Whether nu = 1/2."""
        return self.poissons_ratio == 0.5

    @property
    def title(self) -> str:
        """As in: bonded layer, nu = 0.45."""
        below = "half-space" if self.is_half_space else f"{self.support} layer"
        return f"{below}, nu = {self.poissons_ratio:g}"

    def in_own_units(self) -> Self:
        """The same layer with thickness 1 and E* = 1; a half-space stays infinite."""
        nu = self.poissons_ratio
        thickness = math.inf if self.is_half_space else 1.0
        return self.replace(thickness=thickness, youngs_modulus=(1.0 - nu) * (1.0 + nu))

    @property
    def confined_modulus(self) -> float:
        """Modulus of uniaxial strain, E (1-nu) / ((1+nu)(1-2nu)) [Pa], Eq. (16); infinite at nu = 1/2."""
        nu = self.poissons_ratio
        if nu == 0.5:
            return math.inf
        return self.youngs_modulus * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))
