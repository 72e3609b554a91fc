"""What growing contact under full stick asks of adhered punches: their stiffness and the surface beside them.

Beside the adhered unit punch of radius a, the transform of the surface displacement leaves of the depth

    M(x; a) = Re[((x+a)/(x-a))^(i eps) G(x; a)],   x > a,

with G smooth on the whole square 0 <= a, x <= X: it is tabulated as Chebyshev polynomials in both. Contact that grows
through radii a by depths delta'(a) da follows the indenter if ``g_hs(x) = int_0^x M(x; a) delta'(a) da``.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from bem.kernels.stack import StackKernel as StickingKernel
from bem.layer_equation.stick.adhered_fields import AdheredFields
from bem.layer_equation.stick.adhered_punch import Material, adhered_punch
from contact.records.validation import FloatArray

# Up to this x/a the polynomial g is continued; beyond, its terms magnify rounding and the equation itself is used.
_CONTINUED = 1.005
# Punches of a table, and positions beside each, for X = 0 and per unit of X: the last three of G's
# coefficients are then 5e-15, 1e-12 and 1e-11 of the largest at X = 3, 11 and 18 (nu = 0, 0.3, 1/2, 2026-11-22).
_PUNCHES = (26.0, 4.5)
_POSITIONS = (28.0, 5.5)
# At least so many of both for the root of X times the kernel's longest length, where a film on a soft base has that:
# its punches soften over a = 1/length. With 35 at X = 1.9, 102 thicknesses, coefficients fell to 6e-5, with 45 at
# X = 4.3, 10 thicknesses, to 2e-9; 1e-12 takes so many (2026-11-22).
_PER_ROOT_OF_LENGTH = 9.0


@dataclass(frozen=True)
class GrowthTable:
    """Adhered punches on one layer; lengths in its thickness.

    Attributes:
        material: What the layer is made of.
        kernel: Of the layer.
        max_ratio: X, largest a/h and x/h.
        coefficients: Of G in x (rows) and a (columns), Chebyshev polynomials on [0, X].
        stiffness: Chebyshev coefficients of k_stick/(2 E* a) on [0, X].
    """

    material: Material
    kernel: StickingKernel
    max_ratio: float
    coefficients: NDArray[np.complex128]
    stiffness: FloatArray

    @property
    def is_half_space(self) -> bool:
        """Whether no layer shows."""
        return self.kernel.is_half_space

    def beside(self, x: float, a: FloatArray) -> NDArray[np.complex128]:
        """G(x; a) for one x and many a, shape of a."""
        row = chebyshev.chebval(self._unit(x), self.coefficients)
        return np.asarray(chebyshev.chebval(self._unit(a), row))

    def below(self, t: FloatArray, a: FloatArray) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
        """G(t; a) and dG/dt under the punch, a of shape (n,) and t of shape (n, m)."""
        columns = chebyshev.chebval(self._unit(a), self.coefficients.T)
        slopes = chebyshev.chebder(columns) * (2.0 / self.max_ratio) if len(columns) > 1 else np.zeros_like(columns)
        at = self._unit(t)
        value: NDArray[np.complex128] = np.asarray(
            chebyshev.chebval(at, columns[..., None], tensor=False), dtype=complex
        )
        slope: NDArray[np.complex128] = np.asarray(
            chebyshev.chebval(at, slopes[..., None], tensor=False), dtype=complex
        )
        return value, slope

    def contact_stiffness(self, a: FloatArray) -> FloatArray:
        """k_stick/(E* h) = 2 (a/h) k_bar."""
        return np.asarray(2.0 * a * chebyshev.chebval(self._unit(a), self.stiffness))

    def _unit(self, a: FloatArray | float) -> FloatArray:
        return np.asarray(2.0 * np.asarray(a) / self.max_ratio - 1.0)

    def shortened(self) -> GrowthTable:
        """The table without its last coefficients: what they move is at least what it leaves out."""
        if self.is_half_space:
            return self
        return replace(self, coefficients=self.coefficients[:-3, :-3], stiffness=self.stiffness[:-3])


@lru_cache(maxsize=16)
def growth_table(max_ratio: float, kernel: StickingKernel) -> GrowthTable:
    """Solve the punches of a table that reaches `max_ratio` thicknesses of the surface material."""
    if kernel.is_half_space:
        punch = adhered_punch(0.0, kernel)
        return GrowthTable(
            punch.material, kernel, max_ratio, np.ones((1, 1), dtype=complex), np.array([punch.stiffness])
        )
    least = _PER_ROOT_OF_LENGTH * math.sqrt(max_ratio * kernel.longest)
    punches, positions = (math.ceil(max(start + rate * max_ratio, least)) for start, rate in (_PUNCHES, _POSITIONS))
    to_a, to_x = _to_coefficients(punches), _to_coefficients(positions)
    x = max_ratio * (1.0 + chebyshev.chebpts1(positions)) / 2.0
    values, stiffness = np.empty((positions, punches), dtype=complex), np.empty(punches)
    for j, a in enumerate(max_ratio * (1.0 + chebyshev.chebpts1(punches)) / 2.0):
        fields = AdheredFields(adhered_punch(float(a), kernel))
        stiffness[j] = fields.punch.stiffness
        inside = x <= _CONTINUED * a
        values[inside, j] = fields.continued(x[inside] / a)
        values[~inside, j] = fields.transform_beside(x[~inside] / a)
    return GrowthTable(
        Material.of(kernel.poissons_ratio), kernel, max_ratio, np.asarray(to_x @ values @ to_a.T), to_a @ stiffness
    )


def _to_coefficients(count: int) -> FloatArray:
    return np.asarray(np.linalg.inv(chebyshev.chebvander(chebyshev.chebpts1(count), count - 1)))
