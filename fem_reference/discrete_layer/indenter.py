"""An indenter as finite elements see it: its shape from what the user gave, lengths by the contact radius.

Heights and slopes are written here once more, and not asked of `contact.scene.profiles`: the other methods use those,
and a mistake in them would go unseen between two methods that share it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, singledispatch

import numpy as np

from contact import (
    Cone,
    FlatPunch,
    Paraboloid,
    PowerLaw,
    Profile,
    Sphere,
    Spheroconical,
    Tabulated,
    TruncatedCone,
    TruncatedParaboloid,
    UnsupportedSceneError,
)
from contact.records.validation import FloatArray


@dataclass(frozen=True)
class Shape:
    """Height f [m] and slope f' [-] of a profile at radii [m] within it; at a kink the slope is that from outside."""

    height: FloatArray
    slope: FloatArray


@singledispatch
def shape(profile: Profile, radius: FloatArray) -> Shape:
    """Height and slope at radii [m] of any shape.

    Raises:
        UnsupportedSceneError: for a profile that is not written here.
    """
    raise UnsupportedSceneError(f"finite elements know no {type(profile).__name__}; write its shape in {__name__}")


@shape.register
def _(profile: FlatPunch, radius: FloatArray) -> Shape:
    within = np.where(radius <= profile.radius, 0.0, np.inf)
    return Shape(within, within)


@shape.register
def _(profile: Paraboloid, radius: FloatArray) -> Shape:
    curvature = profile.radius_of_curvature
    return Shape(radius**2 / (2.0 * curvature), radius / curvature)


@shape.register
def _(profile: Sphere, radius: FloatArray) -> Shape:
    # The centre lies this much higher than the circle of the given radius; the sum does not cancel as R - sqrt() does.
    cap = np.sqrt(np.maximum((profile.radius - radius) * (profile.radius + radius), 0.0))
    height = np.where(radius <= profile.radius, radius**2 / (profile.radius + cap), np.inf)
    return Shape(height, np.divide(radius, cap, out=np.full(np.shape(radius), np.inf), where=cap > 0.0))


@shape.register
def _(profile: Spheroconical, radius: FloatArray) -> Shape:
    # sin(theta) and cos(theta) of the flank, by the circle's point of tangency.
    steep, level = profile.slope / np.hypot(1.0, profile.slope), 1.0 / np.hypot(1.0, profile.slope)
    join = profile.radius * steep
    cap = shape(Sphere(radius=profile.radius), np.minimum(radius, join))
    straight = profile.radius * (1.0 - level) + profile.slope * (radius - join)
    is_cap = radius < join
    return Shape(np.where(is_cap, cap.height, straight), np.where(is_cap, cap.slope, profile.slope))


@shape.register
def _(profile: Cone, radius: FloatArray) -> Shape:
    return Shape(profile.slope * radius, np.full(np.shape(radius), profile.slope))


@shape.register
def _(profile: TruncatedCone, radius: FloatArray) -> Shape:
    beyond = radius - profile.flat_radius
    return Shape(profile.slope * np.maximum(beyond, 0.0), np.where(beyond >= 0.0, profile.slope, 0.0))  # Eq. (35)


@shape.register
def _(profile: TruncatedParaboloid, radius: FloatArray) -> Shape:
    flat, curvature = profile.flat_radius, profile.radius_of_curvature
    height = np.maximum((radius - flat) * (radius + flat), 0.0) / (2.0 * curvature)
    return Shape(height, np.where(radius >= flat, radius / curvature, 0.0))


@shape.register
def _(profile: PowerLaw, radius: FloatArray) -> Shape:
    ratio, exponent = radius / profile.reference_radius, profile.exponent
    steepness = profile.reference_height / profile.reference_radius * exponent
    return Shape(profile.reference_height * ratio**exponent, steepness * ratio ** (exponent - 1.0))


@shape.register
def _(profile: Tabulated, radius: FloatArray) -> Shape:
    height, slope = cubics(profile.radii, profile.heights, radius)
    within = radius <= profile.radii[-1]
    return Shape(np.where(within, height, np.inf), np.where(within, slope, np.inf))


