"""Formulas in use for the modulus from force curves, each with its source: what a fit by them would have said.

All are F = E phi(d), with phi a power of the depth times a polynomial in a number x that compares depth and thickness.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from contact import Cone, FlatPunch, Layer, Paraboloid, Scene, Sphere
from contact.records.validation import FloatArray
from mdr.curves import series


@dataclass(frozen=True)
class Formula:
    """phi(d) = factor d^power (1 + c_1 x + c_2 x^2 + ...) with x = (d / length)^share.

    Attributes:
        name: As people call it.
        source: Where it is from.
        factor: Of phi [m^(2 - power)].
        power: Of the depth.
        length: That the depth is compared with [m].
        share: Power of that comparison.
        coefficients: 1, c_1, c_2, ...
    """

    name: str
    source: str
    factor: float
    power: float
    length: float = math.inf
    share: float = 1.0
    coefficients: tuple[float, ...] = (1.0,)

    def per_modulus(self, depth: ArrayLike) -> FloatArray:
        """phi [m^2], zero for depths of at most zero."""
        d = np.maximum(np.asarray(depth, dtype=np.float64), 0.0)
        x = (d / self.length) ** self.share
        return np.asarray(self.factor * d**self.power * np.polynomial.polynomial.polyval(x, self.coefficients))

    def extended(self, depth: ArrayLike) -> FloatArray:
        """phi [m^2], as `per_modulus`."""
        return self.per_modulus(depth)

    def per_modulus_slope(self, depth: ArrayLike) -> FloatArray:
        """d(phi)/d(depth) [m]."""
        d = np.maximum(np.asarray(depth, dtype=np.float64), 0.0)
        x = (d / self.length) ** self.share
        powers = self.power + self.share * np.arange(len(self.coefficients))
        terms = np.polynomial.polynomial.polyval(x, powers * np.array(self.coefficients))
        return np.where(np.asarray(depth) > 0.0, self.factor * d ** (self.power - 1.0) * terms, 0.0)

    def with_slope(self, depth: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """phi and its derivative together."""
        return self.per_modulus(depth), self.per_modulus_slope(depth)


HERTZ = "Hertz 1882"
SNEDDON = "Sneddon 1965"
DIMITRIADIS = "Dimitriadis et al. 2002, Biophys. J. 82, 2798"
GARCIA = "Garcia, Garcia 2018, Biophys. J. 114, 2923"


def formulas_for(scene: Scene) -> tuple[Formula, ...]:
    """The formulas that people use for this tip and support; none for other tips or layers of several materials."""
    if not isinstance(scene.layer, Layer):
        return ()
    match scene.indenter:
        case Paraboloid(radius_of_curvature=radius) | Sphere(radius=radius):
            found = _round(scene.layer, radius)
        case Cone(slope=slope):
            found = _cone(scene.layer, slope)
        case FlatPunch(radius=radius):
            found = _punch(scene.layer, radius)
        case _:
            return ()
    return tuple(found)


def _round(layer: Layer, radius: float) -> list[Formula]:
    """x = sqrt(R d)/h."""
    nu, h = layer.poissons_ratio, layer.thickness
    factor = 4 / (3 * (1 - nu**2)) * math.sqrt(radius)
    found = [Formula("Hertz", HERTZ, factor, 1.5)]
    if layer.is_half_space:
        return found

    def in_thickness(name: str, source: str, coefficients: Sequence[float]) -> Formula:
        return Formula(name, source, factor, 1.5, h**2 / radius, 0.5, tuple(coefficients))

    bonded = layer.support == "bonded"
    # Where the last coefficient is in question, the one in use is taken.
    in_use = series.DIMITRIADIS_BONDED if bonded and nu == 0.5 else series.dimitriadis(nu, bonded=bonded)
    found.append(in_thickness("Dimitriadis", DIMITRIADIS, in_use))
    if bonded and nu == 0.5:
        found.append(in_thickness("Garcia", GARCIA, series.GARCIA_PARABOLOID))
    return found


def _cone(layer: Layer, slope: float) -> list[Formula]:
    """x = d/(h slope): depth times the tangent of the half angle over the thickness."""
    factor = 2 / (math.pi * slope * (1 - layer.poissons_ratio**2))
    found = [Formula("Sneddon", SNEDDON, factor, 2.0)]
    if layer.support == "bonded" and layer.poissons_ratio == 0.5 and not layer.is_half_space:
        found.append(Formula("Garcia", GARCIA, factor, 2.0, layer.thickness * slope, 1.0, series.GARCIA_CONE))
    return found


def _punch(layer: Layer, radius: float) -> list[Formula]:
    """x = a/h is a constant of the scene."""
    factor = 2 * radius / (1 - layer.poissons_ratio**2)
    found = [Formula("Sneddon", SNEDDON, factor, 1.0)]
    if layer.support == "bonded" and layer.poissons_ratio == 0.5 and not layer.is_half_space:
        x = radius / layer.thickness
        stiffer = float(np.polynomial.polynomial.polyval(x, series.GARCIA_PUNCH))
        found.append(Formula("Garcia", GARCIA, factor * stiffer, 1.0))
    return found
