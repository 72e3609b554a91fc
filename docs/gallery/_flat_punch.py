"""Stiffness, springs and pressure of the flat punch on a layer by the integral equation.

    k_bar = k_N/(2 E* a) = punch_0,  c_bar = c_N/E* = y_1^2
    q(rho) = p_bar sqrt(1 - rho^2) = sum_n punch_n sqrt(4n + 1) P_2n(u)/P_2n(0) / (2 punch_0),  u^2 = 1 - rho^2

`bem.equation` defines punch and y_1. The half-space has k_bar = c_bar = 1 and q = 1/2.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from bem.equation import USUAL, Sizes, flat_punches
from bem.kernels.of_layer import contact_kernel
from bem.numerics import EPS, even_legendre
from contact import ElasticLayer
from contact.answer.one_thread import one_thread
from contact.records.validation import FloatArray
from contact.stated import stated_error

# Rounding errors in units of eps times the condition.
_ROUNDINGS = 16.0


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
        for rows in self._own.at(ratios.ravel() * self._kernel.units):
            n = np.arange(1, rows.punch.shape[1])
            at_zero = np.append(1.0, np.cumprod(-(2 * n - 1) / (2 * n)))  # P_2n(0)
            terms = even_legendre(u[rows.which], n.size + 1) * np.sqrt(4 * np.append(0, n) + 1) / at_zero
            found[rows.which] = (terms * rows.punch).sum(axis=1) / (2 * rows.punch[:, 0])
        return np.asarray(found.reshape(shares.shape))
