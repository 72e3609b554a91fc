"""Truncated cone on a thin layer, Eqs. (36)-(39) of Forsbach (2023): a contact radius, b = `flat_radius`, a >= b."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from contact import Layer, TruncatedCone
from contact.records.validation import FloatArray
from mdr.closed_forms.asymptotic import foundation_modulus, is_film


def thin_cone_profile(layer: Layer, cone: TruncatedCone, x: ArrayLike) -> FloatArray:
    """g(x) [m] = delta of a contact with radius x: f itself, or Eq. (37) for the bonded incompressible layer."""
    if not is_film(layer):
        return cone.height(x)
    x, b = np.asarray(x, dtype=float), cone.flat_radius
    # Eq. (37) holds for x >= b.
    g = (2 * x + b) / 3 * ((x - b) / x) ** 2 * cone.slope
    return np.where(x < b, 0.0, g)


def thin_cone_force(layer: Layer, cone: TruncatedCone, contact_radius: ArrayLike) -> FloatArray:
    """F_N [N], Eq. (36), or Eq. (38) for the bonded incompressible layer."""
    a, h = np.asarray(contact_radius, dtype=float), layer.thickness
    beta = cone.flat_radius / a
    if not is_film(layer):
        return foundation_modulus(layer) * np.pi * a**3 / (3 * h) * cone.slope * (1 - beta**3)  # Eq. (36)
    bracket = 2 - 5 * beta**3 + 3 * beta**5
    return layer.youngs_modulus * np.pi * a**2 / 120 * (a / h) ** 3 * cone.slope * bracket  # Eq. (38)


def thin_cone_pressure(layer: Layer, cone: TruncatedCone, contact_radius: float, radius: ArrayLike) -> FloatArray:
    """p(r) [Pa] for r <= a: E~ (f(a) - f(r))/h, or Eq. (39) for the bonded incompressible layer."""
    r, a, h = np.asarray(radius, dtype=float), contact_radius, layer.thickness
    if not is_film(layer):
        return foundation_modulus(layer) * (cone.height(a) - cone.height(r)) / h  # Eqs. (17), (22)
    rho, beta = r / a, cone.flat_radius / a
    within = 2 - beta**3 * (2 - 6 * np.log(beta)) - 3 * (2 - 3 * beta + beta**3) * rho**2
    # Inside b the second line is not asked for.
    safe = np.maximum(rho, beta)
    beyond = 2 + beta**3 * (6 * np.log(safe) + 3) - 3 * (2 + beta**3) * rho**2 + 4 * rho**3
    bracket = np.where(r < cone.flat_radius, within, beyond)
    return layer.youngs_modulus * cone.slope / 36 * (a / h) ** 3 * bracket  # Eq. (39)
