"""Young's modulus from one force curve or a map of them, with intervals, warnings, and moduli by formulas in use.

Model: F = E phi(d - d0) + f0 + k (d - d0), with phi the force curve of the scene, of one family of shapes where more
than E is fitted (`families`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final, Literal, TypedDict, Unpack

import numpy as np
from numpy.polynomial.polynomial import polyfit

from contact import Adhesion, ContactError, InvalidInput, NotConvergedError, Scene
from contact.answer.small_strains import depth_note
from contact.records.validation import FloatArray
from mdr.curves.adhesion import DIP, fit_adhesive, pull_off_of, tabor_sentence
from mdr.curves.contact_point import (
    FURTHEST,
    Data,
    Fitted,
    least_squares,
    refuse_hold,
    rough_indentation,
    trial_indentations,
)
from mdr.curves.families import BACKGROUND, Family, changed, check_parameters, elastic_family, fixed_family
from mdr.curves.force_curve import longest_curve
from mdr.curves.formulas import formulas_for
from mdr.curves.result import CurveFit, FormulaFit, MapFit, with_intervals

DEFAULT_PARAMETERS: Final = ("youngs_modulus", "contact_point", "baseline", "tilt")
# Relative step of central differences, whose error is proportional to its square; a tenth of it amplifies rounding.
_STEP: Final = 1e-3
# Least points in contact minus parameters of the contact. With one less the interval of E may be ten times too narrow.
_SPARE_POINTS: Final = 2


@dataclass(frozen=True)
class Limit:
    """Limit of the points that are fitted.

    Attributes:
        kind: "depth" of indentation [m], "force" of the contact [N], or "fraction" of its largest force.
        value: Points beyond it are left out.
    """

    kind: Literal["depth", "force", "fraction"]
    value: float


class Options(TypedDict, total=False):
    """Options of a fit.

    Attributes:
        parameters: "youngs_modulus", or of a stack "layer[0].youngs_modulus", "base.youngs_modulus"; and any of
            "contact_point", "baseline", "tilt", and one of "thickness", "work_of_adhesion".
        confidence: Confidence of the intervals.
        limit: Points up to a depth, a force or a fraction of the largest force are fitted; by default all.
    """

    parameters: Sequence[str]
    confidence: float
    limit: Limit | None


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
    """Fit Young's modulus and further parameters to one force curve.

    Args:
        scene: Tip and layer. Its value of a fitted modulus is the first guess. The loading is not used. With Adhesion
            among its effects the curve is that of withdrawal.
        depth: Measured depths [m] from any zero if the contact point is fitted, shape (n,). A baseline before contact
            of any length may be among them.
        force: Measured forces [N], shape (n,).
        parameters: "youngs_modulus", or of a stack "layer[0].youngs_modulus", "base.youngs_modulus"; and any of
            "contact_point", "baseline", "tilt", and one of "thickness", "work_of_adhesion".
        confidence: Confidence of the intervals.
        limit: Points up to a depth, a force or a fraction of the largest force are fitted; by default all.
        formulas: Whether formulas in use are fitted too.

    Raises:
        InvalidInput: For data that are no curve or show no contact, parameters that the scene does not have, and
            effects that a fit does not model.
        NotConvergedError: If several minima fit equally well, or the best value is at the end of the searched range.
    """
    check_parameters(scene, parameters)
    data = _checked(depth, force, parameters)
    fit = _fitted(scene, data, confidence)
    if limit is not None:
        fit = _limited(fit, limit, data)
    if not formulas or scene.effects or "youngs_modulus" not in parameters:
        return fit
    # Formulas are fitted with the tilt of this fit: with a free tilt their misfit would appear as tilt.
    names = [name for name in parameters if name in ("youngs_modulus", *BACKGROUND) and name != "tilt"]
    bare = Data.of(fit.depth, fit.force - fit.background, names)
    return replace(fit, formulas=_by_formulas(scene, bare, fit.youngs_modulus))


def fit_map(
    scene: Scene,
    depth: Sequence[FloatArray] | FloatArray,
    force: Sequence[FloatArray] | FloatArray,
    *,
    positions: FloatArray | None = None,
    progress: Callable[[int, int], None] | None = None,
    **options: Unpack[Options],
) -> MapFit:
    """Fit every curve of a map by itself, as `fit_curve` does.

    Args:
        scene: As for `fit_curve`.
        depth: Measured depths [m] of each curve, n arrays of any lengths, or one array if all curves share them.
        force: Measured forces [N], n arrays of the lengths of their depths.
        positions: Places x, y of the curves in the map [m], shape (n, 2).
        progress: Called with the number of fitted curves and the number of all curves.
        options: Parameters, confidence and limit, as for `fit_curve`.

    Raises:
        InvalidInput: If depths and forces are no map, or no curve can be fitted with the scene and parameters.
    """
    check_parameters(scene, options.get("parameters", DEFAULT_PARAMETERS))
    if not len(force) or np.ndim(force[0]) != 1:
        raise InvalidInput(f"force has the shape {np.shape(force)}: give one row per curve")
    depths = [np.asarray(depth)] * len(force) if np.ndim(depth[0]) == 0 else list(depth)
    if len(depths) != len(force):
        raise InvalidInput(f"a map of {len(depths)} depths and {len(force)} forces: give one depth for each force")
    curves: list[CurveFit | None] = []
    reasons = [""] * len(force)
    for number, (d, f) in enumerate(zip(depths, force, strict=True)):
        try:
            curves.append(fit_curve(scene, d, f, formulas=False, **options))
        except ContactError as error:
            curves.append(None)
            reasons[number] = str(error)
        if progress is not None:
            progress(number + 1, len(force))
    places = np.full((len(force), 2), np.nan) if positions is None else positions
    return MapFit(curves=tuple(curves), reasons=tuple(reasons), positions=places)


def _checked(
    depth: Sequence[float] | FloatArray, force: Sequence[float] | FloatArray, parameters: Sequence[str]
) -> Data:
    """Data of a curve, after checks of shapes, number of points, finite values and depths."""
    d, f = (np.asarray(values, dtype=np.float64) for values in (depth, force))
    if d.ndim != 1 or d.shape != f.shape or d.size <= len(parameters):
        raise InvalidInput(
            f"a curve of {d.size} depths and {f.size} forces: give one force for each depth, and more points than the "
            f"{len(parameters)} parameters"
        )
    if np.all(d == d[0]):
        refuse_hold(d)
    fixed = "contact_point" not in parameters
    if not (np.isfinite(d).all() and np.isfinite(f).all() and np.ptp(d) > 0.0) or (fixed and not d.max() > 0.0):
        raise InvalidInput("a curve needs finite numbers, and depths that grow beyond 0; pressing is positive")
    return Data.of(d, f, parameters)


def _fitted(scene: Scene, data: Data, confidence: float) -> CurveFit:
    fitted = _fit_elastic(scene, data) if scene.effect(Adhesion) is None else fit_adhesive(scene, data)
    return _stated(scene, data, fitted, confidence)


def _fit_elastic(scene: Scene, data: Data) -> Fitted:
    """Result of least squares without adhesion, on a force curve that is extended until it covers the indentation."""
    rough = rough_indentation(data)
    first_reach = 2.0 ** math.ceil(math.log2(4 * rough))
    reach = longest_curve(scene, first_reach).largest_depth
    while True:
        best = _search(data, elastic_family(scene, data.names, reach), min(rough, reach), reach)
        if best.family.varied:
            near = elastic_family(scene, data.names, reach, _inner_value(best))
            best = _search(data, near, best.indentation, reach)
        if best.indentation <= reach * (1 + 1e-9):
            return best
        if best.indentation > FURTHEST * float(np.ptp(data.depth)) and data.has_free_point:
            raise InvalidInput(
                "no contact point within half a travel before the first depth: the curve is almost straight; measure "
                "a baseline before contact, or fit without tilt (--with contact_point)"
            )
        # The reach is the first one up to rounding, a half of it, a quarter ..
        if 1.5 * reach < first_reach:
            raise InvalidInput(
                f"indentation = {best.indentation:.4g} m: the scene can be solved up to {reach:.4g} m only; leave "
                "deeper points out (--until), or give the scene a longer indenter"
            )
        rough, reach = best.indentation, 2.0 ** math.ceil(math.log2(1.5 * best.indentation))


def _search(data: Data, family: Family, rough: float, reach: float) -> Fitted:
    """Best result of least squares, from trial indentations about `rough` [m] and all first values of u."""
    points = trial_indentations(data, rough, reach)
    return least_squares(data, family, dict.fromkeys(family.starts, points))[0]


def _inner_value(fitted: Fitted) -> float:
    """Fitted value of the varied parameter.

    Raises:
        NotConvergedError: If it is at an end of the searched range.
    """
    family, u = fitted.family, fitted.u
    value, low, high = family.parameter(u, 1.0), family.starts[0], family.starts[-1]
    if not low < u < high:
        raise NotConvergedError(
            f"{family.varied}: no value within a factor of {math.exp(high - low) ** 0.5:.0f} "
            f"of the scene's fits best (the fit ends at {value:.3g}); the curve does not determine it, or the scene "
            "is another one"
        )
    return value


def _stated(scene: Scene, data: Data, fitted: Fitted, confidence: float) -> CurveFit:
    """The fit with covariance, intervals, band and warnings, from the result of least squares."""
    family, names = fitted.family, data.names
    point = data.deepest - fitted.indentation
    shifted = data.depth - point
    pressed = shifted > 0.0 if family.attached is None else family.attached
    contact_names = [name for name in names if name not in ("baseline", "tilt")]
    if int(pressed.sum()) < len(contact_names) + _SPARE_POINTS or not fitted.modulus > 0.0:
        raise InvalidInput(
            f"{int(pressed.sum())} points in contact, from {point:.4g} m on: a fit of {' and '.join(contact_names)} "
            f"needs {len(contact_names) + _SPARE_POINTS}; measure more points in contact"
        )
    baseline, tilt = _background(data, fitted.modulus * family.shape(fitted.u)(shifted), shifted)
    depth, force = max(abs(float(shifted.max())), 1e-6 * float(np.ptp(shifted))), float(np.ptp(data.force))
    every = np.array([fitted.modulus, fitted.u, point, baseline, tilt])
    steps = _STEP * np.array([fitted.modulus, family.unit, depth, force, force / float(np.ptp(shifted))])
    places = {family.varied: 1, "contact_point": 2, "baseline": 3, "tilt": 4}
    rows = [places.get(name, 0) for name in names]

    def whole(x: FloatArray) -> list[float]:
        """E, u, contact point, baseline and tilt, of which x are fitted."""
        numbers = every.copy()
        numbers[rows] = x
        return list(map(float, numbers))

    def model(x: FloatArray) -> FloatArray:
        """Force [N] at the measured depths, shape (n,)."""
        modulus, u, contact_point, baseline, tilt = whole(x)
        d = data.depth - contact_point
        return np.asarray(modulus * family.shape(u)(d) + baseline + tilt * d)

    def parameters(x: FloatArray) -> dict[str, float]:
        """Value of each fitted parameter in SI units."""
        modulus, u, *line = whole(x)
        numbers = [modulus, family.parameter(u, modulus), *line]
        return {name: numbers[row] for name, row in zip(names, rows, strict=True)}

    warnings, notes = _words(scene, data, fitted, parameters(every[rows]))
    return with_intervals(
        model,
        parameters,
        every[rows],
        steps[rows],
        pressed,
        confidence=confidence,
        # w = E u^2 is flat at u = 0.
        curvature=[fitted.modulus * (name == "work_of_adhesion") for name in names],
        warnings=warnings,
        scene=scene,
        depth=data.depth,
        force=data.force,
        numerical_error=family.error(fitted.u, shifted),
        notes=notes,
    )


def _background(data: Data, contact: FloatArray, shifted: FloatArray) -> tuple[float, float]:
    """Baseline [N] at the contact point, and tilt [N/m], by least squares of the force without that of the contact."""
    powers = [power for power, name in enumerate(("baseline", "tilt")) if name in data.names]
    if not powers:
        return 0.0, 0.0
    size = float(np.ptp(shifted))
    level, slope = (*polyfit(shifted / size, data.force - contact, powers), 0.0)[:2]
    return float(level), float(slope) / size


def _words(scene: Scene, data: Data, fitted: Fitted, values: dict[str, float]) -> tuple[list[str], tuple[str, ...]]:
    """Warnings on depth and pull-off, and notes."""
    varied, effect = fitted.family.varied, scene.effect(Adhesion)
    as_fitted = changed(scene, varied, values[varied]) if varied and effect is None else scene
    warnings = [warning] if (warning := depth_note(as_fitted, fitted.indentation)) else []
    if effect is None:
        return warnings, ()
    signal, beyond = pull_off_of(data, fitted)
    if beyond > 1:
        warnings.append(f"{beyond} points in contact are beyond the pull-off of the fit; see the residuals")
    if "work_of_adhesion" in values and signal < DIP:
        warnings.append(
            "the pull-off is hidden in the scatter: where contact ends is not seen, and the intervals of modulus "
            "and work of adhesion may be too narrow; average more curves, or fix the work of adhesion"
        )
    note = tabor_sentence(scene, fitted.youngs_modulus, values.get("work_of_adhesion", effect.work_of_adhesion))
    return warnings, (note,) if note else ()


def _limited(fit: CurveFit, limit: Limit, data: Data) -> CurveFit:
    """The fit of points up to the limit, repeated once, since the limit depends on the fitted contact point."""
    largest = math.nan
    for _ in range(2):
        deepest = fit.values.get("contact_point", 0.0) + limit.value
        if limit.kind != "depth":
            order = np.argsort(fit.depth)
            contact = np.maximum.accumulate((fit.fitted - fit.background)[order])
            largest = contact[-1] if math.isnan(largest) else largest
            share = limit.value if limit.kind == "force" else limit.value * largest
            deepest = float(np.interp(share, contact, fit.depth[order]))
        within = data.depth <= deepest
        fit = _fitted(fit.scene, _checked(data.depth[within], data.force[within], data.names), fit.confidence)
    return fit


def _by_formulas(scene: Scene, data: Data, modulus: float) -> tuple[FormulaFit, ...]:
    """Fits of each formula to a curve without tilt, with the bias of E against the modulus [Pa] of the scene's fit."""
    rough, fits = rough_indentation(data), []
    for formula in formulas_for(scene):
        by_formula = _search(data, fixed_family(formula.per_modulus), rough, math.inf).modulus
        fits.append(FormulaFit(formula=formula, youngs_modulus=by_formula, bias=by_formula / modulus - 1.0))
    return tuple(fits)
