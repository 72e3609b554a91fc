"""Two rigid bodies with equal elastic coatings, reduced to one rigid indenter on one layer, Eqs. (23)-(25)."""

from __future__ import annotations

from typing import Annotated

from pydantic import model_validator

from contact.records.record import Record
from contact.records.validation import Modulus, PoissonsRatio, PositiveLength, Scalar, number
from contact.scene.effects import Effect
from contact.scene.layer import Layer, Support
from contact.scene.loading import Loading
from contact.scene.profiles import Paraboloid
from contact.scene.scene import Scene

_Radius = Annotated[Scalar, *number("give the radius of curvature in metres", "m", above=True, infinite=True)]


class CoatedPair(Record):
    """Two coated bodies of revolution in contact.

    Attributes:
        first_radius: Radius of curvature R_1 [m] of the first body; infinite for a plane one.
        second_radius: Radius of curvature R_2 [m] of the second body.
        first_thickness: Coating thickness h_1 [m] of the first body.
        second_thickness: Coating thickness h_2 [m] of the second body; Eq. (25) is an approximation unless h_1 = h_2.
        youngs_modulus: Young's modulus E [Pa] of both coatings.
        poissons_ratio: Poisson's ratio nu of both coatings.
        support: Interface of each coating to its body, "bonded" or "unbonded".
        loading: Prescribed quantity as in a `Scene`; depths are approaches of the two bodies.
        effects: Effects as in a `Scene`.
    """

    first_radius: _Radius
    second_radius: _Radius
    first_thickness: PositiveLength
    second_thickness: PositiveLength
    youngs_modulus: Modulus
    poissons_ratio: PoissonsRatio
    support: Support = "bonded"
    loading: Loading
    effects: tuple[Effect, ...] = ()

    @model_validator(mode="after")
    def _check(self) -> CoatedPair:
        if 1.0 / self.first_radius + 1.0 / self.second_radius == 0.0:
            raise ValueError("two plane bodies touch everywhere at once; give at least one finite radius of curvature")
        return self

    def scene(self) -> Scene:
        """The equivalent rigid paraboloid on one layer; depth is the approach of the two bodies."""
        curvature = 1.0 / self.first_radius + 1.0 / self.second_radius  # Eq. (23)
        layer = Layer(
            thickness=0.5 * (self.first_thickness + self.second_thickness),  # Eq. (25)
            youngs_modulus=0.5 * self.youngs_modulus,  # Eq. (24)
            poissons_ratio=self.poissons_ratio,
            support=self.support,
        )
        indenter = Paraboloid(radius_of_curvature=1.0 / curvature)
        return Scene(layer=layer, indenter=indenter, loading=self.loading, effects=self.effects)
