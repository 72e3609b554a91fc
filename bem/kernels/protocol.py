"""What the equations behind it ask of the kernel of any layer.

A surface pressure p^(k) displaces the surface by u^(k) = 2 chi(k)/(k E*) p^(k). Wave numbers k count in units of 1/h, h
being the thickness of the uniform material at the surface (`ElasticLayer.surface`); chi tends to 1 for large k.
"""

from __future__ import annotations

from collections.abc import Hashable
from typing import Any, Protocol

from numpy.typing import NDArray

from bem.kernels.stack import Material, Transfer
from contact.records.validation import FloatArray


class Descent(Protocol):
    """The inside of a layer under a unit pressure of wave numbers k, shape (n,), on the surface; depths over h."""

    def places(self, z: FloatArray) -> NDArray[Any]:
        """Number of the part that holds each depth, shape (m,): depths of one part are asked together."""

    def material(self, place: int, z: FloatArray) -> Material:
        """The material at depths of one part."""

    def at(self, place: int, z: FloatArray) -> Transfer:
        """Displacements and tractions at depths of one part, shape (m, 1): arrays of shape (m, n)."""


class SurfaceKernel(Hashable, Protocol):
    """Compliance of a layer's surface relative to the half-space of its surface material."""

    @property
    def longest(self) -> float:
        """Length over h beyond which chi has its limit for small k: chi is smooth on the scale of 1/longest."""

    @property
    def tail(self) -> tuple[float, ...]:
        """c_1, c_2, .. of 1 - chi ~ sum c_j/k^j for large k on a graded surface; none where it falls exponentially."""

    def chi(self, wavenumber: NDArray[Any]) -> NDArray[Any]:
        """chi at wave numbers k > 0, or complex ones with 0 <= arg k < pi/2, any shape."""

    def one_minus_chi(self, wavenumber: NDArray[Any]) -> NDArray[Any]:
        """1 - chi, also where it is exponentially small."""

    def descent(self, k: FloatArray) -> Descent:
        """The inside at wave numbers k > 0, shape (n,)."""
