"""The linear model F = E phi(d - d0) + f0 + k (d - d0), and the search for the contact point d0.

At a given d0 and shape phi, modulus, baseline and tilt are linear: the background is projected out, and E is one
quotient. So least squares run over d0, and one number u of a family of shapes, only (variable projection).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import takewhile
from typing import Final, NamedTuple

import numpy as np
from scipy.optimize import leastsq

from contact import InvalidInput
from contact.records.validation import FloatArray
from mdr.curves.families import Family

# Number of trial indentations, spaced by equal factors. With half as many the first guess is 25 % off, with twice 6 %.
_TRIALS: Final = 60
# Largest trial indentation over the travel (range of depths): the contact point is at most half a travel before the
# first depth.
FURTHEST: Final = 1.5
# Number of trial indentations with the scene's force curve, within a factor of 3 of the power law's. With half as many
# the first guess is 30 % off.
_FINER: Final = 15
# First guesses from which least squares start. With two some curves of withdrawal end at a wrong minimum; eight improve
# none.
_STARTS: Final = 4
# Largest number of averages of points to which power laws are fitted. Half as many blur contacts of few points.
_BINS: Final = 400
# Least contact signal in standard errors. In pure noise the best of 240 trials reaches 4, and 5 in one of 1e4 curves.
_CONTACT: Final = 5.5
# Range of depths over the travel that counts as a hold. Half of it misses holds that creep, twice slow loading.
_REST: Final = 0.05
# Least correlation of neighbours, in standard errors, that is not white noise. Noise reaches 2 in one curve of 40.
NOT_WHITE: Final = 3.0


@dataclass(frozen=True)
class Data:
    """One measured curve and its background.

    Attributes:
        depth: Depths [m], shape (n,).
        force: Forces [N], shape (n,).
        names: Names of the fitted parameters.
        columns: Orthonormal basis of the fitted background, constant and straight line, shape (n, 0 to 2).
        remaining: Force [N] minus its projection on the columns, shape (n,).
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

    def averaged(self) -> Data:
        """Averages of neighbours, at most `_BINS` of them."""
        size = -(-self.depth.size // _BINS)
        if size == 1:
            return self
        order = np.argsort(self.depth, kind="stable")[self.depth.size % size :]
        depth, force = (values[order].reshape(-1, size).mean(axis=1) for values in (self.depth, self.force))
        return Data.of(depth, force, self.names)

    def fitted(self, phi: FloatArray, *, has_free_modulus: bool = True) -> tuple[FloatArray, FloatArray]:
        """Moduli E >= 0, shape (..), and residuals [N], shape (.., n), of least squares for shapes phi, shape (.., n).

        Where the modulus is not free it is 1.
        """
        phi = phi - (phi @ self.columns) @ self.columns.T
        square = np.asarray(np.vecdot(phi, phi))
        modulus = np.ones_like(square)
        if has_free_modulus:
            product = np.maximum(phi @ self.remaining, 0.0)
            modulus = np.divide(product, square, out=np.zeros_like(square), where=square > 0.0)
        return modulus, self.remaining - modulus[..., None] * phi


class Fitted(NamedTuple):
    """Result of least squares.

    Attributes:
        indentation: Indentation d_max - d0 at the largest depth [m].
        u: Fitted u of the family of shapes.
        family: Family of shapes.
        modulus: E [Pa], or 1 where the family has no free modulus.
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

    @property
    def youngs_modulus(self) -> float:
        """E [Pa], or the named modulus of the family."""
        return self.modulus if self.family.has_free_modulus else self.family.parameter(self.u, 1.0)


def rough_indentation(data: Data) -> float:
    """First guess of the indentation d_max - d0 [m], from fits of F ~ (d - d0)^n, n = 1, 1.5, 2, 3.

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
    residuals = np.concatenate([coarse.fitted(power)[1] for power in (x, x * np.sqrt(x), x * x, x * x * x)])
    best = int(np.argmin(np.vecdot(residuals, residuals)))
    check_contact(coarse, residuals[best], data.depth)
    return float(trials[best % trials.size])


def check_contact(data: Data, residual: FloatArray, depth: FloatArray) -> None:
    """Refuse a contact that decreases the sum of squares by no more than scatter would.

    Args:
        data: The curve, or averages of its points.
        residual: Residual of the fit with a contact [N], shape (n,).
        depth: Measured depths [m] of all points, in the order of measurement.

    Raises:
        InvalidInput: With the remedy.
    """
    squares = float(residual @ residual)
    gain = float(data.remaining @ data.remaining) - squares
    variance = squares / max(data.depth.size - len(data.names), 1)
    variance *= correlation_factor(residual[np.argsort(data.depth, kind="stable")])
    if gain > _CONTACT**2 * variance and gain > 1e-20 * float(data.force @ data.force):
        return
    refuse_hold(depth)
    raise InvalidInput(
        "no contact in the curve: the force does not rise above its scatter and a straight line as the depth "
        "grows; check columns and signs (pressing is positive), or fit without tilt (--with contact_point)"
    )


def refuse_hold(depth: FloatArray) -> None:
    """Refuse depths [m] that are constant, at the largest depth or elsewhere, for most of the points.

    Raises:
        InvalidInput: With the remedy.
    """
    travel, (first, second) = float(np.ptp(depth)), np.array_split(depth, 2)
    rests = float(np.mean(depth >= depth.max() - _REST * travel)) > 0.5
    is_scatter = float(np.median(np.abs(np.diff(depth)))) > _REST * travel
    if rests or (is_scatter and abs(first.mean() - second.mean()) < 2 * _REST * travel):
        raise InvalidInput(
            "the curve is a hold: its depth rests while the force relaxes, from which no elastic modulus follows; "
            'list a viscoelastic effect in the scene (kind = "standard_solid") to fit the relaxation over a column of '
            "time, or keep the points of loading only"
        )


def correlation_factor(residual: FloatArray) -> float:
    """Variance of a mean over that of white noise, 1 + 2 (rho_1 + rho_2 + ..), rho_k the correlation at lag k.

    The sum ends at the first correlation within scatter (initial positive sequence, Geyer 1992).
    """
    n = residual.size
    residual = residual - residual.mean()
    square = float(residual @ residual)
    if n < 8 or square == 0.0:
        return 1.0
    correlations = (float(residual[lag:] @ residual[:-lag]) / square for lag in range(1, n // 2))
    return 1.0 + 2.0 * sum(takewhile(lambda rho: rho >= NOT_WHITE / math.sqrt(n), correlations))


def trial_indentations(data: Data, rough: float, reach: float) -> FloatArray:
    """Trial values of the indentation at the largest depth, d_max - d0 [m], shape (m,).

    They lie within a factor of 3 of the rough value, and at most at the reach and at `FURTHEST` travels. With a known
    contact point the one trial is d_max.

    Args:
        data: The measured curve.
        rough: Rough indentation by power laws [m].
        reach: Largest depth of the curve of the scene [m].
    """
    if not data.has_free_point:
        return np.array([data.deepest])
    trials = np.geomspace(rough / 3, 3 * rough, _FINER)
    return np.minimum(trials, min(reach, FURTHEST * float(np.ptp(data.depth))))


def least_squares(data: Data, family: Family, trials: Mapping[float, FloatArray]) -> list[Fitted]:
    """Results of least squares started from the best trial indentations of each u, the smallest squares first."""
    starts = []
    for u, points in trials.items():
        phi = family.shape(u)(data.depth - data.deepest + points[:, None])
        residuals = data.fitted(phi, has_free_modulus=family.has_free_modulus)[1]
        squares = np.vecdot(residuals, residuals)
        best = int(np.argmin(squares))
        starts.append((float(squares[best]), float(points[best]), u))
    ends = [_polished(data, family, point, u) for _, point, u in sorted(starts)[:_STARTS]]
    return sorted(ends, key=lambda end: end.squares)


def _polished(data: Data, family: Family, indentation: float, u: float) -> Fitted:
    """Result of Levenberg and Marquardt over the indentation [m] and u, started from these values."""
    varies = bool(family.varied)

    def fitted_at(x: FloatArray) -> Fitted:
        """Least squares of the linear parameters at x, indentation and u over their units where these are fitted."""
        point = indentation * float(x[0]) if data.has_free_point else indentation
        number = float(x[-1]) * family.unit if varies else u
        phi = family.shape(number)(data.depth - data.deepest + point)
        modulus, residual = data.fitted(phi, has_free_modulus=family.has_free_modulus)
        return Fitted(point, number, family, float(modulus), residual)

    def residual(x: FloatArray) -> FloatArray:
        return fitted_at(x).residual

    x = np.array([1.0] * data.has_free_point + [u / family.unit] * varies)
    if x.size:
        x = leastsq(residual, x, xtol=1e-9, ftol=1e-12, maxfev=400, full_output=True)[0]
    return fitted_at(x)
