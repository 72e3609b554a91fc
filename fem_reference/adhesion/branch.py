"""The equilibrium branch of an adhering indenter, parametrised by its contact radius.

The energy release rate ``G = k_N' (delta - delta_0)^2 / (4 pi a)`` equals the work of adhesion where

    delta(a) = delta_0(a) - dl(a),   dl(a) = sqrt(4 pi a dgamma / k_N'(a)),      F(a) = k_N delta + F_2.

k_N, k_N', delta_0 and F_2 are solved at Chebyshev points and interpolated; between the kinks of the profile they are
smooth, next to a flat end in the square root of a - b.  Units: SI for lengths, stresses by E*.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.polynomial import Chebyshev
from numpy.typing import NDArray

from fem_reference.elastic.error_estimate import CertifiedContact

Array = NDArray[np.float64]

QUANTITIES = ("stiffness", "stiffness_slope", "smooth_depth", "profile_force")


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
    contacts: tuple[CertifiedContact, ...]

    def parameter(self, radius: Array) -> Array:
        """s of radii [m]."""
        if self.graded:
            return np.sqrt((radius - self.low) / (self.high - self.low))
        return np.asarray(np.log(radius / self.low) / np.log(self.high / self.low))

    @cached_property
    def _interpolants(self) -> dict[str, Chebyshev]:
        s = chebyshev_points(len(self.contacts))
        return {name: Chebyshev.fit(s, self._values(name), len(s) - 1, domain=[0, 1]) for name in QUANTITIES}

    def _values(self, name: str) -> Array:
        """Quantity at the nodes, in SI lengths; stiffness and its slope over the power of a that half-spaces have."""
        radii = np.array([contact.indenter.contact_radius for contact in self.contacts])
        values = np.array([getattr(contact.answer, name) for contact in self.contacts])
        scaled = np.log(values) if name.startswith("stiffness") else values * radii ** POWERS[name]
        return np.asarray(scaled)

    def evaluate(self, name: str, radius: Array) -> Array:
        """A quantity [powers of m, E* = 1] at radii within the piece."""
        value = self._interpolants[name](self.parameter(radius))
        return np.asarray(np.exp(value) * radius ** POWERS[name] if name.startswith("stiffness") else value)

    @cached_property
    def errors(self) -> dict[str, float]:
        """Of the contacts, relative, their root mean square; of their interpolants: see `interpolation_errors`."""
        names = self.contacts[0].error
        return {name: float(np.sqrt(np.mean([c.error[name] ** 2 for c in self.contacts]))) for name in names}

    @cached_property
    def interpolation_errors(self) -> dict[str, float]:
        """Size of the last Chebyshev coefficients: relative for k_N and k_N', in [m] for delta_0 and [m^2] for F_2.

        Those of a profile that is not analytic fall like a power of their number: more is left than the last two.
        """
        left = ROUGH if self._is_rough else 1.0
        return {name: left * float(np.abs(fit.coef[-2:]).sum()) for name, fit in self._interpolants.items()}

    @property
    def _is_rough(self) -> bool:
        """Whether the profile has breakpoints between the ends."""
        indenter = self.contacts[-1].indenter
        return any(r * indenter.contact_radius > self.low * (1 + 1e-9) for r in indenter.breakpoints)


ROUGH = 3.0
SAMPLES = 41  # radii at which the force's error is compared with an accuracy
POWERS = {"stiffness": 1, "stiffness_slope": 0, "smooth_depth": 1, "profile_force": 2}


def chebyshev_points(count: int) -> Array:
    """Chebyshev points of the second kind on [0, 1], increasing."""
    return np.asarray((1 - np.cos(np.pi * np.arange(count) / (count - 1))) / 2)


@dataclass(frozen=True)
class AdhesiveBranch:
    """States in adhesive equilibrium.

    Attributes:
        pieces: between kinks, in increasing radius.
        work: dgamma / E* [m].
    """

    pieces: Sequence[BranchPiece]
    work: float

    def _evaluate(self, name: str, radius: Array) -> Array:
        values = np.full_like(radius, np.nan)  # beyond the ends nothing is known
        for piece in self.pieces:
            inside = (radius >= piece.low * (1 - 1e-14)) & (radius <= piece.high * (1 + 1e-14))
            values[inside] = piece.evaluate(name, np.clip(radius[inside], piece.low, piece.high))
        return values

    def stiffness(self, radius: Array) -> Array:
        """k_N / E* [m]."""
        return self._evaluate("stiffness", radius)

    def elongation(self, radius: Array) -> Array:
        """dl = sqrt(4 pi a dgamma / k_N') [m], Eq. (40)."""
        return np.asarray(np.sqrt(4 * np.pi * radius * self.work / self._evaluate("stiffness_slope", radius)))

    def depth(self, radius: Array) -> Array:
        """delta [m]."""
        return self._evaluate("smooth_depth", radius) - self.elongation(radius)

    def force(self, radius: Array) -> Array:
        """F / E* [m^2]."""
        return self.stiffness(radius) * self.depth(radius) + self._evaluate("profile_force", radius)

    def slope(self, function: Callable[[Array], Array], radius: Array) -> Array:
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
    def contacts(self) -> list[CertifiedContact]:
        """All solved contacts."""
        return [contact for piece in self.pieces for contact in piece.contacts]

    @property
    def depth_interpolation_error(self) -> float:
        """Of the depth between the solved radii, relative to its largest term in each piece."""
        found = []
        for piece in self.pieces:
            radii = np.array([contact.indenter.contact_radius for contact in piece.contacts])
            largest = np.max(np.abs(self._evaluate("smooth_depth", radii)) + self.elongation(radii))
            errors = piece.interpolation_errors
            found.append(errors["stiffness_slope"] / 2 + errors["smooth_depth"] / largest)
        return float(max(found))

    @property
    def force_interpolation_error(self) -> float:
        """Of the force between the solved radii, relative to the terms whose difference it is there."""
        radius = np.geomspace(self.pieces[0].low, self.pieces[-1].high, SAMPLES)
        terms = np.abs(self.force(radius)) + self.stiffness(radius) * self.elongation(radius)
        return float(np.max(self.force_error(radius, 0.0) / terms))

    def _stated(self, kind: str, name: str, radius: Array) -> Array:
        """``errors`` or ``interpolation_errors`` of the piece around each radius."""
        ends = [piece.high for piece in self.pieces[:-1]]
        values = np.array([getattr(piece, kind)[name] for piece in self.pieces])
        return np.asarray(values[np.searchsorted(ends, radius)])

    def elongation_error(self, radius: Array, share: float = 1.0) -> Array:
        """Of dl, relative: half that of k_N'.  ``share`` is one, or zero for the error of the interpolation alone."""
        solved = share * self._stated("errors", "stiffness_slope", radius)
        return np.asarray((solved + self._stated("interpolation_errors", "stiffness_slope", radius)) / 2)

    def depth_error(self, radius: Array, share: float = 1.0) -> Array:
        """Of delta = delta_0 - dl [m]; ``share`` as above."""
        solved = share * np.abs(self._evaluate("smooth_depth", radius)) * self._stated("errors", "smooth_depth", radius)
        interpolated = self._stated("interpolation_errors", "smooth_depth", radius)
        return np.asarray(solved + interpolated + self.elongation(radius) * self.elongation_error(radius, share))

    def force_error(self, radius: Array, share: float = 1.0) -> Array:
        """Of F / E* = F_0 - k_N dl [m^2], F_0 the force of smooth contact; ``share`` as above."""
        pulled = self.stiffness(radius) * self.elongation(radius)
        solved = share * np.abs(self.force(radius) + pulled) * self._stated("errors", "smooth_force", radius)
        interpolated = self.stiffness(radius) * self._stated("interpolation_errors", "smooth_depth", radius)
        interpolated += self._stated("interpolation_errors", "profile_force", radius)
        relative = share * self._stated("errors", "stiffness", radius) + self.elongation_error(radius, share)
        relative += self._stated("interpolation_errors", "stiffness", radius)
        return np.asarray(solved + interpolated + pulled * relative)

    def waves(self, radius: float) -> float:
        """Slope per ln a of the last Chebyshev polynomial around a radius: an error of interpolation tilts so much."""
        piece = next((piece for piece in self.pieces if radius <= piece.high), self.pieces[-1])
        return float(2 * (len(piece.contacts) - 1) / np.log(piece.high / piece.low))


def solve_branch(
    breaks: Sequence[float],
    kinks: Sequence[float],
    work: float,
    solve: Callable[[float], CertifiedContact],
    nodes: int,
) -> AdhesiveBranch:
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
    return AdhesiveBranch(tuple(pieces), work)
