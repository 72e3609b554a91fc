"""The paper's own source of flat punches: FFT boundary elements on a grid of ratios, section 3.2 of Forsbach (2023)."""

from __future__ import annotations

import dataclasses
from functools import lru_cache
from math import ceil, log
from typing import Final, Self

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from bem.grid.calibrated_disc import GAP, THIN, PunchSolution, measured_disc
from bem.grid.error_model import TABLES
from bem.tables.table import LEAST_ROWS, FlatPunchTable, chebyshev_radii
from contact import ElasticLayer, InvalidInput, refuse_other_layers
from contact.records.record import Record, record
from contact.records.validation import FloatArray
from contact.scene.layer import Support

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

        Raises:
            InvalidInput: If the layer is a half-space or the ratio is beyond 1000.
        """
        plain = refuse_other_layers("the table of flat punches", layer)
        if plain.is_half_space:
            raise InvalidInput("a half-space has no a/h; its flat punch is known in closed form, Eq. (14)")
        grid = np.geomspace(SMALLEST_RATIO, LARGEST_RATIO, self.ratios)
        # A quotient of two lengths meant as 1000 may come out above it by rounding.
        if not 0.0 < max_ratio <= LARGEST_RATIO * (1.0 + 1e-12):
            raise InvalidInput(f"a/h = {max_ratio:g} is outside the table's range (0, {LARGEST_RATIO:g}]")
        rows = max(LEAST_HALVED, int(np.searchsorted(grid, max_ratio * (1.0 - 1e-12))) + 1 + BEYOND)
        # Poisson's ratio plays no part in the unbonded layer.
        poissons_ratio = plain.poissons_ratio if plain.support == "bonded" else 0.0
        return _build(self, plain.support, poissons_ratio, min(rows, self.ratios))

    def refined(self) -> Self:
        """A copy with half the cell size."""
        return dataclasses.replace(self, cells=2 * self.cells)


@lru_cache(maxsize=32)
def _build(settings: FftTable, support: Support, poissons_ratio: float, rows: int) -> FlatPunchTable:
    ratios = np.geomspace(SMALLEST_RATIO, LARGEST_RATIO, settings.ratios)[:rows]
    fine, half, quarter = (
        _on_grid(settings.cells // times, ratios, settings.radii, support, poissons_ratio) for times in (1, 2, 4)
    )
    row_share = float(np.clip(np.log(ratios[1] / ratios[0]) ** 2, TABLES.least_row_share, TABLES.largest_row_share))
    return dataclasses.replace(
        _with_errors(fine, half, settings.cells, row_share),
        provenance=_provenance(settings, support, poissons_ratio),
        variants=((TABLES.half_share, half), (TABLES.quarter_share, quarter), (row_share, _every_other(fine))),
    )


def _on_grid(cells: int, ratios: FloatArray, radii: int, support: Support, poissons_ratio: float) -> FlatPunchTable:
    """The table of one grid, its errors still unknown."""
    punches = _punches(cells, ratios, support, poissons_ratio)
    rho = chebyshev_radii(radii)
    q = np.array([np.polynomial.chebyshev.chebval(2.0 * rho**2 - 1.0, punch.shape) for punch in punches])
    return FlatPunchTable(
        support=support,
        poissons_ratio=poissons_ratio,
        ratios=ratios,
        radii=rho,
        stiffness=np.array([punch.stiffness for punch in punches]),
        pressure=np.maximum(q, 0.0) / np.sqrt(1.0 - rho**2),
        error=np.zeros(len(ratios)),
        pressure_error=np.zeros(len(ratios)),
        mean_error=np.zeros((len(ratios), radii)),
    )


def _punches(cells: int, ratios: FloatArray, support: Support, poissons_ratio: float) -> list[PunchSolution]:
    """One solution a ratio, each starting from the one before."""
    discs = {periodic: measured_disc(cells, periodic) for periodic in {False, ratios[-1] > THIN}}
    punches: list[PunchSolution] = []
    for ratio in ratios:
        start = punches[-1].pressure if punches else None
        punches.append(discs[bool(ratio > THIN)].solve(float(ratio), support, poissons_ratio, start))
    return punches


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
    """The largest error at any radius, relative to the largest q."""
    return np.asarray(np.max(difference, axis=1) / np.max(q, axis=1))


def _outwards(difference: FloatArray, q: FloatArray) -> FloatArray:
    """Relative errors of integrals from each radius to the edge; the radii are equally spaced in arcsin(rho)."""
    error, integral = (np.cumsum(values[:, ::-1], axis=1)[:, ::-1] for values in (difference, q))
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


def _provenance(settings: FftTable, support: Support, poissons_ratio: float) -> dict[str, str | int | float]:
    equation = "(29)" if support == "unbonded" else "(31)"
    nearby = f"its largest value within a factor of {TABLES.nearby:g} in a/h"
    return {
        "method": "FFT boundary elements, grid discs measured by the half-space",
        "kernel": f"{support}, Forsbach (2023) Eq. {equation}",
        "poissons_ratio": poissons_ratio,
        "cells": settings.cells,
        "box": f"free space to a/h = {THIN:g}, beyond it periodic with {GAP:g} h between images",
        "error": f"difference to {settings.cells // 2} cells, {nearby}",
    }
