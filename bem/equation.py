"""The equation of contact at every radius, solved once for all profiles.

The pressure's Abel density phi on [0, a] obeys phi - B phi = W with W = depth - g_hs and

    B(x, t) = (2/pi) int_0^inf (1 - chi) cos kx cos kt dk.

B phi is smooth whatever the kinks of W, so a few even Legendre polynomials b_n(t/a) represent it. Their cosine
transforms c_n(k a) are spherical Bessel functions: one table serves all layers and all profiles. With A = 1 - B in
these polynomials,

    punch     = A^-1 e_0,   k_N = 2 E* K,  K = a punch_0           stiffness of the flat punch, Eq. (10)
    resolvent = A^-1 (int B(a, t) b_n(t) dt),  y_1 = 1 + resolvent_0,  c_N = E* y_1^2       springs, Eq. (6)
    g(a)      = [g_hs(a) + sum_n resolvent_n m_n]/y_1,  m_n = int_0^1 g_hs(a s) b_n(s) ds    MDR profile, Eq. (8)
    M(a)      = a sum_n punch_n m_n,                     F = 2 E* (depth K - M)              force, Eq. (4)

No profile enters punch and resolvent. They are smooth in a and interpolated over octaves.
Lengths count in units of the kernel (`bem.kernels.of_layer.unit_of`).
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.kernels.of_layer import ContactKernel
from bem.numerics import (
    Octaves,
    cholesky,
    even_bessel,
    even_bessel_second,
    gauss,
    panels,
    solve_factored,
    special,
)
from contact.records.validation import FloatArray

# a/h beyond which A is factored by QR of its square root. Below 4 Cholesky is as good and faster; beyond 16 Cholesky
# loses a digit of k_N at nu = 1/2.
_ROOT_FROM = 8.0
# Range of k a over which c c^T is replaced by its mean, 24 periods. At half of it the error of k_N is 1e-12.
_TURNING = 24 * np.pi
# Largest r/a at which tables for displacements outside the contact are cached, and number of polynomials times largest
# k a from which on they are not cached: at 2e5 (a/h = 100) a table takes 10 MB.
FAR, _LARGEST_TABLE = 4.0, 2e5
# Orders of polynomials whose integrals of the tail from 0 diverge, and double periods of the quadrature instead: half
# as many leave eight times the error.
_FEW, _PERIODS = 4, 2000
# Radii cached per layer, since searches return to the same radii. Half as many make searches slower.
_CACHED_RADII = 400


class Sizes(NamedTuple):
    """All sizes of the discretisation; an error estimate is the change of an answer from one set of sizes to another.

    Attributes:
        least: Number of polynomials at the smallest contact radii.
        rate: Number of further polynomials per sqrt(a/h); a root suffices since their zeros cluster at the edge.
        nodes: Gauss nodes per panel of wave numbers.
        reach: Largest wave number, in units of the kernel.
        radii: Contact radii per octave, between which punches and resolvents are interpolated.
        extra: Number of further nodes of every other quadrature.
        graded: Number of further polynomials on graded layers, where B is singular like (a - t) ln(a - t) at the edge.
    """

    least: int = 12
    rate: float = 8.0
    nodes: int = 20
    reach: float = 21.0
    radii: int = 18
    extra: int = 0
    graded: int = 120

    def polynomials(self, octave: int, *, is_graded: bool) -> int:
        """Number of polynomials for contacts of a/h up to 2^octave."""
        count = self.least + int(self.rate * np.sqrt(2.0**octave))
        return count + int(self.graded * (1 + self.extra / 12)) if is_graded else count

    def scaled(self, factor: float) -> Sizes:
        """Sizes with about `factor` times the resolution."""
        if factor == 1.0:
            return self
        share = factor**0.6
        return Sizes(
            least=max(4, round(self.least * share)),
            rate=self.rate * share,
            nodes=max(8, round(self.nodes * share)),
            reach=self.reach * min(1.0, share) + 3.0 * max(0.0, share - 1.0),
            radii=max(5, round(self.radii * share)),
            extra=round(12 * (share - 1.0)),
            graded=self.graded,
        )

    @property
    def finer(self) -> Sizes:
        """Finer sizes, for error estimates: 6 further polynomials and nodes, a larger reach, 3 further radii."""
        more = self.least + 6, self.rate, self.nodes + 6, self.reach + 3.0, self.radii + 3, self.extra + 6
        return Sizes(*more, self.graded)


USUAL = Sizes()
# Sizes for radius searches: their relative error is 1e-4, their cost a tenth.
COARSE = Sizes(5, 3.0, 10, 8.0, 6, -6)


class _Waves(NamedTuple):
    """Table of wave numbers kappa = k a: panels from 2^lowest to `top`, `orders` polynomials, `nodes` per panel.

    Panels are at most four periods of cos(kappa) cos(`farthest` kappa) wide.
    """

    lowest: int
    top: float
    orders: int
    nodes: int
    farthest: float = 1.0

    @property
    def ends(self) -> FloatArray:
        """Ends of the panels: octaves up to the largest permitted width, then panels of that width."""
        last = int(5 - np.log2(1 + self.farthest))
        octaves = 2.0 ** np.arange(min(self.lowest, last), min(last, np.ceil(np.log2(self.top))) + 1)
        octaves = np.append(0.0, octaves)
        first, width = octaves[-1], 8 * np.pi / (1 + self.farthest)
        return np.append(octaves, first + width * np.arange(1, max(0, np.ceil((self.top - first) / width)) + 1))


@lru_cache(maxsize=64)
def _transforms(waves: _Waves) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Wave numbers kappa, weights, and c_n(kappa) = int_0^1 b_n(s) cos(kappa s) ds, shape (count, n)."""
    kappa, w = panels(waves.ends, waves.nodes)
    return kappa, w, _scale(waves.orders)[:, None] * even_bessel(kappa, waves.orders)


