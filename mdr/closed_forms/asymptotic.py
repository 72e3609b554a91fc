"""Thin layers, a >> h: closed forms of section 2.1 of Forsbach (2023). The half-space's stand in `half_space_profile`.

A layer that may flow sideways (unbonded) or be compressed (bonded, nu < 1/2) becomes a bed of independent springs under
the indenter itself. A bonded incompressible layer has to squeeze its material out and resists like a lubricating film.
The forms hold to first order: their relative errors fall like h/a.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from bem.kernels.moduli import contact_modulus
from bem.numerics import gauss
from contact import InvalidInput, Layer, Profile
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
