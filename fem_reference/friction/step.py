"""One step of a contact with friction: which nodes slide, and in which direction, at the end of the step.

Pressure p and radial traction q are piecewise linear on the strip, q > 0 pushes the layer outward, mu is Coulomb's
coefficient. At the end of a step, in the contact:

    u_z = delta - f,    |q| <= mu p,    stick |q| < mu p: Du_r = 0,    slip |q| = mu p: q Du_r <= 0,

with the change Du_r of the radial displacement in the step. A node that touches anew keeps the u_r of that instant: a
step ends where the next node touches. Displacements are imposed as moments ``int phi_i u 2 pi r dr``:

    Z_p p + Z_q q = delta w - f,    u_r = Z_q^T p + R_q q,

with the compliances of `Surface`; Z_q^T is reciprocity. A semismooth Newton method finds the sliding nodes: a node
slides if the traction that would keep it, ``q - Du_r / R_ii`` with the diagonal of R_q, exceeds mu p.

Between two touching points the set of pressed nodes does not change. A contact is followed, loading and unloading, in
steps that end where the next node touches, where the last one leaves, or where a depth or force is met before that.
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
# Fewer nodes do not resolve a pressure that is least on the axis, like that under r^4: such contacts are not checked.
RESOLVED = 12
# A node whose traction differs from mu p by less than this share keeps its state: rounding must not decide where the
# slip reverses.
TIE = 1e-9
# Sets of sliding points that are tried in one step; two to six suffice for contacts that grow.
MOST_SETS = 400
# Nodes at the end of the strip that the contact does not reach: the last hat function is only half of one.
SPARE = 2
# A prescribed load that exceeds that of a touching point by less than this share counts as not exceeding it.
CLOSE = 1e-12


@dataclass(frozen=True)
class RubbedContact:
    """The condensed layer and the indenter, lengths over the strip's radius L, stresses over E*.

    Attributes:
        surface: the condensed layer.
        profile: moments ``int phi_i f 2 pi r dr`` of the indenter's profile, shape (n,).
        coefficient: mu; infinity for full stick.
        radius: L [m].
    """

    surface: Surface
    profile: FloatArray
    coefficient: float
    radius: float

    def displacement(self, pressure: FloatArray, shear: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Moments of u_z and u_r, shape (n,) each, under pressures (n,) and radial tractions (n,)."""
        s = self.surface
        return s.pressed @ pressure + s.coupled @ shear, pressure @ s.coupled + s.rubbed @ shear

    def stored_energy(self, state: RubbedState) -> float:
        """Elastic energy (p . u_z + q . u_r) / 2 over E* L^3, with moments u_z and u_r."""
        normal, radial = self.displacement(state.pressure, state.shear)
        return float(state.pressure @ normal + state.shear @ radial) / 2.0


@dataclass(frozen=True)
class RubbedState:
    """One equilibrium at the end of a step, in the units of `RubbedContact`.

    Attributes:
        depth: delta / L.
        pressure: p at the nodes, shape (n,).
        shear: q at the nodes, shape (n,).
        radial: moments of u_r, shape (n,).
        touched: moments of u_r at the instant when each node touched, shape (n,); for free nodes the present ones.
        sliding: 0 where a node sticks, else the sign of q, shape (n,).
        active: number of pressed nodes, the first ones from the axis.
        force: F / (E* L^2).
        work: done by the indenter so far, over E* L^3.
        dissipated: heat of friction so far, over E* L^3.
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
    """The state without contact: zero tractions and displacements."""
    zero = np.zeros(len(contact.profile))
    return RubbedState(0.0, zero, zero, zero, zero, np.zeros(len(zero), dtype=np.int64), 0)


# The equation that determines the end of a step: coefficients of the active pressures and the depth (active + 1,), of
# all shears (n,), and the right-hand side.
Equation: TypeAlias = tuple[FloatArray, FloatArray, float]
Control: TypeAlias = Callable[[RubbedContact, int], Equation]


def touching(contact: RubbedContact, active: int) -> Equation:
    """The step ends where the first node that is not pressed touches: u_z = delta - f there, without pressure.

    In unloading the same equation, with one node less, is the instant at which the last pressed node leaves.
    """
    s = contact.surface
    row = np.append(s.pressed[active, :active], -s.resultants[active])
    return row, s.coupled[active], -float(contact.profile[active])


def at_depth(depth: float) -> Control:
    """The step ends at a depth over L."""
    return lambda contact, active: (np.append(np.zeros(active), 1.0), np.zeros(len(contact.profile)), depth)


def at_force(force: float) -> Control:
    """The step ends at a force over E* L^2: w . p = F."""
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
    """First guess (n,) of the sliding nodes: those before the step; new nodes slide as their inner neighbour does."""
    sliding = before.sliding.copy()
    if active > before.active > 0 and math.isfinite(coefficient):
        sliding[before.active : active] = sliding[before.active - 1]
    sliding[active:] = 0
    return sliding


def _equilibrium(
    contact: RubbedContact, before: RubbedState, sliding: IntArray, active: int, control: Control
) -> tuple[FloatArray, FloatArray, float]:
    """Pressure (n,), shear (n,) and depth with a given set of sliding nodes; the axis does not move and has no shear.

    Unknowns are the pressures of active nodes, the depth and the shears of sticking nodes; at the others q = s mu p
    with s = ``sliding``. The rows are, in this order, ``Z_p p + Z_q q - delta w = -f`` at active nodes, the equation of
    ``control``, and ``Z_q^T p + R_q q = u_r before`` at sticking nodes.
    """
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
    """Nodes that slide (n,), as in `RubbedState`: sign of the traction that would keep them, where it exceeds mu p.

    Args:
        contact: layer and indenter.
        pressure: p at the nodes, shape (n,).
        shear: q at the nodes, shape (n,).
        moved: change of the moments of u_r in the step, shape (n,).
        sliding: state with which these were solved, which stays where the traction equals mu p to rounding.
    """
    if not math.isfinite(contact.coefficient):
        return np.zeros_like(sliding)
    holding = shear - moved / contact.surface.rubbed.diagonal()
    limit = contact.coefficient * np.maximum(pressure, 0.0)
    found = np.where(np.abs(holding) <= limit, 0.0, np.sign(holding)).astype(np.int64)
    tied = (np.abs(np.abs(holding) - limit) <= TIE * limit) & (sliding * holding >= 0.0)
    # The axis does not move, and where nothing presses nothing holds.
    return np.where(tied | (np.arange(len(limit)) == 0) | (pressure <= 0.0), sliding, found)


def _accounted(contact: RubbedContact, before: RubbedState, after: RubbedState) -> RubbedState:
    """The state with its force, work and heat, after the conditions of contact were checked.

    The heat is -sum q_i Du_i over sliding nodes, with the changes Du of the moments of u_r. A node that slid in the
    same direction before the step slides under the mean of both tractions, one that began to slide in it under the
    last. Neither is negative.
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
    """Refuse a negative pressure in the contact, and an overlap u_z < delta - f anywhere on the strip."""
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
    """The states at touching points, in which node 1, 2, .. of the strip just touches, as the contact grows."""
    state, states = at_rest(contact), []
    for active in range(1, len(contact.profile) - SPARE):
        state = advance(contact, state, active, touching)
        states.append(state)
    return states


