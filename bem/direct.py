"""The integral equation of one contact solved by Nystroem's method: an alternative to `bem.equation`.

The pressure's Abel density phi on [0, a] obeys

    phi(x) - int_0^a L(x, t) phi(t) dt = depth - g_hs(x),    L(x, t) = (2/pi) int_0^inf (1 - chi) cos kx cos kt dk,
    g_hs(x) = x int_0^(pi/2) f'(x cos u) du                  transform of the profile for the half-space, Eq. (8)
    phi(a) = 0: depth of the contact,   F = 2 E* int phi dt,   k_N = 2 E* int phi_1 dt, phi_1 for the right side 1

The unknowns are phi at Gauss nodes of panels between the breaks b of the profile. There t = b + s^2, in which g_hs is
smooth, although it starts like a root at a break. Only 1 - chi is shared with the method of dimensionality reduction.

On graded layers 1 - chi = sum_j d_j y^j + rest, y = B/sqrt(k^2 + B^2). The kernel of the sum has a closed form with a
logarithm at x = t. The rest decays so fast that few wave numbers suffice, as for 1 - chi of uniform layers.
"""

from __future__ import annotations

from itertools import pairwise
from math import gamma, inf, pi, sqrt
from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import legder, legval, legvander
from scipy.special import k0, k1

from bem.kernels.of_layer import contact_kernel
from bem.numerics import EPS, gauss, graded, panels
from contact import ElasticLayer, PowerLaw, Profile, Sphere, Spheroconical
from contact.records.validation import FloatArray

# Largest phase of a cosine on a panel of wave numbers, which 40 Gauss nodes integrate to rounding.
_PHASE = 48.0
# Wave numbers that are summed at a time, which bounds the memory.
_CHUNK = 4000
# Least r/a at which the pressure is computed, in place of smaller radii. Half of it doubles rounding errors there.
_AXIS = 1e-6
# t/a at the end of the first panel under a power law r^n: the error for n = 1.07 is 1e-13.
_TIP = 0.02
# B times the thickness. Half or twice of it make the rest a hundred times larger.
_DECAY = 10.0
# Largest wave number of a graded layer over that of a uniform one: at least, over the depth of the first break of its
# constants, and at most. With half of them the rest is ten times larger.
_GRADED, _BREAK, _MOST = 1.5, 0.3, 8.0
# Largest panel of a graded layer over the depth of the first break: with twice of it panels do not resolve the rest.
_LONGEST = 4.0


class Sizes(NamedTuple):
    """All sizes of the discretisation; the error estimate is the change of an answer to finer sizes.

    Attributes:
        nodes: Gauss nodes per panel.
        width: Largest panel over the thickness (the contact radius on the half-space).
        waves: Gauss nodes per panel of wave numbers.
        reach: Largest wave number times the thickness.
        slopes: Gauss nodes per panel of the profile's transform and of the Abel integrals.
        terms: Number of coefficients d_j of a graded layer.
        corner: Length of the last panel towards kinks and edge of a graded layer, over the distance between breaks or
            the largest panel.
        search: Tolerance of ln(a - b) in searches of the radius.
    """

    nodes: int = 20
    width: float = 0.75
    waves: int = 40
    reach: float = 21.0
    slopes: int = 20
    terms: int = 8
    corner: float = 2e-4
    search: float = 1e-13

    @property
    def finer(self) -> Sizes:
        """Finer sizes, for error estimates."""
        sizes = self._replace(nodes=self.nodes + 4, width=0.8 * self.width, waves=self.waves + 6, reach=self.reach + 3)
        return sizes._replace(slopes=self.slopes + 4, terms=self.terms + 1, corner=self.corner / 4)


