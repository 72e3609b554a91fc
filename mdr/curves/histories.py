"""Relaxation, creep, ramps and withdrawal: shear relaxation moduli from force and depth over time, with intervals.

On incompressible layers the springs of the method of dimensionality reduction relax alike. With phi = F/E of the
elastic contact and E = 3 G, while the contact grows (Lee and Radok 1960)

    F(t) = 3 int_0^t G(t - s) d(phi(d(s))),     phi(d(t)) = 1/3 int_0^t J(t - s) dF(s).

On withdrawal the contact is as large as at an earlier instant t1 (Ting 1966), where the spring at its edge is unloaded:

    F(t) = 3 int_0^t1 G(t - s) d(phi(d(s))),    int_t1^t G(t - s) d(d(s)) = 0.

G(t) = G_inf + sum_j G_j exp(-t/tau_j), and eta delta(t) of a dashpot. Depth and force are linear between points.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate, combinations
from typing import Final, Literal

import numpy as np
from scipy.optimize import least_squares, nnls

from contact import ForceHistory, InvalidInput, KelvinVoigt, NotConvergedError, Scene, StandardSolid
from contact.answer.small_strains import depth_note
from contact.records.validation import FloatArray
from contact.scene.effects import Viscoelasticity
from mdr.curves.contact_point import correlation_factor
from mdr.curves.force_curve import ForceCurve, longest_curve
from mdr.curves.result import CurveFit, confounded, spread_of

HISTORY_PARAMETERS: Final = ("moduli", "times", "contact_point", "baseline")
# Relaxation times that are tried, by equal factors over the time that was measured. With half as many pairs of times a
# factor of three apart end as one.
_TRIAL_TIMES: Final = 10
# Trial depths of indentation over the travel. With half as many the contact point of flat punches is missed.
_TRIAL_POINTS: Final = tuple(np.geomspace(0.3, 1.4, 14).tolist())
# First values that go on to least squares. With one some pairs of times end elsewhere; six improve none.
_STARTS: Final = 3
# Steps between neighbouring points in which phi is linear in time. Twice as many change the force by less than 1e-4.
_STEPS: Final = 4
# Share of the largest depth (force) by which it falls before this is a withdrawal. Half of it is noise of some curves.
_FALLS: Final = 0.05
# Least modulus over that of the data: a tenth changes no other parameter.
_LEAST: Final = 1e-9
# Halvings of the search for t1. With 30 the rounding of t1 shows in derivatives.
_HALVINGS: Final = 42
# Relative step of derivatives by the parameters. A hundredth of it is lost in that rounding.
_STEP: Final = 1e-5


@dataclass(frozen=True)
class Solid:
    """A relaxation function.

    Attributes:
        long_term: G_inf [Pa].
        moduli: G_j [Pa], shape (m,).
        times: tau_j [s], shape (m,).
        viscosity: eta [Pa s].
    """

    long_term: float
    moduli: FloatArray
    times: FloatArray
    viscosity: float = 0.0

    def creep(self) -> tuple[float, FloatArray, FloatArray]:
        """J(t) = J_inf - sum_j r_j exp(-t/lambda_j): J_inf [1/Pa], r_j [1/Pa] and lambda_j [s], each of shape (k,).

        With D(s) = G_inf + eta s + sum_j G_j s tau_j/(1 + s tau_j) its transform is 1/(s D), and D(-1/lambda_j) = 0.
        """
        unit = float(np.exp(np.mean(np.log(self.times)))) if self.times.size else self.viscosity / self.long_term
        factors = [np.polynomial.Polynomial([1.0, tau / unit]) for tau in self.times]
        product = math.prod(factors, start=np.polynomial.Polynomial([1.0]))
        zeros = np.polynomial.Polynomial([self.long_term, self.viscosity / unit]) * product
        for j, (modulus, tau) in enumerate(zip(self.moduli, self.times, strict=True)):
            others = math.prod(factors[:j] + factors[j + 1 :], start=np.polynomial.Polynomial([1.0]))
            zeros += np.polynomial.Polynomial([0.0, modulus * tau / unit]) * others
        s = np.real(zeros.roots()) / unit
        slope = self.viscosity + sum(
            modulus * tau / (1 + s * tau) ** 2 for modulus, tau in zip(self.moduli, self.times, strict=True)
        )
        return 1 / self.long_term, -1 / (s * slope), -1 / s


def convolved(time: FloatArray, values: FloatArray, tau: float) -> FloatArray:
    """int_0^t exp(-(t - s)/tau) dv(s) for v linear between instants and zero before the first, shape (n,)."""
    x = np.diff(time) / tau
    gain = np.diff(values) * np.divide(-np.expm1(-x), x, out=np.ones_like(x), where=x > 0.0)
    steps = zip(np.exp(-x).tolist(), gain.tolist(), strict=True)
    return np.array(list(accumulate(steps, lambda q, step: q * step[0] + step[1], initial=float(values[0]))))


def force_of_depth(curve: ForceCurve, solid: Solid, time: FloatArray, depth: FloatArray) -> FloatArray:
    """F [N] at the instants, shape (n,), of depths [m] that grow, rest, and fall once.

    Args:
        curve: phi of the layer.
        solid: G(t).
        time: [s], shape (n,), increasing.
        depth: [m], shape (n,).
    """
    fine = _refined(time)
    d = np.interp(fine, time, depth)
    phi = curve.extended(d)
    force = solid.long_term * phi
    for modulus, tau in zip(solid.moduli, solid.times, strict=True):
        force = force + modulus * convolved(fine, phi, tau)
    force = force + solid.viscosity * np.gradient(phi, fine)
    turn = _turn(depth)
    if turn < depth.size - 1:
        start = int(np.searchsorted(fine, time[turn])) + 1
        force[start:] = _withdrawn(solid, fine, d, phi, start)
    return 3 * np.maximum(force[::_STEPS], 0.0) if turn < depth.size - 1 else 3 * force[::_STEPS]


def _withdrawn(solid: Solid, time: FloatArray, d: FloatArray, phi: FloatArray, start: int) -> FloatArray:
    """F/3 [N] from the instant `start` on, with t1 by halving for all instants at once."""
    parts, depth_parts = ([convolved(time, values, tau) for tau in solid.times] for values in (phi, d))
    late, n = time[start:], start - 1

    def at(values: FloatArray, tau: float, part: FloatArray, t: FloatArray) -> FloatArray:
        """The convolution at instants between those of the table."""
        i = np.clip(np.searchsorted(time, t, side="right") - 1, 0, n - 1)
        x, slope = (t - time[i]) / tau, (values[i + 1] - values[i]) / (time[i + 1] - time[i])
        return part[i] * np.exp(-x) + slope * tau * -np.expm1(-x)

    def unloaded(t1: FloatArray) -> FloatArray:
        """int_t1^t G(t - s) d(d(s)), which falls with t1 while the contact grew."""
        total = solid.long_term * (d[start:] - np.interp(t1, time, d))
        total = total + solid.viscosity * np.gradient(d, time)[start:]
        for g, tau, part in zip(solid.moduli, solid.times, depth_parts, strict=True):
            total = total + g * (part[start:] - np.exp(-(late - t1) / tau) * at(d, tau, part, t1))
        return total

    low, high = np.full(late.size, float(time[0])), np.full(late.size, float(time[n]))
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        above = unloaded(middle) > 0.0
        low, high = np.where(above, middle, low), np.where(above, high, middle)
    t1 = (low + high) / 2
    total = solid.long_term * np.interp(t1, time, phi)
    for g, tau, part in zip(solid.moduli, solid.times, parts, strict=True):
        total = total + g * np.exp(-(late - t1) / tau) * at(phi, tau, part, t1)
    return np.where(np.minimum.accumulate(t1 > time[0]), total, 0.0)


def depth_of_force(curve: ForceCurve, solid: Solid, time: FloatArray, force: FloatArray) -> FloatArray:
    """Depth [m] at the instants, shape (n,), under forces [N] that do not fall."""
    final, shares, times = solid.creep()
    phi = final * force - sum(
        (r * convolved(time, force, tau) for r, tau in zip(shares, times, strict=True)), np.zeros_like(force)
    )
    return curve.depth_of(phi / 3)


def _refined(time: FloatArray) -> FloatArray:
    return np.interp(np.arange((time.size - 1) * _STEPS + 1) / _STEPS, np.arange(time.size), time)


def _turn(depth: FloatArray) -> int:
    """Index of the last point before the depth falls; the last point if it does not."""
    fallen = np.flatnonzero(depth < depth.max() - _FALLS * np.ptp(depth))
    after = fallen[fallen > int(np.argmax(depth))]
    if not after.size:
        return depth.size - 1
    high = np.flatnonzero(depth[: after[0]] >= depth.max() - 0.1 * _FALLS * np.ptp(depth))
    return int(high[-1])


@dataclass(frozen=True)
class _Problem:
    """A scene whose relaxation is fitted, in units of its own guess and of the measured data."""

    scene: Scene
    curve: ForceCurve
    time: FloatArray
    depth: FloatArray
    force: FloatArray
    names: tuple[str, ...]
    response: Literal["force", "depth"]
    branches: int
    unit: float

    @property
    def measured(self) -> FloatArray:
        return self.force if self.response == "force" else self.depth

    @property
    def has_dashpot(self) -> bool:
        return isinstance(self.scene.effect(Viscoelasticity), KelvinVoigt)

    def solid(self, x: FloatArray) -> Solid:
        """The relaxation function at [G_inf, G_j .., ln tau_j .., d0, f0] in units."""
        m, given = self.branches, relaxation_times(self.scene)
        if self.has_dashpot:
            return Solid(x[0] * self.unit, np.empty(0), np.empty(0), x[1] * self.unit * float(np.ptp(self.time)))
        times = np.exp(x[m + 1 : 2 * m + 1]) if "times" in self.names else given
        return Solid(x[0] * self.unit, x[1 : m + 1] * self.unit, times)

    def offsets(self, x: FloatArray) -> tuple[float, float]:
        """Contact point [m] and baseline [N]."""
        rest = x[self.fixed_size :].tolist()
        point = rest.pop(0) * float(np.ptp(self.depth)) if "contact_point" in self.names else 0.0
        return point, rest.pop(0) * float(np.ptp(self.force)) if "baseline" in self.names else 0.0

    @property
    def fixed_size(self) -> int:
        """Number of moduli and times."""
        return 2 if self.has_dashpot else 1 + self.branches * (2 if "times" in self.names else 1)

    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """Least and largest x: moduli are positive, times between a tenth of a step and 100 times the span."""
        size = self.fixed_size + sum(name in self.names for name in ("contact_point", "baseline"))
        lower, upper = np.full(size, -np.inf), np.full(size, np.inf)
        lower[: 2 if self.has_dashpot else 1 + self.branches] = _LEAST
        if "times" in self.names and not self.has_dashpot:
            times = slice(1 + self.branches, 1 + 2 * self.branches)
            lower[times] = math.log(0.1 * float(np.diff(self.time).min()))
            upper[times] = math.log(100 * float(np.ptp(self.time)))
        return lower, upper

    def model(self, x: FloatArray) -> FloatArray:
        """Force [N] or depth [m] at the instants, shape (n,)."""
        point, level = self.offsets(x)
        if self.response == "force":
            return force_of_depth(self.curve, self.solid(x), self.time, self.depth - point) + level
        return point + depth_of_force(self.curve, self.solid(x), self.time, self.force - level)


def relaxation_times(scene: Scene) -> FloatArray:
    """Relaxation times [s] of the scene, shape (m,)."""
    effect = scene.effect(Viscoelasticity)
    return np.asarray(effect.relaxation.times) if effect is not None else np.empty(0)


def fit_history(
    scene: Scene,
    time: Sequence[float] | FloatArray,
    depth: Sequence[float] | FloatArray,
    force: Sequence[float] | FloatArray,
    *,
    parameters: Sequence[str] = HISTORY_PARAMETERS,
    confidence: float = 0.95,
) -> CurveFit:
    """Fit the relaxation function of an incompressible layer to depth and force over time.

    Args:
        scene: Tip, layer, and one of KelvinVoigt, StandardSolid, PronySeries among the effects, with as many branches
            as are fitted. Its moduli are not used, and its times where they are not fitted. A loading by forces over
            time says that depths are the response, any other that forces are.
        time: [s], shape (n,), increasing.
        depth: [m], shape (n,): it grows, rests, and may fall once.
        force: [N], shape (n,), positive where the indenter presses.
        parameters: "moduli", and any of "times", "contact_point", "baseline".
        confidence: Of the intervals.

    Raises:
        InvalidInput: For other scenes, and for histories that press again after a withdrawal.
        NotConvergedError: If the least squares do not converge.
    """
    t, d, f = (np.asarray(values, dtype=np.float64) for values in (time, depth, force))
    problem = _problem(scene, t, d, f, tuple(parameters))
    size = float(np.ptp(problem.measured))

    def misfit(x: FloatArray) -> FloatArray:
        return np.asarray((problem.model(x) - problem.measured) / size)

    ends = []
    for start in _starts(problem):
        lower, upper = problem.bounds()
        ends.append(
            least_squares(
                misfit,
                np.clip(start, lower + 1e-9, upper - 1e-9),
                bounds=(lower, upper),
                x_scale="jac",
                diff_step=np.full(start.size, _STEP),
                max_nfev=80,
            )
        )
        if ends[-1].success and correlation_factor(ends[-1].fun) == 1.0:
            break
    best = min(ends, key=lambda end: float(end.cost))
    if not best.success:
        raise NotConvergedError("the fit did not converge; fit fewer branches, or keep the times (--fit moduli)")
    return _stated(problem, best.x, np.asarray(best.jac) * size, confidence)


def _problem(scene: Scene, t: FloatArray, d: FloatArray, f: FloatArray, names: tuple[str, ...]) -> _Problem:
    """The problem of a scene that can be fitted.

    Raises:
        InvalidInput: With the remedy.
    """
    effect = scene.effect(Viscoelasticity)
    if effect is None or len(scene.effects) > 1:
        raise InvalidInput(
            "effects: list one of KelvinVoigt, StandardSolid, PronySeries to fit a history, and no other"
        )
    nu = scene.layer.surface.poissons_ratio
    if nu != 0.5:
        raise InvalidInput(
            f"poissons_ratio = {nu:g}: histories are fitted for incompressible layers (0.5), where all springs relax "
            "alike; for others finite elements solve the history of a given material (solve --method fem)"
        )
    if "moduli" not in names or set(names) - set(HISTORY_PARAMETERS):
        raise InvalidInput(
            f"parameters = {', '.join(names)}: fit moduli, and any of {', '.join(HISTORY_PARAMETERS[1:])}"
        )
    if not (t.ndim == 1 and t.shape == d.shape == f.shape and t.size > 8 and np.isfinite([t, d, f]).all()):
        raise InvalidInput("a history needs one finite time, depth and force for each of more than 8 points")
    if not np.all(np.diff(t) > 0.0):
        row = int(np.argmin(np.diff(t))) + 1
        raise InvalidInput(f"time = {t[row]:g} s at point {row + 1} follows {t[row - 1]:g} s: times have to increase")
    response: Literal["force", "depth"] = "depth" if isinstance(scene.loading, ForceHistory) else "force"
    _check_course(d if response == "force" else f, response)
    curve = longest_curve(scene, 2.0 * max(float(np.ptp(d)), float(d.max())))
    phi = float(curve.extended(np.array([max(float(np.ptp(d)), float(d.max()))]))[0])
    return _Problem(scene, curve, t, d, f, names, response, relaxation_times(scene).size, float(np.ptp(f)) / (3 * phi))


def _check_course(given: FloatArray, response: str) -> None:
    turn, size = _turn(given), float(np.ptp(given))
    after = given[turn:]
    if response == "depth" and turn < given.size - 1:
        raise InvalidInput(
            f"the force falls from point {turn + 1} on: depths are fitted under forces that grow or rest; keep the "
            "points before, or fit forces (a loading by depth_history in the scene)"
        )
    if float((after - np.minimum.accumulate(after)).max()) > _FALLS * size:
        raise InvalidInput("the depth grows again after it has fallen: keep one loading, rest and withdrawal")


def _starts(problem: _Problem) -> list[FloatArray]:
    """First values: non-negative moduli by linear least squares, of sets of trial times and contact points the best."""
    m, names, given = problem.branches, problem.names, relaxation_times(problem.scene)
    turn = _turn(problem.depth) + 1 if problem.response == "force" else problem.time.size
    time, depth, force = problem.time[:turn], problem.depth[:turn], problem.force[:turn]
    span, way = float(np.ptp(time)), float(np.ptp(depth))
    grid = np.geomspace(max(float(np.median(np.diff(time))), 1e-4 * span), span, _TRIAL_TIMES).tolist()
    sets = list(combinations(grid, m)) if "times" in names and not problem.has_dashpot else [tuple(given.tolist())]
    points = [depth.max() - way * share for share in _TRIAL_POINTS] if "contact_point" in names else [0.0]
    rated: list[tuple[float, int, list[float]]] = []
    for point in points:
        phi = 3 * problem.unit * problem.curve.extended(depth - point)
        level = [np.ones_like(phi), -np.ones_like(phi)] if "baseline" in names else []
        columns = {tau: convolved(time, phi, tau) for tau in {tau for times in sets for tau in times}}
        for times in sets:
            matrix = np.stack([phi, *(columns[tau] for tau in times), *(one * np.ptp(force) for one in level)], axis=1)
            found, misfit = nnls(matrix, force)
            x = [*found[: m + 1], *(np.log(times) if "times" in names else ())]
            x = [found[0], 0.1] if problem.has_dashpot else x
            x += [point / float(np.ptp(problem.depth))] * ("contact_point" in names)
            x += [(found[-2] - found[-1]) * np.ptp(force) / np.ptp(problem.force)] if level else []
            rated.append((float(misfit), len(rated), x))
    return [np.array(x) for *_, x in sorted(rated)[:_STARTS]]


def _stated(problem: _Problem, x: FloatArray, jacobian: FloatArray, confidence: float) -> CurveFit:
    """Parameters in SI with their intervals, and warnings."""
    values, scale = _parameters(problem, x)
    fitted = problem.model(x)
    point, _ = problem.offsets(x)
    residual, pressed = problem.measured - fitted, problem.depth > point
    spread = spread_of(jacobian / scale, residual, pressed, float(np.ptp(problem.measured)), confidence)
    errors = dict(zip(values, np.sqrt(np.maximum(np.diag(spread.covariance), 0.0)).tolist(), strict=True))
    band = np.sqrt(np.maximum(np.sum((jacobian / scale @ spread.covariance) * (jacobian / scale), axis=1), 0.0))
    note = depth_note(problem.scene, float(problem.depth.max()) - point)
    warnings = (*([note] if note else []), *spread.warnings, *confounded(values, spread.covariance, spread.quantile))
    return CurveFit(
        scene=problem.scene,
        depth=problem.depth,
        force=problem.force,
        fitted=fitted,
        values=values,
        standard_error=errors,
        covariance=spread.covariance,
        quantile=spread.quantile,
        confidence=confidence,
        band=spread.quantile * band,
        numerical_error=problem.curve.error,
        warnings=warnings,
        time=problem.time,
        response=problem.response,
    )


def _parameters(problem: _Problem, x: FloatArray) -> tuple[dict[str, float], FloatArray]:
    """Parameters in SI by their names in the scene, and their derivatives by x."""
    solid, m = problem.solid(x), problem.branches
    point, level = problem.offsets(x)
    if problem.has_dashpot:
        found = [
            ("shear_modulus", solid.long_term, problem.unit),
            ("viscosity", solid.viscosity, solid.viscosity / x[1]),
        ]
    else:
        one = isinstance(problem.scene.effect(Viscoelasticity), StandardSolid)
        found = [("long_term_shear_modulus", solid.long_term, problem.unit)]
        found += [
            ("maxwell_shear_modulus" if one else f"shear_moduli[{j}]", float(solid.moduli[j]), problem.unit)
            for j in range(m)
        ]
        times = solid.times.tolist() if "times" in problem.names else []
        found += [("relaxation_time" if one else f"relaxation_times[{j}]", tau, tau) for j, tau in enumerate(times)]
    found += [("contact_point", point, float(np.ptp(problem.depth)))] * ("contact_point" in problem.names)
    found += [("baseline", level, float(np.ptp(problem.force)))] * ("baseline" in problem.names)
    return {name: value for name, value, _ in found}, np.array([scale for *_, scale in found])
