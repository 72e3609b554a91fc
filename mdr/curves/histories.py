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
from mdr.history.spring_law import SpringLaw

HISTORY_PARAMETERS: Final = ("moduli", "times", "contact_point", "baseline")
# Number of trial relaxation times, spaced by equal factors over the measured time. With half as many two times that
# differ by a factor of three are fitted as equal.
_TRIAL_TIMES: Final = 10
# Trial depths of indentation over the travel. With half as many the contact point of flat punches is missed.
_TRIAL_POINTS: Final = tuple(np.geomspace(0.3, 1.4, 14).tolist())
# First guesses from which least squares start. With one some pairs of times end at a wrong minimum; six improve none.
_STARTS: Final = 3
# Steps between neighbouring points in which phi is linear in time. Twice as many change the force by less than 1e-4.
_STEPS: Final = 4
# Decrease of depth (force) over its range that counts as a withdrawal. Half of it is within the noise of some curves.
_FALLS: Final = 0.05
# Lower bound of moduli over the modulus of the elastic fit: a tenth changes no other parameter.
_LEAST: Final = 1e-9
# Halvings of the search for t1. With 30 the rounding of t1 shows in derivatives.
_HALVINGS: Final = 42
# Name of the fitted factor of a relaxation function of given shape.
_SCALE: Final = "instantaneous_shear_modulus"
# Relative step of derivatives by the parameters. A hundredth of it amplifies the rounding of t1.
_STEP: Final = 1e-5


def convolved(time: FloatArray, values: FloatArray, tau: float) -> FloatArray:
    """int_0^t exp(-(t - s)/tau) dv(s) for v linear between instants and zero before the first, shape (n,)."""
    x = np.diff(time) / tau
    gain = np.diff(values) * np.divide(-np.expm1(-x), x, out=np.ones_like(x), where=x > 0.0)
    steps = zip(np.exp(-x).tolist(), gain.tolist(), strict=True)
    return np.array(list(accumulate(steps, lambda q, step: q * step[0] + step[1], initial=float(values[0]))))


def force_of_depth(curve: ForceCurve, solid: Relaxation, time: FloatArray, depth: FloatArray) -> FloatArray:
    """F [N] at the instants, shape (n,), for depths [m] that increase, are held, and decrease once.

    Args:
        curve: Elastic force curve phi of the layer.
        solid: Shear relaxation function G(t).
        time: Instants [s], shape (n,), increasing.
        depth: Depths [m], shape (n,).
    """
    fine, turn = _refined(time), _turn(depth)
    d = np.interp(fine, time, depth)
    phi = curve.extended(d)
    # G_inf is a branch that never relaxes.
    moduli, times = [solid.long_term_modulus, *solid.moduli.tolist()], [math.inf, *solid.times.tolist()]
    parts = [convolved(fine, phi, tau) for tau in times]
    force = np.dot(moduli, parts) + solid.viscosity * np.gradient(phi, fine)
    if turn == depth.size - 1:
        return np.asarray(3 * force[::_STEPS])
    start = int(np.searchsorted(fine, time[turn])) + 1
    late, early = fine[start:], fine[:start]
    depth_parts = [convolved(fine, d, tau) for tau in times]

    def after(t1: FloatArray, parts: list[FloatArray]) -> FloatArray:
        """Terms of int_0^t1 G(t - s) dv(s) at late instants t, shape (m + 1, n), from the convolutions of v."""
        values = np.array([np.interp(t1, early, part[:start]) for part in parts])
        return np.asarray(values * np.exp(-(late - t1) / np.array(times)[:, None]))

    # The stretch of the spring at the edge, int_t1^t G(t - s) d(d(s)), falls with t1 while the contact grew.
    stretch = np.dot(moduli, depth_parts)[start:] + solid.viscosity * np.gradient(d, fine)[start:]
    low, high = np.full(late.size, float(fine[0])), np.full(late.size, float(early[-1]))
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        is_stretched = stretch > np.dot(moduli, after(middle, depth_parts))
        low, high = np.where(is_stretched, middle, low), np.where(is_stretched, high, middle)
    t1 = (low + high) / 2
    force[start:] = np.where(np.minimum.accumulate(t1 > fine[0]), np.dot(moduli, after(t1, parts)), 0.0)
    return np.asarray(3 * np.maximum(force[::_STEPS], 0.0))


def depth_of_force(curve: ForceCurve, solid: Relaxation, time: FloatArray, force: FloatArray) -> FloatArray:
    """Depth [m] at the instants, shape (n,), under forces [N] that do not decrease.

    It is that of an elastic layer under F_e = F + sum_k r_k int_0^t exp(-lambda_k (t - s)) F(s) ds; with a dashpot in
    parallel F_e has no first term.
    """
    order = np.argsort(solid.times)
    modes = SpringLaw.of(replace(solid, moduli=solid.moduli[order], times=solid.times[order])).modes
    elastic_force = force * (solid.viscosity == 0.0)
    for rate, growth in zip(modes.rates.tolist(), modes.of_force.tolist(), strict=True):
        elastic_force = elastic_force + growth / rate * (force - convolved(time, force, 1 / rate))
    return curve.depth_of(elastic_force / (3 * solid.instantaneous_modulus))


