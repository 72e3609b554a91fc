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
    def _tabulated_displacement(self) -> Tabulation:
        return _tabulated(self.pair.displacement, 2 * self.pair.degree)

    @cached_property
    def gradients(self) -> FloatArray:
        """Gradients of the scalar basis, shape (triangle, 2, basis, point)."""
        reference = self._tabulated_displacement.gradient
        inverse = np.linalg.inv(self.jacobians)
        flat = inverse.transpose(0, 2, 1) @ reference.reshape(2, -1)
        return flat.reshape(len(flat), 2, *reference.shape[1:])

    @cached_property
    def displacement_values(self) -> FloatArray:
        """Scalar basis values, shape (basis, point)."""
        return self._tabulated_displacement.value

    @cached_property
    def pressure_values(self) -> FloatArray:
        """Pressure basis values, shape (basis, point)."""
        return _tabulated(self.pair.pressure, 2 * self.pair.degree).value

    @cached_property
    def strains(self) -> FloatArray:
        """Strain of every basis function, shape (triangle, point, 4, 2 x basis)."""
        gradient = self.gradients.transpose(0, 3, 1, 2)
        triangles, points, _, basis = gradient.shape
        strain = np.zeros((triangles, points, 4, basis, 2))
        strain[:, :, 0, :, 0] = gradient[:, :, 0]
        strain[:, :, 1, :, 1] = gradient[:, :, 1]
        strain[:, :, 2, :, 0] = self.displacement_values.T / self.radius[:, :, None]
        strain[:, :, 3, :, 0] = gradient[:, :, 1] * np.sqrt(0.5)
        strain[:, :, 3, :, 1] = gradient[:, :, 0] * np.sqrt(0.5)
        return strain.reshape(triangles, points, 4, 2 * basis)

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
    # The root of the weight is multiplied into the small matrix: half the passes over the strains.
    deviator = (DEVIATOR * np.sqrt(2 * shear_modulus * space.measure)[:, :, None, None]) @ space.strains
    flat = deviator.reshape(len(deviator), -1, deviator.shape[-1])
    return flat.transpose(0, 2, 1) @ flat


def _divergences(space: Space) -> FloatArray:
    """``div u`` of every basis function, shape (triangle, point, 2 x basis)."""
    return np.asarray(space.strains[:, :, :3].sum(axis=2))


def volume_elements(space: Space, bulk_modulus: float) -> FloatArray:
    """``K int div u div v`` of each triangle."""
    weighted = _divergences(space) * np.sqrt(bulk_modulus * space.measure)[:, :, None]
    return weighted.transpose(0, 2, 1) @ weighted


def constraint_elements(space: Space) -> FloatArray:
    """``- int q div u`` of each triangle, shape (triangle, pressure, displacement)."""
    return -space.pressure_values @ (space.measure[:, :, None] * _divergences(space))


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
    """Sum element matrices (triangle, n, n) into a sparse matrix."""
    count = unknowns.shape[1]
    # Half as many bytes to move: no mesh has 2^31 unknowns.
    short = unknowns.astype(np.int32)
    rows = np.repeat(short, count, axis=1).ravel()
    columns = np.tile(short, (1, count)).ravel()
    return sparse.coo_array((elements.ravel(), (rows, columns)), shape=(size, size)).tocsc()


def node_positions(space: Space) -> FloatArray:
    """(r, z) of the scalar displacement unknowns, shape (2, n)."""
    reference = space.pair.displacement.doflocs.T
    barycentric = np.array([1 - reference.sum(axis=0), *reference])
    positions = np.empty((2, int(space.displacement_dofs.N)))
    positions[:, space.displacement_dofs.element_dofs] = np.einsum(
        "cvt,vb->cbt", space.mesh.p[:, space.mesh.t], barycentric
    )
    return positions
