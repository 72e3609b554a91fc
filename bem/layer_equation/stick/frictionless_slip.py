"""How far the surface slides under a frictionless flat punch that is pressed in by one.

What friction changes follows from it by reciprocity: with u_r1 this radial displacement and q the true tangential
traction, ``F = F_frictionless(delta, a) - int q u_r1 dA`` exactly. Densities are Legendre polynomials here, the basis
of the adhered punch without its weight. Lengths in the punch's radius, displacements in its depth.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.polynomial import legendre

from bem.kernels.tangential import StickingKernel
from bem.layer_equation.stick.adhered_punch import BasisTransforms, Material, basis_transforms, functions_for
from bem.layer_equation.triangular import solve_positive
from bem.polynomials.gauss_panels import gauss_nodes
from contact.records.validation import FloatArray

# Gauss nodes of the density between a radius and the edge.
_NODES = 64
# Below this share of the radius the displacement grows with the radius, to six digits.
_NEAR_AXIS = 1e-3
# Radii among which the largest slip is looked for; between two of them it is missed by at most 6e-5
# of itself (50 layers, against 4001 samples, 2026-11-22).
_SAMPLES = 201


@dataclass(frozen=True)
class FrictionlessPunch:
    """Density phi of the pressure, in units of 4 G/pi.

    Attributes:
        material: What the layer is made of.
        ratio: a/h, 0 for the half-space.
        kernel: Of the layer.
        coefficients: Of phi in Legendre polynomials P_0, P_1, .. on [-1, 1].
        transform: P(kappa) = int_0^1 phi cos(kappa t) dt, shape (k,).
        transforms: Of the basis, for wavenumbers and weights.
    """

    material: Material
    ratio: float
    kernel: StickingKernel
    coefficients: FloatArray
    transform: FloatArray
    transforms: BasisTransforms

    def radial_displacement(self, radius: FloatArray) -> FloatArray:
        """u_r1 at 0 <= r/a <= 1, positive outward, shape (n,)."""
        # The friction that bounds an answer needs no Bessel functions.
        from scipy.special import j1  # noqa: PLC0415

        s = np.maximum(radius, _NEAR_AXIS)
        v, weights = gauss_nodes(_NODES)
        square = (1.0 - s) * (1.0 + s)
        t = np.sqrt(s[:, None] ** 2 + square[:, None] * v**2)
        beyond = np.sqrt(square) * (legendre.legval(t, self.coefficients) @ weights)
        enclosed = self.coefficients[0] - beyond
        kappa = self.transforms.wavenumber
        layer = np.zeros_like(s)
        if kappa.size:
            extra = self.kernel.beyond_half_space(kappa / self.ratio)
            layer = j1(np.multiply.outer(s, kappa)) @ (self.transforms.weights * extra.coupling * self.transform)
        displacement = 2.0 / math.pi * (layer - self.material.eta * enclosed / s)
        return np.asarray(displacement * radius / s)

    def largest(self) -> float:
        """max |u_r1| under the punch."""
        return float(np.abs(self.radial_displacement(np.linspace(0.0, 1.0, _SAMPLES))).max())


@lru_cache(maxsize=64)
def frictionless_punch(ratio: float, kernel: StickingKernel) -> FrictionlessPunch:
    """Solve for a punch of radius a on a layer whose surface material is h thick, ratio = a/h; 0 is the half-space."""
    material = Material.of(kernel.poissons_ratio)
    transforms = basis_transforms(0.0, ratio, functions_for(ratio), longest=kernel.longest)
    even = transforms.cosine[::2]
    n = 2 * np.arange(len(even))
    q = transforms.wavenumber / (ratio or 1.0)
    weights = 4.0 / math.pi * transforms.weights * kernel.beyond_half_space(q).normal
    matrix = (even * weights) @ even.T
    matrix[np.diag_indices_from(matrix)] += 2.0 * material.beta
    load = np.zeros(len(even))
    load[0] = math.sqrt(2.0)
    solved = solve_positive(matrix, load)
    coefficients = np.zeros(2 * len(even))
    coefficients[::2] = solved * np.where(n % 4, -1.0, 1.0) * np.sqrt((2 * n + 1) / 2.0)
    return FrictionlessPunch(material, ratio, kernel, coefficients, solved @ even, transforms)
