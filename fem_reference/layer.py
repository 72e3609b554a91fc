"""The discrete layer: its matrix, its supports, the unknowns on its top, and the derivative by the contact radius."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse
from skfem import ElementVector, FacetBasis

from contact.records.validation import FloatArray, IntArray
from fem_reference.assembly import ElementPair, Space, barycentric, element_matrices, quadrature, scatter
from fem_reference.materials import Parts, PointModuli
from fem_reference.mesh import Section
from fem_reference.solver import RestrictedSolver
from fem_reference.weak_forms import membrane

# Radial strain s of the patch test u_r = s r, u_z = c z. With c = (1 - 2 nu) - 2 s the volume strain is 1 - 2 nu, so
# that p = -K (1 - 2 nu) is finite at nu = 1/2. Any s of this order serves: the test is linear.
STRETCH = 0.1


@dataclass(frozen=True)
class DiscreteLayer:
    """A layer discretised on one mesh; lengths by the contact radius, stresses by E* of the surface.

    Attributes:
        section: mesh of the cross-section.
        pair: elements of displacement and pressure.
        parts: material over depth, and the support of the base.
        sticks: whether u_r = 0 on the top within radius one, as under a flat punch with full stick.
    """

    section: Section
    pair: ElementPair
    parts: Parts
    sticks: bool = False

    @cached_property
    def space(self) -> Space:
        """Unknowns of the element pair."""
        return Space(self.section.mesh, self.pair, self.section.faces)

    @cached_property
    def corners(self) -> FloatArray:
        """(r, z) of the three corners of each triangle, shape (triangle, 3, 2)."""
        return np.ascontiguousarray(self.section.mesh.p[:, self.section.mesh.t].transpose(2, 1, 0))

    @cached_property
    def moduli(self) -> PointModuli:
        """Moduli at quadrature points, shape (triangle, point)."""
        return self.parts.at(self.section.part, self.corners[:, :, 1] @ barycentric(quadrature(self.pair.degree)[0]))

    @cached_property
    def elements(self) -> FloatArray:
        """Matrix of each triangle, shape (triangle, n, n), in the order of `Space.element_unknowns`."""
        return element_matrices(self.pair, self.corners, self.moduli)

    @cached_property
    def matrix(self) -> sparse.csc_array:
        """Stiffness matrix, shape (size, size), with the membrane at the outer edge."""
        matrix = scatter(self.elements, self.space.element_unknowns, self.space.size)
        return matrix if self.edge is None else matrix + self.edge

    @cached_property
    def edge(self) -> sparse.csc_array | None:
        """`membrane_matrix` at the outer edge of a layer that slides, shape (size, size); None for other layers."""
        return membrane_matrix(self) if self.parts.slides else None

    def nodes_on(self, boundary: str) -> IntArray:
        """Scalar displacement unknowns on a named boundary, in the order of increasing r."""
        return self.space.nodes_on(self.section.mesh.boundaries[boundary])

    @cached_property
    def supported_unknowns(self) -> IntArray:
        """Unknowns prescribed as zero: u_r on the axis, u_z (u_r if bonded) on the base, u_r under a sticking punch.

        Displacements below a face that those above it replace (`Space.owner`) occur in no equation. They are
        prescribed, too, so that the matrix of the others is regular.
        """
        base = self.nodes_on("base")
        prescribed = [2 * self.nodes_on("axis"), 2 * base + 1]
        if self.parts.bonded:
            prescribed.append(2 * base)
        if self.sticks:
            prescribed.append(2 * self.top_nodes(1.0))
        owner = self.space.owner
        return np.unique(np.concatenate([*prescribed, np.flatnonzero(owner != np.arange(len(owner)))]))

    def top_nodes(self, radius: float) -> IntArray:
        """Scalar displacement unknowns of the top cells that end within ``radius``, in the order of increasing r."""
        mesh = self.section.mesh
        facets = mesh.boundaries["top"]
        inside = mesh.p[0, mesh.facets[:, facets]].max(axis=0) <= radius * (1 + 1e-14)
        return self.space.nodes_on(facets[inside])

    def solver(self, prescribed: IntArray) -> RestrictedSolver:
        """Factorised matrix of the layer with these unknowns prescribed."""
        return RestrictedSolver(self.space, self.elements, self.edge, prescribed)

    def derivative_by_radius(self, solutions: FloatArray, eta: FloatArray) -> FloatArray:
        """A'(u_i, u_j), the derivative of ``u_i . K u_j`` when vertices move by ``(eta, 0)`` and carry the unknowns.

        With eta = 1 at the contact edge this is the derivative by the contact radius at fixed thickness. It is the
        exact derivative of the discrete energy (the G-theta method of fracture mechanics). Moduli depend on the depth
        only, so a radial motion does not change them. A complex step, ``K' = Im K(r + i h eta) / h``, has no rounding
        from differences.

        Args:
            solutions: all unknowns of m solutions, shape (size, m).
            eta: radial motion of the vertices, shape (vertex,), zero on the outer edge.

        Returns:
            A'(u_i, u_j), shape (m, m).
        """
        moving = np.flatnonzero((eta[self.section.mesh.t] != 0).any(axis=0))
        step = 1e-20
        corners = self.corners[moving].astype(complex)
        corners[:, :, 0] += 1j * step * eta[self.section.mesh.t[:, moving]].T
        moduli = PointModuli(*(modulus[moving] for modulus in self.moduli))
        slopes = element_matrices(self.pair, corners, moduli).imag / step
        local = solutions[self.space.element_unknowns[moving]]
        return np.asarray(np.einsum("tni,tnj->ij", local, slopes @ local))

    @property
    def patch_defect(self) -> float:
        """Patch test: largest residual of a constant strain in inner equations, over the sum of its terms' magnitudes.

        Nodal values of ``u_r = s r, u_z = c z`` with their constant pressure are inserted into the equations assembled
        for the moduli at the surface (form A of Taylor, Simo, Zienkiewicz and Chan, Int. J. Numer. Meth. Engng 22
        (1986) 39-62). A residual inside is an error of assembly: geometry, quadrature, hoop strain or coupling.
        """
        space, nu, (r, z) = self.space, self.parts.poissons_ratio, self.space.positions
        surface = self.parts.at(np.zeros_like(self.section.part), np.zeros_like(self.moduli.shear))
        is_uniform = all(map(np.array_equal, surface, self.moduli))
        elements = self.elements if is_uniform else element_matrices(self.pair, self.corners, surface)
        shear = float(surface.shear[0, 0])
        state = np.full(space.size, -2 * shear * (1 + nu) / 3)  # p = -K div u with K = 2 mu (1 + nu) / (3 (1 - 2 nu))
        state[: space.displacement_count] = np.column_stack([STRETCH * r, ((1 - 2 * nu) - 2 * STRETCH) * z]).ravel()
        local, unknowns = state[space.element_unknowns][..., None], space.element_unknowns.ravel()
        residual = np.bincount(unknowns, (elements @ local).ravel(), space.size)
        terms = np.bincount(unknowns, (np.abs(elements) @ np.abs(local)).ravel(), space.size)
        boundary = space.nodes_on(np.concatenate([*self.section.mesh.boundaries.values()]))
        terms[np.concatenate([2 * boundary, 2 * boundary + 1, self.supported_unknowns])] = np.inf
        return float(np.max(np.abs(residual) / terms))


def membrane_matrix(layer: DiscreteLayer) -> sparse.csc_array:
    """Matrix of `weak_forms.membrane` on the outer edge, in the numbering of all unknowns, shape (size, size)."""
    mesh, owner = layer.section.mesh, layer.space.owner
    facets = mesh.boundaries["outer"]
    basis = FacetBasis(mesh, ElementVector(layer.pair.displacement), facets=facets)
    depth = basis.global_coordinates()[1]
    shear = layer.parts.at(layer.section.part[mesh.f2t[0, basis.find]], depth).shear
    entries = membrane.assemble(basis, mu=shear).tocoo()
    shape = (layer.space.size, layer.space.size)
    return sparse.coo_array((entries.data, (owner[entries.row], owner[entries.col])), shape=shape).tocsc()
