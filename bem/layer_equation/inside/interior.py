"""Fields inside the body under one contact, in SI units, from the density of its pressure."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bem.kernels.graded import GradedKernel
from bem.kernels.moduli import contact_modulus
from bem.kernels.of_layer import stack_kernel
from bem.layer_equation.inside.density import Density
from bem.layer_equation.inside.errors import LEFT_OUT, Magnitudes, left_by, stated_errors
from bem.layer_equation.inside.fields import Body
from bem.layer_equation.inside.half_space_part import Points
from contact import FlatPunch, GradedLayer, InvalidInput, PowerLaw, Scene
from contact.answer.inside import InsideFields, KnownContact
from contact.records.validation import FloatArray

# Relative distance within which an end of a piece is a rounded rim: the rim was divided by the unit, subtracted from
# another one and multiplied again, which is four roundings.
_ROUNDED = 4.0 * float(np.finfo(float).eps)
# Contact radii from the contact of which stresses on a half-space, which fall like 1/r^2, are below all roundings; and
# contact radii and thicknesses by which those on a layer, which fall exponentially, have vanished long ago, and which
# take 0.05 s a point, in proportion to the distance; chosen.
_REACH, _REACH_OF_WAVES = 1e8, 1e3
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
        """At points [m] of shape (n,).

        Raises:
            InvalidInput: A point so far away that nothing is left to be resolved.
        """
        layer, unit = self.scene.layer, self.unit
        self._refuse_distant(radius, depth)
        modulus = contact_modulus(layer)
        points = Points(radius / unit, np.minimum(depth, layer.thickness) / unit, self.distances(radius))
        found = self._body.at(points)
        shear = found["modulus"] * layer.shear_modulus
        stresses, slopes = _stresses(found), {name: found[name] for name in _SLOPES}
        return InsideFields(
            radial_displacement=modulus * found["hoop_strain"] * radius / (2.0 * shear),
            axial_displacement=modulus * found["axial"] * unit / (2.0 * shear),
            **{name: modulus * values for name, values in stresses.items()},
            hydrostatic_pressure=modulus * found["hydrostatic_pressure"],
            **{name: modulus * values / unit for name, values in slopes.items()},
            error_estimate=stated_errors(self.density, points, self._sizes(points, found), self.known, unit),
        )

    def _refuse_distant(self, radius: FloatArray, depth: FloatArray) -> None:
        layer, a = self.scene.layer, self.known.radius
        farthest = _REACH * a if layer.is_half_space else _REACH_OF_WAVES * (a + layer.thickness)
        distant = np.flatnonzero(np.maximum(radius, depth) > farthest)
        if distant.size:
            r, z = radius[distant[0]], depth[distant[0]]
            raise InvalidInput(
                f"(r, z) = ({r:g}, {z:g}) m: nothing is left to resolve beyond {farthest:g} m; ask nearer"
            )

    def _sizes(self, points: Points, found: Mapping[str, FloatArray]) -> Magnitudes:
        layer, unit = self.scene.layer, self.unit
        thickness = layer.thickness / unit
        edge = self._body.of_unit_edge(points)
        # A flat punch is one part alone.
        alone = isinstance(self.scene.indenter, FlatPunch)
        pulls = (0.0 if alone else self.density.edge_value) * left_by(thickness, points)
        stresses, slopes, moved = _of_kinds(points.r, found)
        of_edge = _of_kinds(points.r, edge)
        # Displacements are multiplied by 2 G of the surface material.
        yields = contact_modulus(layer) / (2.0 * layer.shear_modulus)
        return Magnitudes(
            stress=_of_both(stresses, pulls, of_edge[0]),
            yields=yields / found["modulus"],
            gradient=_of_both(slopes, pulls, of_edge[1]),
            displacement=yields * _of_both(moved, pulls, of_edge[2]),
            largest_stress=float(_largest(stresses).max(initial=0.0)),
            largest_gradient=float(_largest(slopes).max(initial=0.0)),
            gradient_terms=found["gradient_terms"],
            displacement_terms=yields * found["displacement_terms"] / found["modulus"],
            edge_stress=_largest(of_edge[0]),
            edge_gradient=_largest(of_edge[1]),
            edge_displacement=yields * _largest(of_edge[2]),
            length=min(self.density.radius, thickness),
            tip_order=self._tip_order,
            tilt=self._tilt,
            thickness=thickness,
            depth=self.depth,
            **{name: found[name] for name in LEFT_OUT if name in found},
        )

    @property
    def _tilt(self) -> float:
        indenter = self.scene.indenter
        return float(indenter.slope_at(np.nextafter(min(self.known.radius, indenter.max_radius), 0.0)))

    @property
    def rims(self) -> FloatArray:
        """Radii [m] of the edge, the kinks within it, and a tip that is no parabola."""
        kinks = (kink for kink in self.scene.indenter.kinks if kink < self.known.radius)
        tips = [] if self._tip_order == 2.0 else [0.0]
        return np.array([self.known.radius, *kinks, *tips])

    @property
    def _tip_order(self) -> float:
        indenter = self.scene.indenter
        if isinstance(indenter, PowerLaw):
            return indenter.exponent
        return 1.0 if float(indenter.slope_at(0.0)) > 0.0 else 2.0

    @cached_property
    def _body(self) -> Body:
        layer, nu = self.scene.layer, self.scene.layer.surface.poissons_ratio
        if isinstance(layer, GradedLayer):
            # Only graded layers pay for this import.
            from bem.layer_equation.inside.graded_part import GradedBody  # noqa: PLC0415

            return GradedBody(None, nu, self.density, surface=GradedKernel(layer.in_own_units()))
        return Body(None if layer.is_half_space else stack_kernel(layer), nu, self.density)

    def distances(self, radius: FloatArray) -> FloatArray:
        """Ends of the density's pieces minus radii [m], by the unit, shape (pieces + 1, n).

        Beside a rim a difference of two radii in metres is exact; of two rounded ratios it is not.
        """
        rims, beyond = self._ends
        return np.asarray((rims[:, None] - radius) / self.unit + beyond[:, None])

    @cached_property
    def _ends(self) -> tuple[FloatArray, FloatArray]:
        """Where pieces of the density end: the axis or the nearest rim as given [m], and the way on by the unit."""
        indenter, a = self.scene.indenter, self.density.radius
        given = np.array([0.0, indenter.flat_radius, *indenter.breakpoints, self.known.radius])
        ratios = np.append(given[:-1] / self.unit, a)
        ends = np.array([*(piece.start for piece in self.density.pieces), a])
        nearest = np.argmin(np.abs(np.subtract.outer(ends, ratios)), axis=1)
        beyond = ends - ratios[nearest]
        return given[nearest], np.where(np.abs(beyond) <= _ROUNDED * ends, 0.0, beyond)


def _of_both(whole: Mapping[str, FloatArray], pulls: FloatArray, edge: Mapping[str, FloatArray]) -> FloatArray:
    """Largest sum of the magnitudes of the edge's part of some fields and of the rest, at each point."""
    return _largest({name: np.abs(pulls * part) + np.abs(whole[name] - pulls * part) for name, part in edge.items()})


def _of_kinds(r: FloatArray, found: Mapping[str, FloatArray]) -> tuple[dict[str, FloatArray], ...]:
    """Stresses, gradient, and displacements times 2 G of the surface material."""
    modulus = found.get("modulus", 1.0)
    moved = {"radial": found["hoop_strain"] * r / modulus, "axial": found["axial"] / modulus}
    return _stresses(found), {name: found[name] for name in _SLOPES}, moved


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
