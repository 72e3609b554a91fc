"""Integrals over a profile within the contact radius.

Under a unit depth a flat punch presses with Q(r/a; a) times the half-space's pressure E*/(pi sqrt(a^2 - r^2)). By
reciprocity the force at no depth is -E* M, with r = a cos(psi)

    M(a) = 2 int_0^a r f Q/sqrt(a^2 - r^2) dr = 2 a int f Q cos(psi) dpsi.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np

from contact import Profile
from contact.records.validation import FloatArray

# Gauss nodes between two breakpoints of the profile. Half as many leave 1e-6 of a profile that begins like r^1.1.
NODES: Final = 64
_T, _W = np.polynomial.legendre.leggauss(NODES)
# sin^2 crowds nodes towards both ends, where profiles may begin like a power or end upright.
SHARE: Final = np.sin(0.25 * np.pi * (1.0 + _T)) ** 2
WEIGHT: Final = 0.25 * np.pi * _W * np.sin(0.5 * np.pi * (1.0 + _T))


@dataclass(frozen=True, eq=False)
class ProfileOverCircle:
    """Quadrature over the risen part of a profile within the contact radius a.

    Attributes:
        radius: a [m].
        share: r/a at the nodes, shape (n,).
        by_slope: a f' dpsi [m].
        by_height: 2 a cos(psi) f dpsi [m^2].
    """

    radius: float
    share: FloatArray
    by_slope: FloatArray
    by_height: FloatArray

    @classmethod
    def of(cls, indenter: Profile, radius: float) -> ProfileOverCircle:
        """Nodes between the breakpoints; none within a flat end."""
        flat, a = indenter.flat_radius, radius
        ends = [flat, *(b for b in sorted(indenter.breakpoints) if flat < b < a)] if a > flat else []
        # 2 sin^2(psi/2) = (a - r)/a is accurate where r is close to a.
        angles = [2.0 * np.arcsin(np.sqrt((a - r) / (2.0 * a))) for r in ends] + [0.0]
        psi, weights = np.zeros((2, 0))
        for high, low in pairwise(angles):
            psi = np.append(psi, low + (high - low) * SHARE)
            weights = np.append(weights, (high - low) * WEIGHT)
        # No node lies within the flat end by a rounding.
        r = np.clip(a * np.cos(psi), flat, a)
        by_height = 2.0 * a * np.cos(psi) * indenter.height(r) * weights
        return cls(a, np.cos(psi), np.asarray(a * indenter.slope_at(r) * weights), np.asarray(by_height))

    def moment(self, quotient: FloatArray) -> float:
        """M [m^2] with Q at the nodes: 2 int r f Q/sqrt(a^2 - r^2) dr."""
        return float(self.by_height @ quotient)

    def moment_slope(self, quotient: FloatArray, change: FloatArray) -> float:
        """dM/da [m] with Q and dQ/d(ln a) at the nodes, at fixed r/a."""
        return float(
            self.by_height @ (quotient + change) / self.radius + 2.0 * self.by_slope @ (self.share**2 * quotient)
        )