class Kernel:
    """1 - chi of a layer at wave numbers k [1/m]: a rest that decays fast and, on graded layers, sum_j d_j y^j."""

    def __init__(self, layer: ElasticLayer, sizes: Sizes) -> None:
        self.layer, self.sizes, self.thickness = layer, sizes, layer.surface.thickness
        self.is_uniform, self.is_graded = layer.is_half_space, contact_kernel(layer).is_graded
        self.reach, self.decay, self.d = sizes.reach / self.thickness, _DECAY / self.thickness, np.zeros(1)
        self.width = sizes.width * self.thickness
        if self.is_graded:
            first = min(getattr(layer, "breakpoints", ()), default=inf) / self.thickness
            self.width *= min(1.0, _LONGEST * first)
            # Narrower panels than usual resolve shorter waves too.
            self.reach *= min(max(_GRADED, _BREAK / first), _MOST) * max(1.0, Sizes().width / sizes.width)
            y = self.decay / np.hypot(self.reach, self.decay) * np.sin(pi / 2 * np.linspace(0.04, 1.0, 3 * sizes.terms))
            values = self.one_minus_chi(self.decay * np.sqrt(1 / y**2 - 1))
            self.d = np.linalg.lstsq(y[:, None] ** np.arange(sizes.terms), values / y, rcond=None)[0]

    def one_minus_chi(self, k: FloatArray) -> FloatArray:
        """1 - chi at wave numbers k [1/m], shape (n,)."""
        kernel = contact_kernel(self.layer)
        return kernel.one_minus_chi(k * self.thickness / kernel.units)

    def waves(self, distance: float) -> tuple[FloatArray, FloatArray]:
        """Nodes k and weights times (2/pi) rest, shape (n,) each, for phases up to k times a distance [m]."""
        if self.is_uniform:
            return np.zeros(0), np.zeros(0)
        count = int(np.ceil(self.reach * max(distance / _PHASE, self.thickness / 2)))
        halvings = 4 + int(np.ceil(np.log2(contact_kernel(self.layer).longest)))
        even = self.reach / count * np.arange(1, count + 1)
        k, w = panels(np.concatenate([[0.0], even[0] * 0.5 ** np.arange(halvings, 0, -1), even]), self.sizes.waves)
        y = self.decay / np.hypot(k, self.decay)
        return k, 2 / pi * w * (self.one_minus_chi(k) - y * np.polynomial.polynomial.polyval(y, self.d))

    def tail(self, s: FloatArray) -> FloatArray:
        """(1/pi) int_0^inf sum_j d_j y^j cos ks dk = (B/sqrt(pi)) sum_j d_j (z/2)^v K_v(z)/Gamma(j/2).

        z = B s, v = (j - 1)/2; K_v for v = 0, 1/2, 1, 3/2, the others by their recurrence.
        """
        z = self.decay * np.maximum(s, 1e-300)
        root = np.sqrt(pi) / 2 * np.exp(-z)
        parts = [k0(z), root, z / 2 * k1(z), root * (1 + z) / 2]
        while len(parts) < self.d.size:
            parts.append(z * z / 4 * parts[-4] + (len(parts) / 2 - 1) * parts[-2])
        terms = (d * part / gamma((j + 1) / 2) for j, (d, part) in enumerate(zip(self.d, parts, strict=True)))
        return np.asarray(self.decay / np.sqrt(pi) * sum(terms))


