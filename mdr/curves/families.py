"""Force curves of a scene as a function of one further number u that a fit varies, F = E phi(d; u).

| fitted | u | E |
|---|---|---|
| youngs_modulus of a uniform or graded layer | none | free |
| thickness | ln h | free |
| layer[0].youngs_modulus or base.youngs_modulus of a stack | ln of that modulus | 1: phi is the force |
| youngs_modulus with a known work of adhesion w | ln E | 1: phi is the force |
| youngs_modulus and work_of_adhesion | sqrt(w/E) | free |
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from scipy.interpolate import CubicSpline

from contact import Adhesion, CoatedPair, ElasticBase, InvalidInput, LayerStack, Scene
from contact.records.validation import BoolArray, FloatArray
from mdr.curves.force_curve import CurveShape, curve_to, longest_curve, power_spline

UNITS: Final = {"contact_point": "m", "baseline": "N", "tilt": "N/m", "thickness": "m", "work_of_adhesion": "J/m^2"}
BACKGROUND: Final = ("contact_point", "baseline", "tilt")
# Values of a varied modulus and of a thickness whose curves are solved, over the first guess. A fitted value lies
# between the outermost ones. With factors of 9 the error of the splines is 1e-2, with 2 there are twice the solutions.
_MODULI: Final = tuple(3.0**k for k in range(-5, 6))
_THICKNESSES: Final = tuple(10 ** (k / 4) for k in range(-4, 5))
# Values of the second family over the result of the first fit. The error of its splines is below 1e-7.
_SECOND: Final = tuple(1.1**k for k in range(-3, 4))


@dataclass(frozen=True)
class Family:
    """Force curves F = E phi(d; u).

    Attributes:
        shape: Returns phi(.; u), [m^2] with a free modulus E, else the force of the contact [N] with E = 1.
        error: Returns the relative error of the force by the computation at u and at depths [m].
        varied: Name of the fitted parameter of which u is a function, see the table above; empty where there is none.
        parameter: Returns this parameter in SI from u and E.
        has_free_modulus: Whether E is fitted.
        starts: First values of u.
        unit: Typical size of u.
        attached: Points in contact, shape (n,), where the data show them; None where they are those with d > 0.
        pull_off: Returns depth [m] and phi at pull-off at u; None without adhesion.
    """

    shape: Callable[[float], CurveShape]
    error: Callable[[float, FloatArray], float]
    varied: str = ""
    parameter: Callable[[float, float], float] = lambda u, modulus: 0.0
    has_free_modulus: bool = True
    starts: Sequence[float] = (0.0,)
    unit: float = 1.0
    attached: BoolArray | None = None
    pull_off: Callable[[float], tuple[float, float]] | None = None


def fixed_family(shape: CurveShape, error: float = 0.0) -> Family:
    """The family of one curve phi [m^2] with a relative error."""
    return Family(lambda u: shape, lambda u, depth: error)


def elastic_family(scene: Scene, names: Sequence[str], reach: float, center: float | None = None) -> Family:
    """Force curves without adhesion, as functions of the one varied parameter among `names`, if there is one.

    Curves are solved at values about `center`, by default the scene's, and up to the depth `reach` [m]. Between them
    ln F is a cubic spline over the logarithm of the parameter.
    """
    varied = next((name for name in names if name == "thickness" or "." in name), "")
    if not varied:
        curve = longest_curve(scene, reach)
        return fixed_family(curve.extended, curve.error)
    factors = _SECOND if center else _THICKNESSES if varied == "thickness" else _MODULI
    values = np.multiply(center or _number(scene, varied), factors).tolist()
    scenes = [changed(scene, varied, value) for value in values]
    reach = min(longest_curve(example, reach).largest_depth for example in scenes)
    curves = [curve_to(example, reach) for example in scenes]
    nodes = np.array([curve.nodes[1:] for curve in curves])
    if varied != "thickness":
        nodes[:, 0] += np.log([[example.layer.surface.youngs_modulus] for example in scenes])
    starts = np.log(values)
    spline = CubicSpline(starts, nodes)

    def inside(u: float) -> float:
        return float(np.clip(u, starts[0], starts[-1]))

    return Family(
        lambda u: power_spline(curves[0].nodes[0], *spline(inside(u))),
        lambda u, depth: max(curve.error for curve in curves),
        varied=varied,
        parameter=lambda u, modulus: math.exp(inside(u)),
        has_free_modulus=varied == "thickness",
        starts=starts.tolist(),
    )


def unit_of_parameter(name: str) -> str:
    """SI unit of a fitted parameter."""
    if name.startswith("relaxation_time"):
        return "s"
    return "Pa s" if name == "viscosity" else UNITS.get(name, "Pa")


def is_modulus(name: str) -> bool:
    """Whether the parameter is a Young's modulus."""
    return name.rpartition(".")[2] == "youngs_modulus"


def check_parameters(scene: Scene, parameters: Sequence[str]) -> None:
    """Refuse parameters that the scene does not have, and effects that a fit does not model.

    Raises:
        InvalidInput: With the remedy.
    """
    moduli = [name for name in parameters if is_modulus(name)]
    if not moduli or not {*parameters} <= {*UNITS, *moduli} or len(set(parameters)) < len(parameters):
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
    if "thickness" in parameters and scene.layer.is_half_space:
        raise InvalidInput("thickness: the layer is a half-space; give the scene a thickness as a first guess")
    if scene.effect(Adhesion) is None and "work_of_adhesion" in parameters:
        raise InvalidInput("work_of_adhesion: list Adhesion among the effects of the scene, with a first guess")
    if scene.effect(Adhesion) is not None and varied not in ([], ["work_of_adhesion"]):
        raise InvalidInput(f"Adhesion: {varied[0]} is fitted without adhesion only; fit youngs_modulus")
    _check_moduli(scene, moduli)


def _check_moduli(scene: Scene, names: Sequence[str]) -> None:
    """Refuse names of moduli that the layer of the scene does not have."""
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
    if name == "thickness":
        return scene.replace(layer=layer.replace(thickness=value))
    if name == "base.youngs_modulus":
        return scene.replace(layer=layer.replace(support=layer.support.replace(youngs_modulus=value)))
    sublayers = list(layer.sublayers)
    sublayers[_sublayer_index(name)] = sublayers[_sublayer_index(name)].replace(youngs_modulus=value)
    return scene.replace(layer=layer.replace(sublayers=sublayers))


def _number(scene: Scene, name: str) -> float:
    """Value of the parameter in the scene: the thickness [m], or the modulus of that name [Pa]."""
    layer: Any = scene.layer
    if name == "thickness":
        return float(layer.thickness)
    part = layer.support if name.startswith("base") else layer.sublayers[_sublayer_index(name)]
    return float(part.youngs_modulus)


def _sublayer_index(name: str) -> int:
    """Index of the sublayer in a name like layer[0].youngs_modulus."""
    return int(name.partition("[")[2].partition("]")[0])
