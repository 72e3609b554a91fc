"""The flat punch on a layer by the integral equation: its settings, and its stiffness, springs and pressure.

    k_bar = k_N/(2 E* a) = punch_0,  c_bar = c_N/E* = y_1^2
    q(rho) = p_bar sqrt(1 - rho^2) = sum_n punch_n sqrt(4n + 1) P_2n(u)/P_2n(0) / (2 punch_0),  u^2 = 1 - rho^2

`bem.equation` says what punch and y_1 are. The half-space has k_bar = c_bar = 1 and q = 1/2.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Final, Protocol, Self, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field

from bem.equation import USUAL, Rows, Sizes, flat_punches
from bem.kernels.of_layer import contact_kernel
from bem.numerics import EPS, even_legendre
from contact import ElasticLayer
from contact.answer.one_thread import one_thread
from contact.records.record import Record
from contact.records.validation import FloatArray, positive
from contact.stated import stated_error

# Nodes by default, and the most; a refined setting has so many more.
USUAL_NODES: Final = 24
MOST_NODES: Final = 64
MORE_NODES: Final = 4
# Rounding errors in units of eps times the condition.
_ROUNDINGS = 16.0


class IntegralEquation(Record):
    """Resolution of the layer's equation.

    Attributes:
        nodes: Resolution per panel.
        panel_width: Width of a panel over the layer's thickness; with nodes it scales all sizes of the discretisation.
    """

    nodes: int = Field(default=USUAL_NODES, ge=4, le=MOST_NODES)
    panel_width: Annotated[float, *positive("panels about as wide as the layer is thick")] = 1.0

    @property
    def sizes(self) -> Sizes:
        """All sizes of the discretisation."""
        return USUAL.scaled(self.nodes / USUAL_NODES / self.panel_width)

    def punch(self, layer: ElasticLayer) -> FlatPunchValues:
        """The flat punch on this layer."""
        return FlatPunchValues(layer, self.sizes)

    def refined(self) -> Self:
        """Settings with about twice the resolution."""
        return self.replace(panel_width=self.panel_width / 2, nodes=min(self.nodes + MORE_NODES, MOST_NODES))


@runtime_checkable
class FlatPunchSource(Protocol):
    """Settings of where the flat punches of MDR come from: `IntegralEquation`, or a table (`bem.tables`)."""

    @property
    def sizes(self) -> Sizes:
        """Sizes of the discretisation of springs."""

    def refined(self) -> Self:
        """A copy with half the discretisation length."""


class FlatPunchValues:
    """Flat punches of all radii on one layer; ratios are a/h, h the thickness of the surface material.

    Args:
        layer: Layer, stack or graded layer.
        sizes: Resolution.
    """

    def __init__(self, layer: ElasticLayer, sizes: Sizes = USUAL) -> None:
        self._kernel = contact_kernel(layer)
        self._own, self._finer = (flat_punches(self._kernel, one) for one in (sizes, sizes.finer))

    def _values(self, ratio: ArrayLike, *, finer: bool = False) -> FloatArray:
        """k_bar, c_bar, and the conditions of depth and force, shape (4, n)."""
        x = np.ravel(np.asarray(ratio, dtype=np.float64)) * self._kernel.units
        found = np.empty((4, x.size))
        for index, punch, resolvent, noise in (self._finer if finer else self._own).at(x):
            found[:, index] = punch[:, 0], (1 + resolvent[:, 0]) ** 2, *noise.T
        return found

    @one_thread
    def normalized_contact_stiffness(self, ratio: ArrayLike) -> FloatArray:
        """k_bar = k_N/(2 E* a)."""
        return np.asarray(self._values(ratio)[0].reshape(np.shape(ratio)))

    @one_thread
    def normalized_spring_stiffness(self, ratio: ArrayLike) -> FloatArray:
        """c_bar = c_N/E*."""
        return np.asarray(self._values(ratio)[1].reshape(np.shape(ratio)))

    @one_thread
    def relative_error(self, ratio: ArrayLike) -> FloatArray:
        """Stated error of k_bar and c_bar."""
        own, finer = self._values(ratio), self._values(ratio, finer=True)
        floor = _ROUNDINGS * EPS * (1 + own[2:].max(axis=0))
        both = [stated_error(one, other, scale=one, floor=floor) for one, other in zip(own[:2], finer[:2], strict=True)]
        return np.asarray(np.max(both, axis=0).reshape(np.shape(ratio)))

    @one_thread
    def smooth_pressure(self, rho: ArrayLike, ratio: ArrayLike) -> FloatArray:
        """q at rho = r/a <= 1, shapes that broadcast."""
        shares, ratios = np.broadcast_arrays(np.asarray(rho, dtype=np.float64), np.asarray(ratio, dtype=np.float64))
        u = np.sqrt((1 - shares.ravel()) * (1 + shares.ravel()))
        found = np.empty(u.size)
        for rows in self._rows(ratios.ravel()):
            n = np.arange(1, rows.punch.shape[1])
            at_zero = np.append(1.0, np.cumprod(-(2 * n - 1) / (2 * n)))  # P_2n(0)
            terms = even_legendre(u[rows.which], n.size + 1) * np.sqrt(4 * np.append(0, n) + 1) / at_zero
            found[rows.which] = (terms * rows.punch).sum(axis=1) / (2 * rows.punch[:, 0])
        return np.asarray(found.reshape(shares.shape))

    def _rows(self, ratio: FloatArray) -> Iterator[Rows]:
        return self._own.at(ratio * self._kernel.units)
