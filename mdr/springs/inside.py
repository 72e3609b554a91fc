"""The density of one contact's pressure, as the fields inside ask for it."""

from __future__ import annotations

from functools import partial

import numpy as np

from bem.layer_equation.contact_density import ContactDensity
from bem.layer_equation.inside.density import Density, Piece, pieces_of
from contact import FlatPunch, InvalidInput
from contact.records.validation import FloatArray
from mdr.springs.surface_fields import ContactFields


def density_of(contact: ContactFields) -> Density:
    """phi of a contact, lengths by its unit.

    Raises:
        InvalidInput: If tabulated flat punches stand for the layer.
    """
    if contact.table is not None:
        raise InvalidInput("flat-punch tables hold no density inside; use the integral equation")
    pieces = pieces_of(contact.indenter, contact.unit, contact.stretches)
    return Density(contact.contact_radius, contact.edge_density, pieces, partial(_slope, contact), 1.0)


def _slope(contact: ContactFields, piece: Piece, offset: FloatArray) -> FloatArray:
    """phi' = psi' - g_hs'."""
    flat = contact.indenter.flat_radius / contact.unit
    t = np.minimum(piece.start + offset, contact.contact_radius)
    slope = np.zeros_like(t)
    if isinstance(contact.density, ContactDensity):
        slope += t * contact.density.slope_over_position(t.ravel()).reshape(t.shape)
    if piece.start >= flat and not isinstance(contact.indenter, FlatPunch):
        slope -= contact.slope_at((piece.start - flat) + offset)
    return slope
