"""Heights and slopes of indenters, derived from the parameters of the scene, and an indenter scaled by its contact.

These formulas are written independently of `contact.scene.profiles`, which the other methods use: a mistake in a shared
formula would not appear as a difference between two methods. Hence `pchip_slopes` instead of scipy's PchipInterpolator.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

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

# A tip is sharp if f'/r at 1e-6 contact radii exceeds f'/r at 1e-3 by this factor. Power laws with exponents above
# 2 - 0.007 count as smooth. Half of the excess grades meshes for nearly parabolic tips, too.
SHARP_TIP = 1.05


@dataclass(frozen=True)
class Shape:
    """Height f [m] and slope f' [-] of a profile at radii [m] within it; at a kink the slope is that from outside."""

    height: FloatArray
    slope: FloatArray


def shape(profile: Profile, radius: FloatArray) -> Shape:  # noqa: PLR0911 - one formula per profile
    """Height and slope of a profile at radii [m]; infinite beyond its end. Eq. (35): Machines 11 (2023) 474.

    Raises:
        UnsupportedSceneError: this function has no formula for the profile.
    """
    match profile:
        case FlatPunch(radius=end):
            within = np.where(radius <= end, 0.0, np.inf)
            return Shape(within, within)
        case Paraboloid(radius_of_curvature=curvature):
            return Shape(radius**2 / (2.0 * curvature), radius / curvature)
        case Sphere(radius=sphere):
            # f = R - cap = r^2 / (R + cap), without cancellation.
            cap = np.sqrt(np.maximum((sphere - radius) * (sphere + radius), 0.0))
            height = np.where(radius <= sphere, radius**2 / (sphere + cap), np.inf)
            return Shape(height, np.divide(radius, cap, out=np.full(np.shape(radius), np.inf), where=cap > 0.0))
        case Spheroconical():
            return _spheroconical(profile, radius)
        case Cone(slope=slope):
            return Shape(slope * radius, np.full(np.shape(radius), slope))
        case TruncatedCone(flat_radius=flat, slope=slope):
            return Shape(slope * np.maximum(radius - flat, 0.0), np.where(radius >= flat, slope, 0.0))  # Eq. (35)
        case TruncatedParaboloid(flat_radius=flat, radius_of_curvature=curvature):
            height = np.maximum((radius - flat) * (radius + flat), 0.0) / (2.0 * curvature)
            return Shape(height, np.where(radius >= flat, radius / curvature, 0.0))
        case PowerLaw(exponent=n, reference_radius=reference, reference_height=top):
            ratio = radius / reference
            return Shape(top * ratio**n, top / reference * n * ratio ** (n - 1.0))
        case Tabulated(radii=radii, heights=heights):
            within = radius <= radii[-1]
            return Shape(*(np.where(within, values, np.inf) for values in cubics(radii, heights, radius)))
    raise UnsupportedSceneError(
        f"finite elements have no formula for {type(profile).__name__}; write its shape in {__name__}"
    )


def _spheroconical(profile: Spheroconical, radius: FloatArray) -> Shape:
    """Height and slope of a cone with a spherical tip."""
    # sin(theta) and cos(theta) of the cone with slope tan(theta), which touches the sphere at r = R sin(theta).
    steep, level = profile.slope / np.hypot(1.0, profile.slope), 1.0 / np.hypot(1.0, profile.slope)
    join = profile.radius * steep
    cap = shape(Sphere(radius=profile.radius), np.minimum(radius, join))
    straight = profile.radius * (1.0 - level) + profile.slope * (radius - join)
    is_cap = radius < join
    return Shape(np.where(is_cap, cap.height, straight), np.where(is_cap, cap.slope, profile.slope))


def cubics(x: FloatArray, y: FloatArray, at: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Values and slopes of the shape-preserving Hermite cubics through points (x, y), at abscissas within them.

    Per interval y = y_i + s (start + s (tilt + s bend)), s = at - x_i.
    """
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
    """Slope of the PCHIP interpolant at an end point, by the limited three-point formula.

    ``((2 h_1 + h_2) d_1 - h_1 d_2) / (h_1 + h_2)`` for interval widths h and secants d, from the end inwards. It is
    zero where its sign differs from that of d_1, and at most 3 |d_1| where d_1 and d_2 differ in sign.
    """
    slope = ((2.0 * near + far) * first - near * second) / (near + far)
    if slope * first <= 0.0:
        return 0.0
    return 3.0 * first if first * second <= 0.0 and abs(slope) > 3.0 * abs(first) else slope


def height(profile: Profile, radius: float) -> float:
    """Height f [m] at one radius [m]."""
    return float(shape(profile, np.asarray(radius, dtype=np.float64)).height)


@dataclass(frozen=True)
class ScaledIndenter:
    """A profile within a contact radius, lengths in units of that radius.

    Attributes:
        profile: the indenter in SI units.
        contact_radius: contact radius a [m].
    """

    profile: Profile
    contact_radius: float

    def height(self, radius: FloatArray) -> FloatArray:
        """Height f / a at r / a; radii that exceed the edge by rounding count as at the edge."""
        return np.asarray(shape(self.profile, self._inside(radius)).height / self.contact_radius)

    def slope(self, radius: FloatArray) -> FloatArray:
        """Slope f' at r / a, at the contact edge the value from inside."""
        return np.asarray(shape(self.profile, (1 - 1e-15) * self._inside(radius)).slope)

    def _inside(self, radius: FloatArray) -> FloatArray:
        """Radii [m] of radii over a, at most the contact radius and the end of the profile."""
        return np.minimum(radius * self.contact_radius, min(self.contact_radius, self.profile.max_radius))

    @cached_property
    def kinks(self) -> tuple[float, ...]:
        """Radii / a of slope jumps inside the contact."""
        return self._within(self.profile.kinks)

    @cached_property
    def breakpoints(self) -> tuple[float, ...]:
        """Radii / a inside the contact where the profile is not analytic."""
        return self._within(self.profile.breakpoints)

    def _within(self, radii: tuple[float, ...]) -> tuple[float, ...]:
        """Radii / a of those radii [m] that lie inside the contact."""
        return tuple(r / self.contact_radius for r in radii if r < self.contact_radius * (1 - 1e-12))

    @property
    def last_kink(self) -> float:
        """Radius / a of the outermost kink inside the contact; zero without one."""
        return max(self.kinks, default=0.0)

    @property
    def distance_to_upright_end(self) -> float:
        """(end - a) / a where the profile ends upright, like a sphere at its equator; else infinite."""
        end = self.profile.max_radius
        is_upright = np.isfinite(end) and np.isinf(shape(self.profile, np.asarray(end)).slope)
        return end / self.contact_radius - 1.0 if is_upright else np.inf

    @property
    def has_sharp_tip(self) -> bool:
        """Whether f'/r grows without bound at the axis, as for a cone and, slowly, for r^1.98."""
        near, far = self.slope(np.array([1e-6, 1e-3])) / [1e-6, 1e-3]
        return bool(near > SHARP_TIP * far)
