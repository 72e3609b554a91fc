"""Contact under full stick: equilibria under prescribed radii, depths or forces, reached by loading alone.

Errors: what a coarser discretisation changes (`contact.stated`), and rounding times the condition of the equation.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from bem.flat_punch import FlatPunchSource
from bem.kernels.moduli import contact_modulus
from bem.kernels.of_layer import stack_kernel
from bem.numerics import EPS
from contact import (
    ContactPath,
    ContactRadii,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    NormalForces,
    NotConvergedError,
    Scene,
    StageLog,
    UnsupportedSceneError,
)
from contact.answer.solution import Setting
from contact.records.validation import FloatArray
from contact.stated import stated_error
from mdr.friction.adhered_punch import Adhered
from mdr.friction.growth import Growth
from mdr.profiles import Tip, tip_of
from mdr.spring_bed import State

# Unknowns that the companion has less: with half as many two resolutions agree by accident.
_MORE = 6
# Where the first trial radius does not reach the wanted depth or force, the next is this much larger.
_FURTHER = 1.3
# Roundings of growth, of a punch, and of both per condition of the punch's matrix; half of them are exceeded at times.
_OF_GROWTH, _OF_PUNCH, _PER_CONDITION = 50.0, 20.0, 10.0
# Largest relative error of depth and force that is answered; beyond, the growth is refused.
_LARGEST_ERROR = 1e-3
_PRESCRIBED = {ContactRadii: "radius", IndentationDepths: "depth", NormalForces: "force"}


def solve_stick(scene: Scene, flat_punch: FlatPunchSource, settings: Mapping[str, Setting]) -> ContactPath:
    """Contact radius, depth, force and stiffness where nothing slides from the first touch on.

    Raises:
        UnsupportedSceneError: A flat end that grows, on a compressible layer.
        InvalidInput: If a prescribed value is out of the indenter's reach.
        NotConvergedError: If the growth is not resolved.
    """
    log = StageLog()
    extra = flat_punch.sizes.extra
    kind = _Punch if isinstance(scene.indenter, FlatPunch) else _Grown
    with log.stage("stick"):
        own, coarser = kind.of(scene, extra + _MORE), kind.of(scene, extra)
    return ContactPath(
        scene=scene,
        method="mdr",
        settings=settings,
        cost=log.cost(unknowns=own.unknowns),
        stages=log.records,
        contact_radius=own.state.radius,
        indentation_depth=own.state.depth,
        normal_force=own.state.force,
        contact_stiffness=own.state.stiffness,
        error_estimate=_errors(scene, own, coarser),
        fields=own,
    )


def _errors(scene: Scene, own: _Punch | _Grown, coarser: _Punch | _Grown) -> dict[str, FloatArray]:
    """Of what was not prescribed."""
    radius, depth, force, stiffness = (
        stated_error(one, other, scale=one, floor=own.floor)
        for one, other in zip(own.state, coarser.state, strict=True)
    )
    if not max(depth.max(), force.max()) <= _LARGEST_ERROR:
        raise NotConvergedError(f"growth under full stick is resolved to {max(depth.max(), force.max()):.1g} only")
    zero, loading = np.zeros_like(depth), scene.loading
    is_given = isinstance(loading, ContactRadii) or isinstance(scene.indenter, FlatPunch)
    by_depth, by_radius = isinstance(loading, IndentationDepths), isinstance(loading, ContactRadii)
    return {
        "contact_radius": zero if is_given else radius,
        "indentation_depth": zero if by_depth else depth,
        "normal_force": force if by_depth or by_radius else zero,
        "contact_stiffness": stiffness,
    }


def _values(scene: Scene) -> FloatArray:
    """The radii, depths or forces asked for, shape (n,)."""
    values: FloatArray = scene.loading.values  # type: ignore[attr-defined]  # the dispatch sends equilibria only
    return values


@dataclass(frozen=True)
class _Stuck(ABC):
    """States of a stuck contact, and its surface fields at every step.

    Attributes:
        state: Equilibria.
        modulus: E* [Pa].
    """

    state: State
    modulus: float

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """p(r) [Pa], zero outside."""
        return np.asarray(self._tractions(radius, step)[0])

    def tangential_traction(self, radius: FloatArray, step: int) -> FloatArray:
        """q(r) [Pa], positive where the layer is pushed outward, zero outside."""
        return np.asarray(self._tractions(radius, step)[1])

    @abstractmethod
    def _tractions(self, radius: FloatArray, step: int) -> FloatArray:
        """p and q [Pa], shape (2, n)."""


@dataclass(frozen=True)
class _Punch(_Stuck):
    """An adhered flat punch.

    Attributes:
        punch: Under a depth of one, lengths in units of the kernel.
    """

    punch: Adhered

    @classmethod
    def of(cls, scene: Scene, extra: int) -> _Punch:
        """Of a scene."""
        layer, a, modulus = scene.layer, scene.indenter.flat_radius, contact_modulus(scene.layer)
        unit = a if layer.is_half_space else layer.surface.thickness
        punch = Adhered(stack_kernel(layer), a / unit, extra)
        stiffness, values = 2 * modulus * unit * punch.stiffness, _values(scene)
        by_depth, same = isinstance(scene.loading, IndentationDepths), np.ones_like(values)
        depth = values if by_depth else values / stiffness
        force = stiffness * values if by_depth else values
        return cls(State(a * same, depth, force, stiffness * same), modulus, punch)

    @property
    def floor(self) -> float:
        """Relative rounding error."""
        return EPS * (_OF_PUNCH + _PER_CONDITION * self.punch.condition)

    @property
    def unknowns(self) -> int:
        """Of the system."""
        return self.punch.count

    def _tractions(self, radius: FloatArray, step: int) -> FloatArray:
        a, found = self.state.radius[step], np.zeros((2, radius.size))
        s, size = radius / a, self.modulus * self.state.depth[step] * self.punch.a / a
        found[:, s < 1] = size * self.punch.tractions(s[s < 1])
        return found

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """w(r) [m]."""
        found, s = np.ones_like(radius), radius / self.state.radius[step]
        if (s > 1).any():
            found[s > 1] = self.punch.displacement(s[s > 1])
        return np.asarray(self.state.depth[step] * found)


@dataclass(frozen=True)
class _Grown(_Stuck):
    """Contact that has grown under full stick.

    Attributes:
        growth: Lengths in units of the kernel.
    """

    growth: Growth

    @classmethod
    def of(cls, scene: Scene, extra: int) -> _Grown:
        """Of a scene."""
        nu, flat = scene.layer.surface.poissons_ratio, scene.indenter.flat_radius
        if flat and nu < 0.5:
            raise UnsupportedSceneError(
                f"a flat end of radius {flat:g} m that grows under full stick on a layer with poissons_ratio = {nu:g}: "
                "its edge field oscillates, and growth from it has no stable answer; give Poisson's ratio 0.5, or a "
                "rounded edge"
            )
        growth, radii = _covering(scene, extra)
        modulus, unit, values = contact_modulus(scene.layer), growth.unit, _values(scene)
        depth, force, stiffness = growth.states(radii)
        state = State(radii * unit, depth * unit, force * modulus * unit**2, stiffness * modulus * unit)
        state = state._replace(**{_PRESCRIBED[type(scene.loading)]: values})
        return cls(state, modulus, growth)

    @property
    def floor(self) -> float:
        """Relative rounding error."""
        return EPS * (_OF_GROWTH + _PER_CONDITION * self.growth.punches.largest.condition)

    @property
    def unknowns(self) -> int:
        """Of all stretches."""
        return sum(c.size for _, c in self.growth.parts)

    def _radius(self, step: int) -> float:
        return float(self.state.radius[step]) / self.growth.unit

    def _tractions(self, radius: FloatArray, step: int) -> FloatArray:
        r, a, found = radius / self.growth.unit, self._radius(step), np.zeros((2, radius.size))
        found[:, r < a] = self.modulus * self.growth.tractions(r[r < a], a)
        return found

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """w(r) [m]: the indenter's shape inside, Eq. (1)."""
        r, a = radius / self.growth.unit, self._radius(step)
        inside = r <= a
        found = self.state.depth[step] - self.growth.tip.height(np.where(inside, radius, 0.0))
        if not inside.all():
            found[~inside] = self.growth.unit * self.growth.displacement(r[~inside], a)
        return np.asarray(found)


