"""Rigid indenters: profiles of revolution z = f(r) with f(0) = 0, measured from the tip.

Each profile is one class, with height and slope at any radius, the radii where the slope jumps (`kinks`) or the profile
is not analytic (`breakpoints`, kinks included), the radius of its flat end and the radius where it ends.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike
from pydantic import ValidationInfo, model_validator

from contact.records.errors import InvalidInput, refused, shown
from contact.records.record import Record
from contact.records.units import in_si
from contact.records.validation import (
    FloatArray,
    PositiveLength,
    Reading,
    Vector,
    in_range,
    positive,
    read_number,
    vector,
)

if TYPE_CHECKING:
    from scipy.interpolate import PchipInterpolator

# Range of half angles [rad], from a needle to a plane.
_NARROWEST, _WIDEST = 1e-3, math.pi / 2 - 1e-6
# Fewest points that are smoothed: twice those of a cubic spline, else there is nothing to average.
_FEWEST_TO_SMOOTH = 8


class Profile(Record, ABC):
    """Base of all indenters of revolution. Radii r [m] may be arrays of any shape."""

    NAMED = True
    UPRIGHT_END: ClassVar[str] = "the indenter is upright there"
    """Reason in the message for a radius where the slope is infinite."""

    @abstractmethod
    def height(self, radius: ArrayLike) -> FloatArray:
        """Height f(r) [m] at radii [m], infinite beyond `max_radius`."""

    @abstractmethod
    def slope_at(self, radius: ArrayLike) -> FloatArray:
        """Slope f'(r) [-] at radii [m]; at a kink the value from outside."""

    @property
    def kinks(self) -> tuple[float, ...]:
        """Radii > 0 [m] where the slope jumps."""
        return ()

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Radii > 0 [m] where the profile is not analytic; kinks included."""
        return self.kinks

    @property
    def max_radius(self) -> float:
        """Radius [m] where the profile ends; infinite without an end."""
        return math.inf

    @property
    def ends_upright(self) -> bool:
        """Whether the slope is infinite where the profile ends; the depth of a contact up to there is infinite."""
        return math.isfinite(self.max_radius) and not np.isfinite(self.slope_at(self.max_radius))

    @property
    def is_convex(self) -> bool:
        """Whether f' never decreases; then the indenter cannot touch outside its circle of contact (`one_circle`)."""
        return isinstance(self, CONVEX)

    # At run time a property here would hide the fields of that name below.
    if TYPE_CHECKING:

        @property
        def flat_radius(self) -> float:
            """Radius [m] of the flat end; zero for a profile with a pointed or rounded tip."""


Slope = Annotated[float, *positive("the slope is the tangent of the angle between flank and surface")]


class Sloped(Profile):
    """A profile with a straight flank. Files may have the half angle, from axis to flank, instead of the slope."""

    SHORTHANDS: ClassVar[Mapping[str, Any]] = {
        "half_angle": {"type": "string", "description": 'from the axis to the flank, as in "35 deg"'}
    }
    REPLACED: ClassVar[Mapping[str, str]] = {"slope": "half_angle"}

    @model_validator(mode="before")
    @classmethod
    def _half_angle(cls, given: Any) -> Any:
        """A table with slope = 1/tan(half angle) from one with a half angle."""
        if not isinstance(given, Mapping) or "half_angle" not in given:
            return given
        if "slope" in given:
            raise refused(f"slope = {shown(given['slope'])}: follows from half_angle; drop one of the two")
        written = given["half_angle"]
        try:
            angle = in_si(written, "rad")
        except InvalidInput as error:
            raise refused(f"half_angle = {shown(written)}: {error}") from None
        if angle is written:
            wrong = 'must be an angle with its unit, from the axis to the flank, as in "35 deg"'
            raise refused(f"half_angle = {shown(written)}: {wrong}")
        if not _NARROWEST <= angle <= _WIDEST:
            raise refused(f"half_angle = {shown(written)}: must lie between 0 and 90 degrees")
        rest = {name: value for name, value in given.items() if name not in ("half_angle", "kind")}
        return rest | {"slope": 1.0 / math.tan(angle)}


