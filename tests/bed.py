"""The equivalent bed of springs as functions of the radius, for tests that sum springs themselves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from bem.flat_punch import IntegralEquation
from contact import ElasticLayer, Profile
from contact.records.validation import FloatArray
from mdr.spring_bed import Springs, SpringValues


@dataclass(frozen=True)
class Bed:
    """Springs and profile as functions of radii [m] of any shape."""

    springs: Springs

    def _at(self, radius: ArrayLike) -> tuple[SpringValues, tuple[int, ...]]:
        return self.springs.at(np.ravel(radius)), np.shape(radius)

    def mdr_profile(self, radius: ArrayLike) -> FloatArray:
        """g [m]."""
        values, shape = self._at(radius)
        return values.g.reshape(shape)

    def spring_stiffness(self, radius: ArrayLike) -> FloatArray:
        """c_N [Pa]."""
        values, shape = self._at(radius)
        return np.asarray(self.springs.modulus * values.y1**2).reshape(shape)

    def contact_stiffness(self, radius: ArrayLike) -> FloatArray:
        """k_N [N/m]."""
        values, shape = self._at(radius)
        return np.asarray(2 * self.springs.modulus * values.K).reshape(shape)

    def elastic_force(self, radius: ArrayLike) -> FloatArray:
        """F_N [N] without adhesion."""
        values, shape = self._at(radius)
        return self.springs.state(np.ravel(radius), values).force.reshape(shape)

    def force(self, radius: ArrayLike, depth: ArrayLike) -> FloatArray:
        """F_N [N] at a radius and a depth [m]."""
        values, shape = self._at(radius)
        return self.springs.state(np.ravel(radius), values, np.ravel(depth)).force.reshape(shape)


def bed_of(layer: ElasticLayer, indenter: Profile, source: IntegralEquation | None = None) -> Bed:
    """Springs of a layer under an indenter."""
    return Bed(Springs.of(layer, indenter, (source or IntegralEquation()).sizes))