def _covering(scene: Scene, extra: int) -> tuple[Growth, FloatArray]:
    """The growth up to the largest radius of the loading, and all its radii in units."""
    layer, values, tip, kernel = scene.layer, _values(scene), tip_of(scene.indenter), stack_kernel(scene.layer)
    reach = _first_reach(scene, tip)
    unit = reach if layer.is_half_space else layer.surface.thickness
    if isinstance(scene.loading, ContactRadii):
        return Growth(kernel, tip, unit, reach / unit, extra), values / unit
    which = 0 if isinstance(scene.loading, IndentationDepths) else 1
    wanted = values / unit if which == 0 else values / (contact_modulus(layer) * unit**2)
    while True:
        growth = Growth(kernel, tip, unit, reach / unit, extra)
        if growth.states(np.array([growth.end]))[which][0] >= wanted.max():
            return growth, _radii(growth, which, wanted)
        if reach >= tip.end:
            raise InvalidInput(
                f"loading.values = {values.max():g}: the indenter ends at a radius of {tip.end:g} m, before it is "
                "reached; ask for less or describe the indenter further out"
            )
        reach = min(_FURTHER * reach, tip.end)
        unit = reach if layer.is_half_space else unit
        wanted = values / unit if which == 0 else values / (contact_modulus(layer) * unit**2)


def _radii(growth: Growth, which: int, wanted: FloatArray) -> FloatArray:
    """Radii at which the depth (0) or the force (1) is reached."""

    def missing(a: float, value: float) -> float:
        return float(growth.states(np.array([a]))[which][0]) - value

    start = growth.parts[0][0].start
    return np.array(
        [brentq(missing, start, growth.end, (value,), xtol=1e-300, rtol=4 * EPS) for value in wanted.tolist()]
    )


def _first_reach(scene: Scene, tip: Tip) -> float:
    """Radius [m] at which g_hs passes the largest depth, or 2 E* a g_hs/2 the largest force."""
    largest = float(_values(scene).max())
    if isinstance(scene.loading, ContactRadii):
        return largest
    room, modulus = min(tip.end, 1e12) - tip.flat, contact_modulus(scene.layer)

    def missing(log_excess: float) -> float:
        a = tip.flat + math.exp(log_excess)
        depth = float(tip.transform(np.array([a]))[0])
        return depth - largest if isinstance(scene.loading, IndentationDepths) else modulus * a * depth - largest

    # A trillionth less than the room there is: at a sphere's equator the profile is no number.
    low, high = math.log(1e-15 * min(room, 1.0)), math.log(room) - 1e-12
    found = brentq(missing, low, high, xtol=1e-3) if missing(high) > 0.0 > missing(low) else high
    return min(tip.flat + math.exp(found), tip.end)
