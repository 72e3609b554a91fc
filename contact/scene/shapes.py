"""Rigid indenters that are no bodies of revolution, symmetric about phi = 0.

`Raised` shapes have the height f(r, phi) = f_0(r) + sum_n f_n(r) cos(n phi) with f(0) = 0, `Flat` ones the outline
a(phi).
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Annotated, Any, Literal, Never

import numpy as np
from numpy.typing import ArrayLike
from pydantic import BeforeValidator, Field, model_validator

from contact.records.errors import UnsupportedSceneError
from contact.records.record import OneOf, Record
from contact.records.validation import FloatArray, PositiveLength, number
from contact.scene.profiles import PROFILES, Cone, FlatPunch, Paraboloid, Pointed, Profile, Slope, Sloped

# Largest order n of harmonics. The force of a square pyramid changes by 1e-4 with half of it, of a punch by 5e-4.
LARGEST_ORDER = 16
# Gauss nodes between two corners of a shape. With half as many the order 16 is wrong, twice as many change nothing.
_NODES = 24
_T, _W = np.polynomial.legendre.leggauss(_NODES)


class Shape(Profile, ABC):
    """An indenter whose height or outline depends on the direction phi [rad].

    Its height at a radius without a direction is refused, so that no method solves it as a body of revolution.
    """

    @property
    @abstractmethod
    def mean(self) -> Profile:
        """The body of revolution with the height, or the outline, averaged over phi."""

    @property
    @abstractmethod
    def symmetry(self) -> int:
        """Number m of equal sectors: the period of the shape in phi is 2 pi / m."""

    @property
    def orders(self) -> tuple[int, ...]:
        """Orders n >= 2 of the harmonics cos(n phi) that are not zero, up to `LARGEST_ORDER`."""
        return tuple(range(self.symmetry, LARGEST_ORDER + 1, self.symmetry))

    @property
    def corners(self) -> tuple[float, ...]:
        """Directions [rad] in half a sector where the shape is not analytic."""
        return ()

    @property
    def substitute(self) -> Profile:
        """Body of revolution that messages recommend instead of the shape."""
        return self.mean

    @abstractmethod
    def polar(self, radius: ArrayLike, angle: ArrayLike) -> FloatArray:
        """Height f(r, phi) [m] at radii [m] and directions [rad] that broadcast; infinite outside a flat punch."""

    def sector(self) -> tuple[FloatArray, FloatArray]:
        """Directions [rad] in half a sector and weights of the average over phi, shape (n,)."""
        ends = np.array([0.0, *self.corners, math.pi / self.symmetry])
        width = np.diff(ends)[:, None]
        return (ends[:-1, None] + width * (1.0 + _T) / 2.0).ravel(), (width * _W / (2.0 * ends[-1])).ravel()

    def height(self, radius: ArrayLike) -> FloatArray:
        """Raise UnsupportedSceneError: the height depends on the direction, see `polar`."""
        self._refuse()

    def slope_at(self, radius: ArrayLike) -> FloatArray:
        """Raise UnsupportedSceneError: the slope depends on the direction."""
        self._refuse()

    def _refuse(self) -> Never:
        """Raise the error of a height without a direction."""
        name = type(self).__name__
        raise UnsupportedSceneError(f"indenter = {name}: its height depends on the direction; {self.instead}")

    @property
    def instead(self) -> str:
        """Remedy in messages of methods that do not model the shape."""
        fields = ", ".join(f"{k}={v:.6g}" for k, v in vars(self.substitute).items() if isinstance(v, float))
        return f"take {type(self.substitute).__name__}({fields}) in its place, or leave out what is not modelled"

    @property
    def flat_radius(self) -> float:
        """Radius [m] of the flat end of the mean."""
        return self.mean.flat_radius


class Raised(Shape):
    """A shape whose height depends on radius and direction."""

    @abstractmethod
    def polar_slope(self, radius: ArrayLike, angle: ArrayLike) -> FloatArray:
        """Slope df/dr [-] at radii [m] and directions [rad] that broadcast."""

    def harmonic(self, orders: Sequence[int], radius: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Harmonics f_n [m] and df_n/dr [-] of p orders at radii [m], shape (.., p); f_0 is the average over phi."""
        (angle, weight), n = self.sector(), np.array(orders)
        share = np.where(n == 0, 1.0, 2.0) * weight[:, None] * np.cos(np.multiply.outer(angle, n))
        return self.polar(radius[..., None], angle) @ share, self.polar_slope(radius[..., None], angle) @ share


