"""The adhered flat punch: ``u_r = 0`` and ``u_z = -delta`` on r <= a, one linear solve.

Near the edge stresses go like ``x^(-1/2 +- i eps)``, eps = ln(3 - 4 nu) / (2 pi), x = 1 - r/a.  The oscillation is not
resolved and need not be: energies err by a share of the cell at the edge, as without friction.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy.linalg import solveh_banded

from contact import ContactPath, Layer
from contact.records.validation import FloatArray, IntArray
from contact.stated import SAFETY
from fem_reference.discrete_layer.problem import LayerProblem
from fem_reference.elastic.path import FemEquilibrium
from fem_reference.elastic.prescribed_radius import PrescribedContact
from fem_reference.elastic.surface_fields import FemFields


class AdheredProblem(LayerProblem):
    """A layer whose surface within radius one is held in the radial direction, too."""

    @cached_property
    def supported_unknowns(self) -> IntArray:
        """Displacements that the axis, the base and the indenter's grip hold at zero."""
        return np.union1d(super().supported_unknowns, 2 * self.top_nodes(1.0))


@dataclass(frozen=True)
class AdheredFemFields(FemFields):
    """Surface fields of an adhered punch: one solution, scaled by the depth.

    Attributes:
        layer: the layer.
    """

    layer: Layer = field(kw_only=True)

    @cached_property
    def _shear(self) -> FloatArray:
        return unit_shear(self.layer, self.states[0].contact)

    def tangential_traction(self, radius: FloatArray, step: int) -> FloatArray:
        """q(r) [Pa], positive where the layer is pushed outward, zero outside."""
        state = self.states[step]
        trace = state.contact.contact_trace
        return self.modulus * state.depth * trace.evaluate(self._shear, radius / state.contact_radius)


def unit_shear(layer: Layer, contact: PrescribedContact) -> FloatArray:
    """q / E* of a punch of radius one at depth one, at the nodes of the contact; zero on the axis.

    Recovered from the radial reactions: ``int q v 2 pi r dr = reaction(v)`` for every v that vanishes on the axis.
    """
    problem = LayerProblem(contact.layer_mesh, contact.pair, layer.poissons_ratio, layer.support)
    reactions = problem.matrix[2 * problem.top_nodes(1.0)] @ contact.solutions[:, 0]
    shear = solveh_banded(contact.contact_trace.mass_bands()[:, 1:], reactions[1:], lower=True, check_finite=False)
    return np.concatenate([[0.0], shear])


def with_shear_error(path: ContactPath, layer: Layer, state: FemEquilibrium, other: FemEquilibrium) -> ContactPath:
    """The path with the error of q over the size of p: L2 with the weight ``2 pi r (1 - r^2 / a^2)``, as that of p is.

    The size of q itself would not do: on an incompressible half-space q vanishes.
    """
    contact = state.contact
    radius, weight = (values.ravel() for values in contact.contact_trace.gauss(contact.pair.degree + 2))
    weight = weight * (1 - radius**2)
    fine, coarse = (
        each.contact.contact_trace.evaluate(unit_shear(layer, each.contact), radius) for each in (state, other)
    )
    change = np.sqrt(weight @ (fine - coarse) ** 2 / (weight @ contact.pressure(radius, 1.0) ** 2))
    error = np.full(len(path), SAFETY * float(change))
    return replace(path, error_estimate={**path.error_estimate, "tangential_traction": error})
