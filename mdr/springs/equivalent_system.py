"""The equivalent one-dimensional system: a bed of independent springs and a plane profile, Eqs. (2)-(6).

A rigid profile g(x; h) is pressed by delta into springs of stiffness c_N(x; h) per length. Whatever an effect adds
(adhesion, viscosity) acts on these springs; the elastic three-dimensional contact is already inside g and c_N.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bem.layer_equation.protocol import FlatPunchSolution
from bem.polynomials.gauss_panels import gauss_nodes
from bem.polynomials.mapped import MappedFunction, MappedGrid, apart
from bem.polynomials.root_steps import MOST_STEPS
from contact import InvalidInput, NotConvergedError
from contact.records.validation import FloatArray
from mdr.springs.error_model import SPRING_ROUNDING

# A radius is found when the step, or the bracket, is smaller than this share of it: ninety roundings.
NEWTON_TOLERANCE = 2e-14
# A relative bracket that is accepted after all steps, where rounding in the curve hides its root; chosen.
NOISE_TOLERANCE = 1e-11
# From so many targets on, a start between the curve's nodes, which saves three Newton steps of seven, costs less than
# these steps; chosen.
MANY = 1024
# A position u beside the start of a piece at which a curve has a value and a slope; chosen.
_BESIDE = 1e-6
# Least excess over a flat end, relative to its radius, of which a rounded radius still tells four digits.
LEAST_EXCESS = 1e-12
# Radii, beside the profile's nodes, at which the largest error is looked for: errors change from panel to panel.
_SAMPLES = 96


@dataclass(frozen=True, kw_only=True, eq=False)
class EquivalentSystem:
    """Springs and profile of one layer and indenter, for contact radii up to `max_radius`.

    All methods take arrays of any shape [m, N] and answer in SI units; asked outside their range they raise
    `InvalidInput`.

    Attributes:
        contact_modulus: E* [Pa].
        length_unit: Length [m] in which the fields below count: the thickness of the layer, or of a stack's first
            sublayer, or a radius on the half-space.
        flat_radius: b [m], where the profile begins to rise.
        max_radius: Largest contact radius [m] that is covered.
        flat_punch: Normalised stiffness of layer and springs, Eq. (10).
        profile: g over the excess x - b, both in units of length_unit.
        moment: 2 int_0^x c_bar g dx over the excess x - b, lengths in units of length_unit.
        position_rounding: Relative error of g by rounded positions, at radii [m].
        profile_error: Relative error of g and of the moment at fitted radii, beyond those of flat-punch data and grid.
        variants: Systems made of coarser flat-punch tables, each with the share of its difference that counts as an
            error (`table_errors`); none with other flat-punch data.
        load: The half-space's g over the excess x - b, where contacts within the largest may use its pieces.
    """

    contact_modulus: float
    length_unit: float
    flat_radius: float
    max_radius: float
    flat_punch: FlatPunchSolution
    profile: MappedFunction
    moment: MappedFunction
    profile_error: float = 0.0
    position_rounding: Callable[[FloatArray], FloatArray] = np.zeros_like
    variants: tuple[tuple[float, EquivalentSystem], ...] = ()
    load: MappedFunction | None = None

    def spring_stiffness(self, x: ArrayLike) -> FloatArray:
        """c_N(x; h) [Pa], Eq. (6)."""
        stiffness: FloatArray = self.contact_modulus * self.flat_punch.normalized_spring_stiffness(self._ratio(x))
        return stiffness

    def contact_stiffness(self, contact_radius: ArrayLike) -> FloatArray:
        """k_N(a; h) = 2 int_0^a c_N dx [N/m], Eqs. (5) and (10)."""
        a = np.asarray(contact_radius, dtype=float)
        stiffness: FloatArray = (
            2 * self.contact_modulus * a * self.flat_punch.normalized_contact_stiffness(self._ratio(a))
        )
        return stiffness

    def mdr_profile(self, x: ArrayLike) -> FloatArray:
        """g(x; h) [m], zero within the flat radius."""
        return self.profile_beyond(np.asarray(x, dtype=float) - self.flat_radius)

    def mdr_profile_slope(self, x: ArrayLike) -> FloatArray:
        """dg/dx [-], infinite at a flat end with a sharp rim."""
        excess = np.asarray(x, dtype=float) - self.flat_radius
        return np.where(excess >= 0, self.profile.derivative(self._beyond(excess)), 0.0)

    def profile_beyond(self, excess: FloatArray) -> FloatArray:
        """g [m] at an excess x - b [m] over the flat radius, which says more than the rounded x close to it."""
        inside = self._beyond(excess)
        return np.where(inside > 0, self.length_unit * self.profile(inside), 0.0)

    def profile_moment(self, contact_radius: ArrayLike) -> FloatArray:
        """2 int_0^a c_N g dx [N]: what the profile takes away from the force of a flat punch, Eq. (4)."""
        return self.moment_beyond(np.asarray(contact_radius, dtype=float) - self.flat_radius)

    def moment_beyond(self, excess: FloatArray) -> FloatArray:
        """The same at an excess a - b [m]."""
        inside = self._beyond(excess)
        return np.where(inside > 0, self._force_unit * self.moment(inside), 0.0)

    def force(
        self, contact_radius: ArrayLike, indentation_depth: ArrayLike, stiffness: FloatArray | None = None
    ) -> FloatArray:
        """F_N [N] of springs within a under a depth delta that need not belong to a (adhesion), Eq. (4).

        Args:
            contact_radius: a [m].
            indentation_depth: delta [m].
            stiffness: k_N(a) [N/m], where it is known already.
        """
        k_N = self.contact_stiffness(contact_radius) if stiffness is None else stiffness
        force: FloatArray = k_N * np.asarray(indentation_depth) - self.profile_moment(contact_radius)
        return force

    def elastic_force(self, contact_radius: ArrayLike) -> FloatArray:
        """F_N [N] of the non-adhesive contact with this radius, Eqs. (3) and (4)."""
        return self.force(contact_radius, self.mdr_profile(contact_radius))

    def excess_at_depth(self, indentation_depth: ArrayLike) -> FloatArray:
        """a - b [m] with g(a) = delta, Eq. (3); 0 <= delta <= g(max_radius)."""
        depth = np.asarray(indentation_depth, dtype=float) / self.length_unit
        curve = _Curve(self.profile.at, self.profile.with_slope_at, self.profile.lead)
        return self._invert(depth, curve, "indentation_depth", self.length_unit)

    def excess_at_force(self, normal_force: ArrayLike) -> FloatArray:
        """a - b [m] of the elastic contact with this force F_N; 0 <= F_N <= elastic_force(max_radius)."""
        force = np.asarray(normal_force, dtype=float) / self._force_unit
        lead = self.profile.lead + (0.0 if self.flat_radius else float(self.profile.grid.power[0]))
        return self._invert(
            force, _Curve(self._force_at, self._force_with_slope_at, lead), "normal_force", self._force_unit
        )

    @cached_property
    def seams(self) -> FloatArray:
        """Radii [m] at which polynomials of springs and profile change, where they may jump by their errors."""
        pieces = self.flat_radius / self.length_unit + self.profile.grid.left[1:]
        return self.length_unit * np.sort(np.append(pieces, apart(self.flat_punch.panel_ends(self._last), pieces)))

    @cached_property
    def relative_error(self) -> Mapping[str, float]:
        """The largest of `relative_errors` at all radii up to `max_radius`."""
        beyond = self.flat_radius + self.length_unit * self.profile.grid.nodes.ravel()
        radii = np.append(
            self.max_radius * np.arange(1.0, _SAMPLES + 1.0) / _SAMPLES, np.minimum(beyond, self.max_radius)
        )
        return {name: float(values.max()) for name, values in self.relative_errors(radii).items()}

    def relative_errors(self, contact_radius: FloatArray, *, of_springs: bool = True) -> dict[str, FloatArray]:
        """Bounds of the relative errors of an elastic contact's quantities, and if asked for of c_N, at each radius."""
        ratio = self._ratio(contact_radius)
        stiffness = self.flat_punch.relative_error(ratio) + SPRING_ROUNDING
        data = (
            self.flat_punch.error_of_profile(ratio, self.profile, self.flat_radius / self.length_unit) + SPRING_ROUNDING
        )
        # Within the flat end g is zero.
        data = np.where(np.asarray(contact_radius) >= self.flat_radius, data, SPRING_ROUNDING)
        own = self.profile_truncation(contact_radius) + self.position_rounding(np.asarray(contact_radius))
        depth = data + np.where(ratio > self.flat_punch.fitted_from, self.profile_error, 0.0) + own
        # That of the radius holds where depth or force are prescribed, since g rises at least about linearly.
        found = {
            "contact_radius": depth,
            "indentation_depth": depth,
            "normal_force": depth + stiffness,
            "contact_stiffness": stiffness,
        }
        return (
            found | {"spring_stiffness": self.flat_punch.spring_error(ratio) + SPRING_ROUNDING} if of_springs else found
        )

    def error_in_force(self, contact_radius: FloatArray, **known: FloatArray) -> FloatArray:
        """Relative error of F = int k_N dg from the errors of k_N, at the edge and before."""
        flat = self.flat_radius / self.length_unit
        return self.flat_punch.error_in_force(self._ratio(contact_radius), self.profile, flat, **known)

    def error_at_depth(self, contact_radius: FloatArray, **errors: FloatArray) -> FloatArray:
        """Relative error of F under a given depth, from those of k_N and g as the flat-punch data take them."""
        flat = self.flat_radius / self.length_unit
        return self.flat_punch.error_at_depth(self._ratio(contact_radius), self.profile, flat, **errors)

    def kernel_errors(self, contact_radius: FloatArray) -> FloatArray:
        """What of the relative errors of c_N and g comes from one wrong kernel, shape (2, n)."""
        return self.flat_punch.kernel_errors(self._ratio(contact_radius))

    def error_steepness(self, contact_radius: FloatArray) -> FloatArray:
        """How fast relative errors of flat-punch data change with the radius at most [1/m]."""
        return self.flat_punch.error_steepness(self._ratio(contact_radius)) / self.length_unit

    def profile_truncation(self, contact_radius: FloatArray) -> FloatArray:
        """What the polynomials of g leave out at each radius, relative to it."""
        return self.profile.relative_error(self._beyond(contact_radius - self.flat_radius))

    def moment_truncation(self, contact_radius: FloatArray) -> FloatArray:
        """The same of the moment 2 int c_N g, relative to it."""
        return self.moment.relative_error(self._beyond(contact_radius - self.flat_radius))

    @property
    def _force_unit(self) -> float:
        return self.contact_modulus * self.length_unit**2

    def _ratio(self, x: ArrayLike) -> FloatArray:
        x = np.asarray(x, dtype=float)
        covered = (x >= 0) & (x <= self.max_radius * (1 + SPRING_ROUNDING))
        if not np.all(covered):
            worst = x[~covered].flat[0]
            raise InvalidInput(f"radius = {worst:g} m: this equivalent system covers [0, {self.max_radius:g}] m")
        ratio: FloatArray = np.minimum(x, self.max_radius) / self.length_unit
        return ratio

    def _beyond(self, excess: FloatArray) -> FloatArray:
        """The excess in units of length_unit, zero within the flat radius."""
        self._ratio(self.flat_radius + excess)
        return np.maximum(excess / self.length_unit, 0.0)

    def _position(self, piece: NDArray[np.intp], u: FloatArray) -> FloatArray:
        """x in units of length_unit."""
        grid = self.profile.grid
        return self.flat_radius / self.length_unit + grid.left[piece] + grid.width[piece] * u ** grid.power[piece]

    def _force_at(self, piece: NDArray[np.intp], u: FloatArray) -> FloatArray:
        return self._force_with_slope_at(piece, u)[0]

    def _force_with_slope_at(self, piece: NDArray[np.intp], u: FloatArray) -> tuple[FloatArray, FloatArray]:
        """F and its derivative by u: dF = k_N dg, Eq. (5)."""
        x, (g, g_u) = self._position(piece, u), self.profile.with_slope_at(piece, u)
        stiffness = 2 * x * self.flat_punch.normalized_contact_stiffness(np.minimum(x, self._last))
        return stiffness * g - self.moment.at(piece, u), stiffness * g_u

    @property
    def _last(self) -> float:
        return self.max_radius / self.length_unit

    def _invert(self, target: FloatArray, curve: _Curve, name: str, unit: float) -> FloatArray:
        """Excess [m] over the flat radius where an increasing curve takes the target value."""
        grid = self.profile.grid
        pieces = np.arange(len(grid.left))
        ends = curve.value(pieces, np.ones(pieces.size))
        covered = (target >= 0) & (target <= ends[-1] * (1 + SPRING_ROUNDING))
        if not np.all(covered):
            worst = target[~covered].flat[0] * unit
            raise InvalidInput(f"{name} = {worst:g}: this equivalent system covers [0, {ends[-1] * unit:g}]")
        piece = np.minimum(np.searchsorted(ends, target), pieces.size - 1)
        before = np.append(0.0, ends)[piece]
        share = np.clip((target - before) / (ends[piece] - before), 0.0, 1.0)
        start = share ** np.where(piece == 0, 1 / max(curve.lead, 1.0), 1.0)
        if target.size >= MANY:
            start = _between_nodes(curve, grid, piece, target)
        u = _safeguarded_newton(curve, piece, target, start)
        return self.length_unit * (grid.left[piece] + grid.width[piece] * u ** grid.power[piece])


