"""Element matrices of the weak forms by batched dense products; equal to scikit-fem's assembly, several times faster.

Numbering is scikit-fem's own: displacement component c of scalar unknown i is ``2 i + c``; pressures follow.
Strains are kept as (rr, zz, hoop, sqrt(2) rz), so that ``eps : eps`` is a plain sum of squares.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
from scipy import sparse
from skfem import MeshTri
from skfem.assembly.dofs import Dofs
from skfem.element import Element
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTri

from contact.records.validation import FloatArray, IntArray
from fem_reference.discrete_layer.elements import ElementPair
from fem_reference.discrete_layer.material import Moduli

# Takes the mean of the normal strains (rr, zz, hoop) off a strain (rr, zz, hoop, sqrt(2) rz).
DEVIATOR = np.eye(4)
DEVIATOR[:3, :3] -= 1 / 3
# Sums the normal strains.
TRACE = np.array([1.0, 1.0, 1.0, 0.0])


@dataclass(frozen=True)
class Tabulation:
    """Basis functions of one element at quadrature points of the reference triangle.

    Attributes:
        value: shape (basis, point).
        gradient: reference gradients, shape (2, basis, point).
    """

    value: FloatArray
    gradient: FloatArray


def tabulate(element: Element, points: FloatArray) -> Tabulation:
    """Values and reference gradients of every basis function at reference points (2, n)."""
    pairs = [element.lbasis(points, i) for i in range(_basis_count(element))]
    value = np.array([np.broadcast_to(phi, points.shape[1]) for phi, _ in pairs], dtype=float)
    gradient = np.array([[np.broadcast_to(d, points.shape[1]) for d in dphi] for _, dphi in pairs], dtype=float)
    return Tabulation(value, gradient.transpose(1, 0, 2))


def _basis_count(element: Element) -> int:
    return int(3 * element.nodal_dofs + 3 * element.facet_dofs + element.interior_dofs)


@cache
def _quadrature(degree: int) -> tuple[FloatArray, FloatArray]:
    """Points (2, n) and weights of the rule exact for ``degree``."""
    points, weights = get_quadrature(RefTri, degree)
    return points, weights


@cache
def _tabulated(element: Element, degree: int) -> Tabulation:
    """`tabulate` at the points of the rule for ``degree``: the same on every mesh."""
    return tabulate(element, _quadrature(degree)[0])


@cache
def _terms(element: Element, degree: int) -> FloatArray:
    """Reference derivatives and value of every basis function at the points of a rule, shape (3, basis, point)."""
    tabulated = _tabulated(element, degree)
    return np.concatenate([tabulated.gradient, tabulated.value[None]])


@cache
def _term_products(element: Element, degree: int) -> FloatArray:
    """Products of two terms of two basis functions, shape (3, 3, point, basis, basis)."""
    terms = _terms(element, degree)
    return np.asarray(np.einsum("aip,bjp->abpij", terms, terms))


@cache
def _pressure_products(pair: ElementPair, degree: int) -> FloatArray:
    """Those of a displacement's terms and a pressure, shape (3, point, pressure, basis)."""
    pressures = _tabulated(pair.pressure, degree).value
    return np.asarray(np.einsum("aip,kp->apki", _terms(pair.displacement, degree), pressures))


