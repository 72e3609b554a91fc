"""Every coefficient that shapes an error stated from grids: direct contact, adhering discs, single cells, tables.

Stated errors are differences of grids, multiplied by shares that the order of convergence explains, and floors for what
two grids do not show. How well the results cover and how sharp they are is measured by ``contact-verify coverage`` and
asserted in ``tests/verification/test_boundary_elements.py`` and ``tests/bem/test_flat_punch_table.py``.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class DirectContactCoefficients:
    """They shape the stated errors of elastic contacts (`bem.method`).

    Each is beside the difference of the answers on all points and on half of them.
    """

    # Times the difference of what the slope of force over depth tells. Second order leaves a third of it; what cells
    # make of the slope is stated besides. Counted in full, the coarse grid's share of that made bars of measured
    # profiles 16 to 23 times too wide in the median (128 cells, seed 17, 2026-11-23).
    slope_difference: float = 1.0 / 3.0
    # A kink of the profile within this many cells of the contact edge, on either side, is not resolved.
    kink_cells: float = 6.0
    # Such a kink costs the radius this part of a cell over it, other quantities what the radius costs them. At a
    # prescribed depth force, radius and stiffness of a truncated cone were off by 0.07 s/a at most with the rim within
    # six cells, 0.023 s/a beyond (nu = 0.45, h/b = 0.6 and 4, 128 cells, rim 3 to 10 cells inside, 2026-11-22).
    kink_error: float = 0.1
    # Cells that must lie between the contact's edge and an upright end, a sphere's equator. At a given radius the depth
    # was off by 1.8 times the stated error at 0.8 cells, at a given depth the force by 5 times at 1.1 cells on 256
    # points and by 4 times at 2.3; at 4.7 all errors held (three layers, 128 and 256 points, against MDR, 2026-11-23).
    end_cells: float = 4.0
    # Times (s/a)^2 with the cell size s, because the difference may be small by accident: 0.01 was needed at most (200
    # steps of smooth profiles on 128 cells, seeds 1 and 5, 2026-11-22).
    second_order: float = 0.05
    # Times the difference of the pressures where the profile has a kink under pressure. Its logarithm, or the root
    # close to a flat end, is resolved with order one half, so the error is 1/(sqrt(2) - 1) = 2.4 times the difference
    # once cells are small against the distance of kink and edge; before, 3.8 times was needed at most (60 scenes on 128
    # cells, seed 77001, 2026-11-22).
    kink_difference: float = 4.0
    # Fields inside err by the difference of two grids, and `kink_difference` times as much beside edges, kinks, tips;
    # this is the length over which the one becomes the other, over the contact radius. With it 99.3 % of 1488 errors
    # were covered, 9.7 times in the median (seven contacts, 256 cells, a quarter of the points beside edges, seed 7,
    # against MDR, 2026-11-23).
    inside_near: float = 0.2
    # Times the difference of the displacements beside the contact, whose order of 1.6 from 128 to 256 cells leaves half
    # of it (60 scenes, seed 6, 2026-11-22).
    displacement: float = 0.6
    # A relative error of the contact radius counts this many times in the pressure. It is the largest growth of a
    # contact's pressure with its radius: on a thin incompressible layer p goes with a^4 and F_N with a^6.
    pressure_exponent: float = 6.0
    # Times (s/a)^2: what the radius read from the slope of force over depth may be off though both grids agree. Beyond
    # the other parts radii needed 0.09 on 512 cells, 0.14 on 256 and 0.18 on 128 (60 scenes, seed 4, 2026-11-22).
    slope_scatter: float = 0.3
    # Share of what is taken off the slope for its step beyond the half-space's that counts as an error of the radius:
    # the next power of both steps is 17 times 0.03 squared, 1.5 %, of it for every unit by which that varies faster;
    # chosen.
    excess_share: float = 0.1
    # Times a/h, up to a half, and what the wider step leaves on the half-space: how much more it may leave on a layer.
    # That was at most 2.6 at a/h = 0.1, 3.1 at 0.3 and 2.0 in all at 1 and 3 (`contact_edge`, 2026-11-23).
    excess_rest: float = 4.0
    # Times (s/a)^3 of the grid where that is measured: what its cells may make of a slope. Under r^4.7 and r^5 that was
    # 62 on 64, 128 and 256 cells (seed 9, 2026-11-22); the rest is a margin.
    excess_noise: float = 90.0
    # Times (s/a) (s/h)^2, for layers that are few cells thick. At h = s, 0.7 of it was needed with nu = 1/2 and 0.4
    # with nu = 0.3.
    thin_scatter: float = 0.05
    # An error of the radius counts in k_N by d ln(k_N)/d ln(a): 1 on the half-space, and growing from there with this
    # times a/h. It is 1.4 on an incompressible layer at a/h = 0.3, where it is fastest (integral equation, 2026-11-22).
    exponent_growth: float = 1.5
    # The largest that exponent becomes: k_N goes with a^4 on a thin incompressible layer, Eq. (21).
    largest_exponent: float = 4.0

    def scatter(self, cell: float) -> float:
        """Of the radius read from the slope, relative, from the cell's share s/a of it."""
        return self.slope_scatter * cell**2


