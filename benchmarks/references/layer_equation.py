"""Flat punches and profiles on layers from the Fredholm equation of the kernel, in extended precision.

With lengths in units of the thickness and stresses in units of E*, the Abel density phi of a contact of radius a obeys

    phi(x) - (2/pi) int_0^a L(x, t) phi(t) dt = W(x),    L(x, t) = int_0^inf (1 - chi(k)) cos(k x) cos(k t) dk,

with W = 1 for the flat punch at unit depth and W = g(x), the half-space transform of Eq. (15), for a profile; the
kernel chi is that of Eqs. (29) and (31). The solvers share neither code nor quadrature nor precision with this module.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from mpmath import mp, mpf

Function = Callable[[mpf], mpf]

# Working precision in decimal digits; the printed formula of the kernel loses ten of them at small wavenumbers.
DIGITS = 34
# Largest wavenumber: beyond it 1 - chi, which falls like k^2 exp(-2 k), is below 1e-19.
LARGEST_WAVENUMBER = 24
# Width of panels in k: the nearest poles of chi, at a distance of about one from the axis, do not limit convergence.
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
    """Legendre polynomial P_n and its derivative at x."""
    previous, current = mpf(1), x
    for n in range(2, count + 1):
        previous, current = current, ((2 * n - 1) * x * current - (n - 1) * previous) / n
    return current, count * (x * current - previous) / (x**2 - 1)


@dataclass(frozen=True)
class DensityInDigits:
    """Abel density phi of one right-hand side W: W plus a smooth part, evaluated by the equation at any x.

    Attributes:
        value: Function phi(x).
        slope: Function phi'(x) - W'(x).
        total: Integral int_0^a phi dx.
    """

    value: Function
    slope: Function
    total: mpf


class Contact:
    """Discrete equation for one contact radius on one layer.

    Args:
        ratio: Contact radius over thickness, a/h.
        poissons_ratio: Poisson's ratio of a bonded layer; None for an unbonded layer.
        nodes: Number of Gauss nodes on [0, a].
    """

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
        """Density phi of a right-hand side W(x) that is smooth except for roots of x - b at ``breaks`` b."""
        nodes, weights = self._rule(breaks)
        loaded = [w * source(t) for t, w in zip(nodes, weights, strict=True)]
        # Moments int W(t) cos(k t) dt, so that only the smooth part is unknown.
        moments = [mp.fdot(loaded, [mp.cos(k * t) for t in nodes]) for k in self._k]
        smooth = self._solved([self._applied(moments, row) for row in self._cos])
        loads = [w * s for w, s in zip(self._w, smooth, strict=True)]
        all_moments = [m + mp.fdot(loads, [row[n] for row in self._cos]) for n, m in enumerate(moments)]
        return DensityInDigits(
            value=lambda x: source(x) + self._applied(all_moments, [mp.cos(k * x) for k in self._k]),
            slope=lambda x: self._applied(all_moments, [-k * mp.sin(k * x) for k in self._k]),
            total=mp.fsum(loaded) + mp.fsum(loads),
        )

    @property
    def first_order(self) -> mpf:
        """Coefficient alpha = (2/pi) int (1 - chi) dk, first order of kbar in a/h."""
        return mp.fsum(self._weight)

    def _applied(self, moments: Sequence[mpf], row: Sequence[mpf]) -> mpf:
        """(2/pi) int (1 - chi) moments(k) row(k) dk."""
        return mp.fdot(moments, [w * c for w, c in zip(self._weight, row, strict=True)])

    def _solved(self, right: list[mpf]) -> list[mpf]:
        """Values at the Gauss nodes that solve the discrete equation."""
        return list(mp.lu_solve(self._matrix, mp.matrix(right)))

    def _wavenumbers(self, poissons_ratio: mpf | None) -> tuple[list[mpf], list[mpf]]:
        """Nodes k, and quadrature weights times (2/pi) (1 - chi(k))."""
        width = PANEL / (1 + self.a / 8)
        nodes, weights = gauss(mpf(0), mpf(1), NODES)
        k = [width * (n + x) for n in range(int(LARGEST_WAVENUMBER / width) + 1) for x in nodes]
        panel_weights = [width * w for _ in range(len(k) // NODES) for w in weights]
        return k, [2 / mp.pi * w * (1 - chi(q, poissons_ratio)) for q, w in zip(k, panel_weights, strict=True)]

    def _rule(self, breaks: Sequence[mpf]) -> tuple[list[mpf], list[mpf]]:
        """Nodes and weights on [0, a], with x = b + s^2 beyond each break b, where roots of x - b are smooth in s."""
        ends = [mpf(0), *breaks, self.a]
        nodes, weights = gauss(ends[0], ends[1], 2 * len(self._x))
        for b, end in pairwise(ends[1:]):
            s, w = gauss(mpf(0), mp.sqrt(end - b), 2 * len(self._x))
            nodes = nodes + [b + v**2 for v in s]
            weights = weights + [2 * v * u for v, u in zip(s, w, strict=True)]
        return nodes, weights


def punch(ratio: float | str, poissons_ratio: str | None, nodes: int) -> tuple[Contact, DensityInDigits]:
    """Discrete equation of a contact radius, and the density of the flat punch at unit depth."""
    nu = None if poissons_ratio is None else mpf(poissons_ratio)
    contact = Contact(mpf(ratio), nu, nodes)
    return contact, contact.density(lambda x: mpf(1))


def stiffness(ratio: str, nu: str | None, nodes: int) -> mpf:
    """Stiffness kbar = k_N/(2 E* a) of the flat punch."""
    contact, flat = punch(ratio, nu, nodes)
    return flat.total / contact.a


def spring(ratio: mpf | str, nu: str | None, nodes: int) -> mpf:
    """Spring stiffness cbar = c_N/E* = phi(a)^2 of the flat punch."""
    contact, flat = punch(ratio, nu, nodes)
    return flat.value(contact.a) ** 2


def pressed(contact: Contact, flat: DensityInDigits, profile: DensityInDigits) -> tuple[mpf, mpf]:
    """Depth at which phi vanishes at the contact edge, and force over E*; lengths over the thickness."""
    depth = profile.value(contact.a) / flat.value(contact.a)
    return depth, 2 * (depth * flat.total - profile.total)


def paraboloid(ratio: str, nu: str | None, nodes: int) -> tuple[mpf, mpf]:
    """Depth delta R/h^2 and force F R/(E* h^3) of a paraboloid, from g = x^2/R."""
    contact, flat = punch(ratio, nu, nodes)
    return pressed(contact, flat, contact.density(lambda x: x**2))


def truncated_cone(ratio: str, nu: str | None, nodes: int) -> tuple[mpf, mpf]:
    """Depth delta/(a tan) and force F/(E* a^2 tan) of a truncated cone, b = a/2, from g = x arccos(b/x) beyond b."""
    contact, flat = punch(ratio, nu, nodes)
    b = contact.a / 2
    profile = contact.density(lambda x: x * mp.acos(b / x) if x > b else mpf(0), (b,))
    depth, force = pressed(contact, flat, profile)
    return depth / contact.a, force / contact.a**2


def pressure(ratio: str, nu: str | None, nodes: int, places: Sequence[str]) -> list[mpf]:
    """Pressure p/p_mean of the flat punch at r/a = ``places``, Eq. (9), with t^2 = r^2 + y^2 to remove the root."""
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
    """Coefficient alpha = (2/pi) int (1 - chi) dq, first order of kbar in a/h."""
    contact = Contact(mpf("0.01"), None if nu is None else mpf(nu), 4)
    return contact.first_order


def largest_elongation(nu: str, near: str, nodes: int) -> tuple[mpf, mpf]:
    """Ratio a/h at which (a/h)/cbar is largest, Eq. (42), and the square root of that maximum."""

    def logarithm(x: mpf) -> mpf:
        """ln((a/h)/cbar) at x = a/h."""
        return mp.log(x / spring(x, nu, nodes))

    step = mpf("1e-6")
    place = mp.findroot(
        lambda x: logarithm(x + step) - logarithm(x - step), (mpf(near), mpf(near) + mpf("1e-3")), tol=1e-36
    )
    return place, mp.exp(logarithm(place) / 2)
