"""How far edge values are off: the same branch told by its stiffness and moment alone, which know no edge.

By Eqs. (5) and (6) dk_N/da = 2 E* phi_1^2, and the moment M of a profile grows by dM/da = 2 phi_1 phi_f, with phi_1 and
phi_f the edge values under a unit depth and of the displacement f. Stiffness and moment are sums over all cells: they
converge with second order, and two grids extrapolate them. What this second route says of depth and force is the more
exact, except where a contact has hardly left a rim and where kinks slow its polynomials down; so it is no answer, but
tells the error of one.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from bem.adhesion.branch import DiscBranch
from bem.grid.error_model import DISCS
from bem.kernels.moduli import contact_modulus
from contact.records.validation import BoolArray, FloatArray

# Up to so many radii of a flat end the moment beyond it hardly exists on the grid: there what is told of the force was
# off by more than the answer (scenes 3, 10, 24 and 26 of seed 7101, 2026-11-22). The tenth itself is chosen.
BESIDE_RIM: Final = 1.1


def edge_errors(fine: DiscBranch, coarse: DiscBranch, radius: FloatArray) -> FloatArray:
    """Errors of depth [m] and force [N] by edge values at contact radii [m], shape (2, n); inf where none is told."""
    best = fine.extrapolated(coarse)
    told, rough, short = (_released(branch, radius) for branch in (best, fine, best.cut(DISCS.released_orders)))
    answer = np.stack([fine.depth(radius), fine.force(radius)])
    own = DISCS.extrapolated * np.abs(told - rough) + DISCS.released_truncation * np.abs(told - short)
    error = DISCS.released * np.abs(answer - told) + own
    return np.where(np.isfinite(error) & _is_smooth(fine, radius), error, np.inf)


def _is_smooth(branch: DiscBranch, radius: FloatArray) -> BoolArray:
    """Whether moments converge regularly: no kink, and a flat end left by a tenth or not at all."""
    indenter = branch.scene.indenter
    flat, kinked = indenter.flat_radius, any(r > indenter.flat_radius for r in indenter.breakpoints)
    return np.asarray((radius <= flat) | ((radius > BESIDE_RIM * flat) & (not kinked)))


def _released(branch: DiscBranch, radius: FloatArray) -> FloatArray:
    """Depth [m] and force [N] of the equilibria by derivatives of stiffness and moment, shape (2, n)."""
    _, _, stiffness, moment = branch.values(radius)
    # At a rim, or where the polynomials fail, nothing is told.
    with np.errstate(divide="ignore", invalid="ignore"):
        by_stiffness, by_moment = branch.slopes(radius)
        depth = by_moment / by_stiffness - branch.critical_length(radius) / np.sqrt(0.5 * by_stiffness)
        return np.stack([depth, contact_modulus(branch.scene.layer) * (stiffness * depth - moment)])