@dataclass(frozen=True)
class AdheringDiscCoefficients:
    """They shape the stated errors of adhering contacts on discs of cells (`bem.adhesion.solver`).

    Measured on 30 detachments on 128 cells, a/h to 5, seed 1, 2026-11-22, unless something else is said.
    """

    # Times what second order leaves of the difference to half as many cells. Order 1.5 leaves 1.6 of it; where depth or
    # force cross over from one order to another up to 6.6 was needed.
    difference: float = 7.5
    # The same where stiffness and moment tell the edge values, to five and three eighths as many, of which the larger
    # counts: 95 of 100 pull-off forces needed less than 1.6 of it, of half as many cells alone 5.1, and 10 at most, for
    # two grids agree by accident (121 detachments on 96 and 128 cells, seeds 1401, 7105, 9001 and 9002, 2026-11-23).
    energy_difference: float = 1.75
    # Times the difference of the pressures to half as many cells. Order 1.5 leaves 0.55 of it.
    pressure_difference: float = 2.5
    # The same for the pressure where the profile has a kink under the contact, whose logarithm or root is resolved with
    # order one half: that leaves 2.4 of the difference, and 3.2 was needed where a truncated cone's rim lies just
    # inside the edge (unbonded layer, 96 cells, 2026-11-22).
    kink_difference: float = 4.0
    # Times what the last two orders of the branch's polynomials contribute. Those beyond, of profiles that begin with
    # an odd power, added up to three times as much.
    truncation: float = 2.5
    # Times what the last quarter of them contributes where the profile has breakpoints, whose orders fall like a power:
    # 0.7 was needed at most (10 tables of seeds 7104 and 7301, 2026-11-22).
    broken_truncation: float = 1.5
    # Times what the last quarter of those orders moves a pull-off of a profile with breakpoints: orders that fall with
    # their square leave three times as much beyond.
    broken_orders: float = 3.0
    # The same of other profiles, whose orders fall faster.
    energy_orders: float = 0.4
    # Relative error of depth and force by the linear solutions, which are solved to 1e-10; 2.5e-10 was needed at most
    # (22 detachments, seed 8501, 2026-11-22).
    floor: float = 5e-10
    # The same where stiffness and moment tell the edge values, of which one is stationary at the solution; errors of
    # weak adhesion, which no cell resolves, were 4e-11 at most (79 detachments, seeds 1401 and 9001, 2026-11-23).
    energy_floor: float = 4e-11
    # The same of a measured profile on the half-space, where polynomials follow integrals over it to 1e-12.
    known_floor: float = 1e-12
    # Times that floor: relative error of a radius at which depth or force is found least, for the square of the step of
    # slopes and for roundings.
    radius_floors: float = 2.0
    # Differences of grids cross zero along a branch, so the largest within this factor in the radius, either way,
    # counts.
    nearby: float = 1.5
    # Times (w/h)^3 and a/h, up to one each: what a fit over a ring of cells of width w leaves of the layer's part of an
    # edge value, which is of order a/h and changes over the thickness h, where two grids agree by accident. A flat
    # punch at a/h = 1 left 0.11 of it (2026-11-22).
    ring: float = 0.12
    # Times the difference of depth and force to what stiffness and moment tell of them (`bem.adhesion.energy_balance`),
    # which was 0.9 to 1.1 of the error where a layer counts, a/h from 0.1 to 5 (30 detachments, seed 7101, 2026-11-22).
    released: float = 2.0
    # Share of what extrapolation from two grids changes there that counts as its error. On 128 cells 0.03 of it was
    # left where a layer counts, as fourth order leaves it (20 detachments, seed 7104, 2026-11-22); what is stated more
    # is for coarser grids.
    extrapolated: float = 0.25
    # Times what so many last orders change there, whose derivatives are the largest; chosen, and measured as a whole.
    released_truncation: float = 2.0
    released_orders: int = 2


@dataclass(frozen=True)
class SingleCellCoefficients:
    """They shape the stated errors of adhering contacts that let go cell by cell (`bem.adhesion.cell_by_cell`)."""

    # Cells by which the area of a contact may tell a wrong radius: the largest seen from 128 to 1024 cells.
    area_scatter: float = 0.05
    # Cells by which the contact's edge may lag behind its equilibrium: one cell at most on either of the two grids.
    lag: float = 2.0
    # An error of the radius counts so many times in k_N: its exponent on a thin incompressible layer, Eq. (21).
    largest_exponent: float = 4.0


@dataclass(frozen=True)
class TableCoefficients:
    """They shape the stated errors of flat-punch tables (`bem.tables.from_grid`) and of what MDR makes of them."""

    # Added to the errors of q from the first row on, and to those of g, where q counts once itself and once by its
    # change over a/h: conjugate gradients stop at 1e-10 of the displacement, and on 64 and 128 cells q was off by half
    # of this at most, a tenth in the median (a/h = 1e-3 to 8, nu = 0.3 and 1/2, bonded and unbonded, against 1e-14,
    # 2026-11-22).
    pressure_floor: float = 4e-10
    # Added to the errors of k_bar, which is stationary at the solution: roundings of transforms and of the kernel,
    # measured at most 3e-13 (a/h = 1e-3, 16 to 256 cells, 2026-11-22).
    stiffness_floor: float = 5e-13
    # Share of the difference to the table of half as many cells that counts as error. Second order makes it 1/3, and
    # it counts in full.
    half_share: float = 1.0
    # Share of the difference of the tables of half and a quarter as many cells, for where the finer two agree by
    # accident: between what second order makes of it, 1/12, and first order, 1/2. Of the difference to the finest table
    # a quarter was too little where that passes zero, too: beside a sphere's equator (64 cells, 2026-11-26).
    quarter_share: float = 0.4
    # Times the share of the difference to fewer cells that the mean square distances of both discs leave of it in k_bar
    # (`calibrated_disc.PixelDisc.moment_error`), where the layer is many cells thick. That share itself was 0.8 to 1.3
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


DIRECT = DirectContactCoefficients()
DISCS = AdheringDiscCoefficients()
CELLS = SingleCellCoefficients()
TABLES = TableCoefficients()