class Pointed(Profile):
    """A profile without a flat end."""

    flat_radius = 0.0


class FlatPunch(Profile):
    """A flat-ended cylinder; its radius is the contact radius.

    Attributes:
        radius: Radius a [m].
    """

    radius: PositiveLength

    def height(self, radius: ArrayLike) -> FloatArray:
        return np.where(np.asarray(radius) <= self.radius, 0.0, np.inf)

    def slope_at(self, radius: ArrayLike) -> FloatArray:
        return np.where(np.asarray(radius) <= self.radius, 0.0, np.inf)

    @property
    def flat_radius(self) -> float:
        return self.radius

    @property
    def max_radius(self) -> float:
        return self.radius


class Paraboloid(Pointed):
    """Paraboloid f(r) = r^2 / (2 R).

    Attributes:
        radius_of_curvature: Radius of curvature R [m].
    """

    radius_of_curvature: PositiveLength

    def height(self, radius: ArrayLike) -> FloatArray:
        return np.asarray(radius, dtype=np.float64) ** 2 / (2.0 * self.radius_of_curvature)

    def slope_at(self, radius: ArrayLike) -> FloatArray:
        return np.asarray(radius, dtype=np.float64) / self.radius_of_curvature


class Sphere(Pointed):
    """The exact sphere, f(r) = R - sqrt(R^2 - r^2); a paraboloid for r << R.

    Attributes:
        radius: Radius R [m].
    """

    UPRIGHT_END = "the sphere has sunk to its equator"

    radius: PositiveLength

    def height(self, radius: ArrayLike) -> FloatArray:
        r = np.asarray(radius, dtype=np.float64)
        return np.where(r <= self.radius, r**2 / (self.radius + self._depth_of_cap(r)), np.inf)  # no cancellation

    def slope_at(self, radius: ArrayLike) -> FloatArray:
        r = np.asarray(radius, dtype=np.float64)
        below = self._depth_of_cap(r)
        return np.asarray(np.divide(r, below, out=np.full(r.shape, np.inf), where=below > 0.0))

    def _depth_of_cap(self, r: FloatArray) -> FloatArray:
        """sqrt(R^2 - r^2), factored so that it keeps its digits near the equator; zero beyond."""
        return np.sqrt(np.maximum((self.radius - r) * (self.radius + r), 0.0))

    @property
    def max_radius(self) -> float:
        return self.radius


class Cone(Sloped, Pointed):
    """Cone f(r) = slope r.

    Attributes:
        slope: Slope tan(theta) [-], theta the angle between the cone's flank and the surface.
    """

    slope: Slope

    def height(self, radius: ArrayLike) -> FloatArray:
        return self.slope * np.asarray(radius, dtype=np.float64)

    def slope_at(self, radius: ArrayLike) -> FloatArray:
        return np.full(np.shape(radius), self.slope)


class Spheroconical(Sloped, Pointed):
    """A cone with a spherical tip: f is that of the sphere up to b = R sin(theta), then straight with its slope there.

    Attributes:
        radius: Radius R [m] of the sphere.
        slope: Slope tan(theta) [-], theta the angle between the cone's flank and the surface.
    """

    radius: PositiveLength
    slope: Slope

    def height(self, radius: ArrayLike) -> FloatArray:
        r, b = np.asarray(radius, dtype=np.float64), self.tangent_radius
        return self._cap.height(np.minimum(r, b)) + self.slope * np.maximum(r - b, 0.0)

    def slope_at(self, radius: ArrayLike) -> FloatArray:
        r, b = np.asarray(radius, dtype=np.float64), self.tangent_radius
        return np.where(r < b, self._cap.slope_at(np.minimum(r, b)), self.slope)

    @property
    def tangent_radius(self) -> float:
        """Radius b [m] where sphere and cone meet with equal slope."""
        return self.radius * self.slope / math.hypot(1.0, self.slope)

    @property
    def breakpoints(self) -> tuple[float, ...]:
        return (self.tangent_radius,)

    @cached_property
    def _cap(self) -> Sphere:
        return Sphere(radius=self.radius)


