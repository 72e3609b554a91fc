"""Contact of one given radius: stiffness, its derivative, the depth of smooth contact, forces and surface fields.

Units: lengths by the contact radius, stresses by E*. Two solutions of one factorisation determine everything: u_1, the
unit depth of a flat punch of that radius, and u_2, the profile -f(r) at depth zero. At depth delta the layer carries
``F = k_N delta + F_2``, and since the energy release rate is a perfect square in delta,

    dPi/da = k_N' (delta - delta_0)^2 / 2,     delta_0 = -(dF_2/da) / k_N',

where delta_0 = g(a) is the depth at which the stress at the contact edge vanishes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
from scipy.linalg import solveh_banded

from contact import NotConvergedError, Scene, StageLog
from contact.records.validation import FloatArray
from fem_reference.layer import DiscreteLayer
from fem_reference.profiles import ScaledIndenter
from fem_reference.settings import Discretisation, contact_section, narrowest_radius
from fem_reference.surface import TraceSpace

# Largest relative difference of the stiffness by energy and by reactions: sound solutions agree to 1e-12, a broken
# factorisation errs by 1e-2.
ENERGY_AGREEMENT = 1e-8
# Largest residual of a constant strain over the size of its terms: a hundred thousand roundings.
PATCH_AGREEMENT = 1e-11
# Settings of quick solutions, on which the radius of a load is searched: depth and force err by about 3e-5. With a
# growth of 0.7 they err by 2e-4, and most loads take two full solutions.
QUICK = Discretisation(order=3, growth=0.5, edge_cell=3e-5, truncation=1e-5, half_space_thickness=1e6)
# Width of the widest ring beside the contact's edge in which the slope of delta_0 is read, over the smallest length
# there, and number of rings. The slope errs by 3e-4 at growth 1/2; from one cell at the edge it errs by any factor.
WIDEST, RINGS = 0.8, 5


@dataclass(frozen=True, kw_only=True)
class PrescribedContact:
    """Answers of one mesh and element pair at contact radius one.

    Attributes:
        layer: the discrete layer.
        indenter: the profile, by the contact radius.
        stiffness: k_N.
        stiffness_slope: k_N' = dk_N/da.
        smooth_depth: delta_0, zero for a flat punch.
        smooth_depth_slope: delta_0' = d(delta_0)/da.
        profile_force: F_2, the force at depth zero (negative: the profile alone would have to be pulled in).
        solutions: all unknowns of u_1 and u_2, shape (size, 2).
        contact_trace: polynomials on the contact.
        pressures: pressure of u_1 and u_2 at its nodes, shape (node, 2).
        top_trace: polynomials on the whole top.
        displacements: u_z of u_1 and u_2 at its nodes, shape (node, 2).
        energy_defect: |energy stiffness / reaction stiffness - 1|.
        patch_defect: see `DiscreteLayer.patch_defect`.
        radius: contact radius over that of the mesh: below one where the ring around a flat end is too narrow for it.
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
        """Normal force F = k_N delta + F_2 at any depth, the contact radius held."""
        return self.stiffness * depth + self.profile_force

    @property
    def smooth_force(self) -> float:
        """Normal force at the depth of smooth contact."""
        return self.force(self.smooth_depth)

    def pressure(self, radius: FloatArray, depth: float) -> FloatArray:
        """Pressure p(r), zero outside the contact."""
        return self.contact_trace.evaluate(self.pressures @ [depth, 1.0], radius)

    def surface_displacement(self, radius: FloatArray, depth: float) -> FloatArray:
        """Displacement u_z(r) on the top; zero beyond the mesh."""
        return self.top_trace.evaluate(self.displacements @ [depth, 1.0], radius)

    @property
    def shear_traction(self) -> FloatArray:
        """Traction q of a punch that sticks, at depth one, at the nodes of the contact; zero on the axis.

        ``int q v 2 pi r dr`` equals the radial reaction for every v that vanishes on the axis.
        """
        reactions = (self.layer.matrix @ self.solutions[:, 0])[2 * self.layer.top_nodes(1.0)]
        bands = self.contact_trace.mass_bands()[:, 1:]
        return np.concatenate([[0.0], solveh_banded(bands, reactions[1:], lower=True, check_finite=False)])

    def narrowed(self, share: float) -> PrescribedContact:
        """The contact of a ring ``share^2`` times as narrow around a flat end, on the same mesh.

        So close to the flat radius the stress at the contact's edge is that of the flat punch and its stiffness is
        linear in the radius. Smooth depth and fields outside the ring grow like the root of its width w, so that
        ``F = int k_N d(delta_0)`` leaves ``F_2 ~ w^1.5``.

        Args:
            share: factor on the smooth depth.
        """
        shares, lost = np.array([1.0, share]), (1.0 - self.indenter.last_kink) * (1 - share**2)
        return replace(
            self,
            stiffness=self.stiffness - self.stiffness_slope * lost,
            smooth_depth=share * self.smooth_depth,
            smooth_depth_slope=self.smooth_depth_slope / share,
            profile_force=share**3 * self.profile_force,
            pressures=self.pressures * shares,
            displacements=self.displacements * shares,
            solutions=self.solutions * shares,
            radius=1 - lost,
        )


