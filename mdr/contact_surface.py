"""Pressure and displacement of the surface, Eqs. (9) and (13), from the Abel density of one contact.

    phi = W + psi,  W = depth - g_hs known with its kinks,  psi = B phi smooth
    p(r) = (E*/pi) [phi(a)/sqrt(a^2 - r^2) - int_r^a phi'(t)/sqrt(t^2 - r^2) dt]                      inside
    w(r) = (2/pi) [int_0^a phi(t)/sqrt(r^2 - t^2) dt - int_0^inf (1 - chi) phi^(k) J_0(kr) dk]        outside

psi is a series of even Legendre polynomials, whose Abel images have a closed form: P_2n(t/a) becomes
P_2n(u)/(P_2n(0) a u) with a u = sqrt(a^2 - r^2). In contacts much wider than the layer is thick psi varies within a
thickness of every kink of the profile, and needs more polynomials.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.polynomial import legendre

from bem.equation import FAR, Radius
from bem.numerics import even_bessel, even_legendre, gauss, graded, special
from contact import InvalidInput
from contact.records.validation import FloatArray
from mdr.spring_bed import Springs

# a/h beyond which kinks need more polynomials, and factor of their number: with half as many errors at a/h = 10 are
# 5e-9, with twice as many those at a/h = 60 are a tenth.
_WIDE, _MORE = 3.0, 2.0
# Further polynomials for pressures on graded layers, where phi' converges slowly. Next to kinks their error is 1e-4;
# half as many double it.
_MANY = 300
# b/a below which a kink at radius b is treated as the axis.
_CENTRE = 1e-3
# Wave numbers that are summed at a time.
_CHUNK = 20_000
# 1 - chi of a graded layer falls like 1/k: bounds of the factor on the largest wave number for w outside, and
# the k a to reach. Twice of it leaves a fifth of the error under a flat punch.
_SLOW_DECAY, _SLOW_WAVES = (10.0, 100.0), 2e3


def is_slow(springs: Springs, a: float) -> bool:
    """Whether the series of psi converges slowly: a wide contact of radius a [m] within which the profile has breaks.

    Its error falls like a power of the number of polynomials: 1e-14 of the mean pressure at a/h = 10, 4e-7 at 60.
    """
    is_wide = a > _WIDE * springs.unit and not (
        springs.kernel.is_uniform or springs.kernel.tail or springs.is_tabulated
    )
    return is_wide and any(_CENTRE * a < b < a for b in springs.tip.breaks)


def surface_of(springs: Springs, a: float, depth: float, *, is_singular: bool = False) -> Surface:
    """Fields of the contact of radius a [m] at a depth [m]; `is_singular`: whether phi(a) is not zero."""
    if is_slow(springs, a):
        springs = springs.at_sizes(springs.sizes._replace(rate=_MORE * springs.sizes.rate))
    return Surface(springs, a, depth, is_singular=is_singular)


class Surface:
    """Fields of one contact, psi one series of even Legendre polynomials.

    Args:
        springs: Springs of the scene.
        a: Contact radius [m].
        depth: Indentation depth [m].
        is_singular: Whether phi(a) is not zero: under a flat punch, and with adhesion.
    """

    # Coefficient of a logarithm at the edge of graded layers: psi' = smooth_slope - corner ln[(a + t)/(a - t)].
    corner = 0.0

    def __init__(self, springs: Springs, a: float, depth: float, *, is_singular: bool = False) -> None:
        self.springs, self.tip, self.sizes = springs, springs.tip, springs.sizes
        self.kernel, self.a, self.depth = springs.kernel, a, depth
        self.edge = 0.0  # phi(a)
        if is_singular:
            values = springs.at([a])
            self.edge = float(values.y1[0] * (depth - values.g[0]))
        self._spectra: dict[float, tuple[FloatArray, FloatArray]] = {}
        if not self.kernel.is_uniform:
            self._radius: Radius = springs.radius(a)
        self._solve()

    def _solve(self) -> None:
        """Solve for the coefficients of phi and psi in Legendre polynomials P_2n.

        On graded layers psi has a logarithm at the edge if phi(a) is not zero. Polynomials converge slowly to it:
        psi = corner [(a - t) ln(1 - t/a) + (a + t) ln(1 + t/a)] + smooth, corner = -c_1 phi(a)/pi.
        """
        if self.kernel.is_uniform:
            self._phi = self._series = self._smooth = np.zeros(1)
            return
        if self.kernel.tail:
            sizes = self.sizes._replace(graded=_MANY)
            self._radius = Radius(self.kernel, self.a / self.springs.unit, sizes)
        radius = self._radius
        load = -self.tip.moments(np.array([self.a]), radius.count, self.sizes.extra)[0]
        load[0] += self.depth
        phi = radius.solve(load)
        self._phi, self._series = phi * radius.degree, (phi - load) * radius.degree
        self._smooth = self._series
        if self.kernel.tail and self.edge != 0:
            self.corner = -self.kernel.tail[0] / self.springs.unit * self.edge / np.pi
            m = 2.0 * np.arange(1, radius.count)
            coefficients = 4 * (2 * m + 1) / ((m - 1) * m * (m + 1) * (m + 2))
            self._smooth = self._series - self.corner * self.a * np.concatenate([[2 * np.log(2) - 1], coefficients])

    def psi(self, t: FloatArray) -> FloatArray:
        """Smooth part psi of the density [m] at t <= a [m]."""
        return np.asarray(even_legendre(t / self.a, self._series.size) @ self._series)

    @property
    def degree(self) -> int:
        """Twice the number of coefficients of psi."""
        return 2 * self._smooth.size

    @property
    def edge_of_series(self) -> float:
        """phi(a) [m] of the truncated series; `edge` minus this is the truncation error."""
        without_series = (
            self.depth - float(self.tip.transform(np.array([self.a]))[0]) + 2 * np.log(2) * self.a * self.corner
        )
        return float(without_series + self._smooth.sum())

    def smooth_slope(self, t: FloatArray) -> FloatArray:
        """psi' [-] at t [m] without the logarithm at the edge, see `corner`."""
        full = np.zeros(2 * self._smooth.size)
        full[::2] = self._smooth
        return np.asarray(legendre.legval(t / self.a, legendre.legder(full)) / self.a)

    def smooth_transform(self, k: FloatArray) -> FloatArray:
        """int_0^a psi cos kt dt [m^2] at k [1/m]."""
        alternating = self._series * (-1.0) ** np.arange(self._series.size)
        return np.asarray(self.a * alternating @ even_bessel(k * self.a, self._series.size))

    def density(self, t: FloatArray) -> FloatArray:
        """Abel density phi [m] at t <= a [m]."""
        return np.asarray(self.depth - self.tip.quick(t) + self.psi(t))

    def _image(self, u: FloatArray) -> FloatArray:
        """Abel image of psi - psi(a) at a u = sqrt(a^2 - r^2)."""
        n = np.arange(1, self._smooth.size)
        at_zero = np.concatenate([[1.0], np.cumprod(-(2 * n - 1) / (2 * n))])  # P_2n(0)
        return np.asarray((even_legendre(u, self._smooth.size) / at_zero - 1) @ self._smooth / (self.a * u))

    def _slope(self, t: FloatArray) -> FloatArray:
        """-phi' without the derivative of the series and without the singular terms of kinks, at t [m]."""
        if self.corner == 0:
            return self.tip.transform_slope(t)
        to_edge = np.maximum(self.a - t, 1e-17 * self.a)
        return np.asarray(self.tip.transform_slope(t) - self.corner * np.log((self.a + t) / to_edge))

    def pressure(self, radius: FloatArray) -> FloatArray:
        """p(r) [Pa] at radii [m], shape (n,), zero outside the contact.

        Raises:
            InvalidInput: Where the pressure is infinite: at kinks, at the tip of a cone, at the edge of a flat punch.
        """
        inside = radius < self.a
        self._refuse_infinite(radius, inside | ((radius == self.a) & (self.edge != 0)))
        pressure = np.zeros_like(radius)
        pressure[inside] = self._inside(radius[inside])
        return pressure

    def _inside(self, r: FloatArray) -> FloatArray:
        """p(r) [Pa] at r < a, where t^2 = low^2 + (high^2 - low^2) v^2 between two breaks of the profile."""
        a, tip = self.a, self.tip
        u = np.sqrt((a - r) * (a + r)) / a
        p = self.edge / (a * u) + self._image(u)
        v, w = graded(16 + self.sizes.extra)
        ends = [0.0, *(b for b in tip.breaks if b < a), a]
        for begin, high in pairwise(ends):
            i = np.flatnonzero(r < high)
            if not i.size or high <= begin:
                continue
            low = np.maximum(r[i], begin)[:, None]
            span = (high - low) * (high + low)
            t = np.sqrt(low * low + span * v * v)
            slope = self._slope(t)
            for b, jump in tip.kinks:
                above = np.maximum((low - b) * (low + b) + span * v * v, 1e-300)  # t^2 - b^2 without cancellation
                slope = slope + np.where(low >= b, jump * b / np.sqrt(above), 0.0)
            near = r[i, None]
            to_r = np.maximum((low - near) * (low + near) + span * v * v, 1e-300)
            p[i] += (span * v * w * slope / (t * np.sqrt(to_r))).sum(axis=1)
        return np.asarray(self.springs.modulus / np.pi * p)

    def _refuse_infinite(self, radius: FloatArray, within: FloatArray) -> None:
        """Refuse radii [m] at which the pressure is infinite, of those where `within` is true."""
        profile = self.tip.profile
        singular = [0.0] if float(profile.slope_at(0.0)) > 0 else []
        singular += [b for b in profile.kinks if b < self.a]
        if self.edge != 0:
            singular.append(self.a)
        infinite = radius[np.asarray(within, dtype=bool) & np.isin(radius, singular)]
        if infinite.size:
            raise InvalidInput(f"radius = {infinite[0]:g} m: the pressure is infinite at this sharp rim; ask beside it")

    def displacement(self, radius: FloatArray) -> FloatArray:
        """w(r) [m] at radii [m], shape (n,): depth - f inside, Eq. (1); Eq. (13) outside."""
        inside = radius <= self.a
        w = np.empty_like(radius)
        w[inside] = self.depth - self.tip.height(radius[inside])
        if not inside.all():
            w[~inside] = self._outside(radius[~inside])
        return w

    def _outside(self, r: FloatArray) -> FloatArray:
        """w(r) [m] at r > a, Eq. (13).

        The part of the profile is (2/pi) [depth arcsin(a/r) - int_0^a f'(s) arctan sqrt((a^2 - s^2)/(r^2 - a^2)) ds].
        """
        far, a = r[:, None], self.a
        height = np.zeros_like(r)
        ends = [self.tip.flat, *(b for b in self.tip.cuts if self.tip.flat < b < a), a]
        for low, high in pairwise(ends):
            # f' may be singular at the axis, the arctan has a root near the edge.
            is_smooth = low > 0 and a - high > high - low
            v, w = (gauss if is_smooth else graded)(20 + self.sizes.extra)
            s, to_edge = low + (high - low) * v, a - high + (high - low) * v[::-1]  # v is symmetric: 1 - v
            angle = np.arctan(np.sqrt(to_edge * (a + s) / ((far - a) * (far + a))))
            height += angle @ (w * (high - low) * self.tip.slope(s))
        v, w = gauss(2 * self._phi.size + 16 + self.sizes.extra)
        total = self.depth * np.arcsin(a / r) - height
        if not self.kernel.is_uniform:
            end = np.arcsin(a / far)
            total = total + (end * w * self.psi(np.minimum(far * np.sin(end * v), a))).sum(axis=1)
        return np.asarray(2 / np.pi * (total - self._softening(far)))

    def _softening(self, far: FloatArray) -> FloatArray | float:
        """int_0^inf (1 - chi) phi^(k) J_0(kr) dk [m]."""
        if self.kernel.is_uniform:
            return 0.0
        kappa, weighted = self._weighted_spectrum(2.0 ** np.ceil(np.log2(max(float(far.max()) / self.a, FAR))))
        total, j0 = np.zeros(far.shape[0]), special().j0
        for part in range(0, kappa.size, _CHUNK):
            total = total + j0(far / self.a * kappa[part : part + _CHUNK]) @ weighted[part : part + _CHUNK]
        return total

    def _weighted_spectrum(self, farthest: float) -> tuple[FloatArray, FloatArray]:
        """Nodes k a and (1 - chi) phi^ times weights [m], by which `_softening` is a sum of J_0(kr)."""
        if farthest not in self._spectra:
            largest = self.sizes.reach * self.a / self.springs.unit
            more = 2.0 ** (self.sizes.extra / 6)  # twice the wave numbers at the finer resolution of error estimates
            reach = more * float(np.clip(_SLOW_WAVES / largest, *_SLOW_DECAY)) if self.kernel.tail else 1.0
            kappa, w, table = self._radius.waves(farthest, reach)
            rest = self.kernel.one_minus_chi(kappa / self.a * self.springs.unit)
            # phi^/a = int_0^1 phi(a s) cos(kappa s) ds, from the transforms of the polynomials.
            self._spectra[farthest] = kappa, w * rest * ((self._phi / self._radius.degree) @ table)
        return self._spectra[farthest]
