"""Contact of one given radius: stiffness, its derivative, the depth of smooth contact, forces and surface fields.

Units: lengths by the contact radius a, stresses by E*. Two solutions of one factorisation determine everything: u_1
with u_z = 1 on the contact, a flat punch at unit depth, and u_2 with u_z = -f(r), the profile f at depth zero. At depth
delta the solution is delta u_1 + u_2, and the force ``F = k_N delta + F_2``. A prime is the derivative by a at fixed
depth and layer. From dPi/d(delta) = F the elastic energy Pi(delta, a) obeys d^2 Pi/(da d delta) = k_N' delta + F_2'.
dPi/da is proportional to the square of the stress intensity at the edge, which is linear in delta. Hence

    dPi/da = k_N' (delta - delta_0)^2 / 2,     delta_0 = -F_2' / k_N',     G = (dPi/da) / (2 pi a),

with the energy release rate G. The stress at the contact edge vanishes at the depth delta_0 = g(a) of smooth contact,
which is the depth without adhesion.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TypeAlias

import numpy as np
from scipy.linalg import solveh_banded

from contact import NotConvergedError, Scene, StageLog
from contact.records.validation import FloatArray
from fem_reference.layer import DiscreteLayer
from fem_reference.mesh import Section
from fem_reference.profiles import ScaledIndenter
from fem_reference.settings import Discretisation, contact_section, narrowest_radius
from fem_reference.solver import RestrictedSolver
from fem_reference.surface import TraceSpace

# Largest relative difference of the stiffness by energy and by reactions: sound solutions agree to 1e-12, a broken
# factorisation errs by 1e-2.
ENERGY_AGREEMENT = 1e-8
# Largest `DiscreteLayer.patch_defect`: fifty thousand roundings.
PATCH_AGREEMENT = 1e-11
# Settings of quick solutions, on which the radius of a load is searched: depth and force err by about 3e-5. With a
# growth of 0.7 they err by 2e-4, and most loads take two full solutions.
QUICK = Discretisation(order=3, growth=0.5, edge_cell=3e-5, truncation=1e-5, half_space_thickness=1e6)
# Rings next to the contact edge, inside it, in which the slope of delta_0 is averaged: width of the widest over the
# smallest length there, and their number. The slope errs by 3e-4 at growth 1/2. From one cell it errs by any factor.
WIDEST, RINGS = 0.8, 5


@dataclass(frozen=True, kw_only=True)
class PrescribedContact:
    """Solutions u_1, u_2 on one mesh at contact radius one, and the numbers that follow from them.

    Attributes:
        layer: the discrete layer.
        indenter: the profile in units of the contact radius.
        stiffness: stiffness k_N = dF/d(delta) at fixed radius.
        stiffness_slope: derivative k_N' = dk_N/da.
        smooth_depth: depth delta_0 at which the stress at the contact edge vanishes; zero for a flat punch.
        smooth_depth_slope: derivative delta_0' = d(delta_0)/da.
        profile_force: force F_2 at depth zero; negative, since there the surface is pulled up to the profile.
        solutions: all unknowns of u_1 and u_2, shape (size, 2).
        contact_trace: piecewise polynomials on the contact.
        pressures: pressures of u_1 and u_2 at the nodes of ``contact_trace``, shape (node, 2).
        top_trace: piecewise polynomials on the whole top.
        displacements: u_z of u_1 and u_2 at the nodes of ``top_trace``, shape (node, 2).
        energy_defect: relative difference |k_N by energy / k_N by reactions - 1|.
        patch_defect: largest relative residual of the patch test, see `DiscreteLayer.patch_defect`.
        radius: contact radius over that of the mesh, below one after `narrowed` only.
    """

    layer: DiscreteLayer
    indenter: ScaledIndenter
    stiffness: float
    stiffness_slope: float
    smooth_depth: float
    smooth_depth_slope: float
    profile_force: float
    solutions: FloatArray
    contact_trace: TraceSpace
    pressures: FloatArray
    top_trace: TraceSpace
    displacements: FloatArray
    energy_defect: float
    patch_defect: float
    radius: float = 1.0

    @property
    def unknowns(self) -> int:
        """Size of the linear system."""
        return len(self.solutions)

    @property
    def contact_radius(self) -> float:
        """Contact radius of the mesh [m]."""
        return self.indenter.contact_radius

    def force(self, depth: float) -> float:
        """Normal force F = k_N delta + F_2 at a depth, the contact radius fixed."""
        return self.stiffness * depth + self.profile_force

    @property
    def smooth_force(self) -> float:
        """Normal force of smooth contact, k_N delta_0 + F_2."""
        return self.force(self.smooth_depth)

    def pressure(self, radius: FloatArray, depth: float) -> FloatArray:
        """Pressure p(r) at a depth, at radii of shape (n,); zero outside the contact."""
        return self.contact_trace.evaluate(self.pressures @ [depth, 1.0], radius)

    def surface_displacement(self, radius: FloatArray, depth: float) -> FloatArray:
        """Displacement u_z(r) on the top at a depth, at radii of shape (n,); zero beyond the mesh."""
        return self.top_trace.evaluate(self.displacements @ [depth, 1.0], radius)

    @property
    def shear_traction(self) -> FloatArray:
        """Radial traction q of a sticking punch at depth one, at the contact nodes, shape (node,); zero on the axis.

        ``int q v 2 pi r dr`` equals the radial reaction to v for every polynomial v that vanishes on the axis.
        """
        reactions = (self.layer.matrix @ self.solutions[:, 0])[2 * self.layer.top_nodes(1.0)]
        bands = self.contact_trace.mass_bands()[:, 1:]
        return np.concatenate([[0.0], solveh_banded(bands, reactions[1:], lower=True, check_finite=False)])

    def narrowed(self, share: float) -> PrescribedContact:
        """The contact whose ring around a flat end has ``share^2`` times the width, by its leading-order powers.

        The ring lies between the flat radius b and the contact radius a, of width w = a - b << b. To leading order k_N
        is linear in a, while delta_0 and the fields of u_2 outside the ring grow like ``w^(1/2)``. From smooth contact,
        ``k_N delta_0 + F_2 = int k_N d(delta_0)``, follows ``F_2 = -int delta_0 k_N' da ~ w^(3/2)``.

        Args:
            share: factor on delta_0, at most one.
        """
        shares, narrowing = np.array([1.0, share]), (1.0 - self.indenter.last_kink) * (1 - share**2)
        return replace(
            self,
            stiffness=self.stiffness - self.stiffness_slope * narrowing,
            smooth_depth=share * self.smooth_depth,
            smooth_depth_slope=self.smooth_depth_slope / share,
            profile_force=share**3 * self.profile_force,
            pressures=self.pressures * shares,
            displacements=self.displacements * shares,
            solutions=self.solutions * shares,
            radius=1 - narrowing,
        )


# Solves the contact of a given radius [m].
ContactSolver: TypeAlias = Callable[[float], PrescribedContact]


@dataclass
class Neighbours:
    """Solver of contacts of given radii [m]. Contacts of similar proportions share a mesh, which is stretched.

    If the mesh needs no stretching, as on a half-space under a smooth profile, they share the factorised matrix, too.

    Attributes:
        scene: layer and indenter.
        settings: numerical settings.
        log: record of time and memory by stage.
        sticks: whether u_r = 0 under the indenter.
        sections: meshes made so far, before they are stretched.
        factorised: layer on the last mesh and its factorised matrix.
    """

    scene: Scene
    settings: Discretisation
    log: StageLog
    sticks: bool = False
    sections: list[Section] = field(default_factory=list)
    factorised: tuple[DiscreteLayer, RestrictedSolver] | None = None

    def __call__(self, radius: float) -> PrescribedContact:
        """The contact of a radius [m].

        Where the ring around a flat end is narrower than `narrowest_radius` allows, the narrowest meshed contact is
        solved and `PrescribedContact.narrowed`.
        """
        layer, profile, settings = self.scene.layer, self.scene.indenter, self.settings
        flat = profile.flat_radius
        meshed = max(radius, narrowest_radius(layer, profile, settings.coarsening)) if radius > flat else radius
        indenter = ScaledIndenter(profile, meshed)
        with self.log.stage("mesh"):
            parts, section = contact_section(layer, indenter, settings, self.sections)
        if self.factorised is None or section is not self.factorised[0].section:
            discrete = DiscreteLayer(section, settings.pair, parts, self.sticks)
            self.factorised = discrete, factorised_contact(discrete, self.log)
        discrete, solver = self.factorised
        contact = solve_prescribed_contact(discrete, indenter, self.log, solver)
        return contact if meshed == radius else contact.narrowed(float(np.sqrt((radius - flat) / (meshed - flat))))


def solve_contact(
    scene: Scene, radius: float, settings: Discretisation, log: StageLog, *, sticks: bool = False
) -> PrescribedContact:
    """Mesh the section around a contact radius [m] and solve it; the arguments are those of `Neighbours`."""
    return Neighbours(scene, settings, log, sticks)(radius)


def factorised_contact(layer: DiscreteLayer, log: StageLog) -> RestrictedSolver:
    """Factorised layer with u_z prescribed within radius one: the last prescribed unknowns, in `top_nodes` order."""
    with log.stage("assemble"):
        log.hold(layer.elements.nbytes)
    with log.stage("factor"):
        solver = layer.solver(np.concatenate([layer.supported_unknowns, 2 * layer.top_nodes(1.0) + 1]))
    log.count("factorisations", solver.factorisations)
    return solver


def solve_prescribed_contact(
    layer: DiscreteLayer, indenter: ScaledIndenter, log: StageLog, solver: RestrictedSolver | None = None
) -> PrescribedContact:
    """Solve the contact of radius one on a mesh with a vertex there, by its `factorised_contact`.

    Raises:
        NotConvergedError: the linear solve is inaccurate, energy and reactions disagree, or the patch test fails.
    """
    contact = layer.top_nodes(1.0)
    radii, pressed = layer.space.positions[0, contact], 2 * contact + 1
    solver = solver or factorised_contact(layer, log)
    with log.stage("solve"):
        values = np.zeros((len(solver.prescribed), 2))
        values[-len(pressed) :] = np.column_stack([np.ones_like(radii), -indenter.height(radii)])
        solutions = solver.solve_displaced(values)
        forces = solver.reactions(solutions, pressed)
    with log.stage("recover"):
        energy = energy_stiffness(layer, solutions[:, 0])
        return _evaluated(layer, indenter, solutions, forces, energy)


def energy_stiffness(layer: DiscreteLayer, solution: FloatArray) -> float:
    """Stiffness k_N of a punch at unit depth as twice its strain energy: ``u . K u`` by triangles and outer edge.

    In the mixed form the equations of the pressure make ``u . K u = int 2 mu e : e + p^2 / K``, twice the energy.
    """
    local = solution[layer.space.element_unknowns][..., None]
    energy = float(np.sum(local * (layer.elements @ local)))
    return energy if layer.edge is None else energy + float(solution @ (layer.edge @ solution))


def _evaluated(
    layer: DiscreteLayer, indenter: ScaledIndenter, solutions: FloatArray, reactions: FloatArray, energy: float
) -> PrescribedContact:
    """`PrescribedContact` from u_1, u_2 (size, 2), their reactions at the contact nodes (node, 2) and u_1 . K u_1."""
    stiffness, profile_force = reactions.sum(axis=0)
    defect, patch = abs(energy / stiffness - 1), layer.patch_defect
    if not defect < ENERGY_AGREEMENT:
        raise NotConvergedError("energy and reactions give different stiffnesses", {"energy_defect": defect})
    if not patch < PATCH_AGREEMENT:
        raise NotConvergedError("a constant strain is not in equilibrium on this mesh", {"patch_defect": patch})
    positions, top, degree = layer.space.positions[0], layer.top_nodes(np.inf), layer.pair.degree
    trace = TraceSpace(positions[layer.top_nodes(1.0)], degree)
    nearest = min(1.0, layer.parts.parts[0].thickness, 1.0 - indenter.last_kink)
    derivative = layer.derivative_by_radius(solutions, cut_off(layer.section.mesh.p, 0.6 * nearest))
    # F_2 = u_1 . K u_2. Nodes of the contact that move by eta keep u_z = -f, which changes u_2 there by -eta f'. Hence
    # F_2' = A'(u_1, u_2) - R_1 . (eta f') with the reactions R_1 of u_1; delta_0 = -F_2' / k_N', k_N' = A'(u_1, u_1).
    eta = cut_off(np.array([trace.vertices, np.zeros_like(trace.vertices)]), 0.6 * nearest)
    height_change = np.interp(trace.radii, trace.vertices, eta) * indenter.slope(trace.radii)
    smooth_depth = float((reactions[:, 0] @ height_change - derivative[0, 1]) / derivative[0, 0])
    pressures = trace.recover(reactions)
    analytic = min(nearest, 1.0 - max(indenter.breakpoints, default=0.0), indenter.distance_to_upright_end)
    return PrescribedContact(
        layer=layer,
        indenter=indenter,
        stiffness=float(stiffness),
        stiffness_slope=float(derivative[0, 0]),
        smooth_depth=smooth_depth,
        smooth_depth_slope=smooth_depth_slope(trace, pressures @ [[1.0, smooth_depth], [0.0, 1.0]], analytic),
        profile_force=float(profile_force),
        solutions=solutions,
        contact_trace=trace,
        pressures=pressures,
        top_trace=TraceSpace(positions[top], degree),
        displacements=solutions[2 * top + 1],
        energy_defect=float(defect),
        patch_defect=patch,
    )


def cut_off(points: FloatArray, support: float) -> FloatArray:
    """Radial motion eta of points (2, n): one within support/6 of the contact edge (1, 0), zero beyond support, C^1."""
    t = np.clip(1.2 * np.hypot(points[0] - 1.0, points[1]) / support - 0.2, 0, 1)
    return np.asarray(1 - t**2 * (3 - 2 * t))


def smooth_depth_slope(trace: TraceSpace, pressures: FloatArray, scale: float) -> float:
    """d(delta_0)/da, from the pressures p_1 of the flat punch and p of smooth contact near the edge.

    Smooth contact is a superposition of flat punches, ``p(r) = int_r^a p_1(r; t) delta_0'(t) dt``. Near the edge
    ``p_1(r; t) = C (t - r)^(-1/2)``, hence ``p / p_1 = 2 (a - r) delta_0'(a)`` for r -> a. Ratios of weighted means
    over rings, each half as wide as the last, are extrapolated to width zero. Means average the oscillations of single
    cells.

    Args:
        trace: piecewise polynomials on the contact.
        pressures: nodal values of p_1 and p in ``trace``, shape (node, 2).
        scale: distance from the edge within which the ratio p / p_1 is analytic.
    """
    radius, weight = (values.ravel() for values in trace.gauss(trace.degree + 2))
    punch, smooth = (trace.evaluate(values, radius) for values in pressures.T)
    widths = 2.0 ** -np.arange(float(RINGS))
    # Where an upright end is nearer than the last cells, rings are as wide as the narrowest needs to cover RINGS cells.
    widest = max(WIDEST * scale, (1.0 - trace.vertices[-min(1 + RINGS, len(trace.vertices))]) / widths[-1])
    share = (1.0 - radius) / (widest * widths[:, None])
    weight = weight * share * np.maximum(1.0 - share, 0.0) ** 2
    means = (weight @ smooth) / (weight @ (2.0 * (1.0 - radius) * punch))
    return float(np.polyfit(widths, means, RINGS - 1)[-1])
