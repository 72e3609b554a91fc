"""Every coefficient that shapes a stated error of the finite elements, in the order in which the errors are built up.

``tests/verification/test_fem_error_bars.py`` asserts that the stated errors cover the true ones.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from types import MappingProxyType


@dataclass(frozen=True)
class FixedRadiusCoefficients:
    """They shape the stated errors of stiffness, depth, force and pressure of a contact of given radius.

    At least 95 in 100 errors of random contacts are covered, less than ten times overestimated in the median.
    """

    # Safety factor on the error by interpolation, because the rate at which it falls is itself extrapolated.
    safety: float = 3.0
    # The error of degree 4 over that of degree 3 is typically this times growth^2, and a faster fall of a measured
    # change is taken for an accident: 0.12 in the median, above 0.076 in 95 of 100 numbers of random contacts.
    fastest_rate: float = 0.1
    # The error of degree 3 over that of degree 2, which two degrees alone cannot show, is below this times growth^3 in
    # 95 of 100 numbers (same contacts).
    unmeasured_rate: float = 0.4
    # The error of degree 4 over the last change is below the safety factor times this times growth^3 in 97 of 100
    # numbers (same contacts).  On the coarsest meshes it covers all 256 contacts with nu below 1/2 (random elastic
    # scenes of seeds 1 to 6 at accuracy 1e-2, 2026-11-22).
    coarse_rate: float = 0.3
    # The same from nu = 0.49 on, because the errors of incompressible layers fall slower on coarse meshes: by the rate
    # above, 38 of 42 depths were covered at nu = 1/2, the others off by up to 1.2 times what was stated (same scenes).
    incompressible_rate: float = 0.4
    # Before an upright end that is nearer than a tenth of the radius, depth and force err by up to so many times more:
    # meshes graded towards it are uneven.  Measured with MDR on 117 spheres 1e-10 to 0.1 before their equator at the
    # default settings and accuracies 1e-2 and 1e-4 (seed 77, 2026-11-26): without it 94 in 100 depths were covered, 85
    # in 100 at the default settings, and stated 2.2 times too large in the median; with it 69 of 70 (seed 78).
    before_end: float = 2.0
    # The unresolved singularity in the cell at the contact edge acts like a contact smaller by this share of the cell,
    # by the degree.  Measured for degree 4: 0.02 (nu = 1/2) to 0.055 (nu = 0), with the rings of cells beside it.
    edge_shift: MappingProxyType[int, float] = field(
        default_factory=lambda: MappingProxyType({2: 0.15, 3: 0.08, 4: 0.06})
    )
    # The stiffness lost to the outer edge of a bonded layer over the energy that a longer section would store.
    # Measured on meshes that end 1.5 to 4 thicknesses beyond the contact (nu = 0.3 and 1/2, a/h = 0.2 to 10,
    # 2026-11-22): 0.3 to 3.7.
    outer_edge_safety: float = 4.0
    # On an unbonded layer the outer edge costs this times exp(-2 s distance), s the rate of the bending-like mode.
    # Measured at distances of 1.5 and 2 thicknesses (nu = 0.3 and 1/2, a/h = 0.2 to 10, 2026-11-22): 0.25 to 2.0.
    unbonded_outer_edge: float = 5.0
    # Depth and force beside a flat end grow like the root of a - b but for this times (a - b) / min(b, h), relative.
    # Measured with MDR: 0.47 to 1.51 (cones and paraboloids, nu = 0, 0.3 and 1/2, h/b = 0.05 to infinity, 2026-11-22).
    narrowing: float = 2.0
    # A thick layer is stiffer than the half-space by at most 1.13 a/h, relative (bonded, nu = 1/2: k_bar = 1.0596 at
    # a/h = 0.05 by the integral equation), stated with a margin of six per cent.
    half_space: float = 1.2
    # Relative error of every number by rounding.  Chosen: a tenth of the backward error that linear solves are held to.
    rounding: float = 1e-12
    # The error of the pressure over its last change between degrees is this times the fall of the changes, within the
    # bounds below.  Measured on 136 states of random scenes (seeds 1 and 5, 2026-11-22): 0.04 to 0.55 where the changes
    # fall by ten or more, up to 0.9 where a large cell at a kink lets them fall by five to ten, up to 1.15 where they
    # hardly fall.
    pressure_per_fall: float = 10.0
    # The least and the largest value of that ratio, from the same measurement.
    pressure_bounds: tuple[float, float] = (0.6, 1.5)


@dataclass(frozen=True)
class LoadCoefficients:
    """They shape the stated errors of radius, depth, force and stiffness at a prescribed depth or force.

    Measured on random elastic scenes (`test_error_bars_at_a_load_are_sharp`).
    """

    # The stiffness changes at least by this share of what the change of the radius alone makes of it: a smaller one is
    # an accident.  Measured on 169 loads (109 random elastic scenes of seed 41 at the default settings and accuracies
    # 1e-2 to 1e-4, and 60 forces on a truncated cone, 2026-11-23): the two that were exceeded, 2.5 and 3.2 times, need
    # 0.07 and 0.14; all are covered, and stated errors grow by a tenth in the median.
    share_by_radius: float = 0.2
    # Relative error of the depth's slope, by which the last correction of the radius is made, due to the place where it
    # is read; no degree changes it.  Measured with MDR at growths of 0.35 and 1/2: at most 3e-4 on twelve contacts of
    # uniform layers, 4e-5 on eight of stacks (2026-11-23).
    read_slope: float = 4e-4
    # The same on graded layers, whose pressures have logarithms that rings of several widths do not tell: 4e-3 to 2e-2
    # (exponential and linear, paraboloid and truncated cone, 2026-11-23).
    read_slope_graded: float = 3e-2


@dataclass(frozen=True)
class BranchCoefficients:
    """They shape the stated errors of an adhesive branch and of its pull-off.

    Measured on 22 detachments (random adhesive scenes of seed 1 at accuracy 1e-3 and seed 3 at 1e-2, 2026-11-22), and
    asserted by `test_error_bars_of_pull_offs_are_sharp`.
    """

    # Factor on the error by the degree along the branch, because every solved radius has a mesh and an error of its
    # own, and a branch is made of a dozen.  Without it, three of 44 worst states were off by up to 1.3 times what was
    # stated (the 22 detachments above).  Pull-offs, at single places, do without it.
    scatter: float = 1.5
    # The place of an extremum errs by up to 2.1 times the root mean square of what the errors of the solved radii, each
    # with a sign of its own, tilt the load.  Measured on eight pull-offs of analytic profiles (`PULLED` of
    # ``tests/verification/test_fem_error_bars.py`` under both controls, and random adhesive scenes of seed 1 at
    # accuracy 1e-3, 2026-11-22): 0.06 to 2.1.
    slope_scatter: float = 2.5
    # The error by the degree passes zero now and then along a piece of a branch: at least this share of its root mean
    # square there is stated.
    share_of_mean: float = 0.7


@dataclass(frozen=True)
class HistoryCoefficients:
    """They shape the stated errors of impacts and histories.

    All peaks of random and designed impacts are covered; their median overestimate is about five.
    """

    # Half the cells change smooth profiles at least as much as the answer errs; errors of truncated profiles reach 1.3
    # times that change (measured), stated as twice.
    kinked_profile: float = 2.0
    # A channel's change is looked for where it exceeds this share of its peak: there the contact edge passes several
    # cells, so that two meshes cannot agree everywhere by accident.
    beside_peak: float = 0.9
    # A peak states at least this share of the largest change beside it: an error of second order in the cells is a
    # third to a fifth of what half the cells change.
    share_beside_peak: float = 1 / 3
    # The same of the largest contact radius, which is read from pressures on cells: it erred by up to 0.4 of the change
    # beside it where the edge jumps from cell to cell (70 impacts, seeds 9003, 9104 and 9105, 2026-11-22).
    radius_beside_peak: float = 0.5
    # Every number states at least this share of the mean change of all of them by half the cells.
    share_of_mean: float = 0.8
    # Contact ends when it is half a cell wide: the contact time of a cone is of first order in the cells, so that half
    # of them change it by what it errs; up to 1.05 times as much was needed (30 impacts, seed 9001, 2026-11-22).
    first_order: float = 1.25
    # Height at a cell over that at half a cell up to which a profile ends contact like a square or more slowly.  It is
    # chosen, a power of 2.07: a sphere exceeds a paraboloid's four by the square of the cell over its radius.
    squares: float = 4.2
    # Contact ends with some energy left in the last cell, which is uneven from mesh to mesh: the restitution erred by
    # up to 1.8 times what half the cells changed (69 impacts, seeds 9001 and 9002, 2026-11-22).
    uneven_end: float = 2.0
    # The end of a slow rebound is judged by the times in which the radius halves, if these take at least so many steps;
    # chosen: with fewer of them such a time is known to a quarter at best.
    steps_of_end: float = 4.0
    # Those times grow at most by this from one to the next, or else the series has no end.  The contact time of two
    # heavily damped rebounds was longer than computed by 5.5 and 1.1 times the last of them (same impacts).
    slowest_end: float = 0.9
    # Forces below so many roundings do not tell the end of contact.  A contact time was off by 0.055 with 616 steps,
    # where the last 0.07 of it passed below ten roundings (impact 9201:26 of ``contact-verify coverage``, 2026-11-22).
    roundings_of_end: float = 10.0
    # Factor on the truncation.  Chosen, and far on the safe side: a truncation of 1e-5 moved stiffness, depth and force
    # by at most 1.1e-5 (nu = 0.3 to 1/2, a/h = 0.2 to 300, 2026-11-22); at the usual 1e-7 the term adds 4e-6.
    outer_edge_safety: float = 40.0
    # Distance, in cells, between the true contact edge and the one read from the pressures, whose polynomial is good to
    # 0.06 cells. Largest radii that half the cells changed by less erred by up to 0.04, once by 0.11 (same impacts).
    edge_reading: float = 0.06
    # The same beside a kink, where pressures do not end like sqrt(a - r).
    edge_reading_at_kink: float = 1.0
    # How many cells from a kink count as beside it.
    kink_reach: float = 2.0
    # Safety factor on the changes of prescribed histories, whose first steps after a jump are of an order below one;
    # half of it misses depths just after a jump of force by a quarter, twice of it only widens.
    path_safety: float = 2.0
    # Every instant of a prescribed history states at least this share of the mean changes; half and twice of it change
    # stated errors by a tenth where they are smallest.
    share_of_path_mean: float = 0.2
    # Contact narrower than so many cells states the largest change while it is; the first cells err in every way.
    narrow_path: float = 8.0
    # Kinks below this share of a cell count as none.  Derived: a paraboloid with such a flat end is 4.03 times as high
    # at a cell as at half of it, four times without.
    unseen_kink: float = 0.05


@dataclass(frozen=True)
class InsideCoefficients:
    """They shape the stated errors of fields inside."""

    # The error of fields in a triangle over the largest change there from one degree to the next, by the degree that
    # answers. Measured on 60 contacts against MDR (five kinds of profile, growth 1/4 to 1, nu from 0 to 1/2, a/h from
    # 0.2 to 10, 1 to 100 points, seed 11, 2026-11-22). Degree 4: 0.05 in the median, 0.12 to 0.19 at 95 in 100, at most
    # 0.32; degree 3: 0.09 to 0.3, up to 1; degree 2 is changed by its error.
    share_of_change: MappingProxyType[int, float] = field(
        default_factory=lambda: MappingProxyType({2: 1.2, 3: 0.5, 4: 0.2})
    )
    # The gradient of the pressure, a derivative, errs by so many times more of its change: 0.26 at 95 in 100 for degree
    # 4 (same contacts).
    gradient: float = 1.5
    # Stresses and gradients in triangles that touch the axis, where no volume weighs an error, err by so many times
    # more: stresses by 1.04 of what was stated without this at 95 in 100 points on the axis, 2.5 at most (30 contacts,
    # seed 19103, 2026-11-22).
    on_axis: float = 1.8
    # The gradient there errs at least by this share of how far averages over triangles lie from the triangles' own
    # values.  Measured on the axis of 30 contacts (19102:52 and the first of seed 19104, 134 triangles, 2026-11-23):
    # the error is below 0.47 of that in 90 of 100.  By the change alone seven of the stated errors were exceeded, four
    # of them in the 38 triangles at the base; with this three, one of them there.
    jump_on_axis: float = 0.5


FIXED_RADIUS = FixedRadiusCoefficients()
AT_LOAD = LoadCoefficients()
ON_BRANCH = BranchCoefficients()
IN_TIME = HistoryCoefficients()
INSIDE = InsideCoefficients()
