"""Compliance of an elastic layer in wavenumber space, Eqs. (27)-(31) of Forsbach (2023).

A surface pressure ``p^(k)`` displaces the surface by ``u^(k) = 2 chi(kh) / (k E*) p^(k)``. With ``q = kh``,

    unbonded   chi = 2 sinh^2(q) / (2q + sinh 2q)                                        Eq. (29)
    bonded     chi = (2 kappa sinh 2q - 4q) / (1 + 4q^2 + kappa^2 + 2 kappa cosh 2q)     Eq. (31), kappa = 3 - 4 nu

As printed these overflow at q = 400 and cancel for small q. Here numerator and denominator are multiplied by
``D = exp(-2q)``, and every difference that is left is formed by ``expm1`` or by a series of positive terms. What
remains are sums of positive numbers, so the relative error stays at a few units of the last place for all q > 0.

All functions take real q >= 0, or complex q with Re q >= 0, in any floating precision, and answer in the same.
"""

from __future__ import annotations

from math import factorial
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contact.scene.layer import Support

# Up to this |q| the difference sinh 2q - 2q is summed as a series; beyond it 1 - D^2 - 4qD loses no digit.
SERIES_LIMIT: Final = 1.5
# Terms of that series: at the limit the next one, (2q)^(2k)/(2k + 3)!, is below 1e-20 of the sum.
SERIES_TERMS: Final = 17


def compliance_kernel(q: ArrayLike, support: Support, poissons_ratio: float) -> NDArray[Any]:
    """Ratio chi of the layer's compliance to the half-space's, Eqs. (29) and (31).

    Args:
        q: Wavenumber times layer thickness, any shape.
        support: "bonded", or "unbonded" (frictionless base).
        poissons_ratio: nu in [0, 0.5]; it does not influence the unbonded layer.

    Returns:
        chi in the shape of q: 0 at q = 0, tending to 1 for large q.
    """
    q = _floating(q)
    chi: NDArray[Any] = q * compliance_over_wavenumber(q, support, poissons_ratio)
    return chi


def compliance_over_wavenumber(q: ArrayLike, support: Support, poissons_ratio: float) -> NDArray[Any]:
    """chi(q)/q, finite at q = 0 (`zero_mode`). Arguments as in `compliance_kernel`."""
    q = _floating(q)
    D, S = np.exp(-2 * q), _decay_over_q(q)
    if support == "unbonded":
        # Numerator and denominator are divided by S, because its square underflows for huge q.
        chi_over_q: NDArray[Any] = S / (4 * D / S + 1 + D)
        return chi_over_q
    # In 2 kappa sinh 2q - 4q = 2 (kappa - 1) sinh 2q + 2 (sinh 2q - 2q) both terms are positive.
    numerator: NDArray[Any] = 2 * (1 - 2 * _same_precision(poissons_ratio, q)) * S * (1 + D) + shear_bracket_over_q(q)
    quotient: NDArray[Any] = numerator / _bonded_denominator(q, poissons_ratio)
    return quotient


def one_minus_kernel(q: ArrayLike, support: Support, poissons_ratio: float) -> NDArray[Any]:
    """1 - chi, also where it is exponentially small. Arguments as in `compliance_kernel`."""
    q = _floating(q)
    D = np.exp(-2 * q)
    if support == "unbonded":
        S = _decay_over_q(q)
        complement: NDArray[Any] = 2 * D * (2 + S) / (4 * D + S * (1 + D))
        return complement
    kappa = 3 - 4 * _same_precision(poissons_ratio, q)
    # The product D (1 + 2q)^2 is formed as one square, because q^2 alone could overflow.
    numerator: NDArray[Any] = D * kappa * (kappa + 2 * D) + ((1 + 2 * q) * np.exp(-q)) ** 2
    quotient: NDArray[Any] = numerator / _bonded_denominator(q, poissons_ratio)
    return quotient


def zero_mode(support: Support, poissons_ratio: float) -> float:
    """Limit of chi(q)/q at q = 0: the layer's answer to a uniform pressure, zero only if bonded and incompressible."""
    if support == "unbonded":
        return 0.5
    return (1 - 2 * poissons_ratio) / (2 * (1 - poissons_ratio) ** 2)


def _floating(q: ArrayLike) -> NDArray[Any]:
    values: NDArray[Any] = np.asarray(q)
    return values if values.dtype.kind in "fc" else values.astype(np.float64)


def _same_precision(value: float, q: NDArray[Any]) -> Any:
    return q.real.dtype.type(value)


def _decay_over_q(q: NDArray[Any]) -> NDArray[Any]:
    """(1 - exp(-2q))/q by expm1, 2 at q = 0."""
    values: NDArray[Any] = np.divide(-np.expm1(-2 * q), q, out=np.full_like(q, 2), where=q != 0)
    return values


def _bonded_denominator(q: NDArray[Any], poissons_ratio: float) -> NDArray[Any]:
    """D (1 + 4q^2 + kappa^2 + 2 kappa cosh 2q) with D = exp(-2q), term by term positive."""
    kappa = 3 - 4 * _same_precision(poissons_ratio, q)
    D = np.exp(-2 * q)
    denominator: NDArray[Any] = kappa * (1 + D**2) + (1 + kappa**2) * D + (2 * q * np.exp(-q)) ** 2
    return denominator


def shear_bracket_over_q(q: NDArray[Any]) -> NDArray[Any]:
    """2 D (sinh 2q - 2q)/q with D = exp(-2q): series where the difference cancels, direct elsewhere."""
    small = np.abs(q) < SERIES_LIMIT
    D = np.exp(-2 * q)
    t2 = np.where(small, 2 * q, 0) ** 2
    series = np.zeros_like(q)
    for k in reversed(range(SERIES_TERMS)):
        series = series * t2 + 1 / q.real.dtype.type(factorial(2 * k + 3))
    direct = (1 - D**2 - 4 * q * D) / np.where(small, 1, q)
    bracket: NDArray[Any] = np.where(small, 4 * t2 * D * series, direct)
    return bracket
