"""Unknowns of a mesh, and element matrices of the weak forms by batched dense products.

The matrices equal those of scikit-fem's assembly of `weak_forms` and take a fifth of its time: on straight triangles
the products of basis functions are tabulated once, and each triangle only weights them. Numbering is scikit-fem's own
for `ElementVector`: displacement component c of scalar unknown i is ``2 i + c``. Pressures follow. Strains are stored
as (rr, zz, hoop, sqrt(2) rz), so that ``eps : eps`` is a plain sum of squares.
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
# Sums the normal strains.
TRACE = np.array([1.0, 1.0, 1.0, 0.0])


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
def _products(pair: ElementPair) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Products of basis functions at quadrature points, the same for all triangles.

    The three terms of a displacement function phi are its reference derivatives ``phi,xi`` and ``phi,eta``, and phi.

    Returns:
        Products of the terms of two displacement functions, shape (3, 3, point, basis, basis).
        Products of the terms of a displacement function with the pressure functions, shape (3, point, pressure, basis).
        Values of the pressure functions, shape (pressure, point).
    """
    points, _ = quadrature(pair.degree)
    value, gradient = tabulate(pair.displacement, points)
    terms = np.concatenate([gradient, value[None]])
    pressures = tabulate(pair.pressure, points)[0] if pair.pressure else np.empty((0, points.shape[1]))
    squares, mixed = np.einsum("aip,bjp->abpij", terms, terms), np.einsum("aip,kp->apki", terms, pressures)
    return np.asarray(squares), np.asarray(mixed), pressures


def strains(jacobian: FloatArray) -> FloatArray:
    """Coefficients of the strains of a basis function, shape (triangle, 4, 2, 3).

    Axes: triangle; strain (rr, zz, hoop, sqrt(2) rz); component (r, z); term ``phi,xi``, ``phi,eta`` or ``phi / r``.

    Args:
        jacobian: d(r, z)/d(xi, eta), shape (triangle, 2, 2).
    """
    inverse = np.linalg.inv(jacobian)
    strain = np.zeros((len(inverse), 4, 2, 3), dtype=inverse.dtype)
    strain[:, 0, 0, :2], strain[:, 1, 1, :2] = inverse[:, :, 0], inverse[:, :, 1]
    strain[:, 3, 0, :2], strain[:, 3, 1, :2] = np.sqrt(0.5) * inverse[:, :, 1], np.sqrt(0.5) * inverse[:, :, 0]
    strain[:, 2, 0, 2] = 1.0
    return strain


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
    measure, strain = measures(jacobian, radius, weights), strains(jacobian)
    shear = _strain_products(pair, strain, 2 * moduli.shear * measure, radius, DEVIATOR)
    if not pair.is_mixed:
        if np.any(moduli.compressibility == 0):
            raise InvalidInput("a displacement formulation needs nu < 0.5: take a mixed pair such as P3P2")
        return shear + _strain_products(pair, strain, measure / moduli.compressibility, radius, np.outer(TRACE, TRACE))
    constraint, pressures = _constraints(pair, strain, measure, radius), _products(pair)[2]
    compliance = (pressures * (moduli.compressibility * measure)[:, None, :]) @ pressures.T
    return np.block([[shear, constraint.transpose(0, 2, 1)], [constraint, -compliance]])


def _strain_products(
    pair: ElementPair, strain: FloatArray, weight: FloatArray, radius: FloatArray, form: FloatArray
) -> FloatArray:
    """``int eps(u) : form : eps(v) weight`` of each triangle, shape (triangle, 2 x basis, 2 x basis).

    It sums, over pairs of terms and over points, coefficients of the triangle times products of the reference triangle:
    one matrix product for each pair of components.
    """
    # Axes: triangle, component of u, term of u, component of v, term of v, 1.
    flat, products = strain.reshape(-1, 4, 6), _products(pair)[0]
    mutual = (flat.transpose(0, 2, 1) @ form @ flat).reshape(-1, 2, 3, 2, 3, 1)
    # Factor of each term: 1, 1 and 1/r.
    over_r = np.stack([np.ones_like(radius)] * 2 + [1 / radius], axis=1)
    weights, basis = (weight[:, None] * over_r)[:, :, None] * over_r[:, None], products.shape[-1]
    elements = np.empty((len(weight), basis, 2, basis, 2), dtype=weight.dtype)
    for row, column in ((0, 0), (0, 1), (1, 1)):
        # u_z has no hoop strain: two terms instead of three.
        i, j = slice(3 - row), slice(3 - column)
        share = mutual[:, row, i, column, j] * weights[:, i, j]
        block = share.reshape(len(share), -1) @ products[i, j].reshape(-1, basis**2)
        elements[:, :, row, :, column] = block.reshape(-1, basis, basis)
    elements[:, :, 1, :, 0] = elements[:, :, 0, :, 1].transpose(0, 2, 1)
    return elements.reshape(-1, 2 * basis, 2 * basis)


def _constraints(pair: ElementPair, strain: FloatArray, measure: FloatArray, radius: FloatArray) -> FloatArray:
    """``- int q div u`` of each triangle, shape (triangle, pressure, displacement)."""
    divergence, products = np.einsum("s,tscb->tcb", TRACE, strain), _products(pair)[1]
    weights = np.stack([measure, measure, measure / radius], axis=1)
    elements = np.empty((len(measure), *products.shape[2:], 2), dtype=measure.dtype)
    for component, terms in enumerate((slice(3), slice(2))):
        share = -divergence[:, component, terms, None] * weights[:, terms]
        block = share.reshape(len(share), -1) @ products[terms].reshape(-1, elements[0, ..., 0].size)
        elements[..., component] = block.reshape(elements.shape[:-1])
    return elements.reshape(*elements.shape[:2], -1)


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
