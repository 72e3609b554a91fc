"""Contact under full stick: equilibria under prescribed radii, depths or forces, reached by loading alone.

Errors: the change on a coarser discretisation (`contact.stated`), and rounding times the condition of the equation.
"""

from __future__ import annotations

import math
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

# Number of unknowns of the answer minus that of the coarser solution: with half of it both agree by accident.
_MORE = 6
# Ratio of the next trial radius to one that does not reach the prescribed depth or force.
_FURTHER = 1.3
# Rounding errors over eps, of growth, of a punch, and of both per condition number; half of them is exceeded at times.
_OF_GROWTH, _OF_PUNCH, _PER_CONDITION = 50.0, 20.0, 10.0
# Largest relative error estimate of depth and force; beyond it the solution raises an error.
_LARGEST_ERROR = 1e-3


def solve_stick(scene: Scene, flat_punch: FlatPunchSource, settings: Mapping[str, Setting]) -> ContactPath:
    """Contact radius, depth, force and stiffness under full stick from the first touch on.

    Raises:
        UnsupportedSceneError: A flat end that grows, on a compressible layer.
        InvalidInput: If a prescribed value is out of the indenter's reach.
        NotConvergedError: If the growth is not resolved.
    """
    log, extra = StageLog(), flat_punch.sizes.extra
    solve = _pressed if isinstance(scene.indenter, FlatPunch) else _grown
    with log.stage("stick"):
        answer, coarser = solve(scene, extra + _MORE), solve(scene, extra)
    return ContactPath(
        scene=scene,
        method="mdr",
        settings=settings,
        cost=log.cost(unknowns=answer.unknowns),
        stages=log.records,
        contact_radius=answer.state.radius,
        indentation_depth=answer.state.depth,
        normal_force=answer.state.force,
        contact_stiffness=answer.state.stiffness,
        error_estimate=_errors(scene, answer, coarser),
        fields=answer,
    )


def _errors(scene: Scene, answer: Stuck, coarser: Stuck) -> dict[str, FloatArray]:
    """Relative errors of radius, depth, force and stiffness, zero where they are prescribed."""
    pairs = zip(answer.state, coarser.state, strict=True)
    radius, depth, force, stiffness = (
        stated_error(fine, coarse, scale=fine, floor=answer.floor) for fine, coarse in pairs
    )
    if not max(depth.max(), force.max()) <= _LARGEST_ERROR:
        raise NotConvergedError(f"growth under full stick is resolved to {max(depth.max(), force.max()):.1g} only")
    by_depth, by_force = (isinstance(scene.loading, kind) for kind in (IndentationDepths, NormalForces))
    is_given = isinstance(scene.loading, ContactRadii) or isinstance(scene.indenter, FlatPunch)
    return {
        "contact_radius": 0 * radius if is_given else radius,
        "indentation_depth": 0 * depth if by_depth else depth,
        "normal_force": 0 * force if by_force else force,
        "contact_stiffness": stiffness,
    }


def _values(scene: Scene) -> FloatArray:
    """Prescribed radii [m], depths [m] or forces [N], shape (n,)."""
    values: FloatArray = scene.loading.values  # type: ignore[attr-defined]  # the dispatch sends equilibria only
    return values


@dataclass(frozen=True)
class Stuck:
    """States of a contact under full stick, and its surface fields at every step.

    Attributes:
        state: Radius, depth, force and stiffness at every step.
        modulus: Contact modulus E* [Pa].
        unit: Unit of length of the kernel [m].
        contact: Flat punch at unit depth, or a growing contact, lengths in units of the kernel.
        tip: Profile of the indenter.
        floor: Relative rounding error.
        unknowns: Number of unknowns of all systems.
    """

    state: State
    modulus: float
    unit: float
    contact: Adhered | Growth
    tip: Tip
    floor: float
    unknowns: int

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """Pressure p(r) at one step [Pa], zero outside the contact."""
        return np.asarray(self._tractions(radius, step)[0])

    def tangential_traction(self, radius: FloatArray, step: int) -> FloatArray:
        """Shear traction q(r) at one step [Pa], positive if it pushes the layer outwards, zero outside the contact."""
        return np.asarray(self._tractions(radius, step)[1])

    def _tractions(self, radius: FloatArray, step: int) -> FloatArray:
        """p and q [Pa], shape (2, n)."""
        a, depth = self.state.radius[step], self.state.depth[step] / self.unit
        tractions, inside = np.zeros((2, radius.size)), radius < a
        if isinstance(self.contact, Adhered):
            tractions[:, inside] = self.modulus * depth * self.contact.tractions(radius[inside] / a)
        else:
            tractions[:, inside] = self.modulus * self.contact.tractions(radius[inside] / self.unit, a / self.unit)
        return tractions

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """u_z(r) [m]: depth - f(r) inside the contact, Eq. (1)."""
        a, depth = self.state.radius[step], self.state.depth[step]
        inside = radius <= a
        displacement, r = np.asarray(depth - self.tip.height(np.where(inside, radius, 0.0))), radius[~inside]
        if not r.size:
            return displacement
        if isinstance(self.contact, Adhered):
            displacement[~inside] = depth * self.contact.displacement(r / a)
        else:
            displacement[~inside] = self.unit * self.contact.displacement(r / self.unit, float(a) / self.unit)
        return displacement


