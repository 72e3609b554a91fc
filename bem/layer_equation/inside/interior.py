"""Fields inside the body under one contact, in SI units, from the density of its pressure."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bem.kernels.moduli import contact_modulus
from bem.kernels.of_layer import stack_of
from bem.layer_equation.inside.density import Density
from bem.layer_equation.inside.errors import Magnitudes, stated_errors
from bem.layer_equation.inside.fields import Body
from contact import ElasticLayer
from contact.answer.inside import InsideFields
from contact.records.validation import FloatArray


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
        unit, modulus = self.unit, contact_modulus(self.layer)
        points = np.array([radius, np.minimum(depth, self.layer.thickness)]) / unit
        found = self._body.at(*points)
        shear = found["modulus"] * self.layer.shear_modulus
        stresses = {
            "radial_stress": found["s1"] - found["hoop_strain"],
            "hoop_stress": found["s2"] + found["hoop_strain"],
            "axial_stress": found["axial_stress"],
            "shear_stress": found["shear_stress"],
        }
        slopes = {name: found[name] for name in ("pressure_gradient_radial", "pressure_gradient_axial")}
        length = min(self.density.radius, self.layer.thickness / unit)
        sizes = Magnitudes(_largest(stresses), _largest(slopes), length)
        return InsideFields(
            radial_displacement=modulus * found["hoop_strain"] * radius / (2.0 * shear),
            axial_displacement=modulus * found["axial"] * unit / (2.0 * shear),
            **{name: modulus * values for name, values in stresses.items()},
            hydrostatic_pressure=modulus * found["hydrostatic_pressure"],
            **{name: modulus * values / unit for name, values in slopes.items()},
            error_estimate=stated_errors(self.density, points, sizes, self.pressure_error),
        )

    @cached_property
    def _body(self) -> Body:
        kernel = None if self.layer.is_half_space else stack_of(self.layer)
        return Body(kernel, self.layer.surface.poissons_ratio, self.density)


def _largest(parts: Mapping[str, FloatArray]) -> FloatArray:
    """Largest magnitude of several fields at each point."""
    return np.asarray(np.abs([*parts.values()]).max(axis=0))
