"""Young's modulus from one force curve, with intervals, warnings, and what formulas in use would have said.

Model: F = E phi(d - d0) + f0 + k (d - d0), with phi the force curve of the scene, of one family of shapes where more
than E is fitted (`families`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final, Literal

import numpy as np
from numpy.polynomial.polynomial import polyfit

from contact import Adhesion, InvalidInput, NotConvergedError, Scene
from contact.answer.small_strains import depth_note
from contact.records.validation import FloatArray
from mdr.curves.adhesion import Adhering, fit_adhesive, hides_pull_off, points_beyond, tabor_sentence
from mdr.curves.contact_point import (
    FURTHEST,
    Data,
    Fitted,
    least_squares,
    rough_indentation,
    trial_indentations,
)
from mdr.curves.families import (
    BACKGROUND,
    Family,
    Solved,
    changed,
    check_parameters,
    elastic_family,
    is_modulus,
)
from mdr.curves.force_curve import curve_to, longest_curve
from mdr.curves.formulas import formulas_for
from mdr.curves.result import ROUNDING, CurveFit, FormulaFit, with_intervals

DEFAULT_PARAMETERS: Final = ("youngs_modulus", "contact_point", "baseline", "tilt")
# Relative step of central differences by u. Errors grow as its square; at a tenth of it rounding shows.
_STEP: Final = 1e-3
# A baseline is too short if a quadratic background would widen the interval of E by more than this factor.
# At twice that shifts of several intervals are silent; at half of it curves with a baseline of half the travel warn.
_BENT: Final = 3.0
# Least points in contact minus parameters of the contact. With one less the interval of E may be ten times too narrow.
_SPARE_POINTS: Final = 2


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
            "contact_point", "baseline", "tilt", and one of "thickness", "work_of_adhesion".
        confidence: Of the intervals.
        limit: Points up to a depth, a force or a fraction of the largest force are fitted; by default all.
        formulas: Whether formulas in use are fitted too.

    Raises:
        InvalidInput: For data that are no curve or show no contact, parameters that the scene does not have, and
            effects that a fit would leave out.
        NotConvergedError: If the least squares end in several places, or at no value.
    """
    check_parameters(scene, parameters)
    data = _checked(depth, force, parameters)
    found = _fitted(scene, data, confidence)
    if limit is not None:
        found = _limited(found, limit, data)
    if not formulas or scene.effects or "youngs_modulus" not in parameters:
        return found
    # A formula that does not suit the curve would take its misfit for tilt: it has the background of this fit.
    names = [name for name in parameters if name in ("youngs_modulus", *BACKGROUND) and name != "tilt"]
    bare = Data.of(found.depth, found.force - found.background, names)
    return replace(found, formulas=_by_formulas(scene, bare, found.youngs_modulus))


def _checked(
    depth: Sequence[float] | FloatArray, force: Sequence[float] | FloatArray, parameters: Sequence[str]
) -> Data:
    d, f = (np.asarray(values, dtype=np.float64) for values in (depth, force))
    if d.ndim != 1 or d.shape != f.shape or d.size <= len(parameters):
        raise InvalidInput(
            f"a curve of {d.size} depths and {f.size} forces: give one force for each depth, and more points than the "
            f"{len(parameters)} parameters"
        )
    fixed = "contact_point" not in parameters
    if not (np.isfinite(d).all() and np.isfinite(f).all() and np.ptp(d) > 0.0) or (fixed and not d.max() > 0.0):
        raise InvalidInput("a curve needs finite numbers, and depths that grow beyond 0; pressing is positive")
    return Data.of(d, f, parameters)


def _fitted(scene: Scene, data: Data, confidence: float) -> CurveFit:
    fitted = _fit_elastic(scene, data) if scene.effect(Adhesion) is None else fit_adhesive(scene, data)
    return _stated(scene, data, fitted, confidence)