def _pressed(scene: Scene, extra: int) -> Stuck:
    """States and fields of a flat punch at the prescribed values."""
    layer, tip, values = scene.layer, tip_of(scene.indenter), _values(scene)
    modulus, unit = contact_modulus(layer), tip.flat if layer.is_half_space else layer.surface.thickness
    punch = Adhered(stack_kernel(layer), tip.flat / unit, extra)
    stiffness, ones = 2 * modulus * unit * punch.stiffness, np.ones_like(values)
    by_depth = isinstance(scene.loading, IndentationDepths)
    depth, force = (values, stiffness * values) if by_depth else (values / stiffness, values)
    floor = EPS * (_OF_PUNCH + _PER_CONDITION * punch.condition)
    state = State(tip.flat * ones, depth, force, stiffness * ones)
    return Stuck(state, modulus, unit, punch, tip, floor, punch.count)


def _grown(scene: Scene, extra: int) -> Stuck:
    """States of a tip, followed up to the largest radius of the loading.

    Raises:
        UnsupportedSceneError: A flat end that grows, on a compressible layer.
        InvalidInput: If a prescribed value is out of the indenter's reach.
    """
    layer, tip, values, modulus = scene.layer, tip_of(scene.indenter), _values(scene), contact_modulus(scene.layer)
    nu, flat, kernel = layer.surface.poissons_ratio, tip.flat, stack_kernel(layer)
    if flat and nu < 0.5:
        raise UnsupportedSceneError(
            f"a flat end of radius {flat:g} m that grows under full stick on a layer with poissons_ratio = {nu:g}: "
            "its edge field oscillates, and growth from it has no stable answer; give Poisson's ratio 0.5, or a "
            "rounded edge"
        )
    prescribed = (ContactRadii, IndentationDepths, NormalForces).index(type(scene.loading))
    reach = _first_reach(scene, tip)
    while True:
        unit = reach if layer.is_half_space else layer.surface.thickness
        scales = (unit, unit, modulus * unit**2, modulus * unit)
        growth, targets = Growth(kernel, tip, unit, reach / unit, extra), values / scales[prescribed]
        if not prescribed or growth.states(np.array([growth.end]))[prescribed - 1][0] >= targets.max():
            break
        if reach >= tip.end:
            raise InvalidInput(
                f"loading.values = {values.max():g}: the indenter ends at a radius of {tip.end:g} m, before it is "
                "reached; ask for less or describe the indenter further out"
            )
        reach = min(_FURTHER * reach, tip.end)
    radii = _radii(growth, prescribed - 1, targets) if prescribed else targets
    numbers = [number * scale for number, scale in zip((radii, *growth.states(radii)), scales, strict=True)]
    numbers[prescribed] = values
    floor = EPS * (_OF_GROWTH + _PER_CONDITION * growth.punches.largest.condition)
    return Stuck(State(*numbers), modulus, unit, growth, tip, floor, sum(c.size for _, c in growth.parts))


def _radii(growth: Growth, which: int, targets: FloatArray) -> FloatArray:
    """Radii at which the depth (which = 0) or F/E* (which = 1) equals each target, in units of the kernel."""

    def excess(a: float, value: float) -> float:
        return float(growth.states(np.array([a]))[which][0]) - value

    ends = growth.parts[0][0].start, growth.end
    return np.array([brentq(excess, *ends, (value,), xtol=1e-300, rtol=4 * EPS) for value in targets.tolist()])


def _first_reach(scene: Scene, tip: Tip) -> float:
    """First guess of the largest contact radius [m], from the half-space: g_hs(a) = depth, or E* a g_hs(a) = force."""
    largest = float(_values(scene).max())
    if isinstance(scene.loading, ContactRadii):
        return largest
    widest, modulus = min(tip.end, 1e12) - tip.flat, contact_modulus(scene.layer)

    def residual(log_excess: float) -> float:
        a = tip.flat + math.exp(log_excess)
        depth = float(tip.transform(np.array([a]))[0])
        return depth - largest if isinstance(scene.loading, IndentationDepths) else modulus * a * depth - largest

    # The search ends a share of 1e-12 before the indenter's end: at a sphere's equator the slope is infinite.
    low, high = math.log(1e-15 * min(widest, 1.0)), math.log(widest) - 1e-12
    excess = brentq(residual, low, high, xtol=1e-3) if residual(high) > 0.0 > residual(low) else high
    return min(tip.flat + math.exp(excess), tip.end)
