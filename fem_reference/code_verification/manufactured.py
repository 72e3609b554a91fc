"""Solutions made up beforehand, the body forces that belong to them, and the errors that an element pair makes of them.

At nu = 1/2 the displacement u = (-r^3 cos z, 4 r^2 sin z) has no divergence, and p = cos r cos z is free. For nu < 1/2
grad phi with phi = (r^4/4) sin z is added, whose divergence is D = (4 r^2 - r^4/4) sin z, and the material law asks for
p = -K D. The body force is f = -mu (Lap u + grad D/3) + grad p.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from skfem import MeshTri

from contact.records.validation import FloatArray
from fem_reference.discrete_layer.elements import ElementPair
from fem_reference.discrete_layer.fields import point_fields
from fem_reference.discrete_layer.mesh import LayerMesh, named_layer_mesh
from fem_reference.discrete_layer.problem import LayerProblem, facet_nodes

# Cells along a side of the mesh that is halved.
COARSEST = 4
# Its inner vertices move by this share of a cell at most: triangles become irregular and stay far from flat.
SHIFT = 0.25


@dataclass(frozen=True)
class ManufacturedProblem:
    """The made-up solution on an irregular mesh of the unit square.

    Attributes:
        pair: of elements.
        poissons_ratio: nu.
        cells: along each side.
    """

    pair: ElementPair
    poissons_ratio: float
    cells: int

    def errors(self) -> tuple[float, float]:
        """L2 errors of displacement and pressure, relative to their norms."""
        space = self._problem.space
        fields = point_fields(space, self._problem.moduli, self._solution(), np.arange(space.mesh.t.shape[1]))
        displacement, pressure = self._displacement(*self._points), self._pressure()
        difference = fields.pressure[0] - pressure
        if self._is_incompressible:
            # The level of the pressure carries the pointwise error at the vertex that holds it.
            difference -= np.sum(difference * space.measure) / space.measure.sum()
        moved = self._norm(fields.displacement[0] - displacement) / self._norm(displacement)
        return moved, self._norm(difference) / self._norm(pressure)

    @property
    def unknowns(self) -> int:
        """Of displacement and pressure."""
        return self._problem.space.size

    @cached_property
    def _problem(self) -> LayerProblem:
        return LayerProblem(irregular_mesh(self.cells), self.pair, self.poissons_ratio, "bonded")

    @property
    def _is_incompressible(self) -> bool:
        return self.poissons_ratio == 0.5

    @cached_property
    def _points(self) -> FloatArray:
        """r and z of the quadrature points, shape (2, cells, points)."""
        space = self._problem.space
        points, _ = space.quadrature
        barycentric = np.array([1 - points.sum(axis=0), *points])
        return np.asarray(np.einsum("ctv,vq->ctq", space.mesh.p[:, space.mesh.t].transpose(0, 2, 1), barycentric))

    def _norm(self, field: FloatArray) -> float:
        squares = field**2 if field.ndim == 2 else np.sum(field**2, axis=-1)
        return float(np.sqrt(np.sum(squares * self._problem.space.measure)))

    def _displacement(self, r: FloatArray, z: FloatArray) -> FloatArray:
        """u_r and u_z, along the last axis."""
        solenoidal = np.stack([-(r**3) * np.cos(z), 4 * r**2 * np.sin(z)], axis=-1)
        return np.asarray(solenoidal if self._is_incompressible else solenoidal + _gradient_of_phi(r, z))

    def _pressure(self) -> FloatArray:
        r, z = self._points
        if self._is_incompressible:
            return np.asarray(np.cos(r) * np.cos(z))
        return np.asarray(-self._problem.moduli.bulk * (4 * r**2 - r**4 / 4) * np.sin(z))

    def _force(self) -> FloatArray:
        """f at the quadrature points, components along the last axis."""
        (r, z), shear = self._points, self._problem.moduli.shear
        force = -shear * np.stack([(r**3 - 8 * r) * np.cos(z), (16 - 4 * r**2) * np.sin(z)], axis=-1)
        if self._is_incompressible:
            return np.asarray(force + np.stack([-np.sin(r) * np.cos(z), -np.cos(r) * np.sin(z)], axis=-1))
        gradient_of_divergence = np.stack([(8 * r - r**3) * np.sin(z), (4 * r**2 - r**4 / 4) * np.cos(z)], axis=-1)
        return np.asarray(force - (4 / 3 * shear + self._problem.moduli.bulk) * gradient_of_divergence)

    def _loads(self) -> FloatArray:
        """The body force on every unknown."""
        space = self._problem.space
        local = np.einsum("tqi,bq,tq->tbi", self._force(), space.terms[2], space.measure)
        loads = np.zeros((space.size, 1))
        np.add.at(loads[:, 0], space.element_displacements, local.reshape(len(local), -1))
        return loads

    def _solution(self) -> FloatArray:
        problem, space = self._problem, self._problem.space
        boundary = facet_nodes(space, problem.layer_mesh.mesh.boundary_facets())
        held = np.concatenate([2 * boundary, 2 * boundary + 1])
        values = self._displacement(*problem.positions[:, boundary]).T.ravel()
        if self._is_incompressible:
            held, values = self._with_pressure_level(held, values)
        solver = problem.solver(held)
        return np.asarray(solver.solve_displaced(values[:, None]) + solver.solve_loaded(self._loads()))

    def _with_pressure_level(self, held: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The level of the pressure is free: hold it at the first vertex, and conserve volume.

        The interpolated boundary values let a little flux through, which would leave the layer as a source at that
        vertex, with an error of the pressure of order h^3.
        """
        problem, first = self._problem, self._problem.space.displacement_count
        held = np.append(held, first)
        values = np.append(values, np.prod(np.cos(problem.space.mesh.p[:, 0])))
        flux = np.asarray(problem.matrix[first:].sum(axis=0)).ravel()[held]
        return held, values - flux * (flux @ values) / (flux @ flux)


def irregular_mesh(cells: int) -> LayerMesh:
    """The unit square with so many cells along each side, by halving an irregular mesh of four again and again."""
    side = np.linspace(0, 1, COARSEST + 1)
    square = MeshTri.init_tensor(side, side)
    inner, places = square.interior_nodes(), square.p.copy()
    places[:, inner] += SHIFT / COARSEST * np.random.default_rng(1).uniform(-1, 1, (2, inner.size))
    mesh = MeshTri(places, square.t).refined((cells // COARSEST).bit_length() - 1)
    return named_layer_mesh(mesh.p, mesh.t)


def _gradient_of_phi(r: FloatArray, z: FloatArray) -> FloatArray:
    return np.stack([r**3 * np.sin(z), r**4 / 4 * np.cos(z)], axis=-1)
