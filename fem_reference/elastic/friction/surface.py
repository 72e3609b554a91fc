"""The layer condensed to its top, pressed and rubbed: displacements under pressures and tangential tractions.

Both tractions are continuous and piecewise linear on the strip of equal cells of ``surface_compliance``. With hat
functions phi_i, ``C = [[Z_p, Z_q], [Z_q^T, R_q]]`` gives the moments ``int phi_i (u_z, u_r) 2 pi r dr``; it is
symmetric by reciprocity. Units: lengths by the strip's radius, stresses by E*.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contact import ElasticLayer, StageLog
from contact.records.validation import FloatArray
from fem_reference.discrete_layer.elements import taylor_hood
from fem_reference.discrete_layer.mesh import LayerMesh
from fem_reference.discrete_layer.problem import LayerProblem, problem_of
from fem_reference.discrete_layer.trace import TraceSpace
from fem_reference.elastic.surface_compliance import STRIP_ORDER

# Displacement nodes from one vertex of the tractions to the next: one cell of the mesh for each cell of the tractions.
# Tractions with a kink inside a cell of the mesh made every second point move by another law: forces under stick then
# erred like 1 / cells, by 8e-5 to 5e-4 on 120 cells and more where meshes differed (nu = 1/2, a/h = 5, 2026-11-22).
STRIDE = STRIP_ORDER


@dataclass(frozen=True)
class RubbedSurface:
    """Compliance of the top within radius one.

    Attributes:
        tractions: piecewise linear functions; their nodes are the candidates for contact.
        pressed: moments of u_z under each pressure, shape (n, n).
        coupled: moments of u_z under each tangential traction, shape (n, n); transposed, of u_r under each pressure.
        rubbed: moments of u_r under each tangential traction, shape (n, n).
        resultants: ``int phi_i 2 pi r dr``, shape (n,).
        base_forces: what the base carries of each pressure and each tangential traction, shape (2 n,).
        top: the whole top of the mesh.
        top_displacements: u_z at its nodes under each pressure and each tangential traction, shape (t, 2 n).
        unknowns: size of the condensed system.
        fingerprint: of the mesh.
        poissons_ratio: nu of the material at the top.
    """

    tractions: TraceSpace
    pressed: FloatArray
    coupled: FloatArray
    rubbed: FloatArray
    resultants: FloatArray
    base_forces: FloatArray
    top: TraceSpace
    top_displacements: FloatArray
    unknowns: int
    fingerprint: str
    poissons_ratio: float

    @property
    def radii(self) -> FloatArray:
        """Candidates for contact."""
        return self.tractions.radii


def condense_rubbed(layer: ElasticLayer, mesh: LayerMesh, backend: str, log: StageLog) -> RubbedSurface:
    """Factorise the layer once; load it by every pressure and every tangential traction of the strip."""
    problem = problem_of(layer, mesh, taylor_hood(STRIP_ORDER), backend)
    with log.stage("factor"):
        solver = problem.solver(problem.supported_unknowns)
    log.count("factorisations", solver.checked.factorisations)
    with log.stage("condense"):
        loads, tractions = strip_loads(problem)
        solution = solver.solve_loaded(loads)
        compliance = loads.T @ solution
        compliance = (compliance + compliance.T) / 2
        log.hold(solution.nbytes + compliance.nbytes)
        top = problem.top_nodes(np.inf)
        n = len(tractions.radii)
    return RubbedSurface(
        tractions=tractions,
        pressed=compliance[:n, :n],
        coupled=compliance[:n, n:],
        rubbed=compliance[n:, n:],
        resultants=loads.sum(axis=0)[:n],
        base_forces=_carried(problem, solution, elastic=layer.has_elastic_base),
        top=TraceSpace(problem.positions[0, top], STRIP_ORDER),
        top_displacements=solution[2 * top + 1],
        unknowns=problem.space.size,
        fingerprint=mesh.fingerprint,
        poissons_ratio=layer.surface.poissons_ratio,
    )


def _carried(problem: LayerProblem, solution: FloatArray, *, elastic: bool) -> FloatArray:
    """What the base carries, upright: reactions of a rigid one, springs at the mesh's end of an elastic one."""
    if elastic:
        springs: FloatArray = problem.outer_edge_matrix @ solution
        return np.asarray(springs[1 : 2 * problem.positions.shape[1] : 2].sum(axis=0))
    base = 2 * problem.nodes_on("base") + 1
    return np.asarray(-(problem.matrix[base] @ solution).sum(axis=0))


def strip_loads(problem: LayerProblem) -> tuple[FloatArray, TraceSpace]:
    """Loads of the hat functions, first as pressures, then as tangential tractions, shape (size, 2 n); their space."""
    nodes = problem.top_nodes(1.0)
    radii = problem.positions[0, nodes]
    moments = TraceSpace(radii, problem.pair.degree).hat_moments(STRIDE)
    n = moments.shape[1]
    loads = np.zeros((problem.space.size, 2 * n))
    loads[2 * nodes + 1, :n] = moments
    loads[2 * nodes, n:] = moments
    return loads, TraceSpace(radii[::STRIDE], 1)
