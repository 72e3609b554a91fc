r"""The adhered flat punch: ``u_r = 0`` and ``u_z = -delta`` on r <= a, one linear solve.

Near the edge stresses go like ``x^(-1/2 +- i eps)``, eps = ln(3 - 4 nu) / (2 pi), x = 1 - r/a.  The oscillation is not
resolved and need not be: energies err by a share of the cell at the edge, as without friction.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse.linalg import splu

from contact import Layer
from contact.records.validation import FloatArray, IntArray
from fem_reference.discrete_layer.problem import LayerProblem
from fem_reference.elastic.prescribed_radius import PrescribedContact
from fem_reference.elastic.surface_fields import FemFields


class AdheredProblem(LayerProblem):
    """A layer whose surface within radius one is held in the radial direction."""

    @cached_property
    def supported_unknowns(self) -> IntArray:
        """Displacements that the axis, the base and the indenter's grip hold at zero."""
        return np.union1d(super().supported_unknowns, 2 * self.top_nodes(1.0))


@dataclass(frozen=True)
class AdheredFields(FemFields):
    """Surface fields of an adhered punch: one solution, scaled by the depth.

    Attributes:
        layer: the layer.
    """

    layer: Layer

    @cached_property
    def _shear(self) -> FloatArray:
        return unit_shear(self.layer, self.states[0].contact)

    def tangential_traction(self, radius: FloatArray, step: int) -> FloatArray:
        """q(r) [Pa], positive where the layer is pushed outward, zero outside."""
        state = self.states[step]
        trace = state.contact.contact_trace
        return state.contact_modulus * state.depth * trace.evaluate(self._shear, radius / state.contact_radius)


def unit_shear(layer: Layer, contact: PrescribedContact) -> FloatArray:
    """q / E* of a punch of radius one at depth one, at the nodes of the contact; zero on the axis.

    Recovered from the radial reactions: ``int q v 2 pi r dr = reaction(v)`` for every v that vanishes on the axis.
    """
    problem = LayerProblem(contact.layer_mesh, contact.pair, layer.poissons_ratio, layer.support)
    reactions = problem.matrix[2 * problem.top_nodes(1.0)] @ contact.solutions[:, 0]
    shear = splu(contact.contact_trace.mass_matrix().tocsc()[1:, 1:]).solve(reactions[1:])
    return np.concatenate([[0.0], shear])
