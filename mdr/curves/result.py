"""A fitted curve with intervals: covariance of least squares, widened where the residuals are not white noise."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final, Literal

import numpy as np
from scipy.special import stdtrit

from contact import Scene
from contact.records.validation import BoolArray, FloatArray
from mdr.curves.contact_point import NOT_WHITE, correlation_factor
from mdr.curves.families import is_modulus
from mdr.curves.formulas import Formula

# Correlation of two parameters with a warning: the interval of each is then 7 = 1/sqrt(1 - 0.99^2) times that with the
# other one known.
_CONFOUNDED: Final = 0.99
# Residuals over the range of forces without a warning: rounding of files. At 1e-3 some misfits are silent.
_ROUNDING: Final = 1e-4
# Factor on the interval of E by a quadratic background, above which a warning calls the baseline too short. At twice of
# it errors of several intervals have no warning; at half of it a baseline of half the travel has one.
_TOO_WIDE: Final = 3.0


@dataclass(frozen=True, kw_only=True)
class FormulaFit:
    """A fit of the same curve by a formula in use.

    Attributes:
        formula: The formula.
        youngs_modulus: E [Pa].
        bias: Relative difference of E from that of the scene's own curve.
    """

    formula: Formula
    youngs_modulus: float
    bias: float


@dataclass(frozen=True, kw_only=True)
class CurveFit:
    """A fitted curve.

    Attributes:
        scene: Scene as given; the fitted parameters are in `values`.
        depth: Measured depths [m], shape (n,).
        force: Measured forces [N], shape (n,).
        fitted: Force [N] of the fit at these depths, shape (n,), or depth [m] where depths over time were fitted.
        values: Value of each fitted parameter, in SI units.
        standard_error: Standard error of each parameter from the scatter of the curve, widened where the residuals are
            not white noise.
        covariance: Covariance of the parameters in the order of `values`, shape (p, p).
        quantile: Student's quantile, for intervals of `confidence`.
        confidence: Confidence of intervals and bands.
        band: Half width of the confidence band of the fitted curve, in the unit of `fitted`, shape (n,).
        numerical_error: Relative error of E by the computation itself, not included in `standard_error`.
        warnings: Sentences on doubtful results.
        notes: Sentences on the meaning of the fit.
        time: Instants [s], shape (n,), of histories; else empty.
        response: Name of the fitted quantity, "force" or "depth".
        input_error: Standard uncertainty of each parameter by uncertain inputs of the scene (`cases.uncertain_fit`).
        formulas: Fits of the same curve by formulas in use.
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
        """The fitted quantity as measured: force [N], or depth [m], shape (n,)."""
        return self.force if self.response == "force" else self.depth

    @property
    def indentation(self) -> FloatArray:
        """Depths [m] from the contact point, shape (n,)."""
        return self.depth - self.values.get("contact_point", 0.0)

    @property
    def background(self) -> FloatArray:
        """Baseline and tilt [N] at the depths, shape (n,)."""
        return self.values.get("baseline", 0.0) + self.values.get("tilt", 0.0) * self.indentation

    @property
    def r_squared(self) -> float:
        """1 - (variance of the residuals)/(variance of the data), of points in contact."""
        pressed = self.indentation > 0.0
        measured, residual = self.measured[pressed], (self.measured - self.fitted)[pressed]
        return 1.0 - float(residual @ residual) / max(float(np.sum((measured - measured.mean()) ** 2)), 1e-300)

    @property
    def modulus_at_depth(self) -> FloatArray:
        """Pointwise E [Pa]: the fitted E times measured over fitted force; nan outside the contact, shape (n,)."""
        contact = self.fitted - self.background
        if self.time.size:
            return np.full(self.depth.shape, np.nan)
        with np.errstate(divide="ignore", invalid="ignore"):
            moduli = self.youngs_modulus * (self.force - self.background) / contact
        return np.where(contact > 0.0, moduli, np.nan)

    def interval(self, parameter: str) -> tuple[float, float]:
        """Lower and upper end of the interval of a parameter, uncertain inputs and numerical error included."""
        half = self.quantile * float(np.hypot(self.standard_error[parameter], self.input_error.get(parameter, 0.0)))
        if is_modulus(parameter):
            half += self.numerical_error * self.values[parameter]
        return self.values[parameter] - half, self.values[parameter] + half


@dataclass(frozen=True, kw_only=True)
class MapFit:
    """Fits of n curves, each array of shape (n,).

    Attributes:
        curves: Fit of each curve; None where there is none, see `reasons`.
        reasons: Reason in words why a curve has no fit; empty where it has one.
        positions: Positions of the curves in the map [m], shape (n, 2), not a number where unknown.
    """

    curves: tuple[CurveFit | None, ...]
    reasons: tuple[str, ...]
    positions: FloatArray

    def of(self, quantity: Callable[[CurveFit], float]) -> FloatArray:
        """A quantity of each fit, nan for curves without a fit, shape (n,)."""
        return np.array([np.nan if fit is None else quantity(fit) for fit in self.curves])

    @property
    def youngs_modulus(self) -> FloatArray:
        """E [Pa]: the first fitted modulus."""
        return self.of(lambda fit: fit.youngs_modulus)

    @property
    def standard_error(self) -> FloatArray:
        """Standard error of E [Pa]."""
        return self.of(lambda fit: fit.standard_error[fit.modulus_name])

    @property
    def contact_point(self) -> FloatArray:
        """Contact point d0 [m], zero where it was not fitted."""
        return self.of(lambda fit: fit.values.get("contact_point", 0.0))

    @property
    def converged(self) -> BoolArray:
        """Whether a curve has a fit."""
        return np.array([fit is not None for fit in self.curves])

    @property
    def interval(self) -> FloatArray:
        """Lower and upper end [Pa] of the interval of each E, numerical error included, shape (2, n)."""
        low = self.of(lambda fit: fit.interval(fit.modulus_name)[0])
        return np.stack([low, self.of(lambda fit: fit.interval(fit.modulus_name)[1])])


