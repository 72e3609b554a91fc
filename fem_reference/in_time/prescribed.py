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


def segment_steps(time: FloatArray, steps: int) -> list[int]:
    """How many equal steps each segment between given instants gets: about ``steps`` in all, four at least."""
    share = np.diff(time) / (time[-1] - time[0]) * steps
    return [max(4, round(float(s))) for s in share]


def simulate_depths(
    condensed: CondensedLayer, relaxation: ShearRelaxation, time: FloatArray, depth: FloatArray, steps: int
) -> HistorySamples:
    """Depths linear between the given instants.

    Args:
        condensed: the layer at rest and its indenter.
        relaxation: shear relaxation.
        time: instants [s].
        depth: depths at these instants, in the units of the condensed layer.
        steps: about how many steps in all.
    """
    record = _at_rest(time[0], depth[0])
    surface = condensed.surface

    def advance(step: RelaxationStep, depth: float, active: BoolArray | None) -> Complementary:
        """Pressures at the end of a step to this depth, remembered; the search begins with the contact `active`."""
        matrix, offset = surface.begin(step)
        state = solve_complementarity(matrix, depth * surface.resultants - condensed.profile - offset, active)
        surface.accept(step, state.pressure)
        return state

    for (t0, t1), (d0, d1), count in zip(pairwise(time), pairwise(depth), segment_steps(time, steps), strict=True):
        step = relaxation_step(relaxation, (t1 - t0) / count)
        # The rates jump with that of the depth.
        if step.dashpot > 0:
            advance(step.instant, d0 + (d1 - d0) * INSTANT / count, None)
        active = None
        for n in range(1, count + 1):
            now = (1.0 - n / count) * d0 + n / count * d1
            state = advance(step.first if n == 1 else step, now, active)
            active = state.active
            _add(record, condensed, state, t0 + (t1 - t0) * n / count, now)
    return record


def simulate_forces(
    condensed: CondensedLayer, relaxation: ShearRelaxation, time: FloatArray, force: FloatArray, steps: int
) -> HistorySamples:
    """Forces linear between the given instants, in the units of the condensed layer; see `simulate_depths`.

    Raises:
        NotConvergedError: no depth carries the force.
    """
    record = _at_rest(time[0], 0.0)
    surface, depth = condensed.surface, 0.0

    def advance(step: RelaxationStep, force: float, depth: float) -> tuple[Complementary, float]:
        """Pressures and depth at the end of a step to this force, remembered; the search begins at `depth`."""
        matrix, offset = surface.begin(step)
        state, depth = _depth_of_force(matrix, surface.resultants, condensed.profile + offset, force, depth)
        surface.accept(step, state.pressure)
        return state, depth

    for (t0, t1), (f0, f1), count in zip(pairwise(time), pairwise(force), segment_steps(time, steps), strict=True):
        step = relaxation_step(relaxation, (t1 - t0) / count)
        # The only jump of the force, hence of the rates.
        if step.dashpot > 0 and t0 == time[0] and f0 > 0:
            _, depth = advance(step.instant, float(f0), depth)
        for n in range(1, count + 1):
            # The last is the force given, to the bit: a rounding beside zero would be no force that a depth carries.
            now = (1.0 - n / count) * f0 + n / count * f1
            state, depth = advance(step.first if n == 1 else step, now, depth)
            _add(record, condensed, state, t0 + (t1 - t0) * n / count, depth)
    return record


def _depth_of_force(
    matrix: FloatArray, w: FloatArray, gap: FloatArray, force: float, depth: float
) -> tuple[Complementary, float]:
    """Contact with a given resultant: Newton's method on the convex, piecewise linear F(delta)."""
    # The depth of first touch.
    least = float(np.min(gap / w))
    if force == 0:
        return solve_complementarity(matrix, least * w - gap), min(depth, least)
    depth = max(depth, least + 1e-9 * abs(least) + 1e-15)
    for _ in range(60):
        state = solve_complementarity(matrix, depth * w - gap)
        defect = force - float(w @ state.pressure)
        if abs(defect) <= 1e-10 * force:
            return state, depth
        act = state.active if state.active.any() else gap / w <= depth + 1e-12
        block = matrix[np.ix_(act, act)]
        depth += defect / float(w[act] @ np.linalg.solve(block, w[act]))
    raise NotConvergedError("no depth carries the prescribed force", {"force_defect": defect})


def _at_rest(time: float, depth: float) -> HistorySamples:
    record = HistorySamples()
    record.add(time=float(time), depth=float(depth), force=0.0, radius=0.0, stored=0.0, dissipated=0.0)
    return record


def _add(record: HistorySamples, condensed: CondensedLayer, state: Complementary, time: float, depth: float) -> None:
    record.add(
        time=float(time),
        depth=float(depth),
        force=float(condensed.surface.resultants @ state.pressure),
        radius=edge_radius(condensed.radii, state.pressure),
        stored=condensed.surface.stored_energy,
        dissipated=condensed.surface.dissipated_energy,
    )
