"""Adhesion of JKR type on a grid: cells let go at a stress that depends on the cell size (Pohrt and Popov 2015).

At the edge of an adhering contact the stress is singular, so no fixed strength can be a criterion; the work of adhesion
dgamma is. Let a square cell of size s carry the uniform stress tau. Relaxing it releases the elastic energy that this
stress holds in a half-space,

    U = (1/2) int tau u dA = kappa tau^2 s^3 / E*,
    kappa = (1/2) * mean over the unit square of (1/pi) int dA'/|r - r'|
          = (1/2 pi) int int dA dA'/|r - r'| = (2/3 pi) [1 - sqrt 2 + (3/2) ln((sqrt 2 + 1)/(sqrt 2 - 1))] = 0.473201,

and it lets go when this pays for the new surface, U = dgamma s^2, that is, when its tension exceeds

    tau_c = sqrt(E* dgamma / (kappa s)).

(The double integral over two points of a square: with x, y the differences of their coordinates, densities
2(1 - x) and 2(1 - y) on [0, 1], it is 4 int int (1 - x)(1 - y)/sqrt(x^2 + y^2) dx dy; in polar coordinates, twice the
octant 0 < phi < pi/4, this is elementary and gives the bracket times 4/3.) Close to its edge a layer answers like the
half-space, so the constant serves layers too as long as s is small against the thickness.

The path follows a decreasing depth: at each depth all cells of the rim beyond tau_c let go and the pressure is solved
anew until none is beyond it. Removing a cell raises the tension of its neighbours, so the order does not matter and
the largest contact in equilibrium is found. Where no contact is left in equilibrium, the indenter has pulled off; the
depth is found by smaller steps. A force-controlled indenter pulls off earlier, at the least force of this path. On
the way back in, cells of the rim join as long as they stay.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import log, pi, sqrt
from typing import Final

import numpy as np

from bem.grid.conjugate_gradients import solve_on_contact
from bem.grid.contact_edge import AREA_SHIFT
from bem.grid.operators import Operator
from bem.grid.quadrant import QuadrantGrid
from contact import NotConvergedError, StageLog
from contact.records.validation import BoolArray, FloatArray

# kappa, derived above.
CELL_ENERGY: Final = 2.0 / (3.0 * pi) * (1.0 - sqrt(2.0) + 1.5 * log((sqrt(2.0) + 1.0) / (sqrt(2.0) - 1.0)))
# Steps of the depth over the critical elongation at the start.
STEPS: Final = 40
# The depth of pull-off is found within this part of the critical elongation.
FOLD: Final = 2e-3
# A contact that shrinks below this part of its radius at a fixed depth is past the fold; below `LOST` it does not come
# to rest again.
COLLAPSE: Final = 0.7
LOST: Final = 0.1
# Under force control a path ends when its tension has fallen to this part of its largest, which is more than the grid's
# noise.
PAST_LEAST_FORCE: Final = 0.85
# Largest error of the displacement under the contact; with 1e-4 the pull-off force moves by 0.3 %.
SOLVER_TOLERANCE: Final = 1e-3


@dataclass(frozen=True)
class AdheringState:
    """A contact in equilibrium with its adhesion.

    Attributes:
        contact: Cells in contact, shape (m, m).
        pressure: p [Pa], negative where it pulls.
        indentation_depth: delta [m].
    """

    contact: BoolArray
    pressure: FloatArray
    indentation_depth: float


@dataclass(frozen=True)
class AdheringIndenter:
    """An indenter on a grid whose cells let go beyond a stress.

    Attributes:
        operator: K.
        grid: The quadrant.
        height: f on it [m].
        strength: tau_c [Pa].
        log: Stage log; counts the linear solutions.
    """

    operator: Operator
    grid: QuadrantGrid
    height: FloatArray
    strength: float
    log: StageLog

    def first_state(self, contact: BoolArray) -> AdheringState:
        """The depth at which the first cell of this contact lets go: p is linear in the depth, cell by cell."""
        unit = solve_on_contact(self.operator, contact, 1.0, tolerance=SOLVER_TOLERANCE).pressure
        if np.any(self.height[contact] != 0.0):
            flat = solve_on_contact(self.operator, contact, self.height, tolerance=SOLVER_TOLERANCE).pressure
        else:
            flat = np.zeros(unit.shape)
        edge = rim(contact)
        depth = float(np.max((flat[edge] - self.strength) / unit[edge]))
        return AdheringState(contact, depth * unit - flat, depth)

    def settle(self, state: AdheringState, depth: float, least_radius: float = COLLAPSE) -> AdheringState | None:
        """Equilibrium at `depth` reached by letting go from this state's contact.

        None if the contact shrinks below `least_radius` times its radius.
        """
        contact, pressure = state.contact, state.pressure
        least = least_radius**2 * np.count_nonzero(contact)
        while np.count_nonzero(contact) > least:
            answer = solve_on_contact(
                self.operator, contact, depth - self.height, start=pressure, tolerance=SOLVER_TOLERANCE
            )
            self.log.count("linear_solutions")
            pressure = answer.pressure
            leaving = rim(contact) & (pressure < -self.strength)
            if not leaving.any():
                return AdheringState(contact, pressure, depth)
            contact = contact & ~leaving
        return None

    def unload(self, start: AdheringState, enough: Callable[[list[AdheringState]], bool]) -> list[AdheringState]:
        """Stable states at decreasing depth, from `start` to pull-off or until `enough` says so.

        A contact that jumps may come to rest at a smaller radius; then the path goes on from there.
        """
        elongation = self._elongation(start)
        states = [start]
        landed: AdheringState | None = start
        while landed is not None:
            step = elongation / STEPS
            while step > FOLD * elongation and not enough(states):
                after = self.settle(states[-1], states[-1].indentation_depth - step)
                if after is None:
                    step /= 4.0
                else:
                    states.append(after)
            if enough(states):
                return states
            landed = self.settle(states[-1], states[-1].indentation_depth - 4.0 * step, LOST)
            states += [landed] if landed is not None else []
        return states

    def load(self, start: AdheringState, depths: FloatArray, within: BoolArray | bool = True) -> list[AdheringState]:
        """States at increasing depth: rings of cells join while they stay, which is the same equilibrium branch.

        Cells join only `within` the indenter's end.
        """
        states = [start]
        for depth in depths:
            state = states[-1]
            while True:
                wider = AdheringState(dilated(state.contact, 3) & within, state.pressure, float(depth))
                settled = self.settle(wider, float(depth))
                if settled is None:
                    raise NotConvergedError(f"no adhering contact at a depth of {depth:g} m; load from a larger one")
                grown = np.count_nonzero(settled.contact) > np.count_nonzero(state.contact)
                state = settled
                if not grown:
                    break
            states.append(state)
        return states[1:]

    def is_past_least_force(self, states: list[AdheringState]) -> bool:
        """Whether the tension has fallen again, by more than the grid's noise, from its largest on these states."""
        forces = [self.normal_force(state) for state in states]
        return forces[-1] > PAST_LEAST_FORCE * min(forces) > min(forces)

    def contact_radius(self, state: AdheringState) -> float:
        """a [m] of the area, which for a contact with a singular edge is that of the effective radius as well."""
        cells = 2.0 * sqrt(np.count_nonzero(state.contact) / pi) - AREA_SHIFT
        return self.grid.cell_size * cells

    def normal_force(self, state: AdheringState) -> float:
        """F_N [N]."""
        return 4.0 * self.grid.cell_size**2 * float(state.pressure.sum())

    def _elongation(self, state: AdheringState) -> float:
        """Depth scale of the detachment: that which brings the pressure of a flat punch to the strength at its rim."""
        unit = solve_on_contact(self.operator, state.contact, 1.0, tolerance=1e-2).pressure
        return self.strength / float(np.max(unit[rim(state.contact)]))


def strength(contact_modulus: float, work_of_adhesion: float, cell_size: float) -> float:
    """tau_c [Pa], see above."""
    return sqrt(contact_modulus * work_of_adhesion / (CELL_ENERGY * cell_size))


def rim(contact: BoolArray) -> BoolArray:
    """Cells of a quadrant's contact with a neighbour outside; its lower edges are mirrors, its upper ones are not."""
    padded = np.pad(np.pad(contact, ((1, 0), (1, 0)), mode="edge"), ((0, 1), (0, 1)))
    surrounded = padded[:-2, 1:-1] & padded[2:, 1:-1] & padded[1:-1, :-2] & padded[1:-1, 2:]
    return np.asarray(contact & ~surrounded)


def dilated(contact: BoolArray, rings: int) -> BoolArray:
    """The contact with that many rings of neighbours added, within the quadrant."""
    for _ in range(rings):
        padded = np.pad(np.pad(contact, ((1, 0), (1, 0)), mode="edge"), ((0, 1), (0, 1)))
        contact = padded[:-2, 1:-1] | padded[2:, 1:-1] | padded[1:-1, :-2] | padded[1:-1, 2:] | contact
    return np.asarray(contact)
