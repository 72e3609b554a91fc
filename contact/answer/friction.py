"""Answers with friction: beside depth, force and radius what sticks, what slides, and what turns into heat."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from contact.answer.solution import ContactPath, HistoryPath
from contact.records.validation import FloatArray


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
    """

    ARRAYS: ClassVar[tuple[str, ...]] = (*HistoryPath.ARRAYS, "stick_radius", "dissipated_energy")

    stick_radius: FloatArray
    dissipated_energy: FloatArray