def _between_nodes(curve: _Curve, grid: MappedGrid, piece: NDArray[np.intp], target: FloatArray) -> FloatArray:
    """Positions u by inverse cubics between a curve's values and slopes, to the power with which it begins.

    The values are those at all nodes and at the ends of the pieces, or close beside their starts.
    """
    u = np.concatenate([[_BESIDE], gauss_nodes(grid.count)[0], [1.0]])
    number = np.repeat(np.arange(len(grid.left)), u.size)
    value, slope = curve.with_slope(number, np.tile(u, len(grid.left)))
    power = 1.0 / max(curve.lead, 1.0)
    w, place = np.maximum.accumulate(value**power), number + np.tile(u, len(grid.left))
    inverse = np.divide(value ** (1.0 - power), power * slope, out=np.zeros_like(w), where=slope > 0.0)
    i = np.clip(w.searchsorted(target**power) - 1, 0, w.size - 2)
    h, way = w[i + 1] - w[i], place[i + 1] - place[i]
    share = np.divide(target**power - w[i], h, out=np.zeros_like(h), where=h > 0.0)
    first, last = h * inverse[i], h * inverse[i + 1]
    cubic = share * (first + share * (3.0 * way - 2.0 * first - last + share * (first + last - 2.0 * way)))
    return np.asarray(np.clip(place[i] + cubic - piece, 0.0, 1.0))


