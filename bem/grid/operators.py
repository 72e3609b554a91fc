"""Surface displacement by surface pressure, Eq. (26), on a square grid: periodic or in free space.

Both operators act on the pressure at cell centres, shape (m, m), in pascals, and answer in metres. On a whole grid
m = `cells`; on a quadrant (mirror symmetry about x = 0 and y = 0, which every centred axisymmetric scene has)
m = cells/2, and the first cell's centre lies half a cell from both axes.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from math import ceil, log2, pi
from typing import ClassVar, Final, Protocol

import numpy as np

from bem.grid.influence import band_limited_influence, layer_influence
from bem.grid.other_layers import other_layer_influence
from bem.grid.transforms import (
    FullTransform,
    Transform,
    convolution_symbol,
    fast_period,
    quarter_transform,
)
from bem.kernels.moduli import contact_modulus
from bem.kernels.of_layer import surface_kernel
from bem.polynomials.chebyshev import piecewise_sum
from bem.polynomials.gauss_panels import chebyshev_from_nodes, gauss_nodes
from contact import ElasticLayer, InvalidInput, Layer
from contact.records.validation import FloatArray

# Least answer of the mean mode over that of the next mode. Below it conjugate gradients with the mean mode's inverse
# stall.
LEAST_ANSWER: Final = 0.1
# Nodes on each factor of two of the wavenumbers: chi is analytic in ln k, and these leave 1.2e-12 of it at most (six
# graded layers, tests/bem/test_operators_on_stacks.py, 2026-11-23).
NODES_OF_OCTAVES: Final = 16


class Operator(Protocol):
    """A symmetric positive definite map from pressure to displacement with an approximate inverse."""

    def displacement(self, pressure: FloatArray) -> FloatArray:
        """u [m] by p [Pa], both of shape (m, m)."""
        ...

    def precondition(self, displacement: FloatArray) -> FloatArray:
        """A pressure [Pa] that nearly causes this displacement [m]: the inverse kernel, cyclic and unpadded."""
        ...


class GridOperator:
    """Two filters on one grid: the operator, and its approximate inverse without padding.

    Args:
        layer: The elastic layer or half-space.
        cell_size: s [m].
        cells: Cells across the box.
        quarter: Whether fields hold the quadrant x, y > 0 of a mirror-symmetric grid.
        threads: Threads of the transforms of a quadrant.
    """

    def __init__(
        self,
        layer: ElasticLayer,
        *,
        cell_size: float,
        cells: int,
        quarter: bool = False,
        threads: int = 1,
    ) -> None:
        def transform(period: int) -> Transform:
            return _transform(cells, period, quarter=quarter, threads=threads)

        cyclic = transform(cells)
        symbol = layer_symbol(_wavenumbers(cyclic, cell_size), layer)
        self._inverse, self._inverse_symbol = cyclic, _reciprocal(symbol)
        self._forward, self._symbol = cyclic, symbol
        if self.padded:
            self._forward = transform(fast_period(2 * cells))
            influence = self._influence(layer, self._forward.period // 2, cell_size)
            self._symbol = convolution_symbol(self._forward, influence * (cell_size / contact_modulus(layer)))

    padded: ClassVar[bool]

    def _influence(self, layer: ElasticLayer, offsets: int, cell_size: float) -> FloatArray:
        """Displacement by a unit pressure on one cell, lengths in cell sizes, E* = 1."""
        if not isinstance(layer, Layer):
            return other_layer_influence(offsets, layer, cell_size)
        return layer_influence(offsets, layer.thickness / cell_size, layer.support, layer.poissons_ratio)

    def displacement(self, pressure: FloatArray) -> FloatArray:
        """u [m] by p [Pa], both of shape (m, m)."""
        return self._forward.filter(pressure, self._symbol)

    def precondition(self, displacement: FloatArray) -> FloatArray:
        """A pressure [Pa] that nearly causes this displacement [m]."""
        return self._inverse.filter(displacement, self._inverse_symbol)


class PeriodicOperator(GridOperator):
    """Pressures repeated with the box: the symbol is Eq. (27) at the lattice's own wavenumbers.

    A field is taken as the trigonometric polynomial through its values, so a sinusoidal load has its exact answer,
    Eq. (32). Images decay exponentially for a layer. The mean mode k = 0 answers with the layer's finite compliance
    `h chi(q)/q` at q = 0; a half-space has none, and there the mean displacement is taken as zero.
    """

    padded = False


class FreeSpaceOperator(GridOperator):
    """Pressures alone on an infinite layer: a linear convolution with the influence of one cell, padded by zeros.

    A field is taken as piecewise constant over the cells and the displacement is exact at their centres.
    """

    padded = True


class BandLimitedHalfSpace(GridOperator):
    """A half-space in free space whose pressures are trigonometric polynomials, as those of `PeriodicOperator` are.

    It answers what a periodic operator would if its images were removed, and so tells how a set of cells acts there.
    """

    padded = True

    def _influence(self, layer: ElasticLayer, offsets: int, cell_size: float) -> FloatArray:
        """Of the trigonometric interpolant of a unit pressure at one cell."""
        if not layer.is_half_space:
            raise InvalidInput(f"only a half-space is known in this form, got a layer with h = {layer.thickness:g}")
        return band_limited_influence(offsets)


def layer_symbol(wavenumber: FloatArray, layer: ElasticLayer) -> FloatArray:
    """u^(k) / p^(k) = 2 chi(kh) / (k E*) [m/Pa], Eq. (27), with its finite value at k = 0 on a rigid base."""
    zero = wavenumber == 0.0
    k = np.where(zero, 1.0, wavenumber)
    if layer.is_half_space:
        return np.asarray(2.0 / contact_modulus(layer) * np.where(zero, 0.0, 1.0 / k))
    kernel, h = surface_kernel(layer), layer.surface.thickness
    at_zero = 0.0 if layer.has_elastic_base else h * kernel.zero_mode
    chi = kernel.chi if kernel.is_smooth else partial(_between_octaves, kernel.chi)
    return np.asarray(2.0 / contact_modulus(layer) * np.where(zero, at_zero, chi(k * h) / k))


def _between_octaves(chi: Callable[[FloatArray], FloatArray], wavenumber: FloatArray) -> FloatArray:
    """A kernel that takes long for each wavenumber, from `NODES_OF_OCTAVES` for each factor of two."""
    low = log2(float(wavenumber.min()))
    octaves = ceil(log2(float(wavenumber.max())) - low) + 1
    u = gauss_nodes(NODES_OF_OCTAVES)[0]
    logarithms = np.log(chi(2.0 ** (low + np.arange(octaves)[:, None] + u)))
    place = np.log2(wavenumber) - low
    octave = np.clip(place.astype(np.intp), 0, octaves - 1)
    coefficients = logarithms @ chebyshev_from_nodes(NODES_OF_OCTAVES).T
    return np.exp(piecewise_sum(coefficients, octave, 2.0 * (place - octave) - 1.0))


def _wavenumbers(transform: Transform, cell_size: float) -> FloatArray:
    """|k| [1/m] on the modes of a transform."""
    rows, columns = transform.modes
    return np.asarray(2.0 * pi / (transform.period * cell_size) * np.hypot(rows, columns))


def _reciprocal(symbol: FloatArray) -> FloatArray:
    """1/symbol; a mean mode, k = 0, that hardly answers counts as the most compliant one.

    It does not answer on a half-space or a bonded incompressible layer, and hardly on a nearly incompressible one,
    where its reciprocal would drown all other modes: a contact that fills part of the box has no mode of its own there.
    """
    mean, next_mode = symbol[0, 0], symbol[0, 1]
    damped = symbol.copy()
    damped[0, 0] = mean if mean > LEAST_ANSWER * next_mode else np.max(symbol)
    return np.asarray(1.0 / damped)


def _transform(cells: int, period: int, *, quarter: bool, threads: int) -> Transform:
    if not quarter:
        return FullTransform(cells, period, threads=threads)
    if cells % 2:
        raise InvalidInput(f"a mirror-symmetric grid needs an even number of cells, got {cells}")
    return quarter_transform(cells // 2, period, threads)
