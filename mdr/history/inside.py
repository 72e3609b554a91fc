"""The body at one instant of a history: stresses from what the springs carry then, displacements from how far they are.

The whole body relaxes alike at constant volume, so it is in equilibrium with the pressure of that instant as an elastic
one is, whatever went before: stresses follow from the spring forces f(x) alone. Displacements are those of an elastic
body of the instantaneous modulus whose springs stand as far out as the bed's do, pressed or creeping back: f(x) follows
from this u(x) spring by spring, by the one law of relaxation of the whole body, and u(x) holds all of the history.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from bem.layer_equation.half_space import HalfSpaceFlatPunch
from bem.layer_equation.inside.compared import DISPLACEMENTS, change, scales_of
from bem.layer_equation.inside.density import Piece
from bem.layer_equation.inside.interior import ContactInterior
from bem.layer_equation.inside.superposed import SpringForces, density_of_springs
from contact import FlatPunch
from contact.answer.inside import InsideFields, KnownContact
from contact.records.validation import FloatArray
from mdr.history.contact_edge import SpringBed, front
from mdr.history.followed import FollowedHistory
from mdr.history.runs import RESOLVED, runs_from, runs_to, spring_forces, value_at
from mdr.springs.error_model import HISTORY_SAFETY, PRESSURE_ROUNDING, SPRING_SHARES

# Power of the distance of springs with which fields err: the first at kinks, the second in smooth contacts. With the
# second 95 % of 650 fields were covered and those missed by up to twice, with the first bars are 20 times the error
# (60 depth histories, seed 77, against four times as many springs, 2026-11-22).
_ORDER = 1.5


@dataclass(frozen=True, eq=False)
class HistoryInterior:
    """Fields at one instant, on all springs and on shares of them, whose differences tell the error.

    Attributes:
        bodies: For each number of springs the body under the pressure, and that under springs as far out as they are.
        length: The smaller of contact radius and thickness [m].
        depth: delta [m].
    """

    bodies: tuple[tuple[ContactInterior, ContactInterior], ...]
    length: float
    depth: float

    @property
    def singular_edge(self) -> bool:
        """Whether the pressure is infinite at the edge of contact."""
        return self.bodies[0][0].density.edge_value > 0.0

    def at(self, radius: FloatArray, depth: FloatArray) -> InsideFields:
        """At points [m] of shape (n,)."""
        fine, *coarse = (_together(one.at(radius, depth), two.at(radius, depth)) for one, two in self.bodies)
        error = dict(fine.error_estimate)
        for kind, (names, scale) in scales_of(fine, self.length, self.depth).items():
            more = (share**-_ORDER - 1.0 for share in SPRING_SHARES[1:])
            changes = (change(fine, other, names) / excess for other, excess in zip(coarse, more, strict=False))
            error[kind] += HISTORY_SAFETY * max(changes) / (scale or math.inf)
        return replace(fine, error_estimate=error)


def interior_at(history: FollowedHistory, step: int) -> HistoryInterior:
    """The body at one instant of contact.

    Raises:
        InvalidInput: If the layer's flat punches hold no densities.
    """
    springs = [_springs(history, bed, step) for bed in history.beds]
    bodies = tuple((_interior(history, one, depth), _interior(history, two, depth)) for one, two, depth in springs)
    radius = bodies[0][0].known.radius
    return HistoryInterior(bodies, min(radius, history.scene.layer.thickness), springs[0][2])


def _together(stressed: InsideFields, moved: InsideFields) -> InsideFields:
    """Stresses of the one, displacements of the other."""
    displacements = {name: getattr(moved, name) for name in DISPLACEMENTS}
    error = {**stressed.error_estimate, "displacement": moved.error_estimate["displacement"]}
    return replace(stressed, **displacements, error_estimate=error)


def _interior(history: FollowedHistory, springs: SpringForces, depth: float) -> ContactInterior:
    """Of springs in metres."""
    scene = history.scene
    unit = springs.radius if scene.layer.is_half_space else scene.layer.surface.thickness
    ratio = springs.radius / unit
    solution = HalfSpaceFlatPunch() if scene.layer.is_half_space else history.flat_punch.solution(scene.layer, ratio)
    pieces = tuple(Piece(one.start / unit, one.length / unit, one.power) for one in springs.pieces)
    scaled = SpringForces(pieces, springs.slopes / unit, springs.edge_value / unit)
    density = density_of_springs(scene.layer, solution.one_contact(ratio), scaled)
    own = float(solution.spring_error(np.array(ratio))) + PRESSURE_ROUNDING
    known = KnownContact(springs.radius, 0.0, history.known + own + RESOLVED)
    return ContactInterior(scene, density, unit, depth / unit, known)


def _springs(history: FollowedHistory, bed: SpringBed, step: int) -> tuple[SpringForces, SpringForces, float]:
    """f and u of one bed at one instant [m], and the depth [m]."""
    state, speed = history.state(bed, step)
    forces, layer = history.law.force(state.surface, state.strains, speed), history.scene.layer
    longest = math.inf if layer.is_half_space else layer.surface.thickness
    if isinstance(history.scene.indenter, FlatPunch):
        one, two = (spring_forces(bed, [], float(v[0]), longest) for v in (forces, state.surface))
        return one, two, state.depth
    (y, _), at_front = front(history.law, bed, state, forces, speed)
    pressed = spring_forces(bed, runs_to(bed, forces, y, at_front), at_front, longest)
    surface = value_at(bed, state.depth - bed.profile, y)
    moved = [*runs_to(bed, state.surface, y, surface), *runs_from(bed, state.surface, y, surface)]
    return pressed, spring_forces(bed, moved, 0.0, longest), state.depth
