"""What a fit may vary: force curves of a scene as a function of one further number, F = factor phi(d; u).

| fitted | u | factor |
|---|---|---|
| youngs_modulus of a uniform or graded layer | none | E, linear |
| thickness | ln h | E, linear |
| layer[0].youngs_modulus or base.youngs_modulus of a stack | ln of that modulus | surface modulus at u |
| youngs_modulus with a known work of adhesion w | ln E | E at u |
| youngs_modulus and work_of_adhesion | sqrt(w/E) | E, linear |
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from typing import Any, Final, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from contact import Adhesion, CoatedPair, ElasticBase, InvalidInput, LayerStack, Scene
from contact.records.validation import FloatArray
from mdr.curves.force_curve import blended, curve_to, longest_curve

UNITS: Final = {"contact_point": "m", "baseline": "N", "tilt": "N/m", "thickness": "m", "work_of_adhesion": "J/m^2"}
BACKGROUND: Final = ("contact_point", "baseline", "tilt")
_NAMED = re.compile(r"layer\[(\d+)\]\.youngs_modulus")
# Values of a named modulus and of a thickness whose curves are solved, over the first guess. A fitted value stays
# between the outermost ones. With factors of 9 the splines between them err by 1e-2, with 2 the solutions double.
_MODULI: Final = tuple(3.0**k for k in range(-5, 6))
_THICKNESSES: Final = tuple(10 ** (k / 4) for k in range(-4, 5))
# Spread of the second family of curves about the first result. Its splines err by less than 1e-7.
_SECOND: Final = tuple(1.1**k for k in range(-3, 4))


# phi = F/E [m^2] at depths [m] of any size, zero where nothing touches.
CurveShape: TypeAlias = Callable[[ArrayLike], FloatArray]


class Family:
    """Force curves over one further number u; here one curve alone.

    Attributes:
        varied: Name of the parameter that u stands for, empty where there is none.
        is_scaled: Whether the factor E is linear and free.
        starts: First values of u.
    """

    varied: str = ""
    is_scaled: bool = True
    starts: Sequence[float] = (0.0,)

    def __init__(self, shape: CurveShape, error: float = 0.0) -> None:
        """The family of one curve, with the relative error of its computation."""
        self._shape, self._error = shape, error

    def at(self, u: float) -> CurveShape:
        """phi at u."""
        return self._shape

    def factor(self, u: float) -> float:
        """E [Pa] at u where it is not free."""
        return 1.0

    def value(self, u: float, modulus: float) -> tuple[float, float, float]:
        """The parameter in SI, and its derivatives by u and by E."""
        return 0.0, 0.0, 0.0

    def size(self, u: float) -> float:
        """Change of u that counts as large."""
        return 1.0

    def error(self, u: float, depth: FloatArray) -> float:
        """Relative error of the force by the computation, at depths [m]."""
        return self._error


class Solved(Family):
    """Curves of a scene at several values of a modulus or thickness, and splines over the logarithm between them."""

    def __init__(self, scene: Scene, name: str, values: Sequence[float], reach: float) -> None:
        """Solve the scene at each value."""
        scenes = [changed(scene, name, value) for value in values]
        self.varied, self.is_scaled = name, name == "thickness"
        self.starts = np.log(values).tolist()
        self._scene, self._values = scene, values
        self.reach = min(longest_curve(one, reach).largest_depth for one in scenes)
        curves = [curve_to(one, self.reach) for one in scenes]
        self._at, self._error = blended(values, curves), max(one.error for one in curves)

    def at(self, u: float) -> CurveShape:
        """The curve at exp(u), at the ends those of the outermost value."""
        return self._at(self._inside(u)).extended

    def factor(self, u: float) -> float:
        """The modulus of the surface [Pa]."""
        return float(changed(self._scene, self.varied, self._inside(u)).layer.surface.youngs_modulus)

    def value(self, u: float, modulus: float) -> tuple[float, float, float]:
        """exp(u)."""
        return self._inside(u), self._inside(u), 0.0

    def _inside(self, u: float) -> float:
        return float(np.clip(math.exp(min(u, 700.0)), self._values[0], self._values[-1]))


def elastic_family(scene: Scene, names: Sequence[str], reach: float, about: float | None = None) -> Family:
    """The family of a scene without adhesion, up to a depth [m]; about a value of the varied number, if it is given."""
    varied = [name for name in names if name == "thickness" or "." in name]
    if not varied:
        curve = longest_curve(scene, reach)
        return Family(curve.extended, curve.error)
    (name,) = varied
    guess = about or number_of(scene, name)
    factors = _SECOND if about else _THICKNESSES if name == "thickness" else _MODULI
    return Solved(scene, name, [guess * factor for factor in factors], reach)


def unit_of_parameter(name: str) -> str:
    """SI unit of a fitted parameter."""
    if name.startswith("relaxation_time"):
        return "s"
    return "Pa s" if name == "viscosity" else UNITS.get(name, "Pa")


def is_modulus(name: str) -> bool:
    """Whether the parameter is a Young's modulus."""
    return name.rpartition(".")[2] == "youngs_modulus"