def _fit_elastic(scene: Scene, data: Data) -> Fitted:
    """Values of least squares without adhesion; the curve is solved deeper until it reaches the contact point."""
    rough = rough_indentation(data)
    wanted = 2.0 ** math.ceil(math.log2(4 * rough))
    reach = longest_curve(scene, wanted).largest_depth
    while True:
        best = _search(data, elastic_family(scene, data.names, reach), min(rough, reach), reach)
        if isinstance(best.family, Solved):
            value = best.family.value(best.u, 1.0)[0]
            _check_inside(best.family, best.u, value)
            near = elastic_family(scene, data.names, reach, value)
            best = _search(data, near, best.indentation, reach)
        if best.indentation <= reach * (1 + 1e-9):
            return best
        if best.indentation > FURTHEST * float(np.ptp(data.depth)) and data.has_free_point:
            raise InvalidInput(
                "no contact point within half a travel before the first depth: the curve is almost straight; measure "
                "a baseline before contact, or fit without tilt (--with contact_point)"
            )
        if reach < wanted:
            curve_to(scene, 2 * reach)  # says in words why the indenter is not that long
        rough, reach = best.indentation, 2.0 ** math.ceil(math.log2(1.5 * best.indentation))


def _search(data: Data, family: Family, rough: float, reach: float) -> Fitted:
    points = trial_indentations(data, rough, reach)
    return least_squares(data, family, dict.fromkeys(family.starts, points))[0]


def _check_inside(family: Solved, u: float, value: float) -> None:
    """Refuse values at the ends of what is tried.

    Raises:
        NotConvergedError: With the remedy.
    """
    if not family.starts[0] < u < family.starts[-1]:
        raise NotConvergedError(
            f"{family.varied}: no value within a factor of {math.exp(family.starts[-1] - family.starts[0]) ** 0.5:.0f} "
            f"of the scene's fits best (the fit ends at {value:.3g}); the curve does not determine it, or the scene "
            "is another one"
        )


def _stated(scene: Scene, data: Data, fitted: Fitted, confidence: float) -> CurveFit:
    """Covariance, intervals, band and warnings of the values of least squares."""
    family, u = fitted.family, fitted.u
    modulus = fitted.modulus
    point = data.deepest - fitted.indentation
    pressed = family.attached if isinstance(family, Adhering) else data.depth > point
    contact_names = [name for name in data.names if name not in ("baseline", "tilt")]
    if int(pressed.sum()) < len(contact_names) + _SPARE_POINTS or not modulus > 0.0:
        raise InvalidInput(
            f"{int(pressed.sum())} points in contact, from {point:.4g} m on: a fit of {' and '.join(contact_names)} "
            f"needs {len(contact_names) + _SPARE_POINTS}; measure more points in contact"
        )
    shifted = data.depth - point
    phi = family.at(u)(shifted)
    line = _background(data, data.force - modulus * phi, shifted)
    varied, by_u, by_modulus = family.value(u, modulus)
    known = line | {"contact_point": point, family.varied: varied}
    values = {name: known.get(name, modulus) for name in data.names}
    by_depth, change = _derivatives(family, u, shifted, modulus)
    columns = {"contact_point": -by_depth - line["tilt"], "baseline": np.ones_like(shifted), "tilt": shifted}
    columns |= {family.varied: change}  # "" where nothing is varied
    jacobian = np.stack([columns.get(name, phi) for name in values], axis=1)
    fitted_force = modulus * phi + line["baseline"] + line["tilt"] * shifted
    order = np.argsort(data.depth, kind="stable")
    warnings, notes = _words(scene, data, fitted, values, modulus)
    scatter = float(np.std(data.force - fitted_force))
    if scatter > ROUNDING * float(np.ptp(data.force)):
        warnings = (*warnings, *_bent_background(jacobian, list(values), shifted))
    return with_intervals(
        jacobian,
        (data.force - fitted_force)[order],
        pressed[order],
        _changes(values, family, by_u, by_modulus),
        values=values,
        confidence=confidence,
        # w = E u^2 is flat at u = 0.
        curvature={"work_of_adhesion": modulus} if "work_of_adhesion" in values else {},
        warnings=warnings,
        scene=scene,
        depth=data.depth,
        force=data.force,
        fitted=fitted_force,
        numerical_error=family.error(u, shifted),
        notes=notes,
        per_modulus=phi,
    )


def _bent_background(jacobian: FloatArray, names: list[str], depth: FloatArray) -> tuple[str, ...]:
    """Warning where the baseline is too short to distinguish a quadratic background from the contact."""
    if "tilt" not in names:
        return ()
    unit = jacobian / np.maximum(np.linalg.norm(jacobian, axis=0), np.finfo(float).tiny)
    bend, inverse = (depth / np.ptp(depth)) ** 2, np.linalg.pinv(unit.T @ unit, hermitian=True)
    shift = inverse @ (unit.T @ bend)
    left, row = bend - unit @ shift, next(i for i, name in enumerate(names) if is_modulus(name))
    wider = math.hypot(1.0, float(shift[row] / np.sqrt(left @ left * inverse[row, row] + np.finfo(float).tiny)))
    text = (
        "the baseline is too short to show whether the background is straight: with a quadratic background the "
        f"interval of the modulus would be {min(wider, 999):.2g} times as wide; measure more points before contact"
    )
    return (text,) if wider > _BENT else ()


