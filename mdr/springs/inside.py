"""The density of one contact's pressure, as the fields inside ask for it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from bem.layer_equation.any_layer.graded_density import GradedDensity
from bem.layer_equation.contact_density import ContactDensity
from bem.layer_equation.inside.density import Density, Piece, cut_at, pieces_of
from bem.layer_equation.inside.smooth_slope import smooth_slope
from contact import ElasticLayer, FlatPunch, InvalidInput
from contact.records.validation import FloatArray
from mdr.springs.surface_fields import ContactFields


def density_of(contact: ContactFields, layer: ElasticLayer) -> Density:
    """phi of a contact, lengths by its unit.

    Raises:
        InvalidInput: If tabulated flat punches stand for the layer.
    """
    if contact.table is not None:
        raise InvalidInput("flat-punch tables hold no density inside; use the integral equation")
    pieces, flat = pieces_of(contact.indenter, contact.unit, contact.stretches), contact.indenter.flat_radius
    smooth: Callable[[FloatArray], FloatArray] | None = None
    if isinstance(contact.density, ContactDensity):
        over_position = smooth_slope(layer, contact.density)
        smooth = lambda t: t * over_position(t)  # noqa: E731
    elif isinstance(contact.density, GradedDensity):
        smooth = contact.density.slopes.slope
        pieces = cut_at(pieces, contact.contact_radius * contact.density.panels.ends)

    def slope(piece: Piece, offset: FloatArray) -> FloatArray:
        """phi' = psi' - g_hs'."""
        t = np.minimum(piece.start + offset, contact.contact_radius)
        total = np.zeros_like(t) if smooth is None else smooth(t)
        if piece.start >= flat / contact.unit and not isinstance(contact.indenter, FlatPunch):
            before = piece.start - flat / contact.unit
            # Two small distances from the edge: beside a sphere's equator one small difference would lose its digits.
            total -= contact.slope_at(before + offset, (contact.excess - before) - offset)
        return np.asarray(total)

    return Density(contact.contact_radius, contact.edge_density, pieces, slope, 1.0)
