"""Coefficients of the stated errors of flat-punch tables."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class TableCoefficients:
    """They shape the stated errors of flat-punch tables (`bem.tables.from_grid`) and of what MDR makes of them."""

    # Added to the errors of q from the first row on, and to those of g, where q counts once itself and once by its
    # change over a/h: conjugate gradients stop at 1e-8 of the displacement, and on 64 and 128 cells q was off by half
    # of this at most, a tenth in the median (a/h = 1e-3 to 8, nu = 0.3 and 1/2, bonded and unbonded, against 1e-14,
    # 2026-11-22).
    pressure_floor: float = 4e-7
    # Added to the errors of k_bar, which is stationary at the solution: the influence of cells is computed to that.
    stiffness_floor: float = 1e-9
    # Share of the difference to the table of half as many cells that counts as error, the safety of all stated errors.
    # With half of it the stiffness of a sphere near its equator is up to 2.8 times beyond.
    half_share: float = 2.0
    # Share of the difference of the tables of half and a quarter as many cells, for where the finer two agree by
    # accident: between what second order makes of it, 1/12, and first order, 1/2. Of the difference to the finest table
    # a quarter was too little where that passes zero, too: beside a sphere's equator (64 cells, 2026-11-26).
    quarter_share: float = 0.8
    # Times the share of the difference to fewer cells that the mean square distances of both discs leave of it in k_bar
    # (`from_grid._moment_error`), where the layer is many cells thick. That share itself was 0.8 to 1.3
    # of the true one (64 and 128 cells, nu = 0.3 and 1/2, a/h = 0.01 to 3, 2026-11-22).
    moment_share: float = 2.0
    # Least size of that error, times the square of a cell over the radius, because it may vanish by accident: its size
    # from 16 to 512 cells was 0.003 to 0.097, 0.025 in the median (2026-11-22).
    least_moment: float = 0.025
    # Cells per thickness from which on that share holds, and below which the whole difference counts; between, it grows
    # with the logarithm. On 64 cells it held to 5 cells and failed at 3 (nu = 0.3 and 1/2, 2026-11-22).
    thick_cells: float = 12.0
    thin_cells: float = 4.0
    # The share of the difference to every other row and column is the spacing of the rows in ln(a/h), squared, within
    # these limits. Cubic splines gain 2^4 from half the spacing as soon as that is small against one, the distance in
    # ln(a/h) on which all functions vary.
    least_row_share: float = 1.0 / 64.0
    largest_row_share: float = 1.0 / 4.0
    # Differences cross zero, so the largest within this factor in a/h, either way, counts.
    nearby: float = 1.5


TABLES = TableCoefficients()
