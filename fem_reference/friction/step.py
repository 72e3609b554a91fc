"""One step of a contact with friction: which points slide, and which way, at the end of it.

At the end of a step, on the contact: u_z = delta - f; |q| <= mu p; where |q| < mu p the surface keeps the u_r that it
had at the end of the last step; elsewhere it has slid against q. q > 0 pushes the layer outward. Points that touch
anew keep the u_r they had when they touched: a step ends where the next point touches. Semismooth Newton's method finds
who slides: a point does if the traction that would hold it, ``q - (u_r - u_r before)/C``, exceeds mu p.

Between two touching points the set of pressed nodes does not change. A contact is followed, forwards and backwards, in
steps that end where the next node touches or the last one leaves, or where a depth or force is met before that.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

from contact import InvalidInput, NotConvergedError
from contact.answer.one_circle import no_single_circle
from contact.records.validation import FloatArray, IntArray
from fem_reference.surface import Surface

# Largest tension or overlap that is accepted as rounding, relative to the largest pressure or to the depth.
TOLERANCE = 1e-9
# Fewer nodes do not resolve a pressure that is least on the axis, like that under r^4, which seems to pull there with
# up to 7 nodes of 120 (random scenes of seed 7, 2026-11-22): such contacts are only passed through.
RESOLVED = 12
# A node within so much of its limit of friction stays as it is, so that rounding does not decide again and again where
# slip turns (1e-12 was too little there, random histories of seed 99, 2026-11-22).
TIE = 1e-9
# Sets of sliding points that are tried in one step; two to six suffice for contacts that grow (paraboloids, nu 0 to
# 1/2, mu 0.01 to 1, 2026-11-22), and some more where slip turns.
MOST_SETS = 400
# Nodes at the end of the strip that the contact does not reach: the last hat function is only half of one.
SPARE = 2
# A wanted value this close to a touching point, relative, lies before it.
CLOSE = 1e-12


@dataclass(frozen=True)
class RubbedContact:
    """What is pressed together, in units of the strip's radius [m] and of E*.

    Attributes:
        surface: the condensed layer.
        profile: moments ``int phi_i f 2 pi r dr`` of the indenter's profile, shape (n,).
        coefficient: mu; infinity for full stick.
        radius: of the strip [m].
    """

    surface: Surface
    profile: FloatArray
    coefficient: float
    radius: float

    def displacement(self, pressure: FloatArray, shear: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Moments of u_z and u_r."""
        s = self.surface
        return s.pressed @ pressure + s.coupled @ shear, pressure @ s.coupled + s.rubbed @ shear

    def stored_energy(self, state: RubbedState) -> float:
        """Half the work of the tractions on the displacements that they make."""
        normal, radial = self.displacement(state.pressure, state.shear)
        return float(state.pressure @ normal + state.shear @ radial) / 2.0


@dataclass(frozen=True)
class RubbedState:
    """One equilibrium.

    Attributes:
        depth: delta.
        pressure: p at the nodes, shape (n,).
        shear: q at the nodes, shape (n,).
        radial: moments of u_r, shape (n,).
        touched: their values where and when each node touched, shape (n,).
        sliding: 0 where a node sticks, else the sign of q, shape (n,).
        active: how many nodes carry pressure.
        force: F.
        work: done by the indenter.
        dissipated: energy turned into heat.
    """

    depth: float
    pressure: FloatArray
    shear: FloatArray
    radial: FloatArray
    touched: FloatArray
    sliding: IntArray
    active: int
    force: float = 0.0
    work: float = 0.0
    dissipated: float = 0.0


def at_rest(contact: RubbedContact) -> RubbedState:
    """Nothing is pressed yet."""
    zero = np.zeros(len(contact.profile))
    return RubbedState(0.0, zero, zero, zero, zero, np.zeros(len(zero), dtype=np.int64), 0)


# The last equation of a step: a row for the pressures of the active nodes and the depth, one for all shears, a value.
Equation: TypeAlias = tuple[FloatArray, FloatArray, float]
Control: TypeAlias = Callable[[RubbedContact, int], Equation]


def touching(contact: RubbedContact, active: int) -> Equation:
    """The step ends where the first node that is not pressed touches."""
    s = contact.surface
    row = np.append(s.pressed[active, :active], -s.resultants[active])
    return row, s.coupled[active], -float(contact.profile[active])


def at_depth(depth: float) -> Control:
    """The step ends at a depth."""
    return lambda contact, active: (np.append(np.zeros(active), 1.0), np.zeros(len(contact.profile)), depth)


def at_force(force: float) -> Control:
    """The step ends at a force."""
    return lambda contact, active: (
        np.append(contact.surface.resultants[:active], 0.0),
        np.zeros(len(contact.profile)),
        force,
    )


