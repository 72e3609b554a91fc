"""Fields inside the layer in one equilibrium, with an error from what the last degree of the elements changed."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contact import InvalidInput
from contact.answer.inside import InsideFields
from contact.records.validation import FloatArray
from fem_reference.discrete_layer.assembly import node_positions
from fem_reference.elastic.inside.places import places_of
from fem_reference.elastic.inside.section import NAMES, MeridianSection
from fem_reference.error_model import INSIDE

# Which errors are stated together, as columns of the fields.
_GROUPS = {
    "displacement": slice(0, 2),
    "stress": slice(2, 6),
    "hydrostatic_pressure": slice(6, 7),
    "pressure_gradient": slice(7, 9),
}


@dataclass(frozen=True, eq=False)
class FemInterior:
    """One equilibrium, seen inside the layer.

    Attributes:
        section: the solution that answers.
        other: that of the neighbouring degree on the same mesh.
        contact_radius: a [m].
        contact_modulus: E* [Pa].
        own_error: relative error of the state's depth, force, radius and stiffness, the largest of them.
        depth_error: relative error of the depth, with which all that the indenter touches moves.
        unshown_error: the part of the depth's relative error that a higher degree does not show.
        missed: share of the radius by which the mesh's contact misses that of the state.
    """

    section: MeridianSection
    other: MeridianSection
    contact_radius: float
    contact_modulus: float
    own_error: float
    depth_error: float
    unshown_error: float
    missed: float

    def at(self, radius: FloatArray, depth: FloatArray) -> InsideFields:
        """At points [m] of shape (n,).

        Raises:
            InvalidInput: a point lies beyond the mesh.
        """
        points = self._within_mesh(np.array([radius, depth]) / self.contact_radius)
        mesh = self.section.contact.layer_mesh.mesh
        places = places_of(mesh.p, mesh.t, points)
        values = self.section.at(places)
        error = self._error_of_triangles[places.triangles]
        error[:, 2:7] += np.sqrt(2.0) * self._edge_pressure * self._share_at_edge(points)[:, None]
        error[:, _GROUPS["pressure_gradient"]] += self._gradient_at_edge(points)[:, None]
        error += self._from_the_end(points[0])
        error[self._ends_at_edge[places.triangles]] += self._singular(points)[self._ends_at_edge[places.triangles]]
        return InsideFields(
            **dict(zip(NAMES, (values * self._units).T, strict=True)), error_estimate=self._stated(values, error)
        )

    def _within_mesh(self, points: FloatArray) -> FloatArray:
        """Points (2, n) of the mesh; rounding does not take them out of it."""
        mesh = self.section.contact.layer_mesh
        r, z = points
        rounded = np.where(z <= mesh.thickness * (1 + 1e-14), np.minimum(z, mesh.thickness), z)
        beyond = (r > mesh.outer_radius) | (rounded > mesh.thickness)
        if beyond.any():
            first = points[:, beyond][:, 0] * self.contact_radius
            raise InvalidInput(
                f"(r, z) = ({first[0]:g}, {first[1]:g}) m lies beyond the mesh of finite elements, which ends at r = "
                f"{mesh.outer_radius * self.contact_radius:g} m; ask nearer, or mdr"
            )
        return np.array([r, rounded])

    def _share_at_edge(self, points: FloatArray) -> FloatArray:
        """Of the stress: what a contact wider by a share e of its radius changes beside it in second order, of a root.

        sqrt(2 rho) changes by less than e^2/rho^(3/2) at a distance rho from the edge, and by less than sqrt(e) there.
        """
        away = np.hypot(points[0] - 1.0, points[1]) + self.missed
        return np.asarray(np.sqrt(self.missed) * (self.missed / np.maximum(away, np.finfo(float).tiny)) ** 1.5)

    def _gradient_at_edge(self, points: FloatArray) -> FloatArray:
        """What the same contact changes in the gradient: its share over the distance, but no more than all of it.

        The gradient of sqrt(2 rho) is 1/sqrt(2 rho).
        """
        away = np.maximum(np.hypot(points[0] - 1.0, points[1]), np.finfo(float).tiny)
        change = np.minimum(np.sqrt(2.0) * self._share_at_edge(points) / away, 1.0 / np.sqrt(2.0 * away))
        return np.asarray(self._edge_pressure * (change if self.missed else np.zeros_like(away)))

    def _singular(self, points: FloatArray) -> FloatArray:
        """Fields that no polynomial follows up to the edge, shape (n, 9): of a pressure A/sqrt(2 rho), or zero.

        A = phi (delta - delta_0) / pi, of which a radius that is missed explains a part that is stated elsewhere.
        Stresses are as large as that pressure, and the surface moves by 2 A sqrt(2 rho) over 1 - nu.
        """
        contact = self.section.contact
        explained = self.missed * abs(contact.smooth_depth_slope)
        pulled = max(abs(self.section.depth - contact.smooth_depth) - explained, 0.0)
        amplitude = np.sqrt(contact.stiffness_slope / 2.0) * pulled / np.pi
        root = np.sqrt(2.0 * np.maximum(np.hypot(points[0] - 1.0, points[1]), np.finfo(float).eps))[:, None]
        return np.asarray(amplitude * np.hstack([*[4.0 * root] * 2, *[1.0 / root] * 5, *[root**-3.0] * 2]))

    @cached_property
    def _ends_at_edge(self) -> NDArray[np.bool_]:
        """Whether a triangle has the contact's edge as a corner."""
        mesh = self.section.contact.layer_mesh.mesh
        return np.asarray((np.hypot(mesh.p[0] - 1.0, mesh.p[1])[mesh.t] < 1e-12).any(axis=0))

    @property
    def _edge_pressure(self) -> float:
        """Over E*, the pressure beside the edge of smooth contact over sqrt(2 rho): phi delta_0' / pi, phi^2 = k_N'/2.

        It grows by the edge value phi of the flat punch for every unit that smooth depth grows.
        """
        contact = self.section.contact
        return float(np.sqrt(contact.stiffness_slope / 2.0) * abs(contact.smooth_depth_slope) / np.pi)

    def _from_the_end(self, radius: FloatArray) -> FloatArray:
        """What the mesh's outer edge throws back, shape (n, 9): the fields there, decaying inwards like all ends do.

        A layer that slides on its base moves there as a whole, which the spring on that edge carries exactly.
        """
        contact = self.section.contact
        rate, end = contact.decay / 2, contact.layer_mesh.outer_radius
        r, z = node_positions(self.section.space)
        nodal, beside = self.section.nodal, r >= end - 0.5 / rate
        whole = np.zeros(len(NAMES))
        whole[0] = nodal[beside & (z == z.max()), 0].mean()
        thrown = np.abs(nodal[beside] - whole).max(axis=0)
        return np.asarray(np.exp(-rate * (end - radius))[:, None] * thrown)

    def _stated(self, values: FloatArray, error: FloatArray) -> dict[str, float]:
        """Largest error of each group over its scale: the depth, the largest stress and gradient.

        The latter two scales are known to that error, too.
        """
        mesh, depth = self.section.contact.layer_mesh, abs(self.section.depth)
        stress = np.abs(values[:, 2:7]).max(initial=np.finfo(float).tiny)
        steepest = max(np.abs(values[:, 7:]).max(initial=0.0), stress / min(1.0, mesh.thickness))
        scales = (max(depth, np.finfo(float).tiny), stress, stress, steepest)
        shares = {
            name: float(error[:, group].max(initial=0.0)) / scale
            for (name, group), scale in zip(_GROUPS.items(), scales, strict=True)
        }
        moved = max(shares.pop("displacement") + self.unshown_error, self.depth_error)
        return {"displacement": moved} | {
            name: share / (1.0 - min(share, 0.5)) + self.own_error for name, share in shares.items()
        }

    @property
    def _units(self) -> FloatArray:
        a, modulus = self.contact_radius, self.contact_modulus
        return np.array([a, a, *[modulus] * 5, modulus / a, modulus / a])

    @cached_property
    def _error_of_triangles(self) -> FloatArray:
        """Error of each field in each triangle, shape (triangle, 9)."""
        nodes, gradient = self.section.local_nodes, _GROUPS["pressure_gradient"]
        averaged = self.section.at_local(nodes)
        change = np.abs(averaged - self.other.at_local(nodes)).max(axis=1)
        change[:, gradient] *= INSIDE.gradient
        mesh = self.section.contact.layer_mesh.mesh
        on_axis = (mesh.p[0, mesh.t] == 0.0).any(axis=0)
        change[np.ix_(on_axis, range(2, 9))] *= INSIDE.on_axis
        error = np.asarray(INSIDE.share_of_change[self.section.contact.pair.degree] * change)
        # Averages on the axis are those of one side, and at its ends of two triangles: they smooth little.
        jump = np.abs(averaged - self.section.by_triangle)[on_axis, :, gradient].max(axis=1)
        error[on_axis, gradient] = np.maximum(error[on_axis, gradient], INSIDE.jump_on_axis * jump)
        return error

    def write(self, path: str | Path) -> None:
        """Write a .vtu or .xdmf file for ParaView, see `export.write_section`."""
        from fem_reference.elastic.inside.export import write_section  # noqa: PLC0415 - meshio where a file is written

        write_section(self.section, self._units, Path(path))
