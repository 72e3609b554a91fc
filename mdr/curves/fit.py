"""Young's modulus from one force curve, with intervals, warnings, and what formulas in use would have said.

Model: F = E phi(d - d0) + f0 + k (d - d0), with phi the force curve of the scene; where one modulus of several is
fitted, the force curve of the scene with that modulus.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final, Literal

import numpy as np

from contact import Adhesion, InvalidInput, NotConvergedError, Scene, UnsupportedSceneError
from contact.records.validation import FloatArray
from mdr.curves.adhering import fit_adhesive
from mdr.curves.formulas import formulas_for
from mdr.curves.models import BACKGROUND, Model, check_parameters, curve_to, is_modulus, linearised, modulus_of
from mdr.curves.result import CurveFit, FormulaFit, check_contact, stated
from mdr.curves.search import FURTHEST, CurveShape, Values, best_point, least_squares, rough_fit

DEFAULT_PARAMETERS: Final = ("youngs_modulus", "contact_point", "baseline", "tilt")
# A fitted thickness stays within this factor of the scene's: beyond it the scene is another one.
_THICKNESS_FACTOR: Final = 10.0
# First guesses of a named modulus over the scene's: one is within a factor of 1.7 of any from 1/200 to 200 times it.
_FACTORS: Final = tuple(3.0**k for k in range(-5, 6))
# Halvings of the reach until an indenter is long enough for it: from a travel of a thousand times its length.
_HALVINGS: Final = 20


@dataclass(frozen=True)
class Limit:
    """How deep points are fitted.

    Attributes:
        kind: "depth" of indentation [m], "force" of the contact [N], or "fraction" of its largest force.
        value: Points beyond it are left out.
    """

    kind: Literal["depth", "force", "fraction"]
    value: float


def fit_curve(
    scene: Scene,
    depth: Sequence[float] | FloatArray,
    force: Sequence[float] | FloatArray,
    *,
    parameters: Sequence[str] = DEFAULT_PARAMETERS,
    confidence: float = 0.95,
    limit: Limit | None = None,
    formulas: bool = True,
) -> CurveFit:
    """Fit Young's modulus, and what else is asked for, to one curve.

    Args:
        scene: Tip and layer. A modulus that is fitted is a first guess, the others are kept. The loading is not used.
            With Adhesion among its effects the curve is that of withdrawal.
        depth: Measured depths [m] from any zero if the contact point is fitted, shape (n,). A baseline before contact
            of any length may be among them.
        force: Measured forces [N], shape (n,).
        parameters: "youngs_modulus", or of a stack "layer[0].youngs_modulus", "base.youngs_modulus"; and any of
            "contact_point", "baseline", "tilt", "thickness", "work_of_adhesion".
        confidence: Of the intervals.
        limit: Points up to a depth, a force or a fraction of the largest force are fitted; by default all.
        formulas: Whether formulas in use are fitted too.

    Raises:
        InvalidInput: For data that are no curve or show no contact, parameters that the scene does not have, and
            effects that a fit would leave out.
        NotConvergedError: If the least squares do not converge, or end in several places.
    """
    check_parameters(scene, parameters)
    d, f = _checked(depth, force, parameters)
    found = _fitted(scene, d, f, tuple(parameters), confidence)
    if limit is not None:
        found = _limited(found, limit, d, f)
    bare = [name for name in parameters if name in ("youngs_modulus", *BACKGROUND)]
    if not formulas or scene.effects or "youngs_modulus" not in parameters:
        return found
    return replace(found, formulas=_by_formulas(found, bare))


def fit_elastic(scene: Scene, d: FloatArray, f: FloatArray, parameters: Sequence[str]) -> tuple[Model, Values, bool]:
    """The model and values of least squares of a curve without adhesion, and whether the steps have converged.

    Raises:
        InvalidInput: If the indenter is shorter than the depth of indentation.
    """
    rough, deepest = check_contact(d, f, parameters), float(d.max())
    reach, tip_ends = _reach(scene, 2.0 ** math.ceil(math.log2(4 * rough)))
    while True:
        model = Model(scene, d, parameters, reach)
        lowest = max(deepest - reach, deepest - FURTHEST * float(np.ptp(d)))
        ends = []
        for start in _starts(model, f, min(rough, reach)):
            bounds = _bounds(start, lowest, deepest)
            ends.append(least_squares(model.linearised, start, f, bounds))
        values, _, converged = min(ends, key=lambda end: end[1])
        if model.family is not None:
            model.family = None
            values, _, converged = least_squares(model.linearised, values, f, _bounds(values, lowest, deepest))
        shallow = values.get("contact_point", 0.0) > lowest + 1e-6 * reach
        if shallow or lowest > deepest - reach:
            return model, values, converged
        if tip_ends:
            curve_to(scene, 2 * reach)
        rough, reach = reach, 2 * reach


def _reach(scene: Scene, reach: float) -> tuple[float, bool]:
    """The reach [m], halved until the indenter is that long, and whether it was."""
    for halvings in range(60):
        try:
            curve_to(scene, reach)
        except (InvalidInput, UnsupportedSceneError):
            if halvings == _HALVINGS:
                raise
            reach /= 2
        else:
            return reach, halvings > 0
    raise AssertionError


def _starts(model: Model, force: FloatArray, rough: float) -> list[Values]:
    """First values: the best trial contact point of the curve's own shape, for named moduli at each of many factors."""
    scene, names, starts = model.scene, model.parameters, list[Values]()
    named = [name for name in names if "." in name]
    if len(named) == 1:
        model.tabulate(named[0], [factor * modulus_of(scene, named[0]) for factor in _FACTORS])
    for factor in _FACTORS if named else (1.0,):
        guess = {name: factor * modulus_of(scene, name) for name in named}
        curve = model.curve(guess)
        modulus = curve.scene.layer.surface.youngs_modulus if named else None
        best = best_point(curve, model.depth, force, names, rough=rough, reach=model.reach, modulus=modulus) | guess
        best["thickness"] = scene.layer.thickness
        if not named:
            best["youngs_modulus"] = abs(best["youngs_modulus"]) or 1.0
        starts.append({name: best[name] for name in names})
    return starts