class Flat(Shape):
    """A flat punch whose outline is no circle."""

    @abstractmethod
    def outline(self, angle: ArrayLike) -> FloatArray:
        """Outline a(phi) [m] in directions [rad]."""

    @cached_property
    def mean(self) -> FlatPunch:
        """The round punch whose radius is the mean of the outline."""
        angle, weight = self.sector()
        return FlatPunch(radius=float(weight @ self.outline(angle)))

    def polar(self, radius: ArrayLike, angle: ArrayLike) -> FloatArray:
        """Height f [m]: zero within the outline, infinite outside."""
        return np.where(np.asarray(radius) <= self.outline(angle), 0.0, np.inf)


class EllipticParaboloid(Raised):
    """Elliptic paraboloid f = x^2/(2 R_1) + y^2/(2 R_2) = r^2 [cos^2(phi)/R_1 + sin^2(phi)/R_2]/2.

    Attributes:
        first_radius: Radius of curvature R_1 [m] in the plane y = 0.
        second_radius: Radius of curvature R_2 [m] in the plane x = 0.
    """

    first_radius: PositiveLength
    second_radius: PositiveLength

    symmetry, orders = 2, (2,)

    @property
    def mean(self) -> Paraboloid:
        """The paraboloid of the mean curvature."""
        return Paraboloid(radius_of_curvature=2.0 / (1.0 / self.first_radius + 1.0 / self.second_radius))

    def polar(self, radius: ArrayLike, angle: ArrayLike) -> FloatArray:
        """Height f [m]."""
        return np.asarray(radius) * self.polar_slope(radius, angle) / 2.0

    def polar_slope(self, radius: ArrayLike, angle: ArrayLike) -> FloatArray:
        """Slope df/dr [-]."""
        curvature = np.cos(angle) ** 2 / self.first_radius + np.sin(angle) ** 2 / self.second_radius
        return np.asarray(np.asarray(radius) * curvature)


class Pyramid(Sloped, Raised):
    """A regular pyramid, f = slope r cos(phi) over the middle half of a face; the edges of its faces are sharp.

    With a tip of radius R the profile in each direction is a sphere up to the point where the flank is tangent to it.

    Attributes:
        slope: Tangent of the angle between a face and the surface [-].
        sides: Number of faces, 3 or 4.
        tip_radius: Radius R [m] of the blunt tip; None for a sharp tip.
    """

    slope: Slope
    sides: Literal[3, 4] = 4
    tip_radius: PositiveLength | None = None

    @property
    def symmetry(self) -> int:
        """One sector per face."""
        return self.sides

    @cached_property
    def mean(self) -> Profile:
        """Mean profile over phi: a cone if the tip is sharp, else by quadrature."""
        if self.tip_radius is not None:
            return Averaged(shape=self)
        return Cone(slope=self.slope * self.sides / math.pi * math.sin(math.pi / self.sides))

    @property
    def substitute(self) -> Profile:
        """The customary cone of equal cross-sections."""
        return Cone(slope=self.slope / math.sqrt(self.sides / math.pi * math.tan(math.pi / self.sides)))

    def polar(self, radius: ArrayLike, angle: ArrayLike) -> FloatArray:
        """Height f [m]: R (1 - cos(t)) = R sin(t) tan(t/2) on the sphere, then straight."""
        slope, t = self._rays(radius, angle)
        b = (self.tip_radius or 0.0) * np.sin(t)
        return np.asarray(b * np.tan(t / 2.0) + slope * (np.asarray(radius) - b))

    def polar_slope(self, radius: ArrayLike, angle: ArrayLike) -> FloatArray:
        """Slope df/dr [-]."""
        return np.asarray(np.tan(self._rays(radius, angle)[1]))

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Smallest and largest radius [m] at which the sphere ends in some direction."""
        _, t = self._rays(math.inf, np.array([math.pi / self.sides, 0.0]))
        return tuple((self.tip_radius * np.sin(t)).tolist()) if self.tip_radius else ()

    def _rays(self, radius: ArrayLike, angle: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Slope of the flank in a direction, and the inclination t [rad] of the profile there at a radius [m]."""
        sector = 2.0 * math.pi / self.sides
        slope = self.slope * np.cos(np.asarray(angle) - sector * np.round(np.asarray(angle) / sector))
        sine = np.minimum(np.asarray(radius) / (self.tip_radius or 1e-300), 1.0)
        return slope, np.minimum(np.arcsin(sine), np.arctan(slope))


