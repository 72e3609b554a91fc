"""Unknowns of a mesh, and element matrices of the weak forms by batched dense products.

The matrices equal those of scikit-fem's assembly of `weak_forms` and take a fifth of its time: basis functions are
tabulated once for all triangles, and each matrix is one product of strains. Numbering is scikit-fem's own for
`ElementVector`: displacement component c of scalar unknown i is ``2 i + c``. Pressures follow.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from typing import NamedTuple

import numpy as np
from scipy import sparse
from skfem import MeshTri
from skfem.assembly.dofs import Dofs
from skfem.element import Element, ElementTriP0, ElementTriP1, ElementTriP2, ElementTriP3, ElementTriP4
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTri

from contact.records.errors import InvalidInput
from contact.records.validation import FloatArray, IntArray
from fem_reference.materials import PointModuli

# Subtracts the mean of the normal strains (rr, zz, hoop) from a strain (rr, zz, hoop, sqrt(2) rz).
DEVIATOR = np.eye(4)
DEVIATOR[:3, :3] -= 1 / 3


@dataclass(frozen=True)
class ElementPair:
    """Displacement and pressure elements of one formulation.

    Attributes:
        name: name of the pair, such as "P3P2".
        degree: polynomial degree of the displacement.
        displacement: scalar element of each displacement component.
        pressure: element of the pressure, None for a displacement formulation.
        inf_sup_stable: whether the pair satisfies the inf-sup condition (True for a displacement formulation,
            which has none, but locks as nu -> 1/2).
    """

    name: str
    degree: int
    displacement: Element
    pressure: Element | None = None
    inf_sup_stable: bool = True

    @property
    def is_mixed(self) -> bool:
        """Whether the pressure is an unknown."""
        return self.pressure is not None

    @property
    def inner(self) -> list[int]:
        """Indices, among the unknowns of a triangle, of the interior ones that are condensed.

        scikit-fem numbers interior unknowns last. Pressures are condensed only together with displacements: alone their
        block is ``-int p q / K``, which vanishes at nu = 1/2.
        """
        displacements, inside = 2 * len(self.displacement.doflocs), int(self.displacement.interior_dofs)
        count = displacements + len(self.pressure.doflocs) if self.pressure else displacements
        inner_pressures = int(self.pressure.interior_dofs) if self.pressure and inside else 0
        return [*range(displacements - 2 * inside, displacements), *range(count - inner_pressures, count)]


# All element pairs by name: the stable ones, displacement formulations, and two unstable pairs for tests.
PAIRS = {
    pair.name: pair
    for pair in (
        ElementPair("P2P1", 2, ElementTriP2(), ElementTriP1()),
        ElementPair("P3P2", 3, ElementTriP3(), ElementTriP2()),
        ElementPair("P4P3", 4, ElementTriP4(), ElementTriP3()),
        ElementPair("P2", 2, ElementTriP2()),
        ElementPair("P3", 3, ElementTriP3()),
        ElementPair("P4", 4, ElementTriP4()),
        ElementPair("P1P1", 1, ElementTriP1(), ElementTriP1(), inf_sup_stable=False),
        ElementPair("P1P0", 1, ElementTriP1(), ElementTriP0(), inf_sup_stable=False),
    )
}


def taylor_hood(degree: int) -> ElementPair:
    """Taylor-Hood pair P_k-P_(k-1), k = 2, 3 or 4, both continuous: stable at every Poisson's ratio, 1/2 included."""
    return PAIRS[f"P{degree}P{degree - 1}"]


class Face(NamedTuple):
    """The interface of two parts, whose vertices exist twice.

    Attributes:
        above: facets of the upper part.
        below: facets of the lower part, at the same places.
        slips: whether both sides share u_z only (frictionless); else they share u_r, too.
    """

    above: IntArray
    below: IntArray
    slips: bool


