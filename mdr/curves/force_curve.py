"""The master curve of a scene: force over modulus against depth, solved once and then evaluated at once.

Without effects the force is linear in Young's modulus, F = E phi(d). Between solved depths ln(phi) is a cubic in ln(d)
with the exact slopes d k_N / F at its ends, for dF/dd = k_N. Below the first depth phi goes on as a power of d.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from contact import ContactPath, IndentationDepths, InvalidInput, Scene
from contact.records.validation import FloatArray
from mdr.method import Mdr

# Decades of depth between the first and the last solved one; below them phi has the power of its first two depths.
_DECADES = 5.0
# Solved depths: the error of the cubics falls with the fourth power of their number, and is stated, not assumed.
_DEPTHS = 257
# Halving the spacing of cubics divides their error by 16; half of that is claimed.
_CLAIMED_GAIN = 8.0


class ForceCurve:
    """The force of an elastic scene as a function of depth, from one solution.

    Attributes:
        scene: Layer, indenter, and a loading by depths whose largest is how far the curve reaches.
        error: Stated relative error of the force: of the method and of the interpolation.
    """

    def __init__(self, scene: Scene, method: Mdr | None = None) -> None:
        """Solve the scene once.

        Raises:
            InvalidInput: If the scene has effects or prescribes no depths.
        """
        if scene.effects or not isinstance(scene.loading, IndentationDepths):
            raise InvalidInput("scene: a force curve is elastic and prescribes indentation depths; leave effects out")
        deepest = float(scene.loading.values.max())
        if not deepest > 0.0:
            raise InvalidInput(f"loading.values = {deepest:g}: give the largest depth that the curve shall reach")
        self.scene = scene
        self._method = method or Mdr()
        path = _solved(self._method, scene, deepest)
        modulus = scene.layer.surface.youngs_modulus
        self._log_depth = np.log(path.indentation_depth)
        self._log_force = np.log(path.normal_force / modulus)
        self._power = path.contact_stiffness * path.indentation_depth / path.normal_force
        self._step = float(self._log_depth[-1] - self._log_depth[0]) / (path.indentation_depth.size - 1)
        self.error = float(path.error_estimate["normal_force"].max()) + self._interpolation_error()

    @property
    def largest_depth(self) -> float:
        """How far the curve reaches [m]."""
        return float(np.exp(self._log_depth[-1]))

    def __call__(self, depth: ArrayLike, youngs_modulus: float | None = None) -> FloatArray:
        """Force [N] at depths [m]: that of the scene's own modulus [Pa], or of another one at the surface."""
        modulus = self.scene.layer.surface.youngs_modulus if youngs_modulus is None else youngs_modulus
        return modulus * self.per_modulus(depth)

    def per_modulus(self, depth: ArrayLike) -> FloatArray:
        """phi = F/E [m^2], zero for depths of at most zero.

        Raises:
            InvalidInput: If a depth is beyond the curve.
        """
        return self._value_and_power(depth)[0]

    def per_modulus_slope(self, depth: ArrayLike) -> FloatArray:
        """d(phi)/d(depth) = k_N/E [m]."""
        return self.with_slope(depth)[1]

    def with_slope(self, depth: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """phi and its derivative together."""
        force, power = self._value_and_power(depth)
        d = np.asarray(depth, dtype=np.float64)
        return force, np.divide(power * force, d, out=np.zeros_like(force), where=d > 0.0)

    def replaced(self, **changes: object) -> ForceCurve:
        """The curve with other numbers of layer or indenter, as in `replaced(thickness=2e-6, radius=1e-5)`; kept.

        Raises:
            InvalidInput: If neither has such a field.
        """
        layer, indenter = self.scene.layer, self.scene.indenter
        for name, value in changes.items():
            if hasattr(layer, name):
                layer = layer.replace(**{name: value})
            elif hasattr(indenter, name):
                indenter = indenter.replace(**{name: value})
            else:
                raise InvalidInput(f"{name}: neither the layer nor the indenter has it")
        return _kept(self.scene.replace(layer=layer, indenter=indenter), self._method)

    def _value_and_power(self, depth: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """phi and d ln(phi)/d ln(d)."""
        d = np.asarray(depth, dtype=np.float64)
        if d.size and not float(d.max()) <= self.largest_depth * (1 + 1e-12):
            raise InvalidInput(
                f"depth = {float(d.max()):g} m: this curve reaches {self.largest_depth:g} m; give the scene deeper ones"
            )
        touches = d > 0.0
        log_depth = np.log(np.where(touches, d, 1.0))
        log_force, power = _cubic(self._log_depth, self._log_force, self._power, log_depth, self._step)
        return np.where(touches, np.exp(log_force), 0.0), power

    def _interpolation_error(self) -> float:
        """From every other depth: the largest relative error at those left out, less what halving the spacing gains."""
        x, y, slope = self._log_depth[::2], self._log_force[::2], self._power[::2]
        coarse = _cubic(x, y, slope, self._log_depth[1::2], 2 * self._step)[0]
        return float(np.abs(coarse - self._log_force[1::2]).max()) / _CLAIMED_GAIN


def blended(numbers: Sequence[float], curves: Sequence[ForceCurve]) -> Callable[[float], ForceCurve]:
    """Curves of one reach between those at the given numbers, by cubic splines of ln(F) over ln(number)."""
    from scipy.interpolate import CubicSpline  # noqa: PLC0415  # loaded only where one modulus of several is fitted

    parts = [np.stack([one._log_force + np.log(one.scene.layer.surface.youngs_modulus), one._power]) for one in curves]
    spline = CubicSpline(np.log(numbers), np.stack(parts))

    def at(number: float) -> ForceCurve:
        """The curve at a number."""
        curve = copy.copy(curves[0])
        log_force, curve._power = spline(np.log(number))
        curve._log_force = log_force - np.log(curve.scene.layer.surface.youngs_modulus)
        return curve

    return at


def _solved(method: Mdr, scene: Scene, deepest: float) -> ContactPath:
    depths = deepest * np.logspace(-_DECADES, 0.0, _DEPTHS)
    depths[-1] = deepest
    return method.solve(scene.replace(loading=IndentationDepths(depths), beyond_small_strains=True))


def _cubic(
    x: FloatArray, y: FloatArray, slope: FloatArray, at: FloatArray, step: float
) -> tuple[FloatArray, FloatArray]:
    """Hermite cubics on evenly spaced x, values and slopes at `at`; linear beyond the ends."""
    piece = np.clip(((at - x[0]) / step).astype(np.intp), 0, x.size - 2)
    t = np.clip((at - x[piece]) / step, -np.inf, np.inf)
    y0, y1, m0, m1 = y[piece], y[piece + 1], step * slope[piece], step * slope[piece + 1]
    rise = y1 - y0
    c, d = 3 * rise - 2 * m0 - m1, m0 + m1 - 2 * rise
    before = t < 0.0
    value = np.where(before, y0 + m0 * t, y0 + t * (m0 + t * (c + t * d)))
    found_slope = np.where(before, m0, m0 + t * (2 * c + 3 * d * t)) / step
    return value, found_slope


@lru_cache(maxsize=64)
def _kept(scene: Scene, method: Mdr) -> ForceCurve:
    """Curves of changed scenes, the last 64."""
    return ForceCurve(scene, method)
