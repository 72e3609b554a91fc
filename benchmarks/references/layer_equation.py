"""Flat punches and profiles on layers from the Fredholm equation of the kernel, written down in extended precision.

With lengths in units of the thickness and stresses in units of E*, the Abel density phi of a contact of radius a obeys

    phi(x) - (2/pi) int_0^a L(x, t) phi(t) dt = W(x),    L(x, t) = int_0^inf (1 - chi(k)) cos(k x) cos(k t) dk,

with W = 1 for the flat punch at unit depth and W = g(x), the half-space transform of Eq. (15), for a profile; the
kernel chi is that of Eqs. (29) and (31). Nothing here is shared with the solvers: neither code, nor quadrature, nor
precision.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from mpmath import mp, mpf

Function = Callable[[mpf], mpf]

# Working precision in decimal digits; the kernel as printed loses ten of them at small wavenumbers.
DIGITS = 34
# Wavenumbers beyond this are left out: 1 - chi has fallen to exp(-2 k) k^2, below 1e-19.
LARGEST_WAVENUMBER = 24
# Panels in k are this wide, so that the nearest poles of chi, about one away from the axis, do not slow the rule down.
PANEL = mpf(1) / 2
# Gauss nodes on each panel.
NODES = 16


def chi(q: mpf, poissons_ratio: mpf | None) -> mpf:
    """Compliance kernel of a bonded layer, Eq. (31), or of an unbonded one (no Poisson's ratio), Eq. (29)."""
    if poissons_ratio is None:
        return 2 * mp.sinh(q) ** 2 / (2 * q + mp.sinh(2 * q))
    kappa = 3 - 4 * poissons_ratio
    return (2 * kappa * mp.sinh(2 * q) - 4 * q) / (1 + 4 * q**2 + kappa**2 + 2 * kappa * mp.cosh(2 * q))


def gauss(low: mpf, high: mpf, count: int) -> tuple[list[mpf], list[mpf]]:
    """Gauss-Legendre nodes and weights on [low, high]: roots of P_n by Newton's method."""
    nodes, weights = [], []
    for i in range(count):
        x = mp.cos(mp.pi * (i + mpf(3) / 4) / (count + mpf(1) / 2))
        for _ in range(7):
            value, slope = _legendre(count, x)
            x -= value / slope
        nodes.append((low + high) / 2 + (high - low) / 2 * x)
        weights.append((high - low) / ((1 - x**2) * _legendre(count, x)[1] ** 2))
    return nodes, weights


def _legendre(count: int, x: mpf) -> tuple[mpf, mpf]:
    """P_n and its derivative."""
    before, now = mpf(1), x
    for n in range(2, count + 1):
        before, now = now, ((2 * n - 1) * x * now - (n - 1) * before) / n
    return now, count * (x * now - before) / (x**2 - 1)


@dataclass(frozen=True)
class DensityInDigits:
    """phi of one right-hand side: W plus a smooth part, known at Gauss nodes and continued by the equation itself.

    Attributes:
        value: phi(x).
        slope: phi'(x) - W'(x).
        total: int_0^a phi dx.
    """

    value: Function
    slope: Function
    total: mpf


class Contact:
    """One contact radius a (over the thickness) on one layer."""

    def __init__(self, ratio: mpf, poissons_ratio: mpf | None, nodes: int) -> None:
        self.a = mpf(ratio)
        self._x, self._w = gauss(mpf(0), self.a, nodes)
        self._k, self._weight = self._wavenumbers(poissons_ratio)
        self._cos = [[mp.cos(k * x) for k in self._k] for x in self._x]
        scaled = [[c * w for c, w in zip(row, self._weight, strict=True)] for row in self._cos]
        self._matrix = mp.matrix(nodes, nodes)
        for i in range(nodes):
            for j in range(i + 1):
                entry = mp.fdot(scaled[i], self._cos[j])
                self._matrix[i, j] = -entry * self._w[j]
                self._matrix[j, i] = -entry * self._w[i]
            self._matrix[i, i] += 1

    def density(self, source: Function, breaks: Sequence[mpf] = ()) -> DensityInDigits:
        """Solve for a right-hand side W that is smooth but for roots of x - b at ``breaks`` b."""
        places, weights = self._rule(breaks)
        given = [w * source(t) for t, w in zip(places, weights, strict=True)]
        # Moments int W(t) cos(k t) dt, so that the smooth part alone is left unknown.
        moments = [mp.fdot(given, [mp.cos(k * t) for t in places]) for k in self._k]
        smooth = self._solved([self._applied(moments, row) for row in self._cos])
        loads = [w * s for w, s in zip(self._w, smooth, strict=True)]
        total = [m + mp.fdot(loads, [row[n] for row in self._cos]) for n, m in enumerate(moments)]
        return DensityInDigits(
            value=lambda x: source(x) + self._applied(total, [mp.cos(k * x) for k in self._k]),
            slope=lambda x: self._applied(total, [-k * mp.sin(k * x) for k in self._k]),
            total=mp.fsum(given) + mp.fsum(loads),
        )

    @property
    def first_order(self) -> mpf:
        """(2/pi) int (1 - chi) dk."""
        return mp.fsum(self._weight)

    def _applied(self, moments: Sequence[mpf], row: Sequence[mpf]) -> mpf:
        return mp.fdot(moments, [w * c for w, c in zip(self._weight, row, strict=True)])

    def _solved(self, right: list[mpf]) -> list[mpf]:
        return list(mp.lu_solve(self._matrix, mp.matrix(right)))

    def _wavenumbers(self, poissons_ratio: mpf | None) -> tuple[list[mpf], list[mpf]]:
        """Nodes k, and weights that hold (2/pi) (1 - chi(k))."""
        width = PANEL / (1 + self.a / 8)
        nodes, weights = gauss(mpf(0), mpf(1), NODES)
        k = [width * (n + x) for n in range(int(LARGEST_WAVENUMBER / width) + 1) for x in nodes]
        own = [width * w for _ in range(len(k) // NODES) for w in weights]
        return k, [2 / mp.pi * w * (1 - chi(q, poissons_ratio)) for q, w in zip(k, own, strict=True)]

    def _rule(self, breaks: Sequence[mpf]) -> tuple[list[mpf], list[mpf]]:
        """Places and weights on [0, a], with x = b + s^2 beyond each break b, where the root is smooth in s."""
        ends = [mpf(0), *breaks, self.a]
        places, weights = gauss(ends[0], ends[1], 2 * len(self._x))
        for b, end in pairwise(ends[1:]):
            s, w = gauss(mpf(0), mp.sqrt(end - b), 2 * len(self._x))
            places = places + [b + v**2 for v in s]
            weights = weights + [2 * v * u for v, u in zip(s, w, strict=True)]
        return places, weights


def punch(ratio: float | str, poissons_ratio: str | None, nodes: int) -> tuple[Contact, DensityInDigits]:
    """The flat punch at unit depth."""
    nu = None if poissons_ratio is None else mpf(poissons_ratio)
    contact = Contact(mpf(ratio), nu, nodes)
    return contact, contact.density(lambda x: mpf(1))


def stiffness(ratio: str, nu: str | None, nodes: int) -> mpf:
    """kbar = k_N/(2 E* a)."""
    contact, flat = punch(ratio, nu, nodes)
    return flat.total / contact.a


def spring(ratio: mpf | str, nu: str | None, nodes: int) -> mpf:
    """cbar = c_N/E* = phi(a)^2 of the flat punch."""
    contact, flat = punch(ratio, nu, nodes)
    return flat.value(contact.a) ** 2


def pressed(contact: Contact, flat: DensityInDigits, profile: DensityInDigits) -> tuple[mpf, mpf]:
    """Depth at which phi vanishes at the contact's edge, and the force over E*; lengths in thicknesses."""
    depth = profile.value(contact.a) / flat.value(contact.a)
    return depth, 2 * (depth * flat.total - profile.total)


def paraboloid(ratio: str, nu: str | None, nodes: int) -> tuple[mpf, mpf]:
    """delta R/h^2 and F R/(E* h^3), from g = x^2/R."""
    contact, flat = punch(ratio, nu, nodes)
    return pressed(contact, flat, contact.density(lambda x: x**2))


def truncated_cone(ratio: str, nu: str | None, nodes: int) -> tuple[mpf, mpf]:
    """delta/(a tan) and F/(E* a^2 tan) for b = a/2, from g = x arccos(b/x) beyond b."""
    contact, flat = punch(ratio, nu, nodes)
    b = contact.a / 2
    profile = contact.density(lambda x: x * mp.acos(b / x) if x > b else mpf(0), (b,))
    depth, force = pressed(contact, flat, profile)
    return depth / contact.a, force / contact.a**2


def pressure(ratio: str, nu: str | None, nodes: int, places: Sequence[str]) -> list[mpf]:
    """p/p_mean of the flat punch at r/a, Eq. (9): with t^2 = r^2 + y^2 no root is left under the integral."""
    contact, flat = punch(ratio, nu, nodes)
    mean = 2 * flat.total / contact.a**2
    values = []
    for place in places:
        r = mpf(place) * contact.a
        end = mp.sqrt(contact.a**2 - r**2)
        y, w = gauss(mpf(0), end, nodes)
        t = [mp.sqrt(r**2 + v**2) for v in y]
        inner = mp.fsum(u * flat.slope(s) / s for u, s in zip(w, t, strict=True))
        values.append((flat.value(contact.a) / end - inner) / mean)
    return values


def first_order(nu: str | None) -> mpf:
    """alpha = (2/pi) int (1 - chi) dq, the first coefficient of kbar in a/h."""
    contact = Contact(mpf("0.01"), None if nu is None else mpf(nu), 4)
    return contact.first_order


def largest_elongation(nu: str, near: str, nodes: int) -> tuple[mpf, mpf]:
    """a/h where (a/h)/cbar is largest, Eq. (42), and the root of that maximum."""

    def logarithm(x: mpf) -> mpf:
        return mp.log(x / spring(x, nu, nodes))

    step = mpf("1e-6")
    place = mp.findroot(
        lambda x: logarithm(x + step) - logarithm(x - step), (mpf(near), mpf(near) + mpf("1e-3")), tol=1e-36
    )
    return place, mp.exp(logarithm(place) / 2)