@dataclass(frozen=True)
class Space:
    """Unknowns of one element pair on one mesh; both sides of a face share the displacements of the part above.

    The pressure jumps where the material does, so each part has pressures of its own.

    Attributes:
        mesh: triangles of all parts; the parts are not connected.
        pair: elements of displacement and pressure.
        faces: interfaces between the parts.
    """

    mesh: MeshTri
    pair: ElementPair
    faces: tuple[Face, ...] = ()

    @cached_property
    def displacement_dofs(self) -> Dofs:
        """scikit-fem's numbering of the unknowns of one displacement component."""
        return Dofs(self.mesh, self.pair.displacement)

    @property
    def displacement_count(self) -> int:
        """Number of displacement unknowns, both components."""
        return 2 * int(self.displacement_dofs.N)

    @cached_property
    def pressure_dofs(self) -> Dofs:
        """scikit-fem's numbering of the pressure unknowns."""
        return Dofs(self.mesh, self.pair.pressure)

    @cached_property
    def size(self) -> int:
        """Number of all unknowns."""
        return self.displacement_count + (int(self.pressure_dofs.N) if self.pair.is_mixed else 0)

    @cached_property
    def positions(self) -> FloatArray:
        """(r, z) of the scalar displacement unknowns, shape (2, n): scikit-fem's `doflocs`, without its `Basis`."""
        nodes, positions = self.pair.displacement.doflocs.T, np.empty((2, int(self.displacement_dofs.N)))
        positions[:, self.displacement_dofs.element_dofs] = np.einsum(
            "cvt,vb->cbt", self.mesh.p[:, self.mesh.t], barycentric(nodes)
        )
        return positions

    def nodes_on(self, facets: IntArray) -> IntArray:
        """Scalar displacement unknowns on facets, in the order of increasing r."""
        nodes = np.unique(self.displacement_dofs.get_facet_dofs(facets).all()).astype(np.int64)
        return nodes[np.argsort(self.positions[0, nodes], kind="stable")]

    @cached_property
    def owner(self) -> IntArray:
        """Displacement unknown that replaces each one in the equations: itself, except on the lower side of a face."""
        owner = np.arange(self.displacement_count)
        for face in self.faces:
            above, below = self.nodes_on(face.above), self.nodes_on(face.below)
            owner[2 * below + 1] = 2 * above + 1
            if not face.slips:
                owner[2 * below] = 2 * above
        return owner

    @cached_property
    def element_unknowns(self) -> IntArray:
        """All unknowns of each triangle, shape (triangle, n): u_r and u_z of each node in turn, then the pressures."""
        scalar = self.displacement_dofs.element_dofs.T.astype(np.int64)
        unknowns = np.asarray(self.owner[np.stack([2 * scalar, 2 * scalar + 1], axis=-1).reshape(len(scalar), -1)])
        if not self.pair.is_mixed:
            return unknowns
        return np.hstack([unknowns, self.pressure_dofs.element_dofs.T.astype(np.int64) + self.displacement_count])


def barycentric(points: FloatArray) -> FloatArray:
    """Barycentric coordinates (3, n) of points (2, n) of the reference triangle."""
    return np.array([1 - points.sum(axis=0), *points])


