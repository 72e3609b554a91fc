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
        """Rounding, and the far field of an elastic base.

        A base that ends at a distance T takes up to ``0.6 F / (E* T)`` off the depth (`error_model`, for ``F = 2 E* a
        delta``).  The springs there are right for a point force on its surface.  The layers above and the size of the
        contact move that force by their share of T, and stiff layers restrain the surface of the base within
        their thickness times the ratio of moduli by up to a share ``(1 - 2 nu)^2 / (4 (1 - nu)^2)``.
        """
        if not self.body.base_modulus:
            return FIXED_RADIUS.rounding
        reach = float(self.body.thicknesses[-1])
        fixed = FIXED_RADIUS.half_space / 2 * self.answer.stiffness / (self.body.base_modulus * reach)
        return FIXED_RADIUS.rounding + 2 * fixed * (1 + self.body.layer_thickness + self.body.restrained_length) / reach
