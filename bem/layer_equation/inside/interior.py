"""Fields inside the body under one contact, in SI units, from the density of its pressure."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bem.kernels.graded import GradedKernel
from bem.kernels.moduli import contact_modulus
from bem.kernels.of_layer import stack_of
from bem.layer_equation.inside.density import Density
from bem.layer_equation.inside.errors import LEFT_OUT, Magnitudes, stated_errors
from bem.layer_equation.inside.fields import Body
from bem.layer_equation.inside.half_space_part import Points
from contact import GradedLayer, Scene
from contact.answer.inside import InsideFields, KnownContact
from contact.records.validation import FloatArray

# Relative distance within which an end of a piece is a rounded rim: the rim was divided by the unit, subtracted from
# another one and multiplied again, which is four roundings.
_ROUNDED = 4.0 * float(np.finfo(float).eps)
_SLOPES = ("pressure_gradient_radial", "pressure_gradient_axial")


@dataclass(frozen=True, eq=False)
class ContactInterior:
    """Fields inside the body under one contact.

    Attributes:
        scene: What was solved.
        density: Of the contact's pressure, lengths by `unit`.
        unit: Length unit [m].
        depth: delta by `unit`.
        known: Of the contact.
    """

    scene: Scene
    density: Density
    unit: float
    depth: float
    known: KnownContact

    def at(self, radius: FloatArray, depth: FloatArray) -> InsideFields:
        """At points [m] of shape (n,)."""
        layer, unit = self.scene.layer, self.unit
        modulus = contact_modulus(layer)
        points = Points(radius / unit, np.minimum(depth, layer.thickness) / unit, self.distances(radius))
        found = self._body.at(points)
        shear = found["modulus"] * layer.shear_modulus
        stresses, slopes = _stresses(found), {name: found[name] for name in _SLOPES}
        edge = self._body.of_unit_edge(points)
        yields = modulus / (2.0 * layer.shear_modulus)
        sizes = Magnitudes(
            displacement=yields * _displacement(found, points.r) / found["modulus"],
            stress=_largest(stresses),
            gradient=_largest(slopes),
            gradient_terms=found["gradient_terms"],
            edge_displacement=yields * _displacement(edge, points.r),
            edge_stress=_largest(_stresses(edge)),
            edge_gradient=_largest({name: edge[name] for name in _SLOPES}),
            length=min(self.density.radius, layer.thickness / unit),
            thickness=layer.thickness / unit,
            depth=self.depth,
            **{name: found[name] for name in LEFT_OUT if name in found},
        )
        return InsideFields(
            radial_displacement=modulus * found["hoop_strain"] * radius / (2.0 * shear),
            axial_displacement=modulus * found["axial"] * unit / (2.0 * shear),
            **{name: modulus * values for name, values in stresses.items()},
            hydrostatic_pressure=modulus * found["hydrostatic_pressure"],
            **{name: modulus * values / unit for name, values in slopes.items()},
            error_estimate=stated_errors(self.density, points, sizes, self.known, unit),
        )

    @cached_property
    def _body(self) -> Body:
        layer, nu = self.scene.layer, self.scene.layer.surface.poissons_ratio
        if isinstance(layer, GradedLayer):
            # Only graded layers pay for this import.
            from bem.layer_equation.inside.graded_part import GradedBody  # noqa: PLC0415

            return GradedBody(None, nu, self.density, surface=GradedKernel(layer.in_own_units()))
        return Body(None if layer.is_half_space else stack_of(layer), nu, self.density)

    def distances(self, radius: FloatArray) -> FloatArray:
        """Ends of the density's pieces minus radii [m], by the unit, shape (pieces + 1, n).

        Beside a rim a difference of two radii in metres is exact; of two rounded ratios it is not.
        """
        rims, beyond = self._ends
        return np.asarray((rims[:, None] - radius) / self.unit + beyond[:, None])

    @cached_property
    def _ends(self) -> tuple[FloatArray, FloatArray]:
        """Where pieces of the density end: the nearest rim as it was given [m], and the way from there by the unit."""
        indenter, a = self.scene.indenter, self.density.radius
        given = np.array([indenter.flat_radius, *indenter.breakpoints, self.known.radius])
        ratios = np.append(given[:-1] / self.unit, a)
        ends = np.array([*(piece.start for piece in self.density.pieces), a])
        nearest = np.argmin(np.abs(np.subtract.outer(ends, ratios)), axis=1)
        beyond = ends - ratios[nearest]
        return given[nearest], np.where(np.abs(beyond) <= _ROUNDED * ends, 0.0, beyond)


def _displacement(found: Mapping[str, FloatArray], r: FloatArray) -> FloatArray:
    return np.maximum(np.abs(found["hoop_strain"]) * r, np.abs(found["axial"]))


def _stresses(found: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
    return {
        "radial_stress": found["s1"] - found["hoop_strain"],
        "hoop_stress": found["s2"] + found["hoop_strain"],
        "axial_stress": found["axial_stress"],
        "shear_stress": found["shear_stress"],
    }


def _largest(parts: Mapping[str, FloatArray]) -> FloatArray:
    """Largest magnitude of several fields at each point."""
    return np.asarray(np.abs([*parts.values()]).max(axis=0))
