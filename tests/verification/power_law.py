"""Power-law form of the contact stiffness, Eqs. (33) and (34): k_bar = kappa (a/h)^m."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from bem.flat_punch import IntegralEquation
from contact import Layer, Paraboloid
from contact.records.validation import FloatArray
from tests.bed import bed_of


def stiffness_exponent(layer: Layer, ratio: ArrayLike, flat_punch: IntegralEquation) -> FloatArray:
    """m(a/h, nu) by Eq. (34), from the depth of a paraboloid with the same contact radius.

    Between 0 (half-space) and 1, or 3 for a bonded incompressible layer (thin).

    Args:
        layer: The layer; only its support and Poisson's ratio matter.
        ratio: a/h > 0.
        flat_punch: Where the flat punch comes from.
    """
    xi = np.asarray(ratio, dtype=float)
    unit = layer.replace(thickness=1.0)
    system = bed_of(unit, Paraboloid(radius_of_curvature=1.0), flat_punch)
    exponent: FloatArray = xi**2 / system.mdr_profile(xi) - 1  # Eq. (34)
    return exponent


def stiffness_prefactor(layer: Layer, ratio: ArrayLike, flat_punch: IntegralEquation) -> FloatArray:
    """kappa(a/h, nu) by Eq. (33). Arguments as in `stiffness_exponent`."""
    xi = np.asarray(ratio, dtype=float)
    stiffness = flat_punch.punch(layer).normalized_contact_stiffness(xi)
    prefactor: FloatArray = stiffness * xi ** -stiffness_exponent(layer, xi, flat_punch)
    return prefactor
