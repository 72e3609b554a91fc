"""Contact without adhesion: the complementarity problem by preconditioned, constrained conjugate gradients.

With the gap `g = K p + f - delta` the unknown pressure satisfies, cell by cell,

    p >= 0,    g >= 0,    p g = 0,

which is the minimum of `p K p / 2 + p (f - delta)` over p >= 0; K is symmetric positive definite, so the answer is
unique. The scheme is of the Polonsky-Keer class: conjugate directions on the cells in contact, a step of exact length,
projection onto p >= 0; cells enter where the gap turns negative. Two things keep the iterations from growing with the
grid: the search direction is preconditioned by the inverse kernel, restricted to the contact (Vollebregt 2014,
J. Comput. Phys. 257, 431), and callers start from a coarser grid's answer.

With a prescribed force the depth is an unknown too: directions are kept free of net force, and the depth follows from
the same projection. The displacement follows each step and is computed afresh only where the projection acts.

Sums over cells mean the same on a whole grid and on a quadrant, whose cells each stand for four.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bem.grid.operators import Operator
from contact import InvalidInput, NotConvergedError
from contact.records.validation import BoolArray, FloatArray


@dataclass(frozen=True)
class GridSolution:
    """A pressure with its evidence.

    Attributes:
        pressure: p [Pa], shape (m, m).
        displacement: u = K p [m], right to a few roundings.
        indentation_depth: delta [m].
        iterations: Conjugate gradient steps.
        residual: What was asked to fall below the tolerance.
    """

    pressure: FloatArray
    displacement: FloatArray
    indentation_depth: float
    iterations: int
    residual: float


def solve_on_contact(
    operator: Operator,
    contact: BoolArray,
    displacement: FloatArray | float,
    *,
    start: FloatArray | None = None,
    tolerance: float = 1e-8,
    max_iterations: int = 200,
) -> GridSolution:
    """Linear problem of a known contact: K p = displacement on `contact`, p = 0 elsewhere; p may pull.

    Args:
        operator: K.
        contact: Cells in contact, shape (m, m).
        displacement: Prescribed there [m], shape (m, m) or a scalar.
        start: First guess of p [Pa].
        tolerance: Largest error of the displacement on the contact, relative to its largest value.
        max_iterations: Limit.

    Raises:
        InvalidInput: If no cell is in contact.
        NotConvergedError: If the tolerance was not met.
    """
    if not contact.any():
        raise InvalidInput("no cell is in contact; take a larger contact or smaller cells")
    target = np.where(contact, displacement, 0.0)
    scale = float(np.max(np.abs(target))) or 1.0
    p = np.zeros(contact.shape) if start is None else np.where(contact, start, 0.0)
    r = _restricted(target - operator.displacement(p), contact)
    v, rz = np.zeros(contact.shape), np.inf
    for iteration in range(max_iterations + 1):
        if (residual := float(np.max(np.abs(r))) / scale) <= tolerance:
            u = operator.displacement(p)
            return GridSolution(p, u, scale, iteration, residual)
        z = _restricted(operator.precondition(r), contact)
        rz_before, rz = rz, float(np.vdot(r, z))
        v = z + rz / rz_before * v
        q = _restricted(operator.displacement(v), contact)
        step = rz / float(np.vdot(v, q))
        p, r = p + step * v, r - step * q
    raise _not_converged(residual, tolerance, max_iterations)


def solve_contact(
    operator: Operator,
    height: FloatArray,
    *,
    depth: float | None = None,
    load: float | None = None,
    start: FloatArray | None = None,
    tolerance: float = 1e-7,
    max_iterations: int = 200,
) -> GridSolution:
    """The complementarity problem of a rigid indenter, either at a prescribed depth or under a prescribed load.

    Args:
        operator: K.
        height: f at the cell centres [m], shape (m, m).
        depth: delta [m]; or
        load: Sum of the pressure over the cells [Pa]: force over cell area, a quarter of it on a quadrant.
        start: First guess of p [Pa].
        tolerance: Largest violation of the complementarity, see `complementarity_residual`.
        max_iterations: Limit.

    Raises:
        InvalidInput: If not exactly one of depth and load is given and positive.
        NotConvergedError: If the tolerance was not met.
    """
    if (depth is None) == (load is None) or (depth or load or 0.0) <= 0.0:
        raise InvalidInput(f"prescribe either a positive depth or a positive load, got {depth} and {load}")
    p = _first_guess(height, depth, load) if start is None else np.maximum(start, 0.0)
    if load is not None:
        p = p * (load / p.sum())
    u = operator.displacement(p)
    if start is None and depth is not None:
        # The penetration says where a pressure is, but it is a length: of its multiples, the one of least energy.
        share = float(np.vdot(p, depth - height)) / (float(np.vdot(p, u)) or 1.0)
        p, u = share * p, share * u
    r_before = z_before = v = np.zeros(height.shape)
    for iteration in range(max_iterations + 1):
        delta = depth if depth is not None else _mean_depth(u + height, p)
        gap = u + height - delta
        residual = complementarity_residual(p, gap, delta)
        if residual <= tolerance:
            return GridSolution(p, u, delta, iteration, residual)
        contact = (p > 0.0) | (gap < 0.0)
        r = _restricted(-gap, contact)
        z = _restricted(operator.precondition(r), contact)
        if load is not None:
            z = _without_net_force(operator, z, contact)
        v = z + _polak_ribiere(r, z, r_before, z_before) * _restricted(v, contact)
        if load is not None:
            v = _restricted(v - v.sum() / np.count_nonzero(contact), contact)
        q = operator.displacement(v)
        step = float(np.vdot(r, v)) / float(np.vdot(v, q))
        p, u = p + step * v, u + step * q
        if p.min() < 0.0:
            p = np.maximum(p, 0.0)
            if load is not None:
                p = p * (load / p.sum())
            u = operator.displacement(p)
        r_before, z_before = r, z
    raise _not_converged(residual, tolerance, max_iterations)


def complementarity_residual(pressure: FloatArray, gap: FloatArray, depth: float) -> float:
    """max |min(p/p_max, g/delta)|: zero exactly where p >= 0, g >= 0 and p g = 0 in every cell."""
    peak = float(np.max(pressure))
    # A step may lift the indenter off for one iteration.
    shares = pressure / peak if peak > 0.0 else pressure
    return float(np.max(np.abs(np.minimum(shares, gap / depth))))


def _restricted(field: FloatArray, contact: BoolArray) -> FloatArray:
    return np.where(contact, field, 0.0)


def _not_converged(residual: float, tolerance: float, iterations: int) -> NotConvergedError:
    return NotConvergedError(
        f"no equilibrium to {tolerance:.1e} in {iterations} iterations; allow more or a larger tolerance",
        {"residual": residual},
    )


def _polak_ribiere(r: FloatArray, z: FloatArray, r_before: FloatArray, z_before: FloatArray) -> float:
    """Share of the last direction in the next; zero starts anew, as when cells have come or gone."""
    curvature = float(np.vdot(r_before, z_before))
    return max(0.0, float(np.vdot(z, r - r_before)) / curvature) if curvature > 0.0 else 0.0


def _without_net_force(operator: Operator, z: FloatArray, contact: BoolArray) -> FloatArray:
    """z less the answer to a uniform displacement, which is a change of depth."""
    uniform = _restricted(operator.precondition(contact.astype(np.float64)), contact)
    return np.asarray(z - z.sum() / uniform.sum() * uniform)


def _first_guess(height: FloatArray, depth: float | None, load: float | None) -> FloatArray:
    """The penetration of the undeformed surface, which a pressure is proportional to, or uniform near the tip."""
    if depth is None:
        return np.where(height <= np.quantile(height, 0.05), 1.0, 0.0)
    return np.maximum(depth - height, 0.0)


def _mean_depth(displacement_and_height: FloatArray, pressure: FloatArray) -> float:
    """The depth that closes the gap on average over the contact, weighted by the pressure."""
    return float(np.vdot(pressure, displacement_and_height) / pressure.sum())
