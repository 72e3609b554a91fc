"""Closed forms of the half-space, Eq. (15): an equivalent system that needs no flat-punch data."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contact import Cone, FlatPunch, Paraboloid, TruncatedCone


@dataclass(frozen=True)
class HalfSpaceSprings:
    """c_N = E*, and g of four profiles."""

    indenter: object
    contact_modulus: float = 1.0
    max_radius: float = np.inf

    def spring_stiffness(self, x):
        return np.full(np.shape(x), self.contact_modulus)

    def contact_stiffness(self, radius):
        return 2.0 * self.contact_modulus * np.asarray(radius)

    def mdr_profile(self, x):
        match self.indenter:
            case FlatPunch():
                return np.zeros(np.shape(x))
            case Paraboloid(radius_of_curvature=curvature):
                return x**2 / curvature
            case Cone(slope=slope):
                return 0.5 * np.pi * slope * x
            case TruncatedCone(flat_radius=b, slope=slope):
                return x * slope * np.arccos(np.minimum(b / x, 1.0))
        raise TypeError(self.indenter)