def with_intervals(
    model: Callable[[FloatArray], FloatArray],
    parameters: Callable[[FloatArray], Mapping[str, float]],
    x: FloatArray,
    steps: FloatArray,
    pressed: BoolArray,
    *,
    confidence: float,
    curvature: Sequence[float] | float = 0.0,
    warnings: Sequence[str] = (),
    **fields: Any,
) -> CurveFit:
    """The fit with covariance, intervals and band, widened where residuals are correlated or larger in contact.

    Args:
        model: Returns the fitted curve at variables x, shape (n,).
        parameters: Returns the value of each parameter at variables x.
        x: Variables at the minimum of the squares, shape (p,).
        steps: Steps of central differences by x, shape (p,).
        pressed: Which points are in contact, shape (n,).
        confidence: Confidence of the intervals.
        curvature: Half the second derivative of each parameter by its variable, where the first one may vanish.
        warnings: Warnings on the fit.
        fields: Further fields of `CurveFit`.
    """
    values, fitted = parameters(x), model(x)
    shifted = [(x + shift, x - shift, 2 * step) for shift, step in zip(np.diag(steps), steps, strict=True)]
    jacobian = np.stack([(model(up) - model(down)) / width for up, down, width in shifted], axis=1)
    each = [(parameters(up), parameters(down), width) for up, down, width in shifted]
    changes = np.array([[(up[name] - down[name]) / width for up, down, width in each] for name in values])
    depth, measured = fields["depth"], fields[fields.get("response", "force")]
    order = np.arange(depth.size) if "time" in fields else np.argsort(depth, kind="stable")
    residual = (measured - fitted)[order]
    freedom = max(residual.size - x.size, 1)
    variance = float(residual @ residual) / freedom
    wider, lines = _widening(residual, pressed[order], variance)
    inverse = _inverse(jacobian)
    lines = [*_bent_background(jacobian, inverse, values, depth), *lines]
    raw = variance * wider * inverse
    covariance = changes @ raw @ changes.T
    quantile = float(stdtrit(freedom, 0.5 + confidence / 2))
    errors = np.hypot(np.sqrt(np.maximum(np.diag(covariance), 0.0)), np.multiply(curvature, np.diag(raw)))
    is_noisy = math.sqrt(variance) > _ROUNDING * float(np.ptp(measured))
    return CurveFit(
        values=values,
        fitted=fitted,
        standard_error=dict(zip(values, errors.tolist(), strict=True)),
        covariance=covariance,
        quantile=quantile,
        confidence=confidence,
        band=quantile * np.sqrt(np.maximum(np.sum((jacobian @ raw) * jacobian, axis=1), 0.0)),
        warnings=(*warnings, *lines * is_noisy, *_confounded(values, covariance, quantile)),
        **fields,
    )


def _inverse(jacobian: FloatArray) -> FloatArray:
    """(J^T J)^-1, shape (p, p), a pseudo-inverse: rows and columns of zero columns of J are zero."""
    length = np.linalg.norm(jacobian, axis=0)
    length[length == 0.0] = 1.0
    unit = jacobian / length
    return np.linalg.pinv(unit.T @ unit, hermitian=True) / np.outer(length, length)


def _widening(residual: FloatArray, pressed: BoolArray, variance: float) -> tuple[float, list[str]]:
    """Factor of the covariance, above 1 where the residuals are not white noise, and warnings on it."""
    correlated = max(correlation_factor(residual), correlation_factor(residual[pressed]))
    n, larger, warnings = max(int(pressed.sum()), 1), 1.0, []
    ratio = float(residual[pressed] @ residual[pressed]) / n / (variance or 1.0)
    if n >= 8 and ratio > 1 + NOT_WHITE * np.sqrt(2 / n):
        larger = ratio
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
    return correlated * larger, warnings


def _bent_background(
    jacobian: FloatArray, inverse: FloatArray, values: Mapping[str, float], depth: FloatArray
) -> list[str]:
    """Warning where the baseline is too short to distinguish a quadratic background from the contact."""
    if "tilt" not in values:
        return []
    row = next(i for i, name in enumerate(values) if is_modulus(name))
    square = ((depth - values.get("contact_point", 0.0)) / np.ptp(depth)) ** 2
    ratio = _inverse(np.column_stack([jacobian, square]))[row, row] / inverse[row, row]
    text = (
        "the baseline is too short to show whether the background is straight: with a quadratic background the "
        f"interval of the modulus would be {min(math.sqrt(ratio), 999):.2g} times as wide; measure more points before "
        "contact"
    )
    return [text] if ratio > _TOO_WIDE**2 else []


def _confounded(values: Mapping[str, float], covariance: FloatArray, quantile: float) -> tuple[str, ...]:
    """Warnings on strongly correlated pairs of parameters, and on parameters that the curve does not determine."""
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