# Solves the contact of a given radius [m].
ContactSolver: TypeAlias = Callable[[float], PrescribedContact]


def solve_contact(
    scene: Scene,
    radius: float,
    settings: Discretisation,
    log: StageLog,
    *,
    sticks: bool = False,
) -> PrescribedContact:
    """Mesh the section around a contact radius [m] and solve it.

    The contact of a ring around a flat end that is too narrow for a mesh is derived from the narrowest meshed one.

    Args:
        scene: layer and indenter.
        radius: contact radius [m].
        settings: numerical settings.
        log: of the stages.
        sticks: whether the indenter holds the surface in the radial direction.
    """
    layer, flat = scene.layer, scene.indenter.flat_radius
    meshed = max(radius, narrowest_radius(layer, scene.indenter, settings.coarsening)) if radius > flat else radius
    indenter = ScaledIndenter(scene.indenter, meshed)
    with log.stage("mesh"):
        parts, section = contact_section(layer, indenter, settings)
    contact = solve_prescribed_contact(DiscreteLayer(section, settings.pair, parts, sticks), indenter, log)
    return contact if meshed == radius else contact.narrowed(float(np.sqrt((radius - flat) / (meshed - flat))))


def quick_solution(scene: Scene, radius: float, log: StageLog) -> PrescribedContact:
    """The contact of a radius [m], solved with few cells, to about 1e-5 or, of tables, 1e-4."""
    return solve_contact(scene, radius, QUICK, log)


def solve_prescribed_contact(layer: DiscreteLayer, indenter: ScaledIndenter, log: StageLog) -> PrescribedContact:
    """Solve the contact of radius one on a mesh with a vertex there.

    Raises:
        NotConvergedError: the linear solve is inaccurate, energy and reactions disagree, or the patch test fails.
    """
    contact = layer.top_nodes(1.0)
    radii, pressed = layer.space.positions[0, contact], 2 * contact + 1
    with log.stage("assemble"):
        log.hold(layer.elements.nbytes)
    with log.stage("factor"):
        solver = layer.solver(np.concatenate([layer.supported_unknowns, pressed]))
    log.count("factorisations", solver.factorisations)
    with log.stage("solve"):
        values = np.zeros((len(solver.held), 2))
        values[-len(pressed) :] = np.column_stack([np.ones_like(radii), -indenter.height(radii)])
        solutions = solver.solve_displaced(values)
        forces = solver.reactions(solutions, pressed)
    with log.stage("recover"):
        energy = energy_stiffness(layer, solutions[:, 0])
        return _evaluated(layer, indenter, solutions, forces, energy)


