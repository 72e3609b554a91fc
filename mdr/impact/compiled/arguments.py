"""The right-hand sides as tables, lanes first."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from contact.records.validation import FloatArray
from mdr.impact.compiled.walk import FLAT, PRESSING, RECEDING, Equations
from mdr.impact.equations import ImpactBatch, Pressing, Receding
from mdr.impact.flat_punch_equations import FlatPunchBatch
from mdr.springs.table import SpringTable

Motion: TypeAlias = Pressing | Receding | FlatPunchBatch
# Rows of the table that motions need: g, dg/dy, k, dk/dy, P.
_ROWS = 5
_NOTHING = np.empty((0, 0)), np.empty((0, 0, 0))


def equations_of(problem: Motion) -> Equations:
    """The equations of one of the three kinds of motion."""
    if isinstance(problem, FlatPunchBatch):
        return Equations(FLAT, _numbers(problem), _branches(problem), _NOTHING[1], *_NOTHING)
    inverse: tuple[FloatArray, ...] = ()
    lanes, powers = problem.lanes, _NOTHING[1]
    if isinstance(problem, Receding) and problem.memory is not None:
        inverse, powers = problem.memory.within(problem.step, np.arange(lanes.count))
    numbers = _numbers(lanes, lanes.units[6], *lanes.units[:_ROWS], *inverse)
    powers = np.ascontiguousarray(powers[..., ::-1])
    kind = PRESSING if isinstance(problem, Pressing) else RECEDING
    return Equations(kind, numbers, _branches(lanes), powers, *_panels(lanes.table, problem.section))


def _numbers(own: ImpactBatch | FlatPunchBatch, *others: FloatArray) -> FloatArray:
    """Numbers of each lane in their columns."""
    return np.array([own.long_term, own.viscosity, own.inertia, *others]).T.copy()


def _branches(own: ImpactBatch | FlatPunchBatch) -> FloatArray:
    """Weights and rates."""
    return np.array([own.weights[:, 0], own.rates[:, 0]]).transpose(2, 0, 1).copy()


def _panels(table: SpringTable, section: int) -> tuple[FloatArray, FloatArray]:
    """Ends, centres and scales of a section's panels, and their powers."""
    functions, own = table.functions, slice(*table.section_panels[section : section + 2])
    panels = np.array([functions.edges[1:][own], functions.centres[own], functions.scales[own]]).T.copy()
    return panels, np.ascontiguousarray(functions.powers[::-1, :_ROWS, own].transpose(2, 0, 1))
