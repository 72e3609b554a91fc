"""Paraboloids on layers: what multiplies Hertz's force at the same depth, over X = sqrt(R delta)/h.

Every function takes X, shape (n,), and Poisson's ratio, and returns F / (4/3 E* sqrt(R) delta^(3/2)).
"""

import numpy as np
from numpy.polynomial.polynomial import polyval

from contact.records.validation import FloatArray
from mdr.curves import formulas

# Hayes et al. 1972, spheres: quadratics in t = a/h that were fitted to their tables, as two Python programs have them
# (one by a maker of instruments; seen 2026-11-22). a^2/(R delta) = A1 t^2 + B1 t + C1, F = 4 G delta a kappa/(1 - nu)
# with kappa = A2 t^2 + B2 t + C2. On a half-space C1 is 1 and C2 is 2/3.
HAYES_SPHERE = {
    0.3: ((-0.1263, 0.6325, 1.015), (0.0841, 0.5911, 0.6293)),
    0.35: ((-0.1342, 0.668, 1.0154), (0.1046, 0.6235, 0.6259)),
    0.4: ((-0.1439, 0.7203, 1.0144), (0.1471, 0.6547, 0.6233)),
    0.45: ((-0.1537, 0.7974, 1.0113), (0.2483, 0.6539, 0.6258)),
    0.5: ((-0.1462, 0.9008, 1.0067), (0.5737, 0.4156, 0.6875)),
}


def hertz(x: FloatArray, nu: float) -> FloatArray:
    """One: the layer is taken for a half-space."""
    return np.ones_like(x)


def dimitriadis_bonded(x: FloatArray, nu: float) -> FloatArray:
    """Dimitriadis et al. 2002: bonded, nu = 1/2."""
    return np.asarray(polyval(x, formulas.DIMITRIADIS_BONDED))


def dimitriadis_not_bonded(x: FloatArray, nu: float) -> FloatArray:
    """Dimitriadis et al. 2002: not bonded, nu = 1/2."""
    return np.asarray(polyval(x, formulas.DIMITRIADIS_NOT_BONDED))


def dimitriadis_bonded_any_nu(x: FloatArray, nu: float) -> FloatArray:
    """Dimitriadis et al. 2002: bonded, any nu."""
    return np.asarray(polyval(x, formulas.dimitriadis(nu, bonded=True)))


def dimitriadis_not_bonded_any_nu(x: FloatArray, nu: float) -> FloatArray:
    """Dimitriadis et al. 2002: not bonded, any nu."""
    return np.asarray(polyval(x, formulas.dimitriadis(nu, bonded=False)))


def hayes_quadratics(x: FloatArray, nu: float) -> FloatArray:
    """Hayes et al. 1972 by quadratics: bonded; any other nu than the five of the table gets those of nu = 1/2."""
    (a1, b1, c1), kappa = HAYES_SPHERE.get(nu, HAYES_SPHERE[0.5])
    # t^2/x^2 = A1 t^2 + B1 t + C1, and A1 is negative: one root is positive.
    square = 1 / x**2 - a1
    t = (b1 + np.sqrt(b1**2 + 4 * square * c1)) / (2 * square)
    return np.asarray(1.5 * polyval(t, kappa[::-1]) * t / x)


def garcia(x: FloatArray, nu: float) -> FloatArray:
    """Garcia and Garcia 2018: bonded, nu = 1/2."""
    return np.asarray(polyval(x, formulas.GARCIA_PARABOLOID))


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
