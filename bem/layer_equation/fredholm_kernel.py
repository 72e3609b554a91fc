"""Difference kernel of the layer's Fredholm equation as a short sum of exponentials.

The kernel is ``N(s) = int_0^inf (1 - chi(k)) cos(ks) dk`` for s >= 0, lengths in units of the layer thickness. On the
real axis the integrand oscillates. Turned into the ray ``k = t exp(i theta)`` it decays for every s, and no pole of chi
is crossed as long as theta stays below 53.9 degrees (k = 1.80936 + 2.48689 i, bonded incompressible). So

    N(s) = Re sum_j w_j exp(-z_j s),     z_j = -i t_j exp(i theta)

with one set of Gauss nodes t_j, graded towards zero, is good for all s up to 2^13.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import ArrayLike, NDArray

from bem.kernels.layer import one_minus_kernel
from bem.kernels.protocol import SurfaceKernel
from bem.polynomials.gauss_panels import PANEL_NODES, gauss_nodes
from contact.records.validation import FloatArray
from contact.scene.layer import Support

# theta, about half of the largest angle allowed: exp(-z s) decays with t sin(theta), and 1 - chi with 2 t cos(theta).
RAY_ANGLE: Final = np.radians(25.0)
# Panels [2^j, 2^(j+1)] in t begin with this j, which resolves exp(-z s) up to s = 2^13, and end with the other one at
# t = 32, where 1 - chi has fallen to 1e-22.
FINEST_PANEL: Final = -13
COARSEST_PANEL: Final = 4
# The same for any layer. A stiff sheet on thin incompressible layers has poles near 30 degrees, since its bending
# stiffness grows like k^4 and their compliance like k^2: k^6 is negative there. Half of that angle, with 24 nodes,
# leaves 4e-15 of N on 300 random stacks of 1 to 4 layers (moduli 1e-4 to 1e4, thicknesses 1e-3 to 1, against 12
# degrees and 64 nodes, distances 0.01 to 300, 2026-11-22); 20 degrees leave 1e-10.
ANY_ANGLE: Final = np.radians(15.0)
ANY_NODES: Final = 24
# The first panel ends at 2^ANY_FINEST over the longest length on which the kernel varies.
ANY_FINEST: Final = -6


@dataclass(frozen=True)
class FredholmKernel:
    """N(s) of one layer, Re sum_j weights_j exp(-rates_j s), absolute error about 1e-16.

    Attributes:
        rates: z_j, shape (terms,), Re z_j > 0.
        weights: w_j, shape (terms,).
    """

    rates: NDArray[np.complex128]
    weights: NDArray[np.complex128]
    _kept: dict[tuple[float, int], NDArray[np.complex128]] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )
    _asked: dict[str, tuple[bytes, NDArray[np.complex128]]] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )

    @classmethod
    def of_layer(cls, support: Support, poissons_ratio: float) -> FredholmKernel:
        """The kernel of a bonded or unbonded layer of thickness 1."""
        nodes, weights = gauss_nodes(PANEL_NODES)
        ends = np.concatenate([[0.0], 2.0 ** np.arange(FINEST_PANEL, COARSEST_PANEL + 2)])
        t = (ends[:-1, None] + np.diff(ends)[:, None] * nodes).ravel()
        wavenumber = t * np.exp(1j * RAY_ANGLE)
        dk = np.exp(1j * RAY_ANGLE) * (np.diff(ends)[:, None] * weights).ravel()
        return cls(rates=-1j * wavenumber, weights=one_minus_kernel(wavenumber, support, poissons_ratio) * dk)

    @classmethod
    def of_surface(cls, kernel: SurfaceKernel, coarsest: int = COARSEST_PANEL) -> FredholmKernel:
        """The kernel of any layer, lengths in units of the thickness of its surface material.

        Args:
            kernel: 1 - chi.
            coarsest: Number of the last panel; beyond it 1 - chi is left out.
        """
        finest = min(FINEST_PANEL, int(np.floor(-np.log2(kernel.longest))) + ANY_FINEST)
        nodes, weights = gauss_nodes(ANY_NODES)
        ends = np.concatenate([[0.0], 2.0 ** np.arange(finest, coarsest + 2)])
        t = (ends[:-1, None] + np.diff(ends)[:, None] * nodes).ravel()
        turn = np.exp(1j * ANY_ANGLE)
        dk = turn * (np.diff(ends)[:, None] * weights).ravel()
        return cls(rates=-1j * t * turn, weights=kernel.one_minus_chi(t * turn) * dk)

    def __call__(self, distance: ArrayLike) -> FloatArray:
        """N at distances s >= 0 of any shape, in units of the thickness."""
        decay = np.exp(-np.multiply.outer(np.asarray(distance, dtype=float), self.rates))
        values: FloatArray = (decay @ self.weights).real
        return values

    def products(self, left: FloatArray, right: FloatArray) -> FloatArray:
        """N(left_i + right_j) of distances none of which is negative, by products of their exponentials."""
        decay = np.exp(-np.multiply.outer(left, self.rates)) * self.weights
        values: FloatArray = (decay @ np.exp(-np.multiply.outer(self.rates, right))).real
        return values

    def decay(self, distance: FloatArray) -> NDArray[np.complex128]:
        """exp(-rates s) at distances s, shape (n, terms)."""
        exponents = np.multiply.outer(distance, -self.rates)
        return np.exp(exponents, out=exponents)

    def decay_again(self, distance: FloatArray) -> NDArray[np.complex128]:
        """The same, kept for those who ask for the same distances next: contacts wider than the layer is thick do."""
        asked = distance.tobytes()
        kept = self._asked.get("last")
        if kept is None or kept[0] != asked:
            kept = self._asked["last"] = asked, self.decay(distance)
        return kept[1]

    def decay_within(self, width: float, count: int, *, keep: bool) -> NDArray[np.complex128]:
        """The same at the Gauss nodes of a panel.

        Args:
            width: Of the panel.
            count: Its nodes.
            keep: Whether others will ask for this width again.
        """
        key = (width, count)
        if key in self._kept:
            return self._kept[key]
        decay = self.decay(width * gauss_nodes(count)[0])
        if keep:
            self._kept[key] = decay
        return decay

    def panel_matrix(self, panels: int, width: float, count: int) -> FloatArray:
        """L(x, t) = [N(x - t) + N(x + t)]/2 at all Gauss nodes of equal panels [p width, (p + 1) width].

        Differences x - t depend on the distance of two panels only, sums x + t on the sum of their numbers: of the
        (panels count)^2 entries only 3 panels count^2 are evaluated, as products of exponentials.

        Returns:
            Symmetric matrix of shape (panels count, panels count).
        """
        nodes, _ = gauss_nodes(count)
        near, further = self(width * abs(nodes[:, None] - nodes))[None], self._blocks(panels - 1, width, 1 - nodes)
        differences = np.concatenate([further[::-1].swapaxes(1, 2), near, further])
        blocks = np.empty((panels, count, panels, count))
        # Block (p, q) of the first depends on p - q, of the second on p + q.
        by_difference = sliding_window_view(differences, panels, axis=0)[..., ::-1]
        by_sum = sliding_window_view(self._blocks(2 * panels - 1, width, nodes), panels, axis=0)
        np.add(np.moveaxis(by_difference, 3, 2), np.moveaxis(by_sum, 3, 2), out=blocks)
        blocks /= 2
        return blocks.reshape(panels * count, panels * count)

    def _blocks(self, blocks: int, width: float, other: FloatArray) -> FloatArray:
        """N(width (b + nodes_i + other_j)) for b = 0 .. blocks - 1, shape (blocks, count, count)."""
        nodes, _ = gauss_nodes(other.size)
        left = np.exp(-width * np.multiply.outer(nodes, self.rates))
        right = np.exp(-width * np.multiply.outer(self.rates, other))
        shift = self.weights * np.exp(-width * np.multiply.outer(np.arange(blocks), self.rates))
        values: FloatArray = ((left * shift[:, None, :]) @ right).real
        return values
