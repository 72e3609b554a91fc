"""One formula for any layer up to a/h = 10: the stiffness of a flat punch, and the force on a paraboloid at a depth.

The sum of half-space and thin layer, times the exponential of a polynomial. `fit_compact` writes its coefficients and
the largest error of the fit to `compact.toml`.
"""

import tomllib
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.polynomial.chebyshev import chebvander, chebvander2d
from scipy.special import ive

from contact.records.validation import FloatArray

PLACE = Path(__file__).with_name("compact.toml")
# Thin layers, over the half-space: a bed of springs gives FIRST times the variable, and a squeezed film is reached
# where kappa^2 = SECOND variable^2 (1 - 2 nu)/(1 - nu)^2 vanishes: 3 pi/64 t^3 of a punch, 3 pi/8 x^3 of a paraboloid.
FIRST = {"punch": np.pi / 2, "paraboloid": 3 * np.pi / 4}
SECOND = {"punch": 0.75, "paraboloid": 4.0}


def punch_factor(t: FloatArray, nu: FloatArray, support: str) -> FloatArray:
    """Return k_N / (2 E* a).

    Args:
        t: a/h up to 10, shape (n,).
        nu: Poisson's ratio, shape (n,).
        support: "bonded" or "unbonded".
    """
    return _factor("punch", t, nu, support)


def paraboloid_factor(x: FloatArray, nu: FloatArray, support: str) -> FloatArray:
    """Return F / (4/3 E* sqrt(R) delta^(3/2)).

    Args:
        x: sqrt(R delta)/h where a/h is up to 10, shape (n,).
        nu: Poisson's ratio, shape (n,).
        support: "bonded" or "unbonded".
    """
    return _factor("paraboloid", x, nu, support)


def _factor(shape: str, x: FloatArray, nu: FloatArray, support: str) -> FloatArray:
    """`base` times the exponential of the fitted polynomial, shape (n,)."""
    fit = coefficients()[f"{shape}, {support}"]
    values = design(x, nu, support, fit) @ np.array(fit["coefficients"])
    return np.asarray(base(shape, x, nu, support) * np.exp(values))


@cache
def coefficients() -> dict[str, Any]:
    """Contents of `compact.toml`, by shape and support."""
    return tomllib.loads(PLACE.read_text(encoding="utf-8"))


def base(shape: str, x: FloatArray, nu: FloatArray, support: str) -> FloatArray:
    """Sum of the half-space, a first correction, and the thin layer."""
    springs = FIRST[shape] * x
    if support == "unbonded":
        return 1 + springs
    compressible = 1 - 2 * nu
    kappa = np.sqrt(SECOND[shape] * x**2 * compressible) / (1 - nu)
    # Below, the squeezed film alone: the ratio of Bessel functions is kappa^2/8 there.
    small = kappa < 1e-4
    safe = np.where(small, 1.0, kappa)
    bed = (1 - nu) ** 2 / np.where(small, 1.0, compressible) * (1 - 2 * ive(1, safe) / (safe * ive(0, safe)))
    return 1 + x + springs * np.where(small, SECOND[shape] * x**2 / 8, bed)


def design(x: FloatArray, nu: FloatArray, support: str, fit: dict[str, Any]) -> FloatArray:
    """Chebyshev polynomials of x/(x + scale), zero at x = 0, and of the logarithm of 1 - 2 nu + near; shape (n, m)."""
    u = x / (x + fit["scale"])
    along = 2 * u / fit["largest"] - 1
    if support == "unbonded":
        return np.asarray(chebvander(along, fit["degrees"][0]) * u[:, None])
    near = fit["near"]
    across = 2 * np.log((1 - 2 * nu + near) / near) / np.log((1 + near) / near) - 1
    return np.asarray(chebvander2d(along, across, fit["degrees"]) * u[:, None])