def _background(data: Data, remaining: FloatArray, shifted: FloatArray) -> dict[str, float]:
    """Baseline [N] at the contact point, and tilt [N/m]."""
    powers = [power for power, name in enumerate(("baseline", "tilt")) if name in data.names]
    size = float(np.ptp(shifted))
    level, tilt = (*polyfit(shifted / size, remaining, powers), 0.0, 0.0)[:2] if powers else (0.0, 0.0)
    return {"baseline": float(level), "tilt": float(tilt) / size}


def _derivatives(family: Family, u: float, shifted: FloatArray, modulus: float) -> tuple[FloatArray, FloatArray]:
    """Derivatives of the force of the contact by depth and u, each of shape (n,), by central differences."""

    def force(at: float, move: float = 0.0) -> FloatArray:
        factor = modulus if family.is_scaled else family.factor(at)
        return factor * family.at(at)(shifted + move)

    move = _STEP * max(abs(float(shifted.max())), 1e-6 * float(np.ptp(shifted)))
    by_depth = (force(u, move) - force(u, -move)) / (2 * move)
    if not family.varied:
        return by_depth, np.zeros_like(by_depth)
    step = _STEP * family.size(u)
    return by_depth, (force(u + step) - force(u - step)) / (2 * step)


def _changes(values: dict[str, float], family: Family, by_u: float, by_modulus: float) -> FloatArray:
    """Derivatives of the parameters by those of least squares (E and u), shape (p, p)."""
    matrix, names = np.eye(len(values)), list(values)
    if family.varied:
        row = names.index(family.varied)
        matrix[row, row] = by_u
        if family.is_scaled:
            matrix[row, names.index("youngs_modulus")] = by_modulus
    return matrix


def _words(
    scene: Scene, data: Data, fitted: Fitted, values: dict[str, float], modulus: float
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Warnings on depth and pull-off, and notes."""
    family = fitted.family
    as_fitted = changed(scene, family.varied, values[family.varied]) if isinstance(family, Solved) else scene
    warnings, notes = [depth_note(as_fitted, fitted.indentation)], []
    effect = scene.effect(Adhesion)
    if effect is not None:
        beyond = points_beyond(data, fitted)
        if beyond > 1:
            warnings.append(f"{beyond} points in contact are beyond the pull-off of the fit; see the residuals")
        if "work_of_adhesion" in values and hides_pull_off(fitted):
            warnings.append(
                "the pull-off is hidden in the scatter: where contact ends is not seen, and the intervals of modulus "
                "and work of adhesion may be too narrow; average more curves, or fix the work of adhesion"
            )
        notes.append(tabor_sentence(scene, modulus, values.get("work_of_adhesion", effect.work_of_adhesion)))
    return tuple(filter(None, warnings)), tuple(filter(None, notes))


def _limited(found: CurveFit, limit: Limit, data: Data) -> CurveFit:
    """The fit up to the limit; twice, for the first one finds the contact point from all points."""
    largest = math.nan
    for _ in range(2):
        deepest = found.values.get("contact_point", 0.0) + limit.value
        if limit.kind != "depth":
            order = np.argsort(found.depth)
            contact = np.maximum.accumulate((found.fitted - found.background)[order])
            largest = contact[-1] if math.isnan(largest) else largest
            share = limit.value if limit.kind == "force" else limit.value * largest
            deepest = float(np.interp(share, contact, found.depth[order]))
        kept = data.depth <= deepest
        found = _fitted(found.scene, _checked(data.depth[kept], data.force[kept], data.names), found.confidence)
    return found


def _by_formulas(scene: Scene, data: Data, own: float) -> tuple[FormulaFit, ...]:
    """Each formula fitted to a curve without tilt."""
    found, rough = [], rough_indentation(data)
    for formula in formulas_for(scene):
        best = _search(data, Family(formula.per_modulus), rough, math.inf)
        found.append(FormulaFit(formula=formula, youngs_modulus=best.modulus, bias=best.modulus / own - 1.0))
    return tuple(found)
