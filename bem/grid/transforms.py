"""Cosine filters on quadrants of mirror-symmetric square grids, by FFTW, which only this file uses.

An even field on a grid of 2 m x 2 m cells is given by its quadrant x > 0, y > 0, whose first cell centre is half a cell
from both axes. Extended by zeros to a lattice of `period` cells in both directions, its modes have the wavenumbers
2 pi j/(period s), s the cell size. The forward transform is the DCT-II, the inverse the DCT-III. Their product is
period^2 times the identity. Transforms of rows that are zero by padding are omitted.
"""

from __future__ import annotations

from functools import lru_cache
from threading import get_ident
from typing import Any, Final, Literal

import numpy as np
from scipy.fft import irfft2, rfft2

from bem.compiled_files import compiled
from contact.records.validation import FloatArray

# Unused numbers after each row, one cache line. Without them rows of length 2^n begin at the same address of the cache,
# and column transforms take 1.5 to 3.3 times as long. 4 or 16 are as good.
BESIDE_ROWS: Final = 8


class CosineFilter:
    """Filter of a quadrant of `cells` x `cells` values on a lattice of `period` >= 2 `cells`.

    Attributes:
        cells: Cells along a side of the quadrant.
        period: Cells along a side of the whole lattice, even.
        modes: |j| along both axes, shape (period/2, 1) and (1, period/2).
    """

    def __init__(self, cells: int, period: int, threads: int = 1) -> None:
        self.cells, self.period = cells, period
        half = period // 2
        self.modes = np.arange(half)[:, None], np.arange(half)[None, :]
        self._plane = _fftw().zeros_aligned((half, half + BESIDE_ROWS))[:, :half]
        occupied = self._plane[:cells]
        self._rows = cosine_plan(occupied, 2, (1,), threads)
        self._columns = cosine_plan(self._plane, 2, (0,), threads)
        self._columns_back = cosine_plan(self._plane, 3, (0,), threads)
        self._rows_back = cosine_plan(occupied, 3, (1,), threads)

    def __call__(self, field: FloatArray, symbol: FloatArray) -> FloatArray:
        """The filtered field, shape (cells, cells); `symbol` is the factor of each mode."""
        n, plane = self.cells, self._plane
        plane[:n, :n], plane[:n, n:] = field, 0.0
        self._rows.execute()
        plane[n:] = 0.0
        self._columns.execute()
        plane *= symbol
        self._columns_back.execute()
        self._rows_back.execute()
        return np.asarray(plane[:n, :n] / float(self.period**2))

    def convolution_symbol(self, kernel: FloatArray) -> FloatArray:
        """Eigenvalues of the convolution with an even kernel, given at offsets 0 <= i, j <= period/2."""
        work = kernel.copy()
        cosine_plan(work, 1, (0, 1)).execute()
        return np.asarray(work[:-1, :-1])


class FourierFilter:
    """Filter of the whole grid, for fields without symmetry; shape (cells, cells).

    Attributes:
        cells: Cells along a side of the grid.
        period: Cells along a side of the lattice, at least `cells`.
        modes: |j| along both axes, shape (period, 1) and (1, period/2 + 1).
    """

    def __init__(self, cells: int, period: int, threads: int = 1) -> None:
        self.cells, self.period, self._threads = cells, period, threads
        self._offset = np.minimum(np.arange(period), period - np.arange(period))
        self.modes = self._offset[:, None], np.arange(period // 2 + 1)[None, :]

    def __call__(self, field: FloatArray, symbol: FloatArray) -> FloatArray:
        """The filtered field, shape (cells, cells); `symbol` is the factor of each mode."""
        whole = (self.period, self.period)
        spectrum = rfft2(field, whole, workers=self._threads) * symbol
        return np.asarray(irfft2(spectrum, whole, workers=self._threads)[: self.cells, : self.cells])

    def convolution_symbol(self, kernel: FloatArray) -> FloatArray:
        """Eigenvalues of the convolution with an even kernel, given at offsets 0 <= i, j <= period/2."""
        return np.asarray(rfft2(kernel[np.ix_(self._offset, self._offset)]).real)


def cosine_filter(cells: int, period: int, threads: int = 1) -> CosineFilter:
    """A cached `CosineFilter`, one per thread, since it has a work array."""
    return _cached(cells, period, threads, get_ident())


@lru_cache(maxsize=16)
def _cached(cells: int, period: int, threads: int, thread: int) -> CosineFilter:
    return CosineFilter(cells, period, threads)


def cosine_plan(field: FloatArray, kind: Literal[1, 2, 3], axes: tuple[int, ...], threads: int = 1) -> Any:
    """FFTW's plan of DCT-I, DCT-II or DCT-III along some axes, in place and without normalisation.

    FFTW_ESTIMATE selects the plan without measuring time, so that results repeat exactly.
    """
    kinds = ({1: "FFTW_REDFT00", 2: "FFTW_REDFT10", 3: "FFTW_REDFT01"}[kind],) * len(axes)
    return _fftw().FFTW(field, field, axes=axes, direction=kinds, flags=("FFTW_ESTIMATE",), threads=threads)


def _fftw() -> Any:
    """FFTW's compiled interface alone: the whole package imports dask where that is installed."""
    return compiled("pyfftw.pyfftw", "pyfftw")


def fast_period(least: int) -> int:
    """Smallest even period of at least `least` cells whose half is a product of 2, 3 and 5."""
    half = -(-least // 2)
    powers = range(half.bit_length() + 1)
    products = [2**i * 3**j * 5**k for i in powers for j in powers for k in powers]
    return 2 * int(min(n for n in products if n >= half))
