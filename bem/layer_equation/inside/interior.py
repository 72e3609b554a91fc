"""Fields inside the body under one contact, in SI units, from the density of its pressure."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bem.kernels.moduli import contact_modulus
from bem.kernels.of_layer import stack_of
from bem.layer_equation.inside.density import Density
from bem.layer_equation.inside.fields import Body
from contact import ElasticLayer
from contact.answer.inside import InsideFields
from contact.records.validation import FloatArray

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
        density: Of the contact's pressure, lengths by `unit`.
        unit: Length unit [m].
        pressure_error: Relative error of the contact's pressure.
    """

    layer: ElasticLayer
    density: Density
    unit: float
    pressure_error: float

    def at(self, radius: FloatArray, depth: FloatArray) -> InsideFields:
        """At points [m] of shape (n,)."""
        unit = self.unit
        found = self._body.at(radius / unit, np.minimum(depth, self.layer.thickness) / unit)
        modulus = contact_modulus(self.layer)
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
        return Body(kernel, self.layer.surface.poissons_ratio, self.density)
