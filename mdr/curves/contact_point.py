"""The linear model F = E phi(d - d0) + f0 + k (d - d0), and the search for the contact point d0.

At a given d0 and shape phi, modulus, baseline and tilt are linear: the background is projected out, and E is one
quotient. So least squares run over d0, and one number u of a family of shapes, only (variable projection).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from scipy.optimize import leastsq
from scipy.signal import correlate

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
# Share of the travel within which a depth rests. Half of it misses holds that creep, twice calls slow loadings holds.
_REST: Final = 0.05
# Standard errors of the correlation of neighbours that white noise does not reach. At 2 one curve in 40 would.
NOT_WHITE: Final = 3.0


@dataclass(frozen=True)
class Data:
    """One measured curve and what is linear in its fit.

    Attributes:
        depth: Depths [m], shape (n,).
        force: Forces [N], shape (n,).
        names: Names of the fitted parameters.
        columns: Constant and straight line where they are fitted, orthonormal, shape (n, 0 to 2).
        remaining: Force [N] without its projection on the columns, shape (n,).
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
        square = np.asarray(np.sum(phi * phi, axis=-1))
        modulus = np.ones_like(square)
        if has_free_modulus:
            product = np.maximum(phi @ self.remaining, 0.0)
            modulus = np.divide(product, square, out=np.zeros_like(square), where=square > 0.0)
        return modulus, self.remaining - modulus[..., None] * phi


class Fitted(NamedTuple):
    """Values of least squares.

    Attributes:
        indentation: Depth of indentation at the largest depth [m].
        u: Number of the family of shapes.
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
    residuals = np.concatenate([coarse.fitted(power)[1] for power in (x, x * np.sqrt(x), x * x, x * x * x)])
    best = int(np.argmin(np.sum(residuals**2, axis=1)))
    check_contact(coarse, residuals[best], data.depth)
    return float(trials[best % trials.size])


def check_contact(data: Data, residual: FloatArray, depth: FloatArray) -> None:
    """Refuse contacts that decrease the sum of squares by no more than scatter does.

    Args:
        data: The curve, or averages of its points.
        residual: Residual of the fit with a contact [N], shape (n,).
        depth: Measured depths [m] of all points, as they follow one another.

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
    """Refuse depths [m] that rest at the largest one, or about one, for most of the time.

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
    """Factor of the variance of a mean by the correlation of neighbours, 1 + 2 (rho_1 + rho_2 + ..); 1 for white noise.

    The sum ends at the first correlation within scatter (initial positive sequence, Geyer 1992).
    """
    n = residual.size
    if n < 8 or not np.ptp(residual):
        return 1.0
    products = correlate(residual - residual.mean(), residual - residual.mean())[n - 1 :]
    rho = products[1 : n // 2] / products[0]
    within_scatter = np.append(rho < NOT_WHITE / np.sqrt(n), True)
    return 1.0 + 2.0 * float(rho[: np.argmax(within_scatter)].sum())


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
    """Ends of least squares from the best trial contact points of each u, the smallest squares first."""
    starts = []
    for u, points in trials.items():
        phi = family.shape(u)(data.depth - data.deepest + points[:, None])
        residuals = data.fitted(phi, has_free_modulus=family.has_free_modulus)[1]
        squares = np.sum(residuals**2, axis=1)
        best = int(np.argmin(squares))
        starts.append((float(squares[best]), float(points[best]), u))
    ends = [_polished(data, family, point, u) for _, point, u in sorted(starts)[:_STARTS]]
    return sorted(ends, key=lambda end: end.squares)


def _polished(data: Data, family: Family, indentation: float, u: float) -> Fitted:
    """Levenberg and Marquardt over the depth of indentation and u, from first values."""
    varies = bool(family.varied)

    def at(x: FloatArray) -> Fitted:
        point = indentation * float(x[0]) if data.has_free_point else indentation
        number = float(x[-1]) * family.unit if varies else u
        phi = family.shape(number)(data.depth - data.deepest + point)
        modulus, residual = data.fitted(phi, has_free_modulus=family.has_free_modulus)
        return Fitted(point, number, family, float(modulus), residual)

    def residual(x: FloatArray) -> FloatArray:
        return at(x).residual

    x = np.array([1.0] * data.has_free_point + [u / family.unit] * varies)
    if x.size:
        x = leastsq(residual, x, xtol=1e-9, ftol=1e-12, maxfev=400, full_output=True)[0]
    return at(x)