def _scale(count: int) -> FloatArray:
    """c_n/j_2n = (-1)^n sqrt(4n + 1)."""
    n = np.arange(count)
    return np.asarray(np.sqrt(4 * n + 1) * (-1.0) ** n)


class Radius:
    """The equation A phi = W at one contact radius, A = 1 - B, in orthonormal even polynomials of t/a.

    Args:
        kernel: Kernel 1 - chi of the layer.
        a: Contact radius in units of the kernel.
        sizes: Sizes of the discretisation.
        octave: Binary logarithm of the largest radius for which the sizes are chosen; by default that of a, rounded up.
    """

    def __init__(self, kernel: ContactKernel, a: float, sizes: Sizes = USUAL, octave: int | None = None) -> None:
        # The tail of graded layers is an asymptotic series, so finer sizes begin it at twice the wave number.
        more = max(1.0, 1 + sizes.extra / 6) if kernel.tail else 1.0
        self.kernel, self.a, self.sizes = kernel, a, sizes._replace(reach=more * sizes.reach)
        octave = max(int(np.ceil(np.log2(max(a, 1e-3)))), -3) if octave is None else octave
        self.count = sizes.polynomials(octave, is_graded=bool(kernel.tail))
        self.degree = np.sqrt(4 * np.arange(self.count) + 1)  # b_n(1)
        least = 5 * self.count + _TURNING if self.is_rooted else 0.0
        self._waves = _Waves(self._lowest(octave), max(self.sizes.reach * 2.0**octave, least), self.count, sizes.nodes)
        kappa, w, table = _transforms(self._waves)
        use = slice(0, None if kernel.tail else int(np.searchsorted(kappa, self.sizes.reach * a)) + sizes.nodes)
        self._table, rest = table[:, use], kernel.one_minus_chi(kappa[use] / a)
        self.largest_chi = max(1.0, 1 - float(rest.min()))
        self._weight = 2 / np.pi * w[use] * rest
        self.column = self._table @ (self._weight * np.cos(kappa[use]))  # int B(a, t) b_n(t) dt
        self._tail = [(p, 2 / np.pi * c * a**p) for p, c in enumerate(kernel.tail, 1)]
        for power, size in self._tail:
            self.column = self.column + size * _tails(self._waves, power)[1]

    def _lowest(self, octave: int) -> int:
        """Binary logarithm of kappa below which chi is a power series; takes few values, so that tables are shared."""
        deepest = octave - 4 - int(np.ceil(np.log2(self.kernel.longest)))
        return min(deepest if self.a > 2.0 ** (octave - 2) else deepest - 20, 3)

    def waves(self, farthest: float = 1.0, reach: float = 1.0) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Wave numbers k a and weights, shape (m,), and c_n, shape (n, m).

        Args:
            farthest: Largest r/a at which a field is computed; a power of two, so that tables are shared.
            reach: Factor on the largest wave number `Sizes.reach`, above 1 if 1 - chi decays like a power.
        """
        waves = self._waves._replace(farthest=farthest, top=reach * self._waves.top)
        is_cached = farthest <= FAR and waves.orders * waves.top < _LARGEST_TABLE
        kappa, w, table = (_transforms if is_cached else _transforms.__wrapped__)(waves)
        use = int(np.searchsorted(kappa, reach * self.sizes.reach * self.a)) + self.sizes.nodes
        return kappa[:use], w[:use], table[:, :use]

    @property
    def is_rooted(self) -> bool:
        """Whether A is factored by its square root, which keeps all digits of k_N at nu = 1/2."""
        return self.a > _ROOT_FROM and not self.kernel.tail

    @cached_property
    def smooth(self) -> FloatArray:
        """Matrix of B, shape (count, count)."""
        matrix = (self._table * self._weight) @ self._table.T
        for power, size in self._tail:
            matrix = matrix + size * _tails(self._waves, power)[0]
        return np.asarray(matrix)

    @cached_property
    def _factor(self) -> FloatArray:
        """Upper triangular R with A = R^T R."""
        if self.is_rooted:
            return self._root()
        return cholesky(np.eye(self.count) - self.smooth)

    def _root(self) -> FloatArray:
        """R of the QR factorisation of the rows sqrt((2/pi) w chi) c(kappa): their condition is the root of that of A.

        Well beyond the orders and beyond 3 a/h, c c^T is replaced by its mean (c c^T + d d^T)/2 over the oscillations,
        d made with Bessel functions of the second kind. The transition is smooth over 24 periods (erfc).
        """
        kappa, w, table = _transforms(self._waves)
        ends, width = self._waves.ends, _TURNING
        last = ends[min(int(np.searchsorted(ends, max(3 * self.a, 5 * self.count) + width)), ends.size - 1)]
        near = kappa < last
        kappa, w, table = kappa[near], w[near], table[:, near]
        share = special().erfc(12 * ((kappa - last) / width + 0.5)) / 2  # 1 within, 0 at `last`
        v, u = gauss(2 * self.sizes.nodes + self.count // 4)  # phases of c_m c_n turn by up to 0.4 count
        far = np.concatenate([kappa[share < 1], last / v])
        weight = np.concatenate([(w * (1 - share))[share < 1], u * last / v**2])
        size = _scale(self.count)[:, None] * np.sqrt(weight * self.kernel.chi(far / self.a) / np.pi)
        within = table * np.sqrt(2 / np.pi * w * self.kernel.chi(kappa / self.a) * share)
        beyond = [size * bessel(far, self.count) for bessel in (even_bessel, even_bessel_second)]
        return np.asarray(np.linalg.qr(np.hstack([within, *beyond]).T, mode="r"))

    def solve(self, right: FloatArray) -> FloatArray:
        """A^-1 right, shape (count,)."""
        return solve_factored(self._factor, right)

    @cached_property
    def punch(self) -> FloatArray:
        """Density of the flat punch of unit depth, shape (count,)."""
        return self.solve(np.eye(1, self.count)[0])

    @cached_property
    def resolvent(self) -> FloatArray:
        """R with (A^-1 W)(a) = W(a) + int_0^1 R(s) W(a s) ds for every W, shape (count,)."""
        return self.solve(self.column)

    @cached_property
    def noise(self) -> tuple[float, float]:
        """Condition numbers of depth and of force: their relative change per relative change of A."""
        punch, resolvent = np.linalg.norm(self.punch), np.linalg.norm(self.resolvent)
        whole = self.largest_chi * punch**2 / self.punch[0]
        if self.is_rooted:
            return float(np.sqrt(whole)), float(np.sqrt(whole))
        edge = np.sqrt(self.largest_chi) * punch * (1 + resolvent) / (1 + self.resolvent[0])
        return float(edge * np.sqrt(self.largest_chi)), float(whole)


class Rows(NamedTuple):
    """Densities of flat punches, and resolvents, at n contact radii of one octave.

    Attributes:
        which: Indices of these radii among all requested ones, shape (n,).
        punch: Density of the flat punch of unit depth, `Radius.punch`, shape (n, count).
        resolvent: `Radius.resolvent`, shape (n, count).
        noise: Condition numbers of depth and of force, `Radius.noise`, shape (n, 2).
    """

    which: NDArray[np.intp]
    punch: FloatArray
    resolvent: FloatArray
    noise: FloatArray


class FlatPunches:
    """Flat punches of all radii on one layer, interpolated over octaves of a/h.

    Args:
        kernel: Kernel 1 - chi of the layer.
        sizes: Sizes of the discretisation.
    """

    def __init__(self, kernel: ContactKernel, sizes: Sizes = USUAL) -> None:
        self.kernel, self.sizes = kernel, sizes
        self._cached_row = lru_cache(maxsize=_CACHED_RADII)(self._row)
        self._rows = Octaves(self._solve, self._lowest(), sizes.radii)
        self._factored = lru_cache(maxsize=8)(lambda a, octave: Radius(kernel, a, sizes, octave))

    def _lowest(self) -> int:
        """Lowest octave, which includes all smaller radii: |B_00| < 0.45 there, so that one interpolant suffices."""
        lowest = -1
        if self.kernel.is_uniform:
            return lowest
        while lowest > -40 and abs(Radius(self.kernel, 2.0**lowest, COARSE).smooth[0, 0]) > 0.45:
            lowest -= 1
        return lowest

    def at(self, radii: FloatArray) -> Iterator[Rows]:
        """Rows at contact radii, shape (n,), one octave after the other."""
        if self.kernel.is_uniform:
            unit = np.ones((radii.size, 1))
            yield Rows(np.arange(radii.size), unit, 0 * unit, np.ones((radii.size, 2)))
            return
        for octave, index in self._rows.groups(radii):
            # The choice depends on the radii of this call only, not on the cache, so that answers repeat exactly.
            # On graded layers rows start like a ln(a), which polynomials cannot interpolate.
            few = index.size < self.sizes.radii or (octave == self._rows.lowest and bool(self.kernel.tail))
            rows = (self._solve if few else self._rows)(radii[index], octave)
            half = rows.shape[1] // 2 - 1
            yield Rows(index, rows[:, :half], rows[:, half:-2], rows[:, -2:])

    def unknowns(self, a: float) -> int:
        """Number of unknowns of the equation at a contact radius, zero on the half-space."""
        if self.kernel.is_uniform:
            return 0
        octave = next(self._rows.groups(np.array([a])))[0]
        return self.sizes.polynomials(octave, is_graded=bool(self.kernel.tail))

    def radius(self, a: float) -> Radius:
        """The equation at one contact radius; the last 8 are cached."""
        octave = next(self._rows.groups(np.array([a])))[0]
        return self._factored(a, octave)

    def _solve(self, radii: FloatArray, octave: int) -> FloatArray:
        return np.array([self._cached_row(a, octave) for a in radii.tolist()])

    def _row(self, a: float, octave: int) -> FloatArray:
        """Punch, resolvent and noise at one radius, shape (2 count + 2,)."""
        equation = self._factored(a, octave)
        return np.concatenate([equation.punch, equation.resolvent, equation.noise])


@lru_cache(maxsize=128)
def flat_punches(kernel: ContactKernel, sizes: Sizes) -> FlatPunches:
    """Flat punches on a layer, cached."""
    return FlatPunches(kernel, sizes)


def _critical(mu: NDArray[np.floating], nu: NDArray[np.floating] | float, power: int) -> FloatArray:
    """int_0^inf J_mu J_nu x^-power dx (Weber and Schafheitlin)."""
    gammaln, gammasgn = special().gammaln, special().gammasgn
    over = [(nu - mu + power + 1) / 2, (mu + nu + power + 1) / 2, (mu - nu + power + 1) / 2]
    size = gammaln(power) + gammaln((mu + nu - power + 1) / 2) - power * np.log(2.0) - sum(gammaln(x) for x in over)
    return np.asarray(np.exp(size) * np.nan_to_num(gammasgn(over[0]) * gammasgn(over[2])))


@lru_cache(maxsize=16)
def _far_transforms(end: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Wave numbers kappa over `_PERIODS` double periods from `end` on, weights, and the first `_FEW` c_n(kappa)."""
    kappa, w = panels(end + 4 * np.pi * np.arange(_PERIODS + 1), 20)
    return kappa, w, _scale(_FEW)[:, None] * even_bessel(kappa, _FEW)


