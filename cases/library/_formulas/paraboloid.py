"""Paraboloids on layers: what multiplies Hertz's force at the same depth, over X = sqrt(R delta)/h.

Every function takes X, shape (n,), and Poisson's ratio, and returns F / (4/3 E* sqrt(R) delta^(3/2)).
"""

import numpy as np
from numpy.polynomial.polynomial import polyval

from contact.records.validation import FloatArray
from mdr.curves import series


def hertz(x: FloatArray, nu: float) -> FloatArray:
    """One: the layer is taken for a half-space."""
    return np.ones_like(x)


def dimitriadis_bonded(x: FloatArray, nu: float) -> FloatArray:
    """Dimitriadis et al. 2002: bonded, nu = 1/2."""
    return np.asarray(polyval(x, series.DIMITRIADIS_BONDED))


def dimitriadis_not_bonded(x: FloatArray, nu: float) -> FloatArray:
    """Dimitriadis et al. 2002: not bonded, nu = 1/2."""
    return np.asarray(polyval(x, series.DIMITRIADIS_NOT_BONDED))


def dimitriadis_bonded_any_nu(x: FloatArray, nu: float) -> FloatArray:
    """Dimitriadis et al. 2002: bonded, any nu."""
    return np.asarray(polyval(x, series.dimitriadis(nu, bonded=True)))


def dimitriadis_not_bonded_any_nu(x: FloatArray, nu: float) -> FloatArray:
    """Dimitriadis et al. 2002: not bonded, any nu."""
    return np.asarray(polyval(x, series.dimitriadis(nu, bonded=False)))


def garcia(x: FloatArray, nu: float) -> FloatArray:
    """Garcia and Garcia 2018: bonded, nu = 1/2."""
    return np.asarray(polyval(x, series.GARCIA_PARABOLOID))


def long(x: FloatArray, nu: float) -> FloatArray:
    """Long, Hall, Wu and Hui 2011 with the constants of R/h from 2 to 12.7: bonded, nu = 1/2, small depths over R."""
    omega = x**3
    return (1 + 1.15 * x + 9.5 * omega + 4.212 * omega**2) / (1 + 2.3 * omega)


def hermanowicz_bonded(x: FloatArray, nu: float) -> FloatArray:
    """Hermanowicz 2021: bonded, nu = 1/2."""
    y = x**2
    small = 1 + 1.1053416390578608 * x + 1.606749412034415 * y + 1.6018294436819807 * y * x
    force = (
        0.6157882175705465
        - 3.1143156864367647 * x
        + 6.692972504122468 * y
        - 7.1702772387228935 * y * x
        + 8.227673152332168 * y**2
        + np.pi / 2 * y**3
    )
    return np.where(y < 0.4, small, force / (4 / 3 * x**3))


def hermanowicz_loose(x: FloatArray, nu: float) -> FloatArray:
    """Hermanowicz 2021: frictionless base, any nu."""
    y = x**2
    small = 1 + 0.7219609439372858 * x + 0.8221454802420807 * y
    force = -0.06327893614029767 + 0.2602586469814878 * x + np.pi * y**2
    return np.where(y < 0.5, small, force / (4 / 3 * x**3))


def clifford(x: FloatArray, nu: float) -> FloatArray:
    """Clifford and Seah 2009 on a rigid base, the limit of their formula, with E_L read as E*."""
    return 1 + 2.25 * (x / (1 - 1.92 * nu**2)) ** 1.5


def johnson_thin(x: FloatArray, nu: float) -> FloatArray:
    """A thin compressible bonded layer as a bed of springs: F = pi R delta^2/h E(1-nu)/((1+nu)(1-2nu))."""
    return 3 * np.pi / 4 * x * (1 - nu) ** 2 / (1 - 2 * nu)


def loose_thin(x: FloatArray, nu: float) -> FloatArray:
    """A thin layer on a frictionless base as a bed of springs: F = pi E* R delta^2/h."""
    return 3 * np.pi / 4 * x


def chadwick_thin(x: FloatArray, nu: float) -> FloatArray:
    """Chadwick 2002, Jaffar 1989: a thin incompressible bonded layer, F = (2 pi/3) E R^2 delta^3/h^3."""
    return 3 * np.pi / 8 * x**3
