"""Cones on layers: what multiplies Sneddon's force at the same depth, over x = delta/(h tan(theta)).

Every function takes x, shape (n,), and Poisson's ratio, and returns F / (2/pi E* delta^2 / tan(theta)).
"""

import numpy as np
from numpy.polynomial.polynomial import polyval

from contact.records.validation import FloatArray
from mdr.curves import formulas

# Constant of the bonded layer of nu = 1/2 in the formulas of Gavara, Chadwick and Managuli.
BONDED = 1.7795


def sneddon(x: FloatArray, nu: float) -> FloatArray:
    """One: the layer is taken for a half-space."""
    return np.ones_like(x)


def gavara_as_programmed(x: FloatArray, nu: float) -> FloatArray:
    """Gavara and Chadwick 2012 as three public programs have it: bonded, nu = 1/2."""
    return 1 + 2 * BONDED / np.pi**2 * x + 16 * BONDED**2 * x**2


def managuli(x: FloatArray, nu: float) -> FloatArray:
    """Managuli and Roy 2018: bonded, nu = 1/2."""
    c = BONDED / np.pi**2 * x
    return 1 + 4 * c + 20 * c**2


def garcia(x: FloatArray, nu: float) -> FloatArray:
    """Garcia and Garcia 2018: bonded, nu = 1/2."""
    return np.asarray(polyval(x, formulas.GARCIA_CONE))


def hermanowicz_loose(x: FloatArray, nu: float) -> FloatArray:
    """Hermanowicz 2021: frictionless base, any nu."""
    small = 1 + 0.4609328524178679 * x + 0.34583879607230666 * x**2 + 0.04839052498320088 * x**3
    middle = 0.08585462637137942 + 0.10333228383696946 * x - 0.06471205494467767 * x**2 + 1.0565170696173116 * x**3
    large = np.where(x < 5, middle, np.pi / 3 * x**3) / (2 / np.pi * x**2)
    return np.where(x < 1, small, large)
