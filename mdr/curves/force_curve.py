"""The force curve of a scene: force over modulus against depth, solved once and then interpolated.

Without effects the force is linear in Young's modulus, F = E phi(d). Between solved depths ln(phi) is a cubic in ln(d)
with the exact slopes d k_N / F, for dF/dd = k_N. Outside the solved depths phi continues as a power of d.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import CubicHermiteSpline

from contact import IndentationDepths, InvalidInput, Scene, UnsupportedSceneError
from contact.records.validation import FloatArray
from mdr.method import Mdr

# Decades of depth between the first and the last solved one. With half as many the error of the power law below the
# first one is 1e-3.
_DECADES = 5.0
# Solved depths. The error of the cubics falls with the fourth power of their number, and is stated.
_DEPTHS = 257
# Assumed ratio of the errors of cubics with twice and with the same spacing; 16 in theory, 8 is on the safe side.
_CLAIMED_GAIN = 8.0
# Largest number of halvings of the reach, for indenters that end at a millionth of the first one.
_HALVINGS = 20
# Logarithm of the range of power laws beyond the solved depths. Twice as much costs a digit there.
_BEYOND = 1e3

# A force [N], or phi = F/E [m^2], at depths [m] of any size and shape, zero where nothing touches.
CurveShape: TypeAlias = Callable[[ArrayLike], FloatArray]


class ForceCurve:
    """The force of an elastic scene as a function of depth.

    Attributes:
        scene: Layer, indenter, and a loading by depths whose largest is the reach of the curve.
        error: Relative error estimate of the force, of the method plus the interpolation.
        nodes: Logarithms of the solved depths [m] and of phi [m^2], and slopes of the latter, each of shape (n,).
        extended: phi [m^2] at depths [m], beyond the reach as a power of the depth.
        depth_of: Depth [m] at phi = F/E [m^2], zero where that is at most zero.
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
            raise InvalidInput(f"loading.values = {deepest:g}: give the largest depth of the curve, above zero")
        self.scene = scene
        depths = deepest * np.logspace(-_DECADES, 0.0, _DEPTHS)
        depths[-1] = deepest
        path = (method or Mdr()).solve(scene.replace(loading=IndentationDepths(depths), beyond_small_strains=True))
        log_depth = np.log(path.indentation_depth)
        log_phi = np.log(path.normal_force / scene.layer.surface.youngs_modulus)
        power = path.contact_stiffness * path.indentation_depth / path.normal_force
        self.nodes = log_depth, log_phi, power
        self.extended, self.depth_of = (
            power_spline(log_depth, log_phi, power),
            power_spline(log_phi, log_depth, 1 / power),
        )
        coarse = CubicHermiteSpline(log_depth[::2], log_phi[::2], power[::2])(log_depth[1::2])
        interpolation = float(np.abs(coarse - log_phi[1::2]).max()) / _CLAIMED_GAIN
        self.error = float(path.error_estimate["normal_force"].max()) + interpolation

    @property
    def largest_depth(self) -> float:
        """Largest depth of the curve [m]."""
        return float(np.exp(self.nodes[0][-1]))

    def __call__(self, depth: ArrayLike, youngs_modulus: float | None = None) -> FloatArray:
        """Force [N] at depths [m]: that of the scene's own modulus [Pa], or of another one at the surface."""
        modulus = self.scene.layer.surface.youngs_modulus if youngs_modulus is None else youngs_modulus
        return modulus * self.per_modulus(depth)

    def per_modulus(self, depth: ArrayLike) -> FloatArray:
        """phi = F/E [m^2], zero for depths of at most zero.

        Raises:
            InvalidInput: If a depth is beyond the reach of the curve.
        """
        deepest = float(np.max(depth, initial=0.0))
        if not deepest <= self.largest_depth * (1 + 1e-12):
            raise InvalidInput(
                f"depth = {deepest:g} m: this curve reaches {self.largest_depth:g} m; give the scene deeper ones"
            )
        return self.extended(depth)


def power_spline(log_x: FloatArray, log_y: FloatArray, power: FloatArray) -> CurveShape:
    """The function y(x), zero for x <= 0: ln y is a cubic of ln x between nodes with these slopes, linear beyond."""
    x = np.concatenate([log_x[:1] - _BEYOND, log_x, log_x[-1:] + _BEYOND])
    y = np.concatenate([log_y[:1] - _BEYOND * power[0], log_y, log_y[-1:] + _BEYOND * power[-1]])
    spline = CubicHermiteSpline(x, y, np.concatenate([power[:1], power, power[-1:]]))

    def curve(values: ArrayLike) -> FloatArray:
        """The function at values of any size and shape."""
        given = np.asarray(values, dtype=np.float64)
        y, positive = np.zeros_like(given), given > 0.0
        y[positive] = np.exp(np.minimum(spline(np.log(given[positive])), 700.0))
        return y

    return curve


_solved_curve = lru_cache(maxsize=64)(ForceCurve)


def curve_to(scene: Scene, reach: float) -> ForceCurve:
    """The elastic curve of the scene up to a depth [m]; the last 64 are cached."""
    return _solved_curve(scene.replace(loading=IndentationDepths([reach]), effects=(), beyond_small_strains=True))


@lru_cache(maxsize=256)
def longest_curve(scene: Scene, reach: float, halvings: int = _HALVINGS) -> ForceCurve:
    """Elastic force curve up to the depth `reach` [m]; the depth is halved until the scene can be solved there.

    Depths beyond the end of a short indenter are refused.

    Raises:
        InvalidInput, UnsupportedSceneError: If the scene is refused at every depth.
    """
    try:
        return curve_to(scene, reach)
    except (InvalidInput, UnsupportedSceneError):
        if halvings == 0:
            raise
    return longest_curve(scene, reach / 2, halvings - 1)
