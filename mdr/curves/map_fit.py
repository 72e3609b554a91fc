"""Thousands of force curves at once: modulus, contact point and baseline of each, by Gauss-Newton on one master curve.

The same least squares as of `fit`, done for all curves of a map together: each step solves a system of two or three
unknowns for every curve. A step that does not lessen the squares is halved.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from contact import IndentationDepths, InvalidInput, Scene
from contact.records.validation import BoolArray, FloatArray
from mdr.curves.force_curve import ForceCurve
from mdr.curves.start import TRIALS, linear_fit, trial_points

# Curves fitted together: their arrays then stay in the processor's cache; chosen.
_CHUNK = 256
# Gauss-Newton from a point found among the trials needs about six steps; a curve that needs more has no contact.
_STEPS = 40
# Relative change of all parameters at which a curve is done: far below any scatter.
_DONE = 1e-8

_Fitted: TypeAlias = tuple[FloatArray, FloatArray, FloatArray, BoolArray]


@dataclass(frozen=True, kw_only=True)
class MapFit:
    """Fits of n curves, each array of shape (n,).

    Attributes:
        youngs_modulus: E [Pa]; not a number where the curve could not be fitted, see `converged`.
        standard_error: Of E [Pa], from the scatter of the curve.
        contact_point: d0 [m].
        baseline: f0 [N], zero where it was not fitted.
        scatter: Standard deviation of the residuals [N].
        converged: Whether the fit of the curve ended; the others have no modulus.
        quantile: Student's, for intervals of `confidence`.
        confidence: Of intervals.
        numerical_error: Relative error of E by the computation itself.
    """

    youngs_modulus: FloatArray
    standard_error: FloatArray
    contact_point: FloatArray
    baseline: FloatArray
    scatter: FloatArray
    converged: BoolArray
    quantile: float
    confidence: float
    numerical_error: float

    @property
    def interval(self) -> FloatArray:
        """Lower and upper end [Pa] of the interval of each E, numerical error included, shape (2, n)."""
        half = self.quantile * self.standard_error + self.numerical_error * np.abs(self.youngs_modulus)
        return np.stack([self.youngs_modulus - half, self.youngs_modulus + half])


def fit_map(
    scene: Scene,
    depth: FloatArray,
    force: FloatArray,
    *,
    baseline: bool = False,
    confidence: float = 0.95,
    progress: Callable[[int, int], None] | None = None,
) -> MapFit:
    """Fit modulus and contact point, and a baseline if asked for, to every curve of a map.

    Args:
        scene: Tip and layer, without effects.
        depth: Measured depths [m], shape (n, m), or (m,) if all curves share them.
        force: Measured forces [N], shape (n, m).
        baseline: Whether a constant force is fitted too.
        confidence: Of the intervals.
        progress: Told how many of how many curves are done.

    Raises:
        InvalidInput: For arrays that are no curves, or a scene with effects.
    """
    d, f = _checked(depth, force, 2 + baseline)
    # The contact point may be looked for half a curve before the first depth.
    longest = float(np.ptp(d, axis=-1).max())
    deepest = longest + max(float(d.max()), 0.5 * longest)
    curve = ForceCurve(scene.replace(loading=IndentationDepths([deepest])))
    parts: list[_Fitted] = []
    for start in range(0, len(f), _CHUNK):
        chunk = slice(start, start + _CHUNK)
        parts.append(_fitted(curve, d[chunk], f[chunk], baseline))
        if progress is not None:
            progress(min(start + _CHUNK, len(f)), len(f))
    return _stated(curve, parts, confidence, d.shape[1])


def _stated(curve: ForceCurve, parts: list[_Fitted], confidence: float, points: int) -> MapFit:
    """The fits of all chunks together, each curve of so many points."""
    from scipy.stats import t as student  # noqa: PLC0415  # loaded only when curves are fitted

    values, errors, scatter, converged = (np.concatenate(part) for part in zip(*parts, strict=True))
    return MapFit(
        youngs_modulus=np.where(converged, values[:, 0], np.nan),
        standard_error=np.where(converged, errors, np.nan),
        contact_point=values[:, 1],
        baseline=values[:, 2] if values.shape[1] == 3 else np.zeros(len(values)),
        scatter=scatter,
        converged=converged,
        quantile=float(student.ppf(0.5 + confidence / 2, points - values.shape[1])),
        confidence=confidence,
        numerical_error=curve.error,
    )


def _checked(depth: FloatArray, force: FloatArray, parameters: int) -> tuple[FloatArray, FloatArray]:
    f = np.asarray(force, dtype=np.float64)
    if f.ndim != 2 or f.shape[1] <= parameters:
        raise InvalidInput(f"force has the shape {f.shape}: give one row a curve, of more than {parameters} points")
    try:
        d = np.broadcast_to(np.asarray(depth, dtype=np.float64), f.shape)
    except ValueError:
        raise InvalidInput(f"depth has the shape {np.shape(depth)}: give one depth for each force {f.shape}") from None
    if not (np.isfinite(d).all() and np.isfinite(f).all()):
        raise InvalidInput("depth and force must be finite; leave curves with gaps out, or fit them one by one")
    return d, f


def _fitted(curve: ForceCurve, depth: FloatArray, force: FloatArray, baseline: bool) -> _Fitted:
    """Parameters (n, p), error of E (n,), scatter (n,) and whether it converged (n,)."""
    values = _start(curve, depth, force, baseline)
    squares, converged = _squares(curve, depth, force, values), np.zeros(len(force), dtype=bool)
    width = np.ptp(depth, axis=-1)
    for _ in range(_STEPS):
        jacobian, residual = _linearised(curve, depth, force, values)
        step, _ = _solved(jacobian, residual)
        values, squares, taken = _improved(curve, depth, force, values, step=step, squares=squares)
        size = np.abs(step[:, 0] / values[:, 0]) + np.abs(step[:, 1] / width)
        converged |= (size < _DONE) | ((taken == 0.0) & (size < np.sqrt(_DONE)))
        if converged.all():
            break
    jacobian, residual = _linearised(curve, depth, force, values)
    variance = np.sum(residual**2, axis=-1) / (depth.shape[1] - values.shape[1])
    inverse = _solved(jacobian, residual)[1]
    return values, np.sqrt(variance * inverse[:, 0, 0]), np.sqrt(variance), converged & (values[:, 0] > 0.0)


def _start(curve: ForceCurve, depth: FloatArray, force: FloatArray, baseline: bool) -> FloatArray:
    """The best of the trial contact points of each curve, judged at every few points."""
    points = trial_points(depth)
    thin = slice(None, None, max(1, depth.shape[1] // TRIALS))
    fits = [
        linear_fit(curve.per_modulus(depth[:, thin] - points[:, [i]]), force[:, thin], baseline=baseline)
        for i in range(TRIALS)
    ]
    modulus, constant, squares = (np.stack(part, axis=1) for part in zip(*fits, strict=True))
    best = np.argmin(np.where(modulus > 0.0, squares, np.inf), axis=1)
    rows = np.arange(len(best))
    found = [modulus[rows, best], points[rows, best], constant[rows, best]]
    return np.stack(found[: 2 + baseline], axis=1)


def _linearised(
    curve: ForceCurve, depth: FloatArray, force: FloatArray, values: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Derivatives of the force by the parameters, shape (n, m, p), and what the force misses, shape (n, m)."""
    shifted = depth - values[:, 1:2]
    phi, slope = curve.with_slope(shifted)
    columns = [phi, -values[:, :1] * slope]
    model = values[:, :1] * phi
    if values.shape[1] == 3:
        columns.append(np.ones_like(phi))
        model = model + values[:, 2:]
    return np.stack(columns, axis=-1), force - model