class Truncated(Profile):
    """A profile that is flat up to b, where its slope jumps."""

    @property
    def kinks(self) -> tuple[float, ...]:
        return (self.flat_radius,)


class TruncatedCone(Sloped, Truncated):
    """Truncated cone of Eq. (35): flat up to b, then f(r) = slope (r - b).

    Attributes:
        flat_radius: Radius b [m] of the flat end.
        slope: Slope tan(theta) [-].
    """

    flat_radius: PositiveLength
    slope: Slope

    def height(self, radius: ArrayLike) -> FloatArray:
        return self.slope * np.maximum(np.asarray(radius, dtype=np.float64) - self.flat_radius, 0.0)

    def slope_at(self, radius: ArrayLike) -> FloatArray:
        return np.where(np.asarray(radius) >= self.flat_radius, self.slope, 0.0)


class TruncatedParaboloid(Truncated):
    """A worn paraboloid: flat up to b, then f(r) = (r^2 - b^2) / (2 R).

    Attributes:
        flat_radius: Radius b [m] of the flat end.
        radius_of_curvature: Radius of curvature R [m].
    """

    flat_radius: PositiveLength
    radius_of_curvature: PositiveLength

    def height(self, radius: ArrayLike) -> FloatArray:
        r, b = np.asarray(radius, dtype=np.float64), self.flat_radius
        return np.maximum((r - b) * (r + b), 0.0) / (2.0 * self.radius_of_curvature)

    def slope_at(self, radius: ArrayLike) -> FloatArray:
        r = np.asarray(radius, dtype=np.float64)
        return np.where(r >= self.flat_radius, r / self.radius_of_curvature, 0.0)


class PowerLaw(Pointed):
    """Power law f(r) = H (r / R)^n: a cone for n = 1, a paraboloid for n = 2; the tip is flatter for larger n.

    Attributes:
        exponent: Exponent n >= 1 [-].
        reference_radius: Reference radius R [m].
        reference_height: Height H [m] at r = R.
    """

    exponent: Annotated[float, *in_range(1.0, math.inf, "1 is a cone; a smaller exponent has an infinitely sharp tip")]
    reference_radius: PositiveLength
    reference_height: PositiveLength

    def height(self, radius: ArrayLike) -> FloatArray:
        rho = np.asarray(radius, dtype=np.float64) / self.reference_radius
        return np.asarray(self.reference_height * rho**self.exponent)

    def slope_at(self, radius: ArrayLike) -> FloatArray:
        rho = np.asarray(radius, dtype=np.float64) / self.reference_radius
        return np.asarray(self.reference_height / self.reference_radius * self.exponent * rho ** (self.exponent - 1.0))


