"""Springs from tables of flat-punch data, as `mdr.spring_bed` has them from the layer's equation."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from bem.layer_equation.flat_punch_source import IntegralEquation
from bem.layer_equation.protocol import FlatPunchSource
from contact import ElasticLayer, Layer
from contact.records.validation import FloatArray
from mdr.spring_bed import Springs, SpringValues
from mdr.springs.assembly import equivalent_system
from mdr.springs.equivalent_system import EquivalentSystem

# Relative errors of springs in those of a motion: those of g, c_N and k_N add up.
_SPRINGS_TO_MOTION = 3.0


# Fields after those with defaults need one.
_NONE = Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.5)


@dataclass(frozen=True, eq=False)
class TableSprings(Springs):
    """Springs of one layer from a table, 2 E* = 1.

    Attributes:
        layer: The layer.
        source: Where the data come from.
    """

    layer: ElasticLayer = _NONE
    source: FlatPunchSource = field(default_factory=IntegralEquation)

    @cached_property
    def coarse(self) -> Springs:
        """A table has one resolution."""
        return self

    def _system(self, radius: float) -> EquivalentSystem:
        """The equivalent system up to the next radius of a ladder."""
        flat = self.tip.flat
        grown = 2.0 ** math.ceil(math.log2(max(radius - flat, 1e-9 * self.unit)))
        top = max(radius, min(flat + grown, self.tip.end * (1 - 1e-6)))
        return equivalent_system(self.layer, self.tip.profile, top, self.source, may_fall=True)

    def at(self, radii: ArrayLike, excess: FloatArray | None = None) -> SpringValues:
        """y_1, g, K, M at radii > 0."""
        x = np.atleast_1d(np.asarray(radii, dtype=np.float64))
        system, unit = self._system(float(x.max())), 2 * self.layer.contact_modulus
        K = system.contact_stiffness(x) / unit
        beyond = x - self.tip.flat if excess is None else excess
        g = system.profile_beyond(beyond) if self.tip.flat < x.max() else np.zeros_like(x)
        return SpringValues(np.sqrt(2 * system.spring_stiffness(x) / unit), g, K, g * K - system.force(x, g) / unit)

    def floor(self, radii: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Relative errors of depth, and of force and stiffness."""
        error = _SPRINGS_TO_MOTION * self._system(float(radii.max())).relative_error["normal_force"]
        return np.full(radii.shape, error), np.zeros(radii.shape)