def _solved(jacobian: FloatArray, residual: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Gauss-Newton step (n, p) and (J^T J)^-1 (n, p, p), with columns of length one so that units do not matter."""
    length = np.sqrt(np.sum(jacobian**2, axis=1))
    length = np.where(length > 0.0, length, 1.0)
    unit = jacobian / length[:, None, :]
    inverse = np.linalg.pinv(np.swapaxes(unit, 1, 2) @ unit, hermitian=True) / (length[:, :, None] * length[:, None, :])
    gradient = (np.swapaxes(jacobian, 1, 2) @ residual[..., None])[..., 0]
    return (inverse @ gradient[..., None])[..., 0], inverse


def _squares(curve: ForceCurve, depth: FloatArray, force: FloatArray, values: FloatArray) -> FloatArray:
    model = values[:, :1] * curve.per_modulus(depth - values[:, 1:2])
    model += values[:, 2:] if values.shape[1] == 3 else 0.0
    return np.asarray(np.sum((force - model) ** 2, axis=-1))


def _improved(
    curve: ForceCurve,
    depth: FloatArray,
    force: FloatArray,
    values: FloatArray,
    *,
    step: FloatArray,
    squares: FloatArray,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Values and squares after the whole step, or a half or quarter of it; the share that was taken, zero if none."""
    taken = np.zeros(len(values))
    reach = np.ptp(depth, axis=-1, keepdims=True)
    for share in (1.0, 0.5, 0.25):
        left = taken == 0.0
        trial = values + share * step * left[:, None]
        # The contact point stays where the master curve reaches.
        trial[:, 1:2] = np.clip(
            trial[:, 1:2], depth.min(axis=-1, keepdims=True) - 0.5 * reach, depth.max(axis=-1, keepdims=True)
        )
        found = _squares(curve, depth, force, trial)
        better = left & (found < squares)
        values, squares = np.where(better[:, None], trial, values), np.where(better, found, squares)
        taken = np.where(better, share, taken)
        if taken.all():
            break
    return values, squares, taken
