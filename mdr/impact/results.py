"""What many impacts lead to: restitution, contact time and peaks, as arrays."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from bem.polynomials import chebyshev
from contact import NotConvergedError
from contact.records.validation import FloatArray
from mdr.impact.collocation import states
from mdr.impact.equations import ImpactBatch, force, outline
from mdr.impact.motion import Impacts, Leg
from mdr.impact.units import ScaledImpacts
from mdr.springs.error_model import (
    AGREEMENT_SHARES,
    COARSER_POWER,
    DEFAULT_ACCURACY,
    IMPACT_ROUNDING,
    LEAVING_SHARE,
    PROFILE_ROUNDING,
    SPRINGS_TO_MOTION,
)
from mdr.springs.table import MOMENT, PROFILE, STIFFNESS

# An indenter whose final speed is below this share of the approach speed has come to rest; chosen.
_REST = 1e-10
# Row of the contact time among the five outcomes.
_TIME = 1
# Chebyshev nodes of the force on each step: more than the state's degree of ten, since the force is a function of it.
_NODES = 14
_POWERS_FROM_VALUES = chebyshev.to_powers(_NODES) @ chebyshev.analysis(_NODES)


@dataclass(frozen=True, kw_only=True)
class ImpactResults:
    """Outcome of many impacts, each array of shape (n,).

    Attributes:
        coefficient_of_restitution: [-].
        contact_time: [s].
        peak_force: [N].
        peak_depth: [m].
        peak_contact_radius: [m].
        relative_error: Of these five, in this order, shape (5, n).
    """

    coefficient_of_restitution: FloatArray
    contact_time: FloatArray
    peak_force: FloatArray
    peak_depth: FloatArray
    peak_contact_radius: FloatArray
    relative_error: FloatArray


def results(scaled: ScaledImpacts, impacts: Impacts, accuracy: float) -> ImpactResults:
    """Back to SI units.

    Args:
        scaled: The impacts and their units.
        impacts: Their motions.
        accuracy: That was asked for, shape (n,) or one.

    Raises:
        NotConvergedError: If an indenter comes to rest in the layer.
    """
    lanes = impacts.lanes
    refuse_rest(impacts.end[3, : scaled.lanes.count], scaled.lanes.long_term)
    depth = np.empty(lanes.count)
    peak = np.zeros(lanes.count)
    for leg in impacts.way_in:
        own = lanes.take(leg.lanes)
        depth[leg.lanes] = own.springs(impacts.turn[:1, leg.lanes], leg.section, 1)[0, 0]
        peak[leg.lanes] = np.maximum(peak[leg.lanes], _peak_force(lanes, leg))
    radius = lanes.table.radius(impacts.turn[0] * lanes.units[6])
    both = np.stack([-impacts.end[3], impacts.end[1] + impacts.drift, peak, depth, radius])
    values, change = fine_and_change(both, accuracy, IMPACT_ROUNDING + _depth_rounding(scaled.lanes, depth))
    change += SPRINGS_TO_MOTION * lanes.table.error
    change[_TIME] += SPRINGS_TO_MOTION * lanes.table.error * leaving(values)
    return ImpactResults(
        # Rounded as the quotient of two speeds [m/s], which it is in a history.
        coefficient_of_restitution=values[0] * scaled.velocity / scaled.velocity,
        contact_time=values[1] * scaled.time,
        peak_force=values[2] * scaled.stiffness * scaled.depth,
        peak_depth=values[3] * scaled.depth,
        peak_contact_radius=values[4] * scaled.length,
        relative_error=change,
    )


def _depth_rounding(lanes: ImpactBatch, depth: FloatArray) -> FloatArray:
    """Rounding of g on the first panel of the table over the peak depth: a stiff dashpot stops a body far below it."""
    first = lanes.table.evaluate(lanes.table.functions.edges[1:2], 1)[PROFILE]
    return np.asarray(PROFILE_ROUNDING * first / (lanes.units[0] * depth[: lanes.count]))


def fine_and_change(
    both: FloatArray, accuracy: FloatArray | float, rounding: FloatArray | float = IMPACT_ROUNDING
) -> tuple[FloatArray, FloatArray]:
    """Outcomes of the first half of the lanes, and their errors as the second half, integrated more coarsely, tells.

    Two numbers may agree by chance, so an error is never stated far below what their steps were chosen for.

    Args:
        both: Restitution, contact time, peaks of force, depth and radius, shape (5, 2 n).
        accuracy: That was asked for, shape (n,) or one.
        rounding: Relative, shape (n,).
    """
    fine, coarse = np.split(both, 2, axis=1)
    chance = AGREEMENT_SHARES * accuracy * np.maximum(accuracy / DEFAULT_ACCURACY, 1.0) ** COARSER_POWER
    change = np.abs(fine - coarse) / np.abs(fine) + chance + rounding
    of_peaks = change[_TIME + 1 :].max(axis=0)
    change[_TIME] += LEAVING_SHARE * of_peaks * leaving(fine)
    return fine, change


def leaving(outcomes: FloatArray) -> FloatArray:
    """How much relative errors of the depth count in the contact time: the peak depth over the way at leaving speed."""
    restitution, time, _, depth, _ = outcomes
    return np.asarray(depth / (restitution * time))


def refuse_rest(final_velocity: FloatArray, long_term: FloatArray) -> None:
    """A layer without long-term stiffness may hold the indenter: what is left then is rounding, no rebound.

    Args:
        final_velocity: Over the approach speed, negative for a rebound, shape (lanes,).
        long_term: G_inf / G_0, shape (lanes,).
    """
    resting = np.flatnonzero((final_velocity >= 0.0) | ((long_term == 0.0) & (final_velocity > -_REST)))
    if resting.size:
        first = resting[0]
        why = (
            "it comes to rest in a layer that relaxes completely; give that a long-term shear modulus above zero"
            if long_term[first] == 0.0
            else "what viscosity leaves of its speed is lost in rounding; lower the viscosity or take a heavier body"
        )
        raise NotConvergedError(f"impact {first} does not rebound: {why}")


def force_on_way_in(lanes: ImpactBatch, leg: Leg, z: FloatArray) -> FloatArray:
    """Dimensionless force at z in [-1, 1] on every step, shape (len(z), steps, lanes)."""
    own = lanes.take(leg.lanes)
    state = states(leg.trajectory, z)
    shared, memory = outline(own.branches)
    flat = state.reshape(state.shape[0], -1, state.shape[-1])
    springs = own.springs(flat[0], leg.section, 5)
    taken = springs[MOMENT] + np.add.reduce(springs[STIFFNESS] * flat[shared] - flat[memory])
    return force(own, springs, springs[PROFILE], flat[2], taken).reshape(state.shape[1:])


def _peak_force(lanes: ImpactBatch, leg: Leg) -> FloatArray:
    """Largest force of each lane. A viscous layer relaxes at the turn, so it never comes after it."""
    values = force_on_way_in(lanes, leg, chebyshev.nodes(_NODES))
    present = np.arange(values.shape[1])[:, None] < leg.trajectory.counts
    return chebyshev.largest(np.einsum("ij,jsl->isl", _POWERS_FROM_VALUES, values), present)


def joined(parts: list[ImpactResults], order: NDArray[np.intp]) -> ImpactResults:
    """Several results as one, rearranged."""
    names = [field.name for field in fields(ImpactResults)]
    columns = {name: np.concatenate([getattr(part, name) for part in parts], axis=-1) for name in names}
    return ImpactResults(**{name: column[..., order] for name, column in columns.items()})
