"""Flat punches on layers: what multiplies the stiffness 2 E* a of the half-space, over t = a/h.

Every function takes t, shape (n,), and Poisson's ratio, and returns k_N / (2 E* a).
"""

import numpy as np
from numpy.polynomial.polynomial import polyval
from scipy.interpolate import CubicSpline

from cases.library._common import HAYES
from contact.records.validation import FloatArray
from mdr.curves import formulas

# Hayes, Keer, Herrmann and Mockros, J. Biomech. 5 (1972) 541, nu = 1/2, as an R package that cites the table has it; a
# Python program has the same numbers up to a/h = 2 (seen 2026-11-22). The paper itself was not at hand.
HAYES_AT, HAYES = (
    np.append(at_axis, values)
    for at_axis, values in zip((0.0, 1.0), zip(*HAYES["bonded nu=0.5"].items(), strict=True), strict=True)
)
# A column that stood in public scripts under the heading nu = 0.5, at a/h = 0.2, 0.4, .. 2.0; written down from an
# earlier reading and not found again on 2026-11-22. That it belongs to nu = 0.48 is our finding.
MISLABELLED_AT = 0.2 * np.arange(11)
MISLABELLED = np.array([1, 1.268, 1.645, 2.129, 2.704, 3.359, 4.085, 4.878, 5.737, 6.659, 7.644])


def boussinesq(t: FloatArray, nu: float) -> FloatArray:
    """One: the layer is taken for a half-space."""
    return np.ones_like(t)


def hayes(t: FloatArray, nu: float) -> FloatArray:
    """Hayes et al. 1972, table for nu = 1/2 with a cubic spline: bonded."""
    return np.where(t <= HAYES_AT[-1], CubicSpline(HAYES_AT, HAYES)(t), np.nan)


def hayes_mislabelled(t: FloatArray, nu: float) -> FloatArray:
    """The column in circulation as nu = 0.5, with a cubic spline: bonded."""
    return np.where(t <= MISLABELLED_AT[-1], CubicSpline(MISLABELLED_AT, MISLABELLED)(t), np.nan)


def garcia(t: FloatArray, nu: float) -> FloatArray:
    """Garcia and Garcia 2018: bonded, nu = 1/2."""
    return np.asarray(polyval(t, formulas.GARCIA_PUNCH))


def lin_hui_conway(t: FloatArray, nu: float) -> FloatArray:
    """Lin, Hui and Conway 2000, Shull 2002, from memory of papers that cite them: bonded, nu = 1/2."""
    return 1 + 1.33 * t + 1.33 * t**3


def hermanowicz_bonded(t: FloatArray, nu: float) -> FloatArray:
    """Hermanowicz 2021: bonded, nu = 1/2."""
    small = _polynomial(
        t, 1.127294838473304, 1.2534743855684407, 0.7845575578931572, -0.8066500581952372, 0.25992549153472266
    )
    large = -0.32200988000179354 + _polynomial(t, 1.9372155069019295, 0.8542206369854419, 0.1474038965378127)
    return 1 + np.where(t <= 1.2, small, large)


def hermanowicz_compressible(t: FloatArray, nu: float) -> FloatArray:
    """Hermanowicz 2021: bonded, nu = 0."""
    small = _polynomial(
        t, 0.770308111530346, 0.6165420289577782, -0.0384621101679078, -0.19394949807916162, 0.07260749644777371
    )
    large = -0.33294442393732854 + _polynomial(
        t, 1.5342411518628014, 0.005042851886799859, -0.000260182832698187, 4.362991470005079e-6
    )
    return 1 + np.where(t > 1.5, large, small)


def hermanowicz_loose(t: FloatArray, nu: float) -> FloatArray:
    """Hermanowicz 2021: frictionless base, any nu."""
    small = _polynomial(
        t, 0.7426462444663599, 0.5708600467411756, 0.008619952995014581, -0.1799716509234812, 0.0574929480459991
    )
    large = -0.3838553953270864 + _polynomial(t, 1.553893809221951, 0.00138818040746098, -3.107802923772486e-5)
    return 1 + np.where(t <= 1.65, small, large)


def thin_compressible(t: FloatArray, nu: float) -> FloatArray:
    """A thin compressible bonded layer as a bed of springs: k_N = pi a^2/h E(1-nu)/((1+nu)(1-2nu)), Barber 1990."""
    return np.pi / 4 * t * (1 - nu) ** 2 / (1 - 2 * nu) * 2


def thin_incompressible(t: FloatArray, nu: float) -> FloatArray:
    """A thin incompressible bonded layer: k_N = 3 pi G a^4/(8 h^3), squeezed like a viscous film."""
    return 3 * np.pi / 64 * t**3


def _polynomial(t: FloatArray, *coefficients: float) -> FloatArray:
    """c1 t + c2 t^2 + .."""
    return sum((c * t**power for power, c in enumerate(coefficients, 1)), np.zeros_like(t))
