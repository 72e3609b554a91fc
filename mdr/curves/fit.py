"""Young's modulus from one force curve, with intervals, warnings, and what formulas in use would have said.

Model: F = E phi(d - d0) + f0, with phi the master curve of the scene. Least squares by scipy. The covariance is
s^2 (J^T J)^-1 with s from the residuals; intervals are Student's.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Final, Literal, TypeAlias

import numpy as np

from contact import Adhesion, IndentationDepths, InvalidInput, NotConvergedError, Scene
from contact.answer.small_strains import depth_note
from contact.records.validation import FloatArray
from mdr.curves.force_curve import ForceCurve
from mdr.curves.formulas import Formula, formulas_for
from mdr.curves.start import CurveShape, linear_start

Parameter: TypeAlias = Literal["youngs_modulus", "contact_point", "baseline", "thickness", "work_of_adhesion"]

UNIT_OF_PARAMETER: Final[Mapping[str, str]] = {
    "youngs_modulus": "Pa",
    "contact_point": "m",
    "baseline": "N",
    "thickness": "m",
    "work_of_adhesion": "J/m^2",
}
# A fitted thickness stays within this factor of the scene's: beyond it the scene is another one.
_THICKNESS_FACTOR: Final = 10.0
# Correlation beyond which data hardly tell two parameters apart: the interval of each is then 7 times that with the
# other one known, 1/sqrt(1 - 0.99^2).
_CONFOUNDED: Final = 0.99
# Relative step of differences by thickness and work of adhesion: the cube root of rounding and interpolation errors.
_STEP: Final = 1e-3


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
        standard_error: Of each, from the scatter of the curve.
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
        """E [Pa]."""
        return self.values["youngs_modulus"]

    def interval(self, parameter: str) -> tuple[float, float]:
        """In which the parameter lies with `confidence`; with uncertain inputs, and of E with the numerical error."""
        half = self.quantile * float(np.hypot(self.standard_error[parameter], self.input_error.get(parameter, 0.0)))
        if parameter == "youngs_modulus":
            half += self.numerical_error * self.youngs_modulus
        return self.values[parameter] - half, self.values[parameter] + half


def fit_curve(
    scene: Scene,
    depth: Sequence[float] | FloatArray,
    force: Sequence[float] | FloatArray,
    *,
    parameters: Sequence[Parameter] = ("youngs_modulus", "contact_point"),
    confidence: float = 0.95,
) -> CurveFit:
    """Fit Young's modulus, and what else is asked for, to one curve.

    Args:
        scene: Tip and layer; its modulus is not used, and its loading only says that depths are prescribed. With
            Adhesion among its effects the curve is that of withdrawal.
        depth: Measured depths [m], shape (n,); those before contact may be among them.
        force: Measured forces [N], shape (n,).
        parameters: "youngs_modulus" and any of "contact_point", "baseline", "thickness", "work_of_adhesion".
        confidence: Of the intervals.

    Raises:
        InvalidInput: For data that are no curve, or parameters that the scene does not have.
        NotConvergedError: If the least squares do not converge.
    """
    d, f = _checked(depth, force, parameters)
    if "work_of_adhesion" in parameters and scene.effect(Adhesion) is None:
        raise InvalidInput("work_of_adhesion: list Adhesion among the effects of the scene, with a first guess")
    # The contact point may be looked for half a curve before the first depth, and a step of differences beyond.
    deepest = float(np.ptp(d)) + max(float(d.max()), (0.5 + 2 * _STEP) * float(np.ptp(d)))
    model = _Model(_elastic(scene, deepest), scene, d, tuple(parameters))
    found = model.solved(f)
    bare = [name for name in parameters if name in ("youngs_modulus", "contact_point", "baseline")]
    fits = _by_formulas(scene, d, f, bare, found["youngs_modulus"]) if not scene.effects else ()
    return _stated(model, found, f, confidence, fits)


def _elastic(scene: Scene, deepest: float) -> Scene:
    return scene.replace(loading=IndentationDepths([deepest]), effects=(), beyond_small_strains=True)


def _checked(
    depth: Sequence[float] | FloatArray, force: Sequence[float] | FloatArray, parameters: Sequence[str]
) -> tuple[FloatArray, FloatArray]:
    d, f = (np.asarray(values, dtype=np.float64) for values in (depth, force))
    unknown = [name for name in parameters if name not in UNIT_OF_PARAMETER]
    if unknown or len(set(parameters)) < len(parameters) or "youngs_modulus" not in parameters:
        raise InvalidInput(
            f"parameters = {', '.join(parameters)}: fit youngs_modulus, and any of contact_point, baseline, thickness, "
            "work_of_adhesion, each once"
        )
    if d.ndim != 1 or d.shape != f.shape or d.size <= len(parameters):
        raise InvalidInput(
            f"a curve of {d.size} depths and {f.size} forces: give one force for each depth, and more points than the "
            f"{len(parameters)} parameters"
        )
    if not (np.isfinite(d).all() and np.isfinite(f).all() and d.max() > 0.0 and np.ptp(d) > 0.0):
        raise InvalidInput("a curve needs finite numbers, and depths that grow beyond 0; pressing is positive")
    return d, f


class _Model:
    """Forces of a curve and their derivatives by the parameters, in units that make all parameters about one."""

    def __init__(self, scene: Scene, whole: Scene, depth: FloatArray, parameters: tuple[str, ...]) -> None:
        self.scene, self.whole, self.depth, self.parameters = scene, whole, depth, parameters
        self.curve = ForceCurve(scene)
        adhesion = whole.effect(Adhesion)
        self.work = None if adhesion is None else adhesion.work_of_adhesion
        self.unit: dict[str, float] = {}

    def force(self, values: Mapping[str, float]) -> FloatArray:
        """F [N] at the depths of the data."""
        curve = self.curve
        if "thickness" in values:
            curve = curve.replaced(thickness=values["thickness"])
        shifted = self.depth - values.get("contact_point", 0.0)
        modulus = values["youngs_modulus"]
        if self.work is None:
            force = modulus * curve.per_modulus(shifted)
        else:
            from mdr.adhesion.force_curve import adhesive_curve  # noqa: PLC0415  # only where something adheres

            work = values.get("work_of_adhesion", self.work)
            force = adhesive_curve(curve.scene).force(shifted, modulus, work)
        return force + values.get("baseline", 0.0)

    def numerical_error(self, values: Mapping[str, float]) -> float:
        """Relative error of the force by the computation."""
        if self.work is None:
            return self.curve.error
        from mdr.adhesion.force_curve import adhesive_curve  # noqa: PLC0415  # as above

        shifted = self.depth - values.get("contact_point", 0.0)
        work = values.get("work_of_adhesion", self.work)
        return self.curve.error + adhesive_curve(self.curve.scene).error(shifted, values["youngs_modulus"], work)

    def jacobian(self, values: Mapping[str, float]) -> FloatArray:
        """dF by each parameter in its unit, shape (n, p)."""
        return np.stack([self._derivative(values, name) * self.unit[name] for name in self.parameters], axis=1)

    def _derivative(self, values: Mapping[str, float], name: str) -> FloatArray:
        if name == "baseline":
            return np.ones_like(self.depth)
        if name == "youngs_modulus" and self.work is None:
            return (self.force(values) - values.get("baseline", 0.0)) / values["youngs_modulus"]
        step = _STEP * self.unit[name]
        up, down = (self.force({**values, name: values[name] + sign * step}) for sign in (1.0, -1.0))
        return (up - down) / (2 * step)

    def solved(self, force: FloatArray) -> dict[str, float]:
        """The parameters of least squares."""
        from scipy.optimize import least_squares  # noqa: PLC0415  # loaded only when a curve is fitted

        start = self._start(force)
        lower = [self._bound(name, start[name], -1.0) for name in self.parameters]
        upper = [self._bound(name, start[name], 1.0) for name in self.parameters]
        scale = max(float(np.abs(force).max()), np.finfo(float).tiny)

        def values_of(x: FloatArray) -> dict[str, float]:
            return {name: float(v) * self.unit[name] for name, v in zip(self.parameters, x, strict=True)}

        def misfit(x: FloatArray) -> FloatArray:
            return (self.force(values_of(x)) - force) / scale

        def slopes(x: FloatArray) -> FloatArray:
            return self.jacobian(values_of(x)) / scale

        found = least_squares(
            misfit,
            [start[name] / self.unit[name] for name in self.parameters],
            jac=slopes,
            bounds=(lower, upper),
            xtol=1e-12,
            ftol=1e-12,
            gtol=1e-12,
        )
        if not found.success:
            raise NotConvergedError(f"the fit did not converge: {found.message}")
        return values_of(found.x)

    def _start(self, force: FloatArray) -> dict[str, float]:
        """Modulus and baseline by linear least squares at the best of many contact points; the rest as in the scene."""
        point, modulus, baseline = linear_start(
            self.curve,
            self.depth,
            force,
            contact_point="contact_point" in self.parameters,
            baseline="baseline" in self.parameters,
        )
        known = {
            "youngs_modulus": modulus,
            "contact_point": point,
            "baseline": baseline,
            "thickness": self.scene.layer.thickness,
            "work_of_adhesion": self.work or 0.0,
        }
        sizes = known | {"contact_point": float(np.ptp(self.depth)), "baseline": float(np.abs(force).max())}
        self.unit = {name: sizes[name] or 1.0 for name in self.parameters}
        return {name: known[name] for name in self.parameters}

    def _bound(self, name: str, start: float, sign: float) -> float:
        """Of a parameter in its unit."""
        if name == "thickness":
            return float(_THICKNESS_FACTOR**sign)
        if name == "contact_point":
            edge = self.depth.max() if sign > 0 else self.depth.min() - 0.5 * np.ptp(self.depth)
            return float(edge) / self.unit[name]
        if name == "baseline":
            return sign * np.inf
        return np.inf if sign > 0 else 1e-6


def _by_formulas(
    scene: Scene, depth: FloatArray, force: FloatArray, parameters: Sequence[str], modulus: float
) -> tuple[FormulaFit, ...]:
    return tuple(
        FormulaFit(formula=formula, youngs_modulus=other, bias=other / modulus - 1.0)
        for formula in formulas_for(scene)
        for other in [_modulus_by(formula, depth, force, parameters)]
    )


def _modulus_by(shape: CurveShape, depth: FloatArray, force: FloatArray, parameters: Sequence[str]) -> float:
    """E [Pa] by least squares, contact point and baseline fitted too where they are for the curve itself."""
    from scipy.optimize import minimize_scalar  # noqa: PLC0415  # loaded only when a curve is fitted

    has_point, has_baseline = "contact_point" in parameters, "baseline" in parameters
    start = partial(linear_start, shape, depth, force, baseline=has_baseline)
    if not has_point:
        return start(contact_point=False)[1]
    around, width = start(contact_point=True)[0], float(np.ptp(depth))

    def misfit(point: float) -> float:
        return float(start(contact_point=False, at=point, misfit=True)[0])

    best = minimize_scalar(
        misfit,
        bounds=(around - 0.05 * width, around + 0.05 * width),
        method="bounded",
        options={"xatol": 1e-9 * width},
    )
    return float(start(contact_point=False, at=float(best.x))[1])


def _stated(
    model: _Model, found: Mapping[str, float], force: FloatArray, confidence: float, fits: tuple[FormulaFit, ...]
) -> CurveFit:
    """Covariance, intervals, band and warnings."""
    from scipy.stats import t as student  # noqa: PLC0415  # as above

    fitted, jacobian = model.force(found), model.jacobian(found)
    freedom = force.size - len(found)
    variance = float(np.sum((fitted - force) ** 2)) / freedom
    covariance: FloatArray = np.asarray(
        variance * np.linalg.pinv(jacobian.T @ jacobian, hermitian=True), dtype=np.float64
    )
    units = np.array([model.unit[name] for name in found])
    errors = dict(zip(found, (np.sqrt(np.diag(covariance)) * units).tolist(), strict=True))
    quantile = float(student.ppf(0.5 + confidence / 2, freedom))
    return CurveFit(
        scene=model.whole,
        depth=model.depth,
        force=force,
        fitted=fitted,
        values=found,
        standard_error=errors,
        covariance=np.asarray(covariance * np.outer(units, units)),
        quantile=quantile,
        confidence=confidence,
        band=quantile * np.sqrt(np.maximum(np.einsum("ij,jk,ik->i", jacobian, covariance, jacobian), 0.0)),
        numerical_error=model.numerical_error(found),
        warnings=_warnings(model, found, errors, covariance, quantile),
        formulas=fits,
    )


def _warnings(
    model: _Model, found: Mapping[str, float], errors: Mapping[str, float], covariance: FloatArray, quantile: float
) -> tuple[str, ...]:
    names = list(found)
    spread = np.sqrt(np.maximum(np.diag(covariance), np.finfo(float).tiny))
    correlation = covariance / np.outer(spread, spread)
    told = [
        f"{names[i]} and {names[j]} can hardly be told apart on this curve (correlation {correlation[i, j]:.4f}); "
        "measure one of them by itself, or press deeper"
        for i in range(len(names))
        for j in range(i)
        if abs(correlation[i, j]) > _CONFOUNDED
    ]
    told += [
        f"{name} is not determined by this curve: its interval is wider than itself"
        for name in names
        if name in ("youngs_modulus", "thickness", "work_of_adhesion") and quantile * errors[name] > abs(found[name])
    ]
    pressed = float(model.depth.max()) - found.get("contact_point", 0.0)
    layer = model.scene.layer.replace(thickness=found["thickness"]) if "thickness" in found else model.scene.layer
    note = depth_note(model.scene.replace(layer=layer), pressed)
    return (*told, note) if note else tuple(told)