def energy_stiffness(layer: DiscreteLayer, solution: FloatArray) -> float:
    """Twice the strain energy of a punch of unit depth, ``u . K u`` summed over triangles and the outer edge."""
    local = solution[layer.space.element_unknowns][..., None]
    energy = float(np.sum(local * (layer.elements @ local)))
    return energy if layer.edge is None else energy + float(solution @ (layer.edge @ solution))


def _evaluated(
    layer: DiscreteLayer, indenter: ScaledIndenter, solutions: FloatArray, reactions: FloatArray, energy: float
) -> PrescribedContact:
    """All numbers from u_1, u_2 (size, 2) and their reactions on the contact nodes."""
    stiffness, profile_force = reactions.sum(axis=0)
    defect, patch = abs(energy / stiffness - 1), layer.patch_defect
    if not defect < ENERGY_AGREEMENT:
        raise NotConvergedError("energy and reactions give different stiffnesses", {"energy_defect": defect})
    if not patch < PATCH_AGREEMENT:
        raise NotConvergedError("a constant strain is not in equilibrium on this mesh", {"patch_defect": patch})
    positions, top, degree = layer.space.positions[0], layer.top_nodes(np.inf), layer.pair.degree
    trace = TraceSpace(positions[layer.top_nodes(1.0)], degree)
    scale = min(1.0, layer.parts.parts[0].thickness, 1.0 - indenter.last_kink)
    derivative = layer.derivative_by_radius(solutions, cut_off(layer.section.mesh.p, 0.6 * scale))
    # The nodes of the contact move along the profile, whose height there grows by eta f'.
    edge = cut_off(np.array([trace.vertices, np.zeros_like(trace.vertices)]), 0.6 * scale)
    moving = np.interp(trace.radii, trace.vertices, edge) * indenter.slope(trace.radii)
    smooth_depth = float((reactions[:, 0] @ moving - derivative[0, 1]) / derivative[0, 0])
    pressures = trace.recover(reactions)
    beside = min(scale, 1.0 - max(indenter.breakpoints, default=0.0), indenter.left_to_upright_end)
    return PrescribedContact(
        layer=layer,
        indenter=indenter,
        stiffness=float(stiffness),
        stiffness_slope=float(derivative[0, 0]),
        smooth_depth=smooth_depth,
        smooth_depth_slope=smooth_depth_slope(trace, pressures @ [[1.0, smooth_depth], [0.0, 1.0]], beside),
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
    """Motion eta of points (2, n): one within support/6 of the edge (1, 0), zero beyond ``support``, C^1 between."""
    t = np.clip(1.2 * np.hypot(points[0] - 1.0, points[1]) / support - 0.2, 0, 1)
    return np.asarray(1 - t**2 * (3 - 2 * t))


def smooth_depth_slope(trace: TraceSpace, pressures: FloatArray, scale: float) -> float:
    """d(delta_0)/da, from the pressures of flat punch and smooth contact: p / p_1 = 2 (a - r) delta_0' at the edge.

    Both are superpositions of flat punches of radii up to a. Means over rings, each half as wide as the last, are
    extrapolated to width zero: means average the oscillations of single cells.

    Args:
        trace: functions on the contact.
        pressures: of the flat punch and of smooth contact, in ``trace``, shape (n, 2).
        scale: distance from the edge within which both pressures are smooth.
    """
    radius, weight = (values.ravel() for values in trace.gauss(trace.degree + 2))
    punch, smooth = (trace.evaluate(values, radius) for values in pressures.T)
    widths = 2.0 ** -np.arange(float(RINGS))
    # An upright end may be nearer than the last cells, of which the narrowest ring covers as many as there are rings.
    widest = max(WIDEST * scale, (1.0 - trace.vertices[-min(1 + RINGS, len(trace.vertices))]) / widths[-1])
    share = (1.0 - radius) / (widest * widths[:, None])
    weight = weight * share * np.maximum(1.0 - share, 0.0) ** 2
    means = (weight @ smooth) / (weight @ (2.0 * (1.0 - radius) * punch))
    return float(np.polyfit(widths, means, RINGS - 1)[-1])