def check_parameters(scene: Scene, parameters: Sequence[str]) -> None:
    """Refuse names that the scene does not have, and effects that a fit would leave out.

    Raises:
        InvalidInput: With the remedy.
    """
    unknown = [name for name in parameters if name not in UNITS and not is_modulus(name)]
    if unknown or len(set(parameters)) < len(parameters) or not any(is_modulus(name) for name in parameters):
        raise InvalidInput(
            f"parameters = {', '.join(parameters)}: fit youngs_modulus, and any of contact_point, baseline, tilt, "
            "thickness, work_of_adhesion, each once"
        )
    omitted = [type(effect).__name__ for effect in scene.effects if not isinstance(effect, Adhesion)]
    if omitted:
        raise InvalidInput(
            f"effects: {', '.join(omitted)} would be left out, for fits of force over depth are elastic, with adhesion "
            "at most; take it out of the scene to fit without it, or fit layers that relax over time (a column of time)"
        )
    varied = [name for name in parameters if "." in name or name in ("thickness", "work_of_adhesion")]
    if len(varied) > 1 or (varied and "." in varied[0] and "youngs_modulus" in parameters):
        raise InvalidInput(f"{' and '.join(varied)}: one curve does not determine both; fit one, and keep the other")
    if scene.effect(Adhesion) is None and "work_of_adhesion" in parameters:
        raise InvalidInput("work_of_adhesion: list Adhesion among the effects of the scene, with a first guess")
    if scene.effect(Adhesion) is not None and varied not in ([], ["work_of_adhesion"]):
        raise InvalidInput(f"Adhesion: {varied[0]} is fitted without adhesion only; fit youngs_modulus")
    _check_moduli(scene, [name for name in parameters if is_modulus(name)])


def _check_moduli(scene: Scene, names: Sequence[str]) -> None:
    layer = scene.layer
    several = isinstance(layer, LayerStack | CoatedPair) or layer.has_elastic_base
    known = ["youngs_modulus"] if not several else []
    if isinstance(layer, LayerStack):
        known += [f"layer[{i}].youngs_modulus" for i in range(len(layer.sublayers))]
        known += ["base.youngs_modulus"] if isinstance(layer.support, ElasticBase) else []
    if not known:
        raise InvalidInput("layer: it has several moduli, and fits know those of a Layer, GradedLayer or LayerStack")
    wrong = [name for name in names if name not in known]
    if wrong:
        raise InvalidInput(
            f"{', '.join(wrong)}: the layer has {'several moduli' if several else 'one modulus'}; name what is fitted "
            f"of {', '.join(known)} (--fit {known[0]}), the rest is kept as in the scene"
        )


def changed(scene: Scene, name: str, value: float) -> Scene:
    """The scene with another modulus of a sublayer or of the base [Pa], or with another thickness [m]."""
    layer: Any = scene.layer
    if found := _NAMED.fullmatch(name):
        sublayers = list(layer.sublayers)
        sublayers[int(found[1])] = sublayers[int(found[1])].replace(youngs_modulus=value)
        return scene.replace(layer=layer.replace(sublayers=sublayers))
    if name == "base.youngs_modulus":
        return scene.replace(layer=layer.replace(support=layer.support.replace(youngs_modulus=value)))
    if isinstance(layer, LayerStack | CoatedPair):
        raise InvalidInput("thickness: only that of a single layer is fitted; a stack keeps its thicknesses")
    return scene.replace(layer=layer.replace(thickness=value))


def number_of(scene: Scene, name: str) -> float:
    """The modulus [Pa] or thickness [m] of that name in the scene."""
    layer: Any = scene.layer
    if found := _NAMED.fullmatch(name):
        return float(layer.sublayers[int(found[1])].youngs_modulus)
    return float(layer.support.youngs_modulus if name == "base.youngs_modulus" else layer.thickness)