def _bounds(start: Values, lowest: float, deepest: float) -> dict[str, tuple[float, float]]:
    """Least and largest value of each parameter that has them."""
    bounds = {"contact_point": (lowest, deepest)}
    for name, value in start.items():
        if is_modulus(name):
            bounds[name] = (1e-6 * value, 1e6 * value) if "." not in name else (1e-3 * value, 1e3 * value)
        elif name == "thickness":
            bounds[name] = (value / _THICKNESS_FACTOR, value * _THICKNESS_FACTOR)
    return bounds


def _fitted(scene: Scene, d: FloatArray, f: FloatArray, parameters: tuple[str, ...], confidence: float) -> CurveFit:
    solve = fit_elastic if scene.effect(Adhesion) is None else fit_adhesive
    model, values, converged = solve(scene, d, f, parameters)
    if not converged:
        raise NotConvergedError("the fit did not converge; fit fewer parameters, or a shorter range of the curve")
    return stated(model, values, f, confidence)


def _limited(found: CurveFit, limit: Limit, d: FloatArray, f: FloatArray) -> CurveFit:
    """The fit up to the limit; twice, for the first one finds the contact point from all points."""
    names, largest = tuple(found.values), math.nan
    for _ in range(2):
        point = found.values.get("contact_point", 0.0)
        deepest = point + limit.value
        if limit.kind != "depth":
            order = np.argsort(found.depth)
            line = found.values.get("baseline", 0.0) + found.values.get("tilt", 0.0) * (found.depth - point)
            contact = np.maximum.accumulate((found.fitted - line)[order])
            largest = contact[-1] if math.isnan(largest) else largest
            share = limit.value if limit.kind == "force" else limit.value * largest
            deepest = float(np.interp(share, contact, found.depth[order]))
        kept = d <= deepest
        found = _fitted(found.scene, *_checked(d[kept], f[kept], names), names, found.confidence)
    return found


def _by_formulas(found: CurveFit, parameters: Sequence[str]) -> tuple[FormulaFit, ...]:
    return tuple(
        FormulaFit(formula=formula, youngs_modulus=other, bias=other / found.youngs_modulus - 1.0)
        for formula in formulas_for(found.scene)
        for other in [_modulus_by(formula, found.depth, found.force, parameters)]
    )


def _modulus_by(shape: CurveShape, d: FloatArray, f: FloatArray, parameters: Sequence[str]) -> float:
    """E [Pa] by least squares with the same parameters as the curve itself."""
    start = best_point(shape, d, f, parameters, rough=rough_fit(d, f, parameters)[0], reach=math.inf)
    start = {name: start[name] for name in parameters}
    bounds = {"contact_point": (float(d.max()) - FURTHEST * float(np.ptp(d)), float(d.max()))}
    values, _, _ = least_squares(lambda values: linearised(shape, d, values), start, f, bounds)
    return values["youngs_modulus"]


def _checked(
    depth: Sequence[float] | FloatArray, force: Sequence[float] | FloatArray, parameters: Sequence[str]
) -> tuple[FloatArray, FloatArray]:
    d, f = (np.asarray(values, dtype=np.float64) for values in (depth, force))
    if d.ndim != 1 or d.shape != f.shape or d.size <= len(parameters):
        raise InvalidInput(
            f"a curve of {d.size} depths and {f.size} forces: give one force for each depth, and more points than the "
            f"{len(parameters)} parameters"
        )
    fixed = "contact_point" not in parameters
    if not (np.isfinite(d).all() and np.isfinite(f).all() and np.ptp(d) > 0.0) or (fixed and not d.max() > 0.0):
        raise InvalidInput("a curve needs finite numbers, and depths that grow beyond 0; pressing is positive")
    return d, f
