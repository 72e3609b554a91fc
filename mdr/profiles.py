"""Half-space transform g_hs of a profile of revolution f(r), and the moments of g_hs.

    g_hs(x) = x int_0^x f'(r)/sqrt(x^2 - r^2) dr                                                   Eq. (15)
    m_n(x)  = int_0^1 g_hs(x s) b_n(s) ds = x int_0^(pi/2) f'(x cos t) sqrt(4n+1) Q_n(sin t) sin t dt

b_n = sqrt(4n+1) P_2n, Q_n as in `bem.numerics.abel_legendre`. The second integrand is smooth wherever f' is, so panels
in the angle t end at the radii where f' is not analytic. `tip_of` lists the profiles with closed forms; every other
profile of `contact` is integrated from its `slope_at`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.polynomial import Chebyshev
from numpy.typing import NDArray

from bem.numerics import EPS, abel_legendre, gauss, graded, special
from contact.records.validation import FloatArray
from contact.scene.profiles import (
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
)

# Largest number of entries of a table of moments that is computed at a time.
_BLOCK = 2_000_000
# Chebyshev points per stretch for the slope of g_hs of a profile without a closed form.
_SAMPLES = 40
# Largest amplification of rounding errors by closed forms of measured profiles: 1e4 leaves 1e-12. Profiles with uneven
# radii exceed it, and are integrated numerically.
_CANCELLATION = 1e4
# Exponent of the substitution that concentrates nodes at the inner end of a panel, where tips like r^1.7 are not
# analytic.
_CROWDING = 4


class Tip:
    """Transform of a profile by quadrature of its slope. Radii in metres.

    Attributes:
        profile: Profile of revolution.
        flat: Radius of the flat end [m].
        end: Radius [m] at which the profile ends.
        breaks: Radii > 0 [m] where f is not analytic.
        kinks: Pairs (b, jump of f' at b). The terms jump b/sqrt(x^2 - b^2) of g_hs', singular at b, are not included in
            `transform_slope` for these b.
    """

    kinks: tuple[tuple[float, float], ...] = ()

    def __init__(self, profile: Profile) -> None:
        self.profile, self.flat, self.end = profile, profile.flat_radius, profile.max_radius
        radii = {*profile.breakpoints, *((self.flat,) if self.flat else ())}
        self.breaks = tuple(sorted(b for b in radii if b < self.end))

    @cached_property
    def exponent(self) -> float:
        """n in f ~ r^n near the axis; 1 with a flat end."""
        if self.flat:
            return 1.0
        r = np.array([1e-6 * min([*self.breaks[:1], self.end, 1.0])])
        n = float((r * self.slope(r) / self.height(r))[0])
        return float(round(n)) if abs(n - round(n)) < 1e-3 else n

    @property
    def cuts(self) -> tuple[float, ...]:
        """Radii [m] at which quadratures are cut: breaks, and steps towards a singularity."""
        return self.breaks

    @property
    def is_convex(self) -> bool:
        """Whether f' never decreases."""
        return self.profile.is_convex

    def height(self, r: FloatArray) -> FloatArray:
        """Height f(r) of the profile [m]."""
        return self.profile.height(r)

    def slope(self, r: FloatArray) -> FloatArray:
        """Slope f'(r) of the profile at r > 0 [m]."""
        return self.profile.slope_at(r)

    def transform(self, x: FloatArray) -> FloatArray:
        """g_hs [m] at x > 0 [m] of any shape."""
        flat = np.ravel(x)
        total = np.empty_like(flat)
        for part in self._parts(flat, 1):
            angle, w = self._angles(flat[part], lambda span: 24 + int(12 * span))
            total[part] = flat[part] * (w * self.slope(flat[part, None] * np.cos(angle))).sum(axis=1)
        return total.reshape(np.shape(x))

    def transform_beyond(self, excess: FloatArray) -> FloatArray:
        """g_hs [m] at x = b + excess, b the flat radius; accurate for any small excess [m]."""
        return self.transform(self.flat + excess)

    def quick(self, x: FloatArray) -> FloatArray:
        """g_hs [m] by a faster formula, accurate to 1e-11 for rough measured profiles."""
        return self.transform(x)

    def transform_slope(self, x: FloatArray) -> FloatArray:
        """g_hs' at x > 0 [m] of any shape, without the singular terms of `kinks`."""
        slope = np.zeros_like(x)
        for low, high, series in self._stretches(float(np.max(x, initial=0.0))):
            inside = (x > low) & (x <= high)
            u = np.sqrt((x[inside] - low) / (high - low))
            slope[inside] = series.deriv()(u) / (2 * np.maximum(u, EPS) * (high - low))
        return slope

    def _stretches(self, top: float) -> list[tuple[float, float, Chebyshev]]:
        """g_hs between neighbouring breaks up to a radius, as polynomials of the root of the distance."""
        ends = [self.flat, *(b for b in self.breaks if self.flat < b < top), top]
        return [(low, high, self._of_root(low, high)) for low, high in pairwise(ends) if high > low]

    def _of_root(self, low: float, high: float) -> Chebyshev:
        """g_hs at low + (high - low) u^2 as a polynomial of u."""
        return Chebyshev.interpolate(lambda u: self.transform(low + (high - low) * u * u), _SAMPLES, [0, 1])

    def moments(self, x: FloatArray, count: int, extra: int = 0) -> FloatArray:
        """m_n at x > 0 [m], shape (x.size, count) [m]; `extra` adds nodes to the quadrature."""
        table = np.empty((x.size, count))
        for part in self._parts(x, count):
            at = x[part]
            angle, w = self._angles(at, lambda span: 16 + extra + int((0.7 + 1.3 * self._crowds) * count * span))
            weight = self.slope(at[:, None] * np.cos(angle)) * np.sin(angle) * w * at[:, None]
            table[part] = (weight[:, None, :] @ abel_legendre(np.sin(angle), count))[:, 0]
        return table

    def logarithmic_moment(self, x: FloatArray, extra: int = 0) -> FloatArray:
        """int_0^1 g_hs(x s) ln(1 - s^2) ds = 2 x int_0^(pi/2) f'(x cos t) (ln(2 sin t) - 1) sin^2 t dt at x > 0 [m]."""
        total, (v, weights) = np.empty_like(x), graded(10 + extra)
        for part in self._parts(x, v.size):
            angle, w = _on_panels(self._ends(x[part]), v, weights)
            sine = np.maximum(np.sin(angle), 1e-300)
            slope = self.slope(x[part, None] * np.cos(angle))
            total[part] = 2 * x[part] * (w * slope * (np.log(2 * sine) - 1) * sine**2).sum(axis=1)
        return total

    _crowds = True

    def _parts(self, x: FloatArray, count: int) -> list[NDArray[np.intp]]:
        """Indices of x in blocks that keep the tables of quadratures small."""
        each = max(1, _BLOCK // (count * (len(self.cuts) + 1) * (16 + count)))
        return [np.arange(i, min(i + each, x.size)) for i in range(0, x.size, each)]

    def _ends(self, x: FloatArray) -> FloatArray:
        """Angles t from 0 to that of the flat end, r = x cos t, cut at `cuts`, shape (x.size, panels + 1)."""
        inner = np.array([r for r in self.cuts if r < x.max()][::-1] + ([] if self.flat else [0.0]))
        far = np.sqrt(np.maximum((x[:, None] - inner) * (x[:, None] + inner), 0))
        return np.concatenate([np.zeros((x.size, 1)), np.arctan2(far, inner)], axis=1)

    def _angles(self, x: FloatArray, nodes: Callable[[float], int]) -> tuple[FloatArray, FloatArray]:
        """Quadrature over r = x cos t, flat < r < x: angles and weights, shape (x.size, n)."""
        ends = self._ends(x)
        v, w = gauss(nodes(float(np.diff(ends).max(initial=0))))
        if self._crowds:  # towards the inner end, where t is largest
            v, w = 1 - v**_CROWDING, w * _CROWDING * v ** (_CROWDING - 1)
        return _on_panels(ends, v, w)


def _on_panels(ends: FloatArray, v: FloatArray, w: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Nodes and weights of a rule on [0, 1] on all panels between ends of shape (m, panels + 1), shape (m, n) each."""
    span = np.diff(ends)[..., None]
    return (ends[:, :-1, None] + span * v).reshape(len(ends), -1), (span * w).reshape(len(ends), -1)


class FlatTip(Tip):
    """A flat punch: f = 0 within its radius."""

    def transform(self, x: FloatArray) -> FloatArray:
        """Transform g_hs = 0."""
        return np.zeros_like(x)

    transform_slope = transform

    def moments(self, x: FloatArray, count: int, extra: int = 0) -> FloatArray:
        """Moments m_n = 0, shape (x.size, count)."""
        return np.zeros((x.size, count))


class PowerTip(Tip):
    """f = H (r/R)^n, n >= 1: cone n = 1, paraboloid n = 2. Args: profile, H [m], R [m], n."""

    def __init__(self, profile: Profile, height: float, radius: float, exponent: float) -> None:
        super().__init__(profile)
        self.exponent, self._radius = exponent, radius
        self._gain = height * exponent / 2 * float(special().beta(exponent / 2, 0.5))

    def transform(self, x: FloatArray) -> FloatArray:
        """g_hs = H (n/2) B(n/2, 1/2) (x/R)^n."""
        return np.asarray(self._gain * (x / self._radius) ** self.exponent)

    def transform_slope(self, x: FloatArray) -> FloatArray:
        """Derivative g_hs' at x > 0 [m]."""
        return np.asarray(self._gain * self.exponent / self._radius * (x / self._radius) ** (self.exponent - 1))

    def moments(self, x: FloatArray, count: int, extra: int = 0) -> FloatArray:
        """int_0^1 s^n P_2m ds = prod_(i<m) (n - 2i)/(n + 2i + 3)/(n + 1)."""
        n, i, m = self.exponent, np.arange(count - 1), np.arange(count)
        whole = np.concatenate([[1.0], np.cumprod((n - 2 * i) / (n + 2 * i + 3))]) / (n + 1)
        return np.asarray(self.transform(x)[:, None] * whole * np.sqrt(4 * m + 1))


class BallTip(Tip):
    """A sphere of radius R up to its equator, or continued by a cone that is tangent to it at b = R sin(theta)."""

    _crowds = False

    def __init__(self, profile: Profile, radius: float, flank: float = math.inf) -> None:
        super().__init__(profile)
        self._radius, self._flank = radius, flank
        self._tangent = math.inf if flank == math.inf else radius * flank / math.hypot(1, flank)
        self._near = radius / math.hypot(1, flank)  # sqrt(R^2 - b^2)

    @cached_property
    def cuts(self) -> tuple[float, ...]:
        """Steps towards the pole of f' at R, up to the tangent."""
        towards = self._radius * (1 - 0.25 ** np.arange(1.0, 26))
        return (*towards[towards < self._tangent].tolist(), *self.breaks)

    def slope(self, r: FloatArray) -> FloatArray:
        """f' = r/sqrt(R^2 - r^2), constant beyond the tangent."""
        s = np.minimum(r, self._tangent)
        with np.errstate(divide="ignore"):
            cap = s / np.sqrt(np.maximum((self._radius - s) * (self._radius + s), 0.0))
        return np.where(r < self._tangent, cap, self._flank)

    def _artanh(self, s: FloatArray) -> FloatArray:
        """artanh(s/R) with the digits of R - s."""
        with np.errstate(divide="ignore"):
            return np.asarray(np.log1p(2 * s / (self._radius - s)) / 2)

    def _beyond(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Terms of g_hs on the flank: sqrt(x^2 - b^2), and ln[(R + x)/(sqrt(R^2 - b^2) + sqrt(x^2 - b^2))]."""
        R, b, near = self._radius, self._tangent, self._near
        far = np.sqrt(np.maximum((x - b) * (x + b), 0))
        return far, np.log1p(b * b * (1 / (R + near) + 1 / (x + far)) / (near + far))

    def transform(self, x: FloatArray) -> FloatArray:
        """g_hs = x artanh(x/R); on the flank x {ln[(R + x)/(..)] + slope arctan(sqrt(x^2 - b^2)/b)}."""
        s = np.minimum(x, self._tangent)
        cap = s * self._artanh(s)
        if self._tangent == math.inf:
            return cap
        far, logarithm = self._beyond(x)
        return np.where(x < self._tangent, cap, x * (logarithm + self._flank * np.arctan2(far, self._tangent)))

    def transform_slope(self, x: FloatArray) -> FloatArray:
        """Derivative g_hs' at x > 0 [m]."""
        R, b, near = self._radius, self._tangent, self._near
        s = np.minimum(x, b)
        cap = self._artanh(s) + s * R / ((R - s) * (R + s))
        if b == math.inf:
            return cap
        far, logarithm = self._beyond(x)
        flank = (
            logarithm + self._flank * np.arctan2(far, b) + x / (R + x) + (b * b - near * far) / (near * (near + far))
        )
        return np.where(x < b, cap, flank)


class PiecewiseTip(Tip):
    """f' piecewise quadratic: from knots[i] on it is value + first (r - knot) + second (r - knot)^2.

    Args:
        profile: Profile of revolution.
        knots: Radii [m], shape (n,).
        pieces: value [-], first [1/m], second [1/m^2], shape (n, 3).
    """

    _crowds = False

    def __init__(self, profile: Profile, knots: FloatArray, pieces: FloatArray) -> None:
        super().__init__(profile)
        self._knots, self._pieces = knots, pieces
        step = np.diff(knots)
        (value, first, second), before = pieces[:-1].T, np.zeros((1, 3))
        reached = np.column_stack([value + step * (first + second * step), first + 2 * second * step, second])
        jumps = pieces - np.concatenate([before, reached])
        self._jumps = np.where(np.abs(jumps) > 1e-14 * np.abs(pieces).max(axis=0), jumps, 0.0)
        self.breaks = tuple(float(b) for b in knots if b > 0)
        self.kinks = tuple(
            (float(b), float(j)) for b, j in zip(knots, self._jumps[:, 0], strict=True) if b > 0 and j != 0
        )

    def slope(self, r: FloatArray) -> FloatArray:
        """Slope f'(r) of the profile, zero on the flat end."""
        i = np.clip(np.searchsorted(self._knots, r, "right") - 1, 0, None)
        d = np.maximum(r - self._knots[i], 0)
        value, first, second = np.moveaxis(self._pieces[i], -1, 0)
        return np.where(r >= self._knots[0], value + d * (first + d * second), 0.0)

    def _angle(self, x: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """x, knots b, sqrt(x^2 - b^2) and arccos(b/x), the last two zero where x < b; the last axis is b."""
        wide, b = np.asarray(x, dtype=np.float64)[..., None], self._knots
        far = np.sqrt(np.maximum((wide - b) * (wide + b), 0))
        return wide, b, far, np.arctan2(far, np.where(b == 0, 1e-300, b)) * (wide > b)

    @cached_property
    def _is_even(self) -> bool:
        """Whether rounding errors of the closed forms stay below `_CANCELLATION` up to the end of the profile."""
        if self._knots.size == 1:
            return True
        size = (np.abs(self._jumps) * self.end ** np.arange(3)).sum()
        return bool(size < _CANCELLATION * np.abs(self.slope(self._knots)).max())

    def quick(self, x: FloatArray) -> FloatArray:
        """g_hs [m] by the closed form where rounding errors are small, else by quadrature."""
        return self._closed(x) if self._is_even else self.transform(x)

    def _closed(self, x: FloatArray) -> FloatArray:
        """g_hs = x sum_b sum_m j_m I_m, I_m = int_b^x (r - b)^m/sqrt(x^2 - r^2) dr, m = 0, 1, 2, at all knots b.

        j_m is the jump of the coefficient of (r - b)^m in f' at b.
        """
        wide, b, far, angle = self._angle(x)
        integrals = (angle, far - b * angle, (wide**2 / 2 + b * b) * angle - 1.5 * b * far)
        total: FloatArray = sum(i @ j for i, j in zip(integrals, self._jumps.T, strict=True))
        return x * total

    def transform(self, x: FloatArray) -> FloatArray:
        """Transform g_hs [m]: closed form for a single knot, where it does not cancel, else by quadrature."""
        return self._closed(x) if self._knots.size == 1 else super().transform(x)

    def transform_beyond(self, excess: FloatArray) -> FloatArray:
        """g_hs by the digits of the excess over a flat end: value x angle + first (far - b angle) x + .."""
        if self._knots.size > 1 or not self.flat:
            return super().transform_beyond(excess)
        b, (value, first, second) = self.flat, self._pieces[0]
        x, far = b + excess, np.sqrt(np.maximum(excess * (excess + 2 * b), 0.0))
        angle = np.arctan2(far, b)
        rise = value * angle + first * (far - b * angle) + second * ((x**2 / 2 + b * b) * angle - 1.5 * b * far)
        return np.asarray(x * rise)

    def transform_slope(self, x: FloatArray) -> FloatArray:
        """Derivative g_hs' without the singular terms of `kinks`."""
        if not self._is_even:
            return self._integrated_slope(x)
        wide, b, far, angle = self._angle(x)
        slopes = (angle, 2 * far - b * angle, (1.5 * wide**2 + b * b) * angle - 2.5 * b * far)
        total: FloatArray = sum(s @ j for s, j in zip(slopes, self._jumps.T, strict=True))
        return total

    def _integrated_slope(self, x: FloatArray) -> FloatArray:
        """g_hs' = int (f' + r f'') dt over r = x cos t, without the terms of `kinks`."""
        flat, slope = np.ravel(x), np.empty(np.size(x))
        for part in self._parts(flat, 1):
            angle, w = self._angles(flat[part], lambda span: 16 + int(8 * span))
            r = flat[part, None] * np.cos(angle)
            i = np.clip(np.searchsorted(self._knots, r, "right") - 1, 0, None)
            d = np.maximum(r - self._knots[i], 0)
            value, first, second = np.moveaxis(self._pieces[i], -1, 0)
            slope[part] = (w * (value + d * (first + d * second) + r * (first + 2 * d * second))).sum(axis=1)
        return slope.reshape(np.shape(x))


def tip_of(profile: Profile) -> Tip:
    """The transform of a profile, in closed form where one is known."""
    match profile:
        case FlatPunch():
            tip: Tip = FlatTip(profile)
        case Cone(slope=slope):
            tip = PowerTip(profile, slope, 1.0, 1.0)
        case Paraboloid(radius_of_curvature=R):
            tip = PowerTip(profile, R / 2, R, 2.0)
        case PowerLaw():
            tip = PowerTip(profile, profile.reference_height, profile.reference_radius, profile.exponent)
        case Sphere(radius=R):
            tip = BallTip(profile, R)
        case Spheroconical(radius=R, slope=slope):
            tip = BallTip(profile, R, slope)
        case TruncatedCone(flat_radius=b, slope=slope):
            tip = PiecewiseTip(profile, np.array([b]), np.array([[slope, 0.0, 0.0]]))
        case TruncatedParaboloid(flat_radius=b, radius_of_curvature=R):
            tip = PiecewiseTip(profile, np.array([b]), np.array([[b / R, 1 / R, 0.0]]))
        case Tabulated():  # shape-preserving cubics: f' is quadratic between the measured radii
            cubic, square, linear, _ = profile._curve.c
            tip = PiecewiseTip(profile, profile.radii[:-1], np.column_stack([linear, 2 * square, 3 * cubic]))
        case _:
            tip = Tip(profile)
    return tip
