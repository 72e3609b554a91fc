"""Forces of a scene at measured depths, and their derivatives by the fitted parameters.

What is fitted is named: "youngs_modulus" of a uniform or graded layer scales the force, "layer[0].youngs_modulus" of a
stack changes one sublayer, "base.youngs_modulus" its elastic base, and the rest of the scene is kept.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any, Final

import numpy as np

from contact import Adhesion, CoatedPair, ElasticBase, IndentationDepths, InvalidInput, LayerStack, Scene
from contact.records.validation import FloatArray
from mdr.curves.adhesive_curve import adhesive_curve
from mdr.curves.force_curve import ForceCurve, blended
from mdr.curves.search import CurveShape, Values

UNITS: Final = {
    "contact_point": "m",
    "baseline": "N",
    "tilt": "N/m",
    "thickness": "m",
    "work_of_adhesion": "J/m^2",
}
BACKGROUND: Final = ("contact_point", "baseline", "tilt")
# Relative step of central differences: errors grow as its square; at a tenth of it the table's rounding shows.
_STEP = 1e-3
_NAMED = re.compile(r"layer\[(\d+)\]\.youngs_modulus")


def unit_of_parameter(name: str) -> str:
    """SI unit of a fitted parameter."""
    return UNITS.get(name, "Pa")


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
            f"effects: {', '.join(omitted)} would be left out, for fits are elastic, with adhesion at most; take it "
            "out of the scene to fit without it"
        )
    if "work_of_adhesion" in parameters and scene.effect(Adhesion) is None:
        raise InvalidInput("work_of_adhesion: list Adhesion among the effects of the scene, with a first guess")
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


def with_values(scene: Scene, values: Values) -> Scene:
    """The scene with fitted moduli of sublayers or base, thickness and work of adhesion."""
    layer: Any = scene.layer
    for name, value in values.items():
        if found := _NAMED.fullmatch(name):
            sublayers = list(layer.sublayers)
            sublayers[int(found[1])] = sublayers[int(found[1])].replace(youngs_modulus=value)
            layer = layer.replace(sublayers=sublayers)
        elif name == "base.youngs_modulus":
            layer = layer.replace(support=layer.support.replace(youngs_modulus=value))
        elif name == "thickness":
            if isinstance(layer, LayerStack | CoatedPair):
                raise InvalidInput("thickness: only that of a single layer is fitted; a stack keeps its thicknesses")
            layer = layer.replace(thickness=value)
    return scene if layer is scene.layer else scene.replace(layer=layer)


def modulus_of(scene: Scene, name: str) -> float:
    """The modulus [Pa] of that name in the scene."""
    layer: Any = scene.layer
    found = _NAMED.fullmatch(name)
    if found:
        return float(layer.sublayers[int(found[1])].youngs_modulus)
    return float(layer.support.youngs_modulus if name == "base.youngs_modulus" else layer.surface.youngs_modulus)


def linearised(shape: CurveShape, depth: FloatArray, values: Values) -> tuple[FloatArray, FloatArray]:
    """F = E phi + f0 + k (d - d0) [N], shape (n,), and its derivatives by each value in SI, shape (n, p)."""
    modulus, point, tilt = values["youngs_modulus"], values.get("contact_point", 0.0), values.get("tilt", 0.0)
    shifted = depth - point
    phi, slope = shape.with_slope(shifted)
    columns = {
        "youngs_modulus": phi,
        "contact_point": -modulus * slope - tilt,
        "baseline": np.ones_like(depth),
        "tilt": shifted,
    }
    force = modulus * phi + values.get("baseline", 0.0) + tilt * shifted
    return force, np.stack([columns[name] for name in values], axis=1)


@lru_cache(maxsize=256)
def curve_to(scene: Scene, reach: float) -> ForceCurve:
    """The force curve of an elastic scene up to a depth [m]; the last 256 are kept.

    Raises:
        InvalidInput: If the indenter is not that long.
    """
    elastic = scene.replace(loading=IndentationDepths([reach]), effects=(), beyond_small_strains=True)
    return ForceCurve(elastic)


class Model:
    """Forces of a curve and their derivatives by the parameters.

    Attributes:
        scene: As given.
        depth: Measured [m], shape (n,).
        parameters: Their names, in the order of derivatives.
        reach: Largest depth of indentation [m] that is solved.
        attached: Which points are on the branch in contact, shape (n,); None for elastic scenes.
    """

    def __init__(
        self, scene: Scene, depth: FloatArray, parameters: Sequence[str], reach: float, attached: Any = None
    ) -> None:
        self.scene, self.depth, self.parameters, self.reach = scene, depth, tuple(parameters), reach
        self.attached = attached
        adhesion = scene.effect(Adhesion)
        self.work = None if adhesion is None else adhesion.work_of_adhesion
        self.family: tuple[str, Callable[[float], ForceCurve]] | None = None
        self.is_linear = self.work is None and "youngs_modulus" in parameters

    def curve(self, values: Values) -> ForceCurve:
        """The elastic curve of the scene with these values."""
        if self.family is not None and self.family[0] in values:
            return self.family[1](values[self.family[0]])
        named = {name: value for name, value in values.items() if name == "thickness" or "." in name}
        return curve_to(with_values(self.scene, named) if named else self.scene, self.reach)

    def tabulate(self, name: str, moduli: Sequence[float]) -> None:
        """Interpolate the curves of one modulus [Pa] between those given; `family = None` solves each curve again."""
        curves = [curve_to(with_values(self.scene, {name: modulus}), self.reach) for modulus in moduli]
        self.family = name, blended(moduli, curves)

    def contact_force(self, values: Values) -> FloatArray:
        """Force [N] of the contact alone, shape (n,)."""
        curve, shifted = self.curve(values), self.depth - values.get("contact_point", 0.0)
        if self.work is None:
            return curve(shifted, values.get("youngs_modulus"))
        table = adhesive_curve(curve.scene)
        modulus = values.get("youngs_modulus", curve.scene.layer.surface.youngs_modulus)
        try:
            return table.force(shifted, modulus, self._work(values), self.attached)
        except InvalidInput:
            # Steps of least squares are shortened where the table ends.
            return np.full(self.depth.shape, np.nan)

    def _work(self, values: Values) -> float:
        """Work of adhesion [J/m^2]. Its square root is fitted, for F - F_el is proportional to it."""
        root = values.get("work_of_adhesion")
        return (self.work or 0.0) if root is None else root**2

    def in_words(self, values: Values, errors: Values) -> tuple[Values, Values]:
        """Values and standard errors with the work of adhesion [J/m^2] in place of its square root."""
        if "work_of_adhesion" not in values:
            return values, errors
        root, error = values["work_of_adhesion"], errors["work_of_adhesion"]
        return (
            {**values, "work_of_adhesion": root**2},
            {**errors, "work_of_adhesion": 2 * root * error + error**2},
        )

    def doubts(self, values: Values) -> tuple[str, ...]:
        """Warnings on points that the data show in contact and the fitted branch does not reach."""
        if self.work is None or self.attached is None:
            return ()
        table = adhesive_curve(self.curve(values).scene)
        modulus = values.get("youngs_modulus", self.curve(values).scene.layer.surface.youngs_modulus)
        shifted = self.depth - values.get("contact_point", 0.0)
        beyond = int(np.sum(self.attached & (shifted < table.branch(modulus, self._work(values))[0][0])))
        if beyond <= 1 + 0.02 * self.depth.size:
            return ()
        return (f"{beyond} points in contact are beyond the pull-off of the fit: the scene does not describe them",)

    def force(self, values: Values) -> FloatArray:
        """F [N], shape (n,)."""
        point = values.get("contact_point", 0.0)
        line = values.get("baseline", 0.0) + values.get("tilt", 0.0) * (self.depth - point)
        return self.contact_force(values) + line

    def linearised(self, values: Values) -> tuple[FloatArray, FloatArray]:
        """F [N], shape (n,), and its derivatives by each parameter in SI, shape (n, p)."""
        if self.is_linear and set(values) <= {"youngs_modulus", *BACKGROUND}:
            return linearised(self.curve(values), self.depth, values)
        ones = np.ones_like(self.depth)
        known = {"baseline": ones, "tilt": self.depth - values.get("contact_point", 0.0)}
        columns = [known[name] if name in known else self._difference(values, name) for name in values]
        return self.force(values), np.stack(columns, axis=1)

    def _difference(self, values: Values, name: str) -> FloatArray:
        size = {"contact_point": 0.1 * self.reach, "work_of_adhesion": self.work**0.5 if self.work else 0.0}.get(
            name, 0.0
        )
        step = _STEP * max(abs(values[name]), size)
        low, high = values[name] - step, values[name] + step
        if name == "work_of_adhesion":
            low = max(low, 0.0)
        up, down = (self.force({**values, name: value}) for value in (high, low))
        return (up - down) / (high - low)

    def numerical_error(self, values: Values) -> float:
        """Relative error of the force by the computation."""
        curve = self.curve(values)
        if self.work is None:
            return curve.error
        shifted = self.depth - values.get("contact_point", 0.0)
        modulus = values.get("youngs_modulus", curve.scene.layer.surface.youngs_modulus)
        work = self._work(values)
        return curve.error + adhesive_curve(curve.scene).error(shifted, modulus, work, self.attached)
