"""Fields inside the layer in one equilibrium, their errors from coarser cells, and files of them for ParaView.

Displacements are those of the solution. Stresses and the gradient of the pressure, which jump between triangles, are
averaged over the triangles that meet at a node; the pressure of a mixed pair is continuous within a part.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from pathlib import Path

import numpy as np
from skfem import Basis, ElementVector

from contact import InvalidInput
from contact.answer.inside import InsideFields, KnownContact
from contact.records.validation import FloatArray, IntArray
from contact.stated import SAFETY
from fem_reference.assembly import barycentric, tabulate
from fem_reference.equilibria import FemEquilibrium
from fem_reference.prescribed_contact import PrescribedContact
from fem_reference.stated import FLOOR

NAMES = tuple(field.name for field in fields(InsideFields) if field.name != "error_estimate")
# Fields that change sign across the axis.
ODD = [NAMES.index(name) for name in ("radial_displacement", "shear_stress", "pressure_gradient_radial")]
# Groups of fields with a common stated error, as slices of `NAMES`.
GROUPS = {
    "displacement": slice(0, 2),
    "stress": slice(2, 6),
    "hydrostatic_pressure": slice(6, 7),
    "pressure_gradient": slice(7, 9),
}
# Two meshes are compared at the nodes of a triangle, moved towards its centre by this share, off faces where fields
# jump.
INWARD = 0.1
# Number of triangles, those with the nearest centres, that are tried before all triangles.
NEAREST = 12
# Least barycentric coordinate of a point inside a triangle, to rounding.
ROUNDING = -1e-10
ENDINGS = (".vtu", ".xdmf")
# Corners and middles of sides of the reference triangle, in the order of quadratic triangles in files.
CORNERS_AND_MIDDLES = np.array([[0, 1, 0, 0.5, 0.5, 0], [0, 0, 1, 0, 0.5, 0.5]])


@dataclass(frozen=True)
class MeridianSection:
    """Fields of one solution at one depth, in the order of `NAMES`; lengths over contact radius a, stresses over E*.

    Stresses are positive in tension, the pressure ``p = -K div u`` in compression; z points into the layer.

    Attributes:
        contact: finite element solution at contact radius one.
        depth: indentation depth delta / a.
    """

    contact: PrescribedContact
    depth: float

    @cached_property
    def corners(self) -> FloatArray:
        """(r, z) of the corners, shape (2, 3, triangle)."""
        mesh = self.contact.layer.section.mesh
        return np.asarray(mesh.p[:, mesh.t])

    @property
    def local_nodes(self) -> FloatArray:
        """Coordinates in the reference triangle of the nodes of the displacement, shape (2, basis)."""
        return np.asarray(self.contact.layer.pair.displacement.doflocs.T)

    def units(self, modulus: float) -> FloatArray:
        """Units of the fields [m, Pa, Pa/m] for E* [Pa], shape (9,)."""
        a = self.contact.contact_radius
        return np.array([a, a, *[modulus] * 5, modulus / a, modulus / a])

    @cached_property
    def nodal(self) -> FloatArray:
        """Values at the nodes of each triangle, averaged over the triangles of a node, shape (triangle, basis, 9)."""
        space = self.contact.layer.space
        numbers, local = space.displacement_dofs.element_dofs.T, self.by_triangle
        total = np.zeros((space.positions.shape[1], len(NAMES)))
        np.add.at(total, numbers, local)
        total /= np.bincount(numbers.ravel())[:, None]
        # Mirrored at the axis these fields change sign: the mean over both sides is zero.
        total[np.ix_(space.positions[0] == 0.0, ODD)] = 0.0
        return np.asarray(total[numbers])

    def at(self, triangles: IntArray, local: FloatArray) -> FloatArray:
        """Values at reference points (2, n) of n triangles, shape (n, 9)."""
        basis = tabulate(self.contact.layer.pair.displacement, local)[0]
        return np.asarray(np.einsum("nbc,bn->nc", self.nodal[triangles], basis))

    @cached_property
    def by_triangle(self) -> FloatArray:
        """Values of each triangle alone at its nodes, shape (triangle, basis, 9).

        ``sigma = 2 mu (eps - tr(eps) / 3) - p`` on the diagonal, ``sigma_rz = mu (u_r,z + u_z,r)``.
        """
        layer = self.contact.layer
        space, unknowns = layer.space, self.contact.solutions @ [self.depth, 1.0]
        at_nodes = self.local_nodes, np.ones(self.local_nodes.shape[1])
        basis = Basis(layer.section.mesh, ElementVector(layer.pair.displacement), quadrature=at_nodes)
        displacement = basis.interpolate(unknowns[space.owner])
        pressure = basis.with_element(layer.pair.pressure).interpolate(unknowns[space.displacement_count :])
        u, slope, p = np.asarray(displacement), displacement.grad, np.asarray(pressure)
        radius, depth = np.swapaxes(space.positions[:, space.displacement_dofs.element_dofs], 1, 2)
        # On the axis the hoop strain is u_r,r.
        hoop = np.divide(u[0], radius, out=slope[0, 0].copy(), where=radius > 0)
        normal = np.array([slope[0, 0], hoop, slope[1, 1]])
        shear = layer.parts.at(layer.section.part, depth).shear
        stress = 2 * shear * (normal - normal.mean(axis=0)) - p
        tangential = shear * (slope[0, 1] + slope[1, 0])
        return np.moveaxis(np.array([*u, *stress, tangential, p, *pressure.grad]), 0, -1)

    def places_of(self, points: FloatArray) -> tuple[IntArray, FloatArray]:
        """Triangle (n,) of each of n points (2, n), and the coordinates (2, n) of the points in the reference triangle.

        A point belongs to the triangle in which its smallest barycentric coordinate is largest: inside it is positive.
        The triangles with the nearest centres are tried first, then all.
        """
        from scipy.spatial import cKDTree  # noqa: PLC0415 - takes 0.1 s to import, and only fields inside need it

        centres = self.corners.mean(axis=1).T
        near = cKDTree(centres).query(points.T, min(NEAREST, len(centres)))[1].reshape(points.shape[1], -1)
        triangle, local, smallest = self._best(points, near)
        if (outside := smallest < ROUNDING).any():
            candidates = np.broadcast_to(np.arange(len(centres)), (int(outside.sum()), len(centres)))
            triangle[outside], local[:, outside], _ = self._best(points[:, outside], candidates)
        return triangle, local

    def _best(self, points: FloatArray, triangles: IntArray) -> tuple[IntArray, FloatArray, FloatArray]:
        """Best of k triangles (n, k) for each point, its reference coordinates and smallest barycentric coordinate."""
        repeated = np.repeat(points, triangles.shape[1], axis=1)[:, :, None]
        mapping = self.contact.layer.section.mesh.mapping()
        local = mapping.invF(repeated, tind=triangles.ravel()).reshape(2, *triangles.shape)
        smallest = np.minimum(local.min(axis=0), 1 - local.sum(axis=0))
        best = np.arange(len(triangles)), smallest.argmax(axis=1)
        return triangles[best], local[:, *best], smallest[best]


@dataclass(frozen=True, eq=False)
class FemInterior:
    """Fields inside the layer in one equilibrium.

    Attributes:
        section: fields of the answer.
        coarser: fields of the companion.
        modulus: E* [Pa].
    """

    section: MeridianSection
    coarser: MeridianSection
    modulus: float

    def at(self, radius: FloatArray, depth: FloatArray) -> InsideFields:
        """Fields at points [m] of shape (n,).

        Raises:
            InvalidInput: a point lies beyond the mesh.
        """
        a = self.section.contact.contact_radius
        triangles, local = self.section.places_of(self._within_mesh(np.array([radius, depth]) / a))
        values = self.section.at(triangles, local) * self.section.units(self.modulus)
        return InsideFields(
            **dict(zip(NAMES, values.T, strict=True)),
            error_estimate=self._stated(values, SAFETY * self._changes(triangles)),
        )

    def _within_mesh(self, points: FloatArray) -> FloatArray:
        """Points (r, z) / a, shape (2, n), with a depth that exceeds the thickness by rounding set to the thickness.

        Raises:
            InvalidInput: a point lies beyond the mesh.
        """
        mesh, scale, (r, z) = self.section.contact.layer.section, self.section.contact.contact_radius, points
        rounded = np.where(z <= mesh.thickness * (1 + 1e-14), np.minimum(z, mesh.thickness), z)
        beyond = (r > mesh.outer_radius) | (rounded > mesh.thickness)
        if beyond.any():
            first = points[:, beyond][:, 0] * scale
            raise InvalidInput(
                f"(r, z) = ({first[0]:g}, {first[1]:g}) m lies beyond the mesh of finite elements, which ends at r = "
                f"{mesh.outer_radius * scale:g} m; take a nearer point, or use mdr"
            )
        return np.array([r, rounded])

    def _changes(self, triangles: IntArray) -> FloatArray:
        """Largest difference [SI] of each field from the coarser mesh, in the triangle of each of n points, (n, 9)."""
        fine, coarse = self.section, self.coarser
        distinct, inverse = np.unique(triangles, return_inverse=True)
        local = fine.local_nodes + INWARD * (1 / 3 - fine.local_nodes)
        points = np.einsum("cvt,vb->ctb", fine.corners[:, :, distinct], barycentric(local)).reshape(2, -1)
        points *= fine.contact.contact_radius / coarse.contact.contact_radius
        mesh = coarse.contact.layer.section
        coarse_places = coarse.places_of(np.minimum(points, [[mesh.outer_radius], [mesh.thickness]]))
        fine_places = np.repeat(distinct, local.shape[1]), np.tile(local, len(distinct))
        change = np.abs(
            fine.at(*fine_places) * fine.units(self.modulus) - coarse.at(*coarse_places) * coarse.units(self.modulus)
        )
        # Displacements of the touched surface change by as much as the depth.
        depth, coarse_depth = (each.depth * each.contact.contact_radius for each in (fine, coarse))
        change[:, :2] = np.maximum(change[:, :2], abs(depth - coarse_depth))
        return np.asarray(change.reshape(len(distinct), -1, len(NAMES)).max(axis=1)[inverse])

    def _stated(self, values: FloatArray, error: FloatArray) -> dict[str, float]:
        """Relative error of each group of fields in `GROUPS`: its largest error at the points over a scale.

        The scale of displacements is the depth. The scale of stresses and of the pressure is the largest of both at the
        points. The scale of the gradient is its largest value, at least the largest stress over min(a, thickness).
        """
        contact, tiny = self.section.contact, np.finfo(float).tiny
        depth = max(abs(self.section.depth) * contact.contact_radius, tiny)
        stress = np.abs(values[:, 2:7]).max(initial=tiny)
        length = contact.contact_radius * min(1.0, contact.layer.section.thickness)
        scales = (depth, stress, stress, max(np.abs(values[:, 7:]).max(initial=0.0), stress / length))
        return {
            name: float(error[:, group].max(initial=0.0)) / scale + FLOOR
            for (name, group), scale in zip(GROUPS.items(), scales, strict=True)
        }

    def write(self, path: str | Path) -> None:
        """Write displacement [m], stresses [Pa] and the pressure's gradient [Pa/m] on quadratic triangles.

        Args:
            path: a .vtu or .xdmf file for ParaView.

        Raises:
            InvalidInput: another file ending.
        """
        import meshio  # noqa: PLC0415 - loaded where a file is written

        file, section = Path(path), self.section
        if file.suffix not in ENDINGS:
            raise InvalidInput(f"{file.name}: the ending must be .vtu or .xdmf")
        units, places = section.units(self.modulus), barycentric(CORNERS_AND_MIDDLES)
        basis = tabulate(section.contact.layer.pair.displacement, CORNERS_AND_MIDDLES)[0]
        values = np.einsum("tbc,bn->tnc", section.nodal, basis, optimize=True).reshape(-1, len(NAMES)) * units
        inside = InsideFields(**dict(zip(NAMES, values.T, strict=True)), error_estimate={})
        points = np.einsum("cvt,vn->tnc", section.corners, places).reshape(-1, 2) * units[0]
        flat = np.zeros(len(points))
        vectors = {
            "displacement": np.array([inside.radial_displacement, inside.axial_displacement, flat]),
            "pressure_gradient": np.array([inside.pressure_gradient_radial, inside.pressure_gradient_axial, flat]),
            "principal_stresses": inside.principal_stresses,
        }
        scalars = (*NAMES[2:7], "von_mises", "largest_shear")
        data = {name: parts.T for name, parts in vectors.items()}
        exported = meshio.Mesh(
            np.column_stack([points, flat]),
            [("triangle6", np.arange(len(points)).reshape(-1, 6))],
            point_data=data | {name: getattr(inside, name) for name in scalars},
        )
        exported.write(file, **({"data_format": "XML"} if file.suffix == ".xdmf" else {}))


@dataclass(frozen=True)
class FemFields:
    """Surface fields of a path; satisfies `contact.Fields`.

    Attributes:
        states: the equilibria.
        modulus: E* [Pa].
        coarser: the equilibria of the companion, for the errors of fields inside.
    """

    states: Sequence[FemEquilibrium]
    modulus: float
    coarser: Sequence[FemEquilibrium] = ()

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """Pressure p(r) [Pa]."""
        return self.modulus * self.states[step].pressure(radius)

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """Displacement w(r) [m], positive into the layer; zero beyond the mesh, where it is below its error."""
        return self.states[step].surface_displacement(radius)

    def inside(self, step: int, known: KnownContact) -> FemInterior:
        """Fields inside the layer at one step of the path, with error estimates."""
        fine, coarse = (MeridianSection(path[step].contact, path[step].depth) for path in (self.states, self.coarser))
        return FemInterior(fine, coarse, self.modulus)
