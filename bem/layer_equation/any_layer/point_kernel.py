"""The difference kernel N(s) of a graded layer: like ln s for small s, by polynomials on octaves of the distance."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from bem.kernels.protocol import SurfaceKernel
from bem.layer_equation.fredholm_kernel import FredholmKernel
from bem.polynomials.chebyshev import piecewise_sum
from bem.polynomials.gauss_panels import chebyshev_from_nodes, gauss_nodes
from contact.records.validation import FloatArray

# Wavenumbers end at 2 to this power, and octaves start at 2^-SHORTEST thicknesses: below N continues like the logarithm
# that it is there. As a constant it moved edge values by 2e-11 (E = 1 + 10 z, 2026-11-23).
COARSEST: Final = 44
SHORTEST: Final = 40
# Largest distance, a power of two as well.
FARTHEST: Final = 13
# Nodes on each octave: the logarithm's singularity at the octave's own length leaves 5.8^-22. Of an incompressible
# layer's images, poles two thicknesses from the axis, 18 nodes left 1.7e-12 at s = 4 and 22 leave 2e-15 (2026-11-23).
OCTAVE_NODES: Final = 22
TINY: Final = float(np.finfo(float).tiny)


@dataclass(frozen=True, eq=False)
class PointKernel:
    """N(s) for distances up to 2^FARTHEST thicknesses.

    Attributes:
        exponentials: N as a sum of exponentials.
    """

    exponentials: FredholmKernel

    @classmethod
    def of_surface(cls, kernel: SurfaceKernel) -> PointKernel:
        """Of any layer."""
        return cls(FredholmKernel.of_surface(kernel, COARSEST))

    def __call__(self, distance: FloatArray) -> FloatArray:
        """N at distances s > 0, any shape."""
        first = 2.0**-SHORTEST
        s = np.maximum(distance, first)
        mantissa, exponent = np.frexp(s)
        # The mantissa lies in [1/2, 1).
        values = piecewise_sum(self._coefficients, exponent.astype(np.intp) + SHORTEST - 1, 4 * mantissa - 3)
        close = distance < first
        if np.any(close):
            values = np.asarray(values)
            values[close] += self._slope * np.log(np.maximum(distance[close], TINY) / first)
        return values

    def integral(self, length: FloatArray) -> FloatArray:
        """int_0^length N ds."""
        z, w = self.exponentials.rates, self.exponentials.weights
        return np.asarray((-np.expm1(-np.multiply.outer(length, z)) @ (w / z)).real)

    @cached_property
    def _slope(self) -> float:
        """dN/d(ln s) at the smallest distances, from an octave that the last wavenumbers do not reach."""
        near, far = self.exponentials(2.0 ** (2.0 - SHORTEST) * np.array([1.0, 2.0]))
        return float((far - near) / np.log(2.0))

    @cached_property
    def _coefficients(self) -> FloatArray:
        starts = 2.0 ** np.arange(-SHORTEST, FARTHEST)
        s = starts[:, None] * (1 + gauss_nodes(OCTAVE_NODES)[0])
        return np.asarray(self.exponentials(s) @ chebyshev_from_nodes(OCTAVE_NODES).T)
