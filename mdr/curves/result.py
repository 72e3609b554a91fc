"""A fitted curve with intervals: covariance of least squares, widened where the residuals are not white noise."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, Final, Literal

import numpy as np
from scipy.special import stdtrit

from contact import Scene
from contact.records.validation import BoolArray, FloatArray
from mdr.curves.contact_point import NOT_WHITE, correlation_factor
from mdr.curves.families import is_modulus
from mdr.curves.formulas import Formula

# Correlation beyond which data hardly tell two parameters apart: the interval of each is then 7 times that with the
# other one known, 1/sqrt(1 - 0.99^2).
_CONFOUNDED: Final = 0.99
# Residuals below this share of the largest force have no warning: rounding of files. At 1e-3 some misfits are silent.
ROUNDING: Final = 1e-4


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
    """A fitted curve.

    Attributes:
        scene: As given; the fitted numbers are in `values`.
        depth: As measured [m], shape (n,).
        force: As measured [N], shape (n,).
        fitted: Force [N] of the fit at these depths, shape (n,), or depth [m] where depths over time were fitted.
        values: Each fitted parameter, SI.
        standard_error: Of each, from the scatter of the curve, widened where the residuals are not white noise.
        covariance: Of the parameters in the order of `values`, shape (p, p).
        quantile: Student's, for intervals of `confidence`.
        confidence: Of intervals and bands.
        band: Half width of the band in which the fitted curve lies with that confidence, shape (n,).
        numerical_error: Relative error of E by the computation itself; no part of `standard_error`.
        warnings: What a reader should know before relying on the numbers.
        notes: What the fit means, in words.
        per_modulus: F/E [m^2] at each point by the fit, shape (n,).
        time: [s], shape (n,), of histories; else empty.
        response: What was fitted, "force" or "depth".
        input_error: Standard uncertainty of each parameter by uncertain numbers of the scene, where they were asked
            for (`cases.uncertain_fit`).
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
    notes: tuple[str, ...] = ()
    per_modulus: FloatArray = field(default_factory=lambda: np.empty(0))
    time: FloatArray = field(default_factory=lambda: np.empty(0))
    response: Literal["force", "depth"] = "force"
    input_error: Mapping[str, float] = field(default_factory=dict)
    formulas: tuple[FormulaFit, ...] = field(default=())

    @property
    def youngs_modulus(self) -> float:
        """E [Pa]: the first fitted modulus."""
        return self.values[self.modulus_name]

    @property
    def modulus_name(self) -> str:
        """Name of the first fitted modulus."""
        return next(name for name in self.values if is_modulus(name) or "shear_mod" in name)

    @property
    def measured(self) -> FloatArray:
        """What was fitted: force [N], or depth [m], shape (n,)."""
        return self.force if self.response == "force" else self.depth

    @property
    def background(self) -> FloatArray:
        """Baseline and tilt [N] at the depths, shape (n,)."""
        shifted = self.depth - self.values.get("contact_point", 0.0)
        return self.values.get("baseline", 0.0) + self.values.get("tilt", 0.0) * shifted

    @property
    def r_squared(self) -> float:
        """1 less the variance of the residuals over that of the data in contact; 1 for a perfect fit."""
        pressed = self.depth > self.values.get("contact_point", 0.0)
        measured, residual = self.measured[pressed], (self.measured - self.fitted)[pressed]
        return 1.0 - float(residual @ residual) / max(float(np.sum((measured - measured.mean()) ** 2)), 1e-300)

    @property
    def modulus_at_depth(self) -> FloatArray:
        """E [Pa] from each point alone, (force less background)/phi; not a number outside contact, shape (n,)."""
        if not self.per_modulus.size or not is_modulus(self.modulus_name):
            return np.full(self.depth.shape, np.nan)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(self.per_modulus > 0.0, (self.force - self.background) / self.per_modulus, np.nan)

    def interval(self, parameter: str) -> tuple[float, float]:
        """In which the parameter lies with `confidence`; with uncertain inputs, and of E with the numerical error."""
        half = self.quantile * float(np.hypot(self.standard_error[parameter], self.input_error.get(parameter, 0.0)))
        if is_modulus(parameter):
            half += self.numerical_error * self.values[parameter]
        return self.values[parameter] - half, self.values[parameter] + half


