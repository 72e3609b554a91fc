"""Fields at points: half-space part and layer part together, lengths over the first layer's thickness."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from bem.kernels.inside import Place, place_of, sheet_of
from bem.kernels.stack import StackKernel
from bem.layer_equation.inside.density import Density
from bem.layer_equation.inside.half_space_part import Integrals, Points, at_edge, integrals
from bem.layer_equation.inside.half_space_part import fields as half_space_fields
from bem.layer_equation.inside.layer_part import NAMES, layer_fields
from contact.answer.inside import SURFACE
from contact.records.validation import FloatArray

TERMS = ("gradient_terms", "displacement_terms")


@dataclass(frozen=True)
class Body:
    """A uniform half-space or a stack under one contact.

    Attributes:
        kernel: Of the layers; None for a half-space.
        poissons_ratio: nu of the surface material.
        density: Of the contact's pressure.
    """

    kernel: StackKernel | None
    poissons_ratio: float
    density: Density

    def at(self, points: Points) -> dict[str, FloatArray]:
        """2 G u_r/r, 2 G u_z, stresses, pressure and gradient in E*, and G over the surface's, each of shape (n,).

        With them what they are rounded by: the root of the sum of the squares of the gradient's terms, and of 2 G u the
        larger sum of the magnitudes of what the half-space and the layers below make of it.
        """
        r, depth, ends = points
        z = np.maximum(depth, SURFACE * self.density.radius)
        if self.kernel is None:
            parts = self._of_half_space(Points(r, z, ends))
            parts["displacement_terms"] = sizes_of_displacement(r, parts)
            return {name: part / math.pi for name, part in parts.items()} | {"modulus": np.ones_like(r)}
        found = {name: np.zeros_like(r) for name in (*NAMES, *TERMS, "modulus")}
        sheets = np.array([place_of(self.kernel, float(depth)).sheet for depth in z])
        for sheet in np.unique(sheets):
            some = sheets == sheet
            for name, values in self._of_sheet(Points(r[some], z[some], ends[:, some]), top=sheet == 0).items():
                found[name][some] = values / math.pi
            found["modulus"][some] = sheet_of(self.kernel, Place(int(sheet), 0.0)).shear_modulus
        return found

    def _of_half_space(self, points: Points) -> dict[str, FloatArray]:
        return half_space_fields(integrals(self.density, points), points.r, points.z, self.poissons_ratio)

    def _of_sheet(self, points: Points, *, top: bool) -> dict[str, FloatArray]:
        assert self.kernel is not None
        load, a = self.density.transform, self.density.radius
        parts = layer_fields(self.kernel, load, points.r, points.z, beyond_half_space=top, radius=a)
        if not top:
            return parts | {"displacement_terms": sizes_of_displacement(points.r, parts)}
        upper = self._of_half_space(points)
        terms = sizes_of_displacement(points.r, upper, parts)
        return {name: parts.get(name, 0.0) + part for name, part in upper.items()} | {"displacement_terms": terms}

    def of_unit_edge(self, points: Points) -> dict[str, FloatArray]:
        """What a density of edge value one, in E* times the unit, causes beside the edge: the half-space's share."""
        r, z, ends = points
        beside = Points(r, np.maximum(z, SURFACE * self.density.radius), ends)
        total = Integrals(*np.vstack([at_edge(self.density, beside), np.zeros_like(r)]))
        parts = half_space_fields(total, r, beside.z, self.poissons_ratio)
        return {name: part / math.pi for name, part in parts.items()}


def sizes_of_displacement(r: FloatArray, *parts: Mapping[str, FloatArray]) -> FloatArray:
    """Larger of the sums of the magnitudes of 2 G u_r and of 2 G u_z that are added to another."""
    radial, axial = (np.sum([np.abs(part[name]) for part in parts], axis=0) for name in ("hoop_strain", "axial"))
    return np.asarray(np.maximum(radial * r, axial))
