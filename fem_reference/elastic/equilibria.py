"""Equilibria at prescribed radii, depths or forces at one resolution; contacts that are no circle are refused."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from contact import (
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
from contact.answer.one_circle import Circle, no_single_circle, refuse_touching
from fem_reference.discrete_layer.material import contact_modulus
from fem_reference.discrete_layer.settings import narrowest_radius
from fem_reference.elastic.at_load import MOST_LEFT, searched_radius, state_at_load
from fem_reference.elastic.path import ContactSolver, FemEquilibrium, flat_punch_equilibria, smooth_equilibrium
from fem_reference.elastic.prescribed_radius import quick_solution
from fem_reference.stated import change_beside

# Relative error of the depth in a quick solution: about three times the largest, that of tabulated profiles.
QUICK_ERROR = 2e-4
# Error of the pressure of a cell over what coarser cells change of it, and the same at points of a flat punch, where
# pressures have waves. Ten times as much answers contacts that MDR refuses.
FINE_SHARE, POINT_SHARE = 0.1, 0.5


@dataclass
class RadiusSearch:
    """Radii [m] of depths [m] or forces / E* [m^2], each searched once for all resolutions."""

    scene: Scene
    log: StageLog
    _found: dict[float, float] = field(default_factory=dict)

    def of(self, target: float) -> float:
        """Radius near which a load is carried."""
        if target not in self._found:
            by_depth = isinstance(self.scene.loading, IndentationDepths)
            self._found[target] = searched_radius(self.scene, target, self.log, by_depth=by_depth)
        return self._found[target]


def elastic_equilibria(
    scene: Scene, solve: ContactSolver, coarsening: float, search: RadiusSearch
) -> list[FemEquilibrium]:
    """States without adhesion at prescribed radii, depths or forces.

    Args:
        scene: the scene.
        solve: contact of a given radius [m].
        coarsening: of the companion's cells, see `Discretisation`.
        search: finds the radii of loads.
    """
    loading = scene.loading
    if isinstance(loading, ContactRadii):
        return [smooth_equilibrium(solve(float(a))) for a in loading.values]
    if isinstance(scene.indenter, FlatPunch):
        return flat_punch_equilibria(scene, scene.indenter.radius, solve)
    if not isinstance(loading, IndentationDepths | NormalForces):
        raise UnsupportedSceneError(f"fem has no elastic path for loading {type(loading).__name__}")
    by_depth = isinstance(loading, IndentationDepths)
    targets = loading.values / (1.0 if by_depth else contact_modulus(scene.layer))
    narrowest = narrowest_radius(scene.layer, scene.indenter, coarsening)
    # A companion may miss the load by any error: that is what is stated of the answer.
    most_left = MOST_LEFT if coarsening == 1.0 else np.inf
    states = []
    for target in map(float, targets):
        start = search.of(target)
        try:
            states.append(state_at_load(scene, target, start, narrowest, solve, by_depth=by_depth, most_left=most_left))
        except NotConvergedError:
            # Contacts with tension inside depend on their radius in any way.
            state = smooth_equilibrium(quick_solution(scene, start, search.log))
            _refuse_pulled(scene, state, state)
            raise
    return states


def refuse_other_contacts(scene: Scene, states: Sequence[FemEquilibrium], coarser: Sequence[FemEquilibrium]) -> None:
    """Refuse contacts that only tension would close, and those that the indenter touches outside the circle.

    Raises:
        UnsupportedSceneError: with the contact radius and the first place where the surface would be pulled or touched.
        InvalidInput: a convex profile presses nowhere, since its slope is not positive yet.
    """
    pairs = list(zip(states, coarser, strict=True))
    if not scene.effects:
        for pair in pairs:
            _refuse_pulled(scene, *pair)
    refuse_touching(scene, (_circle(state, change_beside(state, other)) for state, other in pairs))


def _refuse_pulled(scene: Scene, state: FemEquilibrium, other: FemEquilibrium) -> None:
    radius, is_punch = state.contact_radius, isinstance(scene.indenter, FlatPunch)
    rises = bool(state.contact.indenter.slope(np.array([1e-9]))[0] >= 0)
    if not (scene.layer.is_uniform and scene.indenter.is_convex and rises):
        where = pulled_radius(state, other)
        if where is not None:
            raise no_single_circle(radius, f"would be pulled at r = {where:g} m")
    if not is_punch and min(state.depth, state.force) <= 0:
        raise InvalidInput(
            f"the profile presses nowhere at contact radius {radius:g} m: its slope is not positive there; "
            "prescribe a radius beyond its flat end"
        )


def pulled_radius(state: FemEquilibrium, other: FemEquilibrium) -> float | None:
    """Radius [m] of the first cell that is pulled in smooth contact by more than coarser cells change there.

    Where a slope falls suddenly the pressure is minus infinity, like a logarithm: the means of cells count.
    Under a flat punch points count, since a dip may be narrower than a cell.
    """
    contact, is_punch = state.contact, state.contact.smooth_depth == 0
    radius, weight = contact.contact_trace.gauss(contact.pair.degree + 1)
    fine, coarse = (
        each.contact.pressure(radius.ravel(), each.contact.smooth_depth or 1.0).reshape(radius.shape)
        for each in (state, other)
    )
    change = np.abs(fine - coarse)
    is_pulled = np.sum((fine + FINE_SHARE * change) * weight, axis=1) < 0
    if is_punch:
        is_pulled |= np.any(fine + POINT_SHARE * change < 0, axis=1)
    pulled = np.flatnonzero(is_pulled)
    return float(radius[pulled[0]].mean() * contact.contact_radius) if pulled.size else None


def _circle(state: FemEquilibrium, error: float) -> Circle:
    """In SI units. Pressed deeper than smooth contact, as a last correction leaves it, the edge overlaps by as much."""
    a, deeper = state.contact.contact_radius, max(state.depth - state.contact.smooth_depth, 0.0)
    return Circle(a, a * state.depth, state.surface_displacement, error + a * deeper)


def refuse_touching_at(scene: Scene, radius: float, log: StageLog) -> None:
    """The same for the largest contact [m] of a motion: while it grew, the surface moved as on an elastic layer.

    A compressible layer that relaxes changes its Poisson's ratio meanwhile; here it keeps that of the scene.

    Raises:
        UnsupportedSceneError: With the contact radius and the radius of the deepest overlap.
    """
    if scene.indenter.is_convex or radius <= scene.indenter.flat_radius:
        return
    state = smooth_equilibrium(quick_solution(scene, radius, log))
    refuse_touching(scene, [_circle(state, QUICK_ERROR * state.depth * radius)])
