"""Prescribed depths or forces of an adhering indenter, followed in their order from out of contact.

Adhesion of JKR type has no reach: an approaching indenter feels nothing until it touches, at delta = 0, and then snaps
in to the smallest stable contact. Pressed further or withdrawn, the edge moves along the stable branch; where that
ends it jumps, to another stable radius if there is one, or off. So what holds at a negative depth depends on the way
there: nothing on the way in, a contact on the way out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bem.adhesion.branch import DiscBranch
from bem.adhesion.equilibrium_branch import DEPTH, FORCE
from contact import FlatPunch, InvalidInput
from contact.records.validation import FloatArray


@dataclass(frozen=True)
class FollowedState:
    """One state of the history; a radius of zero is out of contact.

    Attributes:
        contact_radius: a [m].
        indentation_depth: delta [m].
        normal_force: F_N [N].
        contact_stiffness: k_N [N/m].
    """

    contact_radius: float
    indentation_depth: float
    normal_force: float
    contact_stiffness: float


def followed(branch: DiscBranch, quantity: int, values: FloatArray) -> list[FollowedState]:
    """The states at the values, one after the other.

    Raises:
        InvalidInput: If a force pulls that no contact can carry, or the contact outgrows the indenter.
    """
    states, radius = [], 0.0
    for entry, value in enumerate(values.tolist()):
        radius = _next_radius(branch, quantity, value, radius)
        if radius == 0.0 and quantity == FORCE:
            raise InvalidInput(
                f"loading.values = {value:g} (entry {entry}): no contact carries this tension; "
                "press first, and pull less than the pull-off force"
            )
        states.append(state(branch, quantity, value, radius))
    return states


def at_radii(branch: DiscBranch, radii: FloatArray) -> list[FollowedState]:
    """The equilibria with these contact radii [m], stable or not."""
    columns = (radii, branch.depth(radii), branch.force(radii), branch.stiffness(radii))
    return [FollowedState(*row) for row in np.column_stack(columns).tolist()]


def state(branch: DiscBranch, quantity: int, value: float, radius: float) -> FollowedState:
    """The state with this radius under the prescribed value; a flat punch may be held below its critical tension."""
    if radius == 0.0:
        return FollowedState(0.0, value, 0.0, 0.0)
    a = np.array([radius])
    stiffness = float(branch.stiffness(a)[0])
    if quantity == DEPTH:
        return FollowedState(radius, value, float(branch.force(a, np.array([value]))[0]), stiffness)
    # The force that holds the profile at no depth.
    unpressed = float(branch.force(a, np.zeros(1))[0])
    return FollowedState(radius, (value - unpressed) / stiffness, value, stiffness)


def _next_radius(branch: DiscBranch, quantity: int, value: float, radius: float) -> float:
    """The edge's next place [m], from where it is."""
    indenter, end = branch.scene.indenter, branch.largest_radius
    if radius == 0.0:
        if value < 0.0:
            return 0.0
        # A flat end touches at once.
        radius = indenter.flat_radius
    if radius > 0.0 and value < float(branch.value(quantity, np.array([radius]))[0]):
        return branch.crossing(quantity, value, (0.0, radius), inmost=False) or 0.0
    wider = branch.crossing(quantity, value, (radius, end), inmost=True)
    if wider is None and not isinstance(indenter, FlatPunch):
        raise InvalidInput(f"loading.values = {value:g}: the contact reaches the end of the indenter at {end:g} m")
    return end if wider is None else wider
