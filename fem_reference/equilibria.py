"""Equilibria without adhesion at prescribed radii, depths or forces at one resolution, and the path they make.

A depth or force is carried by a contact of unknown radius. Newton's method with coarse solutions finds the radius; a
full solution there is corrected to first order where its load differs by little, else repeated. At smooth contact
dF/da = 0 at given depth, so ``F(delta) = F_0 + k_N (delta - delta_0)`` errs only in the square of the difference.
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
from contact.answer.friction import told_of_friction
from contact.answer.one_circle import Circle, no_single_circle, refuse_touching
from contact.answer.solution import Setting
from contact.records.validation import FloatArray
from contact.scene.extent import first_radius
from fem_reference.materials import contact_modulus
from fem_reference.prescribed_contact import ContactSolver, PrescribedContact, quick_solution
from fem_reference.profiles import height
from fem_reference.settings import NARROWEST, narrowest_radius

# Relative load that is left to the first-order correction, whose error is its square.
LEFT_OVER = 1e-4
# Full solutions of one load: on coarse meshes each radius has a mesh that misses the load by its own error.
ATTEMPTS = 3
# Relative load that the last of them may still leave to the correction.
MOST_LEFT = 0.03
# Width of a ring, over flat radius and thickness, below which its load grows like the root of the width and steps of
# the search are not limited. With half of it searches take more steps, with twice of it they may overshoot.
NARROW = 0.1
# Steps of the search for a radius by quick solutions; five usually suffice.
STEPS = 16
# Relative error of the depth in a quick solution: about three times the largest, that of tabulated profiles.
QUICK_ERROR = 2e-4
# Error of the pressure of a cell over its change on coarser cells, and the same at points of a flat punch, where
# pressures oscillate. With a tenth, contacts with a little tension are answered.
FINE_SHARE, POINT_SHARE = 0.1, 0.5
# Radii over the contact's at which displacements of two meshes are compared, down to the cell at the edge.
BESIDE = 1.0 + 2.0 ** np.arange(-24.0, 3.0)


@dataclass(frozen=True, kw_only=True)
class FemEquilibrium:
    """One state of a path at one resolution, in units of the mesh's contact radius and of E*.

    Attributes:
        contact: the solved contact.
        depth: delta / a.
        radius_factor: contact radius over that of the mesh, one up to a last correction.
    """

    contact: PrescribedContact
    depth: float
    radius_factor: float = 1.0

    @property
    def force(self) -> float:
        """F / (E* a^2)."""
        return self.contact.force(self.depth)

    @property
    def contact_radius(self) -> float:
        """Contact radius [m]."""
        return self.radius_factor * self.contact.contact_radius

    @property
    def stiffness(self) -> float:
        """k_N / (E* a) at the corrected radius, by its power of the radius here: one where h >> a, two to four else."""
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


def held_equilibrium(contact: PrescribedContact, depth: float) -> FemEquilibrium:
    """Contact held at its radius, at depth / a."""
    return FemEquilibrium(contact=contact, depth=depth, radius_factor=contact.radius)


def smooth_equilibrium(contact: PrescribedContact) -> FemEquilibrium:
    """The state in which the pressure vanishes at the contact edge."""
    return held_equilibrium(contact, contact.smooth_depth)


def targets_of(scene: Scene) -> tuple[FloatArray, bool]:
    """Prescribed depths [m] or forces / E* [m^2], and whether they are depths."""
    loading = scene.loading
    if isinstance(loading, NormalForces):
        return loading.values / contact_modulus(scene.layer), False
    if isinstance(loading, IndentationDepths):
        return loading.values, True
    raise InvalidInput(f"loading = {type(loading).__name__}: a flat punch takes depths or forces")


def flat_punch_equilibria(scene: Scene, solve: ContactSolver) -> list[FemEquilibrium]:
    """A flat punch at prescribed depths or forces: one solution, scaled."""
    targets, by_depth = targets_of(scene)
    radius = scene.indenter.flat_radius
    contact = solve(radius)
    depths = targets / radius / (1.0 if by_depth else radius * contact.stiffness)
    return [held_equilibrium(contact, depth) for depth in map(float, depths)]


def elastic_equilibria(
    scene: Scene, solve: ContactSolver, coarsening: float, search: Callable[[float], float]
) -> list[FemEquilibrium]:
    """States without adhesion at prescribed radii, depths or forces.

    Args:
        scene: the scene.
        solve: contact of a given radius [m].
        coarsening: of the companion's cells, see `Discretisation`.
        search: radius [m] near which a load is carried, see `searched_radius`.
    """
    if isinstance(scene.loading, ContactRadii):
        return [smooth_equilibrium(solve(float(a))) for a in scene.loading.values]
    if isinstance(scene.indenter, FlatPunch):
        return flat_punch_equilibria(scene, solve)
    targets, by_depth = targets_of(scene)
    narrowest = narrowest_radius(scene.layer, scene.indenter, coarsening)
    # A companion may miss the load by any error, which then is stated of the answer.
    most_left = MOST_LEFT if coarsening == 1.0 else np.inf
    states = []
    for target in map(float, targets):
        start = search(target)
        try:
            states.append(state_at_load(scene, target, start, narrowest, solve, by_depth=by_depth, most_left=most_left))
        except NotConvergedError:
            # The load of contacts with tension inside may depend on their radius in any way.
            state = smooth_equilibrium(quick_solution(scene, start, StageLog()))
            _refuse_pulled(scene, state, state)
            raise
    return states


def state_at_load(
    scene: Scene,
    target: float,
    start: float,
    narrowest: float,
    solve: ContactSolver,
    *,
    by_depth: bool,
    most_left: float = MOST_LEFT,
) -> FemEquilibrium:
    """The state at a prescribed load, by full solutions.

    Args:
        scene: the scene.
        target: a depth [m] or a force / E* [m^2].
        start: radius [m] near which the load is carried.
        narrowest: smallest radius [m] that is meshed.
        solve: contact of a given radius [m].
        by_depth: whether the target is a depth.
        most_left: relative load that the last solution may leave to the correction.

    Raises:
        NotConvergedError: the radius does not settle.
    """
    radius, flat = start, scene.indenter.flat_radius
    for attempt in range(ATTEMPTS):
        contact = solve(max(radius, narrowest))
        scaled = target / contact.contact_radius ** (1 if by_depth else 2)
        defect = _load(contact, by_depth) / scaled
        if radius <= narrowest and defect > 1:
            contact = contact.narrowed(1 / defect)
            defect = _load(contact, by_depth) / scaled
        exponent = grows_like(contact, flat / contact.contact_radius, by_depth=by_depth)
        corrected = flat + (contact.radius * contact.contact_radius - flat) * defect ** (-1 / exponent)
        if abs(defect - 1) <= (LEFT_OVER if attempt < ATTEMPTS - 1 else most_left):
            moved = 0.0 if by_depth else (scaled - contact.smooth_force) / contact.stiffness
            depth = scaled if by_depth else contact.smooth_depth + moved
            return FemEquilibrium(contact=contact, depth=depth, radius_factor=corrected / contact.contact_radius)
        radius = min(corrected, scene.indenter.max_radius)
    raise NotConvergedError("the contact radius does not settle", {"load_defect": abs(defect - 1)})


def searched_radius(scene: Scene, log: StageLog, target: float) -> float:
    """Radius [m] of a depth [m] or a force / E* [m^2], to about 1e-5, by quick solutions.

    Raises:
        InvalidInput: contact would reach the end of the profile.
        NotConvergedError: the radius does not settle.
    """
    indenter, flat, by_depth = scene.indenter, scene.indenter.flat_radius, targets_of(scene)[1]

    def load_at(radius: float) -> tuple[float, float]:
        contact = quick_solution(scene, radius, log)
        load = _load(contact, by_depth) * radius ** (1 if by_depth else 2)
        return load / target, grows_like(contact, flat / radius, by_depth=by_depth)

    # Half the load: of several contacts the narrowest is found, as it is when the load grows.
    start = first_radius(indenter, lambda r: height(indenter, r) * (1.0 if by_depth else 4.0 * r) >= target / 2)
    return radius_of_load(load_at, start, flat, indenter.max_radius, narrowest_radius(scene.layer, indenter))


def _load(contact: PrescribedContact, by_depth: bool) -> float:
    """Depth / a or force / (E* a^2) of smooth contact."""
    return contact.smooth_depth if by_depth else contact.smooth_force


def grows_like(contact: PrescribedContact, flat: float, *, by_depth: bool) -> float:
    """d ln(load) / d ln(a - flat) of one solution, lengths by its radius, within [0.2, 1e6].

    The depth grows by its slope, the force by k_N times that. Differences of neighbouring radii, each with a mesh of
    its own, are useless where the errors of the meshes are as large.
    """
    slope = contact.smooth_depth_slope
    grows = slope / contact.smooth_depth if by_depth else contact.stiffness * slope / contact.smooth_force
    return float(np.clip(grows * (contact.radius - flat), 0.2, 1e6))


def radius_of_load(
    load_at: Callable[[float], tuple[float, float]], start: float, flat: float, end: float, narrowest: float = 0.0
) -> float:
    """Radius a at which a load ratio is one: Newton's method in logarithms, or bisection.

    Near a flat end the load grows like a power of a - flat, elsewhere like a power of a. In narrow rings that power is
    a half, whatever the layer: there steps may be long.

    Args:
        load_at: load ratio at a radius, and its power of a - flat.
        start: first radius.
        flat: radius of the flat end.
        end: radius where the profile ends.
        narrowest: smallest radius, which is returned where even that carries more.

    Raises:
        InvalidInput: contact would reach the end of the profile.
        NotConvergedError: the radius does not settle.
    """
    least = float(np.log(narrowest - flat)) if flat else -np.inf
    narrow, last = least + float(np.log(NARROW / NARROWEST)), float(np.log(end - flat))
    x, low, high = min(float(np.log(max(start - flat, narrowest - flat))), last), -np.inf, np.inf
    for _ in range(STEPS):
        ratio, growth = load_at(flat + float(np.exp(x)))
        # Where contact presses nowhere, a larger one may.
        y = float(np.log(ratio)) if ratio > 0 else -1.0
        if x == least and y > 0:
            return narrowest
        # A last step leaves about the square of this.
        if y**2 < LEFT_OVER:
            return flat + float(np.exp(np.clip(x - y / growth, least, last)))
        if x == last and y < 0:
            raise InvalidInput(f"contact would reach the end of the profile at {end:g} m; press less")
        low, high = (x, high) if y < 0 else (low, x)
        step = -y / growth if x < narrow else float(np.clip(-y / growth, -1, 1))
        following = float(np.clip(x + step, least, last))
        x = following if low < following < high or np.isinf(high - low) else (low + high) / 2
    if y < 0 and x > last - 0.1:
        raise InvalidInput(f"contact comes close to the end of the profile at {end:g} m, or would pass it; press less")
    raise NotConvergedError("the contact radius does not settle", {"load_defect": abs(y)})


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
    """Radius [m] of the first cell that is pulled in smooth contact by more than its change on coarser cells.

    Where a slope falls suddenly the pressure is minus infinity, like a logarithm: the means of cells count.
    Under a flat punch points count, since a dip may be narrower than a cell.
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


