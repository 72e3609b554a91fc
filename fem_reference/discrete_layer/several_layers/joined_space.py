"""Parts with nodes of their own, joined at their faces: bonded in both directions, sliding ones in the normal only.

The pressure of the mixed formulation jumps where the material does, and so each part has pressures of its own.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from contact.records.validation import FloatArray, IntArray
from fem_reference.discrete_layer.assembly import Space, node_positions


@dataclass(frozen=True)
class Face:
    """Where two parts meet.

    Attributes:
        above: facets of the upper part.
        below: facets of the lower part, at the same places.
        slips: whether only the normal displacement is shared.
    """

    above: IntArray
    below: IntArray
    slips: bool


@dataclass(frozen=True)
class JoinedSpace(Space):
    """Displacements on both sides of a face are one unknown, that of the part above.

    Attributes:
        faces: where the parts meet.
    """

    faces: tuple[Face, ...] = ()

    @cached_property
    def owner(self) -> IntArray:
        """For each displacement unknown the one that stands for it; itself but for those below a face."""
        owner = np.arange(self.displacement_count)
        positions = node_positions(self)
        for face in self.faces:
            above, below = (self._along(facets, positions) for facets in (face.above, face.below))
            owner[2 * below + 1] = 2 * above + 1
            if not face.slips:
                owner[2 * below] = 2 * above
        return owner

    def _along(self, facets: IntArray, positions: FloatArray) -> IntArray:
        """Scalar unknowns on facets, in the order of increasing r."""
        nodes = np.asarray(self.displacement_dofs.get_facet_dofs(facets).all(), dtype=np.int64)
        return nodes[np.argsort(positions[0, nodes])]

    @property
    def unused(self) -> IntArray:
        """Displacement unknowns that another one stands for."""
        return np.flatnonzero(self.owner != np.arange(len(self.owner)))

    @cached_property
    def element_displacements(self) -> IntArray:
        """Global displacement unknowns of each triangle, shape (triangle, 2 x basis)."""
        return np.asarray(self.owner[super().element_displacements])
