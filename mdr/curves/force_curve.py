"""The force curve of a scene: force over modulus against depth, solved once and then interpolated.

Without effects the force is linear in Young's modulus, F = E phi(d). Between solved depths ln(phi) is a cubic in ln(d)
with the exact slopes d k_N / F, for dF/dd = k_N. Outside the solved depths phi continues as a power of d.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import CubicHermiteSpline, CubicSpline

from contact import IndentationDepths, InvalidInput, Scene, UnsupportedSceneError
from contact.records.validation import FloatArray
from mdr.method import Mdr

# Decades of depth between the first and the last solved one. With half as many the power law below errs by 1e-3.
_DECADES = 5.0
# Solved depths. The error of the cubics falls with the fourth power of their number, and is stated.
_DEPTHS = 257
# Halving the spacing divides the error of cubics by 16. Half of that is claimed.
_CLAIMED_GAIN = 8.0
# Halvings of the reach until an indenter is long enough for it: from a travel of a million times its length.
_HALVINGS = 20


class ForceCurve:
    """The force of an elastic scene as a function of depth.

    Attributes:
        scene: Layer, indenter, and a loading by depths whose largest is the reach of the curve.
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
        depths = deepest * np.logspace(-_DECADES, 0.0, _DEPTHS)
        depths[-1] = deepest
        path = (method or Mdr()).solve(scene.replace(loading=IndentationDepths(depths), beyond_small_strains=True))
        log_depth = np.log(path.indentation_depth)
        log_force = np.log(path.normal_force / scene.layer.surface.youngs_modulus)
        power = path.contact_stiffness * path.indentation_depth / path.normal_force
        self._interpolate(log_depth, log_force, power)
        coarse = CubicHermiteSpline(log_depth[::2], log_force[::2], power[::2])(log_depth[1::2])
        interpolation = float(np.abs(coarse - log_force[1::2]).max()) / _CLAIMED_GAIN
        self.error = float(path.error_estimate["normal_force"].max()) + interpolation

    def _interpolate(self, log_depth: FloatArray, log_force: FloatArray, power: FloatArray) -> None:
        self._nodes = log_depth, log_force, power
        self._log_force = CubicHermiteSpline(log_depth, log_force, power)
        self._power = self._log_force.derivative()

    @property
    def largest_depth(self) -> float:
        """Reach of the curve [m]."""
        return float(np.exp(self._nodes[0][-1]))

    def __call__(self, depth: ArrayLike, youngs_modulus: float | None = None) -> FloatArray:
        """Force [N] at depths [m]: that of the scene's own modulus [Pa], or of another one at the surface."""
        modulus = self.scene.layer.surface.youngs_modulus if youngs_modulus is None else youngs_modulus
        return modulus * self.per_modulus(depth)

    def per_modulus(self, depth: ArrayLike) -> FloatArray:
        """phi = F/E [m^2], zero for depths of at most zero.

        Raises:
            InvalidInput: If a depth is beyond the reach of the curve.
        """
        d = np.asarray(depth, dtype=np.float64)
        if d.size and not float(d.max()) <= self.largest_depth * (1 + 1e-12):
            raise InvalidInput(
                f"depth = {float(d.max()):g} m: this curve reaches {self.largest_depth:g} m; give the scene deeper ones"
            )
        return self.extended(d)

    def extended(self, depth: ArrayLike) -> FloatArray:
        """phi [m^2], beyond the reach as a power of the depth."""
        d = np.asarray(depth, dtype=np.float64)
        touches = d > 0.0
        log_depth = np.log(d[touches])
        inside = np.clip(log_depth, self._nodes[0][0], self._nodes[0][-1])
        log_force = self._log_force(inside)
        outside = inside != log_depth
        if outside.any():
            log_force[outside] += self._power(inside[outside]) * (log_depth - inside)[outside]
        phi = np.zeros_like(d)
        phi[touches] = np.exp(np.minimum(log_force, 700.0))
        return phi

    def depth_of(self, per_modulus: ArrayLike) -> FloatArray:
        """Depth [m] at F/E [m^2], zero where that is at most zero."""
        phi = np.asarray(per_modulus, dtype=np.float64)
        log_depth, log_force, power = self._nodes
        touches = phi > 0.0
        wanted = np.log(phi[touches])
        inside = np.clip(wanted, log_force[0], log_force[-1])
        inverse = CubicHermiteSpline(log_force, log_depth, 1 / power)
        depth = np.zeros_like(phi)
        depth[touches] = np.exp(inverse(inside) + (wanted - inside) / np.interp(inside, log_force, power))
        return depth


def curve_to(scene: Scene, reach: float) -> ForceCurve:
    """The elastic curve of the scene up to a depth [m]; the last 64 are cached."""
    return _cached(scene.replace(loading=IndentationDepths([reach]), effects=(), beyond_small_strains=True))


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


def blended(numbers: Sequence[float], curves: Sequence[ForceCurve]) -> Callable[[float], ForceCurve]:
    """Curves of one reach between those at the given numbers, by cubic splines of ln(F/E) over ln(number)."""
    spline = CubicSpline(np.log(numbers), np.stack([np.stack(one._nodes[1:]) for one in curves]))

    def at(number: float) -> ForceCurve:
        """The curve at a number."""
        curve = copy.copy(curves[0])
        log_force, power = spline(np.log(number))
        curve._interpolate(curves[0]._nodes[0], log_force, power)
        return curve

    return at


@lru_cache(maxsize=64)
def _cached(scene: Scene) -> ForceCurve:
    return ForceCurve(scene)
