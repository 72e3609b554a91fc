"""One discrete solution inside the layer: continuous fields recovered at the nodes, and their values at any point.

Displacements are the solution's own. Stresses and the gradient of the pressure, which jump between triangles, are
averaged over the triangles that meet at a node; the pressure of a mixed pair is continuous as it is.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from contact.records.validation import FloatArray, IntArray
from fem_reference.discrete_layer.assembly import Space, node_positions, tabulate
from fem_reference.elastic.inside.places import Places
from fem_reference.elastic.prescribed_radius import PrescribedContact

NAMES = (
    "radial_displacement",
    "axial_displacement",
    "radial_stress",
    "hoop_stress",
    "axial_stress",
    "shear_stress",
    "hydrostatic_pressure",
    "pressure_gradient_radial",
    "pressure_gradient_axial",
)
# Fields that change sign across the axis.
ODD = [NAMES.index(name) for name in ("radial_displacement", "shear_stress", "pressure_gradient_radial")]


@dataclass(frozen=True)
class MeridianSection:
    """Fields of one solution at one depth, lengths by the contact radius and stresses by E*, in the order of `NAMES`.

    Attributes:
        contact: the discrete answer at contact radius one.
        depth: delta / a.
    """

    contact: PrescribedContact
    depth: float

    @cached_property
    def space(self) -> Space:
        """Unknowns and basis."""
        return self.contact.layer_mesh.space(self.contact.pair)

    @property
    def node_numbers(self) -> IntArray:
        """Nodes of each triangle, shape (triangle, basis)."""
        return np.asarray(self.space.displacement_dofs.element_dofs.T, dtype=np.int64)

    @property
    def local_nodes(self) -> FloatArray:
        """Their places in the reference triangle, shape (2, basis)."""
        return np.asarray(self.contact.pair.displacement.doflocs.T)

    @cached_property
    def nodal(self) -> FloatArray:
        """Values at the nodes, shape (node, 9)."""
        numbers, local = self.node_numbers, self.by_triangle
        total = np.zeros((int(self.space.displacement_dofs.N), local.shape[-1]))
        np.add.at(total, numbers, local)
        total /= np.bincount(numbers.ravel())[:, None]
        # On the axis half of the triangles that meet at a node are mirror images, in which these are opposite.
        on_axis = node_positions(self.space)[0] == 0.0
        total[np.ix_(on_axis, ODD)] = 0.0
        return total

    def units(self, modulus: float) -> FloatArray:
        """Units of the fields [m, Pa, Pa/m] for E* [Pa], shape (9,)."""
        a = self.contact.contact_radius
        return np.array([a, a, *[modulus] * 5, modulus / a, modulus / a])

    def at(self, places: Places) -> FloatArray:
        """Values at points, shape (n, 9)."""
        basis = tabulate(self.contact.pair.displacement, places.local).value
        return np.asarray(np.einsum("nbc,bn->nc", self.nodal[self.node_numbers[places.triangles]], basis))

    def at_local(self, local: FloatArray) -> FloatArray:
        """Values at the same local points (2, n) of every triangle, shape (triangle, n, 9)."""
        basis = tabulate(self.contact.pair.displacement, local).value
        return np.asarray(np.einsum("tbc,bn->tnc", self.nodal[self.node_numbers], basis, optimize=True))

    @cached_property
    def _unknowns(self) -> FloatArray:
        return np.asarray(self.contact.solutions @ [self.depth, 1.0])

    @cached_property
    def by_triangle(self) -> FloatArray:
        """Values of each triangle by itself at its nodes, shape (triangle, basis, 9)."""
        space, numbers = self.space, self.node_numbers
        depth = node_positions(space)[1, numbers]
        shear = self.contact.constants.at(np.arange(len(numbers)), depth).shear
        nodal = self._unknowns[space.element_displacements].reshape(len(self.node_numbers), -1, 2)
        inverse = np.asarray(np.linalg.inv(space.jacobians), dtype=np.float64)
        basis = tabulate(self.contact.pair.displacement, self.local_nodes)
        gradient = np.einsum("tbi,kbn,tkj->tnij", nodal, basis.gradient, inverse, optimize=True)
        radius = node_positions(space)[0, self.node_numbers]
        # On the axis the hoop strain is u_r,r.
        hoop = np.divide(nodal[..., 0], radius, out=gradient[..., 0, 0].copy(), where=radius > 0)
        volume = gradient[..., 0, 0] + gradient[..., 1, 1] + hoop
        pressure, slope = self._pressure(inverse)
        normal = np.stack([gradient[..., 0, 0], hoop, gradient[..., 1, 1]], axis=-1) - volume[..., None] / 3
        tangential = shear * (gradient[..., 0, 1] + gradient[..., 1, 0])
        stress = 2 * shear[..., None] * normal - pressure[..., None]
        return np.concatenate([nodal, stress, tangential[..., None], pressure[..., None], slope], axis=-1)

    def _pressure(self, inverse: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Hydrostatic pressure (triangle, basis) and its gradient (triangle, basis, 2) at the nodes."""
        own = tabulate(self.contact.pair.pressure, self.local_nodes)
        values = self._unknowns[self.space.element_pressures]
        return values @ own.value, np.einsum("tb,kbn,tkj->tnj", values, own.gradient, inverse, optimize=True)
