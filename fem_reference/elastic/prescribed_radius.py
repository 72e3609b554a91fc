"""Contact of one given radius: stiffness, its derivative, the depth of smooth contact, forces and surface fields.

Units: lengths by the contact radius, stresses by E*.  Two solutions of one factorisation tell everything: u_1, the
unit depth of a flat punch of that radius, and u_2, the profile -f(r) at depth zero.  At depth delta the layer carries
``F = k_N delta + F_2``, and since the energy release rate is a perfect square in delta,

    dPi/da = k_N' (delta - delta_0)^2 / 2,     delta_0 = -(dF_2/da) / k_N',

where delta_0 = g(a) is the depth at which the stress at the contact edge vanishes.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from contact import NotConvergedError, Scene, StageLog
from contact.records.validation import FloatArray, IntArray
from fem_reference.discrete_layer.elements import ElementPair
from fem_reference.discrete_layer.indenter import ScaledIndenter
from fem_reference.discrete_layer.material import ElasticConstants
from fem_reference.discrete_layer.mesh import LayerMesh
from fem_reference.discrete_layer.problem import LayerProblem, problem_of
from fem_reference.discrete_layer.settings import Discretisation, contact_mesh, narrowest_radius
from fem_reference.discrete_layer.trace import TraceSpace
from fem_reference.elastic.patch_test import patch_defect
from fem_reference.elastic.shape_derivative import (
    derivative_by_radius,
    mutual_energies,
    smooth_depth_slope,
    smooth_scale,
)

# Largest relative difference of the stiffness by energy and by reactions: sound solutions agree to 1e-12 and a broken
# down factorisation misses by 1e-2, so anything between tells the two apart.
ENERGY_AGREEMENT = 1e-8
# Largest residual of a constant strain over the size of its terms: a hundred thousand roundings.
PATCH_AGREEMENT = 1e-11
# Settings of quick solutions, on which the radius of a load is searched: depth and force err by about 3e-5, and one
# full solution then suffices. With a growth of 0.7 they err by 2e-4, and most loads take two full solutions.
QUICK = Discretisation(order=3, growth=0.5, edge_cell=3e-5, truncation=1e-5, half_space_thickness=1e6)


@dataclass(frozen=True, kw_only=True)
class PrescribedContact:
    """Answers of one mesh and element pair at contact radius one.

    Attributes:
        stiffness: k_N.
        stiffness_slope: k_N' = dk_N/da.
        smooth_depth: delta_0, zero for a flat punch.
        smooth_depth_slope: delta_0' = d(delta_0)/da.
        profile_force: F_2, the force at depth zero (negative: the profile alone would have to be pulled in).
        indenter: the profile, by the contact radius.
        contact_trace: polynomials on the contact.
        pressures: pressure of u_1 and u_2 at its nodes, shape (node, 2).
        top_trace: polynomials on the whole top.
        displacements: u_z of u_1 and u_2 at its nodes, shape (node, 2).
        energy_defect: |energy stiffness / reaction stiffness - 1|.
        patch_defect: of `patch.patch_defect`.
        layer_mesh: the section.
        pair: element pair.
        constants: moduli at the points of the mesh, at E* = 1.
        solutions: all unknowns of u_1 and u_2, shape (size, 2).
        radius: contact radius over that of the mesh: below one where the ring around a flat end is too narrow for it.
    """

    stiffness: float
    stiffness_slope: float
    smooth_depth: float
    smooth_depth_slope: float
    profile_force: float
    indenter: ScaledIndenter
    contact_trace: TraceSpace
    pressures: FloatArray
    top_trace: TraceSpace
    displacements: FloatArray
    energy_defect: float
    patch_defect: float
    layer_mesh: LayerMesh
    pair: ElementPair
    constants: ElasticConstants
    solutions: FloatArray
    radius: float = 1.0

    @property
    def unknowns(self) -> int:
        """Size of the linear system."""
        return len(self.solutions)

    def force(self, depth: float) -> float:
        """Normal force at any depth, the contact radius held."""
        return self.stiffness * depth + self.profile_force

    @property
    def smooth_force(self) -> float:
        """Normal force at the depth of smooth contact."""
        return self.force(self.smooth_depth)

    def pressure(self, radius: FloatArray, depth: float) -> FloatArray:
        """p(r), zero outside the contact."""
        return self.contact_trace.evaluate(self.pressures @ [depth, 1.0], radius)

    def surface_displacement(self, radius: FloatArray, depth: float) -> FloatArray:
        """u_z(r) on the top; zero beyond the mesh."""
        return self.top_trace.evaluate(self.displacements @ [depth, 1.0], radius)

    @property
    def contact_radius(self) -> float:
        """Contact radius of the mesh [m]."""
        return self.indenter.contact_radius

    @property
    def ring(self) -> float:
        """Width of the meshed ring between the last kink and the edge, by the radius of the mesh."""
        return 1.0 - max(self.indenter.kinks, default=0.0)

    def narrowed(self, share: float) -> PrescribedContact:
        """The contact of a ring ``share^2`` times as narrow around a flat end, on the same mesh.

        So close to the rim the stress at the contact's edge is that of the flat punch and its stiffness is linear in
        the radius.  Smooth depth and fields outside the ring grow like the root of its width w, so that
        ``F = int k_N d(delta_0)`` leaves ``F_2 ~ w^1.5``.

        Args:
            share: of the smooth depth.
        """
        shares, lost = np.array([1.0, share]), self.ring * (1 - share**2)
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


def solve_prescribed_contact(problem: LayerProblem, indenter: ScaledIndenter, log: StageLog) -> PrescribedContact:
    """Solve the contact of radius one on a mesh with a vertex there.

    Raises:
        NotConvergedError: the linear solve is inaccurate, energy and reactions disagree, or the patch test fails.
    """
    contact = problem.top_nodes(1.0)
    radii = problem.positions[0, contact]
    pressed = 2 * contact + 1
    with log.stage("assemble"):
        log.hold(problem.elements.nbytes)
    with log.stage("factor"):
        solver = problem.solver(np.concatenate([problem.supported_unknowns, pressed]))
    log.count("factorisations", solver.checked.factorisations)
    with log.stage("solve"):
        values = np.zeros((len(solver.held), 2))
        values[-len(pressed) :] = np.column_stack([np.ones_like(radii), -indenter.height(radii)])
        solutions = solver.solve_displaced(values)
        reactions = solver.reactions(solutions, pressed)
    with log.stage("recover"):
        return _evaluate(problem, indenter, contact, solutions, reactions)


def _evaluate(
    problem: LayerProblem, indenter: ScaledIndenter, contact: IntArray, solutions: FloatArray, reactions: FloatArray
) -> PrescribedContact:
    """All numbers from u_1, u_2 (size, 2) and their reactions on the contact nodes."""
    stiffness, profile_force = reactions.sum(axis=0)
    defect = abs(mutual_energies(problem, solutions)[0, 0] / stiffness - 1)
    if not defect < ENERGY_AGREEMENT:
        raise NotConvergedError("energy and reactions give different stiffnesses", {"energy_defect": defect})
    patch = patch_defect(problem)
    if not patch < PATCH_AGREEMENT:
        raise NotConvergedError("a constant strain is not in equilibrium on this mesh", {"patch_defect": patch})
    derivative, moving_slope = derivative_by_radius(problem, solutions, indenter, problem.positions[0, contact])
    profile_force_slope = derivative[0, 1] - reactions[:, 0] @ moving_slope
    top, degree = problem.top_nodes(np.inf), problem.pair.degree
    contact_trace = TraceSpace(problem.positions[0, contact], degree)
    pressures, smooth_depth = contact_trace.recover(reactions), float(-profile_force_slope / derivative[0, 0])
    smooth_pressures = pressures @ [[1.0, smooth_depth], [0.0, 1.0]]
    return PrescribedContact(
        stiffness=float(stiffness),
        stiffness_slope=float(derivative[0, 0]),
        smooth_depth=smooth_depth,
        smooth_depth_slope=smooth_depth_slope(contact_trace, smooth_pressures, smooth_scale(problem, indenter)),
        profile_force=float(profile_force),
        indenter=indenter,
        contact_trace=contact_trace,
        pressures=pressures,
        top_trace=TraceSpace(problem.positions[0, top], degree),
        displacements=solutions[2 * top + 1],
        energy_defect=float(defect),
        patch_defect=patch,
        layer_mesh=problem.layer_mesh,
        pair=problem.pair,
        constants=problem.constants,
        solutions=solutions,
    )


def solve_contact(
    scene: Scene,
    radius: float,
    settings: Discretisation,
    log: StageLog,
    *,
    backend: str = "superlu",
    kind: type[LayerProblem] = LayerProblem,
) -> PrescribedContact:
    """Mesh the section around a contact radius [m] and solve it.

    A ring around a flat end that is too narrow for a mesh is taken from one that is not.

    Args:
        scene: layer and indenter.
        radius: contact radius [m].
        settings: numerical settings.
        log: of the stages.
        backend: linear solver.
        kind: the discrete layer, or one whose contact is held in more ways.
    """
    layer, flat = scene.layer, scene.indenter.flat_radius
    meshed = max(radius, narrowest_radius(layer, scene.indenter, settings.coarsening)) if radius > flat else radius
    indenter = ScaledIndenter(scene.indenter, meshed)
    settings = settings.beside_kinks(layer, indenter)
    with log.stage("mesh"):
        mesh = contact_mesh(layer, indenter, settings)
    contact = solve_prescribed_contact(problem_of(layer, mesh, settings.pair, backend, kind), indenter, log)
    return contact if meshed == radius else contact.narrowed(float(np.sqrt((radius - flat) / (meshed - flat))))


def quick_solution(scene: Scene, radius: float, log: StageLog) -> PrescribedContact:
    """The contact of a radius [m], solved with few cells, to about 1e-5 or, of tables, 1e-4."""
    return solve_contact(scene, radius, QUICK, log)
