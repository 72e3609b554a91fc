"""A fitted curve with intervals: covariance of least squares, widened where the residuals are not white noise."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from contact import InvalidInput, Scene
from contact.answer.small_strains import depth_note
from contact.records.validation import FloatArray
from mdr.curves.formulas import Formula
from mdr.curves.models import Model, is_modulus, with_values
from mdr.curves.search import Values, rough_fit

# Correlation beyond which data hardly tell two parameters apart: the interval of each is then 7 times that with the
# other one known, 1/sqrt(1 - 0.99^2).
_CONFOUNDED: Final = 0.99
# Standard deviations of the correlation of neighbours that white noise does not reach. At 2 one curve in 40 would warn.
_NOT_WHITE: Final = 3.0
# Standard errors that a contact stands above scatter. The best of 240 trials in noise reaches 4; at 5 one in 1e4 does.
_CONTACT: Final = 5.5
# Residuals below this share of the largest force have no warning: rounding of files. At 1e-3 some misfits are silent.
_ROUNDING: Final = 1e-4


@dataclass(frozen=True, kw_only=True)
class FormulaFit:
    """What a fit by a formula in use gives on the same curve.

    Attributes:
        formula: Which.
        youngs_modulus: E [Pa].
        bias: E over that of the scene's own curve, less one.
    """

    formula: Formula
    youngs_modulus: float
    bias: float


@dataclass(frozen=True, kw_only=True)
class CurveFit:
    """A fitted force curve.

    Attributes:
        scene: As given; the fitted numbers are in `values`.
        depth: As measured [m], shape (n,).
        force: As measured [N], shape (n,).
        fitted: Force [N] of the fit at these depths, shape (n,).
        values: Each fitted parameter, SI.
        standard_error: Of each, from the scatter of the curve, widened where the residuals are not white noise.
        covariance: Of the parameters in the order of `values`, shape (p, p).
        quantile: Student's, for intervals of `confidence`.
        confidence: Of intervals and bands.
        band: Half width [N] of the band in which the curve lies with that confidence, shape (n,).
        numerical_error: Relative error of E by the computation itself; no part of `standard_error`.
        warnings: What a reader should know before relying on the numbers.
        input_error: Standard uncertainty of each parameter by uncertain numbers of the scene, where they were asked
            for (`cases.measurements.uncertain_fit`).
        formulas: The same curve fitted by formulas in use.
    """

    scene: Scene
    depth: FloatArray
    force: FloatArray
    fitted: FloatArray
    values: Mapping[str, float]
    standard_error: Mapping[str, float]
    covariance: FloatArray
    quantile: float
    confidence: float
    band: FloatArray
    numerical_error: float
    warnings: tuple[str, ...] = ()
    formulas: tuple[FormulaFit, ...] = field(default=())
    input_error: Mapping[str, float] = field(default_factory=dict)

    @property
    def youngs_modulus(self) -> float:
        """E [Pa]: the first fitted modulus."""
        return self.values[self.modulus_name]

    @property
    def modulus_name(self) -> str:
        """Name of the first fitted modulus."""
        return next(name for name in self.values if is_modulus(name))

    def interval(self, parameter: str) -> tuple[float, float]:
        """In which the parameter lies with `confidence`; with uncertain inputs, and of E with the numerical error."""
        half = self.quantile * float(np.hypot(self.standard_error[parameter], self.input_error.get(parameter, 0.0)))
        if is_modulus(parameter):
            half += self.numerical_error * self.values[parameter]
        return self.values[parameter] - half, self.values[parameter] + half


def check_contact(depth: FloatArray, force: FloatArray, parameters: Sequence[str]) -> float:
    """Rough depth of indentation [m]; curves whose force does not rise above scatter and drift are refused.

    Raises:
        InvalidInput: With the remedy.
    """
    rough, gain, residual = rough_fit(depth, force, parameters)
    freedom = max(depth.size - len(parameters), 1)
    variance = float(residual @ residual) / freedom * correlated(residual[np.argsort(depth, kind="stable")])
    if not gain > _CONTACT**2 * variance or not gain > 1e-20 * float(force @ force):
        raise InvalidInput(
            "no contact in the curve: the force does not rise above its scatter and a straight line as the depth "
            "grows; check columns and signs (pressing is positive), or fit without tilt (--with contact_point)"
        )
    return rough


def correlated(residual: FloatArray) -> float:
    """Factor of the variance of a mean by the correlation of neighbours, 1 + 2 (rho_1 + rho_2 + ..); 1 for white noise.

    The sum ends at the first correlation within scatter (initial positive sequence, Geyer 1992).
    """
    n = residual.size
    residual = residual - residual.mean()
    square = float(residual @ residual)
    if n < 8 or square == 0.0:
        return 1.0
    total, limit = 0.0, _NOT_WHITE / np.sqrt(n)
    for lag in range(1, n // 2):
        rho = float(residual[lag:] @ residual[:-lag]) / square
        if rho < limit:
            break
        total += rho
    return 1.0 + 2.0 * total


def stated(model: Model, values: Values, force: FloatArray, confidence: float) -> CurveFit:
    """Covariance, intervals, band and warnings of the values of least squares."""
    from scipy.stats import t as student  # noqa: PLC0415  # loaded only when a curve is fitted

    fitted, jacobian = model.linearised(values)
    freedom = force.size - len(values)
    variance, doubts = _variance(model, values, force, fitted, freedom)
    length = np.linalg.norm(jacobian, axis=0)
    length[length == 0.0] = 1.0
    unit = jacobian / length
    scaled = variance * np.linalg.pinv(unit.T @ unit, hermitian=True)
    covariance = scaled / np.outer(length, length)
    errors = dict(zip(values, np.sqrt(np.maximum(np.diag(covariance), 0.0)).tolist(), strict=True))
    quantile = float(student.ppf(0.5 + confidence / 2, freedom))
    numerical_error = model.numerical_error(values)
    warnings = (
        *_deep(model, values),
        *doubts,
        *_confounded(values, errors, covariance, quantile),
        *model.doubts(values),
    )
    values, errors = model.in_words(values, errors)
    return CurveFit(
        scene=model.scene,
        depth=model.depth,
        force=force,
        fitted=fitted,
        values=values,
        standard_error=errors,
        covariance=covariance,
        quantile=quantile,
        confidence=confidence,
        band=quantile * np.sqrt(np.maximum(np.einsum("ij,jk,ik->i", jacobian, covariance, jacobian), 0.0)),
        numerical_error=numerical_error,
        warnings=warnings,
    )


def _variance(
    model: Model, values: Values, force: FloatArray, fitted: FloatArray, freedom: int
) -> tuple[float, tuple[str, ...]]:
    """Variance of the residuals, widened by their correlation and by that of the points in contact, and warnings."""
    order = np.argsort(model.depth, kind="stable")
    residual = (force - fitted)[order]
    pressed = residual[model.depth[order] > values.get("contact_point", 0.0)]
    variance = float(residual @ residual) / freedom
    ratio, n = float(pressed @ pressed) / max(pressed.size, 1) / (variance or 1.0), max(pressed.size, 1)
    larger = ratio if ratio > 1 + _NOT_WHITE * np.sqrt(2 / n) and n >= 8 else 1.0
    factor = max(correlated(residual), correlated(pressed))
    doubts = []
    if np.sqrt(variance) > _ROUNDING * float(np.ptp(force)):
        if factor > 1.0:
            doubts.append(
                f"the residuals are not noise (neighbours are correlated): intervals are {np.sqrt(factor):.2g} times "
                "as wide; the scene does not describe the curve, or noise is filtered; see the residuals, or fit a "
                "shorter range (--until)"
            )
        if larger > 1.0:
            doubts.append(
                f"residuals in contact are {np.sqrt(larger):.2g} times the average: intervals are as much wider; see "
                "the residuals"
            )
    return variance * factor * larger, tuple(doubts)


def _deep(model: Model, values: Values) -> tuple[str, ...]:
    pressed = float(model.depth.max()) - values.get("contact_point", 0.0)
    note = depth_note(with_values(model.scene, values), pressed)
    return (note,) if note else ()


def _confounded(
    values: Values, errors: Mapping[str, float], covariance: FloatArray, quantile: float
) -> tuple[str, ...]:
    names = list(values)
    spread = np.sqrt(np.maximum(np.diag(covariance), np.finfo(float).tiny))
    correlation = covariance / np.outer(spread, spread)
    background = ("baseline", "tilt")
    doubts = [
        f"{names[i]} and {names[j]} can hardly be told apart on this curve (correlation {correlation[i, j]:.4f}); "
        "measure one of them by itself, or press deeper"
        for i in range(len(names))
        for j in range(i)
        if abs(correlation[i, j]) > _CONFOUNDED and not (names[i] in background and names[j] in background)
    ]
    doubts += [
        f"{name} is not determined by this curve: its interval is wider than itself"
        for name in names
        if (is_modulus(name) or name in ("thickness", "work_of_adhesion"))
        and quantile * errors[name] > abs(values[name])
    ]
    return tuple(doubts)
