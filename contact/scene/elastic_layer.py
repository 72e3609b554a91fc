"""What every kind of elastic layer answers: its thickness, and the material that touches the indenter."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol, Self

from contact.records.record import Record


class SurfaceMaterial(Protocol):
    """The uniform part of a layer that touches the indenter."""

    @property
    def thickness(self) -> float:
        """Of that part [m]."""

    @property
    def youngs_modulus(self) -> float:
        """E [Pa] at the surface."""

    @property
    def poissons_ratio(self) -> float:
        """nu at the surface."""


class ElasticLayer(Record):
    """Base of `Layer`, `LayerStack` and `GradedLayer`."""

    # At run time a property here would hide the field of that name of some layers.
    if TYPE_CHECKING:

        @property
        def thickness(self) -> float:
            """h [m], of all sublayers together; infinite for a half-space."""

    @property
    def surface(self) -> SurfaceMaterial:
        """What touches the indenter."""
        raise TypeError(f"{type(self).__name__} declares no surface")

    @property
    def is_half_space(self) -> bool:
        """Whether the layer is infinitely thick and uniform."""
        return False

    @property
    def is_uniform(self) -> bool:
        """Whether it is of one material."""
        return False

    @property
    def is_piecewise_uniform(self) -> bool:
        """Whether it is of one material, or of several on top of each other."""
        return False

    @property
    def is_incompressible(self) -> bool:
        """Whether nu = 1/2 everywhere, an elastic base included."""
        return False

    @property
    def has_elastic_base(self) -> bool:
        """Whether it rests on an elastic half-space of another material, and not on a rigid base."""
        return False

    @property
    def contact_modulus(self) -> float:
        """E* = E / (1 - nu^2) [Pa] at the surface."""
        nu = self.surface.poissons_ratio
        return self.surface.youngs_modulus / ((1.0 - nu) * (1.0 + nu))

    @property
    def shear_modulus(self) -> float:
        """G = E / (2 (1 + nu)) [Pa] at the surface."""
        return self.surface.youngs_modulus / (2.0 * (1.0 + self.surface.poissons_ratio))

    @property
    def title(self) -> str:
        """A few words for headings."""
        return type(self).__name__

    def simplest(self) -> ElasticLayer:
        """The plainest record of the same body."""
        return self

    def in_own_units(self) -> Self:
        """The same layer with thickness 1 and E* = 1; a half-space stays infinite."""
        raise TypeError(f"{type(self).__name__} has no units of its own")

    def stretched(self, factor: float) -> ElasticLayer:
        """The same layer with all depths so many times as large."""
        raise TypeError(f"{type(self).__name__} cannot be stretched")
