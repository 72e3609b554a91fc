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
from dataclasses import dataclass, replace
from itertools import accumulate, combinations
from typing import Final, Literal, NamedTuple

import numpy as np
from scipy.optimize import least_squares, nnls

from contact import ForceHistory, InvalidInput, KelvinVoigt, NotConvergedError, Scene, StandardSolid
from contact.answer.small_strains import depth_note
from contact.records.validation import FloatArray
from contact.scene.effects import Relaxation, Viscoelasticity
from mdr.curves.contact_point import correlation_factor
from mdr.curves.force_curve import ForceCurve, longest_curve
from mdr.curves.result import CurveFit, with_intervals

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
# Evaluations of a search. Twenty are usual; a curve that needs more than this has a flat minimum.
_EVALUATIONS: Final = 80
# Name of the factor of a relaxation function whose shape is kept.
_SCALE: Final = "instantaneous_shear_modulus"
# Relative step of derivatives by the parameters. A hundredth of it is lost in that rounding.
_STEP: Final = 1e-5


def creep_of(solid: Relaxation) -> tuple[float, FloatArray, FloatArray]:
    """J(t) = J_inf - sum_j r_j exp(-t/lambda_j): J_inf [1/Pa], r_j [1/Pa] and lambda_j [s], each of shape (k,).

    With D(s) = G_inf + eta s + sum_j G_j s tau_j/(1 + s tau_j) its transform is 1/(s D), and D(-1/lambda_j) = 0. The
    zeros are eigenvalues of the equations of the strains in the dashpots. A dashpot eta allows no branches.
    """
    m, moduli, times = solid.moduli.size, solid.moduli, solid.times
    if solid.viscosity > 0.0:
        s = np.array([-solid.long_term_modulus / solid.viscosity])
    else:
        shares = np.broadcast_to(moduli / solid.instantaneous_modulus, (m, m))
        s = np.linalg.eigvals((shares - np.eye(m)) / times[:, None]).real
    slope = solid.viscosity + (moduli * times / (1 + s[:, None] * times) ** 2).sum(axis=1)
    return 1 / solid.long_term_modulus, -1 / (s * slope), -1 / s


def convolved(time: FloatArray, values: FloatArray, tau: float) -> FloatArray:
    """int_0^t exp(-(t - s)/tau) dv(s) for v linear between instants and zero before the first, shape (n,)."""
    x = np.diff(time) / tau
    gain = np.diff(values) * np.divide(-np.expm1(-x), x, out=np.ones_like(x), where=x > 0.0)
    steps = zip(np.exp(-x).tolist(), gain.tolist(), strict=True)
    return np.array(list(accumulate(steps, lambda q, step: q * step[0] + step[1], initial=float(values[0]))))


def force_of_depth(curve: ForceCurve, solid: Relaxation, time: FloatArray, depth: FloatArray) -> FloatArray:
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
    force = solid.long_term_modulus * phi
    for modulus, tau in zip(solid.moduli, solid.times, strict=True):
        force = force + modulus * convolved(fine, phi, tau)
    force = force + solid.viscosity * np.gradient(phi, fine)
    turn = _turn(depth)
    if turn < depth.size - 1:
        start = int(np.searchsorted(fine, time[turn])) + 1
        force[start:] = _withdrawn(solid, fine, d, phi, start)
    return 3 * np.maximum(force[::_STEPS], 0.0) if turn < depth.size - 1 else 3 * force[::_STEPS]


def _withdrawn(solid: Relaxation, time: FloatArray, d: FloatArray, phi: FloatArray, start: int) -> FloatArray:
    """F/3 [N] from the instant `start` on; bisection gives t1 of all instants together."""
    parts, depth_parts = ([convolved(time, values, tau) for tau in solid.times] for values in (phi, d))
    late, n = time[start:], start - 1

    def at(values: FloatArray, tau: float, part: FloatArray, t: FloatArray) -> FloatArray:
        """The convolution at instants between those of the table."""
        i = np.clip(np.searchsorted(time, t, side="right") - 1, 0, n - 1)
        x, slope = (t - time[i]) / tau, (values[i + 1] - values[i]) / (time[i + 1] - time[i])
        return part[i] * np.exp(-x) + slope * tau * -np.expm1(-x)

    def unloaded(t1: FloatArray) -> FloatArray:
        """int_t1^t G(t - s) d(d(s)), which falls with t1 while the contact grew."""
        total = solid.long_term_modulus * (d[start:] - np.interp(t1, time, d))
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
    total = solid.long_term_modulus * np.interp(t1, time, phi)
    for g, tau, part in zip(solid.moduli, solid.times, parts, strict=True):
        total = total + g * np.exp(-(late - t1) / tau) * at(phi, tau, part, t1)
    return np.where(np.minimum.accumulate(t1 > time[0]), total, 0.0)


