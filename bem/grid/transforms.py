"""Spectral filters on square grids: the only file that knows the library of transforms, FFTW.

Convention, stated once. A field of `cells` x `cells` values is extended by zeros to a lattice of even period
`period` in both directions. The forward transform carries no factor, the inverse carries 1/period^2, and mode j of a
lattice with spacing s has the angular wavenumber 2 pi j / (period s). A filter multiplies every mode by a real, even
`symbol`; the symbol is stored only on `modes`, the modes a transform of real data really has.

`FullTransform` holds the whole grid (real to complex). `QuarterTransform` holds the quadrant x > 0, y > 0 of a grid
that is mirror symmetric about the corner of its first cell (cosine transforms): a quarter of the work and memory.
Both skip the row transforms of rows that are zero by padding, and of rows nobody reads on the way back.

All plans are made with FFTW_ESTIMATE, which measures no time: results repeat bit by bit. Each thread keeps its plans.
"""

from __future__ import annotations

from functools import lru_cache, partial
from threading import get_ident
from typing import Any, Final, Literal, Protocol

import numpy as np
import numpy.typing as npt

from contact import InvalidInput
from contact.answer.compiled_files import compiled
from contact.records.validation import FloatArray

# Unused numbers after each row, one cache line: without them all rows of a power of two numbers begin at the same place
# of the cache, and column transforms take 1.5 to 3.3 times as long; 4 or 16 numbers do as well.
BESIDE_ROWS: Final = 8


class Transform(Protocol):
    """What an operator needs from a transform: its sizes, its modes and one verb."""

    cells: int
    period: int

    @property
    def modes(self) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
        """Absolute mode numbers along axis 0 (column) and axis 1 (row), broadcasting against each other."""
        ...

    def filter(self, field: FloatArray, symbol: FloatArray) -> FloatArray:
        """Inverse transform of symbol times transform of the zero-padded field, on the cells of the field."""
        ...


