"""The interior of the layer in one equilibrium: displacement and stress at any point, and files for ParaView."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import meshio
import numpy as np
from numpy.typing import ArrayLike

from contact import InvalidInput
from contact.records.validation import FloatArray, IntArray
from fem_reference.discrete_layer.assembly import Space, tabulate
from fem_reference.elastic.prescribed_radius import PrescribedContact


@dataclass(frozen=True)
class Section:
    """One equilibrium, seen inside the layer.

    Attributes:
        contact: the discrete answer at contact radius one.
        contact_radius: a [m].
        depth: delta / a.
        contact_modulus: E* [Pa].
    """

    contact: PrescribedContact
    contact_radius: float
    depth: float
    contact_modulus: float

    @cached_property
    def _space(self) -> Space:
        return Space(self.contact.layer_mesh.mesh, self.contact.pair)

    @cached_property
    def _unknowns(self) -> FloatArray:
        return np.asarray(self.contact.solutions @ [self.depth, 1.0])

    def displacement(self, radius: ArrayLike, depth: ArrayLike) -> FloatArray:
        """(u_r, u_z) [m] at points (r, z) [m], shape (n, 2).

        Raises:
            InvalidInput: a point lies outside the meshed section.
        """
        triangles, local = self._locate(radius, depth)
        return self._evaluate(triangles, local)[0]

    def stress(self, radius: ArrayLike, depth: ArrayLike) -> FloatArray:
        """(rr, zz, hoop, rz) [Pa] at points (r, z) [m], tension positive, shape (n, 4).

        Raises:
            InvalidInput: a point lies outside the meshed section.
        """
        triangles, local = self._locate(radius, depth)
        return self._evaluate(triangles, local)[1]

    def _locate(self, radius: ArrayLike, depth: ArrayLike) -> tuple[IntArray, FloatArray]:
        """Triangle of each point and its coordinates (2, n) in the reference triangle."""
        points = np.array(np.broadcast_arrays(np.atleast_1d(radius), np.atleast_1d(depth)), dtype=float)
        points /= self.contact_radius
        section = self.contact.layer_mesh
        outside = (points < 0).any(axis=0) | (points[0] > section.outer_radius) | (points[1] > section.thickness)
        if outside.any() or not np.all(np.isfinite(points)):
            r, z = points[:, ~np.isfinite(points).all(axis=0) | outside][:, 0] * self.contact_radius
            raise InvalidInput(f"(r, z) = ({r:g}, {z:g}) m lies outside the meshed section of the layer")
        triangles = nearest_triangles(section.mesh.p, section.mesh.t, points)
        corner = section.mesh.p[:, section.mesh.t[0, triangles]]
        local = np.linalg.solve(self._space.jacobians[triangles], (points - corner).T[:, :, None])[:, :, 0].T
        return triangles, local

    def _evaluate(self, triangles: IntArray, local: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Displacement (n, 2) [m] and stress (n, 4) [Pa] at reference coordinates (2, n) of given triangles."""
        space, moduli, mesh = self._space, self.contact.moduli, self.contact.layer_mesh.mesh
        nodal = self._unknowns[space.element_displacements[triangles]].reshape(len(triangles), -1, 2)
        basis = tabulate(self.contact.pair.displacement, local)
        inverse = np.linalg.inv(space.jacobians[triangles])
        gradient = np.einsum("nbi,kbn,nkj->nij", nodal, basis.gradient, inverse)
        displacement = np.einsum("nbi,bn->ni", nodal, basis.value)
        corners = mesh.p[0, mesh.t[:, triangles]]
        radius = corners[0] + (corners[1] - corners[0]) * local[0] + (corners[2] - corners[0]) * local[1]
        # On the axis the hoop strain is u_r,r.
        hoop = np.divide(displacement[:, 0], radius, out=gradient[:, 0, 0].copy(), where=radius > 0)
        volume = gradient[:, 0, 0] + gradient[:, 1, 1] + hoop
        if self.contact.pair.pressure is None:
            pressure = -moduli.bulk * volume
        else:
            values = tabulate(self.contact.pair.pressure, local).value
            pressure = np.einsum("nb,bn->n", self._unknowns[space.element_pressures[triangles]], values)
        shear = (gradient[:, 0, 1] + gradient[:, 1, 0]) / 2
        normal = np.stack([gradient[:, 0, 0], gradient[:, 1, 1], hoop], axis=1) - volume[:, None] / 3
        stress = np.column_stack([2 * moduli.shear * normal - pressure[:, None], 2 * moduli.shear * shear])
        return displacement * self.contact_radius, stress * self.contact_modulus

    def write(self, path: str | Path) -> None:
        """Write a .vtu or .xdmf file: quadratic triangles with displacement [m], stress and pressure [Pa].

        Every triangle has nodes of its own, so that jumps of the stress between triangles stay visible.

        Raises:
            InvalidInput: another file ending.
        """
        file = Path(path)
        if file.suffix not in (".vtu", ".xdmf"):
            raise InvalidInput(f"{file.name}: the ending must be .vtu or .xdmf")
        count = self.contact.layer_mesh.mesh.t.shape[1]
        triangles = np.repeat(np.arange(count), 6)
        local = np.tile([[0, 1, 0, 0.5, 0.5, 0], [0, 0, 1, 0, 0.5, 0.5]], count)
        displacement, stress = self._evaluate(triangles, local)
        mesh = self.contact.layer_mesh.mesh
        corner = mesh.p[:, mesh.t[0, triangles]]
        points = corner + np.einsum("nij,jn->in", self._space.jacobians[triangles], local)
        flat = np.zeros(len(triangles))
        exported = meshio.Mesh(
            np.column_stack([*(points * self.contact_radius), flat]),
            [("triangle6", np.arange(6 * count).reshape(-1, 6))],
            point_data={
                "displacement": np.column_stack([displacement, flat]),
                "stress_rr": stress[:, 0],
                "stress_zz": stress[:, 1],
                "stress_hoop": stress[:, 2],
                "stress_rz": stress[:, 3],
                "pressure": -stress[:, :3].mean(axis=1),
            },
        )
        exported.write(file, **({"data_format": "XML"} if file.suffix == ".xdmf" else {}))


def nearest_triangles(vertices: FloatArray, triangles: IntArray, points: FloatArray) -> IntArray:
    """A triangle that holds each point (2, n), to rounding: where the point's least barycentric coordinate is largest.

    The triangles with the nearest centres are tried first; a point that none of them holds is sought in all.
    """
    from scipy.spatial import cKDTree  # noqa: PLC0415 - only interior fields need it

    corners = vertices[:, triangles]
    tree = cKDTree(corners.mean(axis=1).T)
    found = np.empty(points.shape[1], dtype=np.int64)
    everything = np.arange(triangles.shape[1])
    for n, point in enumerate(points.T):
        near = np.atleast_1d(tree.query(point, min(12, len(everything)))[1])
        least = _least_barycentric(corners[:, :, near], point)
        if least.max() < -1e-10:
            near, least = everything, _least_barycentric(corners, point)
        found[n] = near[np.argmax(least)]
    return found


def _least_barycentric(corners: FloatArray, point: FloatArray) -> FloatArray:
    """Smallest barycentric coordinate of a point in triangles (2, 3, m)."""
    (ax, bx, cx), (ay, by, cy) = corners
    area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
    second = ((point[0] - ax) * (cy - ay) - (cx - ax) * (point[1] - ay)) / area
    third = ((bx - ax) * (point[1] - ay) - (point[0] - ax) * (by - ay)) / area
    return np.asarray(np.minimum(np.minimum(second, third), 1 - second - third))
