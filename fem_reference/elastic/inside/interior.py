"""Fields inside the layer in one equilibrium, with an error from what coarser cells change."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from contact import InvalidInput
from contact.answer.inside import InsideFields
from contact.records.validation import FloatArray, IntArray
from contact.stated import SAFETY
from fem_reference.elastic.inside.places import Places, places_of
from fem_reference.elastic.inside.section import NAMES, MeridianSection

# Which errors are stated together, as columns of the fields.
_GROUPS = {
    "displacement": slice(0, 2),
    "stress": slice(2, 6),
    "hydrostatic_pressure": slice(6, 7),
    "pressure_gradient": slice(7, 9),
}
# Where in a triangle two meshes are compared: its nodes, moved towards its centre by this share, off the faces where
# fields jump. Not measured: half and twice.
_INWARD = 0.1


@dataclass(frozen=True, eq=False)
class FemInterior:
    """One equilibrium, seen inside the layer.

    Attributes:
        section: the solution that answers.
        coarser: that of the companion.
        modulus: E* [Pa].
    """

    section: MeridianSection
    coarser: MeridianSection
    modulus: float

    def at(self, radius: FloatArray, depth: FloatArray) -> InsideFields:
        """At points [m] of shape (n,).

        Raises:
            InvalidInput: a point lies beyond the mesh.
        """
        contact = self.section.contact
        places = self._places(self.section, self._within_mesh(np.array([radius, depth]) / contact.contact_radius))
        values = self.section.at(places) * self.section.units(self.modulus)
        return InsideFields(
            **dict(zip(NAMES, values.T, strict=True)),
            error_estimate=self._stated(values, SAFETY * self._changes(places.triangles)),
        )

    def _within_mesh(self, points: FloatArray) -> FloatArray:
        """Points (2, n) of the mesh; rounding does not take them out of it."""
        mesh, scale = self.section.contact.layer_mesh, self.section.contact.contact_radius
        r, z = points
        rounded = np.where(z <= mesh.thickness * (1 + 1e-14), np.minimum(z, mesh.thickness), z)
        beyond = (r > mesh.outer_radius) | (rounded > mesh.thickness)
        if beyond.any():
            first = points[:, beyond][:, 0] * scale
            raise InvalidInput(
                f"(r, z) = ({first[0]:g}, {first[1]:g}) m lies beyond the mesh of finite elements, which ends at r = "
                f"{mesh.outer_radius * scale:g} m; ask nearer, or mdr"
            )
        return np.array([r, rounded])

    @staticmethod
    def _places(section: MeridianSection, points: FloatArray) -> Places:
        mesh = section.contact.layer_mesh.mesh
        return places_of(mesh.p, mesh.t, points)

    def _changes(self, triangles: IntArray) -> FloatArray:
        """Largest change of each field [SI] in the triangles of n points by the coarser cells, shape (n, 9)."""
        chosen, back = np.unique(triangles, return_inverse=True)
        local = self.section.local_nodes
        local = local + _INWARD * (1 / 3 - local)
        here = Places(np.repeat(chosen, local.shape[1]), np.tile(local, len(chosen)))
        corners = self.section.contact.layer_mesh.mesh.p[:, self.section.contact.layer_mesh.mesh.t[:, here.triangles]]
        points = np.einsum("cvn,vn->cn", corners, np.array([1 - here.local.sum(axis=0), *here.local]))
        mesh = self.coarser.contact.layer_mesh
        points *= self.section.contact.contact_radius / self.coarser.contact.contact_radius
        ends = np.array([[mesh.outer_radius], [mesh.thickness]])
        there = self._places(self.coarser, np.minimum(points, ends))
        fine, coarse = self.section.at(here), self.coarser.at(there)
        change = np.abs(fine * self.section.units(self.modulus) - coarse * self.coarser.units(self.modulus))
        return np.asarray(change.reshape(len(chosen), -1, len(NAMES)).max(axis=1)[back])

    def _stated(self, values: FloatArray, error: FloatArray) -> dict[str, float]:
        """Largest error of each group over its scale: the depth, the largest stress and gradient."""
        contact, tiny = self.section.contact, np.finfo(float).tiny
        depth = max(abs(self.section.depth) * contact.contact_radius, tiny)
        stress = np.abs(values[:, 2:7]).max(initial=tiny)
        length = contact.contact_radius * min(1.0, contact.layer_mesh.thickness)
        scales = (depth, stress, stress, max(np.abs(values[:, 7:]).max(initial=0.0), stress / length))
        return {
            name: float(error[:, group].max(initial=0.0)) / scale
            for (name, group), scale in zip(_GROUPS.items(), scales, strict=True)
        }

    def write(self, path: str | Path) -> None:
        """Write a .vtu or .xdmf file for ParaView, see `export.write_section`."""
        from fem_reference.elastic.inside.export import write_section  # noqa: PLC0415 - meshio where a file is written

        write_section(self.section, self.section.units(self.modulus), Path(path))
