"""The paper's own source of flat punches: FFT boundary elements on a grid of ratios, section 3.2 of Forsbach (2023)."""

from __future__ import annotations

import dataclasses
from functools import lru_cache
from math import ceil, log
from typing import Final, Self

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from bem.grid.discs import FILL, IMAGE_GAP, Disc, disc_of
from bem.grid.error_model import TABLES
from bem.tables.grid_rows import THIN, grid_rows
from bem.tables.table import LEAST_ROWS, FlatPunchTable, chebyshev_radii
from bem.tables.tabulated_layer import Tabulable, lowest_face, tabulable
from contact import ElasticLayer, InvalidInput, LayerStack
from contact.records.record import Record, record
from contact.records.validation import FloatArray

# Tabulated ratios a/h. Below the first one a table is read linearly towards the half-space, beyond the last one never.
SMALLEST_RATIO: Final = 1e-3
LARGEST_RATIO: Final = 1e3
# Rows and columns that a table needs so that every other one is a table.
LEAST_HALVED: Final = 2 * LEAST_ROWS - 1
# Rows solved beyond the ratio asked for, because splines end less well than they run; a quintic B-spline spans six.
BEYOND: Final = LEAST_ROWS


@record
class FftTable(Record):
    """Flat-punch tables by the FFT boundary element method; a `FlatPunchSource`.

    Attributes:
        cells: Grid cells across the punch's box, a multiple of 4.
        ratios: Number of log-spaced ratios a/h in [1e-3, 1e3]; only those up to the ratio asked for are solved.
        radii: Number of radii r/a, dense towards the edge.

    Each table is built on `cells` and on half as many; the differences, their largest values over neighbouring ratios,
    are the stated errors of stiffness and pressure, and what reading between rows and columns adds. The method is of
    second order in cell size over thickness, so the difference exceeds the error; where the layer is thinner than two
    cells, it is doubled.

    Raises:
        InvalidInput: If `cells` is too small or no multiple of 4.
    """

    cells: int = 256
    ratios: int = 400
    radii: int = 500

    def __post_init__(self) -> None:
        """Refuse grids that cannot be halved."""
        if self.cells < 64 or self.cells % 4:
            raise InvalidInput(f"cells must be a multiple of 4 and at least 64, got {self.cells}")
        if min(self.ratios, self.radii) < LEAST_HALVED:
            raise InvalidInput(f"ratios and radii must be at least {LEAST_HALVED}, got {self.ratios} and {self.radii}")

    def solution(self, layer: ElasticLayer, max_ratio: float) -> FlatPunchTable:
        """The table of this layer's kernel up to at least a/h = `max_ratio`; built once, then remembered.

        On a stack h is the first sublayer's thickness, which the cells of the coarsest grid, four times as wide, must
        not exceed: a/h reaches an eighth of `cells`.

        Raises:
            InvalidInput: If the layer is a half-space or the ratio is beyond 1000, or `cells`/8 on a stack.
            UnsupportedSceneError: If the layer is graded.
        """
        unit = tabulable(layer)
        grid = np.geomspace(SMALLEST_RATIO, LARGEST_RATIO, self.ratios)
        largest = LARGEST_RATIO if unit.is_uniform else FILL * self.cells / 8
        # A quotient of two lengths meant as 1000 may come out above it by rounding.
        if not 0.0 < max_ratio <= largest * (1.0 + 1e-12):
            raise InvalidInput(
                f"a/h = {max_ratio:g} is outside the table's range (0, {largest:g}]"
                + ("" if unit.is_uniform else f" on stacks with cells = {self.cells}; take more cells")
            )
        rows = max(LEAST_HALVED, int(np.searchsorted(grid, max_ratio * (1.0 - 1e-12))) + 1 + BEYOND)
        return _build(self, unit, min(rows, self.ratios))

    def refined(self) -> Self:
        """A copy with half the cell size."""
        return dataclasses.replace(self, cells=2 * self.cells)


