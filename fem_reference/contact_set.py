"""The linear complementarity problem of unilateral contact, solved exactly in finitely many steps.

    p >= 0,   g = C p - b >= 0,   p . g = 0,      C symmetric positive definite.

Here p are nodal pressures, and g and b moments of the gap and of the overlap (`surface.Surface`). The primal-dual
active set method (Hintermueller, Ito and Kunisch, SIAM J. Optim. 13 (2002) 865-888) takes a handful of dense solves. It
may cycle. When a set returns, only the wrong vertex of largest index changes from then on: such principal pivoting ends
for every positive definite C (Murty, Opsearch 11 (1974) 123-130). Every answer is checked against all conditions.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, TypeVar

import numpy as np
from scipy.linalg.lapack import dposv

from contact import NotConvergedError
from contact.records.validation import BoolArray, FloatArray, IntArray

# Largest accepted violation of a contact condition, relative to the largest pressure or overlap: roundings are 5e-16.
TOLERANCE = 1e-9
# Largest number of active sets. A handful suffice, and principal pivoting usually takes as many as there are vertices.
MOST_SETS = 1000
# Coefficients, highest power first, of the polynomial that maps the ratio of the last two pressures to the distance
# [cells] from the last pressed vertex to the contact edge; it errs by 0.06 cells.
EDGE_POLYNOMIAL = (0.11, 1.0, 0.04)
# Error, in cells, of a contact edge read from pressures: half of it is less than the polynomial errs.
EDGE_ERROR = 0.1


# A set as one value per vertex, and the solution on it.
Chosen = TypeVar("Chosen", BoolArray, IntArray)
Solved = TypeVar("Solved")


class LoadLine(NamedTuple):
    """Relation ``share delta + spring F = reach`` of depth and force at the end of a step, depths from any origin.

    A prescribed depth has the coefficients (1, 0), a prescribed force (0, 1).
    """

    share: float
    spring: float
    reach: float


class Complementary(NamedTuple):
    """Solution whose conditions are checked, arrays of shape (n,).

    Attributes:
        pressure: nodal pressures p.
        active: True at vertices where p > 0 is allowed and g = 0 is required.
    """

    pressure: FloatArray
    active: BoolArray


def settled(start: Chosen, follow: Callable[[Chosen], tuple[Solved, Chosen]]) -> Solved:
    """Solution on a set of vertices that follows from itself.

    Args:
        start: first guess of the set, one value per vertex, shape (n,).
        follow: function that returns the solution on a set, and the set that follows from the solution.

    Raises:
        NotConvergedError: no set follows from itself.
    """
    chosen, earlier_sets, is_cycling = start, set[bytes](), False
    for _ in range(MOST_SETS):
        solution, following = follow(chosen)
        wrong = np.flatnonzero(following != chosen)
        if not len(wrong):
            return solution
        is_cycling |= following.tobytes() in earlier_sets
        if is_cycling:
            following = np.where(np.arange(len(chosen)) == wrong[-1], following, chosen)
        earlier_sets.add(following.tobytes())
        chosen = following
    raise NotConvergedError(f"the contact set is not settled after {MOST_SETS} attempts")


def solve_complementarity(
    compliance: FloatArray, approach: FloatArray, start: BoolArray | None = None
) -> Complementary:
    """Pressures p of the complementarity problem, and the vertices that they press.

    Args:
        compliance: compliance C, shape (n, n), symmetric positive definite.
        approach: moments b of the overlap of the indenter with the unloaded surface, shape (n,).
        start: first guess of the active set, shape (n,); by default the vertices with b > 0.

    Raises:
        NotConvergedError: a condition is violated (C is not positive definite, or not finite).
    """
    line = LoadLine(1.0, 0.0, 0.0)
    return solve_on_line(compliance, -approach, 0.0 * approach, line, approach > 0 if start is None else start)[0]


def solve_on_line(
    compliance: FloatArray, gap: FloatArray, w: FloatArray, line: LoadLine, start: BoolArray
) -> tuple[Complementary, float]:
    """Pressures p for the approach ``b = delta w - gap`` at a depth delta that obeys the load line, and this depth.

    On an active set ``p = delta s - t`` with ``s = C^-1 w`` and ``t = C^-1 gap``, which determines the depth.

    Args:
        compliance: compliance C, shape (n, n), symmetric positive definite.
        gap: moments of the gap between the profile at depth zero and the unloaded surface, shape (n,).
        w: moments of the function one, shape (n,).
        line: relation of depth and force.
        start: first guess of the active set, shape (n,), not empty where a force is prescribed.

    Raises:
        NotConvergedError: a condition is violated (C is not positive definite, or not finite).
    """
    diagonal = compliance.diagonal()

    def follow(active: BoolArray) -> tuple[tuple[FloatArray, float, BoolArray], BoolArray]:
        """Pressures and depth on an active set, and the set on which ``p_i > g_i / C_ii``."""
        per_depth, at_zero = pressure_on(compliance, np.column_stack([w, gap]), active).T
        depth = (line.reach + line.spring * (w @ at_zero)) / (line.share + line.spring * (w @ per_depth))
        pressure = depth * per_depth - at_zero
        # On the active set g = 0, and off it p = 0.
        following = diagonal * pressure > np.where(active, 0.0, compliance @ pressure + gap - depth * w)
        return (pressure, float(depth), active), following

    pressure, depth, active = settled(start, follow)
    return _checked(compliance, depth * w - gap, pressure, active), depth


def pressure_on(compliance: FloatArray, approach: FloatArray, active: BoolArray) -> FloatArray:
    """Pressures, zero off the active set, that close gaps on it; negative where this needs tension.

    ``approach`` holds one gap (n,) or several (n, m), and the result has its shape.
    """
    pressure = np.zeros_like(approach)
    if active.any():
        _, pressure[active], failed = dposv(compliance[np.ix_(active, active)], approach[active])
        if failed:
            raise NotConvergedError("the compliance is not positive definite", {"leading_minor": float(failed)})
    return pressure


def _checked(compliance: FloatArray, approach: FloatArray, pressure: FloatArray, active: BoolArray) -> Complementary:
    """The solution, after its contact conditions were checked to `TOLERANCE`."""
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
    return Complementary(np.maximum(pressure, 0.0), active)


def edge_radius(radii: FloatArray, pressure: FloatArray) -> float:
    """Contact radius from the outermost two positive pressures, to a few hundredths of a cell; zero without pressure.

    Next to its edge every smooth contact is the same problem of the half-plane, with p proportional to sqrt(a - r).
    Solved on equal cells, the distance from the last pressed vertex to the true edge depends on the ratio of the last
    two pressures only: `EDGE_POLYNOMIAL`. If the last pressure exceeds its neighbour, the edge is sharp and the contact
    ends at the last vertex.

    Args:
        radii: radii of the vertices, equidistant at the edge, shape (n,).
        pressure: pressures at the vertices, shape (n,).
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
