"""How far edge values of a ring are off: the branch told by its stiffness and moment alone, which know no edge.

By Eqs. (5) and (6) dk_N/da = 2 E* phi_1^2, and the moment M of a profile grows by dM/da = 2 phi_1 phi_f, with phi_1 and
phi_f the edge values under a unit depth and of the displacement f. Stiffness and moment are sums over all cells: they
converge with second order, and two grids extrapolate them. What this second route says of depth and force is the more
exact, except where a contact has hardly left a rim and where kinks slow its polynomials down; so of profiles
with breakpoints it is no answer, but tells the error of one; of others it is the answer (`branch.is_told_by_energy`).
"""

from __future__ import annotations

from typing import Final

import numpy as np

from bem.adhesion.branch import RIM, DiscBranch, is_told_by_energy
from bem.grid.error_model import DISCS
from contact.records.validation import BoolArray, FloatArray

# Up to so many radii of a flat end the moment beyond it hardly exists on the grid: there what is told of the force was
# off by more than the answer (scenes 3, 10, 24 and 26 of seed 7101, 2026-11-22). The tenth itself is chosen.
BESIDE_RIM: Final = 1.1
# Step of ln(a) for slopes and curvatures at a pull-off: they err by its square, 1e-4, and magnify roundings to 1e-12.
STEP: Final = 1e-2


def edge_errors(fine: DiscBranch, coarse: DiscBranch, radius: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Least and largest errors of depth [m] and force [N] by edge values at contact radii [m], each of shape (2, n).

    Where nothing is told, or the edge values are told by the same, they are zero and infinite.
    """
    if is_told_by_energy(fine.scene):
        return np.zeros((2, radius.size)), np.full((2, radius.size), np.inf)
    best = fine.extrapolated(coarse)
    told, rough, short = (_released(branch, radius) for branch in (best, fine, best.cut(DISCS.released_orders)))
    answer = np.stack([fine.depth(radius), fine.force(radius)])
    return _bounds(told - answer, rough - answer, short - answer, _is_smooth(fine, radius))


def _bounds(
    told: FloatArray, rough: FloatArray, short: FloatArray, is_smooth: BoolArray
) -> tuple[FloatArray, FloatArray]:
    """Least and largest errors by the differences from the answer: told, not extrapolated, and of fewer orders."""
    own = DISCS.extrapolated * np.abs(told - rough) + DISCS.released_truncation * np.abs(told - short)
    is_told = np.isfinite(own) & is_smooth
    least = np.where(is_told, np.abs(told) - own, 0.0)
    return np.maximum(least, 0.0), np.where(is_told, DISCS.released * np.abs(told) + own, np.inf)


def pull_off_errors(
    fine: DiscBranch, coarse: DiscBranch, controlled: FloatArray, lost: float, strongest: float
) -> tuple[FloatArray, FloatArray]:
    """Least and largest errors by edge values of a pull-off's numbers, each of shape (4,).

    These are depth [m], largest tension [N], ln(a), and the force [N] at the loss.

    The extremum of another branch lies where its slope less the answer's own, over the curvature, says.

    Args:
        fine: The branch of the answer.
        coarse: On half as many cells.
        controlled: Shares of depth and force [m/N] in what is controlled, shape (2,).
        lost: Radius [m] at which contact is lost: where that quantity is least, or a rim or the branch's end.
        strongest: Radius [m] of the least force.
    """
    if is_told_by_energy(fine.scene):
        return np.zeros(4), np.full(4, np.inf)
    held = lost >= (1.0 - RIM) * fine.largest_radius or abs(lost - fine.scene.indenter.flat_radius) < RIM * lost
    around = lost * np.exp((0.0 if held else STEP) * np.array([-1.0, 0.0, 1.0]))
    places = np.append(around, strongest)
    answer = np.stack([fine.depth(places), fine.force(places)])

    def numbers(branch: DiscBranch) -> FloatArray:
        """By how much they differ on this branch from the answer's."""
        other = _released(branch, places) - answer
        shift = 0.0 if held else -float(controlled @ _slope(other)) / float(controlled @ _curvature(answer))
        depth, force = _slope(answer) * shift
        moved = force if strongest == lost else 0.0
        return np.array([other[0, 1] + depth, other[1, 3] + moved, shift, other[1, 1] + force])

    best = fine.extrapolated(coarse)
    told, rough, short = (numbers(branch) for branch in (best, fine, best.cut(DISCS.released_orders)))
    return _bounds(told, rough, short, np.asarray(np.all(_is_smooth(fine, places))))


def _slope(values: FloatArray) -> FloatArray:
    """By ln(a), from values at the first and third place."""
    return np.asarray((values[:, 2] - values[:, 0]) / (2.0 * STEP))


def _curvature(values: FloatArray) -> FloatArray:
    """By ln(a), from values at the first three places."""
    return np.asarray((values[:, 2] - 2.0 * values[:, 1] + values[:, 0]) / STEP**2)


def _is_smooth(branch: DiscBranch, radius: FloatArray) -> BoolArray:
    """Whether moments converge regularly: a flat end left by a tenth or not at all."""
    flat = branch.scene.indenter.flat_radius
    return np.asarray((radius <= flat) | (radius > BESIDE_RIM * flat))


def _released(branch: DiscBranch, radius: FloatArray) -> FloatArray:
    """Depth [m] and force [N] of the equilibria by derivatives of stiffness and moment, shape (2, n)."""
    _, _, stiffness, moment = branch.values(radius)
    # At a rim, or where the polynomials fail, nothing is told.
    with np.errstate(divide="ignore", invalid="ignore"):
        by_stiffness, by_moment = branch.slopes(radius)
        depth = by_moment / by_stiffness - branch.critical_length(radius) / np.sqrt(0.5 * by_stiffness)
        return np.stack([depth, branch.scene.layer.contact_modulus * (stiffness * depth - moment)])