@lru_cache(maxsize=32)
def _build(settings: FftTable, layer: Tabulable, rows: int) -> FlatPunchTable:
    ratios = np.geomspace(SMALLEST_RATIO, LARGEST_RATIO, settings.ratios)[:rows]
    fine, half, quarter = (_on_grid(settings, times, layer, rows) for times in (1, 2, 4))
    shares = TABLES.half_share, TABLES.quarter_share
    half, quarter = (
        _weighed(fine, _as_far(fine, *pair), share, settings.cells, times)
        for pair, share, times in zip(((fine, half), (half, quarter)), shares, (1, 2), strict=True)
    )
    row_share = float(np.clip(np.log(ratios[1] / ratios[0]) ** 2, TABLES.least_row_share, TABLES.largest_row_share))
    return dataclasses.replace(
        _with_errors(fine, half, settings.cells, row_share),
        provenance=_provenance(settings, fine),
        variants=(*zip(shares, (half, quarter), strict=True), (row_share, _every_other(fine))),
    )


def _on_grid(settings: FftTable, times: int, layer: Tabulable, rows: int) -> FlatPunchTable:
    """The table of one grid, of `times` fewer cells, its errors still unknown."""
    grid = grid_rows(settings.cells // times, SMALLEST_RATIO, LARGEST_RATIO, settings.ratios, layer)
    punches, ratios = grid.first(rows), grid.ratios[:rows]
    rho, radii = chebyshev_radii(settings.radii), settings.radii
    q = np.array([np.polynomial.chebyshev.chebval(2.0 * rho**2 - 1.0, punch.shape) for punch in punches])
    # Under a flat end a stack may pull, one layer never does.
    q = np.maximum(q, 0.0) if layer.is_uniform else q
    return FlatPunchTable(
        support=lowest_face(layer),
        poissons_ratio=layer.surface.poissons_ratio,
        ratios=ratios,
        radii=rho,
        stiffness=np.array([punch.stiffness for punch in punches]),
        pressure=q / np.sqrt(1.0 - rho**2),
        error=np.zeros(len(ratios)),
        pressure_error=np.zeros(len(ratios)),
        mean_error=np.zeros((len(ratios), radii)),
        stack=layer if isinstance(layer, LayerStack) else None,
    )


def _as_far(table: FlatPunchTable, finer: FlatPunchTable, coarser: FlatPunchTable) -> FlatPunchTable:
    """The table off by what tells two others apart."""
    return dataclasses.replace(
        table,
        stiffness=table.stiffness * (coarser.stiffness / finer.stiffness),
        pressure=np.maximum(
            table.pressure + coarser.pressure - finer.pressure, 0.0 if table.stack is None else -np.inf
        ),
    )


def _weighed(fine: FlatPunchTable, coarse: FlatPunchTable, share: float, cells: int, times: int) -> FlatPunchTable:
    """A table that is off by what `times` and twice as many fewer cells differ, in k_bar by the part that is an error.

    On layers many cells thick k_bar is off by what the discs' mean square distances are off, which is known of both:
    the error is far smaller than the difference.
    """
    own, finer, coarser = (disc_of(n) for n in (cells, cells // times, cells // (2 * times)))
    error = max(abs(_moment_error(own)), TABLES.least_moment / own.radius**2)
    known = TABLES.moment_share / share * error / abs(_moment_error(coarser) - _moment_error(finer))
    per_thickness = own.radius / fine.ratios
    thin = np.log(TABLES.thick_cells / per_thickness) / np.log(TABLES.thick_cells / TABLES.thin_cells)
    counted = min(known, 1.0) ** (1.0 - np.clip(thin, 0.0, 1.0))
    return dataclasses.replace(coarse, stiffness=fine.stiffness * (coarse.stiffness / fine.stiffness) ** counted)


def _moment_error(disc: Disc) -> float:
    """Relative error of the mean square distance of two points of a disc's pressure, (4/3) a^2 on a circle.

    A layer many cells thick responds to that distance alone. Pressures are uniform on cells, displacements those of the
    cells' centres, hence the square of a cell over six.
    """
    square = np.average((disc.radius * disc.centres) ** 2, weights=disc.pressure)
    return float((2.0 * square + 1.0 / 6.0) / (4.0 / 3.0 * disc.radius**2) - 1.0)


def _with_errors(fine: FlatPunchTable, coarse: FlatPunchTable, cells: int, row_share: float) -> FlatPunchTable:
    """The fine table with bounds of its errors: of k_bar or c_bar, of q, and of integrals of q.

    Each is the difference to the coarse table and what reading between rows and columns adds. Where the edge layer, as
    wide as the layer is thick, spans fewer than two cells, convergence is of first order only; there the differences
    count twice, except in the mean, which converges faster.
    """
    xi, root = fine.ratios, np.sqrt(1.0 - fine.radii**2)
    k = np.abs(coarse.stiffness / fine.stiffness - 1.0)
    c = np.abs(coarse.normalized_spring_stiffness(xi) / fine.normalized_spring_stiffness(xi) - 1.0)
    q, difference = root * fine.pressure, root * np.abs(coarse.pressure - fine.pressure)
    times = np.where(xi > cells / 4, 2.0, 1.0)
    read_stiffness, read_pressure = _reading_errors(fine, row_share)
    if fine.stack is not None:
        # Below the first row q is read linearly, but leaves one half with the third power of a/h, as far as films bend.
        read_pressure[0] += fine.first_bending
    return dataclasses.replace(
        fine,
        error=TABLES.stiffness_floor
        + times * _largest_nearby(np.maximum(k, c), xi)
        + _largest_nearby(read_stiffness, xi),
        pressure_error=TABLES.pressure_floor
        + times * _largest_nearby(_worst(difference, q), xi)
        + _largest_nearby(_worst(read_pressure, q), xi),
        mean_error=TABLES.pressure_floor
        + _largest_nearby(_outwards(difference, q), xi)
        + _largest_nearby(_outwards(read_pressure, q), xi),
    )


def _worst(difference: FloatArray, q: FloatArray) -> FloatArray:
    """The largest error at any radius, relative to the largest q; a punch that pulls has negative ones."""
    return np.asarray(np.max(difference, axis=1) / np.max(np.abs(q), axis=1))


def _outwards(difference: FloatArray, q: FloatArray) -> FloatArray:
    """Errors of integrals of q from each radius to the edge, over those of its size; equal steps of arcsin(rho)."""
    error, integral = (np.cumsum(values[:, ::-1], axis=1)[:, ::-1] for values in (difference, np.abs(q)))
    return np.asarray(error / integral)


def _reading_errors(table: FlatPunchTable, share: float) -> tuple[FloatArray, FloatArray]:
    """What reading between rows adds to the errors of k_bar and c_bar, and between rows and columns to that of q.

    Args:
        table: The table.
        share: Part of the difference to the table without every other row and column that counts.
    """
    thin, xi = _every_other(table), table.ratios
    k = thin.normalized_contact_stiffness(xi) / table.stiffness - 1.0
    c = thin.normalized_spring_stiffness(xi) / table.normalized_spring_stiffness(xi) - 1.0
    q = thin.smooth_pressure(table.radii, xi[:, None]) - table.pressure * np.sqrt(1.0 - table.radii**2)
    shares = np.full(len(xi), share)
    # Splines end less well than they run.
    shares[-2:] = 2.0
    return shares * np.maximum(np.abs(k), np.abs(c)), shares[:, None] * np.abs(q)


def _every_other(table: FlatPunchTable) -> FlatPunchTable:
    """The table without every second row and column; the last row stays."""
    rows = slice((len(table.ratios) - 1) % 2, None, 2)
    return dataclasses.replace(
        table,
        ratios=table.ratios[rows],
        radii=table.radii[::2],
        stiffness=table.stiffness[rows],
        pressure=table.pressure[rows, ::2],
        error=table.error[rows],
        pressure_error=table.pressure_error[rows],
        mean_error=table.mean_error[rows, ::2],
    )


def _largest_nearby(difference: FloatArray, ratios: FloatArray) -> FloatArray:
    """The largest value over each row's neighbourhood, along axis 0."""
    rows = ceil(log(TABLES.nearby) / log(ratios[1] / ratios[0]))
    padded = np.pad(difference, ((rows, rows), *[(0, 0)] * (difference.ndim - 1)), mode="edge")
    return np.asarray(sliding_window_view(padded, 2 * rows + 1, axis=0).max(axis=-1))


def _provenance(settings: FftTable, table: FlatPunchTable) -> dict[str, str | int | float]:
    equation = "(29)" if table.support == "unbonded" else "(31)"
    nearby = f"its largest value within a factor of {TABLES.nearby:g} in a/h"
    own = table.stack is None
    return {
        "method": "FFT boundary elements, grid discs measured by the half-space",
        "kernel": f"{table.support}, Forsbach (2023) Eq. {equation}" if own else "stack of layers",
        "poissons_ratio": table.poissons_ratio,
        "cells": settings.cells,
        "box": f"free space to a/h = {THIN:g}, beyond it periodic with {IMAGE_GAP:g} h between images"
        if own
        else "free space",
        "error": f"difference to {settings.cells // 2} cells, {nearby}",
    }
