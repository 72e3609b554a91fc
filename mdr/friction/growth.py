"""Growing contact of a convex tip under full stick, a superposition of adhered punches of all radii.

    g_hs(x) = int_0^x M(x; a) d delta(a),   F = int k_stick d delta,   M = Re[((x + a)/(x - a))^(i eps) G(x; a)]

with G of `Adhered.beside`, a polynomial of x and a. Between radii where the profile is not analytic, d delta/du is
u^(lead - 1) times a polynomial of u, a = start + length u^power. Its coefficients follow by least squares. Lengths are
in units of the kernel.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray
from scipy.special import j0

from bem.kernels.stack import StackKernel
from contact.records.validation import FloatArray
from mdr.friction.adhered_punch import REACH, Adhered, ComplexArray, Density, Rule, abel, towards_one
from mdr.inside import wave_rule
from mdr.profiles import Tip

# Numbers of nodes in a and in x of the table of G: at a/h = 0, and per a/h. With a fifth less three digits are lost.
_PUNCHES, _PLACES = (26, 4.5), (28, 5.5)
# Least number of both per `Punches.root`. With 6 the error over a base a hundred times as soft is 1e-7.
_PER_ROOT = 9.0
# Number of coefficients on a stretch: at a/h = 0 and per a/h, per `Punches.root`, and the largest number by the latter.
# With 70 rounding errors are 5e-8.
_UNKNOWNS, _UNKNOWNS_PER_ROOT, _MOST = (20, 5.0), 2.5, 46.0


def _nodes(count: int) -> FloatArray:
    """Chebyshev nodes on [0, 1]."""
    return np.asarray((1 - np.cos(np.pi * (np.arange(count) + 0.5) / count)) / 2)


class Punches:
    """Adhered punches of all radii up to `end` on one layer: G(x; a) and k_stick as polynomials of x and a."""

    def __init__(self, kernel: StackKernel, end: float, extra: int) -> None:
        self.kernel, self.end = kernel, end
        self.size = 0.0 if kernel.is_half_space else end
        self.root = float(np.sqrt(self.size * (kernel.longest - 1)))
        radii, places = (
            end * _nodes(int(max(least + rate * self.size, _PER_ROOT * self.root)) + extra)
            for least, rate in (_PUNCHES, _PLACES)
        )
        punches = [Adhered(kernel, a, extra, end / a) for a in radii.tolist()]
        self._stiffness = self._fitted(radii, np.array([punch.stiffness / punch.a for punch in punches]))
        beside = np.array([punch.beside(places / punch.a) for punch in punches])
        self._table = self._fitted(radii, self._fitted(places, beside.T).T)  # coefficients in a, x
        self.largest = punches[-1]

    def _fitted(self, x: FloatArray, values: NDArray[np.inexact]) -> NDArray[np.inexact]:
        """Chebyshev coefficients on [0, end] of values at x, first axis."""
        return np.asarray(chebyshev.chebfit(2 * x / self.end - 1, values, x.size - 1))

    def at(self, a: FloatArray) -> ComplexArray:
        """Chebyshev coefficients of G(x; a) in x, first axis, at radii a."""
        return np.asarray(chebyshev.chebval(2 * a / self.end - 1, self._table))

    def stiffness(self, a: FloatArray) -> FloatArray:
        """k_stick/E* at radii a, shape (n,)."""
        return np.asarray(2 * a * chebyshev.chebval(2 * a / self.end - 1, self._stiffness))


@lru_cache(maxsize=32)
def punches_of(kernel: StackKernel, end: float, extra: int) -> Punches:
    """The punches of one layer, cached."""
    return Punches(kernel, end, extra)


@dataclass(frozen=True)
class Stretch:
    """Radii start + (end - start) u^power, on which d delta/du is u^(lead - 1) times a polynomial of u.

    Attributes:
        start: First radius.
        end: Last radius.
        power: Exponent of u.
        lead: Exponent of the depth at the first radius.
        count: Number of coefficients of the polynomial.
    """

    start: float
    end: float
    power: int
    lead: float
    count: int

    def steps(self, low: float, high: float, rule: Rule, *, to_high: bool) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Quadrature of d delta over radii from low to high.

        Returns radii a, shape (q,), their distances from high (or low) without cancellation, and weights of d delta per
        coefficient of the polynomial, shape (q, count).
        """
        length, (v, rest, w) = self.end - self.start, rule
        first, last = (np.clip((x - self.start) / length, 0, 1) ** (1 / self.power) for x in (low, high))
        u = first + (last - first) * (v if to_high else rest)
        distance = length * (last - first) * rest * (1.0 if self.power == 1 else u + (last if to_high else first))
        distance = distance + (max(0.0, high - self.end) if to_high else max(0.0, self.start - low))
        rows = ((last - first) * w * u ** (self.lead - 1))[:, None] * chebyshev.chebvander(2 * u - 1, self.count - 1)
        return self.start + length * u**self.power, np.maximum(distance, 1e-300), rows