def _refined(time: FloatArray) -> FloatArray:
    """Instants [s] with each interval divided into `_STEPS` equal ones."""
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
        scale: Unit of x in SI units, or None for a relaxation time.
        low: Lower bound of x.
        high: Upper bound of x.
    """

    name: str
    scale: float | None
    low: float = -math.inf
    high: float = math.inf


@dataclass(frozen=True)
class History:
    """Measured data and fitted parameters.

    Attributes:
        curve: Elastic force curve of the layer.
        time: Instants [s], shape (n,).
        depth: Depths [m], shape (n,).
        force: Forces [N], shape (n,).
        response: Name of the fitted quantity.
        parameters: Moduli first, then relaxation times, contact point and baseline.
        shares: Derivatives of G_inf, G_j and the viscosity by the fitted moduli, shape (m + 2, p).
        times: Relaxation times of the scene [s], shape (m,), where they are not fitted.
    """

    curve: ForceCurve
    time: FloatArray
    depth: FloatArray
    force: FloatArray
    response: Literal["force", "depth"]
    parameters: tuple[Parameter, ...]
    shares: FloatArray
    times: FloatArray

    def values(self, x: FloatArray) -> dict[str, float]:
        """Value of each parameter in SI units, by name, from the variables x of least squares."""
        pairs = zip(self.parameters, x.tolist(), strict=True)
        return {p.name: math.exp(number) if p.scale is None else p.scale * number for p, number in pairs}

    def model(self, x: FloatArray) -> FloatArray:
        """Force [N] or depth [m] at the instants, shape (n,)."""
        values, kinds = self.values(x), self.parameters
        long_term, *moduli, viscosity = self.shares @ list(values.values())[: self.shares.shape[1]]
        times = np.array([values[kind.name] for kind in kinds if kind.scale is None] or self.times)
        solid = Relaxation(
            long_term_modulus=long_term, moduli=np.array(moduli), times=times, viscosity=float(viscosity)
        )
        point, level = values.get("contact_point", 0.0), values.get("baseline", 0.0)
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
            as are fitted. Its moduli are not used, its times only where they are not fitted. With a loading by forces
            over time depths are the fitted response, with any other forces.
        time: Instants [s], shape (n,), increasing.
        depth: Depths [m], shape (n,): they increase, are held, and may decrease once.
        force: Forces [N], shape (n,), positive where the indenter presses.
        parameters: "moduli", or "scale" for one common factor of them (of a normalised table G(t)/G_0), and any of
            "times", "contact_point", "baseline".
        confidence: Confidence of the intervals.

    Raises:
        InvalidInput: For scenes that cannot be fitted, and for histories that load again after a withdrawal.
        NotConvergedError: If the least squares do not converge.
    """
    t, d, f = (np.asarray(values, dtype=np.float64) for values in (time, depth, force))
    history = _history(scene, t, d, f, tuple(parameters))
    measured = f if history.response == "force" else d
    size = float(np.ptp(measured))
    bounds = tuple(np.array([getattr(number, end) for number in history.parameters]) for end in ("low", "high"))

    def misfit(x: FloatArray) -> FloatArray:
        return np.asarray((history.model(x) - measured) / size)

    ends = []
    for start in _starts(history):
        first = np.clip(start, bounds[0] + 1e-9, bounds[1] - 1e-9)
        ends.append(least_squares(misfit, first, jac="3-point", bounds=(bounds[0], bounds[1]), x_scale="jac"))
        if ends[-1].success and correlation_factor(ends[-1].fun) == 1.0:
            break
    best = min(ends, key=lambda end: float(end.cost))
    if not best.success:
        raise NotConvergedError("the fit did not converge; fit fewer branches, or keep the times (--fit moduli)")
    indentation = d - history.values(best.x).get("contact_point", 0.0)
    note = depth_note(scene, float(indentation.max()))
    return with_intervals(
        history.model,
        history.values,
        best.x,
        # Moduli may be small and stay positive; the other variables may be zero, and change by about one.
        _STEP * np.where(bounds[0] == _LEAST, best.x, 1.0),
        indentation > 0.0,
        confidence=confidence,
        warnings=[note] if note else [],
        scene=scene,
        depth=d,
        force=f,
        numerical_error=history.curve.error,
        time=t,
        response=history.response,
    )


