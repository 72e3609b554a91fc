"""Elastic contact without effects: equilibria under prescribed radii, depths or forces, with stated errors.

For a prescribed radius the depth is g(a), Eq. (3). For a prescribed depth or force the radius is found by a search, and
the prescribed value is inserted unchanged. Error estimates: the change of the states on finer springs
(`contact.stated`), plus rounding errors times the condition number of the equation.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from bem.flat_punch import FlatPunchSource, IntegralEquation
from bem.numerics import EPS, gauss
from contact import (
    ContactPath,
    ContactRadii,
    ElasticLayer,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    NormalForces,
    Profile,
    Scene,
    StageLog,
    UnsupportedSceneError,
)
from contact.answer.friction import friction_notes
from contact.answer.inside import InteriorFields, KnownContact
from contact.answer.solution import Setting, StatedErrors
from contact.records.validation import FloatArray
from contact.stated import stated_error
from mdr.admissible import refuse_pulling, refuse_touching_outside
from mdr.contact_surface import Surface, is_slow, surface_of
from mdr.profiles import FlatTip
from mdr.radius_search import Quantity, RadiusSearch, refuse_too_wide
from mdr.spring_bed import Springs, SpringValues, State

# An error estimate, or the function that computes it at first use.
StatedError: TypeAlias = FloatArray | Callable[[], FloatArray]
# Numbers of states of a path at which errors are computed and contacts are checked; the largest error is used for all.
_COMPARED, CHECKED = 8, 12
# Radii inside, and radii outside over the contact radius, at which fields are compared.
_INSIDE, _OUTSIDE = 8, np.array([1.001, 1.02, 2.0, 4.0])
# Further points: distances from breaks over the thickness. The outermost two alone give a third of the error at
# a/h = 600.
_DISTANCES = np.array([-1.0, -0.5, -0.25, 0.25, 0.5, 1.0])
# Number of polynomials of the comparison where series converge slowly, over that of the answer. The error estimate is 4
# to 50 times the error.
_FEWER = 0.65
# Relative rounding error of pressure and displacement by their quadratures.
_FIELD_ROUNDING = 2e-13
# Relative error of pressures that are infinite at the edge of a graded layer, whose series converge slowly. At half of
# it one of thirty scenes is not covered.
_GRADED_EDGE = 2e-9


def solve_elastic(scene: Scene, flat_punch: FlatPunchSource, settings: Mapping[str, Setting]) -> ContactPath:
    """Contact radius, depth, force and stiffness; pressure and displacement are computed at first use.

    Raises:
        InvalidInput: If a prescribed value is out of reach of the indenter, or the contact becomes too wide.
        SeveralContacts: If the contact would not be one circle.
        UnsupportedSceneError: If there would be tension inside the contact, or a second contact outside.
    """
    log = StageLog()
    springs = springs_of(scene, flat_punch, log)
    with log.stage("mdr_profile"):
        radius = _radii(scene, springs)
    with log.stage("force"):
        values = springs.at(radius)
        state = _states(scene, springs, radius, values)
        refuse_inadmissible(scene, springs, state)
        errors = StatedErrors(_elastic_errors(scene, springs, state, values), "mdr")
    return ContactPath(
        scene=scene,
        method="mdr",
        settings=settings,
        contact_radius=state.radius,
        indentation_depth=state.depth,
        normal_force=state.force,
        contact_stiffness=state.stiffness,
        error_estimate=errors,
        cost=log.cost(unknowns=springs.punches.unknowns(float(radius.max()) / springs.unit)),
        stages=log.records,
        notes=friction_notes(scene.layer, state.radius),
        fields=PathFields(scene, springs, state.radius, state.depth, flat_punch, settings),
    )


def springs_of(scene: Scene, flat_punch: FlatPunchSource, log: StageLog) -> Springs:
    """Springs of a scene, from the integral equation or a table; the log counts them as flat-punch data."""
    if scene.layer.is_half_space:
        return springs_on(scene.layer, scene.indenter, flat_punch)
    with log.stage("flat_punch_data"):
        log.count("flat_punch_solutions")
        return springs_on(scene.layer, scene.indenter, flat_punch)


def springs_on(layer: ElasticLayer, indenter: Profile, flat_punch: FlatPunchSource) -> Springs:
    """Springs of a layer under an indenter, by the equation of contact or by a table of flat punches.

    Raises:
        UnsupportedSceneError: If the source is a table and the layer is not uniform.
        InvalidInput: If a stored table belongs to another layer.
    """
    if isinstance(flat_punch, IntegralEquation):
        return Springs.of(layer, indenter, flat_punch.sizes)
    if layer.is_half_space:
        return Springs.of(layer, indenter)
    from mdr.table_bed import TableSprings  # noqa: PLC0415 - loads the boundary elements

    return TableSprings.of_table(layer, indenter, flat_punch)


def is_simple(scene: Scene) -> bool:
    """Whether g increases and the contact is one circle without tension for sure: one layer under a convex profile."""
    return scene.layer.is_uniform and scene.indenter.is_convex


def _radii(scene: Scene, springs: Springs) -> FloatArray:
    """Contact radii [m] at the prescribed radii, depths or forces, shape (n,)."""
    loading, indenter = scene.loading, scene.indenter
    if not isinstance(loading, ContactRadii | IndentationDepths | NormalForces):
        raise UnsupportedSceneError(f"loading {type(loading).__name__} prescribes no radii, depths or forces")
    if isinstance(indenter, FlatPunch):
        refuse_too_wide(springs, indenter.radius)
        return np.full(loading.values.size, indenter.radius)
    _refuse_unrisen(indenter)
    search = RadiusSearch(springs, may_fall=not is_simple(scene))
    if isinstance(loading, ContactRadii):
        largest = float(loading.values.max())
        refuse_too_wide(springs, largest)
        if scene.layer.is_uniform:
            search.refuse_falls(largest)
        return loading.values
    quantity: Quantity = "depth" if isinstance(loading, IndentationDepths) else "force"
    is_contact = lambda a: refuse_inadmissible(scene, springs, springs.states(np.array([a])))  # noqa: E731
    return search.radii(quantity, loading.values, is_contact)


def _refuse_unrisen(indenter: Profile) -> None:
    """Refuse a tabulated profile whose first heights are zero, unless it is a flat end.

    Raises:
        InvalidInput: With the radius up to which it is flat.
    """
    if not isinstance(indenter, FlatPunch) and not indenter.flat_radius and indenter.breakpoints:
        first = indenter.breakpoints[0]
        if float(indenter.height(first)) == 0.0:
            message = f"indenter: does not rise within {first:g} m of first touch; give it a flat end or a first height"
            raise InvalidInput(message)


def _states(scene: Scene, springs: Springs, radius: FloatArray, values: SpringValues) -> State:
    """Equilibria at radii [m], with prescribed depths or forces inserted unchanged."""
    loading = scene.loading
    if isinstance(loading, IndentationDepths):
        return springs.state(radius, values, loading.values)
    if isinstance(loading, NormalForces):
        depth = springs.depth_of(loading.values, values)
        return springs.state(radius, values, depth)._replace(force=loading.values)
    return springs.state(radius, values)


def is_singular(scene: Scene, radius: float) -> bool:
    """Whether the pressure is infinite at the edge: under a flat punch, and a flat end that the contact fills."""
    return isinstance(scene.indenter, FlatPunch) or radius <= scene.indenter.flat_radius


def refuse_inadmissible(scene: Scene, springs: Springs, state: State) -> None:
    """Refuse paths with tension inside a contact, or with a second contact outside.

    Where g increases the widest contact has the smallest gaps, so gaps are checked for it alone.

    Raises:
        UnsupportedSceneError: With the contact radius, and the radius of tension or touch.
    """
    if is_simple(scene):
        return
    some = _spread(state.radius, CHECKED).tolist()
    for i in reversed(some):
        a, widest = float(state.radius[i]), i == some[-1]
        if scene.layer.is_uniform and not widest:
            continue
        depth, mean, singular = float(state.depth[i]), float(state.force[i]) / (np.pi * a * a), is_singular(scene, a)
        surface = surface_of(springs, a, depth, is_singular=singular)
        if widest:
            refuse_touching_outside(scene, surface)
        if not scene.layer.is_uniform:
            refuse_pulling(surface, mean, partial(pressure_error, springs, a, depth, mean, is_singular=singular))


def _spread(radius: FloatArray, count: int) -> NDArray[np.intp]:
    """Indices of at most `count` radii, evenly from the smallest to the largest."""
    order = np.argsort(radius)
    return order[sorted(set(np.linspace(0, order.size - 1, min(order.size, count)).astype(int).tolist()))]


def _elastic_errors(scene: Scene, springs: Springs, state: State, values: SpringValues) -> dict[str, StatedError]:
    """Relative error estimates by name, shape (n,), zero of the prescribed quantity; fields have functions instead."""
    some = _spread(state.radius, _COMPARED)
    states = State(*(row[some] for row in state))
    finer, flat, a = springs.finer.at(states.radius), springs.tip.flat, state.radius
    is_punch = isinstance(scene.indenter, FlatPunch)
    by_radius, by_depth = (isinstance(scene.loading, kind) for kind in (ContactRadii, IndentationDepths))
    finer_states = springs.finer.state(states.radius, finer, None if by_radius else states.depth)
    floor, whole = springs.floor(a)
    if scene.indenter.ends_upright:  # a rounding error of a changes g
        floor = floor + EPS * a * springs.tip.transform_slope(a) / springs.tip.transform(a)
    depth = _largest(values.g[some], finer.g, states.depth) + floor
    force = _largest(states.force, finer_states.force, states.force) + whole + floor
    stiffness = _largest(states.stiffness, finer_states.stiffness, states.stiffness) + whole
    zero = np.zeros(a.size)
    a_error = zero if by_radius or is_punch else depth * _sensitivity(scene, springs, states)
    # At a prescribed force the depth, and at a prescribed depth the force, is stationary in the radius.
    of_depth, of_force = (depth + force, depth + force) if by_radius else (force, force)
    # Pressures between the flat radius b and the edge vary like a - b.
    pressure = whole + a_error / np.maximum(1 - flat / a, 1e-12)
    # On thin layers w outside is a small difference of terms of the size of phi, K/a times the depth. An error of the
    # radius changes w by its power 3/2, like the gap near the edge.
    displacement = (zero if by_depth else of_depth) + a_error**1.5 + whole + EPS * values.K / a
    # The functions below refer to a few states only, since they stay in memory as long as the answer.
    ends = {(a, depth, force / (np.pi * a * a)) for a, depth, force in np.transpose(states[:3])[[0, -1]].tolist()}
    return {
        "contact_radius": a_error,
        "indentation_depth": zero if by_depth else of_depth,
        "normal_force": of_force if by_radius or by_depth else zero,
        "contact_stiffness": stiffness + a_error * a * values.y1**2 / values.K,  # d(ln k_N)/d(ln a) = a y_1^2/K
        "pressure": lambda: (
            max(pressure_error(springs, *end, is_singular=is_singular(scene, end[0])) for end in ends) + pressure
        ),
        "surface_displacement": lambda: (
            max(displacement_error(springs, a, d, is_singular=is_singular(scene, a)) for a, d, _ in ends) + displacement
        ),
    }


def _sensitivity(scene: Scene, springs: Springs, states: State) -> float:
    """Largest d(ln a)/d(ln g) of the states, at least 1."""
    if is_simple(scene):
        return 1.0
    inner = np.maximum(states.radius * (1 - 1e-4), springs.tip.flat)
    growth = (states.depth - springs.at(inner).g) / np.where(states.depth == 0, 1, states.depth)
    return float(np.max(1 / np.maximum(growth / np.maximum(1 - inner / states.radius, EPS), 1e-3), initial=1.0))


def surface_pair(springs: Springs, a: float, depth: float, *, is_singular: bool) -> list[Surface]:
    """One contact at two resolutions: that of the answer, and the comparison for error estimates.

    All quadratures of the comparison are finer. Where the error falls like a power of the number of polynomials, it has
    fewer of them.
    """
    finer = springs.finer
    if is_slow(springs, a):
        finer = springs.at_sizes(finer.sizes._replace(rate=_FEWER * finer.sizes.rate))
    return [surface_of(resolution, a, depth, is_singular=is_singular) for resolution in (springs, finer)]


def pressure_error(springs: Springs, a: float, depth: float, scale: float, *, is_singular: bool) -> float:
    """Error estimate over `scale` [Pa] of the pressure in a contact of radius a [m], from two resolutions."""
    pair, unit = surface_pair(springs, a, depth, is_singular=is_singular), springs.unit
    # Errors are largest within a thickness of the breaks, and oscillate there.
    near = np.add.outer(np.array(springs.tip.breaks[:_INSIDE]), unit * _DISTANCES).ravel()
    near = near[(near > 0) & (near < a - unit) & ~np.isin(near, springs.tip.breaks)]
    inside = np.append(a * np.sin(np.pi / 2 * gauss(_INSIDE)[0]), near)
    values = [surface.pressure(inside) for surface in pair]
    floor = _GRADED_EDGE if springs.kernel.tail and pair[0].edge else _FIELD_ROUNDING
    return float(stated_error(values[0], values[1], scale=scale, floor=floor).max())


def displacement_error(springs: Springs, a: float, depth: float, *, is_singular: bool) -> float:
    """Error estimate over the depth [m] of the displacement outside a contact of radius a [m], from two resolutions."""
    outside = a * _OUTSIDE
    if not isinstance(springs.tip, FlatTip):  # a punch's flank is upright
        outside = outside[outside < springs.tip.end]
    if not outside.size:
        return _FIELD_ROUNDING
    values = [surface.displacement(outside) for surface in surface_pair(springs, a, depth, is_singular=is_singular)]
    return float(stated_error(values[0], values[1], scale=depth, floor=_FIELD_ROUNDING).max())


def _largest(answer: FloatArray, other: FloatArray, scale: FloatArray) -> float:
    """Largest error estimate: the safety factor times the relative change between two resolutions."""
    return float(stated_error(answer, other, scale=scale).max())


@dataclass(frozen=True, eq=False)
class PathFields:
    """Surface fields of every step of a path; each contact is solved at first use and cached.

    Attributes:
        scene: The scene.
        springs: Springs of the scene.
        radius: Contact radius a [m], shape (n,).
        depth: Indentation depth delta [m], shape (n,).
        flat_punch: Source of flat-punch data.
        settings: Settings that the answer reports.
        adheres: Whether the contact has adhesion, so that the pressure is infinite at the edge.
    """

    scene: Scene
    springs: Springs
    radius: FloatArray
    depth: FloatArray
    flat_punch: FlatPunchSource
    settings: Mapping[str, Setting]
    adheres: bool = False
    _surfaces: dict[int, Surface] = field(default_factory=dict)

    def surface(self, step: int) -> Surface:
        """The contact of one step."""
        if step not in self._surfaces:
            a = float(self.radius[step])
            singular = self.adheres or is_singular(self.scene, a)
            self._surfaces[step] = surface_of(self.springs, a, float(self.depth[step]), is_singular=singular)
        return self._surfaces[step]

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """Pressure p(r) at one step [Pa], zero outside the contact."""
        return self.surface(step).pressure(radius)

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """Surface displacement w(r) at one step [m]."""
        return self.surface(step).displacement(radius)

    def inside(self, step: int, known: KnownContact) -> InteriorFields:
        """Fields inside the layer at one step; `known` are radius and errors of its contact."""
        from mdr.inside import interior  # noqa: PLC0415 - only those who look inside load it

        singular = self.adheres or is_singular(self.scene, known.radius)
        if not self.adheres:  # the error follows from two resolutions of the contact instead
            known = known._replace(density_error=0.0)
        return interior(self.springs, self.scene.layer, known, float(self.depth[step]), is_singular=singular)