class Growth:
    """The contact of one tip up to the radius `end`.

    Args:
        kernel: Kernel of the layer.
        tip: The profile, in metres.
        unit: Length of the kernel [m].
        end: Largest radius in units.
        extra: Increase of the sizes of the discretisation.
    """

    def __init__(self, kernel: StackKernel, tip: Tip, unit: float, end: float, extra: int) -> None:
        self.kernel, self.tip, self.unit, self.end = kernel, tip, unit, end
        # The largest radius of the table is a power of 1.2, so that scenes share tables.
        table_end = end if kernel.is_half_space else float(1.2 ** np.ceil(np.log(end) / np.log(1.2) - 1e-9))
        self.punches = punches_of(kernel, table_end, extra)
        self.rule = towards_one(16 + extra, 0 if tip.exponent % 1 == 0 else 6)
        usual = _UNKNOWNS[0] + _UNKNOWNS[1] * self.punches.size
        count = int(max(usual, min(usual + _UNKNOWNS_PER_ROOT * self.punches.root, _MOST)))
        self._solve(tip.exponent, count + extra)

    def _solve(self, lead: float, count: int) -> None:
        """Solve g_hs(x) = int_0^x M d delta for d delta on each stretch in turn, by least squares.

        The number of equations is 1.25 times that of the unknowns; `lead` is the exponent of delta at the tip.
        """
        flat, unit = self.tip.flat / self.unit, self.unit
        ends = [flat, *(b / unit for b in self.tip.breaks if flat < b / unit < self.end), self.end]
        self.parts: list[tuple[Stretch, FloatArray]] = []
        for low, high in pairwise(ends):
            stretch = Stretch(low, high, 2 if low else 1, 1.0 if low else lead, count)
            u = _nodes(int(1.25 * count))
            x = low + (high - low) * u**stretch.power
            earlier = np.array([sum(self._integral(part, y) @ c for part, c in self.parts) for y in x.tolist()])
            scale = u**-stretch.lead
            rows = scale[:, None] * np.array([self._integral(stretch, y) for y in x.tolist()])
            g_hs = self.tip.transform(x * unit) / unit
            self.parts.append((stretch, np.linalg.lstsq(rows, scale * (g_hs - earlier), rcond=None)[0]))

    def _integral(self, stretch: Stretch, x: float) -> FloatArray:
        """int M(x; a) d delta over the radii of one stretch up to x, per coefficient of d delta."""
        a, gap, rows = stretch.steps(0.0, x, self.rule, to_high=True)
        G = chebyshev.chebval(2 * x / self.punches.end - 1, self.punches.at(a))
        M = np.exp(1j * self.punches.largest.eps * np.log((x + a) / gap)) * G
        return np.asarray(M.real @ rows)

    def states(self, radii: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Depth, F/E* and k_stick/E* at contact radii, each of shape (n,)."""
        depth, force = np.zeros(radii.size), np.zeros(radii.size)
        for i, x in enumerate(radii.tolist()):
            for stretch, c in self.parts:
                a, _, rows = stretch.steps(0.0, x, self.rule, to_high=True)
                step = rows @ c
                depth[i] += step.sum()
                force[i] += self.punches.stiffness(a) @ step
        return depth, force, self.punches.stiffness(radii)

    def _beyond(self, x: float, a: float, rule: Rule) -> list[tuple[FloatArray, FloatArray, FloatArray]]:
        """Quadrature from x to a on each stretch: radii, their distances from x, and weights d delta, shape (q,)."""
        reached = [(stretch, c) for stretch, c in self.parts if stretch.end > x and stretch.start < a]
        nodes = [(stretch.steps(x, a, rule, to_high=False), c) for stretch, c in reached]
        return [(size, gap, rows @ c) for (size, gap, rows), c in nodes]

    def tractions(self, r: FloatArray, a: float) -> FloatArray:
        """p and q over E* at radii r < a of the contact of radius a, shape (2, n): sums over punches larger than r."""
        tractions, (_, rest, w) = np.zeros((2, r.size)), self.rule
        squared = 1 - rest**2, rest**2, 2 * rest * w  # tractions of a punch are 1/sqrt(gap)
        for i, x in enumerate(r.tolist()):
            for size, gap, step in self._beyond(x, a, squared):
                density = self._unit_densities(size[:, None], self.punches.at(size)[..., None])
                tractions[:, i] += abel(x / size, gap * (size + x) / size**2, self.rule, density) @ (step / size)
        return 2 * self.punches.largest.beta / np.pi * tractions

    def _unit_densities(self, size: FloatArray, columns: ComplexArray) -> Density:
        """Function of t and rest = 1 - t: Phi and (1 - t^2) Phi' of punches of radii `size` at unit depth.

        `columns` are their coefficients of G in x.
        """
        eps, end = self.punches.largest.eps, self.punches.end
        slopes = chebyshev.chebder(columns) * 2 / end

        def density(t: FloatArray, rest: FloatArray) -> tuple[ComplexArray, ComplexArray]:
            """Phi and (1 - t^2) Phi' at t in [0, 1)."""
            y = 2 * t * size / end - 1
            g, change = (chebyshev.chebval(y, coefficients, tensor=False) for coefficients in (columns, slopes))
            rho = np.exp(1j * eps * np.log((1 + t) / rest)) / np.sqrt(self.punches.largest.kap)
            return rho * g, rho * (2j * eps * g + rest * (1 + t) * size * change)

        return density

    def displacement(self, r: FloatArray, a: float) -> FloatArray:
        """u_z at radii r > a outside the contact of radius a, from the density summed over all punches."""
        punch, (v, rest, w) = self.punches.largest, self.rule
        t = a * v
        phi = a * w * np.array([self._density(x, a) for x in t.tolist()])
        half_space = 1 / np.sqrt(((r - a)[:, None] + a * rest) * (r[:, None] + t)) @ phi.real
        layer: FloatArray | float = 0.0
        if not self.kernel.is_half_space:
            k, weight = wave_rule(REACH, a + float(r.max()), self.kernel.longest, punch.nodes)
            _, uw, ww = self.kernel.beyond_half_space(k)
            angle = np.multiply.outer(k, t)
            load = ww * (np.cos(angle) @ phi.real) + uw * (np.sin(angle) @ phi.imag)
            layer = j0(np.multiply.outer(r, k)) @ (weight * load)
        return np.asarray(2 / np.pi * (2 * punch.beta * half_space + layer))

    def _density(self, x: float, a: float) -> complex:
        """Phi at x, summed over all punches larger than x."""
        punch, total = self.punches.largest, 0j
        for size, gap, step in self._beyond(x, a, self.rule):
            G = chebyshev.chebval(2 * x / self.punches.end - 1, self.punches.at(size))
            total += (np.exp(1j * punch.eps * np.log((size + x) / gap)) * G) @ step
        return complex(total / np.sqrt(punch.kap))