@dataclass(frozen=True)
class Space:
    """Displacement and pressure of one element pair on one mesh, seen at the quadrature points."""

    mesh: MeshTri
    pair: ElementPair

    @cached_property
    def displacement_dofs(self) -> Dofs:
        """Numbering of one displacement component."""
        return Dofs(self.mesh, self.pair.displacement)

    @cached_property
    def pressure_dofs(self) -> Dofs:
        """Numbering of the pressure."""
        return Dofs(self.mesh, self.pair.pressure)

    @property
    def displacement_count(self) -> int:
        """Displacement unknowns, both components."""
        return 2 * int(self.displacement_dofs.N)

    @property
    def size(self) -> int:
        """All unknowns."""
        return self.displacement_count + (int(self.pressure_dofs.N) if self.pair.is_mixed else 0)

    @property
    def quadrature(self) -> tuple[FloatArray, FloatArray]:
        """Rule on the reference triangle: exact for degree 2k, scikit-fem's own default."""
        return _quadrature(2 * self.pair.degree)

    @cached_property
    def jacobians(self) -> FloatArray:
        """``dx/dX`` of each triangle, shape (triangle, 2, 2)."""
        corners = self.mesh.p[:, self.mesh.t]
        return np.stack([corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]], axis=-1).transpose(1, 0, 2)

    @cached_property
    def radius(self) -> FloatArray:
        """r at the quadrature points, shape (triangle, point)."""
        points, _ = self.quadrature
        barycentric = np.array([1 - points.sum(axis=0), *points])
        return np.asarray(self.mesh.p[0, self.mesh.t].T @ barycentric)

    @cached_property
    def measure(self) -> FloatArray:
        """``2 pi r dr dz`` at the quadrature points, shape (triangle, point)."""
        _, weights = self.quadrature
        area = np.abs(np.linalg.det(self.jacobians))[:, None] * weights
        return np.asarray(2 * np.pi * self.radius * area)

    @property
    def terms(self) -> FloatArray:
        """Reference derivatives and value of every scalar basis function, shape (3, basis, point)."""
        return _terms(self.pair.displacement, 2 * self.pair.degree)

    @cached_property
    def inverse_jacobians(self) -> FloatArray:
        """``dX/dx`` of each triangle, shape (triangle, 2, 2)."""
        return np.asarray(np.linalg.inv(self.jacobians))

    @cached_property
    def pressure_values(self) -> FloatArray:
        """Pressure basis values, shape (basis, point)."""
        return _tabulated(self.pair.pressure, 2 * self.pair.degree).value

    @cached_property
    def strains(self) -> FloatArray:
        """Strain by (component, term) of a displacement's basis function, shape (triangle, 4, 6).

        The terms are its two reference derivatives and its value over r.
        """
        inverse = self.inverse_jacobians
        strain = np.zeros((len(inverse), 4, 2, 3))
        strain[:, 0, 0, :2], strain[:, 1, 1, :2] = inverse[:, :, 0], inverse[:, :, 1]
        strain[:, 3, 0, :2], strain[:, 3, 1, :2] = np.sqrt(0.5) * inverse[:, :, 1], np.sqrt(0.5) * inverse[:, :, 0]
        strain[:, 2, 0, 2] = 1.0
        return strain.reshape(-1, 4, 6)

    @cached_property
    def element_displacements(self) -> IntArray:
        """Global displacement unknowns of each triangle, shape (triangle, 2 x basis)."""
        scalar = self.displacement_dofs.element_dofs.T.astype(np.int64)
        return np.stack([2 * scalar, 2 * scalar + 1], axis=-1).reshape(len(scalar), -1)

    @cached_property
    def element_pressures(self) -> IntArray:
        """Global pressure unknowns of each triangle, shape (triangle, basis)."""
        return np.asarray(self.pressure_dofs.element_dofs.T.astype(np.int64) + self.displacement_count)

    @cached_property
    def inner(self) -> tuple[int, int]:
        """How many displacements and pressures lie inside a triangle; pressures alone there are left to the others."""
        displacements = 2 * int(self.pair.displacement.interior_dofs)
        return displacements, int(self.pair.pressure.interior_dofs) if self.pair.pressure and displacements else 0

    @property
    def inner_count(self) -> int:
        """Unknowns inside a triangle."""
        return sum(self.inner)

    @cached_property
    def local_order(self) -> tuple[tuple[int, slice], ...]:
        """Parts of a triangle's displacements (0) and pressures (1): those it shares, then those inside it."""
        shared = [
            slice(0, len(of_triangle[0]) - inside)
            for of_triangle, inside in zip(self._by_kind, self.inner, strict=True)
        ]
        inside = [slice(part.stop, None) for part in shared]
        return tuple(enumerate(shared)) + tuple(enumerate(inside))

    @cached_property
    def _by_kind(self) -> tuple[IntArray, IntArray]:
        return self.element_displacements, self.element_pressures

    @cached_property
    def element_unknowns(self) -> IntArray:
        """All unknowns of each triangle, in the order of `local_order`."""
        if not self.pair.is_mixed:
            return self.element_displacements
        return np.hstack([self._by_kind[kind][:, part] for kind, part in self.local_order])


def shear_elements(space: Space, shear_modulus: float | FloatArray) -> FloatArray:
    """``2 mu int dev(u) : dev(v)`` of each triangle."""
    return _strain_elements(space, 2 * shear_modulus * space.measure, DEVIATOR)


def volume_elements(space: Space, bulk_modulus: float) -> FloatArray:
    """``K int div u div v`` of each triangle."""
    return _strain_elements(space, bulk_modulus * space.measure, np.outer(TRACE, TRACE))