def tabulate(element: Element, points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Values (basis, n) and reference gradients (2, basis, n) of all basis functions at reference points (2, n)."""
    count = int(3 * element.nodal_dofs + 3 * element.facet_dofs + element.interior_dofs)
    pairs = [element.lbasis(points, i) for i in range(count)]
    value = np.array([np.broadcast_to(phi, points.shape[1]) for phi, _ in pairs], dtype=float)
    gradient = np.array([[np.broadcast_to(d, points.shape[1]) for d in dphi] for _, dphi in pairs], dtype=float)
    return value, gradient.transpose(1, 0, 2)


@cache
def quadrature(degree: int) -> tuple[FloatArray, FloatArray]:
    """Points (2, n) and weights (n,) on the reference triangle, exact for polynomials of degree 2 k, k = ``degree``.

    Of uniform parts all integrands are polynomials of lower degree, except the hoop terms ``u_r v_r / r``.
    """
    points, weights = get_quadrature(RefTri, 2 * degree)
    return points, weights


@cache
def tables(pair: ElementPair) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Basis functions at quadrature points, the same for all triangles.

    Returns:
        Values of displacement functions, shape (basis, point).
        Their reference gradients, shape (2, basis, point).
        Values of pressure functions, shape (pressure, point).
    """
    points, _ = quadrature(pair.degree)
    pressures = tabulate(pair.pressure, points)[0] if pair.pressure else np.empty((0, points.shape[1]))
    return *tabulate(pair.displacement, points), pressures


def strains(pair: ElementPair, jacobian: FloatArray, radius: FloatArray) -> FloatArray:
    """Strains of all displacement functions at quadrature points, shape (triangle, 4, point, 2 x basis).

    The second axis is (rr, zz, hoop, sqrt(2) rz), so that ``eps : eps`` is a plain sum of squares.

    Args:
        pair: elements of displacement and pressure.
        jacobian: d(r, z)/d(xi, eta), shape (triangle, 2, 2).
        radius: r at the quadrature points, shape (triangle, point).
    """
    value, gradient, _ = tables(pair)
    inverse = np.linalg.inv(jacobian)
    by_r, by_z = (np.tensordot(inverse[:, :, axis], gradient, 1).transpose(0, 2, 1) for axis in (0, 1))
    strain = np.zeros((len(radius), 4, *by_r.shape[1:], 2), dtype=inverse.dtype)
    strain[:, 0, ..., 0], strain[:, 1, ..., 1], strain[:, 2, ..., 0] = by_r, by_z, value.T / radius[..., None]
    strain[:, 3, ..., 0], strain[:, 3, ..., 1] = np.sqrt(0.5) * by_z, np.sqrt(0.5) * by_r
    return strain.reshape(*strain.shape[:3], -1)


def measures(jacobian: FloatArray, radius: FloatArray, weights: FloatArray) -> FloatArray:
    """``2 pi r dr dz`` at quadrature points, shape (triangle, point)."""
    # Triangles with sorted vertices, as scikit-fem has them, may be clockwise. np.abs would end complex steps.
    determinant = np.linalg.det(jacobian)
    return np.asarray(2 * np.pi * radius * (determinant * np.sign(determinant.real))[:, None] * weights)


def element_matrices(pair: ElementPair, corners: FloatArray, moduli: PointModuli) -> FloatArray:
    """Matrix ``[[A, B^T], [B, -C]]`` of each triangle, in the order of `Space.element_unknowns`.

    A, B and C are `weak_forms.shear`, `constraint` and `pressure_mass` / K. A displacement formulation has A plus
    `weak_forms.volume` alone.

    Args:
        pair: elements of displacement and pressure.
        corners: (r, z) of the corners, shape (triangle, 3, 2); may be complex, for derivatives by complex steps.
        moduli: mu and 1/K at quadrature points, shape (triangle, point).

    Raises:
        InvalidInput: a displacement formulation of an incompressible material.
    """
    points, weights = quadrature(pair.degree)
    jacobian = np.stack([corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]], axis=-1)
    radius = corners[:, :, 0] @ barycentric(points)
    measure, strain = measures(jacobian, radius, weights), strains(pair, jacobian, radius)
    dilation, count = strain[:, :3].sum(axis=1), len(strain)
    deviator = (DEVIATOR @ strain.reshape(count, 4, -1)).reshape(strain.shape)
    shear = _products(deviator, 2 * moduli.shear * measure)
    if not pair.is_mixed:
        if np.any(moduli.compressibility == 0):
            raise InvalidInput("a displacement formulation needs nu < 0.5: take a mixed pair such as P3P2")
        return shear + _products(dilation[:, None], measure / moduli.compressibility)
    pressures = tables(pair)[2]
    constraint = -(pressures * measure[:, None]) @ dilation
    compliance = (pressures * (moduli.compressibility * measure)[:, None]) @ pressures.T
    return np.block([[shear, constraint.transpose(0, 2, 1)], [constraint, -compliance]])


def _products(strain: FloatArray, weight: FloatArray) -> FloatArray:
    """Sum of products of strains (triangle, m, point, n) with weights (triangle, point), shape (triangle, n, n)."""
    weighted = strain * weight[:, None, :, None]
    shape = len(strain), -1, strain.shape[-1]
    return np.asarray(weighted.reshape(shape).transpose(0, 2, 1) @ strain.reshape(shape))


def scatter(elements: FloatArray, unknowns: IntArray, size: int) -> sparse.csc_array:
    """Sum of element matrices (triangle, n, n) as a sparse matrix of shape (size, size).

    It is ``P^T R``: R has each row of each element matrix as one sparse row, and P assigns these rows to unknowns. The
    product adds all entries of one matrix position, without the sorting of duplicates in COO format.
    """
    count, short = unknowns.shape[1], unknowns.astype(np.int32)
    ends = np.arange(short.size + 1, dtype=np.int32)
    rows = sparse.csr_array(
        (elements.ravel(), np.repeat(short, count, axis=0).ravel(), count * ends), (short.size, size)
    )
    assignment = sparse.csc_array((np.ones(short.size), short.ravel(), ends), shape=(size, short.size))
    return (assignment.tocsr() @ rows).tocsc()
