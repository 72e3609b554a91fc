"""Elastic contact without effects: equilibria under prescribed radii, depths or forces."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np

from bem.layer_equation.profiles.half_space_slope import has_closed_slope
from bem.layer_equation.protocol import FlatPunchSolution, FlatPunchSource
from bem.polynomials.chebyshev import BLOCK
from bem.polynomials.mapped import MappedFunction
from contact import (
    ContactPath,
    ContactRadii,
    ElasticLayer,
    FlatPunch,
    IndentationDepths,
    NormalForces,
    Scene,
    StageLog,
)
from contact.answer.friction import told_of_friction
from contact.answer.inside import InteriorFields, KnownContact
from contact.answer.solution import Setting
from contact.records.validation import FloatArray
from mdr.radius_search import SeveralContacts
from mdr.springs.assembly import contact_fields
from mdr.springs.beside_contact import refuse_touching_beside
from mdr.springs.equivalent_system import EquivalentSystem
from mdr.springs.error_model import PRESSURE_ROUNDING, SAMPLED_ROUNDING
from mdr.springs.pulling import refuse_pulling
from mdr.springs.reach import beyond_falls, covering_system
from mdr.springs.surface_fields import ContactFields

if TYPE_CHECKING:
    from bem.layer_equation.inside.interior import ContactInterior

# Relative errors of density and radius together, over k_bar, from which on fields inside are compared with those of
# finer data: below, roundings count as much, and no finer data have less of them.
_EXACT = 1e-12
# Share of the stated error of a radius by which one errs where roundings alone are stated, since they seldom add up:
# 0.18 at worst of 155 contacts under a given force (campaign of the fields inside, seeds 19201 and 19401, 2026-11-22).
_ROUNDED_RADIUS = 0.25
# But a radius that was found is no better than its last digit, and it and a point's place are rounded once more in the
# density's unit: 1.5 of that digit. The share alone gave 1.2 where 1.26 were missing, 6e-7 a from the edge of a sphere
# pressed nearly to its equator (scene 738 of seed 19701, 2026-11-23).
_LAST_DIGITS = 1.5 * float(np.finfo(float).eps)


def solve_elastic(scene: Scene, flat_punch: FlatPunchSource, settings: Mapping[str, Setting]) -> ContactPath:
    """Contact radius, depth, force and stiffness, with pressure and displacement on demand.

    Raises:
        InvalidInput: If a prescribed value is out of reach of the indenter or the flat-punch data.
        SeveralContacts: If the contact would not be one circle.
        UnsupportedSceneError: If the indenter would touch beside it.
    """
    log = StageLog()
    source = LoggedSource(flat_punch, log)
    with log.stage("mdr_profile"):
        system, chosen = _system(scene, source)
    with log.stage("force"):
        values = getattr(scene.loading, "values", np.empty(0))
        found = _in_blocks(partial(_equilibria, system, scene), values=values, chosen=chosen)
        excess, radius, depth, force, stiffness = (found[name] for name in ("excess", *ContactPath.ARRAYS))
    fields = PathFields(scene, system.flat_punch, excess, depth, partial(density_errors, system, scene, radius))
    fields = replace(fields, load=system.load, finer=by_finer_data(solve_elastic, scene, flat_punch, settings))
    if chosen is None:
        refuse_touching_beside(scene, system, radius, depth, fields.contact)
    state = {"radius": radius, "depth": depth, "force": force, "contact_stiffness": stiffness}
    errors = _in_blocks(partial(_errors, system, scene), **state)
    refuse_pulling(scene, fields, radius, force, float(errors["pressure"].max()))
    return ContactPath(
        scene=scene,
        method="mdr",
        settings=settings,
        contact_radius=radius,
        indentation_depth=depth,
        normal_force=force,
        contact_stiffness=stiffness,
        error_estimate=errors,
        cost=log.cost(unknowns=getattr(system.flat_punch, "unknowns", 0)),
        stages=log.records,
        notes=told_of_friction(scene.layer, radius),
        fields=fields,
    )


@dataclass(frozen=True)
class LoggedSource:
    """A flat-punch source whose work is written into a stage log."""

    source: FlatPunchSource
    log: StageLog

    def solution(self, layer: ElasticLayer, max_ratio: float) -> FlatPunchSolution:
        """As the source's; counts the solutions asked for, whether made or found in its cache."""
        with self.log.stage("flat_punch_data"):
            self.log.count("flat_punch_solutions")
            return self.source.solution(layer, max_ratio)

    def refined(self) -> LoggedSource:
        """The refined source with the same log."""
        return LoggedSource(self.source.refined(), self.log)


