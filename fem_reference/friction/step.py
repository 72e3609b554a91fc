"""One step of a contact with friction: which nodes slide, and in which direction, at the end of the step.

Pressure p and radial traction q are piecewise linear on the strip, q > 0 pushes the layer outward, mu is Coulomb's
coefficient. At the end of a step, in the contact:

    u_z = delta - f,    |q| <= mu p,    stick |q| < mu p: Du_r = 0,    slip |q| = mu p: q Du_r <= 0,

with the change Du_r of the radial displacement in the step. A node that touches anew keeps the u_r of that instant: a
step ends where the next node touches. Displacements are imposed as moments ``int phi_i u 2 pi r dr``:

    Z_p p + Z_q q = delta w - f,    u_r = Z_q^T p + R_q q,

with the compliances of `Surface`; Z_q^T is reciprocity. Pressures and shears together are the tractions (2 n,), and the
moments of u_z and u_r together the displacements (2 n,) = C (p, q). A semismooth Newton method finds the sliding nodes:
a node slides if the traction that would keep it, ``q - Du_r / R_ii`` with the diagonal of R_q, exceeds mu p.

Between two touching points the set of pressed nodes does not change. A contact is followed, loading and unloading, in
steps that end where the next node touches, where the last one leaves, or where a depth or force is met before that.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

from contact import InvalidInput
from contact.answer.one_circle import no_single_circle
from contact.records.validation import FloatArray, IntArray
from fem_reference.contact_set import TOLERANCE, edge_radius, settled
from fem_reference.surface import Surface

# Fewest pressed nodes of contacts checked for tension and overlap: fewer do not resolve a pressure that is least on the
# axis, like that under r^4.
RESOLVED = 12
# A node whose traction differs from mu p by less than this share keeps its state: rounding must not decide where the
# slip reverses.
TIE = 1e-9
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
        coefficient: coefficient of friction mu; infinity for full stick.
        radius: radius L of the strip [m].
    """

    surface: Surface
    profile: FloatArray
    coefficient: float
    radius: float


@dataclass(frozen=True)
class RubbedState:
    """One equilibrium at the end of a step, in the units of `RubbedContact`.

    Attributes:
        contact: layer and indenter.
        depth: indentation depth delta / L.
        tractions: tractions p and q at the nodes, shape (2 n,).
        displacements: moments of u_z and u_r, shape (2 n,).
        touched: moments of u_r at the instant when each node touched, shape (n,); for free nodes the present ones.
        sliding: sign of q at sliding nodes, 0 at sticking nodes, shape (n,).
        active: number of pressed nodes, the first ones from the axis.
        force: normal force F / (E* L^2).
        work: work of the indenter since the start, over E* L^3.
        dissipated: heat of friction since the start, over E* L^3.
    """

    contact: RubbedContact
    depth: float
    tractions: FloatArray
    displacements: FloatArray
    touched: FloatArray
    sliding: IntArray
    active: int
    force: float = 0.0
    work: float = 0.0
    dissipated: float = 0.0

    @property
    def pressure(self) -> FloatArray:
        """p at the nodes, shape (n,)."""
        return self.tractions[: len(self.touched)]

    @property
    def shear(self) -> FloatArray:
        """q at the nodes, shape (n,)."""
        return self.tractions[len(self.touched) :]

    @property
    def radial(self) -> FloatArray:
        """Moments of u_r, shape (n,)."""
        return self.displacements[len(self.touched) :]

    @property
    def stored_energy(self) -> float:
        """Elastic energy (p . u_z + q . u_r) / 2 over E* L^3."""
        return float(self.tractions @ self.displacements) / 2.0

    @property
    def base_force(self) -> float:
        """Force on the base over E* L^2, which equals that of the indenter in equilibrium."""
        return float(self.contact.surface.base_forces @ self.tractions)

    @property
    def radius(self) -> float:
        """Contact radius over L, extrapolated from the pressures."""
        return edge_radius(self.contact.surface.radii, self.pressure)

    @property
    def stick_radius(self) -> float:
        """Stick radius c over L, extrapolated from the tractions at three nodes inside it.

        With r -> c ``y = 1 - |q|/(mu p)`` falls to zero like ``(c - r)^(3/2)`` where the stick region grows and like
        ``(c - r)^(1/2)`` where it shrinks. Hence y^(2/3) or y^2 is linear: the straighter one of these at three nodes
        is extrapolated to zero. The last sticking node is omitted, since it slid during a part of its step.
        """
        radii: FloatArray = self.contact.surface.radii
        last = int(np.flatnonzero(self.sliding[: self.active] == 0).max(initial=0))
        if last == self.active - 1:
            return float(radii[self.active])
        # Without the last node fewer than three nodes lie off the axis.
        if last < 4:
            return float(radii[last])
        near = slice(last - 3, last)
        margin = np.maximum(0.0, 1.0 - np.abs(self.shear[near]) / (self.contact.coefficient * self.pressure[near]))
        _, distance = min(_curvature_and_root(margin**power) for power in (2.0 / 3.0, 2.0))
        return float(radii[last - 1] + min(max(distance, 1.0), 3.0) * (radii[last] - radii[last - 1]))


