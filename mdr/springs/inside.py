"""The body under one contact: its density handed to the closed forms and wavenumber integrals of the inside."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from bem.kernels.of_layer import stack_of
from bem.layer_equation.contact_density import ContactDensity
from bem.layer_equation.inside.density import Density, Piece
from bem.layer_equation.inside.fields import Body
from contact import ElasticLayer, FlatPunch, InvalidInput, PowerLaw
from contact.answer.inside import InsideFields
from contact.records.validation import FloatArray
from mdr.springs.surface_fields import ContactFields

# Share of the distance to a pole of the profile's slope by which pieces shrink towards it.
_GRADING = 4.0
# Longest piece of the density over the thickness: longer ones left 2e-10 of the stress at a/h = 10, where panels that
# suit a depth span several thicknesses.
_LONGEST = 1.0
# What quadrature and rounding leave of stresses, over the largest: 2e-14 at worst, five times that is
# stated (540 points of 60 contacts, a/h 0.1 to 10, six kinds of profile, seed 2929, against rules of 36 nodes,
# 2026-11-22).
_QUADRATURE = 1e-13
# The error of the pressure counts so many times in the stresses, since s_1 - 2 G u_r/r combines three integrals of it;
# chosen.
_PRESSURE_SHARE = 3.0


@dataclass(frozen=True, eq=False)
class ContactInterior:
    """Fields inside the body under one contact.

    Attributes:
        layer: Layer, stack or half-space.
        contact: Density and profile of the contact.
        pressure_error: Relative error of the contact's pressure.
    """

    layer: ElasticLayer
    contact: ContactFields
    pressure_error: float

    def at(self, radius: FloatArray, depth: FloatArray) -> InsideFields:
        """At points [m] of shape (n,)."""
        unit = self.contact.unit
        found = self._body.at(radius / unit, np.minimum(depth, self.layer.thickness) / unit)
        modulus = self.contact.contact_modulus
        shear = found["modulus"] * self.layer.shear_modulus
        rr, tt = found["s1"] - found["hoop_strain"], found["s2"] + found["hoop_strain"]
        error = _PRESSURE_SHARE * self.pressure_error + _QUADRATURE
        names = ("displacement", "stress", "hydrostatic_pressure", "pressure_gradient")
        return InsideFields(
            radial_displacement=modulus * found["hoop_strain"] * radius / (2.0 * shear),
            axial_displacement=modulus * found["axial"] * unit / (2.0 * shear),
            radial_stress=modulus * rr,
            hoop_stress=modulus * tt,
            axial_stress=modulus * found["axial_stress"],
            shear_stress=modulus * found["shear_stress"],
            hydrostatic_pressure=modulus * found["hydrostatic_pressure"],
            pressure_gradient_radial=modulus * found["pressure_gradient_radial"] / unit,
            pressure_gradient_axial=modulus * found["pressure_gradient_axial"] / unit,
            error_estimate=dict.fromkeys(names, error),
        )

    @cached_property
    def _body(self) -> Body:
        kernel = None if self.layer.is_half_space else stack_of(self.layer)
        return Body(kernel, self.layer.surface.poissons_ratio, self._density)

    @cached_property
    def _density(self) -> Density:
        contact = self.contact
        if contact.table is not None:
            raise InvalidInput("flat-punch tables hold no density inside; use the integral equation")
        flat = contact.indenter.flat_radius / contact.unit
        pieces = _no_longer([Piece(0.0, flat, 1.0)] if flat else [])
        for stretch in contact.stretches:
            start, stop = flat + stretch.start, flat + stretch.stop
            power = 2.0 if start > 0.0 else 4.0 if isinstance(contact.indenter, PowerLaw) else 1.0
            ends = _graded(start, stop, stretch.room)
            pieces += _no_longer([Piece(one, two - one, power if one == start else 1.0) for one, two in pairwise(ends)])
        return Density(contact.contact_radius, contact.edge_density, tuple(pieces), self._slope, 1.0)

    def _slope(self, piece: Piece, offset: FloatArray) -> FloatArray:
        """phi' = psi' - g_hs'."""
        contact, flat = self.contact, self.contact.indenter.flat_radius / self.contact.unit
        t = np.minimum(piece.start + offset, contact.contact_radius)
        slope = np.zeros_like(t)
        if isinstance(contact.density, ContactDensity):
            slope += t * contact.density.slope_over_position(t.ravel()).reshape(t.shape)
        if piece.start >= flat and not isinstance(contact.indenter, FlatPunch):
            slope -= contact.slope_at((piece.start - flat) + offset)
        return slope


def _no_longer(pieces: list[Piece]) -> list[Piece]:
    """Pieces cut into parts on which psi, which varies over a thickness, is resolved."""
    parts = []
    for piece in pieces:
        count = max(1, math.ceil(piece.length / _LONGEST))
        width = piece.length / count
        parts += [Piece(piece.start + i * width, width, 1.0 if i else piece.power) for i in range(count)]
    return parts


def _graded(start: float, stop: float, room: float) -> list[float]:
    """Ends of pieces that shrink towards the pole of the slope, `room` beyond stop."""
    ends, distance = [stop], room
    while distance < 0.5 * (stop - start):
        ends.append(stop - distance)
        distance *= _GRADING
    return [start, *ends[::-1]]
