"""What the springs of a bed carry as a function of the radius, smooth between breakpoints of the profile and fronts."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from bem.layer_equation.inside.density import Piece
from bem.layer_equation.inside.superposed import SpringForces
from bem.polynomials.gauss_panels import PANEL_NODES
from bem.polynomials.mapped import MappedFunction, MappedGrid
from contact.records.validation import FloatArray
from mdr.history.contact_edge import SpringBed, way_to_zero

# Polynomials in the radius meet the springs' values to this share of the largest; chosen, below what a history states.
RESOLVED = 1e-11
# Pieces are split down to this share of the radius, far less than the springs' distance; chosen.
_SMALLEST = 1e-6
# A spring closer to a front than this share of the springs' distance gives way to it: slopes between both are noise.
_APART = 0.5


class Run(NamedTuple):
    """Springs of one section and ends between them.

    Attributes:
        section: Number of the section.
        y: Front coordinates, increasing, shape (n,).
        values: Shape (n,).
    """

    section: int
    y: FloatArray
    values: FloatArray


def runs_to(bed: SpringBed, values: FloatArray, end: float, at_end: float) -> list[Run]:
    """Springs up to a front at y = end, with the value there."""
    runs: list[Run] = []
    for number, own in enumerate(bed.sections()):
        y = bed.y[own]
        if y[0] >= end and runs:
            break
        if y[-1] < end and own.stop < bed.y.size:
            runs.append(Run(number, y, values[own]))
            continue
        keep = y < end - _APART * bed.step(own.start)
        keep[0] = True
        runs.append(Run(number, np.append(y[keep], end), np.append(values[own][keep], at_end)))
    return runs


def runs_from(bed: SpringBed, values: FloatArray, begin: float, at_begin: float) -> list[Run]:
    """Springs beyond a front at y = begin out to where they are at rest: they fall to zero between two of them."""
    last = int(np.flatnonzero(values)[-1])
    if bed.y[last] <= begin:
        return []
    end = bed.y[last] + way_to_zero(values[bed.section(last).start : last + 1][::-1], bed.step(last))[0]
    runs: list[Run] = []
    for run in runs_to(bed, values, float(end), 0.0):
        keep = run.y > begin + (0.0 if runs else _APART * bed.step(bed.starts[run.section]))
        keep[-1] = run.y[-1] > begin
        if keep.any():
            first = ([begin], [at_begin]) if not runs else ([], [])
            runs.append(Run(run.section, np.append(first[0], run.y[keep]), np.append(first[1], run.values[keep])))
    return runs


def value_at(bed: SpringBed, values: FloatArray, y: float) -> float:
    """A smooth function of the springs' places at a front, from its section."""
    own = next(own for own in bed.sections() if y <= bed.y[own.stop - 1] or own.stop == bed.y.size)
    return float(CubicSpline(bed.y[own], values[own])(y))


def spring_forces(bed: SpringBed, runs: list[Run], edge_value: float, longest: float) -> SpringForces:
    """The function of the radius [m] that runs make, in pieces no longer than a length."""
    b = float(bed.radius[0]) if bed.core else 0.0
    flat = [Piece(start, stop - start, 1.0) for start, stop in pairwise(_cuts(0.0, b, longest))] if b else []
    none = np.zeros((len(flat), PANEL_NODES))
    if not runs:
        return SpringForces(tuple(flat), none, edge_value)
    grid = _grid(bed, runs, longest)
    found = _resolved(_Joined(bed, runs), grid)
    rows = zip(found.grid.left.tolist(), found.grid.width.tolist(), found.grid.power.tolist(), strict=True)
    pieces = [Piece(b + left, width, power) for left, width, power in rows]
    return SpringForces((*flat, *pieces), np.concatenate([none, found.node_slopes]), edge_value)


def _resolved(function: Callable[[FloatArray], FloatArray], grid: MappedGrid) -> MappedFunction:
    """Polynomials on pieces that are split until they meet the function at their ends, where they err most."""
    while True:
        found = MappedFunction(grid, function(grid.nodes), 0.0)
        piece, one = np.arange(grid.left.size), np.ones(grid.left.size)
        apart = np.abs(found.at(piece, 0.0 * one) - function(grid.left))
        apart = np.maximum(apart, np.abs(found.at(piece, one) - function(grid.left + grid.width)))
        coarse = (apart > RESOLVED * np.abs(found.node_values).max()) & (grid.width > _SMALLEST * grid.end)
        if not coarse.any():
            return found
        grid = grid.split(coarse)


def _grid(bed: SpringBed, runs: list[Run], longest: float) -> MappedGrid:
    """Pieces of the excess a - b; behind a breakpoint a root is mapped."""
    left: list[float] = []
    power: list[float] = []
    end = 0.0
    for run in runs:
        start, end = _excess(bed, run, run.y[[0, -1]])
        cuts = _cuts(start, end, longest)[:-1]
        left += cuts
        mapped = _behind_breakpoint(bed, run) and run.y[0] == bed.y[bed.starts[run.section]]
        power += [2.0 if mapped else 1.0, *[1.0] * (len(cuts) - 1)]
    return MappedGrid(np.array(left), np.diff(left, append=end), np.array(power), PANEL_NODES)


def _cuts(start: float, stop: float, longest: float) -> list[float]:
    count = max(1, math.ceil((stop - start) / longest))
    return [start + (stop - start) * i / count for i in range(count)] + [stop]


class _Joined:
    """Values at excesses a - b [m] of any shape, by cubics within each run."""

    def __init__(self, bed: SpringBed, runs: list[Run]) -> None:
        self.bed, self.runs = bed, runs
        self.splines = [CubicSpline(run.y, run.values) for run in runs]
        self.starts = np.array([_excess(bed, run, run.y[:1])[0] for run in runs])

    def __call__(self, excess: FloatArray) -> FloatArray:
        number: NDArray[np.intp] = np.maximum(self.starts.searchsorted(excess, side="right") - 1, 0)
        values = np.empty_like(excess)
        for i, (run, spline) in enumerate(zip(self.runs, self.splines, strict=True)):
            own = number == i
            values[own] = spline(_coordinate(self.bed, run, excess[own]))
        return values


def _behind_breakpoint(bed: SpringBed, run: Run) -> bool:
    return bool(bed.radius[bed.starts[run.section]] > 0.0)


def _excess(bed: SpringBed, run: Run, y: FloatArray) -> FloatArray:
    """a - b at y."""
    start = bed.starts[run.section]
    way = y - bed.y[start]
    return np.asarray(bed.radius[start] - bed.radius[0] + (way**2 if _behind_breakpoint(bed, run) else way))


def _coordinate(bed: SpringBed, run: Run, excess: FloatArray) -> FloatArray:
    """y at a - b."""
    start = bed.starts[run.section]
    way = np.maximum(excess - (bed.radius[start] - bed.radius[0]), 0.0)
    return np.asarray(bed.y[start] + (np.sqrt(way) if _behind_breakpoint(bed, run) else way))
