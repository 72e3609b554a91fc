"""The layer condensed to its top: one factorisation, then contact problems of a few hundred unknowns.

Pressures are continuous and piecewise linear on a strip of equal cells, two in every cell of the mesh, whose
displacements are of fourth degree: the mesh then adds less than the contact set, found to a cell.
``C_ij = int phi_i u_z(phi_j) 2 pi r dr`` is the compliance, ``w_i = int phi_i 2 pi r dr`` the resultant of each
pressure function.  Units: lengths by the strip's radius, stresses by E*.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from contact import ElasticLayer, Layer, StageLog
from contact.records.validation import FloatArray, IntArray
from fem_reference.discrete_layer.elements import taylor_hood
from fem_reference.discrete_layer.grading import Grading
from fem_reference.discrete_layer.mesh import LayerMesh, layer_mesh
from fem_reference.discrete_layer.problem import LayerProblem, problem_of
from fem_reference.discrete_layer.settings import Discretisation
from fem_reference.discrete_layer.trace import TraceSpace

# Degree of the displacements, so that the mesh errs less than the contact set, which is found to a cell.
STRIP_ORDER = 4
# Displacement nodes from one pressure vertex to the next.
STRIDE = 2
# Cells of the strip on which a contact is searched; a strip of so many goes with a growth of one away from it.
STRIP_CELLS = 120


@dataclass(frozen=True)
class SurfaceCompliance:
    """Compliance of the top within radius one.

    Attributes:
        layer_mesh: the mesh.
        pressure_space: piecewise linear pressures; their vertices are the candidates for contact.
        matrix: C, shape (n, n).
        resultants: w, shape (n,).
        vertex_displacements: u_z at these vertices under each pressure function, shape (n, n).
        unknowns: size of the condensed system.
    """

    layer_mesh: LayerMesh
    pressure_space: TraceSpace
    matrix: FloatArray
    resultants: FloatArray
    vertex_displacements: FloatArray
    unknowns: int

    @property
    def radii(self) -> FloatArray:
        """Candidate vertices."""
        return self.pressure_space.radii

    def weighted(self, function: FloatArray) -> FloatArray:
        """``int phi_i f 2 pi r dr`` for f given at ``pressure_space.gauss(4)``."""
        return self.pressure_space.moments(function, 4)


# Cells from the axis below which a kink gets no vertex on the strip: cells of unequal width next to the axis, some
# hundreds of times narrower than the others, made pressures there oscillate, and the contact had a gap (measured on
# truncated cones on 2026-11-22: gaps from 0.07 cells down, none at 0.75).  The strip only finds the radius.
NEAREST_KINK = 0.5


def strip_mesh(
    layer: ElasticLayer,
    radius: float,
    cells: int,
    kinks: tuple[float, ...],
    settings: Discretisation,
    *,
    outside: float = 1.0,
    stride: int = STRIDE,
) -> LayerMesh:
    """A section with ``cells`` equal pressure cells on the strip of ``radius`` [m], lengths by that radius.

    Away from the strip the mesh errs like growth^7, the contact set like 1 / cells^2: both shrink alike.  The growth of
    120 cells is ``outside``; ``stride`` counts displacement nodes from one pressure vertex to the next.
    """
    cell = STRIP_ORDER / stride / cells
    points = (*((r / radius, cell) for r in kinks if NEAREST_KINK * cell * radius <= r < radius), (1.0, cell))
    growth = outside * (STRIP_CELLS / cells) ** (1 / 3)
    if not isinstance(layer, Layer):
        from fem_reference.discrete_layer.several_layers.mesh import parts_mesh  # noqa: PLC0415 - only they load it

        return parts_mesh(layer, radius, points, replace(settings, growth=growth), strip=1.0)
    thickness = settings.thickness(layer, radius)
    outer = 1 + thickness * settings.distance(layer)
    grading = Grading(points=points, strip=(1.0, cell), growth=growth, max_cell=max(cell, growth * thickness))
    return layer_mesh(thickness, outer, grading)


def condense(layer: ElasticLayer, mesh: LayerMesh, backend: str, log: StageLog) -> SurfaceCompliance:
    """Factorise the layer once and load it by every pressure function of the strip of radius one."""
    problem = problem_of(layer, mesh, taylor_hood(STRIP_ORDER), backend)
    with log.stage("assemble"):
        log.hold(problem.elements.nbytes)
    with log.stage("factor"):
        solver = problem.solver(problem.supported_unknowns)
    log.count("factorisations", solver.checked.factorisations)
    with log.stage("condense"):
        nodes = problem.top_nodes(1.0)
        loads = _strip_moments(problem)
        displacements = solver.response(2 * nodes + 1, loads)
        compliance = loads.T @ displacements
        log.hold(compliance.nbytes)
    return SurfaceCompliance(
        layer_mesh=mesh,
        pressure_space=TraceSpace(problem.positions[0, nodes[::STRIDE]], 1),
        matrix=(compliance + compliance.T) / 2,
        resultants=loads.sum(axis=0),
        vertex_displacements=displacements[::STRIDE],
        unknowns=problem.space.size,
    )


def strip_vertices(problem: LayerProblem) -> IntArray:
    """Scalar displacement unknowns at the vertices of the pressures on the strip of radius one."""
    return problem.top_nodes(1.0)[::STRIDE]


def strip_loads(problem: LayerProblem) -> FloatArray:
    """Loads of the piecewise linear pressures on the strip of radius one, shape (size, n)."""
    moments = _strip_moments(problem)
    loads = np.zeros((problem.space.size, moments.shape[1]))
    loads[2 * problem.top_nodes(1.0) + 1] = moments
    return loads


def _strip_moments(problem: LayerProblem) -> FloatArray:
    """The same of the nodes on the strip."""
    return TraceSpace(problem.positions[0, problem.top_nodes(1.0)], problem.pair.degree).hat_moments(STRIDE)