def followed(contact: RubbedContact, targets: Sequence[float], *, by_depth: bool) -> list[RubbedState]:
    """The states at depths over L or forces over E* L^2 that are reached one after the other, from the first touch on.

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
    """The state at one target, and the number of nodes that are pressed just before it is reached.

    Args:
        contact: layer and indenter.
        state: the state at the last target.
        active: number of nodes pressed just before that.
        target: depth or force.
        control: `at_depth` or `at_force`.
    """

    def measure(state: RubbedState) -> float:
        return state.depth if control is at_depth else state.force

    start = measure(state)
    if target == start:
        return state, active
    loading = target > start
    while True:
        ahead = active if loading else active - 1
        if not ahead and control is at_force and target > 0:
            return advance(contact, state, active, control(target)), active
        if not ahead:
            return at_rest_again(contact, state), 1
        if ahead >= len(contact.profile) - SPARE:
            raise InvalidInput(f"contact reaches the end of the profile at {contact.radius:g} m; press less")
        event = advance(contact, state, ahead, touching)
        short = target - measure(event) if loading else measure(event) - target
        if short <= CLOSE * abs(target):
            reached = advance(contact, state, active, control(target))
            return (reached, active) if reached.force >= 0 else (at_rest_again(contact, state), 1)
        state, active = event, active + 1 if loading else active - 1


def at_rest_again(contact: RubbedContact, state: RubbedState) -> RubbedState:
    """The state after the contact is lost; work and heat so far stay."""
    rest = at_rest(contact)
    return type(rest)(**{**vars(rest), "work": state.work, "dissipated": state.dissipated})


def stick_radius(contact: RubbedContact, state: RubbedState) -> float:
    """Stick radius c over L.

    Towards c ``y = 1 - |q|/(mu p)`` falls to zero like ``(c - r)^(3/2)`` where the stick region grows and like
    ``(c - r)^(1/2)`` where it shrinks. Hence y^(2/3) or y^2 is linear: the straighter one of these at three nodes is
    extrapolated to zero. The last sticking node is left out, since it slid during a part of its step.
    """
    radii: FloatArray = contact.surface.radii
    stuck = [i for i in range(state.active) if state.sliding[i] == 0]
    last = stuck[-1] if stuck else 0
    if last == state.active - 1:
        return float(radii[state.active])
    # Fewer than three nodes off the axis are left without the last one.
    if last < 4:
        return float(radii[last])
    near = slice(last - 3, last)
    spare = np.maximum(0.0, 1.0 - np.abs(state.shear[near]) / (contact.coefficient * state.pressure[near]))
    _, beyond = min(_bend_and_root(spare**power) for power in (2.0 / 3.0, 2.0))
    return float(radii[last - 1] + min(max(beyond, 1.0), 3.0) * (radii[last] - radii[last - 1]))


def _bend_and_root(values: FloatArray) -> tuple[float, float]:
    """Curvature over slope of three equidistant values, and the distance beyond the last to the zero of their line."""
    before, middle, last = values
    if not middle > last:
        return math.inf, 1.0
    return abs(before - 2.0 * middle + last) / (middle - last), last / (middle - last)
