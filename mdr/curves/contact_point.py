"""The linear model F = E phi(d - d0) + f0 + k (d - d0), and the search for the contact point d0.

At a given d0 and shape phi, modulus, baseline and tilt are linear: the background is projected out, and E is one
quotient. So least squares run over d0, and one number u of a family of shapes, only (variable projection).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from scipy.optimize import leastsq

from contact import InvalidInput
from contact.records.validation import FloatArray
from mdr.curves.families import Family

# Trial depths of indentation, by equal factors. With half as many the search starts 25 % off, with twice 6 %.
_TRIALS: Final = 60
# Trial contact points reach this many travels back from the largest depth: 0.5 travels before the first depth.
FURTHEST: Final = 1.5
# Trial points with the curve's own shape, in a factor of 3 about that of a power law. Half as many start 30 % off.
_FINER: Final = 15
# First guesses that go on to least squares. With two some curves of withdrawal end elsewhere; eight improve none.
_STARTS: Final = 4
# Power laws are tried on averages of the points, at most this many. Half as many blur contacts of few points.
_BINS: Final = 400
# Standard errors that a contact stands above scatter. The best of 240 trials in noise reaches 4; at 5 one in 1e4 does.
_CONTACT: Final = 5.5
# Standard errors of the correlation of neighbours that white noise does not reach. At 2 one curve in 40 would.
NOT_WHITE: Final = 3.0


@dataclass(frozen=True)
class Data:
    """One measured curve and what is linear in its fit.

    Attributes:
        depth: [m], shape (n,).
        force: [N], shape (n,).
        names: Fitted parameters.
        columns: Constant and straight line where they are fitted, orthonormal, shape (n, 0 to 2).
        remaining: Force without these, shape (n,).
    """

    depth: FloatArray
    force: FloatArray
    names: tuple[str, ...]
    columns: FloatArray
    remaining: FloatArray

    @classmethod
    def of(cls, depth: FloatArray, force: FloatArray, names: Sequence[str]) -> Data:
        """Data of a curve with the fitted background subtracted from the force."""
        parts = [np.ones_like(depth)] * ("baseline" in names) + [depth - depth.mean()] * ("tilt" in names)
        columns = np.linalg.qr(np.stack(parts, axis=1))[0] if parts else np.zeros((depth.size, 0))
        return cls(depth, force, tuple(names), columns, force - columns @ (columns.T @ force))

    @property
    def deepest(self) -> float:
        """Largest depth [m]."""
        return float(self.depth.max())

    @property
    def has_free_point(self) -> bool:
        """Whether the contact point is fitted."""
        return "contact_point" in self.names

    def projected(self, phi: FloatArray) -> FloatArray:
        """Shapes, shape (..., n), without their background."""
        return phi - (phi @ self.columns) @ self.columns.T

    def averaged(self) -> Data:
        """Averages of neighbours, at most `_BINS` of them."""
        size = -(-self.depth.size // _BINS)
        if size == 1:
            return self
        order = np.argsort(self.depth, kind="stable")[self.depth.size % size :]
        depth, force = (values[order].reshape(-1, size).mean(axis=1) for values in (self.depth, self.force))
        return Data.of(depth, force, self.names)


class Fitted(NamedTuple):
    """Values of least squares.

    Attributes:
        indentation: Depth of indentation at the largest depth [m].
        u: Number of the family of shapes.
        family: Of shapes.
        modulus: E [Pa].
        residual: Measured less fitted force [N], shape (n,).
    """

    indentation: float
    u: float
    family: Family
    modulus: float
    residual: FloatArray

    @property
    def squares(self) -> float:
        """Sum of squared residuals [N^2]."""
        return float(self.residual @ self.residual)


def rough_indentation(data: Data) -> float:
    """Rough depth of indentation [m] by powers of the depth.

    Raises:
        InvalidInput: For a curve whose force does not rise above scatter and drift.
    """
    coarse = data.averaged()
    trials = np.array([coarse.deepest])
    if data.has_free_point:
        travel = float(np.ptp(coarse.depth))
        least = max(coarse.deepest - float(np.partition(coarse.depth, -3)[-3]), 1e-3 * travel)
        trials = np.geomspace(least, FURTHEST * travel, _TRIALS)
    x = np.maximum(coarse.depth - coarse.deepest + trials[:, None], 0.0)
    powers = (x, x * np.sqrt(x), x * x, x * x * x)
    gains = np.stack([_gains(coarse, power) for power in powers])
    power, trial = divmod(int(np.argmax(gains)), trials.size)
    phi = coarse.projected(powers[power][trial])
    square = float(phi @ phi)
    residual = coarse.remaining - phi * (float(phi @ coarse.remaining) / square if square else 0.0)
    check_contact(coarse, float(gains.max()), residual)
    return float(trials[trial])


def check_contact(data: Data, gain: float, residual: FloatArray) -> None:
    """Refuse contacts that decrease the sum of squares by no more than scatter does.

    Args:
        data: The curve.
        gain: Decrease of the sum of squares by the contact in addition to the background [N^2].
        residual: Of the fit with a contact [N], shape (n,).

    Raises:
        InvalidInput: With the remedy.
    """
    freedom = max(data.depth.size - len(data.names), 1)
    ordered = residual[np.argsort(data.depth, kind="stable")]
    variance = float(residual @ residual) / freedom * correlation_factor(ordered)
    if not gain > _CONTACT**2 * variance or not gain > 1e-20 * float(data.force @ data.force):
        raise InvalidInput(
            "no contact in the curve: the force does not rise above its scatter and a straight line as the depth "
            "grows; check columns and signs (pressing is positive), or fit without tilt (--with contact_point); a "
            "hold over time needs a viscoelastic effect in the scene"
        )


def correlation_factor(residual: FloatArray) -> float:
    """Factor of the variance of a mean by the correlation of neighbours, 1 + 2 (rho_1 + rho_2 + ..); 1 for white noise.

    The sum ends at the first correlation within scatter (initial positive sequence, Geyer 1992).
    """
    n = residual.size
    if n < 8:
        return 1.0
    residual = residual - residual.mean()
    square = float(residual @ residual)
    if square == 0.0:
        return 1.0
    total, limit = 0.0, NOT_WHITE / math.sqrt(n)
    for lag in range(1, n // 2):
        rho = float(residual[lag:] @ residual[:-lag]) / square
        if rho < limit:
            break
        total += rho
    return 1.0 + 2.0 * total


def _gains(data: Data, phi: FloatArray) -> FloatArray:
    """Decrease of the sum of squares by E phi with E > 0, for phi of shape (m, n)."""
    phi = data.projected(phi)
    square = np.sum(phi * phi, axis=1)
    product = np.maximum(phi @ data.remaining, 0.0)
    return np.asarray(np.divide(product**2, square, out=np.zeros_like(square), where=square > 0.0))


def trial_indentations(data: Data, rough: float, reach: float) -> FloatArray:
    """Trial values of the indentation at the largest depth, d_max - d0 [m], shape (m,).

    They lie within a factor of 3 of the rough value, and at most at the reach and at `FURTHEST` travels. With a known
    contact point the one trial is d_max.

    Args:
        data: the measured curve.
        rough: rough indentation by power laws [m].
        reach: largest depth of the curve of the scene [m].
    """
    if not data.has_free_point:
        return np.array([data.deepest])
    trials = np.geomspace(rough / 3, 3 * rough, _FINER)
    return np.minimum(trials, min(reach, FURTHEST * float(np.ptp(data.depth))))


def fitted_at(data: Data, family: Family, indentation: float, u: float) -> Fitted:
    """Modulus and residual at a depth of indentation [m]."""
    phi = data.projected(family.at(u)(data.depth - data.deepest + indentation))
    square = float(phi @ phi)
    if not family.is_scaled:
        modulus = family.factor(u)
    else:
        modulus = max(float(phi @ data.remaining) / square, 0.0) if square > 0.0 else 0.0
    return Fitted(indentation, u, family, modulus, data.remaining - modulus * phi)


def least_squares(data: Data, family: Family, trials: dict[float, FloatArray]) -> list[Fitted]:
    """Ends of least squares from the best trial contact points of each u, the smallest squares first."""
    rated = []
    for u, points in trials.items():
        phi = family.at(u)(data.depth - data.deepest + points[:, None])
        if family.is_scaled:
            squares = -_gains(data, phi)
        else:
            squares = np.sum((data.remaining - family.factor(u) * data.projected(phi)) ** 2, axis=1)
        best = int(np.argmin(squares))
        rated.append((float(squares[best]), float(points[best]), u))
    ends = [_polished(data, family, point, u) for _, point, u in sorted(rated)[:_STARTS]]
    return sorted(ends, key=lambda end: end.squares)


def _polished(data: Data, family: Family, indentation: float, u: float) -> Fitted:
    """Levenberg and Marquardt over the depth of indentation and u."""
    free_point, varies = data.has_free_point, bool(family.varied)
    unit = family.size(u)

    def unpacked(x: FloatArray) -> tuple[float, float]:
        point = indentation * float(x[0]) if free_point else indentation
        return point, float(x[-1]) * unit if varies else u

    def residual(x: FloatArray) -> FloatArray:
        return fitted_at(data, family, *unpacked(x)).residual

    start = np.array([1.0] * free_point + [u / unit] * varies)
    if start.size:
        start = leastsq(residual, start, xtol=1e-9, ftol=1e-12, maxfev=400, full_output=True)[0]
    return fitted_at(data, family, *unpacked(start))
