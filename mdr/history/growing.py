"""A force that never falls: the contact only grows, and its depth is that of an elastic layer under another force.

Each spring is touched once and stays in contact, so the law of one spring is that of their sum, F = G * dF_e with the
elastic force F_e of the depth (Lee and Radok 1960, J. Appl. Mech. 27, 438). Turned around, F_e = J * dF with the
compliance J: while the force moves linearly a sum of exponentials, and no step in time is needed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bem.layer_equation.protocol import FlatPunchSource
from contact import ForceHistory, HistoryPath, InvalidInput, NormalForces, Scene, StageLog
from contact.answer.solution import InstantFields, InstantInterior, Setting
from contact.records.validation import FloatArray
from mdr.elastic import solve_elastic
from mdr.history.springs_in_time import SpringLaw
from mdr.springs.beside_contact import refuse_touching_at
from mdr.springs.equivalent_system import EquivalentSystem
from mdr.springs.error_model import EPS
from mdr.springs.pulling import refuse_pulling_at
from mdr.springs.reach import covering_system

# Coefficients of (z - 1 + exp(-z))/z^2 = 1/2! - z/3! + ..., used up to z = 1, where the first one left out is 4e-19.
_SERIES = np.array([(-1.0) ** n / math.factorial(n + 2) for n in range(18)])


def only_grows(law: SpringLaw, loading: ForceHistory) -> bool:
    """Whether the contact does, or knows the present only: J never falls, so F_e rises with the force."""
    return bool(law.is_elastic or np.all(np.diff(loading.force) >= 0.0))


@dataclass(frozen=True, eq=False)
class FollowedLater:
    """What is inside the body, from the history followed spring by spring when it is first asked for.

    Attributes:
        follow: Follows it.
    """

    follow: Callable[[], HistoryPath]

    def inside(self, step: int) -> InstantInterior:
        """The body at one instant of contact.

        Raises:
            InvalidInput: If the layer's flat punches hold no densities.
        """
        fields = self._followed.fields
        assert fields is not None
        return fields.inside(step)

    @cached_property
    def _followed(self) -> HistoryPath:
        return self.follow()


def growing_history(
    scene: Scene, law: SpringLaw, flat_punch: FlatPunchSource, settings: Mapping[str, Setting], fields: InstantFields
) -> HistoryPath:
    """Depth under a force that never falls.

    Raises:
        InvalidInput: If the force is out of reach of the indenter or the flat-punch data.
        UnsupportedSceneError: If the contact would leave a gap inside itself, or touch beside itself.
    """
    log, loading = StageLog(), scene.loading
    assert isinstance(loading, ForceHistory)
    with log.stage("history"):
        load = elastic_force(law, loading)
        pressed = load > 0.0
        alike = scene.replace(loading=NormalForces(values=load[pressed]), effects=())
        # The contact passes through all radii, so that none of them may leave a gap.
        slope = _system(alike, flat_punch).mdr_profile_slope
        path = solve_elastic(alike, flat_punch, settings)
        for refuse in refuse_touching_at, refuse_pulling_at:
            refuse(scene, flat_punch, float(path.contact_radius.max()))
    rounding = EPS * (loading.time.size + 4.0 * (law.times.size + 1))

    def at_all(values: FloatArray) -> FloatArray:
        """With zeros where nothing presses yet."""
        found = np.zeros(load.size)
        found[pressed] = values
        return found

    depth, radius, error = path.indentation_depth, path.contact_radius, path.error_estimate
    moved = rounding * path.normal_force / path.contact_stiffness
    with np.errstate(divide="ignore", invalid="ignore"):
        widened = np.where(radius > scene.indenter.flat_radius, moved / slope(radius), 0.0)
    return HistoryPath(
        scene=scene,
        method="mdr",
        settings=settings,
        error_estimate={
            "indentation_depth": at_all(error["indentation_depth"] * depth + moved) / depth.max(),
            "normal_force": np.zeros(load.size),
            "contact_radius": at_all(error["contact_radius"] * radius + widened) / radius.max(),
        },
        cost=log.cost(unknowns=path.cost.unknowns),
        stages=log.records,
        time=loading.time,
        indentation_depth=at_all(depth),
        normal_force=loading.force,
        contact_radius=at_all(radius),
        fields=fields,
    )


def _system(alike: Scene, flat_punch: FlatPunchSource) -> EquivalentSystem:
    try:
        return covering_system(alike, flat_punch)
    except InvalidInput as error:
        raise InvalidInput(f"loading.force, as an elastic layer must bear it to be as deep: {error}") from error


def elastic_force(law: SpringLaw, loading: ForceHistory) -> FloatArray:
    """Force F_e [N] under which a layer of the instantaneous modulus is pressed as deep at each instant, shape (n,)."""
    force = loading.force
    if law.is_elastic:
        return force
    modes, steps = law.modes, np.diff(loading.time)[:, None] / law.clock
    z = modes.rates * steps
    steady = np.divide(-np.expm1(-z), z, out=np.ones_like(z), where=z > 0.0)
    rising = np.where(
        z > 1.0, (1.0 - steady) / np.maximum(z, 1.0), np.polynomial.polynomial.polyval(np.minimum(z, 1.0), _SERIES)
    )
    gained = modes.of_force * steps * (force[:-1, None] * steady + np.diff(force)[:, None] * rising)
    amplitudes = [modes.of_surface[:, 0] * force[0]]
    for decay, gain in zip(np.exp(-z), gained, strict=True):
        amplitudes.append(amplitudes[-1] * decay + gain)
    crept = np.sum(amplitudes, axis=1)
    return np.asarray(crept if law.viscosity > 0.0 else force + crept)