def depth_of_force(curve: ForceCurve, solid: Relaxation, time: FloatArray, force: FloatArray) -> FloatArray:
    """Depth [m] at the instants, shape (n,), under forces [N] that do not fall."""
    final, shares, times = creep_of(solid)
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


class Parameter(NamedTuple):
    """A fitted number: `scale` times x, or exp(x) for a relaxation time.

    Attributes:
        name: Name of the field in the scene.
        scale: Unit of x, in SI units.
        low: Lower bound of x.
        high: Upper bound of x.
    """

    name: str
    scale: float
    low: float = -math.inf
    high: float = math.inf

    def value(self, x: float) -> float:
        """Value in SI units."""
        return math.exp(x) if self.is_time else self.scale * x

    @property
    def is_time(self) -> bool:
        """Whether the number is a relaxation time, so that x is its logarithm."""
        return self.name.startswith("relaxation_time")


@dataclass(frozen=True)
class _Problem:
    """Measured data and what is fitted: moduli and times first, in the order G_inf, G_j .., tau_j ..."""

    scene: Scene
    given: Relaxation
    curve: ForceCurve
    time: FloatArray
    depth: FloatArray
    force: FloatArray
    parameters: tuple[Parameter, ...]
    response: Literal["force", "depth"]

    @property
    def measured(self) -> FloatArray:
        return self.force if self.response == "force" else self.depth

    @property
    def names(self) -> list[str]:
        return [one.name for one in self.parameters]

    def values(self, x: FloatArray) -> dict[str, float]:
        """Each parameter in SI."""
        return {one.name: one.value(float(x_i)) for one, x_i in zip(self.parameters, x, strict=True)}

    def solid(self, values: dict[str, float]) -> Relaxation:
        """The relaxation function of the values."""
        given, found = self.given, np.array(list(values.values()))
        if _SCALE in values:
            share = found[0] / given.instantaneous_modulus
            return replace(given, long_term_modulus=share * given.long_term_modulus, moduli=share * given.moduli)
        if given.viscosity > 0.0:
            return replace(given, long_term_modulus=found[0], viscosity=found[1])
        m = given.moduli.size
        times = found[1 + m : 1 + 2 * m] if any(one.is_time for one in self.parameters) else given.times
        return replace(given, long_term_modulus=found[0], moduli=found[1 : 1 + m], times=times)

    def model(self, x: FloatArray) -> FloatArray:
        """Force [N] or depth [m] at the instants, shape (n,)."""
        values = self.values(x)
        solid, point, level = self.solid(values), values.get("contact_point", 0.0), values.get("baseline", 0.0)
        if self.response == "force":
            return force_of_depth(self.curve, solid, self.time, self.depth - point) + level
        return point + depth_of_force(self.curve, solid, self.time, self.force - level)


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
        parameters: "moduli", or "scale" for one factor of all of them (a normalised table G(t)/G_0 is kept), and any of
            "times", "contact_point", "baseline".
        confidence: Of the intervals.

    Raises:
        InvalidInput: For other scenes, and for histories that press again after a withdrawal.
        NotConvergedError: If the least squares do not converge.
    """
    t, d, f = (np.asarray(values, dtype=np.float64) for values in (time, depth, force))
    problem = _problem(scene, t, d, f, tuple(parameters))
    size = float(np.ptp(problem.measured))
    lower, upper = (np.array([getattr(one, end) for one in problem.parameters]) for end in ("low", "high"))

    def misfit(x: FloatArray) -> FloatArray:
        return np.asarray((problem.model(x) - problem.measured) / size)

    ends = []
    for start in _starts(problem):
        first, step = np.clip(start, lower + 1e-9, upper - 1e-9), np.full(start.size, _STEP)
        ends.append(
            least_squares(misfit, first, bounds=(lower, upper), x_scale="jac", diff_step=step, max_nfev=_EVALUATIONS)
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
            "alike; fit with 0.5 if --over poissons_ratio shows that it changes the elastic force little, or solve the "
            "history of a given material by finite elements (solve --method fem)"
        )
    if ("moduli" in names) == ("scale" in names) or set(names) - {*HISTORY_PARAMETERS, "scale"}:
        others = ", ".join(HISTORY_PARAMETERS[1:])
        raise InvalidInput(
            f"parameters = {', '.join(names)}: fit moduli (or scale, their common factor), with {others}"
        )
    if not (t.ndim == 1 and t.shape == d.shape == f.shape and t.size > 8 and np.isfinite([t, d, f]).all()):
        raise InvalidInput("a history needs one finite time, depth and force for each of more than 8 points")
    if not np.all(np.diff(t) > 0.0):
        row = int(np.argmin(np.diff(t))) + 1
        raise InvalidInput(f"time = {t[row]:g} s at point {row + 1} follows {t[row - 1]:g} s: times have to increase")
    response: Literal["force", "depth"] = "depth" if isinstance(scene.loading, ForceHistory) else "force"
    _check_course(d if response == "force" else f, response)
    reach = max(float(np.ptp(d)), float(d.max()))
    curve = longest_curve(scene, 2 * reach)
    modulus = float(np.ptp(f)) / (3 * float(curve.extended(np.array([reach]))[0]))
    fitted = [*_of_solid(effect, names, modulus, t)]
    fitted += [Parameter("contact_point", float(np.ptp(d)))] * ("contact_point" in names)
    fitted += [Parameter("baseline", float(np.ptp(f)))] * ("baseline" in names)
    return _Problem(scene, effect.relaxation, curve, t, d, f, tuple(fitted), response)


def _of_solid(effect: Viscoelasticity, names: Sequence[str], modulus: float, t: FloatArray) -> list[Parameter]:
    """Moduli and times of the effect, of the size of a modulus [Pa] and of the times [s] that were measured."""
    if "scale" in names:
        return [Parameter(_SCALE, modulus, _LEAST)]
    span = float(np.ptp(t))
    if isinstance(effect, KelvinVoigt):
        return [Parameter("shear_modulus", modulus, _LEAST), Parameter("viscosity", modulus * span, _LEAST)]
    alone, m = isinstance(effect, StandardSolid), effect.relaxation.moduli.size
    moduli = ["maxwell_shear_modulus"] if alone else [f"shear_moduli[{j}]" for j in range(m)]
    times = ["relaxation_time"] if alone else [f"relaxation_times[{j}]" for j in range(m)]
    ends = math.log(0.1 * float(np.diff(t).min())), math.log(100 * span)
    found = [Parameter(name, modulus, _LEAST) for name in ("long_term_shear_modulus", *moduli)]
    return found + [Parameter(name, 1.0, *ends) for name in times if "times" in names]


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
    names, given = problem.names, problem.given
    turn = _turn(problem.depth) + 1 if problem.response == "force" else problem.time.size
    time, depth, force = problem.time[:turn], problem.depth[:turn], problem.force[:turn]
    span, way = float(np.ptp(time)), float(np.ptp(depth))
    grid = np.geomspace(max(float(np.median(np.diff(time))), 1e-4 * span), span, _TRIAL_TIMES).tolist()
    fits_times = any(one.is_time for one in problem.parameters)
    sets = list(combinations(grid, given.times.size)) if fits_times else [tuple(given.times.tolist())]
    points = [depth.max() - way * share for share in _TRIAL_POINTS] if "contact_point" in names else [0.0]
    rated: list[tuple[float, int, list[float]]] = []
    for point in points:
        phi = 3 * problem.curve.extended(depth - point)
        level = [np.ones_like(phi), -np.ones_like(phi)] if "baseline" in names else []
        columns = {tau: convolved(time, phi, tau) for tau in {tau for times in sets for tau in times}}
        for times in sets:
            parts = [phi, *(columns[tau] for tau in times), *level]
            if _SCALE in names:
                shares = np.array([given.long_term_modulus, *given.moduli]) / given.instantaneous_modulus
                parts = [np.tensordot(shares, parts[: shares.size], 1), *level]
            sizes = np.array([float(np.abs(part).max()) or 1.0 for part in parts])
            found, misfit = nnls(np.stack(parts, axis=1) / sizes, force)
            found = found / sizes
            known = [*found[: len(parts) - len(level)], *([0.1 * found[0] * span] if given.viscosity else [])]
            known += [*times] * fits_times + [point] * ("contact_point" in names)
            known += [found[-2] - found[-1]] if level else []
            rated.append((float(misfit), len(rated), known))
    return [
        np.array(
            [math.log(v) if one.is_time else v / one.scale for one, v in zip(problem.parameters, known, strict=True)]
        )
        for *_, known in sorted(rated)[:_STARTS]
    ]


def _stated(problem: _Problem, x: FloatArray, jacobian: FloatArray, confidence: float) -> CurveFit:
    """Parameters in SI with their intervals, and warnings."""
    values, fitted = problem.values(x), problem.model(x)
    point = values.get("contact_point", 0.0)
    note = depth_note(problem.scene, float(problem.depth.max()) - point)
    return with_intervals(
        jacobian,
        problem.measured - fitted,
        problem.depth > point,
        np.diag([values[one.name] if one.is_time else one.scale for one in problem.parameters]),
        values=values,
        confidence=confidence,
        warnings=[note] if note else [],
        scene=problem.scene,
        depth=problem.depth,
        force=problem.force,
        fitted=fitted,
        numerical_error=problem.curve.error,
        time=problem.time,
        response=problem.response,
    )
