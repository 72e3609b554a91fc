"""Prescribed depth or force in time on a (visco)elastic layer, the contact set solved in every step."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from contact import NotConvergedError
from contact.records.validation import BoolArray, FloatArray
from fem_reference.elastic.active_set import Complementary, solve_complementarity
from fem_reference.elastic.contact_search import edge_radius
from fem_reference.in_time.condensed_layer import CondensedLayer
from fem_reference.in_time.impact import HistorySamples
from fem_reference.in_time.relaxation import ShearRelaxation
from fem_reference.in_time.relaxation_step import INSTANT, RelaxationStep, relaxation_step

# Steps of a segment between given instants: at least one in so many of the whole history, and at least four.
# Half as many segments' steps double the error of a ramp that is short; twice as many cost as much time again.
LEAST_SHARE = 20
LEAST_STEPS = 4


def segment_steps(time: FloatArray, steps: int, coarser: int) -> list[int]:
    """Equal steps of each segment between given instants.

    Args:
        time: given instants [s].
        steps: about how many steps in all; short segments add some.
        coarser: 1, or 2 for exactly half the steps, whose instants are every other one.
    """
    share = np.diff(time) / (time[-1] - time[0]) * steps / 2
    least = max(LEAST_STEPS, steps // (2 * LEAST_SHARE))
    return [2 // coarser * max(least, round(float(s))) for s in share]


def simulate_prescribed(
    condensed: CondensedLayer,
    relaxation: ShearRelaxation,
    time: FloatArray,
    values: FloatArray,
    counts: list[int],
    *,
    by_depth: bool,
) -> HistorySamples:
    """Response to depths or forces that are linear between the given instants; a first load above zero acts at once.

    Args:
        condensed: the layer at rest and its indenter.
        relaxation: shear relaxation.
        time: instants [s].
        values: depths or forces at these instants, in the units of the condensed layer.
        counts: equal steps of each segment.
        by_depth: whether ``values`` are depths.

    Raises:
        NotConvergedError: no depth carries the force.
    """
    record, surface, depth = HistorySamples(), condensed.surface, 0.0
    active: BoolArray | None = None

    def advance(step: RelaxationStep, load: float) -> Complementary:
        """Pressures at the end of a step to this load; the memory and the depth move on."""
        nonlocal depth, active
        matrix, offset = surface.begin(step)
        if by_depth:
            approach = load * surface.resultants - condensed.profile - offset
            state, depth = solve_complementarity(matrix, approach, active), load
        else:
            state, depth = _depth_of_force(matrix, surface.resultants, condensed.profile + offset, load, depth)
        surface.accept(step, state.pressure)
        active = state.active
        return state

    for n, ((t0, t1), (v0, v1), count) in enumerate(zip(pairwise(time), pairwise(values), counts, strict=True)):
        step = relaxation_step(relaxation, (t1 - t0) / count)
        active = None
        if n == 0 and v0 > 0:
            _add(record, condensed, advance(step.instant, float(v0)), t0, depth)
        elif n == 0:
            start = float(v0) if by_depth else 0.0
            record.add(time=float(t0), depth=start, force=0.0, radius=0.0, stored=0.0, dissipated=0.0)
        if by_depth and step.dashpot > 0:
            # The rates jump with that of the depth.
            advance(step.instant, v0 + (v1 - v0) * INSTANT / count)
            active = None
        for k in range(1, count + 1):
            # The last instant and its load are the given ones, to the bit.
            now = t1 if k == count else t0 + (t1 - t0) * k / count
            load = float((1.0 - k / count) * v0 + k / count * v1)
            _add(record, condensed, advance(step.first if k == 1 else step, load), now, depth)
    return record


def _depth_of_force(
    matrix: FloatArray, w: FloatArray, gap: FloatArray, force: float, depth: float
) -> tuple[Complementary, float]:
    """Contact with a given resultant: Newton's method on the convex, piecewise linear F(delta)."""
    # The depth of first touch.
    least = float(np.min(gap / w))
    if force == 0:
        return solve_complementarity(matrix, least * w - gap), min(depth, least)
    depth, change = max(depth, least + 1e-9 * abs(least) + 1e-15), np.inf
    for _ in range(60):
        state = solve_complementarity(matrix, depth * w - gap)
        defect = force - float(w @ state.pressure)
        # A force far below the layer's own stresses is known to the rounding of its depth only.
        if abs(defect) <= 1e-10 * force or abs(change) <= 1e-14 * abs(depth):
            return state, depth
        act = state.active if state.active.any() else gap / w <= depth + 1e-12
        block = matrix[np.ix_(act, act)]
        change = defect / float(w[act] @ np.linalg.solve(block, w[act]))
        depth += change
    raise NotConvergedError("no depth carries the prescribed force", {"force_defect": defect})


def _add(record: HistorySamples, condensed: CondensedLayer, state: Complementary, time: float, depth: float) -> None:
    record.add(
        time=float(time),
        depth=float(depth),
        force=float(condensed.surface.resultants @ state.pressure),
        radius=edge_radius(condensed.radii, state.pressure),
        stored=condensed.surface.stored_energy,
        dissipated=condensed.surface.dissipated_energy,
    )
