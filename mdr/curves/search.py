"""Least squares for one force curve: a search for the contact point, then steps in all parameters.

Model: F = E phi(d - d0) + f0 + k (d - d0). At a given d0 it is linear in E, f0 and k.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from contact.records.validation import FloatArray

# Trial depths of indentation, by equal factors. With half as many the search starts 25 % off, with twice 6 %.
_TRIALS = 60
# Trial contact points reach this many travels back from the largest depth: 0.5 travels before the first depth.
FURTHEST = 1.5
# Trial points with the curve's own shape, in a factor of 3 about that of a power law. Half as many start 30 % off.
_FINER = 15
# Steps of least squares. Ten are usual; a curve that needs more than this has a flat minimum.
_STEPS = 60
# Steps end where the parameters change by this share of their standard error. Ten times as many change no digit shown.
_DONE = 1e-3

Values = dict[str, float]
Linearised = Callable[[Values], tuple[FloatArray, FloatArray]]


class CurveShape(Protocol):
    """A force curve of a given shape: what a fit of Young's modulus needs."""

    def per_modulus(self, depth: ArrayLike) -> FloatArray:
        """phi = F/E [m^2] at depths [m], zero where nothing touches."""

    def with_slope(self, depth: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """phi [m^2] and d(phi)/d(depth) [m]."""


def background(depth: FloatArray, parameters: Sequence[str]) -> FloatArray:
    """Columns of a constant and of a straight line where they are fitted, orthonormal, shape (n, 0 to 2)."""
    columns = [np.ones_like(depth)] if "baseline" in parameters else []
    columns += [depth - depth.mean()] if "tilt" in parameters else []
    return np.asarray(np.linalg.qr(np.stack(columns, axis=1))[0]) if columns else np.zeros((depth.size, 0))


def _trials(depth: FloatArray, parameters: Sequence[str]) -> FloatArray:
    """Trial depths of indentation [m], from that of the third deepest point on."""
    if "contact_point" not in parameters:
        return np.array([float(depth.max())])
    travel = float(np.ptp(depth))
    least = max(float(depth.max() - np.partition(depth, -3)[-3]), 1e-3 * travel)
    return np.geomspace(least, FURTHEST * travel, _TRIALS)


def _powers(depth: FloatArray, reaches: FloatArray) -> Sequence[FloatArray]:
    """Depths of indentation to the powers 1, 3/2, 2 and 3, each of shape (m, n)."""
    x = np.maximum(depth - depth.max() + reaches[:, None], 0.0)
    return x, x * np.sqrt(x), x * x, x * x * x


def rough_fit(depth: FloatArray, force: FloatArray, parameters: Sequence[str]) -> tuple[float, float, FloatArray]:
    """The best power of the depth, before any scene is solved.

    Returns:
        Depth of indentation [m], decrease of the sum of squares [N^2] by the contact, and the residual [N], shape (n,).
    """
    reaches, columns = _trials(depth, parameters), background(depth, parameters)
    powers = _powers(depth, reaches)
    gains = np.stack([_gains(phi, force, columns) for phi in powers])
    power, trial = divmod(int(np.argmax(gains)), gains.shape[1])
    matrix = np.column_stack([columns, powers[power][trial] / (powers[power][trial].max() or 1.0)])
    residual = force - matrix @ np.linalg.lstsq(matrix, force, rcond=None)[0]
    return float(reaches[trial]), float(gains.max()), residual


def _gains(phi: FloatArray, force: FloatArray, columns: FloatArray) -> FloatArray:
    """Decrease of the sum of squares by E phi with E > 0, beyond that of the background, for phi of shape (m, n)."""
    remaining = force - columns @ (columns.T @ force)
    phi = phi - (phi @ columns) @ columns.T
    square = np.sum(phi * phi, axis=1)
    product = np.maximum(phi @ remaining, 0.0)
    return np.asarray(np.divide(product**2, square, out=np.zeros_like(square), where=square > 0.0))


def best_point(
    shape: CurveShape,
    depth: FloatArray,
    force: FloatArray,
    parameters: Sequence[str],
    *,
    rough: float,
    reach: float,
    modulus: float | None = None,
) -> Values:
    """The best trial contact point near a rough depth of indentation [m], with its modulus and background.

    Args:
        shape: Force over modulus, up to `reach`.
        depth: [m], shape (n,).
        force: [N], shape (n,).
        parameters: Which of contact_point, baseline and tilt are fitted.
        rough: Depth of indentation [m].
        reach: Largest depth of the shape [m].
        modulus: E [Pa] where it is not fitted.
    """
    deepest, columns = float(depth.max()), background(depth, parameters)
    trials = np.array([deepest])
    if "contact_point" in parameters:
        trials = np.geomspace(rough / 3, 3 * rough, _FINER)
        trials = np.minimum(trials, min(reach, FURTHEST * float(np.ptp(depth))))
    phi = shape.per_modulus(np.minimum(depth - deepest + trials[:, None], reach))
    remaining = force - columns @ (columns.T @ force)
    squares = float(remaining @ remaining) - _gains(phi, force, columns)
    if modulus is not None:
        misfit = force - modulus * phi
        squares = np.sum((misfit - (misfit @ columns) @ columns.T) ** 2, axis=1)
    best = int(np.argmin(squares))
    point = deepest - float(trials[best])
    remaining = force if modulus is None else force - modulus * phi[best]
    basis = {"youngs_modulus": phi[best]} if modulus is None else {}
    basis |= {"baseline": np.ones_like(depth)} if "baseline" in parameters else {}
    basis |= {"tilt": depth - point} if "tilt" in parameters else {}
    return {"contact_point": point, **_linear_part(basis, remaining)}


def _linear_part(basis: dict[str, FloatArray], force: FloatArray) -> Values:
    """Factors of the columns by linear least squares."""
    if not basis:
        return {}
    matrix = np.stack(list(basis.values()), axis=1)
    length = np.linalg.norm(matrix, axis=0)
    length[length == 0.0] = 1.0
    solved = np.linalg.lstsq(matrix / length, force, rcond=None)[0] / length
    return dict(zip(basis, solved.tolist(), strict=True))


def least_squares(
    linearised: Linearised, start: Values, force: FloatArray, bounds: Mapping[str, tuple[float, float]]
) -> tuple[Values, float, bool]:
    """Values of least squares, their sum of squares, and whether the steps have converged (Levenberg, Marquardt).

    Args:
        linearised: Forces (n,) and their derivatives (n, p) at values.
        start: First values, in the order of the columns.
        force: Measured [N], shape (n,).
        bounds: Least and largest value of some parameters.
    """
    values, damping = dict(start), 1e-4
    model, jacobian = linearised(values)
    squares = float(np.sum((force - model) ** 2))
    floor = 1e-22 * float(force @ force)
    for _ in range(_STEPS):
        length = np.linalg.norm(jacobian, axis=0)
        unit = jacobian / np.where(length > 0.0, length, 1.0)
        free, right = _free(unit, values, bounds, force - model)
        normal = unit[:, free].T @ unit[:, free]
        step = np.zeros(len(values))
        step[free] = np.linalg.solve(normal + damping * np.eye(len(free)), right)
        small = float(np.sum((unit @ step) ** 2)) <= _DONE**2 * squares / force.size + floor
        trial = _moved(values, step / np.where(length > 0.0, length, 1.0), bounds)
        trial_model, trial_jacobian = linearised(trial)
        changed = float(np.sum((force - trial_model) ** 2))
        if changed <= squares:
            values, model, jacobian, squares, damping = trial, trial_model, trial_jacobian, changed, damping / 10
        elif not small:
            damping *= 10
        if small or damping > 1e12:
            return values, squares, small
    return values, squares, False


def _free(
    unit: FloatArray, values: Values, bounds: Mapping[str, tuple[float, float]], residual: FloatArray
) -> tuple[list[int], FloatArray]:
    """Numbers of the parameters that may move, and their gradients: those on a bound move only inwards."""
    gradient = unit.T @ residual
    free = [
        i
        for i, (name, value) in enumerate(values.items())
        for low, high in [bounds.get(name, (-np.inf, np.inf))]
        if not (value <= low and gradient[i] < 0.0) and not (value >= high and gradient[i] > 0.0)
    ]
    return free, gradient[free]


def _moved(values: Values, step: FloatArray, bounds: Mapping[str, tuple[float, float]]) -> Values:
    moved = dict[str, float]()
    for (name, value), change in zip(values.items(), step.tolist(), strict=True):
        low, high = bounds.get(name, (-np.inf, np.inf))
        moved[name] = min(max(value + change, low), high)
    return moved