def cubics(x: FloatArray, y: FloatArray, at: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Values and slopes of the shape-preserving cubics through points, at places within them."""
    i = np.clip(np.searchsorted(x, at, side="right") - 1, 0, len(x) - 2)
    width, slopes = np.diff(x)[i], pchip_slopes(x, y)
    secant, start = (y[i + 1] - y[i]) / width, slopes[i]
    bend = (start + slopes[i + 1] - 2.0 * secant) / width**2
    tilt = (secant - start) / width - bend * width
    s = at - x[i]
    return y[i] + s * (start + s * (tilt + s * bend)), start + s * (2.0 * tilt + 3.0 * s * bend)


def pchip_slopes(x: FloatArray, y: FloatArray) -> FloatArray:
    """Slopes of the shape-preserving cubics through points (PCHIP).

    Inside, the weighted harmonic mean of the neighbouring secants, zero where these differ in sign: Fritsch and
    Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300. At the ends the three-point formula, limited so that the curve
    does not overshoot: Moler, Numerical Computing with Matlab (2004), section 3.6.
    """
    width = np.diff(x)
    secant = np.diff(y) / width
    if len(x) == 2:
        return np.repeat(secant, 2)
    left, right = secant[:-1], secant[1:]
    same = left * right > 0.0
    weights = 2.0 * width[1:] + width[:-1], width[1:] + 2.0 * width[:-1]
    mean = sum(weights) / (weights[0] / np.where(same, left, 1.0) + weights[1] / np.where(same, right, 1.0))
    ends = (_end_slope(width[0], width[1], secant[0], secant[1]), _end_slope(*width[:-3:-1], *secant[:-3:-1]))
    return np.concatenate([[ends[0]], np.where(same, mean, 0.0), [ends[1]]])


def _end_slope(near: float, far: float, first: float, second: float) -> float:
    slope = ((2.0 * near + far) * first - near * second) / (near + far)
    if slope * first <= 0.0:
        return 0.0
    return 3.0 * first if first * second <= 0.0 and abs(slope) > 3.0 * abs(first) else slope


def height(profile: Profile, radius: float) -> float:
    """f [m] at one radius [m]."""
    return float(shape(profile, np.asarray(radius, dtype=np.float64)).height)


@dataclass(frozen=True)
class ScaledIndenter:
    """A profile within one contact radius.

    Attributes:
        profile: the indenter.
        contact_radius: a [m].
    """

    profile: Profile
    contact_radius: float

    def height(self, radius: FloatArray) -> FloatArray:
        """f / a at r / a; nodes at the rim of a punch may exceed it by rounding."""
        return np.asarray(shape(self.profile, self._inside(radius)).height / self.contact_radius)

    def slope(self, radius: FloatArray) -> FloatArray:
        """f' at r / a, at the contact edge the value from inside."""
        return np.asarray(shape(self.profile, (1 - 1e-15) * self._inside(radius)).slope)

    def _inside(self, radius: FloatArray) -> FloatArray:
        return np.minimum(radius * self.contact_radius, min(self.contact_radius, self.profile.max_radius))

    @cached_property
    def kinks(self) -> tuple[float, ...]:
        """Radii / a of slope jumps inside the contact."""
        return self._within(self.profile.kinks)

    @cached_property
    def breakpoints(self) -> tuple[float, ...]:
        """Radii / a inside the contact where the profile is not analytic."""
        return self._within(self.profile.breakpoints)

    @property
    def left_to_upright_end(self) -> float:
        """(end - a) / a where the profile ends upright, like a sphere at its equator; else infinite."""
        end = self.profile.max_radius
        is_upright = np.isfinite(end) and np.isinf(shape(self.profile, np.asarray(end)).slope)
        return end / self.contact_radius - 1.0 if is_upright else np.inf

    def _within(self, radii: tuple[float, ...]) -> tuple[float, ...]:
        return tuple(r / self.contact_radius for r in radii if r < self.contact_radius * (1 - 1e-12))

    @property
    def has_sharp_tip(self) -> bool:
        """Whether the curvature grows without bound at the axis, as that of a cone does and, slowly, that of r^1.98."""
        near, far = self.slope(np.array([1e-6, 1e-3])) / [1e-6, 1e-3]
        return bool(near > 1.05 * far)
