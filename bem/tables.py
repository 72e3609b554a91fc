"""Tables of flat punches on uniform layers, as in section 3.2 of Forsbach (2023).

A table holds k_bar(a/h) and p_bar(r/a; a/h), Eq. (10), at 400 ratios and 500 radii, made with discs of cells.
Between its rows k_bar and q = p_bar sqrt(1 - rho^2) are splines over ln(a/h); below the first row 1/k_bar and q are
linear in a/h, towards the half-space. Over rho, q is a polynomial in u = sqrt(1 - rho^2), from which the Abel density
phi_1 of the punch follows:

    2 k_bar q = sum_n c_n P_2n(u)/P_2n(0),    phi_1(t) = sum_n c_n P_2n(t/a),    int_0^1 phi_1 d(t/a) = c_0 = k_bar.

At its edge phi_1 = y_1 = sqrt(k_bar + d k_bar/d ln a), Eq. (6). Errors are estimated from a second table with half as
many cells and radii and two thirds of the ratios (`FlatPunchTable.coarser`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any, Final, NamedTuple, Self

import numpy as np
from numpy.polynomial import chebyshev
from scipy.interpolate import BSpline, make_interp_spline

from bem.equation import USUAL
from bem.grid.discs import LARGEST_DEGREE, punch
from bem.grid.operators import Boundary
from bem.numerics import even_legendre
from contact import ElasticLayer, InvalidInput, Layer, UnsupportedSceneError
from contact.files.storage import read_tree, write_tree
from contact.records.record import Record
from contact.records.validation import FloatArray
from contact.scene.layer import Support

SCHEMA: Final = "contact-verification/flat-punch-table/4"
SMALLEST_RATIO, LARGEST_RATIO = 1e-3, 1e3
# Largest a/h of partial tables, one of which is solved at a time. With half as many a search solves unnecessary rows.
RUNGS: Final = (1.0, 4.0, 16.0, 64.0, 256.0, LARGEST_RATIO)
# Number of rows beyond the largest ratio, since splines are less accurate near their ends; and least number of rows.
BEYOND: Final = 6
# a/h from which on to twice of it periodic lattices with a gap between images replace free space gradually. A sudden
# change would put a spike into the slope of k_bar.
THIN: Final = 8.0


class Densities(NamedTuple):
    """Flat punches at some ratios a/h.

    Attributes:
        y1: phi_1 at the edge, shape (n,).
        density: c_0 = k_bar, c_1, .., shape (n, m).
        slope: Derivatives of the density by ln(a), shape (n, m).
    """

    y1: FloatArray
    density: FloatArray
    slope: FloatArray


@dataclass(frozen=True, eq=False)
class FlatPunchTable:
    """Flat punches on one layer at tabulated ratios and radii.

    Attributes:
        support: "bonded" or "unbonded".
        poissons_ratio: nu; zero on an unbonded layer, where it has no influence.
        ratios: a/h, increasing, shape (n,).
        radii: rho = r/a in [0, 1), increasing, shape (m,).
        stiffness: Dimensionless stiffness k_bar = k_N/(2 E* a), shape (n,).
        pressure: Dimensionless pressure p_bar, shape (n, m).
        cells: Cells across the grid of the computation.
        coarser: The coarser table for error estimates; None in the coarser table.

    Raises:
        InvalidInput: If shapes, order or values cannot be a table of flat punches.
    """

    support: Support
    poissons_ratio: float
    ratios: FloatArray
    radii: FloatArray
    stiffness: FloatArray
    pressure: FloatArray
    cells: int
    coarser: FlatPunchTable | None = None

    def __post_init__(self) -> None:
        """Refuse arrays whose shapes, order or values are not those of a table."""
        shape = self.ratios.size, self.radii.size
        steps = np.diff(self.ratios, prepend=0.0), np.diff(self.radii), 1.0 - self.radii, self.radii[:1] + 1e-300
        if shape[0] < BEYOND or not all(np.all(values > 0.0) for values in steps):
            raise InvalidInput(
                f"flat-punch table: at least {BEYOND} positive ratios, and radii in [0, 1), must increase"
            )
        if self.stiffness.shape != shape[:1] or self.pressure.shape != shape:
            raise InvalidInput(f"flat-punch table: stiffness and pressure must have shapes {shape[:1]} and {shape}")
        if not all(np.all(np.isfinite(values) & (values >= 0.0)) for values in (self.stiffness, self.pressure)):
            raise InvalidInput("flat-punch table: stiffness and pressure must be finite and not negative")

    @property
    def largest_ratio(self) -> float:
        """Largest a/h of the table."""
        return float(self.ratios[-1])

    def at(self, ratio: FloatArray) -> Densities:
        """Punches at ratios a/h > 0, shape (n,).

        Raises:
            InvalidInput: Beyond the last row.
        """
        refuse_beyond(float(ratio.max()), self.largest_ratio)
        first, place = self.ratios[0], np.log(np.maximum(ratio, self.ratios[0]))
        value, slope = self._spline(place), self._spline.derivative()(place)
        below = np.minimum(ratio / first, 1.0)
        soft = (1.0 - 1.0 / self.stiffness[0]) * below
        inside = ratio < first
        k = np.where(inside, 1.0 / (1.0 - soft), np.exp(value[:, 0]))
        growth = np.where(inside, soft / (1.0 - soft), slope[:, 0])[:, None]
        share = np.column_stack([np.ones_like(k), 2.0 * below[:, None] * value[:, 1:]])
        change = np.where(inside[:, None], share, 2.0 * np.column_stack([0.0 * k, slope[:, 1:]]))
        change[:, 0] = 0.0
        return Densities(np.sqrt(k * (1.0 + growth[:, 0])), k[:, None] * share, k[:, None] * (growth * share + change))

    @cached_property
    def _spline(self) -> BSpline:
        """Spline over ln(a/h) of ln k_bar and c_n/(2 k_bar), n > 0, whose coefficients c_n are fitted to q(rho)."""
        u = np.sqrt(1.0 - self.radii**2)
        largest = LARGEST_DEGREE if self.coarser else 3 * LARGEST_DEGREE // 4  # of which thin layers need all
        rows = even_legendre(u, min(largest, self.radii.size // 2) + 1)
        n = np.arange(1, rows.shape[1])
        at_zero = np.cumprod(-(2 * n - 1) / (2 * n))  # P_2n(0)
        fitted = np.linalg.lstsq(rows[:, 1:], (self.pressure * u - 0.5).T, rcond=None)[0].T * at_zero
        return make_interp_spline(np.log(self.ratios), np.column_stack([np.log(self.stiffness), fitted]), k=5)

    def tree(self) -> dict[str, Any]:
        """Arrays and settings under the names of the paper, for HDF5."""
        settings = {"support": self.support, "poissons_ratio": self.poissons_ratio, "cells": self.cells}
        arrays = {"ratios": self.ratios, "radii": self.radii, "k_bar": self.stiffness, "p_bar": self.pressure}
        return settings | arrays | ({"coarser": self.coarser.tree()} if self.coarser else {})

    @classmethod
    def of_tree(cls, tree: dict[str, Any]) -> Self:
        """The table from arrays and settings as `tree` returns them."""
        fields = {name: tree[name] for name in ("support", "poissons_ratio", "ratios", "radii", "cells")}
        coarser = cls.of_tree(tree["coarser"]) if "coarser" in tree else None
        return cls(**fields, stiffness=tree["k_bar"], pressure=tree["p_bar"], coarser=coarser)


def refuse_beyond(ratio: float, largest: float) -> None:
    """Refuse a ratio a/h beyond the largest one of a table.

    Raises:
        InvalidInput: With both ratios.
    """
    if not 0.0 < ratio <= largest * (1.0 + 1e-9):
        raise InvalidInput(
            f"a/h = {ratio:g}: the flat-punch table covers ratios up to {largest:g} and is never extrapolated; "
            "make it up to a larger ratio, or ask for smaller contacts"
        )


def write_table(path: str | Path, table: FlatPunchTable) -> None:
    """Write a table, and its coarser table, to an HDF5 file."""
    write_tree(path, {"schema": SCHEMA} | table.tree())


def read_table(path: str | Path) -> FlatPunchTable:
    """Read a table that `write_table` wrote.

    Raises:
        InvalidInput: If the file is missing, damaged, or no such table.
    """
    tree = read_tree(path)
    if tree.get("schema") != SCHEMA:
        raise InvalidInput(f"{path}: schema {tree.get('schema')!r}; this version reads {SCHEMA!r}: make the table anew")
    return FlatPunchTable.of_tree(tree)


def tabulated_layer(layer: ElasticLayer) -> Layer:
    """The layer with h = 1 and E* = 1.

    Raises:
        UnsupportedSceneError: If it is no uniform layer of finite thickness.
    """
    plain = layer.simplest()
    if not isinstance(plain, Layer) or plain.is_half_space:
        raise UnsupportedSceneError(
            f"tables of flat punches are of uniform layers of finite thickness, not of a {type(plain).__name__}; "
            "use the integral equation"
        )
    nu = plain.poissons_ratio if plain.support == "bonded" else 0.0
    return plain.replace(thickness=1.0, youngs_modulus=1.0 - nu**2, poissons_ratio=nu)


class FftTable(Record):
    """Settings of tables by boundary elements, as a source of flat-punch data of MDR (`Mdr.flat_punch`).

    Attributes:
        cells: Cells across the grid, a multiple of 4.
        ratios: Number of log-spaced ratios a/h from 1e-3 to 1e3; only those up to the largest contact are solved.
        radii: Number of radii r/a = sin(theta), equally spaced in theta.

    Raises:
        InvalidInput: If there are too few of any, or `cells` is no multiple of 4.
    """

    cells: int = 256
    ratios: int = 400
    radii: int = 500

    largest_ratio = LARGEST_RATIO
    sizes = USUAL

    def __post_init__(self) -> None:
        """Refuse grids that cannot be halved."""
        if self.cells < 64 or self.cells % 4:
            raise InvalidInput(f"cells must be a multiple of 4 and at least 64, got {self.cells}")
        if min(self.ratios, self.radii) < 2 * BEYOND:
            raise InvalidInput(f"ratios and radii must be at least {2 * BEYOND}, got {self.ratios} and {self.radii}")

    def solution(self, layer: ElasticLayer, largest_ratio: float = LARGEST_RATIO) -> FlatPunchTable:
        """The table of a layer up to at least a ratio a/h, by default the complete one.

        Raises:
            InvalidInput: If the ratio is beyond 1000.
            UnsupportedSceneError: If the layer is not uniform, or a half-space.
        """
        refuse_beyond(largest_ratio, LARGEST_RATIO)
        rung = next((rung for rung in RUNGS if largest_ratio <= rung), LARGEST_RATIO)
        return _table(self, tabulated_layer(layer), rung)

    def refined(self) -> Self:
        """A copy with half the cell size."""
        return self.replace(cells=2 * self.cells)


@lru_cache(maxsize=64)
def _table(settings: FftTable, layer: Layer, rung: float) -> FlatPunchTable:
    """The table up to the ratio `rung`, with its coarser table, cached."""
    cells, count, radii = settings.cells, settings.ratios, settings.radii
    # Errors fall with the sixth power of the ratios: half of them state sixty times too much.
    coarser = _made(layer, rung, cells // 2, 2 * count // 3, radii // 2)
    return replace(_made(layer, rung, cells, count, radii), coarser=coarser)


def _made(layer: Layer, rung: float, cells: int, count: int, columns: int) -> FlatPunchTable:
    """The table on one grid. The edge value of Q is y_1 from the derivative of the stiffness over all rows."""
    ratios = np.geomspace(SMALLEST_RATIO, LARGEST_RATIO, count)
    ratios = ratios[: int(np.searchsorted(ratios, rung * (1.0 - 1e-9))) + 1 + BEYOND]
    growth, at_zero, at_one = zip(*(_row(layer, ratio, cells) for ratio in ratios.tolist()), strict=True)
    k, place = np.array(growth), np.log(ratios)
    y1 = np.sqrt(k * (1.0 + make_interp_spline(place, np.log(k), k=5).derivative()(place)))
    series = np.array(at_zero) + y1[:, None] * (np.array(at_one) - np.array(at_zero))
    theta = (np.arange(columns) + 0.5) * (np.pi / (2 * columns))
    q = np.maximum(chebyshev.chebval(-np.cos(2.0 * theta), series.T), 0.0) / (2.0 * k[:, None])
    pressure = q / np.cos(theta)
    return FlatPunchTable(layer.support, layer.poissons_ratio, ratios, np.sin(theta), k, pressure, cells)


@lru_cache(maxsize=4096)
def _row(layer: Layer, ratio: float, cells: int) -> tuple[float, FloatArray, FloatArray]:
    """k_bar, and Chebyshev coefficients of Q in 2 rho^2 - 1 for the edge values 0 and 1, in which Q is linear.

    The boundary is free space, or periodic with a gap between images, or a weighted mean of both in between.
    """
    rise = float(np.clip(np.log2(ratio / THIN), 0.0, 1.0))
    periodic = rise * rise * (3.0 - 2.0 * rise)
    shares: dict[Boundary, float] = {"free": 1.0 - periodic, "periodic": periodic}
    k, series = 0.0, np.zeros((2, LARGEST_DEGREE + 1))
    for boundary, share in shares.items():
        if share:
            disc = punch(layer, ratio, cells, boundary)
            k += share * disc.growth
            series[:, : disc.degree + 1] += [share * disc.series(disc.degree, edge) for edge in (0.0, 1.0)]
    return k, series[0], series[1]


class TableFile(Record):
    """A stored table as a source of flat-punch data of MDR.

    Attributes:
        path: HDF5 file that `write_table` wrote.
    """

    path: str

    sizes = USUAL

    @property
    def largest_ratio(self) -> float:
        """Largest a/h that the file covers."""
        return _stored(self.path).largest_ratio

    def solution(self, layer: ElasticLayer, largest_ratio: float = SMALLEST_RATIO) -> FlatPunchTable:
        """The stored table.

        Raises:
            InvalidInput: If it belongs to another layer, or ends below the ratio a/h.
            UnsupportedSceneError: If the layer is not uniform, or a half-space.
        """
        unit_layer, table = tabulated_layer(layer), _stored(self.path)
        if (table.support, table.poissons_ratio) != (unit_layer.support, unit_layer.poissons_ratio):
            raise InvalidInput(
                f"{self.path}: the table is of a {table.support} layer with nu = {table.poissons_ratio:g}, not of a "
                f"{unit_layer.support} one with nu = {unit_layer.poissons_ratio:g}; make one with FftTable"
            )
        refuse_beyond(largest_ratio, table.largest_ratio)
        return table

    def refined(self) -> Self:
        """Raises an error, since a stored table cannot be refined.

        Raises:
            InvalidInput: Always.
        """
        raise InvalidInput(f"{self.path} cannot be refined; make a finer table with FftTable")


_stored = lru_cache(maxsize=8)(read_table)