class Panels(NamedTuple):
    """Panels on which t = start + s^2, low < s < high.

    Attributes:
        start: Breaks b [m], shape (p,).
        low: Smallest s of each panel, shape (p,).
        high: Largest s of each panel, shape (p,).
        nodes: Gauss nodes per panel.
    """

    start: FloatArray
    low: FloatArray
    high: FloatArray
    nodes: int

    @property
    def rule(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """s, t and weights of dt at the nodes, shape (p nodes,)."""
        x, w = gauss(self.nodes)
        span = (self.high - self.low)[:, None]
        s = self.low[:, None] + span * x
        return s.ravel(), (self.start[:, None] + s * s).ravel(), (2 * s * span * w).ravel()

    @property
    def to_series(self) -> FloatArray:
        """Legendre coefficients from values at the nodes of a panel, shape (nodes, nodes)."""
        x, w = gauss(self.nodes)
        degree = np.arange(self.nodes)[:, None]
        return np.asarray((2 * degree + 1) * w * legvander(2 * x - 1, self.nodes - 1).T)

    def series(self, values: FloatArray) -> FloatArray:
        """Legendre coefficients on each panel of values at the nodes, shape (nodes, p)."""
        return np.asarray(self.to_series @ values.reshape(-1, self.nodes).T)

    def place(self, t: FloatArray, p: int) -> tuple[FloatArray, FloatArray]:
        """s of the point of panel p closest to t, and the distance of t from the panel [m], shape of t."""
        low, high = self.low[p], self.high[p]
        first, last = self.start[p] + low**2, self.start[p] + high**2
        s = np.clip(np.sqrt(np.maximum(t - self.start[p], 0)), low, high)
        # Points within rounding of an end are set to it, since s varies like the root of the distance.
        s = np.where(np.abs(t - first) <= 4 * EPS * t, low, np.where(np.abs(t - last) <= 4 * EPS * t, high, s))
        gap = np.maximum(first - t, t - last)
        return s, np.where(gap > 4 * EPS * t, gap, 0.0)

    def abel(self, series: FloatArray, r: FloatArray, count: int, *, beyond: bool) -> FloatArray:
        """int g(s)/sqrt(|t^2 - r^2|) ds over t > r (`beyond`) or t < r, shape of r, for a Legendre series g."""
        total, (v, w) = np.zeros_like(r), _one_sided(count, 8)
        for p, (low, high) in enumerate(zip(self.low, self.high, strict=True)):
            here, gap = self.place(r, p)
            i = np.flatnonzero(here < high if beyond else here > low)
            here, gap = here[i, None], gap[i, None]
            length = (high if beyond else low) - here
            step = length * v
            gap = gap + np.abs(step * (2 * here + step))
            root = np.sqrt(gap * (2 * r[i, None] + (gap if beyond else -gap)))
            total[i] += (legval(2 * (here + step - low) / (high - low) - 1, series[:, p]) / root * np.abs(length)) @ w
        return total


def _one_sided(count: int, levels: int) -> tuple[FloatArray, FloatArray]:
    """Composite Gauss rule on [0, 1] with nodes v = u^2, on panels in u that shrink towards 0."""
    u, w = panels(np.concatenate([[0.0], 0.15 ** np.arange(float(levels))[::-1]]), count)
    return u * u, 2 * u * w


def transform(profile: Profile, excess: FloatArray, count: int) -> FloatArray:
    """g_hs [m] at x = b + excess > 0 [m], b the flat radius, shape (n,).

    Between two breaks panels shrink towards both ends, unless f' is continuous at the inner break.
    """
    total, flat, end = np.zeros_like(excess), profile.flat_radius, float(excess.max())
    inner = (b - flat for b in profile.breakpoints if 0 < b - flat < end)
    for low, high in pairwise([0.0, *inner, end]):
        x = excess[excess > low, None]
        far, near = (np.sqrt(np.maximum((x - e) * (x + e + 2 * flat), 0)) for e in (low, high))
        narrow = np.arctan2(near, flat + high)
        span = np.arctan2(far, flat + low) - narrow
        v, w = gauss(count + 10) if low > 0 and flat + low not in profile.kinks else graded(count)
        radius = np.clip((flat + x) * np.cos(narrow + span * v), flat + low, np.nextafter(flat + high, 0))
        total[excess > low] += span[:, 0] * (profile.slope_at(radius) @ w)
    return (flat + excess) * total


def panels_of(profile: Profile, a: float, kernel: Kernel) -> Panels:
    """Panels of the contact of radius a [m], shorter than the distance of s from singularities of phi."""
    width = kernel.sizes.width * a if kernel.is_uniform else kernel.width
    pole = profile.radius if isinstance(profile, Sphere | Spheroconical) else inf
    ends = np.unique([0.0, *(b for b in (profile.flat_radius, *profile.breakpoints) if b < a), a]).tolist()
    ranges = []
    for i, (start, stop) in enumerate(pairwise(ends)):
        gap = min(start - ends[i - 1], abs(pole - start)) if i else _TIP * a if isinstance(profile, PowerLaw) else width
        corner = stop if kernel.is_graded and (stop == a or stop in profile.kinks) else inf
        upright, shortest = pole if pole > stop else inf, kernel.sizes.corner * min(width, stop - start)
        low, high = 0.0, sqrt(stop - start)
        while low < high:
            t = start + low**2
            longest = min(width, max((corner - t) / 2, shortest), (upright - t) / 3)
            end = min(low + sqrt((low**2 + gap) / 2), sqrt(low**2 + longest))
            ranges.append((start, low, end if end < high * (1 - 1e-9) else high))
            low = ranges[-1][-1]
    starts, lows, highs = np.array(ranges).T
    return Panels(starts, lows, highs, kernel.sizes.nodes)


class Density:
    """Solution at one contact radius; columns of arrays belong to the right-hand sides 1 and g_hs.

    Args:
        kernel: Kernel 1 - chi of the layer.
        profile: The indenter.
        a: Contact radius [m].
    """

    def __init__(self, kernel: Kernel, profile: Profile, a: float) -> None:
        self.kernel, self.profile, self.a = kernel, profile, a
        self.panels = panels_of(profile, a, kernel)
        self.s, self.t, self.w = self.panels.rule
        # Beyond a flat end g_hs needs the digits of t - b.
        self.load = self._load(np.repeat(self.panels.start - profile.flat_radius, kernel.sizes.nodes) + self.s**2)
        self.phi = self._solved()
        self.integrals = self.w @ self.phi
        self.edge = (self._load(np.array([a - profile.flat_radius])) + self.psi(np.array([a])))[0]
        # phi(a) = 0
        self.depth = float(self.edge[1] / self.edge[0])

    def _load(self, excess: FloatArray) -> FloatArray:
        """Right-hand sides 1 and g_hs at x = b + excess [m], b the flat radius, shape (n, 2)."""
        return np.column_stack([np.ones(excess.size), transform(self.profile, excess, self.kernel.sizes.slopes)])

    def _solved(self) -> FloatArray:
        """phi at the nodes, shape (nodes, 2)."""
        k, weight = self.kernel.waves(2 * self.a)
        waves = np.cos(np.multiply.outer(k, self.t))
        matrix = (waves.T * weight) @ (waves * self.w) + self._tail(self.t)
        return np.asarray(np.linalg.solve(np.eye(self.t.size) - matrix, self.load))

    def psi(self, x: FloatArray) -> FloatArray:
        """int_0^a L(x, t) phi(t) dt at x >= 0 [m], also outside the contact, shape (x.size, 2)."""
        k, weight = self.kernel.waves(self.a + float(x.max()))
        total = self._tail(x) @ self.phi
        for i in range(0, k.size, _CHUNK):
            some = k[i : i + _CHUNK]
            spectrum = np.cos(np.multiply.outer(some, self.t)) @ (self.w[:, None] * self.phi)
            total += np.cos(np.multiply.outer(x, some)) @ (weight[i : i + _CHUNK, None] * spectrum)
        return total

    def _tail(self, x: FloatArray) -> FloatArray:
        """Weights of phi at the nodes in the part of int L(x, t) phi(t) dt from `Kernel.tail`, shape (x.size, nodes).

        If x or -x is closer to a panel than its length, quadrature panels shrink towards the point.
        """
        rows, grid, (v, u) = np.zeros((x.size, self.t.size)), self.panels, _one_sided(self.kernel.sizes.slopes, 6)
        if not self.kernel.is_graded:
            return rows
        for target in (x, -x):
            part = self.kernel.tail(np.abs(target[:, None] - self.t)) * self.w
            for p, (start, low, high) in enumerate(zip(*grid[:3], strict=True)):
                here, gap = grid.place(target, p)
                near = np.flatnonzero(gap < high**2 - low**2)
                middle = here[near, None]
                s = np.concatenate([middle + (low - middle) * v, middle + (high - middle) * v], axis=1)
                weight = np.concatenate([(middle - low) * u, (high - middle) * u], axis=1)
                weight *= 2 * s * self.kernel.tail(np.abs(target[near, None] - start - s * s))
                table = legvander(2 * (s - low) / (high - low) - 1, grid.nodes - 1)
                rule = np.einsum("ij,ijl->il", weight, table) @ grid.to_series
                part[near, p * grid.nodes : (p + 1) * grid.nodes] = rule
            rows += part
        return rows

    def pressure(self, r: FloatArray, depth: float, *, is_singular: bool) -> FloatArray:
        """pi p(r)/E* = phi(a)/sqrt(a^2 - r^2) - int_r^a phi'(t)/sqrt(t^2 - r^2) dt at r < a [m], Eq. (9)."""
        grid = self.panels
        slope = 2 * legder(grid.series(self.phi @ [depth, -1.0])) / (grid.high - grid.low)  # d phi/ds
        smooth = grid.abel(slope, np.maximum(r, _AXIS * self.a), self.kernel.sizes.slopes, beyond=True)
        if not is_singular:
            return -smooth
        return np.asarray(self.edge @ [depth, -1.0] / np.sqrt((self.a - r) * (self.a + r)) - smooth)

    def displacement(self, r: FloatArray, depth: float) -> FloatArray:
        """w(r) = (2/pi) int_0^r W(t)/sqrt(r^2 - t^2) dt at r > a [m], W = depth - g_hs inside, -psi outside."""
        grid, count, under = self.panels, self.kernel.sizes.slopes, np.array([depth, -1.0])
        total = grid.abel(grid.series(2 * self.s * (self.load @ under)), r, count, beyond=False)
        if not self.kernel.is_uniform:
            step, ends = sqrt(self.kernel.width / 2), [0.0]
            while self.a + ends[-1] ** 2 < r.max():
                ends.append(ends[-1] + max(step - ends[-1] / 2, ends[-1] / 2))
            grid = Panels(np.full(len(ends) - 1, self.a), np.array(ends[:-1]), np.array(ends[1:]), grid.nodes)
            s, t, _ = grid.rule
            total -= grid.abel(grid.series(2 * s * (self.psi(t) @ under)), r, count, beyond=False)
        return np.asarray(2 / pi * total)
