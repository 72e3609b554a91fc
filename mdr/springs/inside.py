"""The body under one contact: its density handed to the closed forms and wavenumber integrals of the inside."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TypeAlias

import numpy as np
from scipy.optimize import minimize

from bem.kernels.of_layer import stack_of
from bem.layer_equation.contact_density import ContactDensity
from bem.layer_equation.inside.density import Density, Piece
from bem.layer_equation.inside.fields import Body
from contact import ElasticLayer, FlatPunch, InvalidInput, PowerLaw
from contact.answer.inside import Extreme, InsideFields, Searched
from contact.records.validation import FloatArray
from mdr.springs.surface_fields import ContactFields

_Points: TypeAlias = Sequence[FloatArray]
_Range: TypeAlias = tuple[float, float]
_Value: TypeAlias = Callable[[InsideFields], FloatArray]

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
# Points of the first look in r and z, from which the best few are refined.
_SAMPLES = 40
_STARTS = 3


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

    @property
    def thickness(self) -> float:
        """Depth [m] to which fields exist."""
        return self.layer.thickness

    def at(self, radius: FloatArray, depth: FloatArray) -> InsideFields:
        """At points [m] of shape (n,)."""
        self._refuse_singular(radius, depth)
        unit = self.contact.unit
        found = self._body.at(radius / unit, np.minimum(depth, self.thickness) / unit)
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

    def largest(self, what: Searched) -> Extreme:
        """Of the whole body: the best of a grid over it, refined."""
        if what == "interface_shear":
            return self._largest_interface_shear()
        self._refuse_infinite_maximum()
        a = self.contact.contact_radius * self.contact.unit
        deepest = min(self.thickness, 4.0 * a)
        r, z = np.linspace(0.0, 1.5 * a, _SAMPLES), np.linspace(0.0, deepest, _SAMPLES)
        return self._refined(np.meshgrid(r, z), (0.0, 1.5 * a), (0.0, deepest), lambda f: f.von_mises)

    def _largest_interface_shear(self) -> Extreme:
        if self.layer.is_half_space:
            raise InvalidInput('largest("interface_shear"): a half-space has no interface')
        a = self.contact.contact_radius * self.contact.unit
        best = Extreme(0.0, self.thickness, 0.0)
        for depth in self._faces:
            r = np.linspace(0.0, 2.0 * a + 2.0 * self.thickness, 4 * _SAMPLES)
            found = self._refined((r, np.full_like(r, depth)), (0.0, float(r[-1])), (depth, depth), _shear)
            best = max(best, found, key=lambda extreme: extreme.value)
        return best

    @property
    def _faces(self) -> list[float]:
        kernel = stack_of(self.layer)
        return [float(z) * self.contact.unit for z in np.cumsum([sheet.thickness for sheet in kernel.sheets])]

    def _refined(self, points: _Points, radii: _Range, depths: _Range, value: _Value) -> Extreme:
        """The largest value near the best of some points."""
        r, z = (np.ravel(p) for p in points)
        values = value(self.at(r, z))
        best = Extreme(0.0, depths[0], 0.0)
        scale = np.array([radii[1], max(depths[1], 1e-300)])
        for start in np.argsort(values)[::-1][:_STARTS]:
            near = np.array([r[start], z[start]]) / scale
            found = minimize(  # type: ignore[call-overload]  # the stubs know no initial simplex
                lambda x: -float(value(self.at(x[:1] * scale[0], x[1:] * scale[1]))[0]),
                near,
                method="Nelder-Mead",
                bounds=[(0.0, 1.0), (depths[0] / scale[1], 1.0)],
                options={
                    "xatol": 1e-9,
                    "fatol": 1e-13 * values.max(),
                    "initial_simplex": _simplex(near, depths[0] / scale[1]),
                },
            )
            if -found.fun > best.value:
                best = Extreme(float(found.x[0] * scale[0]), float(found.x[1] * scale[1]), float(-found.fun))
        return best

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

    def _refuse_singular(self, radius: FloatArray, depth: FloatArray) -> None:
        rims = self._rims
        bad = (depth == 0.0) & np.isin(radius, rims)
        if np.any(bad):
            raise InvalidInput(
                f"radius = {radius[bad][0]:g} m, depth = 0: stresses are infinite at this sharp rim; ask beside it"
            )

    @property
    def _rims(self) -> list[float]:
        contact, indenter = self.contact, self.contact.indenter
        a = contact.contact_radius * contact.unit
        rims = [0.0] if float(indenter.slope_at(0.0)) > 0.0 else []
        rims += [k for k in indenter.kinks if k < a]
        return [*rims, a] if contact.edge_density else rims

    def _refuse_infinite_maximum(self) -> None:
        edge = self.contact.edge_density != 0.0
        if edge or (self._rims and self.layer.surface.poissons_ratio < 0.5):
            raise InvalidInput(
                f'largest("von_mises"): it is infinite at the rim r = {self._rims[-1]:g} m of the surface; ask for '
                "fields at points of interest"
            )


def _shear(found: InsideFields) -> FloatArray:
    return np.abs(found.shear_stress)


def _simplex(near: FloatArray, least: float) -> FloatArray:
    """A triangle of one sample's size that stays inside."""
    step, (r, z) = 1.0 / _SAMPLES, near
    across = r - step if r > 0.5 else r + step
    down = z - step if z - step > least else min(z + step, 1.0)
    return np.array([[r, z], [across, z], [r, down]])


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