@dataclass(frozen=True, eq=False)
class PathFields:
    """Surface fields of every step of a path, each contact solved when it is first asked for.

    Attributes:
        scene: The problem.
        flat_punch: The solution the path was made of.
        excess: a - b [m] over the radius of the flat end, shape (n,).
        indentation_depth: delta [m], shape (n,).
        density_error: Tells, when fields inside are asked for, what they lose in solving for the density, relative,
            shape (n,); if unknown the pressure's error.
        edge_error: Error of the density's value at the edge [m], shape (n,).
        singular_edge: Whether the pressure may be singular at the edge; by default only under a flat punch.
        finer: The body under one step by refined flat punches; what fields differ then tells their errors.
        load: g_hs on pieces that all contacts share, where they do.
    """

    scene: Scene
    flat_punch: FlatPunchSolution
    excess: FloatArray
    indentation_depth: FloatArray
    density_error: Callable[[], FloatArray | None] | None = None
    edge_error: FloatArray | None = None
    singular_edge: bool | None = None
    finer: Callable[[int], ContactInterior] | None = None
    load: MappedFunction | None = None
    _contacts: dict[int, ContactFields] = field(default_factory=dict)

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """p(r) [Pa], zero outside the contact."""
        return self.contact(step).pressure(radius)

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """w(r) [m]."""
        return self.contact(step).surface_displacement(radius)

    def falls(self, step: int) -> bool:
        """Whether the Abel density of one step falls from the axis to an edge value that is not negative."""
        density = self.contact(step).density
        return self.scene.indenter.is_convex and density is not None and density.falls

    def inside(self, step: int, known: KnownContact) -> InteriorFields:
        """The body under one step; where its data are coarse, compared with finer ones."""
        own = self.body(step, known)
        if self.finer is None or own.known.density_error + known.radius_error < self._rounded(own.density.radius):
            return own
        # As below.
        from bem.layer_equation.inside.compared import ComparedInterior  # noqa: PLC0415

        return ComparedInterior(own, self.finer(step))

    def body(self, step: int, known: KnownContact) -> ContactInterior:
        """The body under one step, as the density of the contact alone makes it."""
        # Half of what an answer would import otherwise, for those who look inside.
        from bem.layer_equation.inside.interior import ContactInterior  # noqa: PLC0415
        from mdr.springs.inside import density_of  # noqa: PLC0415

        contact = self.contact(step)
        if self._density_errors is not None:
            known = known._replace(density_error=float(self._density_errors[step]))
        if self.edge_error is not None:
            known = known._replace(edge_error=float(self.edge_error[step]))
        elif 0.0 < known.radius_error < self._rounded(contact.contact_radius):
            known = known._replace(radius_error=max(_ROUNDED_RADIUS * known.radius_error, _LAST_DIGITS))
        return ContactInterior(
            self.scene, density_of(contact, self.scene.layer), contact.unit, contact.indentation_depth, known
        )

    def _rounded(self, radius: float) -> float:
        """Errors below which roundings are all there is, at a radius by the contact's unit."""
        return _EXACT * max(1.0, float(self.flat_punch.normalized_contact_stiffness(radius)))

    @cached_property
    def _density_errors(self) -> FloatArray | None:
        return self.density_error() if self.density_error is not None else None

    def contact(self, step: int) -> ContactFields:
        """One step's contact."""
        if step not in self._contacts:
            is_punch = isinstance(self.scene.indenter, FlatPunch)
            self._contacts[step] = contact_fields(
                self.scene.layer,
                self.scene.indenter,
                self.flat_punch,
                excess=float(self.excess[step]),
                depth=float(self.indentation_depth[step]),
                edge=is_punch if self.singular_edge is None else self.singular_edge,
                load=self.load,
            )
        return self._contacts[step]