def _strain_elements(space: Space, weight: FloatArray, form: FloatArray) -> FloatArray:
    """``int eps(u) : form : eps(v) weight`` of each triangle.

    A sum over pairs of terms and points: what a triangle is multiplies what the element is, in few large products.
    """
    strains, products = space.strains, _term_products(space.pair.displacement, 2 * space.pair.degree)
    mutual = (strains.transpose(0, 2, 1) @ form @ strains).reshape(-1, 2, 3, 2, 3, 1)
    weights, basis = _over_radius(space, weight), space.terms.shape[1]
    elements = np.empty((len(weight), basis, 2, basis, 2))
    for one, other in ((0, 0), (0, 1), (1, 1)):
        # Axial displacements have no part over r.
        i, j = slice(3 - one), slice(3 - other)
        share = mutual[:, one, i, other, j] * weights[:, i, j]
        block = share.reshape(len(share), -1) @ products[i, j].reshape(-1, basis**2)
        elements[:, :, one, :, other] = block.reshape(-1, basis, basis)
    elements[:, :, 1, :, 0] = elements[:, :, 0, :, 1].transpose(0, 2, 1)
    return elements.reshape(-1, 2 * basis, 2 * basis)


def _over_radius(space: Space, weight: FloatArray) -> FloatArray:
    """``weight`` over r once for each of two terms that is a value over r, shape (triangle, 3, 3, point)."""
    over = np.ones((len(weight), 3, weight.shape[1]))
    over[:, 2] = 1 / space.radius
    return (weight[:, None] * over)[:, :, None] * over[:, None]


def constraint_elements(space: Space) -> FloatArray:
    """``- int q div u`` of each triangle, shape (triangle, pressure, displacement)."""
    divergence = (TRACE @ space.strains).reshape(-1, 2, 3, 1)
    weights, basis = _over_radius(space, space.measure)[:, 0], space.terms.shape[1]
    products = _pressure_products(space.pair, 2 * space.pair.degree)
    elements = np.empty((len(weights), len(space.pressure_values), basis, 2))
    for component in range(2):
        share = -divergence[:, component, : 3 - component] * weights[:, : 3 - component]
        block = share.reshape(len(share), -1) @ products[: 3 - component].reshape(-1, elements[0, ..., 0].size)
        elements[..., component] = block.reshape(elements.shape[:-1])
    return elements.reshape(*elements.shape[:2], -1)


def pressure_mass_elements(space: Space) -> FloatArray:
    """``int p q`` of each triangle."""
    return (space.pressure_values * space.measure[:, None, :]) @ space.pressure_values.T


def stiffness_elements(space: Space, moduli: Moduli) -> FloatArray:
    """Element matrices of the whole formulation, mixed or displacement."""
    shear = shear_elements(space, moduli.shear)
    if not space.pair.is_mixed:
        return shear + volume_elements(space, moduli.bulk)
    compliance = moduli.compressibility * pressure_mass_elements(space)
    return saddle_elements(space, shear, constraint_elements(space), compliance)


def saddle_elements(space: Space, shear: FloatArray, constraint: FloatArray, compliance: FloatArray) -> FloatArray:
    """``[[A, B^T], [B, -C]]`` of each triangle, in the order of `Space.local_order`."""
    kinds, parts = ((shear, constraint.transpose(0, 2, 1)), (constraint, -compliance)), space.local_order
    return np.block([[kinds[i][j][:, rows, columns] for j, columns in parts] for i, rows in parts])


def scatter(elements: FloatArray, unknowns: IntArray, size: int) -> sparse.csc_array:
    """Sum element matrices (triangle, n, n) into a sparse matrix.

    A product of sparse matrices adds the rows that belong to one unknown: its duplicates need no sorting.
    """
    count = unknowns.shape[1]
    # Half as many bytes to move: no mesh has 2^31 unknowns.
    short = unknowns.astype(np.int32)
    ends = np.arange(short.size + 1, dtype=np.int32)
    rows = sparse.csr_array(
        (elements.ravel(), np.repeat(short, count, axis=0).ravel(), count * ends), (short.size, size)
    )
    belongs = sparse.csc_array((np.ones(short.size), short.ravel(), ends), shape=(size, short.size))
    return (belongs.tocsr() @ rows).tocsc()


def node_positions(space: Space) -> FloatArray:
    """(r, z) of the scalar displacement unknowns, shape (2, n)."""
    reference = space.pair.displacement.doflocs.T
    barycentric = np.array([1 - reference.sum(axis=0), *reference])
    positions = np.empty((2, int(space.displacement_dofs.N)))
    positions[:, space.displacement_dofs.element_dofs] = np.einsum(
        "cvt,vb->cbt", space.mesh.p[:, space.mesh.t], barycentric
    )
    return positions
