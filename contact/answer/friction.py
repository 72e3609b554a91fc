"""Answers with friction, and what answers without it say about it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from contact.answer.solution import ContactPath, Fields, HistoryPath, sampled
from contact.records.validation import FloatArray
from contact.scene.layer import ElasticLayer, Layer, LayerStack

# From this Poisson's ratio on, and from this a/h, an answer without friction says what friction would move: a
# coefficient of 0.1 then moves it by up to four per cent or more (0.405 and 0.346 of the bound below at a/h = 1 and
# nu = 1/2 and 0.49, `FrictionlessPunch.largest`, 2026-11-22).
_NEARLY_INCOMPRESSIBLE = 0.49
_THIN = 1.0
# Largest radial displacement under a frictionless unit punch, over a/h: 3/4 on a thin incompressible bonded layer, 1/2
# on an unbonded one (lubrication theory); less on every other layer from a/h = 0.5 on (nu from 0.45 on, 2026-11-22).
_SLIDES = {"bonded": 0.75, "unbonded": 0.5}
# Coefficient of friction that is spoken of.
_SPOKEN_OF = 0.1


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class FrictionPath(ContactPath):
    """Equilibria with friction, each reached by loading alone.

    Attributes:
        stick_radius: Radius of the outermost point that sticks [m], shape (n,); the contact's own under full stick.
        dissipated_energy: Turned into heat since the first touch [J], shape (n,).
    """

    ARRAYS: ClassVar[tuple[str, ...]] = (*ContactPath.ARRAYS, "stick_radius", "dissipated_energy")
    OFFERS: ClassVar[tuple[str, ...]] = (
        *ContactPath.OFFERS,
        "tangential_traction(radius, step)",
        "slip(radius, step)",
    )

    stick_radius: FloatArray
    dissipated_energy: FloatArray

    def scale(self, quantity: str) -> FloatArray:
        """The quantity's own magnitude; the contact radius for that of the stick, work for heat, p's for tractions."""
        if quantity == "dissipated_energy":
            return np.abs(self.normal_force * self.indentation_depth)
        if quantity in ("pressure", "tangential_traction"):
            return np.asarray(np.abs(self.normal_force) / (np.pi * self.contact_radius**2))
        values = self.contact_radius if quantity == "stick_radius" else getattr(self, quantity, np.ones(len(self)))
        return np.abs(np.asarray(values, dtype=np.float64))

    def tangential_traction(self, radius: ArrayLike, step: int = 0) -> FloatArray:
        """Traction q(r) [Pa] of one step at radii [m], positive where it pushes the layer outward, zero outside."""
        return self._field("tangential_traction", radius, step)

    def slip(self, radius: ArrayLike, step: int = 0) -> FloatArray:
        """How far the surface has slid outward at radii [m] since it touched there [m], zero outside."""
        return self._field("slip", radius, step)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class FrictionHistory(HistoryPath):
    """Response to a prescribed history of depth or force, at its own instants: dry friction knows no time.

    Attributes:
        stick_radius: Radius of the outermost point that sticks [m], shape (n,).
        dissipated_energy: Turned into heat since the first touch [J], shape (n,).
        surface: Tractions at the surface at each instant, where the method gives them.
    """

    ARRAYS: ClassVar[tuple[str, ...]] = (*HistoryPath.ARRAYS, "stick_radius", "dissipated_energy")
    OFFERS: ClassVar[tuple[str, ...]] = (
        *HistoryPath.OFFERS,
        "pressure(radius, step)",
        "tangential_traction(radius, step)",
    )

    stick_radius: FloatArray
    dissipated_energy: FloatArray
    surface: Fields | None = None

    def pressure(self, radius: ArrayLike, step: int) -> FloatArray:
        """Pressure p(r) [Pa] of one instant at radii [m], zero outside."""
        return sampled(self, self.surface, "pressure", radius, step)

    def tangential_traction(self, radius: ArrayLike, step: int) -> FloatArray:
        """Traction q(r) [Pa] of one instant at radii [m], positive where it pushes the layer outward, zero outside."""
        return sampled(self, self.surface, "tangential_traction", radius, step)


def told_of_friction(layer: ElasticLayer, radius: FloatArray) -> tuple[str, ...]:
    """What dry friction would move of frictionless contacts of these radii [m]: a note on thin soft layers, or none.

    With u_r1 the radial displacement under the frictionless unit punch, F <= F_0/(1 - mu max |u_r1|) by reciprocity.
    """
    if layer.surface.poissons_ratio < _NEARLY_INCOMPRESSIBLE:
        return ()
    ratio = float(np.max(radius, initial=0.0)) / layer.surface.thickness
    if ratio < _THIN:
        return ()
    if not isinstance(layer, Layer):
        return _told_of_what_lies_below(layer, ratio)
    slip = _SPOKEN_OF * _SLIDES[layer.support] * ratio
    most = f"by up to {100.0 * slip / (1.0 - slip):.2g} %" if slip < 0.5 else "by more than half of it"
    place = f"at a/h = {ratio:.3g} and nu = {layer.poissons_ratio:g}"
    told = f"frictionless: {place} dry friction of {_SPOKEN_OF:g} may raise the force {most}"
    return (f"{told}; contact-verify solve --advise tells more closely, Friction(coefficient=..) solves it",)


def _told_of_what_lies_below(layer: ElasticLayer, ratio: float) -> tuple[str, ...]:
    """On several layers the slip depends on all of them, and has no bound without solving."""
    if not isinstance(layer, LayerStack):
        return ()
    place = f"at a/h = {ratio:.3g} of the surface layer and nu = {layer.surface.poissons_ratio:g}"
    told = f"frictionless: {place} dry friction may raise the force, the more the stiffer what lies below"
    return (f"{told}; contact-verify solve --advise bounds it, Friction(coefficient=..) solves it",)
