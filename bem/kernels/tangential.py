"""Compliance of a layer's surface to normal and tangential traction, beyond the half-space's, in wavenumber space.

With ``u_r = int U J1(kr) k dk``, ``w = int W J0(kr) k dk``, ``q = int Q J1 k dk`` and ``p = int P J0 k dk`` (q > 0
pushes the layer outward, w > 0 points into it), the surface obeys ``2 G k (U, W) = C (Q, P)``. The half-space has
``C_hs = [[2 beta, -eta], [-eta, 2 beta]]`` with ``beta = 1 - nu`` and ``eta = 1 - 2 nu``; the layer adds ``D = C -
C_hs``, which decays as ``q^2 exp(-2q)``, q = kh. D_WW = -2 beta (1 - chi) is the frictionless kernel again.

Numerators and denominators are multiplied by ``exp(-2q)``; no large terms cancel.
"""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from contact.records.validation import FloatArray
from contact.scene.layer import Support


@dataclass(frozen=True)
class TangentialKernel:
    """D of the layer at some wavenumbers, each in the shape of q.

    Attributes:
        radial: D_UU, radial displacement under radial traction.
        coupling: D_UW = D_WU.
        normal: D_WW.
    """

    radial: FloatArray
    coupling: FloatArray
    normal: FloatArray


class StickingKernel(Hashable, Protocol):
    """What a layer tells of both tractions; wavenumbers count in units of 1/h of its surface material. Hashable."""

    @property
    def poissons_ratio(self) -> float:
        """nu of the surface material."""

    @property
    def longest(self) -> float:
        """Length over h on the scale of whose inverse D is smooth."""

    def beyond_half_space(self, wavenumber: FloatArray) -> TangentialKernel:
        """D = C - C_hs at wavenumbers k > 0, any shape."""


@dataclass(frozen=True)
class HalfSpaceKernel:
    """A half-space has nothing beyond itself.

    Attributes:
        poissons_ratio: nu.
    """

    poissons_ratio: float

    @property
    def longest(self) -> float:
        """No layer, no length."""
        return 1.0

    def beyond_half_space(self, wavenumber: FloatArray) -> TangentialKernel:
        """D = 0."""
        return TangentialKernel(*np.zeros((3, *wavenumber.shape)))


def beyond_half_space(q: FloatArray, support: Support, poissons_ratio: float) -> TangentialKernel:
    """D = C - C_hs at q = wavenumber times thickness, any shape, q > 0; exactly 0 for an infinite q."""
    beta, eta = 1.0 - poissons_ratio, 1.0 - 2.0 * poissons_ratio
    e = np.exp(-2.0 * q)
    # Beyond q = 350 e is zero to every digit; the cap keeps q^2 e from becoming inf times zero.
    q = np.minimum(q, 350.0)
    if support == "bonded":
        kappa = 3.0 - 4.0 * poissons_ratio
        scale = 2.0 * beta * e / (kappa * (1.0 + e) ** 2 / 4.0 + (eta**2 + q**2) * e)
        even = kappa * (1.0 + e) / 2.0 + q**2 + eta**2
        return TangentialKernel(-scale * (even - q), scale * (q**2 + 2.0 * beta * eta), -scale * (even + q))
    scale = 2.0 * beta * e / (-np.expm1(-4.0 * q) / 4.0 + q * e)
    return TangentialKernel(scale * ((1.0 + e) / 2.0 - q), scale * q, -scale * (-np.expm1(-2.0 * q) / 2.0 + q))