class FullTransform:
    """Real-to-complex filter of a whole grid of `cells` x `cells` values on a lattice of `period` >= cells."""

    def __init__(self, cells: int, period: int, *, threads: int = 1) -> None:
        self.cells, self.period = _checked_sizes(cells, period)
        self._strip = _fftw().zeros_aligned((cells, period), dtype="float64")
        self._plane = _fftw().zeros_aligned((period, period // 2 + 1), dtype="complex128")
        occupied = self._plane[:cells]
        plan = partial(_fftw().FFTW, flags=("FFTW_ESTIMATE",), threads=threads)
        self._rows = plan(self._strip, occupied, axes=(1,), direction="FFTW_FORWARD")
        self._columns = plan(self._plane, self._plane, axes=(0,), direction="FFTW_FORWARD")
        self._columns_back = plan(self._plane, self._plane, axes=(0,), direction="FFTW_BACKWARD")
        self._rows_back = plan(occupied, self._strip, axes=(1,), direction="FFTW_BACKWARD")

    @property
    def modes(self) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
        """Mode numbers |j1| as a column of `period` rows and j2 as a row of period/2 + 1 columns."""
        rows = np.arange(self.period)
        return np.minimum(rows, self.period - rows)[:, None], np.arange(self.period // 2 + 1)[None, :]

    def filter(self, field: FloatArray, symbol: FloatArray) -> FloatArray:
        """Filtered field, shape (cells, cells); `symbol` has the shape of the modes."""
        n = self.cells
        self._strip[:, :n], self._strip[:, n:] = field, 0.0
        self._rows.execute()
        self._plane[n:] = 0.0
        self._columns.execute()
        self._plane *= symbol
        self._columns_back.execute()
        self._rows_back.execute()
        return np.asarray(self._strip[:, :n] / float(self.period**2))


class QuarterTransform:
    """Cosine filter of the quadrant of `cells` x `cells` values of a mirror-symmetric grid.

    The quadrant stands for 2 cells x 2 cells values, and its lattice `period` counts those: period >= 2 cells.
    The forward transform is the DCT-II, its inverse the DCT-III; together they carry the factor period^2 of the full
    transform, and the eigenvalues of a symmetric convolution are the same numbers.
    """

    def __init__(self, cells: int, period: int, *, threads: int = 1) -> None:
        _checked_sizes(2 * cells, period)
        self.cells, self.period = cells, period
        half = period // 2
        self._plane = _fftw().zeros_aligned((half, half + BESIDE_ROWS))[:, :half]
        occupied = self._plane[:cells]
        self._rows = cosine_plan(occupied, 2, (1,), threads)
        self._columns = cosine_plan(self._plane, 2, (0,), threads)
        self._columns_back = cosine_plan(self._plane, 3, (0,), threads)
        self._rows_back = cosine_plan(occupied, 3, (1,), threads)

    @property
    def modes(self) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
        """Mode numbers 0 .. period/2 - 1 in both directions."""
        numbers = np.arange(self.period // 2)
        return numbers[:, None], numbers[None, :]

    def filter(self, field: FloatArray, symbol: FloatArray) -> FloatArray:
        """Filtered field, shape (cells, cells); `symbol` has the shape of the modes."""
        n, plane = self.cells, self._plane
        plane[:n, :n], plane[:n, n:] = field, 0.0
        self._rows.execute()
        plane[n:] = 0.0
        self._columns.execute()
        plane *= symbol
        self._columns_back.execute()
        self._rows_back.execute()
        return np.asarray(plane[:n, :n] / float(self.period**2))


def cosine_plan(field: FloatArray, kind: Literal[1, 2, 3], axes: tuple[int, ...], threads: int = 1) -> Any:
    """FFTW's plan of DCT-I, DCT-II or DCT-III along some axes, in place and without a factor."""
    direction = {1: "FFTW_REDFT00", 2: "FFTW_REDFT10", 3: "FFTW_REDFT01"}[kind]
    kinds = (direction,) * len(axes)
    return _fftw().FFTW(field, field, axes=axes, direction=kinds, flags=("FFTW_ESTIMATE",), threads=threads)


def quarter_transform(cells: int, period: int, threads: int = 1) -> QuarterTransform:
    """A `QuarterTransform` with its plans, made once per thread: it has a plane to work in."""
    return _kept(cells, period, threads, get_ident())


@lru_cache(maxsize=16)
def _kept(cells: int, period: int, threads: int, _: int) -> QuarterTransform:
    return QuarterTransform(cells, period, threads=threads)


def _fftw() -> Any:
    """FFTW's compiled interface: the whole package imports dask where that is installed."""
    return compiled("pyfftw.pyfftw", "pyfftw")


def convolution_symbol(transform: Transform, quadrant: FloatArray) -> FloatArray:
    """Eigenvalues of the convolution with an even kernel, on the modes of `transform`.

    `quadrant[i, j]` is the kernel at the lattice offset (i, j), 0 <= i, j <= period/2. Being even in both directions
    the kernel has a cosine series, so one DCT-I of the quadrant serves both kinds of transform.
    """
    half = transform.period // 2
    if quadrant.shape != (half + 1, half + 1):
        raise InvalidInput(f"the kernel quadrant must have shape {(half + 1, half + 1)}, got {quadrant.shape}")
    work = quadrant.copy()
    cosine_plan(work, 1, (0, 1)).execute()
    columns, rows = transform.modes
    return np.asarray(work[columns, rows])


def fast_period(least: int) -> int:
    """Smallest even period of at least `least` cells whose prime factors transforms handle fast."""
    half = -(-least // 2)
    return 2 * min(fast for fast in _products(2 * half) if fast >= half)


@lru_cache(maxsize=64)
def _products(most: int) -> tuple[int, ...]:
    """All products of 2, 3 and 5 up to a number; the powers of 2 among them reach half of it."""
    powers = range(most.bit_length())
    return tuple(n for i in powers for j in powers for k in powers if (n := 2**i * 3**j * 5**k) <= most)


def _checked_sizes(cells: int, period: int) -> tuple[int, int]:
    if cells < 2 or period < cells or period % 2:
        raise InvalidInput(f"a grid needs at least 2 cells and an even period >= cells, got {cells} and {period}")
    return cells, period
