"""Elastic contact without effects: equilibria under prescribed radii, depths or forces, with stated errors.

By radius: depth g(a), Eq. (3). By depth or force: the radius by search, then the prescribed value is inserted as it is.
Errors: the same states on finer springs (`contact.stated`), and rounding errors times the condition of the equation.
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

# A stated error, or the function that computes it.
StatedError: TypeAlias = FloatArray | Callable[[], FloatArray]
# States of a path at which errors are computed and contacts are checked; the largest change counts for all of them.
_COMPARED, CHECKED = 8, 12
# Radii inside, and radii outside over the contact radius, at which fields are compared.
_INSIDE, _OUTSIDE = 8, np.array([1.001, 1.02, 2.0, 4.0])
# Distances from breaks, in thicknesses, at which pressures are compared as well. The outermost two alone state a third
# of the error at a/h = 600.
_DISTANCES = np.array([-1.0, -0.5, -0.25, 0.25, 0.5, 1.0])
# Share of the polynomials of the companion where series converge slowly: errors are stated 4 to 50 times too large.
_FEWER = 0.65
# Relative rounding error of pressure and displacement by their quadratures.
_FIELD_ROUNDING = 2e-13
# Error of pressures that are infinite at the edge of a graded layer: their series converge slowly. With half of it one
# of thirty scenes is not covered.
_GRADED_EDGE = 2e-9


def solve_elastic(scene: Scene, flat_punch: FlatPunchSource, settings: Mapping[str, Setting]) -> ContactPath:
    """Contact radius, depth, force and stiffness, with pressure and displacement on demand.

    Raises:
        InvalidInput: If a prescribed value is out of reach of the indenter, or the contact becomes too wide.
        SeveralContacts: If the contact would not be one circle.
        UnsupportedSceneError: If the surfaces would pull inside, or the indenter would touch outside.
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
    """Springs of a scene; those of a layer are solutions of its equation, or of a table."""
    if scene.layer.is_half_space:
        return springs_on(scene.layer, scene.indenter, flat_punch)
    with log.stage("flat_punch_data"):
        log.count("flat_punch_solutions")
        return springs_on(scene.layer, scene.indenter, flat_punch)


def springs_on(layer: ElasticLayer, indenter: Profile, flat_punch: FlatPunchSource) -> Springs:
    """Springs of a layer under an indenter, by the equation of contact or by a table of flat punches.

    Raises:
        UnsupportedSceneError: If a table is asked for of a layer that is not uniform.
        InvalidInput: If a stored table is of another layer.
    """
    if isinstance(flat_punch, IntegralEquation):
        return Springs.of(layer, indenter, flat_punch.sizes)
    if layer.is_half_space:
        return Springs.of(layer, indenter)
    from mdr.table_bed import TableSprings  # noqa: PLC0415 - loads the boundary elements

    return TableSprings.of_table(layer, indenter, flat_punch)


def is_simple(scene: Scene) -> bool:
    """Whether g rises and no contact pulls or is touched outside: one layer under a convex profile."""
    return scene.layer.is_uniform and scene.indenter.is_convex


def _radii(scene: Scene, springs: Springs) -> FloatArray:
    """Contact radii [m] of what is prescribed."""
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
    """Refuse a table that begins flat.

    Raises:
        InvalidInput: With the radius up to which it does.
    """
    if not isinstance(indenter, FlatPunch) and not indenter.flat_radius and indenter.breakpoints:
        first = indenter.breakpoints[0]
        if float(indenter.height(first)) == 0.0:
            message = f"indenter: does not rise within {first:g} m of first touch; give it a flat end or a first height"
            raise InvalidInput(message)