class Averaged(Pointed):
    """Mean profile f_0(r) of a shape, by quadrature over phi.

    Attributes:
        shape: Shape that is averaged.
    """

    shape: Pyramid

    def height(self, radius: ArrayLike) -> FloatArray:
        """Height f_0 [m]."""
        return self.shape.harmonic((0,), np.asarray(radius, dtype=np.float64))[0][..., 0]

    def slope_at(self, radius: ArrayLike) -> FloatArray:
        """Slope df_0/dr [-]."""
        return self.shape.harmonic((0,), np.asarray(radius, dtype=np.float64))[1][..., 0]

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Breakpoints of the shape [m]."""
        return self.shape.breakpoints

    is_convex = True  # as in every direction


class Harmonic(Record):
    """One term share f(r) cos(n phi) of `Harmonics`.

    Attributes:
        order: Order n >= 2. The order 1 is a shift or tilt: move the axis there.
        share: Factor of f [-], of either sign.
        profile: Profile f; None for the mean profile.
    """

    order: Annotated[int, Field(ge=2, le=LARGEST_ORDER)]
    share: Annotated[float, *number("give the factor of the term", low=-math.inf)]
    profile: Annotated[Profile, OneOf(*PROFILES)] | None = None


def _terms(given: Any) -> Any:
    """Terms from a mapping {n: share} or {n: profile}; other input is returned unchanged."""
    if not isinstance(given, Mapping):
        return tuple(given) if isinstance(given, list) else given
    return tuple(
        Harmonic(order=order, share=1.0, profile=term)
        if isinstance(term, Profile)
        else Harmonic(order=order, share=term)
        for order, term in given.items()
    )


class Harmonics(Raised):
    """Shape f = f_0(r) + sum_n share_n f_n(r) cos(n phi).

    Attributes:
        profile: Profile f_0.
        terms: Terms, as a list of `Harmonic`; in Python also {n: share} or {n: profile}.
    """

    profile: Annotated[Profile, OneOf(*PROFILES)]
    terms: Annotated[tuple[Harmonic, ...], BeforeValidator(_terms)]

    @model_validator(mode="after")
    def _check(self) -> Harmonics:
        if isinstance(self.profile, FlatPunch | Shape) or self.profile.flat_radius:
            raise ValueError("profile: must be a profile of revolution without a flat end")
        if not self.terms or len(set(self.orders)) < len(self.terms):
            raise ValueError("terms: give at least one term, and each order once")
        return self

    @property
    def symmetry(self) -> int:
        """Greatest common divisor of the orders."""
        return math.gcd(*self.orders)

    @property
    def orders(self) -> tuple[int, ...]:
        """Orders of the terms."""
        return tuple(term.order for term in self.terms)

    @property
    def mean(self) -> Profile:
        """The profile f_0."""
        return self.profile

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Breakpoints of all profiles [m]."""
        return tuple(sorted({b for profile in (self.profile, *map(self._of, self.terms)) for b in profile.breakpoints}))

    def polar(self, radius: ArrayLike, angle: ArrayLike) -> FloatArray:
        """Height f [m]."""
        rest = (t.share * self._of(t).height(radius) * np.cos(t.order * np.asarray(angle)) for t in self.terms)
        return np.asarray(self.profile.height(radius) + sum(rest))

    def polar_slope(self, radius: ArrayLike, angle: ArrayLike) -> FloatArray:
        """Slope df/dr [-]."""
        rest = (t.share * self._of(t).slope_at(radius) * np.cos(t.order * np.asarray(angle)) for t in self.terms)
        return np.asarray(self.profile.slope_at(radius) + sum(rest))

    def _of(self, term: Harmonic) -> Profile:
        """Profile f_n of a term."""
        return self.profile if term.profile is None else term.profile