def _history(scene: Scene, t: FloatArray, d: FloatArray, f: FloatArray, names: tuple[str, ...]) -> History:
    """Measured data and parameters to be fitted.

    Raises:
        InvalidInput: If the scene cannot be fitted, with the remedy.
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
    by_force = isinstance(scene.loading, ForceHistory)
    _check_course(f if by_force else d, may_fall=not by_force)
    reach = max(float(np.ptp(d)), float(d.max()))
    curve = longest_curve(scene, 2 * reach)
    modulus = float(np.ptp(f)) / (3 * float(curve.extended(reach)))
    fitted, shares = _of_solid(effect, names, modulus, t)
    fitted += [Parameter("contact_point", float(np.ptp(d)))] * ("contact_point" in names)
    fitted += [Parameter("baseline", float(np.ptp(f)))] * ("baseline" in names)
    response: Literal["force", "depth"] = "depth" if by_force else "force"
    return History(curve, t, d, f, response, tuple(fitted), shares, effect.relaxation.times)


def _of_solid(
    effect: Viscoelasticity, names: Sequence[str], modulus: float, t: FloatArray
) -> tuple[list[Parameter], FloatArray]:
    """Fitted moduli and times, scaled by a modulus [Pa] and bounded by the instants t [s], and `History.shares`."""
    given, span = effect.relaxation, float(np.ptp(t))
    if "scale" in names:
        parts = np.array([given.long_term_modulus, *given.moduli, given.viscosity])
        return [Parameter(_SCALE, modulus, _LEAST)], parts[:, None] / given.instantaneous_modulus
    if isinstance(effect, KelvinVoigt):
        viscosity = Parameter("viscosity", modulus * span, _LEAST)
        return [Parameter("shear_modulus", modulus, _LEAST), viscosity], np.eye(2)
    moduli, times = ["maxwell_shear_modulus"], ["relaxation_time"]
    if not isinstance(effect, StandardSolid):
        numbers = range(given.moduli.size)
        moduli, times = [f"shear_moduli[{j}]" for j in numbers], [f"relaxation_times[{j}]" for j in numbers]
    ends = math.log(0.1 * float(np.diff(t).min())), math.log(100 * span)
    fitted = [Parameter(name, modulus, _LEAST) for name in ("long_term_shear_modulus", *moduli)]
    shares = np.eye(given.moduli.size + 2, len(fitted))
    return fitted + [Parameter(name, None, *ends) for name in times if "times" in names], shares


def _check_course(prescribed: FloatArray, *, may_fall: bool) -> None:
    """Refuse depths or forces that increase after a withdrawal, and withdrawals unless `may_fall`."""
    turn = _turn(prescribed)
    if turn < prescribed.size - 1 and not may_fall:
        raise InvalidInput(
            f"the force falls from point {turn + 1} on: depths are fitted under forces that grow or rest; keep the "
            "points before, or fit forces (a loading by depth_history in the scene)"
        )
    after = prescribed[turn:]
    if float((after - np.minimum.accumulate(after)).max()) > _FALLS * float(np.ptp(prescribed)):
        raise InvalidInput("the depth grows again after it has fallen: keep one loading, rest and withdrawal")


def _starts(history: History) -> list[FloatArray]:
    """First guesses of x: non-negative moduli by linear least squares, for the best trial times and contact points."""
    names, scales = zip(*((number.name, number.scale) for number in history.parameters), strict=True)
    turn = _turn(history.depth) + 1 if history.response == "force" else history.time.size
    time, depth, force = history.time[:turn], history.depth[:turn], history.force[:turn]
    span, has_free_times = float(np.ptp(time)), None in scales
    shortest = max(float(np.median(np.diff(time))), 1e-4 * span)
    trial_times = [tuple(history.times.tolist())]
    if has_free_times:
        trial_times = list(combinations(np.geomspace(shortest, span, _TRIAL_TIMES).tolist(), history.times.size))
    points = depth.max() - float(np.ptp(depth)) * np.array(_TRIAL_POINTS) if "contact_point" in names else [0.0]
    starts: list[tuple[float, int, list[float]]] = []
    for point in points:
        phi = 3 * history.curve.extended(depth - point)
        levels = [np.ones_like(phi), -np.ones_like(phi)] if "baseline" in names else []
        relaxed = {tau: convolved(time, phi, tau) for tau in {tau for times in trial_times for tau in times}}
        rate = np.gradient(phi, time)
        for times in trial_times:
            parts = history.shares.T @ [phi, *(relaxed[tau] for tau in times), rate]
            columns = np.stack([*parts, *levels], axis=1)
            sizes = np.abs(columns).max(axis=0, initial=1e-300)
            factors, misfit = nnls(columns / sizes, force)
            moduli, level = np.split(factors / sizes, [len(parts)])
            start = [*moduli, *np.log(times if has_free_times else ()), *[point] * ("contact_point" in names)]
            starts.append((float(misfit), len(starts), [*start, *(level[:1] - level[1:])]))
    return [np.array(start) / [scale or 1.0 for scale in scales] for *_, start in sorted(starts)[:_STARTS]]
