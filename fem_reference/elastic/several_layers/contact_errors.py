"""Error bars of contacts with stacks and graded layers: as on uniform layers, with another end of the mesh."""

from __future__ import annotations

from fem_reference.discrete_layer.several_layers.mesh import PartsMesh
from fem_reference.discrete_layer.several_layers.parts import LayerParts
from fem_reference.elastic.error_estimate import ContactWithErrors
from fem_reference.error_model import FIXED_RADIUS


class StackedContactWithErrors(ContactWithErrors):
    """The section ends far out, and an elastic base far down."""

    @property
    def body(self) -> LayerParts:
        """The parts of the mesh."""
        if not isinstance(self.layer_mesh, PartsMesh):
            raise TypeError("a stack needs a mesh with parts")
        return self.layer_mesh.body

    @property
    def is_nearly_incompressible(self) -> bool:
        """Whether errors fall slower on coarse meshes."""
        return self.body.is_nearly_incompressible

    @property
    def common_error(self) -> float:
        """Rounding, and the thick layer that stands for an elastic base.

        A layer of thickness T instead of a half-space leaves out a share of the depth that a punch of radius a loses
        as well: ``F / (2 E* a)`` is then smaller by up to 1.2 a / T (`error_model`), hence by 0.6 F / (E* T), and so is
        the depth of a stack under the force ``k_N delta``.
        """
        if not self.body.base_modulus:
            return FIXED_RADIUS.rounding
        compliance = FIXED_RADIUS.half_space / (2 * self.body.base_modulus * self.body.thicknesses[-1])
        return float(FIXED_RADIUS.rounding + 2 * compliance * self.answer.stiffness)
