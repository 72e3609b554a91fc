"""The equilibrium branch of an adhering indenter, parametrised by its contact radius.

The energy release rate ``G = k_N' (delta - delta_0)^2 / (4 pi a)`` equals the work of adhesion where

    delta(a) = delta_0(a) - dl(a),   dl(a) = sqrt(4 pi a dgamma / k_N'(a)),      F(a) = k_N delta + F_2.

k_N, k_N', delta_0 and F_2 are solved at Chebyshev points and interpolated; between the kinks of the profile they are
smooth, next to a flat end in the square root of a - b.  Where a profile has breakpoints between solved radii, only what
the pressures of flat punches do not tell of ``k_N' delta_0`` and F_2 is interpolated, see `superposed`: nearly nothing.

Units: SI for lengths, stresses by E*.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.polynomial import Chebyshev
from numpy.polynomial.chebyshev import chebder, chebfit, chebval

from contact.records.validation import FloatArray
from contact.scene.loading import Controlled
from fem_reference.adhesion.superposed import punch_pressure, superposed
from fem_reference.prescribed_contact import PrescribedContact

# What is interpolated along the branch, with the power of the contact radius that turns it into SI lengths.
POWERS = {"stiffness": 1, "stiffness_slope": 0, "smooth_depth": 1, "profile_force": 2}


@dataclass(frozen=True)
class BranchPiece:
    """The branch between two neighbouring kinks.

    Attributes:
        low: smallest contact radius [m].
        high: largest contact radius [m].
        graded: whether radii are ``low + (high - low) s^2`` (next to a kink) or ``low (high / low)^s``.
        contacts: solved contacts at the Chebyshev points of s in [0, 1], in increasing s.
    """

    low: float
    high: float
    graded: bool
    contacts: tuple[PrescribedContact, ...]

    def parameter(self, radius: FloatArray) -> FloatArray:
        """s of radii [m]."""
        if self.graded:
            return np.sqrt((radius - self.low) / (self.high - self.low))
        return np.asarray(np.log(radius / self.low) / np.log(self.high / self.low))

    @cached_property
    def _interpolants(self) -> dict[str, Chebyshev]:
        s = chebyshev_points(len(self.contacts))
        return {name: Chebyshev.fit(s, self._values(name), len(s) - 1, domain=[0, 1]) for name in POWERS}

    def _values(self, name: str) -> FloatArray:
        """Quantity at the nodes, in SI lengths; stiffness and its slope over the power of a that half-spaces have."""
        radii = self.radii
        values = np.array([getattr(contact, name) for contact in self.contacts])
        if name.startswith("stiffness"):
            return np.asarray(np.log(values))
        factor, known = self._known(name, radii, np.array([contact.stiffness_slope for contact in self.contacts]))
        return np.asarray(values * radii ** POWERS[name] * factor - known)

    def evaluate(self, name: str, radius: FloatArray) -> FloatArray:
        """A quantity [powers of m, E* = 1] at radii within the piece."""
        value = self._interpolants[name](self.parameter(radius))
        if name.startswith("stiffness"):
            return np.asarray(np.exp(value) * radius ** POWERS[name])
        slope = self.evaluate("stiffness_slope", radius) if self.is_rough else np.ones_like(radius)
        factor, known = self._known(name, radius, slope)
        return np.asarray((value + known) / factor)

    def _known(self, name: str, radius: FloatArray, slope: FloatArray) -> tuple[FloatArray | float, FloatArray | float]:
        """Factor on delta_0 or F_2, and its part that flat punches tell, at radii [m] and slopes k_N'."""
        if not self.is_rough:
            return 1.0, 0.0
        place, punches = self._logarithmic(radius), self._punches
        growth = np.asarray(chebval(place, chebder(punches)) * 2 / np.log(self.high / self.low), dtype=np.float64)
        depth, force = superposed(
            self.contacts[-1].indenter.profile, radius, np.asarray(chebval(place, punches), dtype=np.float64), growth
        )
        return (slope / 2.0, depth) if name == "smooth_depth" else (1.0, force)

    def _logarithmic(self, radius: FloatArray) -> FloatArray:
        """ln a of radii [m], from -1 to 1 within the piece."""
        return np.asarray(2 * np.log(radius / self.low) / np.log(self.high / self.low) - 1)

    @cached_property
    def _punches(self) -> FloatArray:
        """Chebyshev coefficients of the pressures of flat punches over ln a, shape (degree + 1, term).

        They are smooth, and every radius has a mesh of its own: a polynomial of half the degree that could pass through
        all of them hardly feels the errors of the meshes, even in its slope.  What it leaves is interpolated.
        """
        pressures = np.array([punch_pressure(contact) for contact in self.contacts])
        return np.asarray(chebfit(self._logarithmic(self.radii), pressures, (len(self.contacts) - 1) // 2))

    @property
    def radii(self) -> FloatArray:
        """Solved contact radii [m]."""
        return np.array([contact.contact_radius for contact in self.contacts])

    @cached_property
    def is_rough(self) -> bool:
        """Whether the profile has breakpoints between the ends."""
        indenter = self.contacts[-1].indenter
        return any(r * indenter.contact_radius > self.low * (1 + 1e-9) for r in indenter.breakpoints)


def chebyshev_points(count: int) -> FloatArray:
    """Chebyshev points of the second kind on [0, 1], increasing."""
    return np.asarray((1 - np.cos(np.pi * np.arange(count) / (count - 1))) / 2)


@dataclass(frozen=True)
class InterpolatedBranch:
    """States in adhesive equilibrium.

    Attributes:
        pieces: between kinks, in increasing radius.
        work: dgamma / E* [m].
        machine: E*/K [1/m] of a machine of stiffness K; zero if it is rigid.
    """

    pieces: Sequence[BranchPiece]
    work: float
    machine: float = 0.0

    @property
    def loads(self) -> dict[Controlled, Callable[[FloatArray], FloatArray]]:
        """What each control prescribes, over radii [m]."""
        return {"displacement": self.depth, "force": self.force, "machine": self.displacement}

    def _evaluate(self, name: str, radius: FloatArray) -> FloatArray:
        # Beyond the ends nothing is known.
        values = np.full_like(radius, np.nan)
        for piece in self.pieces:
            inside = (radius >= piece.low * (1 - 1e-14)) & (radius <= piece.high * (1 + 1e-14))
            if np.any(inside):
                values[inside] = piece.evaluate(name, np.clip(radius[inside], piece.low, piece.high))
        return values

    def stiffness(self, radius: FloatArray) -> FloatArray:
        """k_N / E* [m]."""
        return self._evaluate("stiffness", radius)

    def elongation(self, radius: FloatArray) -> FloatArray:
        """dl = sqrt(4 pi a dgamma / k_N') [m], Eq. (40)."""
        return np.asarray(np.sqrt(4 * np.pi * radius * self.work / self._evaluate("stiffness_slope", radius)))

    def depth(self, radius: FloatArray) -> FloatArray:
        """delta [m]."""
        return self._evaluate("smooth_depth", radius) - self.elongation(radius)

    def force(self, radius: FloatArray) -> FloatArray:
        """F / E* [m^2]."""
        return self.stiffness(radius) * self.depth(radius) + self._evaluate("profile_force", radius)

    def displacement(self, radius: FloatArray) -> FloatArray:
        """delta + F/K [m] of the machine."""
        return self.depth(radius) + self.machine * self.force(radius)

    def slope(self, function: Callable[[FloatArray], FloatArray], radius: FloatArray) -> FloatArray:
        """d function / d a by central differences inside the piece of each radius (the interpolants are smooth)."""
        slopes = np.empty_like(radius)
        for piece in self.pieces:
            inside = (radius >= piece.low) & (radius <= piece.high)
            step = 1e-5 * (piece.high - piece.low)
            up = np.minimum(radius[inside] + step, piece.high)
            down = np.maximum(radius[inside] - step, piece.low)
            slopes[inside] = (function(up) - function(down)) / (up - down)
        return slopes

    @property
    def contacts(self) -> list[PrescribedContact]:
        """All solved contacts."""
        return [contact for piece in self.pieces for contact in piece.contacts]


def solve_branch(
    breaks: Sequence[float],
    kinks: Sequence[float],
    work: float,
    solve: Callable[[float], PrescribedContact],
    nodes: int,
) -> InterpolatedBranch:
    """Solve the branch on [breaks[0], breaks[-1]], in pieces that end at ``breaks``.

    Args:
        breaks: increasing radii [m], kinks inside the range among them.
        kinks: radii where the profile's slope jumps; pieces beginning there are graded.
        work: dgamma / E* [m].
        solve: contact of a given radius [m].
        nodes: Chebyshev points in each piece.
    """
    pieces = []
    for low, high in pairwise(breaks):
        s = chebyshev_points(nodes)
        graded = low in kinks
        radii = low + (high - low) * s**2 if graded else low * (high / low) ** s
        radii[0], radii[-1] = low, high
        pieces.append(BranchPiece(low, high, graded, tuple(solve(float(a)) for a in radii)))
    return InterpolatedBranch(tuple(pieces), work)