def at_rest(contact: RubbedContact, *, work: float = 0.0, dissipated: float = 0.0) -> RubbedState:
    """The state without contact: zero tractions and displacements."""
    n = len(contact.profile)
    zero, both = np.zeros(n), np.zeros(2 * n)
    return RubbedState(contact, 0.0, both, both, zero, zero.astype(np.int64), 0, work=work, dissipated=dissipated)


# The equation that determines the end of a step: coefficients of the tractions (2 n,) and of the depth, and the
# right-hand side.
Equation: TypeAlias = tuple[FloatArray, float, float]


def touching(contact: RubbedContact, active: int) -> Equation:
    """Equation of a step that ends where the first free node touches: u_z = delta - f there, without pressure.

    In unloading the equation for one pressed node less determines when the last pressed node leaves.
    """
    surface = contact.surface
    return surface.compliance[active], -float(surface.resultants[active]), -float(contact.profile[active])


def at_load(contact: RubbedContact, load: float, *, by_depth: bool) -> Equation:
    """Equation ``delta = load`` or ``w . p = load`` of a step that ends at a depth over L or a force over E* L^2."""
    w = np.concatenate([contact.surface.resultants, np.zeros(len(contact.profile))])
    return (0.0 * w, 1.0, load) if by_depth else (w, 0.0, load)


def advance(before: RubbedState, active: int, end: Equation) -> RubbedState:
    """The equilibrium at the end of a step, with the first ``active`` nodes pressed.

    Raises:
        NotConvergedError: no set of sliding nodes satisfies the conditions.
        UnsupportedSceneError: tension at a pressed node, or overlap at a free node: the contact is no single circle.
    """

    def follow(sliding: IntArray) -> tuple[RubbedState, IntArray]:
        """The equilibrium with a set of sliding nodes, and the set that follows from it."""
        after = _equilibrium(before, sliding, active, end)
        return after, _sliding(before, after)

    return _accounted(before, settled(_first_guess(before, active), follow))


def _first_guess(before: RubbedState, active: int) -> IntArray:
    """First guess (n,) of the sliding nodes: those before the step; new nodes slide as their inner neighbour does."""
    sliding = before.sliding.copy()
    if active > before.active > 0 and math.isfinite(before.contact.coefficient):
        sliding[before.active : active] = sliding[before.active - 1]
    sliding[active:] = 0
    return sliding


def _equilibrium(before: RubbedState, sliding: IntArray, active: int, end: Equation) -> RubbedState:
    """The state at the end of a step with a given set of sliding nodes; the axis does not move and has no shear.

    Unknowns are the pressures of active nodes, the shears of sticking ones, and the depth; at the others q = s mu p
    with s = ``sliding``. The rows are ``Z_p p + Z_q q - delta w = -f`` at active nodes, ``Z_q^T p + R_q q = u_r`` as
    before at sticking nodes, and the equation ``end``.
    """
    contact, n = before.contact, len(sliding)
    compliance = contact.surface.compliance
    slides = sliding[:active] != 0
    stuck = 1 + np.flatnonzero(~slides[1:])
    friction = np.zeros(active)
    friction[slides] = contact.coefficient * sliding[:active][slides]
    unknown, pressures, shears = np.append(np.arange(active), n + stuck), slice(0, active), slice(n, n + active)
    row, depth_share, value = end
    size = len(unknown)
    matrix = np.zeros((size + 1, size + 1))
    matrix[:size, :size] = compliance[np.ix_(unknown, unknown)]
    matrix[:size, pressures] += compliance[unknown, shears] * friction
    matrix[size, :size] = row[unknown]
    matrix[size, pressures] += row[shears] * friction
    matrix[pressures, size], matrix[size, size] = -contact.surface.resultants[pressures], depth_share
    right = np.concatenate([-contact.profile[pressures], before.radial[stuck], [value]])
    solved = np.linalg.solve(matrix, right)
    tractions = np.zeros(2 * n)
    tractions[unknown] = solved[:size]
    tractions[shears] += friction * solved[pressures]
    return replace(
        before,
        depth=float(solved[size]),
        tractions=tractions,
        displacements=compliance @ tractions,
        sliding=sliding,
        active=active,
    )


