"""Thin layers, a >> h: closed forms of section 2.1 of Forsbach (2023), and a truncated cone on them, Eqs. (36)-(39).

A layer that may flow sideways (unbonded) or be compressed (bonded, nu < 1/2) becomes a bed of independent springs under
the indenter itself. A bonded incompressible layer has to squeeze its material out and resists like a lubricating film.
The forms hold to first order: their relative errors fall like h/a.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from bem.kernels.moduli import contact_modulus
from bem.numerics import gauss
from contact import InvalidInput, Layer, Profile, TruncatedCone
from contact.records.validation import FloatArray

# Gauss nodes of a profile's mean height. Half as many leave 1e-6 of steep tips.
NODES = 32


def is_film(layer: Layer) -> bool:
    """Whether the thin layer resists like a film: bonded and incompressible.

    Raises:
        InvalidInput: For a half-space, which has no thin limit.
    """
    if layer.is_half_space:
        raise InvalidInput("thickness = inf: a half-space has no thin-layer limit; give the layer's thickness")
    return layer.support == "bonded" and layer.poissons_ratio == 0.5


def foundation_modulus(layer: Layer) -> float:
    """E~ [Pa] of the bed p = E~ w/h: confined modulus if bonded, Eq. (17), E* if unbonded, Eq. (22)."""
    return contact_modulus(layer) if layer.support == "unbonded" else layer.confined_modulus


def thin_profile(layer: Layer, indenter: Profile, x: ArrayLike) -> FloatArray:
    """g [m]: the profile itself, Eqs. (17) and (22), or its mean over the contact area, Eq. (20)."""
    x = np.asarray(x, dtype=float)
    return _mean_height(indenter, x) if is_film(layer) else indenter.height(x)


def _mean_height(indenter: Profile, x: FloatArray) -> FloatArray:
    """(2/x^2) int_0^x f(r) r dr by Gauss quadrature between breakpoints."""
    nodes, weights = gauss(NODES)
    flat = indenter.flat_radius
    ends = [flat, *(k for k in indenter.breakpoints if flat < k < np.max(x, initial=0.0)), np.inf]
    total = np.zeros_like(x)
    for k, start in enumerate(ends[:-1]):
        low, high = np.minimum(start, x), np.minimum(ends[k + 1], x)
        r = low[..., None] + (high - low)[..., None] * nodes
        total += (high - low) * ((indenter.height(r) * r) @ weights)
    return 2 * total / x**2


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
