"""Four grids and more: f = f_0 + C length^p by least squares (Eca and Hoekstra 2014, J. Comput. Phys. 262, 104).

Their procedure is written for a formal order of two; here the formal order p_f takes its place.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize_scalar

from contact import InvalidInput
from contact.records.validation import FloatArray


@dataclass(frozen=True, kw_only=True)
class Fit:
    """A fitted error expansion.

    Attributes:
        limit: f_0.
        order: fitted p, or the fixed exponent of the expansion chosen in its place.
        observed_order: fitted p, whatever was chosen afterwards.
        deviation: standard deviation of the fit, unit of the values.
        uncertainty: of the finest value, 95 %, same unit.
    """

    limit: float
    order: float
    observed_order: float
    deviation: float
    uncertainty: float


def fit(values: Sequence[float], lengths: Sequence[float], formal: float) -> Fit:
    """Fit an error expansion to four or more grids, finest first.

    Raises:
        InvalidInput: with fewer than four grids, or with a value that is not finite.
    """
    f, h = np.asarray(values, dtype=float), np.asarray(lengths, dtype=float)
    if f.size < 4 or f.shape != h.shape or not np.all(np.isfinite(f)):
        raise InvalidInput(f"a least-squares fit needs four finite values or more, one per length, got {tuple(values)}")
    h = h / h[0]
    free = _fitted_order(f, h)
    candidates = _expansions(free, formal)
    solved = [_solve(f, h, exponents) for exponents in candidates]
    best = min(range(len(solved)), key=lambda i: solved[i][1])
    coefficients, deviation = solved[best]
    fitted = _columns(h, candidates[best]) @ coefficients
    order = free if candidates[best] == (free,) else candidates[best][0]
    limit = float(coefficients[0])
    error, misfit = float(abs(fitted[0] - limit)), float(abs(f[0] - fitted[0]))
    believable = 0.5 <= order <= formal + 0.1
    uncertainty = _uncertainty(error, misfit, deviation, float(np.ptp(f)) / (f.size - 1), believable=believable)
    return Fit(limit=limit, order=order, observed_order=free, deviation=deviation, uncertainty=uncertainty)


def _expansions(free: float, formal: float) -> list[tuple[float, ...]]:
    """Exponents to choose from: the fitted order if it is believable, fixed ones if not."""
    if free < 0.5:
        return [(1.0,), (formal,), (1.0, 2.0)]
    if free > formal + 0.1:
        return [(1.0,), (formal,)]
    return [(free,)]


def _fitted_order(f: FloatArray, h: FloatArray) -> float:
    """Variable projection: for each p the other unknowns are linear, so one scalar search remains."""
    misfit: Callable[[float], float] = lambda p: _solve(f, h, (p,))[1]  # noqa: E731 - a formula
    grid = np.linspace(0.05, 10.0, 200)
    start = int(np.argmin([misfit(p) for p in grid]))
    bounds = (grid[max(start - 1, 0)], grid[min(start + 1, grid.size - 1)])
    return float(minimize_scalar(misfit, bounds=bounds, method="bounded", options={"xatol": 1e-10}).x)


def _columns(h: FloatArray, exponents: tuple[float, ...]) -> FloatArray:
    return np.column_stack([np.ones_like(h), *(h**p for p in exponents)])


def _solve(f: FloatArray, h: FloatArray, exponents: tuple[float, ...]) -> tuple[FloatArray, float]:
    columns = _columns(h, exponents)
    # The differences carry the information; the level would only cost digits.
    shift = f[0]
    coefficients, *_ = np.linalg.lstsq(columns, f - shift, rcond=None)
    residual = f - shift - columns @ coefficients
    freedom = max(f.size - columns.shape[1] - 1, 1)
    coefficients[0] += shift
    return coefficients, float(np.sqrt(residual @ residual / freedom))


def _uncertainty(error: float, misfit: float, deviation: float, data_range: float, *, believable: bool) -> float:
    """Eqs. (16)-(19) there: a good fit (deviation below the data range) adds, a bad one multiplies."""
    if deviation < data_range:
        return (1.25 if believable else 3.0) * error + deviation + misfit
    spread = deviation / data_range if data_range > 0 else 1.0
    return 3.0 * spread * (error + deviation + misfit)