@dataclass(frozen=True)
class _Curve:
    """An increasing function of the position u in a piece, with its slope by u, and the power of u it begins with."""

    value: Callable[[NDArray[np.intp], FloatArray], FloatArray]
    with_slope: Callable[[NDArray[np.intp], FloatArray], tuple[FloatArray, FloatArray]]
    lead: float


def _safeguarded_newton(curve: _Curve, piece: NDArray[np.intp], target: FloatArray, start: FloatArray) -> FloatArray:
    """Positions u in [0, 1] where the curve takes its targets; a Newton step that leaves its bracket is bisected.

    In the first piece u is found to rounding relative to itself, in the others relative to the piece.
    """
    low, high, u = np.zeros_like(start), np.ones_like(start), start
    size = np.where(piece > 0, 1.0, 0.0)
    for _ in range(MOST_STEPS):
        value, slope = curve.with_slope(piece, u)
        residual = value - target
        low, high = np.where(residual <= 0, u, low), np.where(residual >= 0, u, high)
        step = u - np.divide(residual, slope, out=np.full_like(u, np.inf), where=slope > 0)
        new = np.where((step >= low) & (step <= high), step, (low + high) / 2)
        if np.all(np.minimum(np.abs(new - u), high - low) <= NEWTON_TOLERANCE * np.maximum(u, size)):
            return new
        u = new
    left = np.max(np.minimum(np.abs(new - u), high - low) / np.maximum(u, np.maximum(size, np.finfo(float).tiny)))
    if left > NOISE_TOLERANCE:
        raise NotConvergedError("contact radius not found", {"relative bracket": float(left)})
    return u