def _states(scene: Scene, springs: Springs, radius: FloatArray, values: SpringValues) -> State:
    """Equilibria at radii [m]; what is prescribed is inserted as it is."""
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
    """Refuse paths with tension in a contact, or with a second contact outside one.

    Where g rises the widest contact has the smallest gaps, so gaps are checked for it alone.

    Raises:
        UnsupportedSceneError: With the contact radius and the place.
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
    """Indices of at most so many radii, from the smallest to the widest."""
    order = np.argsort(radius)
    return order[sorted(set(np.linspace(0, order.size - 1, min(order.size, count)).astype(int).tolist()))]


def _elastic_errors(scene: Scene, springs: Springs, state: State, values: SpringValues) -> dict[str, StatedError]:
    """Relative errors, shape (n,) each, zero for the prescribed quantity; those of fields are called at first use."""
    some = _spread(state.radius, _COMPARED)
    states = State(*(row[some] for row in state))
    finer, flat, a = springs.finer.at(states.radius), springs.tip.flat, state.radius
    is_punch = isinstance(scene.indenter, FlatPunch)
    by_radius, by_depth = (isinstance(scene.loading, kind) for kind in (ContactRadii, IndentationDepths))
    companion = springs.finer.state(states.radius, finer, None if by_radius else states.depth)
    floor, whole = springs.floor(a)
    if scene.indenter.ends_upright:  # the last digit of a changes g
        floor = floor + EPS * a * springs.tip.transform_slope(a) / springs.tip.transform(a)
    depth = _largest(values.g[some], finer.g, states.depth) + floor
    force = _largest(states.force, companion.force, states.force) + whole + floor
    stiffness = _largest(states.stiffness, companion.stiffness, states.stiffness) + whole
    zero = np.zeros(a.size)
    a_error = zero if by_radius or is_punch else depth * _sensitivity(scene, springs, states)
    # At a prescribed force the depth, and at a prescribed depth the force, is stationary in the radius.
    of_depth, of_force = depth if by_radius else force, force + (depth if by_radius else 0.0)
    # Between the edge of a flat end and that of the contact pressures go with a - b.
    pressure = whole + a_error / np.maximum(1 - flat / a, 1e-12)
    # Outside thin layers w is a small difference of terms of the size of phi, K/a times the depth. An error of the
    # radius changes it like the gap next to the edge, by its power 3/2.
    displacement = (zero if by_depth else of_depth) + a_error**1.5 + whole + EPS * values.K / a
    # Functions outlive the answer's other arrays, so they refer to a few states only.
    ends = {(a, depth, force / (np.pi * a * a)) for a, depth, force in np.transpose(states[:3])[[0, -1]].tolist()}
    widest, deepest = float(states.radius[-1]), float(states.depth[-1])
    return {
        "contact_radius": a_error,
        "indentation_depth": zero if by_depth else of_depth,
        "normal_force": of_force if by_radius or by_depth else zero,
        "contact_stiffness": stiffness + a_error * a * values.y1**2 / values.K,  # d(ln k_N)/d(ln a) = a y_1^2/K
        "pressure": lambda: (
            max(pressure_error(springs, *end, is_singular=is_singular(scene, end[0])) for end in ends) + pressure
        ),
        "surface_displacement": lambda: (
            displacement_error(springs, widest, deepest, is_singular=is_singular(scene, widest)) + displacement
        ),
    }


def _sensitivity(scene: Scene, springs: Springs, seen: State) -> float:
    """d(ln a)/d(ln g), one at most where g rises faster than a."""
    if is_simple(scene):
        return 1.0
    inner = np.maximum(seen.radius * (1 - 1e-4), springs.tip.flat)
    risen = (seen.depth - springs.at(inner).g) / np.where(seen.depth == 0, 1, seen.depth)
    return float(np.max(1 / np.maximum(risen / np.maximum(1 - inner / seen.radius, EPS), 1e-3), initial=1.0))


def surface_pair(springs: Springs, a: float, depth: float, *, is_singular: bool) -> list[Surface]:
    """One contact at two resolutions: that of the answer, and another one whose change states its error.

    All quadratures of the other one are finer. Where the error falls like a power of the number of polynomials, it has
    fewer of them.
    """
    finer = springs.finer
    if is_slow(springs, a):
        finer = springs.at_sizes(finer.sizes._replace(rate=_FEWER * finer.sizes.rate))
    return [surface_of(resolution, a, depth, is_singular=is_singular) for resolution in (springs, finer)]


def pressure_error(springs: Springs, a: float, depth: float, scale: float, *, is_singular: bool) -> float:
    """Stated error over a pressure [Pa] of the pressure of a contact of radius a [m], by two resolutions."""
    pair, unit = surface_pair(springs, a, depth, is_singular=is_singular), springs.unit
    # Errors are largest within a thickness of the breaks, and oscillate there.
    near = np.add.outer(np.array(springs.tip.breaks[:_INSIDE]), unit * _DISTANCES).ravel()
    near = near[(near > 0) & (near < a - unit) & ~np.isin(near, springs.tip.breaks)]
    inside = np.append(a * np.sin(np.pi / 2 * gauss(_INSIDE)[0]), near)
    values = [surface.pressure(inside) for surface in pair]
    floor = _GRADED_EDGE if springs.kernel.tail and pair[0].edge else _FIELD_ROUNDING
    return float(stated_error(values[0], values[1], scale=scale, floor=floor).max())


def displacement_error(springs: Springs, a: float, depth: float, *, is_singular: bool) -> float:
    """Stated error of the displacement outside a contact of radius a [m] over the depth [m], by two resolutions."""
    outside = a * _OUTSIDE
    if not isinstance(springs.tip, FlatTip):  # a punch's flank is upright
        outside = outside[outside < springs.tip.end]
    if not outside.size:
        return _FIELD_ROUNDING
    values = [surface.displacement(outside) for surface in surface_pair(springs, a, depth, is_singular=is_singular)]
    return float(stated_error(values[0], values[1], scale=depth, floor=_FIELD_ROUNDING).max())


def _largest(answer: FloatArray, other: FloatArray, scale: FloatArray) -> float:
    """Largest relative change between two resolutions, times the safety."""
    return float(stated_error(answer, other, scale=scale).max())


@dataclass(frozen=True, eq=False)
class PathFields:
    """Surface fields of every step of a path, each contact solved when it is first asked for.

    Attributes:
        scene: The problem.
        springs: Springs of the scene.
        radius: a [m], shape (n,).
        depth: delta [m], shape (n,).
        flat_punch: Settings of the answer.
        settings: Settings as the answer reports them.
        adheres: Whether the edge is held by adhesion.
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
        """One step's contact."""
        if step not in self._surfaces:
            a = float(self.radius[step])
            singular = self.adheres or is_singular(self.scene, a)
            self._surfaces[step] = surface_of(self.springs, a, float(self.depth[step]), is_singular=singular)
        return self._surfaces[step]

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """p(r) [Pa], zero outside the contact."""
        return self.surface(step).pressure(radius)

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """w(r) [m]."""
        return self.surface(step).displacement(radius)

    def inside(self, step: int, known: KnownContact) -> InteriorFields:
        """The body under one step."""
        from mdr.inside import interior  # noqa: PLC0415 - only those who look inside load it

        singular = self.adheres or is_singular(self.scene, known.radius)
        if not self.adheres:  # two resolutions of the contact itself tell more
            known = known._replace(density_error=0.0)
        return interior(self.springs, self.scene.layer, known, float(self.depth[step]), is_singular=singular)