class PolygonalPunch(Flat):
    """A flat punch whose outline is a regular polygon with rounded corners; phi = 0 is the middle of a side.

    Attributes:
        sides: Number of sides, 3 to 12.
        inscribed_radius: Distance [m] of the sides from the axis: half the side of a square.
        corner_radius: Radius [m] of the corners, at most `inscribed_radius`; None for sharp corners.
    """

    inscribed_radius: PositiveLength
    sides: Annotated[int, Field(ge=3, le=12)] = 4
    corner_radius: PositiveLength | None = None

    @model_validator(mode="after")
    def _check(self) -> PolygonalPunch:
        if self._rounding > self.inscribed_radius:
            raise ValueError(f"corner_radius = {self._rounding:g}: must be at most inscribed_radius")
        return self

    @property
    def _rounding(self) -> float:
        """Radius [m] of the corners; zero for sharp corners."""
        return self.corner_radius or 0.0

    @property
    def symmetry(self) -> int:
        """One sector per side."""
        return self.sides

    @property
    def corners(self) -> tuple[float, ...]:
        """Direction where a side ends [rad]."""
        straight = (self.inscribed_radius - self._rounding) * math.tan(math.pi / self.sides)
        end = math.atan2(straight, self.inscribed_radius)
        return (end,) if 0.0 < self._rounding < self.inscribed_radius else ()

    def outline(self, angle: ArrayLike) -> FloatArray:
        """Outline a(phi) [m]: a side, or the circle about the centre of a corner."""
        half = math.pi / self.sides
        phi = np.abs(np.asarray(angle) - 2.0 * half * np.round(np.asarray(angle) / (2.0 * half)))
        centre, c = (self.inscribed_radius - self._rounding) / math.cos(half), self._rounding
        sine = centre * np.sin(half - phi)
        round_part = centre * np.cos(half - phi) + np.sqrt(np.maximum((c - sine) * (c + sine), 0.0))
        end = math.atan2((self.inscribed_radius - c) * math.tan(half), self.inscribed_radius)
        return np.where(phi <= end, self.inscribed_radius / np.cos(phi), round_part)


class EllipticPunch(Flat):
    """A flat punch with an elliptic outline.

    Attributes:
        first_half_axis: Half axis A [m], along phi = 0.
        second_half_axis: Half axis B [m].
    """

    first_half_axis: PositiveLength
    second_half_axis: PositiveLength

    symmetry = 2

    def outline(self, angle: ArrayLike) -> FloatArray:
        """Outline a(phi) = A B/sqrt(B^2 cos^2(phi) + A^2 sin^2(phi)) [m]."""
        A, B = self.first_half_axis, self.second_half_axis
        return np.asarray(A * B / np.hypot(B * np.cos(angle), A * np.sin(angle)))


SHAPES: tuple[type[Shape], ...] = (EllipticParaboloid, Pyramid, Harmonics, PolygonalPunch, EllipticPunch)