def by_finer_data(
    solve: Callable[[Scene, FlatPunchSource, Mapping[str, Setting]], ContactPath],
    scene: Scene,
    flat_punch: FlatPunchSource,
    settings: Mapping[str, Setting],
) -> Callable[[int], ContactInterior] | None:
    """Solves for the body under one step with refined flat punches, where panels refine them."""
    layer, loading = scene.layer, scene.loading
    refines = layer.is_piecewise_uniform and not layer.is_half_space
    if not (refines and isinstance(loading, ContactRadii | IndentationDepths | NormalForces)):
        return None

    def finer(step: int) -> ContactInterior:
        """The body under that step."""
        alone = scene.replace(loading=type(loading)(loading.values[[step]]))
        path = solve(alone, flat_punch.refined(), settings)
        assert isinstance(path.fields, PathFields)
        names = ("contact_radius", "pressure")
        errors = (float(np.broadcast_to(path.error_estimate[name], 1)[0]) for name in names)
        return path.fields.body(0, KnownContact(float(path.contact_radius[0]), *errors))

    return finer


def _system(scene: Scene, source: LoggedSource) -> tuple[EquivalentSystem, FloatArray | None]:
    """The equivalent system, and a - b where a profile that falls on the way leaves a choice."""
    try:
        return covering_system(scene, source), None
    except SeveralContacts as ring:
        return beyond_falls(scene, source, ring)


