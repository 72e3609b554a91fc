"""Formulas in use for the modulus from force curves, each with its source.

All are F = E phi(d), with phi a power of the depth times a polynomial in a number x that compares depth and thickness.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.polynomial.polynomial import polyval
from numpy.typing import ArrayLike

from contact import Cone, FlatPunch, Layer, Paraboloid, Scene, Sphere
from contact.records.validation import FloatArray


@dataclass(frozen=True)
class Formula:
    """phi(d) = factor d^power (1 + c_1 x + c_2 x^2 + ...) with x = (d / length)^share.

    Attributes:
        name: Usual name.
        source: Publication.
        factor: Factor of phi [m^(2 - power)].
        power: Exponent of the depth.
        length: Length to which the depth is compared [m].
        share: Exponent of their ratio.
        coefficients: Coefficients 1, c_1, c_2, ... of the polynomial.
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
        return np.asarray(self.factor * d**self.power * polyval(x, self.coefficients))


HERTZ = "Hertz 1882"
SNEDDON = "Sneddon 1965"
DIMITRIADIS = "Dimitriadis et al. 2002, Biophys. J. 82, 2798"
GARCIA = "Garcia, Garcia 2018, Biophys. J. 114, 2923"
# Coefficients of 1, x, x^2, .. at nu = 1/2, Garcia's for bonded layers, as in public programs that cite the papers and
# agree with each other; not compared with the papers. x is sqrt(R d)/h for a paraboloid, a/h for a flat punch,
# d tan(alpha)/h for a cone of half angle alpha.
DIMITRIADIS_BONDED = (1.0, 1.133, 1.283, 0.769, 0.0975)
DIMITRIADIS_NOT_BONDED = (1.0, 0.884, 0.781, 0.386, 0.0048)
GARCIA_PARABOLOID = (1.0, 1.133, 1.497, 1.469, 0.755)
GARCIA_CONE = (1.0, 0.721, 0.650, 0.491, 0.225)
GARCIA_PUNCH = (1.0, 1.133, 1.283, 0.598, -0.291)


def dimitriadis(nu: float, *, bonded: bool) -> tuple[float, ...]:
    """Coefficients of Dimitriadis et al. 2002 for any Poisson's ratio, with alpha_0 and beta_0 as in AtomicJ.

    For a bonded layer at nu = 1/2 its last coefficient is -0.0975, where `DIMITRIADIS_BONDED` has +0.0975.
    """
    alpha, beta = -0.347 * (3 - 2 * nu) / (1 - nu), 0.056 * (5 - 2 * nu) / (1 - nu)
    if bonded:
        alpha = -(1.2876 - 1.4678 * nu + 1.3442 * nu**2) / (1 - nu)
        beta = (0.6387 - 1.0277 * nu + 1.5164 * nu**2) / (1 - nu)
    pi = math.pi
    return (
        1.0,
        -2 * alpha / pi,
        4 * alpha**2 / pi**2,
        -8 / pi**3 * (alpha**3 + 4 * pi**2 / 15 * beta),
        16 * alpha / pi**4 * (alpha**3 + 3 * pi**2 / 5 * beta),
    )


def formulas_for(scene: Scene) -> tuple[Formula, ...]:
    """The formulas in use for this tip and support; none for other tips or layers of several materials."""
    layer = scene.layer
    if not isinstance(layer, Layer):
        return ()
    nu, h, compliance = layer.poissons_ratio, layer.thickness, 1 - layer.poissons_ratio**2
    bonded = layer.support == "bonded"
    # Garcia's coefficients are those of bonded layers at nu = 1/2.
    garcia = bonded and nu == 0.5 and not layer.is_half_space
    match scene.indenter:
        case Paraboloid(radius_of_curvature=radius) | Sphere(radius=radius):
            factor, length = 4 / (3 * compliance) * math.sqrt(radius), h**2 / radius
            formulas = [Formula("Hertz", HERTZ, factor, 1.5)]
            if not layer.is_half_space:
                # At nu = 1/2 the sources differ in the sign of the last coefficient; here it is the common one.
                in_use = DIMITRIADIS_BONDED if garcia else dimitriadis(nu, bonded=bonded)
                formulas += [Formula("Dimitriadis", DIMITRIADIS, factor, 1.5, length, 0.5, in_use)]
            if garcia:
                formulas += [Formula("Garcia", GARCIA, factor, 1.5, length, 0.5, GARCIA_PARABOLOID)]
        case Cone(slope=slope):
            factor = 2 / (math.pi * slope * compliance)
            formulas = [Formula("Sneddon", SNEDDON, factor, 2.0)]
            if garcia:
                formulas += [Formula("Garcia", GARCIA, factor, 2.0, h * slope, 1.0, GARCIA_CONE)]
        case FlatPunch(radius=radius):
            factor = 2 * radius / compliance
            formulas = [Formula("Sneddon", SNEDDON, factor, 1.0)]
            if garcia:  # x = a/h is a constant of the scene
                formulas += [Formula("Garcia", GARCIA, factor * float(polyval(radius / h, GARCIA_PUNCH)), 1.0)]
        case _:
            return ()
    return tuple(formulas)
