"""Prescribed forces without steps in time, at every instant at which the contact has never been larger.

Forces f of a spring and displacements u of its end obey u = J * df with the compliance J, in contact or free, so their
sums do: the springs' displacements, each times its stiffness, add up to F_e = J * dF, a sum of exponentials while F
moves linearly. No end of a spring stands above the indenter, and a free one only creeps back. So where F_e has never
been larger all springs ever touched are touched, and F_e is the elastic force of the depth (Lee and Radok 1960,
J. Appl. Mech. 27, 438; Ting 1966, J. Appl. Mech. 33, 845); elsewhere the depth is less than F_e would make it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from bem.layer_equation.protocol import FlatPunchSource
from contact import FlatPunch, ForceHistory, HistoryPath, InvalidInput, NormalForces, Scene, StageLog
from contact.answer.solution import InstantFields, InstantInterior, Setting
from contact.records.validation import FloatArray
from mdr.equilibria import solve_elastic
from mdr.history.springs_in_time import SpringLaw
from mdr.springs.beside_contact import refuse_touching_at
from mdr.springs.equivalent_system import EquivalentSystem
from mdr.springs.error_model import EPS
from mdr.springs.pulling import refuse_pulling_at
from mdr.springs.reach import covering_system

# Coefficients of (z - 1 + exp(-z))/z^2 = 1/2! - z/3! + ..., used up to z = 1, where the first one left out is 4e-19.
_SERIES = np.array([(-1.0) ** n / math.factorial(n + 2) for n in range(18)])


def without_steps(law: SpringLaw, scene: Scene) -> NDArray[np.bool_]:
    """At which instants of a force history the depth is known in closed form, shape (n,).

    Where F_e has never been larger; always under a flat punch, which holds all springs alike, and on elastic layers.
    """
    loading = scene.loading
    assert isinstance(loading, ForceHistory)
    if law.is_elastic or isinstance(scene.indenter, FlatPunch):
        return np.full(loading.time.size, True)
    time, load = searched(law, loading)
    highest = np.maximum.accumulate(load) * (1.0 - _rounding(law, loading))
    return np.asarray((load >= highest)[np.searchsorted(time, loading.time)])


def searched(law: SpringLaw, loading: ForceHistory) -> tuple[FloatArray, FloatArray]:
    """Times [s] so close to each other, and closer to the instants, that no peak of F_e is missed; F_e [N] there."""
    # After a change of rate a layer creeps fastest; what lies between two of so many points is off by their distance^2.
    near = np.geomspace(1e-9, 0.5, 60)
    between = loading.time[:-1, None] + np.diff(loading.time)[:, None] * np.concatenate([near, 1.0 - near])
    time = np.unique(np.concatenate([loading.time, between.ravel()]))
    return time, elastic_force(law, loading.replace(time=time, force=np.interp(time, loading.time, loading.force)))


def _rounding(law: SpringLaw, loading: ForceHistory) -> float:
    """Relative, of the sums of exponentials."""
    return EPS * (loading.time.size + 4.0 * (law.times.size + 1))


def with_closed_form(followed: HistoryPath, exact: HistoryPath, known: NDArray[np.bool_]) -> HistoryPath:
    """A history followed in steps, with values and errors of the closed form where that holds."""
    values, errors = {}, {"normal_force": followed.error_estimate["normal_force"]}
    for name in ("indentation_depth", "contact_radius"):
        stepped, found = getattr(followed, name), getattr(exact, name)
        values[name] = np.where(known, found, stepped)
        absolute = [path.error_estimate[name] * own.max() for path, own in ((exact, found), (followed, stepped))]
        errors[name] = np.where(known, *absolute) / values[name].max()
    return replace(followed, error_estimate=errors, **values)


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
    """Depth under a force, as if the contact had never been larger at any instant.

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

    def at_all(values: FloatArray) -> FloatArray:
        """With zeros where nothing presses yet."""
        found = np.zeros(load.size)
        found[pressed] = values
        return found

    depth, radius, error = path.indentation_depth, path.contact_radius, path.error_estimate
    moved = _rounding(law, loading) * path.normal_force / path.contact_stiffness
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
        contact_radius=np.where(loading.force > 0.0, np.maximum(at_all(radius), scene.indenter.flat_radius), 0.0),
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
    # A dashpot beside the springs holds them where they are: a force that is there at first does not move it.
    amplitudes = [np.zeros(modes.rates.size)]
    for decay, gain in zip(np.exp(-z), gained, strict=True):
        amplitudes.append(amplitudes[-1] * decay + gain)
    crept = np.sum(amplitudes, axis=1)
    return np.asarray(crept if law.viscosity > 0.0 else force + crept)
