"""The equilibrium branch of an adhering indenter, parametrised by its contact radius.

The energy release rate ``G = k_N' (delta - delta_0)^2 / (4 pi a)`` equals the work of adhesion where

    delta(a) = delta_0(a) - dl(a),   dl(a) = sqrt(4 pi a dgamma / k_N'(a)),      F(a) = k_N delta + F_2.

k_N, k_N', delta_0 and F_2 are solved at Chebyshev points and interpolated; between the kinks of the profile they are
smooth, next to a flat end in the square root of a - b.  Where a profile has breakpoints between solved radii, only what
the pressures of flat punches do not tell of ``k_N' delta_0`` and F_2 is interpolated, see `superposed`: nearly nothing.

Units: SI for lengths, stresses by E*.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.polynomial import Chebyshev
from numpy.polynomial.chebyshev import chebder, chebfit, chebval

from contact.records.validation import BoolArray, FloatArray
from contact.scene.loading import Controlled
from fem_reference.adhesion.superposed import punch_pressure, superposed
from fem_reference.elastic.error_estimate import ContactWithErrors
from fem_reference.error_model import FIXED_RADIUS

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
        degree: of the elements; None for that of the answer.
    """

    low: float
    high: float
    graded: bool
    contacts: tuple[ContactWithErrors, ...]
    degree: int | None = None

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
        solutions = [contact.levels[self.degree or contact.settings.order] for contact in self.contacts]
        values = np.array([getattr(solution, name) for solution in solutions])
        if name.startswith("stiffness"):
            return np.asarray(np.log(values))
        factor, known = self._known(name, radii, np.array([solution.stiffness_slope for solution in solutions]))
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
        levels = (contact.levels[self.degree or contact.settings.order] for contact in self.contacts)
        pressures = np.array([punch_pressure(level) for level in levels])
        return np.asarray(chebfit(self._logarithmic(self.radii), pressures, (len(self.contacts) - 1) // 2))

    @property
    def radii(self) -> FloatArray:
        """Solved contact radii [m]."""
        return np.array([contact.indenter.contact_radius for contact in self.contacts])

    def tilts(self, radius: float) -> FloatArray:
        """Slope per ln a at a radius [m] of the interpolant that is one at one solved radius and zero at the others."""
        inner, s = self.parameter(radius * np.array([1 - 1e-6, 1.0]))
        return np.asarray(chebval(2 * s - 1, chebder(self._cardinals)) * 2 * (s - inner) / 1e-6)

    def weights(self, radius: float) -> FloatArray:
        """Value there of the same interpolants: what each solved radius counts."""
        return np.asarray(chebval(2 * self.parameter(np.asarray(radius)) - 1, self._cardinals))

    @cached_property
    def _cardinals(self) -> FloatArray:
        """Chebyshev coefficients of the interpolants that are one at one solved radius and zero at the others."""
        count = len(self.contacts)
        return np.asarray(chebfit(2 * chebyshev_points(count) - 1, np.eye(count), count - 1))

    @cached_property
    def far(self) -> dict[str, float]:
        """Root mean square of the contacts' errors by outer edge and half-space, relative."""
        names = self.contacts[0].far_error
        return {name: float(np.sqrt(np.mean([c.far_error[name] ** 2 for c in self.contacts]))) for name in names}

    @cached_property
    def last_coefficients(self) -> FloatArray:
        """The last two Chebyshev coefficients of each interpolant, in the order of `POWERS`, shape (4, 2)."""
        return np.array([fit.coef[-2:] for fit in self._interpolants.values()])

    def last_terms(self, counts: FloatArray) -> FloatArray:
        """Size of the last two terms of numbers that take the interpolants ``counts`` (4, n) times, shape (n,)."""
        return np.asarray(np.abs(counts.T @ self.last_coefficients).sum(axis=1))

    def between(self, counts: FloatArray) -> FloatArray:
        """Errors of such numbers between the solved radii: their last terms, less what these owe to the meshes.

        Every radius has a mesh of its own, whose error differs from the next one's: that is no error of interpolation.
        It is taken off each interpolant apart, since what is left may have any sign.
        """
        low, high = (self.at_degrees[degree].last_coefficients for degree in sorted(self.at_degrees)[-2:])
        share = FIXED_RADIUS.safety * float(np.mean([contact.rate for contact in self.contacts]))
        left = np.abs(self.last_coefficients).sum(axis=1) - share * np.abs(high - low).sum(axis=1)
        return np.asarray(np.maximum(left, 0.0) @ np.abs(counts))

    def counts(self, radius: FloatArray, elongation: FloatArray) -> FloatArray:
        """How often depth [m] and force / E* [m^2] at radii take each interpolant, to first order, shape (2, 4, n).

        What errs in both parts of a force, ``k_N delta`` and F_2, cancels there.
        """
        stiffness, depth = self.evaluate("stiffness", radius), self.evaluate("smooth_depth", radius)
        slope = self.evaluate("stiffness_slope", radius)
        factor = self._known("smooth_depth", radius, slope)[0] * np.ones_like(radius)
        none, by_slope = np.zeros_like(radius), elongation / 2 - self.is_rough * depth
        of_force = stiffness * (depth - elongation), stiffness * by_slope, stiffness / factor, none + 1.0
        return np.array([[none, by_slope, 1 / factor, none], of_force])

    @cached_property
    def at_degrees(self) -> Mapping[int, BranchPiece]:
        """The piece as elements of each degree that was solved have it."""
        return {degree: replace(self, degree=degree) for degree in self.contacts[0].levels}

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
        is_shifted: whether every contact acts like a smaller one, as its edge cell makes it.
        machine: E*/K [1/m] of a machine of stiffness K; zero if it is rigid.
    """

    pieces: Sequence[BranchPiece]
    work: float
    is_shifted: bool = False
    machine: float = 0.0

    @property
    def loads(self) -> dict[Controlled, Callable[[FloatArray], FloatArray]]:
        """What each control prescribes, over radii [m]."""
        return {"displacement": self.depth, "force": self.force, "machine": self.displacement}

    def at_degree(self, degree: int) -> InterpolatedBranch:
        """The branch as elements of another degree have it."""
        return replace(self, pieces=[piece.at_degrees[degree] for piece in self.pieces])

    def _evaluate(self, name: str, radius: FloatArray) -> FloatArray:
        if self.is_shifted:
            radius = np.maximum(radius * (1 - np.interp(radius, *self._edge_shifts)), self.pieces[0].low)
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

    @cached_property
    def _edge_shifts(self) -> tuple[FloatArray, FloatArray]:
        """Radii [m] of the contacts, and by how much each acts like a smaller one, relative."""
        shifts = {contact.indenter.contact_radius: contact.edge_shift for contact in self.contacts}
        return np.array(list(shifts)), np.array(list(shifts.values()))

    @property
    def contacts(self) -> list[ContactWithErrors]:
        """All solved contacts."""
        return [contact for piece in self.pieces for contact in piece.contacts]

    @property
    def depth_interpolation_error(self) -> float:
        """Of the depth between the solved radii, relative to its largest term in each piece."""
        found = []
        for piece in self.pieces:
            error = self.errors_between(piece.radii, BranchPiece.last_terms)[0].max()
            found.append(error / self.terms(piece.radii)[0].max())
        return float(max(found))

    @property
    def force_interpolation_error(self) -> float:
        """Of the force between the solved radii, relative to the terms whose difference it is there."""
        radius = np.geomspace(self.pieces[0].low, self.pieces[-1].high, 41)
        return float(np.max(self.errors_between(radius, BranchPiece.last_terms)[1] / self.terms(radius)[1]))

    def terms(self, radius: FloatArray) -> FloatArray:
        """Size of the terms whose difference depth [m] and force / E* [m^2] are, shape (2, radius)."""
        depth, elongation = np.abs(self._evaluate("smooth_depth", radius)), self.elongation(radius)
        return np.array([depth + elongation, np.abs(self.force(radius)) + self.stiffness(radius) * elongation])

    def _by_piece(self, radius: FloatArray) -> list[tuple[BranchPiece, BoolArray]]:
        """Each piece with the radii [m] that lie in it."""
        found = np.searchsorted([piece.high for piece in self.pieces[:-1]], radius)
        return [(piece, found == i) for i, piece in enumerate(self.pieces)]

    def errors_far(self, radius: FloatArray) -> FloatArray:
        """Of depth [m] and force / E* [m^2] by outer edge and half-space, shape (2, radius)."""
        errors = np.empty((4, len(radius)))
        for piece, inside in self._by_piece(radius):
            errors[:, inside] = np.array(list(piece.far.values()))[:, None]
        stiffness, slope, smooth_depth, smooth_force = errors
        elongation = self.elongation(radius)
        pulled = self.stiffness(radius) * elongation
        depth = np.abs(self._evaluate("smooth_depth", radius)) * smooth_depth + elongation * slope / 2
        force = np.abs(self.force(radius) + pulled) * smooth_force + pulled * (stiffness + slope / 2)
        return np.array([depth, force])

    def errors_between(
        self, radius: FloatArray, error: Callable[[BranchPiece, FloatArray], FloatArray] = BranchPiece.between
    ) -> FloatArray:
        """Of depth [m] and force / E* [m^2] between the solved radii, shape (2, radius)."""
        errors, elongation = np.empty((2, len(radius))), self.elongation(radius)
        for piece, inside in self._by_piece(radius):
            counts = piece.counts(np.clip(radius[inside], piece.low, piece.high), elongation[inside])
            errors[:, inside] = [error(piece, of_load) for of_load in counts]
        return errors

    def piece_around(self, radius: float) -> BranchPiece:
        """The piece that a radius [m] lies in."""
        return next((piece for piece in self.pieces if radius <= piece.high), self.pieces[-1])

    def tilt_of_last_polynomial(self, radius: float) -> float:
        """Slope per ln a of the last Chebyshev polynomial around a radius: an error of interpolation tilts so much."""
        piece = self.piece_around(radius)
        return float(2 * (len(piece.contacts) - 1) / np.log(piece.high / piece.low))


def solve_branch(
    breaks: Sequence[float],
    kinks: Sequence[float],
    work: float,
    solve: Callable[[float], ContactWithErrors],
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