def _in_blocks(compute: Callable[..., dict[str, FloatArray]], **values: FloatArray | None) -> dict[str, FloatArray]:
    """What is computed of each value by itself, so many at a time that all intermediate arrays stay in the cache."""
    blocks = -(-max(one.size for one in values.values() if one is not None) // BLOCK)
    if blocks <= 1:
        return compute(**values)
    parts = [[None] * blocks if one is None else np.array_split(one, blocks) for one in values.values()]
    found = [compute(**dict(zip(values, block, strict=True))) for block in zip(*parts, strict=True)]
    return {name: np.concatenate([part[name] for part in found]) for name in found[0]}


def _equilibria(
    system: EquivalentSystem, scene: Scene, values: FloatArray, chosen: FloatArray | None
) -> dict[str, FloatArray]:
    """a - b, a, the depth, the force and k_N for prescribed values."""
    excess, depth = _excess_and_depth(system, scene, values, chosen)
    radius = values if isinstance(scene.loading, ContactRadii) else system.flat_radius + excess
    stiffness = system.contact_stiffness(radius)
    # Where two pieces meet polynomials leap, and no radius may have the prescribed force to the last digit.
    force = values if isinstance(scene.loading, NormalForces) else system.force(radius, depth, stiffness)
    return {"excess": excess} | dict(zip(ContactPath.ARRAYS, (radius, depth, force, stiffness), strict=True))


def _excess_and_depth(
    system: EquivalentSystem, scene: Scene, values: FloatArray, chosen: FloatArray | None
) -> tuple[FloatArray, FloatArray]:
    """a - b and the depth, Eq. (3); a flat punch keeps its radius."""
    if chosen is not None:
        by_depth = isinstance(scene.loading, IndentationDepths)
        return chosen, values if by_depth else system.profile_beyond(chosen)
    excess = np.zeros_like(values)
    if isinstance(scene.loading, ContactRadii):
        excess = values - system.flat_radius
        return excess, system.profile_beyond(excess)
    by_depth = isinstance(scene.loading, IndentationDepths)
    if isinstance(scene.indenter, FlatPunch):
        return excess, values if by_depth else values / system.contact_stiffness(excess + scene.indenter.radius)
    excess = system.excess_at_depth(values) if by_depth else system.excess_at_force(values)
    return excess, values if by_depth else system.profile_beyond(excess)


def _errors(
    system: EquivalentSystem,
    scene: Scene,
    radius: FloatArray,
    *,
    depth: FloatArray,
    force: FloatArray,
    contact_stiffness: FloatArray,
) -> dict[str, FloatArray]:
    """Relative errors of what was not prescribed; of the pressure in the norm weighted with 2 pi r."""
    errors, given = system.relative_errors(radius, of_springs=False), type(scene.loading).__name__
    stiffness, ratio, exact = errors["contact_stiffness"], radius / system.length_unit, np.zeros_like(radius)
    if isinstance(scene.indenter, FlatPunch):
        of_depth = exact if given == "IndentationDepths" else stiffness
        return {
            "contact_radius": exact,
            "contact_stiffness": stiffness,
            "pressure": system.flat_punch.punch_pressure_error(ratio) + of_depth + PRESSURE_ROUNDING,
            "surface_displacement": system.flat_punch.spring_error(ratio) + of_depth + PRESSURE_ROUNDING,
            "indentation_depth": of_depth,
            "normal_force": stiffness - of_depth,
        }
    # F = k_N g - int g dk_N: an error of g counts against the difference, one of k_N in F = int k_N dg does not
    spread = contact_stiffness * depth / force
    of_depth, of_moment = errors["indentation_depth"], system.moment_truncation(radius) * np.abs(spread - 1)
    passed = system.error_in_force(radius, stiffness=stiffness, spread=spread)
    at_depth = system.error_at_depth(radius, stiffness=passed, depth=of_depth, spread=spread) + of_moment
    # Under a given radius F errs as under the given depth, and by k_N times the error of g, which is no part of that.
    of_force = np.minimum(passed + of_depth * spread + of_moment, np.hypot(at_depth, of_depth * spread))
    searched = of_force / spread if given == "NormalForces" else of_depth
    moved, growth, of_density = exact, exact, system.flat_punch.contact_pressure_error(ratio, of_depth)
    rounding = PRESSURE_ROUNDING if has_closed_slope(scene.indenter) else SAMPLED_ROUNDING
    if given != "ContactRadii":  # dF = k_N dg: of g, or of F over k_N g; and d(ln k_N)/d(ln a)
        # The noise of a table may let its slope fall.
        moved = searched * depth / (radius * np.abs(system.mdr_profile_slope(radius)))
        growth = 2.0 * system.spring_stiffness(radius) * radius / contact_stiffness
        of_force, of_depth = np.minimum(of_force, at_depth), at_depth / spread
    return {
        "contact_radius": moved,
        "indentation_depth": exact if given == "IndentationDepths" else of_depth,
        "normal_force": exact if given == "NormalForces" else of_force,
        "contact_stiffness": stiffness + growth * moved,
        # Between the rim of a flat end and the edge pressures go with the excess.
        "pressure": of_density + moved / np.maximum(1.0 - system.flat_radius / radius, PRESSURE_ROUNDING) + rounding,
        # An error of g moves the surface like a flat punch, by no more than itself; without an edge density that of a
        # does nothing.
        "surface_displacement": errors["indentation_depth"] + rounding,
    }


def density_errors(system: EquivalentSystem, scene: Scene, radius: FloatArray) -> FloatArray | None:
    """Of the density whose slope the fields inside make by an integral; tables have none."""
    if system.variants:
        return None
    ratio = radius / system.length_unit
    if isinstance(scene.indenter, FlatPunch):
        if not scene.layer.is_piecewise_uniform:
            # What slopes of panels that shrink towards the edge miss counts as in the pressure.
            return PRESSURE_ROUNDING + system.flat_punch.punch_pressure_error(ratio)
        return PRESSURE_ROUNDING + system.flat_punch.spring_error(ratio)
    depth_error = system.relative_errors(radius, of_springs=False)["indentation_depth"]
    # Closed slopes are as good as the quadrature over them, which fields inside state themselves.
    rounding = 0.0 if has_closed_slope(scene.indenter) else SAMPLED_ROUNDING
    return rounding + system.flat_punch.contact_density_error(ratio, depth_error)
