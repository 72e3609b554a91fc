"""Restitution of a flat punch on a Kelvin-Voigt layer in closed form, Eqs. (48)-(50)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from contact import InvalidInput
from contact.records.validation import FloatArray

# |1 - D| below which the series is used: its seven terms are exact to rounding there.
_NEAR_ONE = 1e-3
_SERIES = tuple((-1.0) ** n / (2 * n + 1) for n in range(7))


def damping_ratio(
    viscosity: ArrayLike, shear_modulus: ArrayLike, mass: ArrayLike, contact_stiffness: ArrayLike
) -> FloatArray:
    """D of Eq. (50), from eta [Pa s], G [Pa], M [kg] and the punch's elastic stiffness k_N = 8 G a k_bar [N/m]."""
    eta, modulus, m, k = (np.asarray(q, dtype=np.float64) for q in (viscosity, shear_modulus, mass, contact_stiffness))
    return np.asarray(0.5 * eta / modulus * np.sqrt(k / m))


def kelvin_voigt_restitution(damping: ArrayLike) -> FloatArray:
    """Coefficient of restitution for any D >= 0, Eq. (49) and its continuation beyond D = 1.

    With e = 1 - D^2 the exponent is -2 arctan(sqrt(e)/D)/(sqrt(e)/D), an analytic function of e/D^2: arctan for e > 0,
    artanh for e < 0, and a power series between them, where both divide zero by zero.

    Raises:
        InvalidInput: If D is negative or not finite.
    """
    ratio = np.asarray(damping, dtype=np.float64)
    if not np.all(np.isfinite(ratio) & (ratio >= 0.0)):
        raise InvalidInput(f"damping = {ratio.min():g}: the damping ratio must be finite and not negative")
    near = np.abs(1.0 - ratio) < _NEAR_ONE
    # The two roots are taken apart since D^2 could overflow; at D = 1 the series below is taken.
    root = np.sqrt(np.abs(1.0 - ratio)) * np.sqrt(1.0 + ratio)
    with np.errstate(divide="ignore", invalid="ignore"):
        under = ratio / root * np.arctan2(root, ratio)
        # artanh(s/D) = ln(D + s) loses no digits for large D.
        over = ratio / root * np.log(ratio + root)
    close = np.where(near, ratio, 1.0)
    tangent = (1.0 - close) * (1.0 + close) / close**2
    series = sum(coefficient * tangent**n for n, coefficient in enumerate(_SERIES))
    exponent = np.where(near, series, np.where(ratio < 1.0, under, over))
    return np.asarray(np.exp(-2.0 * exponent))
