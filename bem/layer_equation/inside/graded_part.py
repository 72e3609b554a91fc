"""The body of a graded layer: closed forms of a half-space like its surface, and what grading and base add to it.

What is added falls like 1/k only, times exp(-kz): integrals end where that has faded, or close to the surface at a
largest wavenumber. What the waves between half of it and all of it add tells what is left out beyond.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.special import j0, j1

from bem.kernels.graded import GradedDescent, GradedKernel
from bem.kernels.inside import Transfer, half_space_transfer
from bem.layer_equation.inside.errors import LEFT_OUT
from bem.layer_equation.inside.fields import Body, sizes_of_displacement
from bem.layer_equation.inside.half_space_part import Points
from bem.layer_equation.inside.layer_part import NAMES
from bem.polynomials.gauss_panels import PANEL_NODES, gauss_nodes
from contact.answer.inside import SURFACE
from contact.records.validation import FloatArray

# Depths times k up to which tractions are followed: exp(-40) is below all digits.
FADED = 40.0
# Largest wavenumber times the contact radius plus the distance from the axis. At the edge of a paraboloid's contact
# what is left out of stresses is 1e-5 of the mean pressure, elsewhere 1e-8; four times as much takes 16 times as long.
_LARGEST = 1500.0
# First panel of wavenumbers over the reciprocal of the longest length; panels then double.
_FIRST = 0.5
# Longest panel times the depth: exp(-8) is a polynomial of twenty nodes to 1e-14.
_FADES = 8.0
# What is left out beyond a wavenumber is at most so many times what the octave before it adds, which falls at least
# like 1/sqrt(k), at the edge of a flat punch.
_BEYOND = 2.5
_STRESSES = ("hoop_strain", "axial_stress", "shear_stress", "s1", "s2")
_SLOPES = ("pressure_gradient_radial", "pressure_gradient_axial")
# Points times wavenumbers of a block: 2 MB an array.
_BLOCK = 1 << 18


@dataclass(frozen=True, kw_only=True)
class GradedBody(Body):
    """A graded layer under one contact, lengths over its thickness.

    Attributes:
        surface: Kernel of the graded layer.
    """

    surface: GradedKernel

    def at(self, points: Points) -> dict[str, FloatArray]:
        """As `Body.at`, with what is left out of stresses, of the gradient and of displacements."""
        found, layer = super().at(points), self.surface.layer
        z = np.maximum(points.z, SURFACE * self.density.radius)
        added = {name: np.zeros_like(z) for name in (*NAMES, *LEFT_OUT)}
        octaves = np.floor(np.log2(np.maximum(z, FADED * self.density.radius / _LARGEST))).astype(int)
        for octave in np.unique(octaves):
            some = octaves == octave
            for name, values in self._added(points.r[some], z[some]).items():
                added[name][some] = values / math.pi
        slopes = 1.0 + layer.ratio_at(z), 1.0 + float(layer.ratio_at(0.0))
        modulus = layer.youngs_modulus.at(z, 1.0) / float(layer.youngs_modulus.at(0.0, 1.0)) * slopes[1] / slopes[0]
        total = {name: found.get(name, 0.0) + values for name, values in added.items()}
        total["displacement_terms"] = sizes_of_displacement(points.r, found, added)
        return found | total | {"modulus": np.asarray(modulus)}

    def _added(self, r: FloatArray, z: FloatArray) -> dict[str, FloatArray]:
        """At depths within one octave."""
        reach = self.density.radius + float(r.max())
        faded, largest = FADED / float(z.min()), _LARGEST / reach
        k, w = self._waves(min(faded, largest), min(4.0 * math.pi / reach, _FADES / float(z.max())))
        load = w * k * self.density.transform(k)
        last = k > 0.5 * k[-1] if faded > largest else None
        depths, which = np.unique(z, return_inverse=True)
        descent = self.surface.descent(k)
        rows, values, left = max(1, _BLOCK // k.size), np.empty((len(NAMES), r.size)), np.zeros((len(NAMES), r.size))
        for number, depth in enumerate(depths):
            own = np.flatnonzero(which == number)
            terms = self._terms(descent, float(depth)) * load
            for start in range(0, own.size, rows):
                some = own[start : start + rows]
                waves = _waves_at(np.multiply.outer(r[some], k), r[some], k)
                values[:, some] = np.einsum("cpk,ck->cp", waves, terms)
                if last is not None:
                    left[:, some] = np.einsum("cpk,ck->cp", waves[..., last], terms[:, last])
        return dict(zip(NAMES, values, strict=True)) | _left_out(dict(zip(NAMES, np.abs(left), strict=True)), r)

    def _waves(self, largest: float, widest: float) -> tuple[FloatArray, FloatArray]:
        ends, width = [0.0], min(_FIRST / self.surface.longest, widest)
        while ends[-1] < largest:
            ends.append(min(ends[-1] + width, largest))
            width = min(2.0 * width, widest)
        u, w = gauss_nodes(PANEL_NODES)
        starts, widths = np.array(ends[:-1]), np.diff(ends)
        return (starts[:, None] + widths[:, None] * u).ravel(), (widths[:, None] * w).ravel()

    def _terms(self, descent: GradedDescent, depth: float) -> FloatArray:
        """What multiplies the Bessel functions beyond the half-space, shape (9, k)."""
        z, k = np.array([depth]), descent.k
        _, nu, stiffens, turns, _ = (float(np.ravel(one)[0]) for one in descent.material(0, z))
        own = _of_material(Transfer(*(one[0] for one in descent.at(0, z))), k, nu, stiffens, turns)
        return own - _of_material(half_space_transfer(k * depth, self.poissons_ratio), k, self.poissons_ratio, 0.0, 0.0)


def _left_out(octave: dict[str, FloatArray], r: FloatArray) -> dict[str, FloatArray]:
    """Of stresses, gradient and displacements, from what the last octave of waves adds."""
    stress = np.max([octave[name] for name in _STRESSES], axis=0)
    gradient = np.max([octave[name] for name in _SLOPES], axis=0)
    moved = np.maximum(octave["hoop_strain"] * r, octave["axial"])
    return dict(zip(LEFT_OUT, (_BEYOND * part for part in (stress, gradient, moved)), strict=True))


def _of_material(here: Transfer, k: FloatArray, nu: float, stiffens: float, turns: float) -> FloatArray:
    """Factors of `NAMES`, with G'/G and d(nu)/dz there."""
    U, W, Q, P = here
    m, share = nu / (1 - nu), (1 + nu) / (3 * (1 - nu))
    spherical = share * (P - U)
    along = share * (k * (Q - W) - stiffens * U) + 2 * turns / (3 * (1 - nu) ** 2) * (P - U)
    return np.stack([U / k, W / k, -P, -Q, U / (1 - nu) - m * P, m * (U - P), spherical, -k * spherical, along])


def _waves_at(kr: FloatArray, r: FloatArray, k: FloatArray) -> FloatArray:
    """The Bessel function of each field, shape (9, points, k)."""
    J0, J1, over_r = j0(kr), j1(kr), np.zeros_like(kr)
    away = r > 0.0
    over_r[away] = J1[away] / r[away, None]
    over_r[~away] = k / 2.0
    return np.stack([over_r, J0, J0, J1, J0, J0, J0, J1, J0])
