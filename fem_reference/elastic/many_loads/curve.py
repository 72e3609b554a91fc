"""Depth, force and stiffness over the contact radius, interpolated between solved contacts.

Between the breakpoints of a profile they are analytic in ln(a - b), b the radius of the flat end: logarithms of even
power laws are straight lines.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial.chebyshev import chebder, chebfit, chebval

from contact.records.errors import NotConvergedError
from contact.records.validation import FloatArray
from fem_reference.elastic.error_estimate import ContactWithErrors
from fem_reference.elastic.loaded_contact import LoadedContact
from fem_reference.elastic.path import FemEquilibrium

# Loads at which two curves are compared: four to the narrowest wave of twenty radii.  Chosen.
PLACES = 60
# Share of a load to which its place between solved radii is found: thousands of roundings, below any error of elements.
ROUNDING = 1e-12


@dataclass(frozen=True, kw_only=True)
class LoadCurve:
    """Units: SI for lengths, stresses by E*.

    Attributes:
        flat: radius b of the flat end [m].
        by_depth: whether loads are depths [m] or forces / E* [m^2].
        contacts: at `leja_points` of ln(a - b), in increasing radius.
    """

    flat: float
    by_depth: bool
    contacts: Sequence[ContactWithErrors]

    @cached_property
    def states(self) -> list[FemEquilibrium]:
        """Every solved radius in smooth contact, with the errors that it has at the load it carries."""
        load = "smooth_depth" if self.by_depth else "smooth_force"
        return [
            LoadedContact(
                contact=each, load=getattr(each.answer, load), by_depth=self.by_depth, radius_factor=each.answer.radius
            ).equilibrium
            for each in self.contacts
        ]

    @cached_property
    def solved(self) -> FloatArray:
        """Radius, depth, force and stiffness of the solved contacts, shape (4, n)."""
        rows = []
        for state in self.states:
            a = state.contact.indenter.contact_radius
            rows.append([a, a * state.depth, a**2 * state.force, a * state.stiffness])
        return np.array(rows).T

    @property
    def loads(self) -> FloatArray:
        """What the solved radii carry."""
        return np.asarray(self.solved[1 if self.by_depth else 2])

    @property
    def _places(self) -> FloatArray:
        return np.asarray(np.log(self.solved[0] - self.flat))

    def _inside(self, place: FloatArray) -> FloatArray:
        """Places x = ln(a - b) as arguments of Chebyshev polynomials."""
        low, high = self._places[[0, -1]]
        return np.asarray((2 * place - low - high) / (high - low))

    @cached_property
    def _cardinals(self) -> FloatArray:
        """Chebyshev coefficients of the interpolants that are one at one solved radius and zero at the others."""
        count = len(self.contacts)
        return np.asarray(chebfit(self._inside(self._places), np.eye(count), count - 1))

    def _place_of(self, loads: FloatArray) -> FloatArray:
        """Where loads are carried: Newton's method in logarithms from the straight line between two solved radii.

        Raises:
            NotConvergedError: If a load is not met to `ROUNDING`.
        """
        place, target = np.interp(loads, self.loads, self._places), np.log(loads)
        curve = self._cardinals @ np.log(self.loads)
        slope, (low, high) = chebder(curve), self._places[[0, -1]]
        for _ in range(20):
            at = self._inside(place)
            missed = chebval(at, curve) - target
            place = place - missed / (chebval(at, slope) * 2 / (high - low))
        # NaN is not below either.
        if not np.all(np.abs(missed) < ROUNDING):
            message = "the contact radius of a load between solved radii was not found; ask for fewer loads at a time"
            raise NotConvergedError(message, {"relative load": float(np.abs(missed).max())})
        return np.asarray(place)

    def at(self, loads: FloatArray) -> FloatArray:
        """Radius, depth, force and stiffness at loads, shape (4, load)."""
        place = self._place_of(loads)
        values = np.exp(chebval(self._inside(place), self._cardinals @ np.log(self.solved[1:]).T))
        values[0 if self.by_depth else 1] = loads
        return np.vstack([self.flat + np.exp(place), values])

    def errors(self, loads: FloatArray) -> Mapping[str, FloatArray]:
        """Relative errors at loads by those of the solved radii, in common to all or each apart, whichever is more."""
        weights = chebval(self._inside(self._place_of(loads)), self._cardinals)
        solved = {name: np.array([state.error[name] for state in self.states]) for name in self.states[0].error}
        return {
            name: np.maximum(np.abs(error @ weights), np.sqrt(error**2 @ weights**2)) for name, error in solved.items()
        }

    def change_from(self, coarser: LoadCurve) -> FloatArray:
        """Largest relative change of radius, depth, force and stiffness at one load by the radii added since."""
        loads = np.geomspace(self.loads[0], self.loads[-1], PLACES)
        return np.asarray(np.abs(coarser.at(loads) / self.at(loads) - 1).max(axis=1))


def leja_points(count: int) -> FloatArray:
    """Points of [0, 1], the ends first, each where the product of the distances to those before is largest.

    They serve interpolation nearly as well as Chebyshev's, and a point more moves none of those before it.
    """
    candidates = (1 - np.cos(np.linspace(0.0, np.pi, 129))) / 2
    points = [0.0, 1.0]
    while len(points) < count:
        products = np.abs(candidates[:, None] - points).prod(axis=1)
        points.append(float(candidates[np.argmax(products)]))
    return np.array(points)
