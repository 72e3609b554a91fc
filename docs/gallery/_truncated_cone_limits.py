"""The two limits in Fig. 7: the half-space (a/h -> 0) and the thin layer (a/h -> inf), as curves without a method."""

from collections.abc import Iterator

import numpy as np
from numpy.polynomial.legendre import leggauss

from cases.library._common import layer
from contact import TruncatedCone
from contact.records.validation import FloatArray
from docs.gallery._parts import Series, series
from docs.gallery._thin_layers import thin_cone_force, thin_cone_pressure, thin_cone_profile

HALF_SPACE, THIN_LAYER = "half-space", "thin layer"
NODES, WEIGHTS = leggauss(60)


def profile_limits(label: str, cone: TruncatedCone, a: float, x: FloatArray) -> Iterator[Series]:
    """g(x)/f(a) over x/a: x tan(theta) arccos(b/x) on the half-space, f or Eq. (37) on the thin layer."""
    height = float(cone.height(a))
    on_half_space = cone.slope * x * np.arccos(np.minimum(cone.flat_radius / x, 1.0))
    yield series(HALF_SPACE, HALF_SPACE, "", x / a, on_half_space / height)
    yield series(THIN_LAYER, THIN_LAYER, "", x / a, thin_cone_profile(layer(label), cone, x) / height)


def pressure_limits(label: str, cone: TruncatedCone, a: float, r: FloatArray) -> Iterator[Series]:
    """p(r)/p_mean over r/a; both limits are free of the modulus, and of the thickness."""
    yield series(HALF_SPACE, HALF_SPACE, "", r / a, _half_space_pressure(cone, a, r))
    mean = thin_cone_force(layer(label), cone, a) / (np.pi * a**2)
    yield series(THIN_LAYER, THIN_LAYER, "", r / a, thin_cone_pressure(layer(label), cone, a, r) / mean)


def _half_space_pressure(cone: TruncatedCone, a: float, r: FloatArray) -> FloatArray:
    """p/p_mean, r != b: p = (E* tan / pi) int_max(r,b)^a [arccos(b/x) + b/sqrt(x^2 - b^2)]/sqrt(x^2 - r^2) dx.

    x = max(r, b) + s^2 takes the root out of either denominator.
    """
    b, ratio = cone.flat_radius, cone.flat_radius / a
    start = np.maximum(r, b)[:, None]
    end = np.sqrt(a - start)
    s = end * (1 + NODES) / 2
    x = start + s**2
    integrand = (np.arccos(b / x) + b / np.sqrt(x**2 - b**2)) / np.sqrt(x**2 - r[:, None] ** 2) * 2 * s
    pressure = cone.slope / np.pi * np.sum(integrand * WEIGHTS * end / 2, axis=1)  # over E*
    # F/(pi a^2) over E*.
    mean = cone.slope / np.pi * (np.arccos(ratio) + ratio * np.sqrt(1 - ratio**2))
    return np.asarray(pressure / mean)
