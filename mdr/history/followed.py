"""A bed of springs followed through a prescribed depth or force, from instant to instant."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from bem.layer_equation.protocol import FlatPunchSource
from contact import DepthHistory, ForceHistory, Scene
from contact.answer.solution import InstantInterior
from mdr.history.contact_edge import SpringBed
from mdr.history.force_control import Ramp, pressed_at_once, to_force
from mdr.history.springs_in_time import BedState, SpringLaw, advance, undeformed


@dataclass(frozen=True, eq=False)
class FollowedHistory:
    """What fields inside need of a history, which is followed again up to an instant that is asked for.

    Attributes:
        scene: What was solved.
        flat_punch: Source of the layer's flat punches.
        law: Of the springs.
        beds: On shares of the springs, all of them first.
        substeps: Of each interval.
        known: Relative error of springs and of the steps in time.
    """

    scene: Scene
    flat_punch: FlatPunchSource
    law: SpringLaw
    beds: list[SpringBed]
    substeps: NDArray[np.intp]
    known: float

    def inside(self, step: int) -> InstantInterior:
        """The body at one instant of contact.

        Raises:
            InvalidInput: If the layer's flat punches hold no densities.
        """
        # Half of what an answer would import otherwise, for those who look inside.
        from mdr.history.inside import interior_at  # noqa: PLC0415

        return interior_at(self, step)

    def state(self, bed: SpringBed, step: int) -> tuple[BedState, float]:
        """A bed and the speed of the depth at one instant."""
        loading = self.scene.loading
        assert isinstance(loading, DepthHistory | ForceHistory)
        return next(islice(states_at(self.law, bed, loading, self.substeps), step, None))


def states_at(
    law: SpringLaw, bed: SpringBed, loading: DepthHistory | ForceHistory, substeps: NDArray[np.intp]
) -> Iterator[tuple[BedState, float]]:
    """The bed and the speed of the depth at each instant; a prescribed depth needs no substeps."""
    return _by_depth(law, bed, loading) if isinstance(loading, DepthHistory) else _by_force(law, bed, loading, substeps)


def _by_depth(law: SpringLaw, bed: SpringBed, loading: DepthHistory) -> Iterator[tuple[BedState, float]]:
    state = undeformed(law, bed.profile, float(loading.depth[0]))
    yield state, 0.0
    for duration, depth in zip(np.diff(loading.time), loading.depth[1:], strict=True):
        speed = float(depth - state.depth) / float(duration)
        state = advance(law, bed.profile, state, float(depth), float(duration))
        yield state, speed


def _by_force(
    law: SpringLaw, bed: SpringBed, loading: ForceHistory, substeps: NDArray[np.intp]
) -> Iterator[tuple[BedState, float]]:
    force, durations = loading.force, np.diff(loading.time)
    at_once = force[0] > 0.0 and law.viscosity == 0.0
    state = pressed_at_once(law, bed, float(force[0])) if at_once else undeformed(law, bed.profile, 0.0)
    yield state, 0.0
    for i, duration in enumerate(durations):
        ramp = Ramp(float(force[i]), float(force[i + 1]), float(duration))
        state, speed = to_force(law, bed, state, ramp, int(substeps[i]))
        yield state, speed
