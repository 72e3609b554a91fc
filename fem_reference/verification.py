"""Problems that need no other method: whether elements solve their equations at their orders, and are stable.

Manufactured solutions. At nu = 1/2 u = (-r^3 cos z, 4 r^2 sin z) has no divergence, and p is independent of it: here
p = cos r cos z. For nu < 1/2 grad phi with phi = (r^4/4) sin z is added, whose divergence is
D = (4 r^2 - r^4/4) sin z, and the material law requires p = -K D. The body force is
f = -mu (Lap u + grad D/3) + grad p, with the Laplacian of a vector: (Lap u)_r = Lap(u_r) - u_r/r^2.

Inf-sup constant, the measure of how well displacements control the pressure as meshes refine:

    beta = min_q max_v  int q div v / (|v|_1 |q|_0),

the square root of the smallest eigenvalue of ``B H^-1 B^T q = beta^2 M q``, with B, H and M the matrices of
`weak_forms.constraint`, `displacement_gradient` and `pressure_mass`. A stable pair keeps beta bounded below.
For nu < 1/2 compressibility controls the pressure, too: with mu H as the shear form, ``B H^-1 B^T + (mu/K) M`` takes
the place of ``B H^-1 B^T``, and sqrt(beta^2 + mu/K) that of beta.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.linalg import cho_factor, cho_solve, eigh
from skfem import Basis, ElementVector, LinearForm, MeshTri

from contact.records.validation import FloatArray
from fem_reference import weak_forms
from fem_reference.assembly import ElementPair
from fem_reference.layer import DiscreteLayer
from fem_reference.materials import uniform
from fem_reference.mesh import Section, named_section

# Cells along a side of the mesh that is halved.
COARSEST = 4
# Its inner vertices move by this share of a cell at most: triangles become irregular and stay far from flat.
SHIFT = 0.25


def uniform_layer(section: Section, pair: ElementPair, poissons_ratio: float, *, bonded: bool = True) -> DiscreteLayer:
    """A uniform layer of contact modulus one on a section of any thickness."""
    return DiscreteLayer(section, pair, uniform(poissons_ratio, section.thickness, bonded=bonded))


def plain_section(mesh: MeshTri) -> Section:
    """A section of one part, with named boundaries, from the triangles of a rectangle."""
    return named_section(mesh.p, mesh.t, np.zeros(mesh.t.shape[1], dtype=np.int64), uniform(0.5))


def uniform_mesh(cells: int) -> MeshTri:
    """Regular mesh of 0 < r < 2, 0 < z < 1 with named boundaries and ``cells`` cells across its thickness."""
    return plain_section(MeshTri.init_tensor(np.linspace(0, 2, 2 * cells + 1), np.linspace(0, 1, cells + 1))).mesh


def irregular_section(cells: int) -> Section:
    """The unit square with ``cells`` = 4, 8, 16, .. cells along each side: an irregular mesh, refined uniformly."""
    side = np.linspace(0, 1, COARSEST + 1)
    square = MeshTri.init_tensor(side, side)
    inner, places = square.interior_nodes(), square.p.copy()
    places[:, inner] += SHIFT / COARSEST * np.random.default_rng(1).uniform(-1, 1, (2, inner.size))
    return plain_section(MeshTri(places, square.t).refined((cells // COARSEST).bit_length() - 1))


def inf_sup_constant(pair: ElementPair, mesh: MeshTri) -> float:
    """Inf-sup constant beta of a pair on a mesh with named axis (u_r = 0) and base (u = 0), other sides free."""
    displacement = Basis(mesh, ElementVector(pair.displacement))
    pressure = displacement.with_element(pair.pressure)
    axis = displacement.get_dofs("axis").all(["u^1"])
    prescribed = np.concatenate([axis, displacement.get_dofs("base").all()])
    free = np.setdiff1d(np.arange(displacement.N), prescribed)
    gradient = weak_forms.displacement_gradient.assemble(displacement).toarray()[np.ix_(free, free)]
    divergence = weak_forms.constraint.assemble(displacement, pressure).toarray()[:, free]
    mass = weak_forms.pressure_mass.assemble(pressure).toarray()
    schur = divergence @ cho_solve(cho_factor(gradient), divergence.T)
    smallest = eigh((schur + schur.T) / 2, mass, eigvals_only=True, subset_by_index=[0, 0])[0]
    return float(np.sqrt(max(smallest, 0.0)))


@dataclass(frozen=True)
class ManufacturedProblem:
    """The manufactured solution on an irregular mesh of the unit square.

    Attributes:
        pair: elements of displacement and pressure.
        poissons_ratio: nu.
        cells: number of cells along each side.
    """

    pair: ElementPair
    poissons_ratio: float
    cells: int

    @cached_property
    def layer(self) -> DiscreteLayer:
        """The layer discretised with ``cells`` cells along each side."""
        return uniform_layer(irregular_section(self.cells), self.pair, self.poissons_ratio)

    @property
    def unknowns(self) -> int:
        """Number of displacement and pressure unknowns."""
        return self.layer.space.size

    @property
    def _is_incompressible(self) -> bool:
        """Whether nu = 1/2."""
        return self.poissons_ratio == 0.5

    @cached_property
    def _shear_and_bulk(self) -> tuple[float, float]:
        """Shear modulus mu and bulk modulus K over E*; K is infinite at nu = 1/2."""
        shear, compressibility = (float(values[0, 0]) for values in self.layer.moduli)
        return shear, 1 / compressibility if compressibility else np.inf

    def displacement(self, r: FloatArray, z: FloatArray) -> FloatArray:
        """Exact u_r and u_z, shape (2, ...)."""
        solenoidal = np.stack([-(r**3) * np.cos(z), 4 * r**2 * np.sin(z)])
        gradient = np.stack([r**3 * np.sin(z), r**4 / 4 * np.cos(z)])
        return np.asarray(solenoidal if self._is_incompressible else solenoidal + gradient)

    def pressure(self, r: FloatArray, z: FloatArray) -> FloatArray:
        """Exact pressure p, of the shape of r."""
        if self._is_incompressible:
            return np.asarray(np.cos(r) * np.cos(z))
        return np.asarray(-self._shear_and_bulk[1] * (4 * r**2 - r**4 / 4) * np.sin(z))

    def force(self, r: FloatArray, z: FloatArray) -> FloatArray:
        """Body force f, shape (2, ...)."""
        shear, bulk = self._shear_and_bulk
        force = -shear * np.stack([(r**3 - 8 * r) * np.cos(z), (16 - 4 * r**2) * np.sin(z)])
        if self._is_incompressible:
            return np.asarray(force + np.stack([-np.sin(r) * np.cos(z), -np.cos(r) * np.sin(z)]))
        gradient_of_divergence = np.stack([(8 * r - r**3) * np.sin(z), (4 * r**2 - r**4 / 4) * np.cos(z)])
        return np.asarray(force - (4 / 3 * shear + bulk) * gradient_of_divergence)

    def errors(self) -> tuple[float, float]:
        """L2 errors of displacement and pressure, relative to their norms."""
        basis = Basis(self.layer.section.mesh, ElementVector(self.pair.displacement))
        solution, count = self._solution(basis), basis.N
        points, weight = basis.global_coordinates(), basis.dx * 2 * np.pi * basis.global_coordinates()[0]
        field = basis.interpolate(solution[:count])
        if self.pair.is_mixed:
            pressure = np.asarray(basis.with_element(self.pair.pressure).interpolate(solution[count:]))
        else:
            divergence = field.grad[0, 0] + field.grad[1, 1] + field[0] / points[0]
            pressure = -self._shear_and_bulk[1] * divergence
        exact = self.displacement(*points), self.pressure(*points)
        difference = pressure - exact[1]
        if self._is_incompressible:
            # The level of the pressure has the pointwise error at the vertex where the pressure is prescribed.
            difference -= np.sum(difference * weight) / weight.sum()
        pairs = ((np.asarray(field) - exact[0], exact[0]), (difference, exact[1]))
        u_error, p_error = (float(np.sqrt(np.sum(d**2 * weight) / np.sum(e**2 * weight))) for d, e in pairs)
        return u_error, p_error

    def _solution(self, basis: Basis) -> FloatArray:
        """All unknowns, with the exact displacement on the boundary."""
        layer, space = self.layer, self.layer.space

        def work(v: Any, w: Any) -> Any:
            """Integrand ``2 pi r f . v`` of the virtual work of the body force."""
            force = self.force(*w.x)
            return (force[0] * v[0] + force[1] * v[1]) * weak_forms.measure(w)

        loads = np.zeros((space.size, 1))
        loads[: basis.N, 0] = LinearForm(work).assemble(basis)
        boundary = space.nodes_on(layer.section.mesh.boundary_facets())
        prescribed = np.concatenate([2 * boundary, 2 * boundary + 1])
        values = self.displacement(*space.positions[:, boundary]).ravel()
        if self._is_incompressible:
            prescribed, values = self._with_pressure_level(prescribed, values)
        solver = layer.solver(prescribed)
        return np.asarray(solver.solve_displaced(values[:, None]) + solver.solve_loaded(loads))[:, 0]

    def _with_pressure_level(self, prescribed: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Prescribed unknowns and values: the exact pressure at the first vertex, boundary values without net flux.

        With u given on the whole boundary the level of the pressure is free. Interpolated boundary values have a small
        net flux, which would enter as a source at that vertex, with an error of the pressure of order h^3.
        """
        first = self.layer.space.displacement_count
        prescribed = np.append(prescribed, first)
        values = np.append(values, np.prod(np.cos(self.layer.section.mesh.p[:, 0])))
        flux = np.asarray(self.layer.matrix[first:].sum(axis=0)).ravel()[prescribed]
        return prescribed, values - flux * (flux @ values) / (flux @ flux)
