"""Equilibria without adhesion at prescribed radii, depths or forces at one resolution, and the path of these states.

The load is a depth or a force. The contact radius that belongs to it is unknown. Newton's method on coarse meshes
(`QUICK`) finds it. A full solution at that radius is corrected to first order if its load differs by little,
else the radius is corrected and the solution repeated. At smooth contact dF/da = 0 at fixed depth, so that
``F = F_0 + k_N (delta - delta_0)`` at the solved radius, F_0 its force of smooth contact, errs only in the square of
delta - delta_0.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from contact import (
    ContactPath,
    ContactRadii,
    Fields,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    NormalForces,
    NotConvergedError,
    Scene,
    StageLog,
)
from contact.answer.friction import friction_notes
from contact.answer.one_circle import Circle, no_single_circle, refuse_touching
from contact.answer.solution import Setting
from contact.records.validation import FloatArray
from contact.scene.extent import first_radius
from fem_reference.materials import contact_modulus
from fem_reference.prescribed_contact import QUICK, ContactSolver, Neighbours, PrescribedContact, solve_contact
from fem_reference.profiles import height
from fem_reference.settings import NARROWEST, narrowest_radius

# Largest relative defect of the load that the first-order correction removes, with the square of it as error.
SMALL_DEFECT = 1e-4
# Largest number of full solutions per load. On coarse meshes each radius has a mesh with an error of its own.
ATTEMPTS = 3
# Largest relative defect of the load that the correction removes after the last full solution.
LARGEST_DEFECT = 0.03
# Width of a ring, over the smaller of flat radius and thickness, below which its load grows like the root of the width
# and steps of the search are not limited. With half of it searches take more steps, with twice they may overshoot.
NARROW = 0.1
# Largest number of steps of the search for a radius by quick solutions; five usually suffice.
STEPS = 16
# Relative error of the depth in a quick solution: about three times the largest, that of tabulated profiles.
QUICK_ERROR = 2e-4
# Error of the pressure of a cell over its change on coarser cells, and the same at points of a flat punch, where
# pressures oscillate. Tension below it counts as error. With larger shares contacts with a little tension are accepted,
# with smaller ones contacts without tension may be refused.
FINE_SHARE, POINT_SHARE = 0.1, 0.5
# Radii over the contact radius at which displacements of two meshes are compared, the nearest 6e-8 from the edge.
OUTSIDE = 1.0 + 2.0 ** np.arange(-24.0, 3.0)


@dataclass(frozen=True, kw_only=True)
class FemEquilibrium:
    """One state of a path at one resolution, in units of the mesh's contact radius and of E*.

    Attributes:
        contact: solved contact on the mesh.
        depth: indentation depth delta / a.
        radius_factor: contact radius over that of the mesh; one, except after a correction and for `narrowed` rings.
    """

    contact: PrescribedContact
    depth: float
    radius_factor: float = 1.0

    @property
    def force(self) -> float:
        """Normal force F / (E* a^2)."""
        return self.contact.force(self.depth)

    @property
    def contact_radius(self) -> float:
        """Contact radius [m]."""
        return self.radius_factor * self.contact.contact_radius

    @property
    def stiffness(self) -> float:
        """k_N / (E* a), a of the mesh, continued to the corrected radius by k_N ~ a^n, n = a k_N' / k_N.

        n is one on a half-space, two on a thin compressible layer and four on a thin incompressible bonded one.
        """
        contact = self.contact
        power = contact.stiffness_slope * contact.radius / contact.stiffness
        return float(contact.stiffness * (self.radius_factor / contact.radius) ** power)

    def pressure(self, radius: FloatArray) -> FloatArray:
        """Pressure p / E* at radii [m]."""
        return self.contact.pressure(radius / self.contact.contact_radius, self.depth)

    def surface_displacement(self, radius: FloatArray) -> FloatArray:
        """Displacement u_z [m] on the top at radii [m]; zero beyond the mesh."""
        a = self.contact.contact_radius
        return a * self.contact.surface_displacement(radius / a, self.depth)


def equilibrium_at_depth(contact: PrescribedContact, depth: float) -> FemEquilibrium:
    """State of a solved contact at a depth delta / a; the stress at its edge may be singular."""
    return FemEquilibrium(contact=contact, depth=depth, radius_factor=contact.radius)


def smooth_equilibrium(contact: PrescribedContact) -> FemEquilibrium:
    """The state at depth delta_0, in which the pressure vanishes at the contact edge."""
    return equilibrium_at_depth(contact, contact.smooth_depth)


def targets_of(scene: Scene) -> tuple[FloatArray, bool]:
    """Prescribed depths [m] or forces / E* [m^2], and whether they are depths."""
    loading = scene.loading
    if isinstance(loading, NormalForces):
        return loading.values / contact_modulus(scene.layer), False
    if isinstance(loading, IndentationDepths):
        return loading.values, True
    raise InvalidInput(f"loading = {type(loading).__name__}: a flat punch takes depths or forces")


def flat_punch_equilibria(scene: Scene, solve: ContactSolver) -> list[FemEquilibrium]:
    """States of a flat punch at prescribed depths or forces, from one solution that is proportional to the depth."""
    targets, by_depth = targets_of(scene)
    radius = scene.indenter.flat_radius
    contact = solve(radius)
    depths = targets / radius / (1.0 if by_depth else radius * contact.stiffness)
    return [equilibrium_at_depth(contact, depth) for depth in map(float, depths)]


def elastic_equilibria(
    scene: Scene, solve: ContactSolver, coarsening: float, search: Callable[[float], float]
) -> list[FemEquilibrium]:
    """States without adhesion at prescribed radii, depths or forces.

    Args:
        scene: the scene.
        solve: function that solves the contact of a given radius [m].
        coarsening: growth of cells over that of the answer, see `Discretisation`.
        search: function that returns the approximate radius [m] of a load; see `searched_radius`.
    """
    if isinstance(scene.loading, ContactRadii):
        return [smooth_equilibrium(solve(float(a))) for a in scene.loading.values]
    if isinstance(scene.indenter, FlatPunch):
        return flat_punch_equilibria(scene, solve)
    states = []
    for target in map(float, targets_of(scene)[0]):
        start = search(target)
        try:
            states.append(state_at_load(scene, target, start, solve, coarsening))
        except NotConvergedError:
            # With tension inside the contact the load need not grow with the radius. The message then names it.
            state = smooth_equilibrium(solve_contact(scene, start, QUICK, StageLog()))
            _refuse_pulled(scene, state, state)
            raise
    return states


def state_at_load(
    scene: Scene, target: float, start: float, solve: ContactSolver, coarsening: float = 1.0
) -> FemEquilibrium:
    """State at a prescribed load, from full solutions at corrected radii.

    Args:
        scene: the scene, with depths or forces.
        target: prescribed depth [m] or force / E* [m^2].
        start: first radius [m], close to that of the load.
        solve: function that solves the contact of a given radius [m].
        coarsening: growth of cells over that of the answer. In a companion the correction removes any defect of the
            load, and its error adds to the stated error of the answer.

    Raises:
        NotConvergedError: the defect is above `LARGEST_DEFECT` after `ATTEMPTS` solutions.
    """
    radius, flat, by_depth = start, scene.indenter.flat_radius, targets_of(scene)[1]
    narrowest = narrowest_radius(scene.layer, scene.indenter, coarsening)
    largest_defect = LARGEST_DEFECT if coarsening == 1.0 else np.inf
    for attempt in range(ATTEMPTS):
        contact = solve(max(radius, narrowest))
        scaled_target = target / contact.contact_radius ** (1 if by_depth else 2)
        defect = _load(contact, by_depth) / scaled_target
        if radius <= narrowest and defect > 1:
            contact = contact.narrowed(1 / defect)  # load ~ delta_0 to leading order
            defect = _load(contact, by_depth) / scaled_target
        exponent = load_exponent(contact, flat / contact.contact_radius, by_depth=by_depth)
        corrected = flat + (contact.radius * contact.contact_radius - flat) * defect ** (-1 / exponent)
        if abs(defect - 1) <= (SMALL_DEFECT if attempt < ATTEMPTS - 1 else largest_defect):
            depth = (
                scaled_target
                if by_depth
                else contact.smooth_depth + (scaled_target - contact.smooth_force) / contact.stiffness
            )
            return FemEquilibrium(contact=contact, depth=depth, radius_factor=corrected / contact.contact_radius)
        radius = min(corrected, scene.indenter.max_radius)
    raise NotConvergedError("the contact radius does not settle", {"load_defect": abs(defect - 1)})


def searched_radius(scene: Scene, log: StageLog, target: float) -> float:
    """Radius [m] of smooth contact at a depth [m] or a force / E* [m^2], to about 1e-5, by quick solutions.

    Raises:
        InvalidInput: contact would reach the end of the profile.
        NotConvergedError: the radius does not settle.
    """
    indenter, flat, by_depth = scene.indenter, scene.indenter.flat_radius, targets_of(scene)[1]
    solve = Neighbours(scene, QUICK, log)

    def load_at(radius: float) -> tuple[float, float]:
        """Load over the target at a radius [m], and d ln(load) / d ln(a - flat)."""
        contact = solve(radius)
        load = _load(contact, by_depth) * radius ** (1 if by_depth else 2)
        return load / target, load_exponent(contact, flat / radius, by_depth=by_depth)

    # Estimates f(r) for the depth and 4 E* r f(r) for the force. The search starts at half the load, so that of several
    # contacts at one load it finds the narrowest, which a growing load reaches first.
    start = first_radius(indenter, lambda r: height(indenter, r) * (1.0 if by_depth else 4.0 * r) >= target / 2)
    return radius_of_load(load_at, start, flat, indenter.max_radius, narrowest_radius(scene.layer, indenter))


def _load(contact: PrescribedContact, by_depth: bool) -> float:
    """Depth / a or force / (E* a^2) of smooth contact, a the radius of the mesh."""
    return contact.smooth_depth if by_depth else contact.smooth_force


def load_exponent(contact: PrescribedContact, flat: float, *, by_depth: bool) -> float:
    """Exponent d ln(load) / d ln(a - flat) from one solution, lengths by the radius of its mesh, clipped to [0.2, 1e6].

    Along smooth contacts d(depth)/da = delta_0' and dF/da = k_N delta_0'. Differences of two solutions at neighbouring
    radii would be dominated by the errors of their meshes.
    """
    slope = contact.smooth_depth_slope
    rate = slope / contact.smooth_depth if by_depth else contact.stiffness * slope / contact.smooth_force
    return float(np.clip(rate * (contact.radius - flat), 0.2, 1e6))


def radius_of_load(
    load_at: Callable[[float], tuple[float, float]], start: float, flat: float, end: float, narrowest: float = 0.0
) -> float:
    """Radius a at which a load ratio is one: Newton's method for ln(ratio) over ln(a - flat), else bisection.

    The load grows like a power of a - flat, of which this method finds the root in one step. In narrow rings the power
    is a half, whatever the layer, and steps are not limited there. Elsewhere ln(a - flat) changes by one at most.

    Args:
        load_at: function of the radius that returns load / target and d ln(load) / d ln(a - flat).
        start: first radius.
        flat: radius of the flat end.
        end: radius where the profile ends.
        narrowest: smallest radius, which is returned if the load at it exceeds the target.

    Raises:
        InvalidInput: contact would reach the end of the profile.
        NotConvergedError: the radius does not settle.
    """
    lowest = float(np.log(narrowest - flat)) if flat else -np.inf
    narrow, last = lowest + float(np.log(NARROW / NARROWEST)), float(np.log(end - flat))
    x, low, high = min(float(np.log(max(start - flat, narrowest - flat))), last), -np.inf, np.inf
    for _ in range(STEPS):
        ratio, growth = load_at(flat + float(np.exp(x)))
        # A load that is not positive counts as too small: a larger contact may press.
        y = float(np.log(ratio)) if ratio > 0 else -1.0
        if x == lowest and y > 0:
            return narrowest
        # One more step leaves an error of about y^2.
        if y**2 < SMALL_DEFECT:
            return flat + float(np.exp(np.clip(x - y / growth, lowest, last)))
        if x == last and y < 0:
            raise InvalidInput(f"contact would reach the end of the profile at {end:g} m; press less")
        low, high = (x, high) if y < 0 else (low, x)
        step = -y / growth if x < narrow else float(np.clip(-y / growth, -1, 1))
        following = float(np.clip(x + step, lowest, last))
        x = following if low < following < high or np.isinf(high - low) else (low + high) / 2
    if y < 0 and x > last - 0.1:
        raise InvalidInput(f"contact comes close to the end of the profile at {end:g} m, or would pass it; press less")
    raise NotConvergedError("the contact radius does not settle", {"load_defect": abs(y)})


def refuse_other_contacts(scene: Scene, states: Sequence[FemEquilibrium], coarser: Sequence[FemEquilibrium]) -> None:
    """Refuse tension inside a contact without adhesion, and indenters that also touch outside the contact circle.

    Raises:
        UnsupportedSceneError: tension or a second contact; the message has the contact radius and the place.
        InvalidInput: depth or force is not positive, since the slope of the profile is not positive yet.
    """
    pairs = list(zip(states, coarser, strict=True))
    if not scene.effects:
        for pair in pairs:
            _refuse_pulled(scene, *pair)
    refuse_touching(scene, (circle_of(state, outside_change(state, other)) for state, other in pairs))


def _refuse_pulled(scene: Scene, state: FemEquilibrium, other: FemEquilibrium) -> None:
    """Refuse tension inside a contact without adhesion, and a depth or force that is not positive."""
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
    """Radius [m] of the first cell under tension that exceeds a share of the change on coarser cells; None without one.

    In smooth contact the mean over a cell counts, since at a kink where the slope falls the pressure goes to minus
    infinity like a logarithm. Under a flat punch points count, too, since a dip may be narrower than a cell.
    """
    contact, is_punch = state.contact, state.contact.smooth_depth == 0
    radius, weight = contact.contact_trace.gauss(contact.layer.pair.degree + 1)
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


def outside_change(state: FemEquilibrium, other: FemEquilibrium) -> float:
    """Largest change of the surface displacement outside the contact between two meshes [m], at the radii `OUTSIDE`."""
    radii = state.contact_radius * OUTSIDE
    return float(np.abs(state.surface_displacement(radii) - other.surface_displacement(radii)).max())


def circle_of(state: FemEquilibrium, error: float) -> Circle:
    """Contact circle in SI units, with an error [m] of the surface displacement outside it.

    The correction in `state_at_load` may press deeper than smooth contact. The tolerance includes the resulting overlap
    at the edge, which is no second contact.
    """
    a, deeper = state.contact.contact_radius, max(state.depth - state.contact.smooth_depth, 0.0)
    return Circle(a, a * state.depth, state.surface_displacement, error + a * deeper)


def refuse_touching_at(scene: Scene, radius: float, log: StageLog) -> None:
    """Refuse a motion whose largest contact, of a radius [m], is no single circle on the elastic layer.

    Raises:
        UnsupportedSceneError: a second contact; the message has the contact radius and that of the deepest overlap.
    """
    if scene.indenter.is_convex or radius <= scene.indenter.flat_radius:
        return
    state = smooth_equilibrium(solve_contact(scene, radius, QUICK, log))
    refuse_touching(scene, [circle_of(state, QUICK_ERROR * state.depth * radius)])


def contact_path(
    scene: Scene, states: Sequence[FemEquilibrium], fields: Fields, settings: Mapping[str, Setting], log: StageLog
) -> ContactPath:
    """Path in SI units at one resolution. Its error estimates are the residuals of checks; `stated` adds the errors."""
    modulus = contact_modulus(scene.layer)
    mesh_radius = np.array([state.contact.contact_radius for state in states])
    radius = np.array([state.contact_radius for state in states])
    meshes = ", ".join(dict.fromkeys(state.contact.layer.section.fingerprint for state in states))
    return ContactPath(
        scene=scene,
        method="fem",
        settings={**settings, "mesh": meshes},
        error_estimate={
            name: np.array([getattr(state.contact, name) for state in states])
            for name in ("energy_defect", "patch_defect")
        },
        cost=log.cost(unknowns=max(state.contact.unknowns for state in states)),
        stages=log.records,
        notes=() if scene.effects else friction_notes(scene.layer, radius),
        contact_radius=radius,
        indentation_depth=mesh_radius * np.array([state.depth for state in states]),
        normal_force=modulus * mesh_radius**2 * np.array([state.force for state in states]),
        contact_stiffness=modulus * mesh_radius * np.array([state.stiffness for state in states]),
        fields=fields,
    )
