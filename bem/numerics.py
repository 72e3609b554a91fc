"""Numerical tools of the integral equation: exact Gauss rules, Legendre and Bessel functions, interpolation."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bem.compiled_files import compiled, lapack
from contact.records.errors import NotConvergedError
from contact.records.validation import FloatArray

EPS = float(np.finfo(np.float64).eps)
# Smallest argument of the Bessel tables; x below it is rounded up to it, which changes no value.
_LEAST = 1e-290
# Interpolation nodes per octave of wave numbers for graded layers: the error is 1e-13 with 18, 1e-7 with 9.
WAVES = 18


def special() -> Any:
    """Functions of `scipy.special`, as j0, from its compiled file alone, since the package loads slowly."""
    return compiled("scipy.special._special_ufuncs", "scipy.special")


def cholesky(matrix: FloatArray) -> FloatArray:
    """Upper triangular R with matrix = R^T R; its lower triangle is left undefined.

    Raises:
        NotConvergedError: If the matrix is not positive definite to double precision.
    """
    factor, failed = lapack().dpotrf(matrix, lower=False, clean=False)
    if failed:
        raise NotConvergedError("the equation of contact is singular to double precision")
    return np.asarray(factor)


def solve_factored(factor: FloatArray, right: FloatArray) -> FloatArray:
    """Solution x of R^T R x = right with the upper triangular R = `factor`."""
    return np.asarray(lapack().dpotrs(factor, right, lower=False)[0])


@lru_cache(maxsize=256)
def gauss(count: int) -> tuple[FloatArray, FloatArray]:
    """Nodes and weights of Gauss's rule on [0, 1], correct to the last digit (numpy's are off by 7e-14 at 20 nodes).

    Newton's method in long double from the asymptotic nodes cos(pi (i + 3/4)/(n + 1/2)).
    """
    place = (np.arange(count) + 0.75) / (count + 0.5)
    x = -np.cos(np.pi * place).astype(np.longdouble)
    for _ in range(5):
        below, p = np.ones_like(x), x
        for m in range(1, count):
            below, p = p, ((2 * m + 1) * x * p - m * below) / (m + 1)
        slope = count * (x * p - below) / (x * x - 1)
        x = x - p / slope
    weights = 1 / ((1 - x * x) * slope**2)
    return ((1 + x) / 2).astype(np.float64), weights.astype(np.float64)


def panels(ends: ArrayLike, count: int) -> tuple[FloatArray, FloatArray]:
    """Composite Gauss rule with `count` nodes between neighbouring ends, shape ((len(ends) - 1) count,)."""
    x, w = gauss(count)
    ends = np.asarray(ends, dtype=np.float64)
    width = np.diff(ends)[:, None]
    return (ends[:-1, None] + width * x).ravel(), (width * w).ravel()


@lru_cache(maxsize=64)
def graded(count: int, levels: int = 16, ratio: float = 0.15) -> tuple[FloatArray, FloatArray]:
    """Composite Gauss rule on [0, 1] with `count` nodes per panel, on panels that shrink towards both ends."""
    steps = 0.5 * ratio ** np.arange(levels)[::-1]
    v, w = panels(np.concatenate([[0.0], steps]), count)
    return np.concatenate([v, 1 - v[::-1]]), np.concatenate([w, w[::-1]])


def even_legendre(s: ArrayLike, count: int) -> FloatArray:
    """P_0, P_2, .., P_(2 count - 2) at s; the last axis is the degree."""
    s = np.asarray(s, dtype=np.float64)
    table = np.empty((count, *s.shape))
    below, p = np.ones_like(s), s
    table[0] = 1.0
    for m in range(1, 2 * count - 2):
        below, p = p, ((2 * m + 1) * s * p - m * below) / (m + 1)
        if m % 2:
            table[(m + 1) // 2] = p
    return np.moveaxis(table, 0, -1)


def spherical_bessel(x: FloatArray, count: int, step: int = 1) -> FloatArray:
    """Spherical Bessel functions j_0, j_step, j_(2 step), .. at x >= 0, shape (count, n), to 1e-16 absolute.

    The recurrence runs upwards up to the order x. Beyond, the ratios j_n/j_(n-1) follow from a downward recurrence.
    """
    x = np.maximum(x, _LEAST)
    top = step * (count - 1)
    ratios = np.empty((top + 1, x.size))
    ratio = np.zeros_like(x)
    table = np.empty((count, x.size))
    with np.errstate(all="ignore"):
        for n in range(top + 40 + int(3 * np.sqrt(top)), 0, -1):
            ratio = x / (2 * n + 1 - x * ratio)
            if n <= top:
                ratios[n] = ratio
        below, j = np.cos(x) / x, np.sin(x) / x
        table[0] = j
        for n in range(1, top + 1):
            upwards = (2 * n - 1) / x * j - below
            below, j = j, np.where(n <= x, upwards, j * ratios[n])
            if n % step == 0:
                table[n // step] = j
    return table


def even_bessel(x: FloatArray, count: int) -> FloatArray:
    """Spherical Bessel functions j_0, j_2, .. at x >= 0, shape (count, n)."""
    return spherical_bessel(x, count, step=2)


def even_bessel_second(x: FloatArray, count: int) -> FloatArray:
    """Spherical Bessel functions of the second kind y_0, y_2, .. at x well beyond the orders, shape (count, n)."""
    table = np.empty((count, x.size))
    below, y = np.sin(x) / x, -np.cos(x) / x
    table[0] = y
    for n in range(1, 2 * count - 1):
        below, y = y, (2 * n - 1) / x * y - below
        if n % 2 == 0:
            table[n // 2] = y
    return table


def abel_legendre(u: ArrayLike, count: int) -> FloatArray:
    """sqrt(4n + 1) Q_n(u), Q_n(u) = int_0^u P_2n / P_2n(0) = [P_(2n+1) - P_(2n-1)]/((4n + 1) P_2n(0)).

    Q_n(u) = int_r^1 s P_2n(s)/sqrt(s^2 - r^2) ds with u^2 = 1 - r^2. The last axis is n.
    """
    u = np.asarray(u, dtype=np.float64)
    table = np.empty((count, *u.shape))
    below, p = np.ones_like(u), u
    table[0] = u
    at_zero = 1.0
    for m in range(1, 2 * count - 1):
        before, below, p = below, p, ((2 * m + 1) / (m + 1) * u) * p - (m / (m + 1)) * below
        if m % 2 == 0:
            at_zero *= -(m - 1) / m
            table[m // 2] = (p - before) / (np.sqrt(2 * m + 1) * at_zero)
    return np.moveaxis(table, 0, -1)


def barycentric(nodes: FloatArray) -> FloatArray:
    """Weights w of the interpolation sum_i w_i f_i/(x - x_i) / sum_i w_i/(x - x_i)."""
    gaps = nodes[:, None] - nodes + np.eye(nodes.size)
    size = np.log(np.abs(gaps)).sum(axis=1)
    return np.asarray(np.prod(np.sign(gaps), axis=1) * np.exp(size.mean() - size))


class Octaves:
    """Interpolation of a smooth vector-valued function of x > 0 on [0, 2^lowest], [2^lowest, 2^(lowest+1)], ..

    The function is sampled at the Gauss nodes of an octave at first use.

    Args:
        function: Maps positions, shape (n,), and the number of their octave to values, shape (n, m).
        lowest: Binary logarithm of the end of the first interval.
        count: Nodes per octave.
        together: Number of neighbouring octaves that are sampled in one call, with the number of the first.
    """

    def __init__(
        self, function: Callable[[FloatArray, int], FloatArray], lowest: int, count: int, together: int = 1
    ) -> None:
        self.function, self.lowest, self.together = function, lowest, together
        self.panels: dict[int, FloatArray] = {}
        self._nodes, _ = gauss(count)
        self._weights = barycentric(self._nodes)

    def groups(self, x: FloatArray) -> Iterator[tuple[int, NDArray[np.intp]]]:
        """Yields each octave that contains positions x, and the indices of these positions."""
        octaves = np.maximum(np.ceil(np.log2(np.maximum(x, _LEAST))), self.lowest).astype(int)
        for octave in sorted(set(octaves.tolist())):
            yield octave, np.flatnonzero(octaves == octave)

    def __call__(self, x: FloatArray, octave: int) -> FloatArray:
        """Values at positions within one octave, shape (n, m)."""
        if octave not in self.panels:
            self._sample(octave - (octave - self.lowest) % self.together)
        low = self._low(octave)
        gap = ((x / 2.0**octave - low) / (1 - low))[:, None] - self._nodes
        weights = self._weights / np.where(gap == 0, 1e-200, gap)
        return np.asarray((weights @ self.panels[octave]) / weights.sum(axis=1)[:, None])

    def _low(self, octave: int) -> float:
        """Beginning of an octave over its end."""
        return 0.0 if octave == self.lowest else 0.5

    def _sample(self, first: int) -> None:
        """Sample the function on `together` octaves from the first one on."""
        octaves = range(first, first + self.together)
        x = [(self._low(o) + (1 - self._low(o)) * self._nodes) * 2.0**o for o in octaves]
        self.panels |= zip(octaves, np.split(self.function(np.concatenate(x), first), self.together), strict=True)