class Tabulated(Pointed):
    """A measured profile, interpolated by shape-preserving cubics (PCHIP: no overshoot, continuous slope).

    Attributes:
        radii: Radii r [m], increasing from zero, shape (n,), n >= 3.
        heights: Heights f [m] at these radii, starting at zero, shape (n,).
        smoothing: Largest change [m] of a height by `smoothed`; None for measured heights.
    """

    SHORTHANDS: ClassVar[Mapping[str, Any]] = {
        "file": {"type": "string", "description": "CSV: radii, heights"},
        "unit": {"type": "string", "description": "of both columns, where the file names none"},
        "noise": {"type": ["number", "string"], "description": "of the heights, smoothed away"},
    }
    REPLACED: ClassVar[Mapping[str, str]] = {"radii": "file", "heights": "file"}

    radii: Annotated[Vector, *vector("give radii in metres from 0 on", "m", least=0.0, increasing=True)]
    heights: Annotated[Vector, *vector("give heights in metres, one for each radius", "m")]
    smoothing: Annotated[float, *in_range(0.0, math.inf, "leave it to Tabulated.smoothed", "m")] | None = None

    @model_validator(mode="wrap")
    @classmethod
    def _from_file(cls, given: Any, handler: Any, info: ValidationInfo) -> Any:
        """The profile of a table, with heights from a CSV file if it names one, smoothed if it has the noise."""
        if not isinstance(given, Mapping):
            return handler(given)
        table = dict(given)
        noise = table.pop("noise", None)
        if "file" in table:
            if twice := table.keys() & {"radii", "heights"}:
                raise refused(*(f"{name}: stands in the file already; drop one of the two" for name in sorted(twice)))
            source = {name: table.pop(name) for name in ("file", "unit") if name in table}
            table |= {name: source | {"column": i} for i, name in enumerate(("radii", "heights"))}
        made = handler(table)
        if noise is None:
            return made
        reading = info.context if isinstance(info.context, Reading) else None
        return made.smoothed(noise=read_number(noise, "give the noise of the heights in m", "m", reading))

    @model_validator(mode="after")
    def _check(self) -> Tabulated:
        if self.radii.shape != self.heights.shape or self.radii.size < 3:
            sizes = f"got {self.radii.size} radii and {self.heights.size} heights"
            raise ValueError(f"a table needs at least three radii and one height for each; {sizes}")
        if self.radii[0] != 0.0 or self.heights[0] != 0.0:
            start = f"({self.radii[0]:g}, {self.heights[0]:g})"
            raise ValueError(f"a table starts at the tip (0, 0), got {start}; shift it so that it does")
        return self

    def smoothed(self, *, noise: float) -> Tabulated:
        """Smoothest cubic spline whose root mean square distance from the tabulated heights is the noise.

        If all heights change by at most e, the force changes by at most as much as between depths that differ by e.
        So smoothing changes the force by at most about k_N times `smoothing`.

        Args:
            noise: Standard deviation [m] of the measured heights.

        Raises:
            InvalidInput: If the noise is not positive, or the table is too short.
        """
        from scipy.interpolate import UnivariateSpline  # noqa: PLC0415  # see `_curve`

        if not (isinstance(noise, int | float) and 0.0 < noise < math.inf):
            raise InvalidInput(f"noise = {shown(noise)}: must be a positive length; give the noise of the heights in m")
        if self.radii.size < _FEWEST_TO_SMOOTH:
            raise InvalidInput(f"{self.radii.size} heights are too few to smooth; give at least {_FEWEST_TO_SMOOTH}")
        radius, height = self.max_radius, max(float(np.abs(self.heights).max()), noise)
        spline = UnivariateSpline(
            self.radii / radius, self.heights / height, s=self.radii.size * (noise / height) ** 2, k=3
        )
        heights = height * np.asarray(spline(self.radii / radius))
        heights -= heights[0]
        return self.replace(heights=heights, smoothing=float(np.abs(heights - self.heights).max()))

    @cached_property
    def _curve(self) -> PchipInterpolator:
        # Only tabulated profiles need this import.
        from scipy.interpolate import PchipInterpolator  # noqa: PLC0415

        return PchipInterpolator(self.radii, self.heights)

    def height(self, radius: ArrayLike) -> FloatArray:
        r = np.asarray(radius, dtype=np.float64)
        return np.where(r <= self.max_radius, self._curve(np.minimum(r, self.max_radius)), np.inf)

    def slope_at(self, radius: ArrayLike) -> FloatArray:
        r = np.asarray(radius, dtype=np.float64)
        return np.where(r <= self.max_radius, self._curve(np.minimum(r, self.max_radius), 1), np.inf)

    @property
    def breakpoints(self) -> tuple[float, ...]:
        return tuple(float(r) for r in self.radii[1:])

    @cached_property
    def is_convex(self) -> bool:  # f'' is linear between two breakpoints
        cubic, square = self._curve.c[:2]
        second = np.array([2 * square, 6 * cubic * np.diff(self.radii) + 2 * square])
        return bool(np.all(second >= 0.0))

    @property
    def max_radius(self) -> float:
        return float(self.radii[-1])


# Profiles whose slope never falls.
CONVEX = (FlatPunch, Paraboloid, Sphere, Cone, Spheroconical, TruncatedCone, TruncatedParaboloid, PowerLaw)
PROFILES: tuple[type[Profile], ...] = (*CONVEX, Tabulated)
