"""The kernel N(s) of a graded layer on real wavenumbers, with its logarithm split off.

For large k ``1 - chi = -c1/k + ...``, so N is like c1 ln s. With a length B of choice

    N(s) = c1 ln s - (c1/2) ln(s^2 + B^2) + N2(s),    N2(s) = int_0^inf [1 - chi + c1 (1 - exp(-Bk))/k] cos(ks) dk,

and N2 has a kink only. It is integrated by Filon's rule: Legendre polynomials on octaves of k, whose products with
cosines have closed forms. `point_kernel` turns the path of integration into the complex plane instead.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Final

import numpy as np
from scipy.special import spherical_jn

from bem.kernels.graded import GradedKernel
from bem.polynomials.chebyshev import piecewise_sum
from bem.polynomials.gauss_panels import chebyshev_from_nodes, gauss_nodes
from contact.records.validation import FloatArray

# Octaves of wavenumbers: the first ends at this power of two over the longest length, the last at the other power. What
# is left out beyond it is c2/k^2, below 1e-12.
FIRST_OCTAVE: Final = -6
LAST_OCTAVE: Final = 40
# Legendre polynomials on each of them: chi is analytic in ln k, and the remainder falls like 1/k^2.
ORDERS: Final = 20
# Octaves of distances on which N2 is tabulated: below 2^-SHORTEST it is constant to 1e-12.
SHORTEST: Final = 40
FARTHEST: Final = 9


@dataclass(frozen=True, eq=False)
class SplitKernel:
    """N(s) in two parts.

    Attributes:
        surface: 1 - chi.
        length: B, in thicknesses; N does not depend on it.
    """

    surface: GradedKernel
    length: float

    @property
    def slope(self) -> float:
        """c1, the factor of ln s."""
        return self.surface.edge_slope

    def regular(self, distance: FloatArray) -> FloatArray:
        """N - c1 ln s at distances s >= 0, any shape."""
        s = np.maximum(distance, 2.0**-SHORTEST)
        mantissa, exponent = np.frexp(s)
        rest = piecewise_sum(self._coefficients, exponent.astype(np.intp) + SHORTEST - 1, 4 * mantissa - 3)
        return np.asarray(rest - self.slope / 2 * np.log(s**2 + self.length**2))

    def __call__(self, distance: FloatArray) -> FloatArray:
        """N at distances s > 0."""
        return np.asarray(self.slope * np.log(distance) + self.regular(distance))

    @cached_property
    def _coefficients(self) -> FloatArray:
        starts = 2.0 ** np.arange(-SHORTEST, FARTHEST)
        s = starts[:, None] * (1 + gauss_nodes(ORDERS)[0])
        return np.asarray(self._remainder(s.ravel()).reshape(s.shape) @ chebyshev_from_nodes(ORDERS).T)

    def _remainder(self, distance: FloatArray) -> FloatArray:
        """N2 by Filon's rule: int P_n(u) cos((m + w u) s) du = 2 Re[i^n exp(i m s)] j_n(w s)."""
        first = int(np.floor(-np.log2(self.surface.longest))) + FIRST_OCTAVE
        ends = np.append(0.0, 2.0 ** np.arange(first, LAST_OCTAVE + 1))
        middle, half = (ends[1:] + ends[:-1]) / 2, np.diff(ends) / 2
        tau, omega = gauss_nodes(ORDERS)
        k = middle[:, None] + half[:, None] * (2 * tau - 1)
        values = self.surface.one_minus_chi(k) - self.slope * np.expm1(-self.length * k) / k
        orders = np.arange(ORDERS)
        legendre = np.polynomial.legendre.legvander(2 * tau - 1, ORDERS - 1)
        coefficients = (values * 2 * omega) @ legendre * (orders + 0.5)
        total = np.zeros_like(distance)
        turn = 1j**orders
        for m, w, row in zip(middle, half, coefficients, strict=True):
            waves = spherical_jn(orders, w * distance[:, None])
            total += 2 * w * (np.exp(1j * m * distance)[:, None] * (waves * row * turn)).real.sum(axis=1)
        return total


@lru_cache(maxsize=8)
def split_kernel(surface: GradedKernel, length: float) -> SplitKernel:
    """The same, remembered: its table takes a second."""
    return SplitKernel(surface, length)