def change_beside(state: FemEquilibrium, other: FemEquilibrium) -> float:
    """Largest change of the surface outside the contact between two meshes [m]."""
    radii = state.contact_radius * BESIDE
    return float(np.abs(state.surface_displacement(radii) - other.surface_displacement(radii)).max())


def _circle(state: FemEquilibrium, error: float) -> Circle:
    """The contact in SI units. Pressed deeper than smooth contact by the last correction, its edge overlaps as much."""
    a, deeper = state.contact.contact_radius, max(state.depth - state.contact.smooth_depth, 0.0)
    return Circle(a, a * state.depth, state.surface_displacement, error + a * deeper)


def refuse_touching_at(scene: Scene, radius: float, log: StageLog) -> None:
    """Refuse a motion whose largest contact [m] is no single circle, as if the layer were elastic.

    Raises:
        UnsupportedSceneError: with the contact radius and the radius of the deepest overlap.
    """
    if scene.indenter.is_convex or radius <= scene.indenter.flat_radius:
        return
    state = smooth_equilibrium(quick_solution(scene, radius, log))
    refuse_touching(scene, [_circle(state, QUICK_ERROR * state.depth * radius)])


def contact_path(
    scene: Scene, states: Sequence[FemEquilibrium], fields: Fields, settings: Mapping[str, Setting], log: StageLog
) -> ContactPath:
    """The path in SI units at one resolution; it states no errors yet, only the residuals of its own checks."""
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
        notes=() if scene.effects else told_of_friction(scene.layer, radius),
        contact_radius=radius,
        indentation_depth=mesh_radius * np.array([state.depth for state in states]),
        normal_force=modulus * mesh_radius**2 * np.array([state.force for state in states]),
        contact_stiffness=modulus * mesh_radius * np.array([state.stiffness for state in states]),
        fields=fields,
    )