def advance(contact: RubbedContact, before: RubbedState, active: int, control: Control) -> RubbedState:
    """The equilibrium at the end of a step, with the first ``active`` nodes pressed.

    Raises:
        NotConvergedError: no set of sliding nodes was found.
        UnsupportedSceneError: a node is pulled, or another one would be overlapped: no single circle.
    """
    sliding = _first_guess(before, active, contact.coefficient)
    seen: set[bytes] = set()
    for _ in range(MOST_SETS):
        pressure, shear, depth = _equilibrium(contact, before, sliding, active, control)
        radial = contact.displacement(pressure, shear)[1]
        found = _sliding(contact, pressure, shear, radial - before.radial, sliding)
        if np.array_equal(found, sliding):
            after = replace(before, depth=depth, pressure=pressure, shear=shear, radial=radial, sliding=found)
            return _accounted(contact, before, replace(after, active=active))
        sliding = found if found.tobytes() not in seen else _one_changed(sliding, found)
        seen.add(sliding.tobytes())
    raise NotConvergedError(f"the sliding part of the contact is not settled after {MOST_SETS} attempts")


def _one_changed(sliding: IntArray, found: IntArray) -> IntArray:
    """The set in which only the outermost wrong node has changed: principal pivoting (Murty 1974) does not cycle."""
    last = int(np.flatnonzero(found != sliding)[-1])
    return np.where(np.arange(len(found)) == last, found, sliding)


def _first_guess(before: RubbedState, active: int, coefficient: float) -> IntArray:
    """As before the step; new nodes slide as their neighbour does."""
    sliding = before.sliding.copy()
    if active > before.active > 0 and math.isfinite(coefficient):
        sliding[before.active : active] = sliding[before.active - 1]
    sliding[active:] = 0
    return sliding


def _equilibrium(
    contact: RubbedContact, before: RubbedState, sliding: IntArray, active: int, control: Control
) -> tuple[FloatArray, FloatArray, float]:
    """Pressure, shear and depth with a given set of sliding nodes; the axis does not move and has no shear."""
    s, own = contact.surface, slice(0, active)
    slides = sliding[own] != 0
    stuck = np.flatnonzero(~slides)
    stuck = stuck[stuck > 0]
    friction = np.zeros(active)
    friction[slides] = contact.coefficient * sliding[own][slides]
    row, shear_row, value = control(contact, active)
    matrix = np.zeros((active + 1 + len(stuck), active + 1 + len(stuck)))
    right = np.concatenate([-contact.profile[own], [value], before.radial[stuck]])
    matrix[own, own] = s.pressed[own, own] + s.coupled[own, own] * friction
    matrix[own, active] = -s.resultants[own]
    matrix[own, active + 1 :] = s.coupled[own, stuck]
    matrix[active, : active + 1] = row
    matrix[active, own] += shear_row[own] * friction
    matrix[active, active + 1 :] = shear_row[stuck]
    matrix[active + 1 :, own] = s.coupled[own, stuck].T + s.rubbed[stuck, own] * friction
    matrix[active + 1 :, active + 1 :] = s.rubbed[np.ix_(stuck, stuck)]
    solved = np.linalg.solve(matrix, right)
    pressure, shear = np.zeros(len(contact.profile)), np.zeros(len(contact.profile))
    pressure[own] = solved[own]
    shear[own] = friction * pressure[own]
    shear[stuck] = solved[active + 1 :]
    return pressure, shear, float(solved[active])


def _sliding(
    contact: RubbedContact, pressure: FloatArray, shear: FloatArray, moved: FloatArray, sliding: IntArray
) -> IntArray:
    """Which nodes friction does not hold, by the sign of the traction that would; at a tie what ``sliding`` says."""
    if not math.isfinite(contact.coefficient):
        return np.zeros_like(sliding)
    holding = shear - moved / contact.surface.rubbed.diagonal()
    limit = contact.coefficient * np.maximum(pressure, 0.0)
    found = np.where(np.abs(holding) <= limit, 0.0, np.sign(holding)).astype(np.int64)
    tied = (np.abs(np.abs(holding) - limit) <= TIE * limit) & (sliding * holding >= 0.0)
    # The axis does not move, and where nothing presses nothing holds.
    return np.where(tied | (np.arange(len(limit)) == 0) | (pressure <= 0.0), sliding, found)