def _sliding(before: RubbedState, after: RubbedState) -> IntArray:
    """Nodes that slide (n,), as in `RubbedState`: sign of the traction that would keep them, where it exceeds mu p.

    ``after`` was solved with its set of sliding nodes, which stays where the traction equals mu p to rounding.
    """
    contact, sliding, n = after.contact, after.sliding, len(after.sliding)
    if not math.isfinite(contact.coefficient):
        return np.zeros_like(sliding)
    sticking_traction = after.shear - (after.radial - before.radial) / contact.surface.compliance.diagonal()[n:]
    limit = contact.coefficient * np.maximum(after.pressure, 0.0)
    next_sliding = np.where(np.abs(sticking_traction) <= limit, 0.0, np.sign(sticking_traction)).astype(np.int64)
    tied = (np.abs(np.abs(sticking_traction) - limit) <= TIE * limit) & (sliding * sticking_traction >= 0.0)
    # u_r = 0 on the axis, and without pressure there is no friction.
    return np.where(tied | (np.arange(n) == 0) | (after.pressure <= 0.0), sliding, next_sliding)


def _accounted(before: RubbedState, after: RubbedState) -> RubbedState:
    """The state with its force, work and heat, after the conditions of contact were checked.

    The heat is -sum q_i Du_i over sliding nodes, with the changes Du of the moments of u_r. A node that slid in the
    same direction before the step slides under the mean of both tractions, a node that begins to slide in the step
    under the traction at its end. Neither contribution is negative.
    """
    _refuse_rings(after)
    steady = before.sliding == after.sliding
    traction = np.where(steady, (before.shear + after.shear) / 2.0, after.shear)
    heat = -(traction * (after.radial - before.radial))[after.sliding != 0]
    force = float(after.contact.surface.resultants @ after.pressure)
    return replace(
        after,
        force=force,
        touched=np.where(np.arange(len(traction)) < after.active, before.touched, after.radial),
        work=before.work + (before.force + force) / 2.0 * (after.depth - before.depth),
        dissipated=before.dissipated + float(heat.sum()),
    )


def _refuse_rings(state: RubbedState) -> None:
    """Refuse a negative pressure in the contact, and an overlap u_z < delta - f anywhere on the strip."""
    if state.active < RESOLVED:
        return
    contact, n = state.contact, len(state.sliding)
    depth_moments = state.depth * contact.surface.resultants
    gap = state.displacements[:n] - (depth_moments - contact.profile)
    pulled = state.pressure < -TOLERANCE * np.abs(state.pressure).max()
    wrong = pulled | (gap < -TOLERANCE * (np.abs(depth_moments).max() + np.abs(contact.profile).max()))
    if wrong.any():
        radius, contact_radius = (
            contact.radius * contact.surface.radii[i] for i in (int(np.argmax(wrong)), state.active)
        )
        kind = "would pull" if pulled.any() else "would overlap"
        raise no_single_circle(float(contact_radius), f"{kind} at r = {radius:g} m")


def grown(contact: RubbedContact) -> list[RubbedState]:
    """The states at touching points, in which node 1, 2, .. of the strip just touches, as the contact grows."""
    states = [at_rest(contact)]
    for active in range(1, len(contact.profile) - SPARE):
        states.append(advance(states[-1], active, touching(contact, active)))
    return states[1:]


def followed(contact: RubbedContact, targets: Sequence[float], *, by_depth: bool) -> list[RubbedState]:
    """States at consecutive depths over L or forces over E* L^2, from the first touch on.

    Raises:
        InvalidInput: the contact reaches the end of the strip.
    """
    state, active, states = at_rest(contact), 1, []
    for target in targets:
        state, active = _towards(state, active, target, by_depth)
        states.append(state)
    return states


def _towards(state: RubbedState, active: int, target: float, by_depth: bool) -> tuple[RubbedState, int]:
    """Equilibrium at one target, and the number of nodes pressed just before the target is reached.

    The contact advances from one touching point to the next: in loading one more node touches, in unloading the last
    one leaves. The last step ends at the target itself.

    Args:
        state: equilibrium at the previous target.
        active: number of nodes pressed just before the previous target.
        target: depth over L, or force over E* L^2.
        by_depth: whether the target is a depth.
    """
    start = state.depth if by_depth else state.force
    loading, contact = target > start, state.contact
    while target != start:
        next_active = active if loading else active - 1
        if next_active >= len(contact.profile) - SPARE:
            raise InvalidInput(f"contact reaches the end of the profile at {contact.radius:g} m; press less")
        event = advance(state, next_active, touching(contact, next_active)) if next_active else None
        event_load = (event.depth if by_depth else event.force) if event else 0.0
        if event is None or (target - event_load if loading else event_load - target) <= CLOSE * abs(target):
            is_held = event or (target > 0 and not by_depth)
            final = advance(state, active, at_load(contact, target, by_depth=by_depth)) if is_held else None
            if final is None or final.force < 0:
                return at_rest(contact, work=state.work, dissipated=state.dissipated), 1
            return final, active
        state, active = event, active + 1 if loading else active - 1
    return state, active


def _curvature_and_root(values: FloatArray) -> tuple[float, float]:
    """Curvature over slope of three equidistant values, and the distance beyond the last to the zero of their line."""
    before, middle, last = values
    if not middle > last:
        return math.inf, 1.0
    return abs(before - 2.0 * middle + last) / (middle - last), last / (middle - last)