@lru_cache(maxsize=64)
def _tails(waves: _Waves, power: int) -> tuple[FloatArray, FloatArray]:
    """Integrals of x^-power c_m c_n and of x^-power cos(x) c_n from the end of the table to infinity.

    They are the integrals from 0 less the part that the table integrates. For the lowest orders the integrals from 0
    diverge, and a quadrature over `_PERIODS` double periods replaces them.
    """
    kappa, w, table = _transforms(waves)
    n, scale = np.arange(waves.orders), _scale(waves.orders)
    with np.errstate(all="ignore"):
        whole = np.pi / 2 * _critical(2 * n[:, None] + 0.5, 2 * n + 0.5, power + 1) * scale[:, None] * scale
        side = np.pi / 2 * _critical(2 * n + 0.5, -0.5, power) * scale
        thin = w / kappa**power
        matrix, column = whole - (table * thin) @ table.T, side - table @ (thin * np.cos(kappa))
    few = min(waves.orders, _FEW)
    far, v, rows = _far_transforms(waves.ends[-1])
    rows, m = rows[:few], n[:few]
    last = waves.ends[-1] + _PERIODS * 4 * np.pi
    rest = last ** (-power - 1.0) / (2 * (power + 1))  # mean of sin^2
    outer = (rows * v / far**power) @ rows.T + rest * np.sqrt((4 * m[:, None] + 1) * (4 * m + 1))
    matrix[:few, :few] = np.where(m[:, None] + m < 3, outer, matrix[:few, :few])
    ahead = (np.cos(2 * last) / 4 + m * (2 * m + 1) / (2 * (power + 1))) * last ** (-power - 1.0)
    column[:few] = rows @ (v * np.cos(far) / far**power) + np.sqrt(4 * m + 1) * ahead
    return matrix, column
