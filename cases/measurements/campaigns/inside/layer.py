"""What a layer on a rigid base adds to the half-space under unit pressure waves, in extended precision.

Fields are combined of four solutions, two that decay from the surface and two that decay from the base; their
coefficients solve the conditions at both faces, by elimination. Lengths are in thicknesses.
"""

import numpy as np
from numpy.typing import NDArray

from contact import Layer
from contact.records.validation import FloatArray


class LayerWaves:
    """Difference of a layer's fields from the half-space's at wavenumbers k > 0, shape (n,)."""

    def __init__(self, layer: Layer, wavenumbers: FloatArray) -> None:
        self.k = wavenumbers.astype(np.longdouble)
        self.nu = np.longdouble(layer.poissons_ratio)
        top = self._solutions(np.longdouble(0.0))
        base = self._solutions(np.longdouble(1.0))
        held = (0, 1) if layer.support == "bonded" else (1, 2)
        matrix = np.stack([top[3], top[2], base[held[0]], base[held[1]]])
        # The half-space is the second solution, which meets the conditions at the surface.
        missing = np.zeros((4, self.k.size), np.longdouble)
        missing[2:] = -matrix[2:, 1]
        self.coefficients = _eliminated(matrix, missing)

    def at(self, depth: np.longdouble) -> NDArray[np.longdouble]:
        """2 G k u_r, 2 G k u_z, shear stress and pressure at a depth, shape (4, n)."""
        total: NDArray[np.longdouble] = np.sum(self._solutions(depth) * self.coefficients, axis=1)
        return total

    def _solutions(self, depth: np.longdouble) -> NDArray[np.longdouble]:
        """The four fields of the four solutions, shape (4, 4, n)."""
        nu, q, p = self.nu, self.k * depth, self.k * (1 - depth)
        e, f = np.exp(-q), np.exp(-p)
        return np.array(
            [
                [e, -(1 - 2 * nu - q) * e, f, -(1 - 2 * nu - p) * f],
                [e, (2 * (1 - nu) + q) * e, -f, -(2 * (1 - nu) + p) * f],
                [e, q * e, -f, -p * f],
                [e, (1 + q) * e, f, (1 + p) * f],
            ]
        )


def _eliminated(matrix: NDArray[np.longdouble], right: NDArray[np.longdouble]) -> NDArray[np.longdouble]:
    """Solutions of systems of shape (4, 4, n) with right sides (4, n), by pivots in columns."""
    size, each = len(matrix), np.arange(right.shape[1])
    rows = np.concatenate([matrix, right[:, None]], axis=1)
    for i in range(size):
        pivot = i + np.argmax(np.abs(rows[i:, i]), axis=0)
        upper, chosen = rows[i].copy(), rows[pivot, :, each].T.copy()
        rows[pivot, :, each] = upper.T
        rows[i] = chosen
        for j in range(i + 1, size):
            rows[j] -= rows[j, i] / rows[i, i] * rows[i]
    solution = np.zeros_like(right)
    for i in reversed(range(size)):
        known = np.sum(rows[i, i + 1 : size] * solution[i + 1 :], axis=0)
        solution[i] = (rows[i, size] - known) / rows[i, i]
    return solution