def with_intervals(
    jacobian: FloatArray,
    residual: FloatArray,
    pressed: BoolArray,
    changes: FloatArray,
    *,
    values: Mapping[str, float],
    confidence: float,
    curvature: Mapping[str, float] | None = None,
    warnings: Iterable[str] = (),
    **fields: Any,
) -> CurveFit:
    """The fit with covariance, intervals and band, widened where residuals are correlated or larger in contact.

    Args:
        jacobian: Derivatives of the fitted curve by the numbers that least squares vary, shape (n, p).
        residual: Measured less fitted, in the order of depth or time, shape (n,).
        pressed: Which of them are in contact, shape (n,).
        changes: Derivatives of the parameters by the numbers that least squares vary, shape (p, p).
        values: Each parameter.
        confidence: Of the intervals.
        curvature: Half the second derivative of a parameter by its number, where the first one may vanish.
        warnings: On the fit.
        fields: Further ones of `CurveFit`.
    """
    freedom = max(residual.size - jacobian.shape[1], 1)
    variance = float(residual @ residual) / freedom
    size = float(np.ptp(fields["depth" if fields.get("response") == "depth" else "force"]))
    wider, lines = _widening(residual, pressed, variance, size)
    length = np.linalg.norm(jacobian, axis=0)
    length[length == 0.0] = 1.0
    unit = jacobian / length
    raw = variance * wider * np.linalg.pinv(unit.T @ unit, hermitian=True) / np.outer(length, length)
    covariance = changes @ raw @ changes.T
    quantile = float(stdtrit(freedom, 0.5 + confidence / 2))
    errors = dict(zip(values, np.sqrt(np.maximum(np.diag(covariance), 0.0)).tolist(), strict=True))
    for name, half in (curvature or {}).items():
        row = list(values).index(name)
        errors[name] = float(np.hypot(errors[name], half * raw[row, row]))
    return CurveFit(
        values=values,
        standard_error=errors,
        covariance=covariance,
        quantile=quantile,
        confidence=confidence,
        band=quantile * np.sqrt(np.maximum(np.sum((jacobian @ raw) * jacobian, axis=1), 0.0)),
        warnings=(*warnings, *lines, *_confounded(values, covariance, quantile)),
        **fields,
    )


def _widening(residual: FloatArray, pressed: BoolArray, variance: float, size: float) -> tuple[float, list[str]]:
    """Factor of the covariance, and warnings, where the residuals are not white noise."""
    correlated = max(correlation_factor(residual), correlation_factor(residual[pressed]))
    larger = _larger_in_contact(residual, pressed, variance)
    warnings = []
    if correlated > 1.0:
        warnings.append(
            f"the residuals are not noise (neighbours are correlated): intervals are {np.sqrt(correlated):.2g} times "
            "as wide; the scene does not describe the curve, or noise is filtered; see the residuals, or fit a shorter "
            "range (--until)"
        )
    if larger > 1.0:
        warnings.append(
            f"residuals in contact are {np.sqrt(larger):.2g} times the average: intervals are as much wider; see the "
            "residuals"
        )
    return correlated * larger, warnings if np.sqrt(variance) > ROUNDING * size else []


def _larger_in_contact(residual: FloatArray, pressed: BoolArray, variance: float) -> float:
    """Variance of the points in contact over the average, one within scatter."""
    n = int(pressed.sum())
    if n < 8 or variance == 0.0:
        return 1.0
    ratio = float(residual[pressed] @ residual[pressed]) / n / variance
    return ratio if ratio > 1 + NOT_WHITE * np.sqrt(2 / n) else 1.0


def _confounded(values: Mapping[str, float], covariance: FloatArray, quantile: float) -> tuple[str, ...]:
    """Warnings on pairs of parameters that the curve hardly tells apart, and on those that it does not determine."""
    names = list(values)
    error = np.sqrt(np.maximum(np.diag(covariance), np.finfo(float).tiny))
    correlation = covariance / np.outer(error, error)
    lines = ("baseline", "tilt")
    warnings = [
        f"{names[i]} and {names[j]} can hardly be told apart on this curve (correlation {correlation[i, j]:.4f}); "
        "measure one of them by itself, or press deeper"
        for i in range(len(names))
        for j in range(i)
        if abs(correlation[i, j]) > _CONFOUNDED and not (names[i] in lines and names[j] in lines)
    ]
    warnings += [
        f"{name} is not determined by this curve: its interval is wider than itself"
        for name, sigma in zip(names, error.tolist(), strict=True)
        if name not in ("contact_point", *lines) and quantile * sigma > abs(values[name])
    ]
    return tuple(warnings)
