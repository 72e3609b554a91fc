"""What many impacts lead to: restitution, contact time and peaks, as arrays."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from contact import NotConvergedError
from contact.validation import FloatArray
from mdr.effects import chebyshev
from mdr.effects.collocation import states
from mdr.effects.impact_lanes import force, outline
from mdr.effects.impact_solver import Impacts, Leg
from mdr.effects.impact_units import ScaledImpacts
from mdr.effects.spring_table import PROFILE, STIFFNESS

_REST = 1e-10  # of the approach speed
_NODES = 14  # of the force on each step


@dataclass(frozen=True, kw_only=True)
class ImpactResults:
    """Outcome of many impacts, each array of shape (n,).

    Attributes:
        coefficient_of_restitution: [-].
        contact_time: [s].
        peak_force: [N].
        peak_depth: [m].
        peak_contact_radius: [m].
        relative_error: Estimate for all of them.
    """

    coefficient_of_restitution: FloatArray
    contact_time: FloatArray
    peak_force: FloatArray
    peak_depth: FloatArray
    peak_contact_radius: FloatArray
    relative_error: FloatArray


def results(scaled: ScaledImpacts, impacts: Impacts) -> ImpactResults:
    """Back to SI units.

    Raises:
        NotConvergedError: If an indenter comes to rest in the layer.
    """
    lanes = scaled.lanes
    refuse_rest(impacts.end[3], lanes.long_term)
    depth = np.empty(lanes.count)
    peak = np.zeros(lanes.count)
    for leg in impacts.way_in:
        own = lanes.take(leg.lanes)
        depth[leg.lanes] = own.springs(impacts.turn[:1, leg.lanes], leg.section, 1)[0, 0]
        peak[leg.lanes] = np.maximum(peak[leg.lanes], _peak_force(scaled, leg))
    return ImpactResults(
        coefficient_of_restitution=-impacts.end[3],
        contact_time=impacts.end[1] * scaled.time,
        peak_force=peak * scaled.stiffness * scaled.depth,
        peak_depth=depth * scaled.depth,
        peak_contact_radius=lanes.table.radius(impacts.turn[0] * lanes.units[6]) * scaled.length,
        relative_error=impacts.error,
    )


def refuse_rest(final_velocity: FloatArray, long_term: FloatArray) -> None:
    """A layer without long-term stiffness may hold the indenter: what is left then is rounding, no rebound.

    Args:
        final_velocity: Over the approach speed, negative for a rebound, shape (lanes,).
        long_term: G_inf / G_0, shape (lanes,).
    """
    resting = np.flatnonzero((final_velocity >= 0.0) | ((long_term == 0.0) & (final_velocity > -_REST)))
    if resting.size:
        raise NotConvergedError(
            f"impact {resting[0]} does not rebound: the indenter comes to rest in a layer that relaxes completely; "
            "give it a long-term shear modulus above zero"
        )


def force_on_way_in(scaled: ScaledImpacts, leg: Leg, z: FloatArray) -> FloatArray:
    """Dimensionless force at z in [-1, 1] on every step, shape (len(z), steps, lanes)."""
    own = scaled.lanes.take(leg.lanes)
    state = states(leg.trajectory, z)
    shared, memory, _ = outline(own.branches)
    flat = state.reshape(state.shape[0], -1, state.shape[-1])
    springs = own.springs(flat[0], leg.section, 5)
    branches = springs[STIFFNESS] * flat[shared] - flat[memory]
    return force(own, springs, springs[PROFILE], flat[2], branches).reshape(state.shape[1:])


def _peak_force(scaled: ScaledImpacts, leg: Leg) -> FloatArray:
    """Largest force of each lane. A viscous layer relaxes at the turn, so it never comes after it."""
    values = force_on_way_in(scaled, leg, chebyshev.nodes(_NODES))
    matrix = chebyshev.to_powers(_NODES) @ chebyshev.analysis(_NODES)
    present = np.arange(values.shape[1])[:, None] < leg.trajectory.counts
    return chebyshev.largest(np.tensordot(matrix, values, 1), present)


def joined(parts: list[ImpactResults], order: NDArray[np.intp]) -> ImpactResults:
    """Several results as one, rearranged."""
    names = [field.name for field in fields(ImpactResults)]
    return ImpactResults(**{name: np.concatenate([getattr(part, name) for part in parts])[order] for name in names})
