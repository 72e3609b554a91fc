"""Layers as models of nanite and PyJibe, programs that fit force curves: bonded or not, under three kinds of tips.

In Python `register()` adds all of them to nanite. PyJibe (Preferences, Extensions) and nanite's
`load_model_from_file` take this file, which is then the model of a paraboloid on a bonded layer.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache, partial
from math import inf, log2, radians, tan
from types import SimpleNamespace
from typing import Any, Final, Literal, TypeAlias

import numpy as np

from contact import Cone, IndentationDepths, InvalidInput, Layer, Paraboloid, Profile, Scene, Sphere
from contact.records.validation import FloatArray
from mdr.curves.force_curve import ForceCurve

TipOfModel: TypeAlias = Literal["paraboloid", "sphere", "cone"]
SupportOfModel: TypeAlias = Literal["bonded", "unbonded"]

# Tips by nanite's own names, units and first values: 10 um, and 25 degrees from the axis.
_TIPS: Final[dict[TipOfModel, tuple[str, str, str, float, Callable[[float], Profile]]]] = {
    "paraboloid": ("R", "Tip Radius", "m", 10e-6, lambda radius: Paraboloid(radius_of_curvature=radius)),
    "sphere": ("R", "Tip Radius", "m", 10e-6, lambda radius: Sphere(radius=radius)),
    "cone": ("alpha", "Half Cone Angle", "deg", 25.0, lambda angle: Cone(slope=1.0 / tan(radians(angle)))),
}
_SUPPORTS: Final[tuple[SupportOfModel, ...]] = ("bonded", "unbonded")


def layer_model(tip: TipOfModel, support: SupportOfModel) -> SimpleNamespace:
    """What nanite asks of the module of a model: names, units, first values and the force.

    Parameters are Young's modulus E, tip, Poisson's ratio nu, thickness h, contact point and force baseline; E, contact
    point and baseline are fitted, the others as they are set free.

    Raises:
        InvalidInput: If there is no such tip or support.
    """
    if tip not in _TIPS or support not in _SUPPORTS:
        raise InvalidInput(f"{tip} on a {support} layer: give {', '.join(_TIPS)}, and {' or '.join(_SUPPORTS)}")
    key, name, unit, _, _ = _TIPS[tip]
    words = "bonded to" if support == "bonded" else "not bonded to"
    return SimpleNamespace(
        get_parameter_defaults=partial(_first_values, tip),
        model_doc=f"{tip.capitalize()} on an elastic layer that is {words} a rigid base, solved exactly.",
        model_func=_force_function(tip, support),
        model_key=f"layer_{tip}_{support}",
        model_name=f"{tip} on a {support} layer",
        parameter_keys=["E", key, "nu", "h", "contact_point", "baseline"],
        parameter_names=[
            "Young's Modulus",
            name,
            "Poisson's Ratio",
            "Layer Thickness",
            "Contact Point",
            "Force Baseline",
        ],
        parameter_units=["Pa", unit, "", "m", "m", "N"],
        valid_axes_x=["tip position"],
        valid_axes_y=["force"],
    )


def register() -> list[str]:
    """Make all of them known to nanite, and return their keys.

    Raises:
        InvalidInput: If nanite is not installed.
    """
    try:
        from nanite.model import register_model  # noqa: PLC0415  # an optional package
    except ImportError:
        raise InvalidInput("nanite is not installed: pip install 'contact-verification[fit]' nanite") from None
    models = [layer_model(tip, support) for tip in _TIPS for support in _SUPPORTS]
    for model in models:
        register_model(model)
    return [model.model_key for model in models]


def _first_values(tip: TipOfModel) -> Any:
    """As `lmfit.Parameters`; what a curve hardly tells is held."""
    import lmfit  # noqa: PLC0415  # nanite brings it

    key, _, _, value, _ = _TIPS[tip]
    parameters = lmfit.Parameters()
    parameters.add("E", value=3e3, min=0)
    parameters.add(key, value=value, min=0, max=90 if tip == "cone" else inf, vary=False)
    parameters.add("nu", value=0.5, min=0, max=0.5, vary=False)
    parameters.add("h", value=5e-6, min=0, vary=False)
    parameters.add("contact_point", value=0)
    parameters.add("baseline", value=0)
    return parameters


def _force_function(tip: TipOfModel, support: SupportOfModel) -> Callable[..., FloatArray]:
    """The force at tip positions [m], which decrease as the tip goes in; nanite looks at the order of the arguments."""
    if tip == "cone":

        def of_cone(  # noqa: PLR0917  # called by name, declared in the order that nanite checks
            delta: FloatArray, E: float, alpha: float, nu: float, h: float, contact_point: float, baseline: float
        ) -> FloatArray:
            return E * _per_modulus(tip, support, contact_point - delta, (alpha, nu, h)) + baseline

        return of_cone

    def of_sphere(  # noqa: PLR0917  # as above
        delta: FloatArray, E: float, R: float, nu: float, h: float, contact_point: float, baseline: float
    ) -> FloatArray:
        return E * _per_modulus(tip, support, contact_point - delta, (R, nu, h)) + baseline

    return of_sphere


def _per_modulus(
    tip: TipOfModel, support: SupportOfModel, depth: FloatArray, numbers: tuple[float, float, float]
) -> FloatArray:
    """F/E [m^2]: from the kept curve that reaches the next power of two of the depth, if the tip is that long."""
    deepest = float(np.max(depth, initial=0.0))
    if deepest <= 0.0:
        return np.zeros_like(depth)
    try:
        curve = _curve(tip, support, numbers, 2.0 ** np.ceil(log2(deepest)))
    except InvalidInput:
        curve = _curve(tip, support, numbers, deepest)
    return curve.per_modulus(depth)


@lru_cache(maxsize=64)
def _curve(tip: TipOfModel, support: SupportOfModel, numbers: tuple[float, float, float], deepest: float) -> ForceCurve:
    size, nu, thickness = numbers
    layer = Layer(thickness=thickness, youngs_modulus=1.0, poissons_ratio=nu, support=support)
    return ForceCurve(Scene(layer=layer, indenter=_TIPS[tip][-1](size), loading=IndentationDepths([deepest])))


globals().update(vars(layer_model("paraboloid", "bonded")))
