"""The linear complementarity problem of unilateral contact, solved exactly in finitely many steps.

    p >= 0,   g = C p - b >= 0,   p . g = 0,      C symmetric positive definite.

The primal-dual active set method (Hintermueller, Ito and Kunisch 2002) takes a handful of dense solves. It may cycle
in principle: when a set returns, the equivalent problem ``min |L^T p - L^-1 b|, p >= 0`` (C = L L^T) is solved by
Lawson and Hanson's non-negative least squares, which does not cycle. Every answer is checked against all conditions.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import cholesky, solve_triangular
from scipy.linalg.lapack import dposv

from contact import NotConvergedError
from contact.records.validation import BoolArray, FloatArray

# Largest accepted violation of a contact condition, relative to the largest pressure or overlap: roundings are 5e-16.
TOLERANCE = 1e-9
# Coefficients, highest power first, of the polynomial that maps the ratio of the last two pressures to the distance
# [cells] from the last pressed vertex to the contact edge; it errs by 0.06 cells.
EDGE_POLYNOMIAL = (0.11, 1.0, 0.04)


@dataclass(frozen=True)
class Complementary:
    """A checked solution.

    Attributes:
        pressure: p.
        gap: g.
        active: where p > 0 was allowed.
        iterations: active sets visited.
    """

    pressure: FloatArray
    gap: FloatArray
    active: BoolArray
    iterations: int


def solve_complementarity(
    compliance: FloatArray, approach: FloatArray, start: BoolArray | None = None
) -> Complementary:
    """Solve for p and g.

    Args:
        compliance: C, shape (n, n), symmetric positive definite.
        approach: b, shape (n,): how far the free surface would be overlapped.
        start: first guess of the active set; overlap where omitted.

    Raises:
        NotConvergedError: a condition is violated (C is not positive definite, or not finite).
    """
    diagonal = compliance.diagonal()
    active = approach > 0 if start is None else start
    seen: set[bytes] = set()
    for iteration in range(1, 61):
        pressure = _pressure(compliance, approach, active)
        following = diagonal * pressure > np.where(active, 0.0, compliance @ pressure - approach)
        if np.array_equal(following, active):
            return _checked(compliance, approach, pressure, active, iteration)
        if following.tobytes() in seen:
            break
        seen.add(following.tobytes())
        active = following
    active = _non_negative_least_squares(compliance, approach) > 0
    # The same set is solved again without the squared condition number.
    return _checked(compliance, approach, _pressure(compliance, approach, active), active, iteration)


def _pressure(compliance: FloatArray, approach: FloatArray, active: BoolArray) -> FloatArray:
    """Pressure with zero gap on the active set."""
    pressure = np.zeros_like(approach)
    if active.any():
        _, pressure[active], failed = dposv(compliance[np.ix_(active, active)], approach[active])
        if failed:
            raise NotConvergedError("the compliance is not positive definite", {"leading_minor": float(failed)})
    return pressure


def _non_negative_least_squares(compliance: FloatArray, approach: FloatArray) -> FloatArray:
    from scipy.optimize import nnls  # noqa: PLC0415 - takes 0.15 s to import, and few contacts need it

    lower = cholesky(compliance, lower=True)
    pressure, _ = nnls(lower.T, solve_triangular(lower, approach, lower=True), maxiter=30 * len(approach))
    return np.asarray(pressure)


def _checked(
    compliance: FloatArray, approach: FloatArray, pressure: FloatArray, active: BoolArray, iterations: int
) -> Complementary:
    gap = compliance @ pressure - approach
    # A flat punch that touches without pressing has neither overlap nor pressure.
    tiny = np.finfo(float).tiny
    overlap = max(np.abs(approach).max(), tiny)
    violations = {
        "tensile_pressure": -pressure.min() / max(np.abs(pressure).max(), tiny),
        "overlap": -gap.min() / overlap,
        "gap_under_pressure": np.abs(gap[active]).max(initial=0.0) / overlap,
    }
    if not all(violation <= TOLERANCE for violation in violations.values()):
        raise NotConvergedError("contact conditions are violated", violations)
    return Complementary(np.maximum(pressure, 0.0), np.where(active, 0.0, np.maximum(gap, 0.0)), active, iterations)


def edge_radius(radii: FloatArray, pressure: FloatArray) -> float:
    """Contact radius from the last two pressures that press, to a few hundredths of a cell.

    Next to its edge every smooth contact is the same problem of the half-plane, p = K sqrt(a - r). Solved on equal
    cells, the distance from the last pressed vertex to the true edge is one function of the ratio of the last two
    pressures, whatever K: `EDGE_POLYNOMIAL`. A last pressure above its neighbour belongs to a sharp edge, where the
    contact ends.
    """
    pressed = np.flatnonzero(pressure > 0)
    if not len(pressed):
        return 0.0
    last = int(pressed[-1])
    if last == 0:
        return float(radii[:2].mean())
    inner, outer = pressure[last - 1 : last + 1]
    if outer >= inner:
        return float(radii[last])
    return float(radii[last] + np.polyval(EDGE_POLYNOMIAL, outer / inner) * (radii[last] - radii[last - 1]))