def _accounted(contact: RubbedContact, before: RubbedState, after: RubbedState) -> RubbedState:
    """With force and energies, after all conditions of contact were checked.

    What slid the same way before and after the step did so under the mean of both tractions, what just began to slide
    under the last one; neither gives energy back.
    """
    _refuse_rings(contact, after)
    moved = after.radial - before.radial
    steady = before.sliding == after.sliding
    traction = np.where(steady, (before.shear + after.shear) / 2.0, after.shear)
    heat = -(traction * moved)[after.sliding != 0]
    force = float(contact.surface.resultants @ after.pressure)
    touched = np.where(np.arange(len(moved)) < after.active, before.touched, after.radial)
    return replace(
        after,
        force=force,
        touched=touched,
        work=before.work + (before.force + force) / 2.0 * (after.depth - before.depth),
        dissipated=before.dissipated + float(heat.sum()),
    )


def _refuse_rings(contact: RubbedContact, state: RubbedState) -> None:
    if state.active < RESOLVED:
        return
    gap = contact.displacement(state.pressure, state.shear)[0] - (
        state.depth * contact.surface.resultants - contact.profile
    )
    scale = np.abs(state.depth * contact.surface.resultants).max() + np.abs(contact.profile).max()
    pulled = state.pressure < -TOLERANCE * np.abs(state.pressure).max()
    overlapped = gap < -TOLERANCE * scale
    if (wrong := pulled | overlapped).any():
        place, end = (contact.radius * contact.surface.radii[i] for i in (int(np.argmax(wrong)), state.active))
        kind = "would pull" if pulled.any() else "would overlap"
        raise no_single_circle(float(end), f"{kind} at r = {place:g} m")


def grown(contact: RubbedContact) -> list[RubbedState]:
    """The states in which each node of the strip touches, as the contact grows."""
    state, states = at_rest(contact), []
    for active in range(1, len(contact.profile) - SPARE):
        state = advance(contact, state, active, touching)
        states.append(state)
    return states


def followed(contact: RubbedContact, targets: Sequence[float], *, by_depth: bool) -> list[RubbedState]:
    """The states at depths or forces that are reached one after the other, from the first touch on.

    Raises:
        InvalidInput: the contact reaches the end of the strip.
    """
    state, active, states = at_rest(contact), 1, []
    control = at_depth if by_depth else at_force
    for target in targets:
        state, active = _towards(contact, state, active, target, control)
        states.append(state)
    return states


def _towards(
    contact: RubbedContact, state: RubbedState, active: int, target: float, control: Callable[[float], Control]
) -> tuple[RubbedState, int]:
    """On to one target; ``active`` is how many nodes are pressed just before it."""

    def measure(state: RubbedState) -> float:
        return state.depth if control is at_depth else state.force

    start = measure(state)
    if target == start:
        return state, active
    loading = target > start
    while True:
        ahead = active if loading else active - 1
        if not ahead:
            return at_rest_again(contact, state), 1
        if ahead >= len(contact.profile) - SPARE:
            raise InvalidInput(f"contact reaches the end of the profile at {contact.radius:g} m; press less")
        event = advance(contact, state, ahead, touching)
        short = target - measure(event) if loading else measure(event) - target
        if short <= CLOSE * abs(target):
            return advance(contact, state, active, control(target)), active
        state, active = event, active + 1 if loading else active - 1


def at_rest_again(contact: RubbedContact, state: RubbedState) -> RubbedState:
    """The contact is lost; what was dissipated stays."""
    rest = at_rest(contact)
    return type(rest)(**{**vars(rest), "work": state.work, "dissipated": state.dissipated})


def stick_radius(contact: RubbedContact, state: RubbedState) -> float:
    """Radius, over the strip's, of the outermost point that sticks.

    Inside the end c of the stick ``1 - |q|/(mu p)`` falls to zero like ``(c - r)^(3/2)`` where the stick spreads and
    like ``(c - r)^(1/2)`` where it shrinks: of the two laws, the one that makes the straighter line of three nodes. The
    last node that sticks does not count, since it slid for a part of its step.
    """
    radii: FloatArray = contact.surface.radii
    stuck = [i for i in range(state.active) if state.sliding[i] == 0]
    last = stuck[-1] if stuck else 0
    if last == state.active - 1:
        return float(radii[state.active])
    # Three nodes off the axis are left beside the last one.
    if last < 4:
        return float(radii[last])
    near = slice(last - 3, last)
    spare = np.maximum(0.0, 1.0 - np.abs(state.shear[near]) / (contact.coefficient * state.pressure[near]))
    _, beyond = min(_bend_and_root(spare**power) for power in (2.0 / 3.0, 2.0))
    return float(radii[last - 1] + min(max(beyond, 1.0), 3.0) * (radii[last] - radii[last - 1]))


def _bend_and_root(values: FloatArray) -> tuple[float, float]:
    """How much three values at equal distances bend, and how many distances beyond the last the line is zero."""
    before, middle, last = values
    if not middle > last:
        return math.inf, 1.0
    return abs(before - 2.0 * middle + last) / (middle - last), last / (middle - last)
