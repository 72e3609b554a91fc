"""A contact followed from one touching point to the next, forwards and backwards.

Between two touching points the set of pressed nodes does not change. A step therefore ends where the next node touches
or the last one leaves, or where a wanted depth or force is met before that.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from contact import InvalidInput
from contact.records.validation import FloatArray
from fem_reference.friction.step import (
    Control,
    RubbedContact,
    RubbedState,
    advance,
    at_depth,
    at_force,
    at_rest,
    touching,
)

# Nodes at the end of the strip that the contact does not reach: the last hat function is only half of one.
SPARE = 2
# A wanted value this close to a touching point, relative, lies before it.
CLOSE = 1e-12


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
