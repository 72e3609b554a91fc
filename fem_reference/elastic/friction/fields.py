"""Tractions, slip and displacement of the surface under friction, in SI units."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contact.records.validation import FloatArray
from fem_reference.elastic.friction.growth import Growing
from fem_reference.elastic.friction.step import RubbedState


@dataclass(frozen=True)
class Blend:
    """A state between two touching points; between them everything moves in proportion to the depth.

    Attributes:
        growing: the strip.
        before: the touching point before it.
        after: the one after it.
        share: of the way from one to the other.
        modulus: E* [Pa].
    """

    growing: Growing
    before: RubbedState
    after: RubbedState
    share: float
    modulus: float

    @classmethod
    def at(cls, growing: Growing, depth: float, modulus: float) -> Blend:
        """The state at a depth [m]; beyond the last touching point in the proportion of the last two."""
        place = int(np.clip(np.searchsorted(growing.depth, depth), 1, len(growing.depth) - 1))
        low, high = growing.depth[place - 1], growing.depth[place]
        states = growing.states[place - 1 : place + 1]
        return cls(growing, states[0], states[1], float((depth - low) / (high - low)), modulus)

    def of(self, name: str) -> FloatArray:
        """A nodal quantity of the state."""
        before, after = getattr(self.before, name), getattr(self.after, name)
        return np.asarray(before + self.share * (after - before))

    def on_nodes(self, values: FloatArray, radius: FloatArray) -> FloatArray:
        """A piecewise linear function on the strip at radii [m]."""
        contact = self.growing.contact
        return contact.surface.tractions.evaluate(values, radius / contact.radius)

    @property
    def slip(self) -> FloatArray:
        """u_r since touching over the strip's radius at the nodes, zero on the axis and outside the contact."""
        moved = (self.of("radial") - self.of("touched")) / self.growing.contact.surface.resultants
        moved[0] = 0.0
        return np.where(self.of("pressure") > 0.0, moved, 0.0)

    def displacement(self, radius: FloatArray) -> FloatArray:
        """w(r) [m]."""
        contact = self.growing.contact
        nodal = contact.surface.top_displacements @ np.concatenate([self.of("pressure"), self.of("shear")])
        return contact.radius * contact.surface.top.evaluate(nodal, radius / contact.radius)


@dataclass(frozen=True)
class RubbedFields:
    """Surface fields of a path; satisfies `contact.Fields`."""

    blends: tuple[Blend, ...]

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """p(r) [Pa]."""
        blend = self.blends[step]
        return blend.modulus * blend.on_nodes(blend.of("pressure"), radius)

    def tangential_traction(self, radius: FloatArray, step: int) -> FloatArray:
        """q(r) [Pa], positive where the layer is pushed outward, zero outside."""
        blend = self.blends[step]
        return blend.modulus * blend.on_nodes(blend.of("shear"), radius)

    def slip(self, radius: FloatArray, step: int) -> FloatArray:
        """How far the surface has slid outward since it touched [m], zero outside."""
        blend = self.blends[step]
        return blend.growing.contact.radius * blend.on_nodes(blend.slip, radius)

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """w(r) [m], positive into the layer; zero beyond the mesh."""
        return self.blends[step].displacement(radius)


def traction_errors(fine: Blend, coarse: Blend) -> dict[str, float]:
    """What half the cells change of both tractions: root mean square over the contact, relative to that of p."""
    surface = fine.growing.contact.surface
    radius, weight = (values.ravel() for values in surface.tractions.gauss(2))
    pressure = surface.tractions.evaluate(fine.of("pressure"), radius)
    size = float(weight @ pressure**2)
    errors = {}
    for quantity, name in (("pressure", "pressure"), ("tangential_traction", "shear")):
        others = coarse.growing.contact.surface.tractions.evaluate(coarse.of(name), radius)
        change = surface.tractions.evaluate(fine.of(name), radius) - others
        errors[quantity] = float(np.sqrt(weight @ change**2 / size))
    return errors
