"""Random scenes by the thousand: every answer within its stated error of an independent one, or a named refusal.

The referee of elastic scenes is `referee` as far as it reaches; beyond a/h = 100, where it is costly, the method
with half the discretisation length checks every eighth scene. Depth histories of viscoelastic layers are followed
spring by spring. For other loadings the refined method checks every scene, or another method does. Every solved scene
is also solved in other units, where it must give the same answer, and with its relaxation written down in other ways.
"""

from __future__ import annotations

import re
import time
import warnings
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from cases.measurements.campaigns.random_scenes import RATIO, Family, random_scenes
from cases.measurements.campaigns.referee import LARGEST_RATIO, adhesive_states, second_opinion
from cases.measurements.campaigns.restated import changes_when_restated
from cases.measurements.campaigns.spring_by_spring import spring_by_spring
from cases.measurements.campaigns.units import Units, in_units
from contact import (
    ContactError,
    ContactPath,
    DepthHistory,
    DetachmentPath,
    HistoryPath,
    ImpactHistory,
    Method,
    NotConvergedError,
    Scene,
    Solution,
)
from contact.records.validation import FloatArray
from contact.scene.effects import Viscoelasticity

End: TypeAlias = Literal["within", "refused", "beyond", "crashed"]
Referee: TypeAlias = Literal[
    "second opinion", "spring by spring", "refinement", "another method", "other units", "none"
]

OTHER_UNITS = Units(length=2.0**17, stress=2.0**-23, time=2.0**11)
IMPACT_NUMBERS = ("coefficient_of_restitution", "contact_time", "peak_force", "peak_depth", "peak_contact_radius")
_MOTION = ("indentation_depth", "normal_force")
UNITS_AGREEMENT = 1e-12  # the same scene in other units: only roundings of pow and log differ

# How far a depth history may change, relative to its largest force, when its scene is written down in another way.
# Nothing iterates there, so only rounding changes: 8e-15 at most in 150 histories (seed 3, measured 2026-11-22).
RESTATED_AGREEMENT = 1e-12
_ROUNDING = 64 * float(np.finfo(float).eps)  # a few operations, also on what was prescribed
_THIN_LAYERS_REFINED = 8  # one in so many
_STATES_OF_A_BRANCH = 5
_ALL = slice(None)
_UNLISTED_MOST = 1e-2  # a quantity without a stated error still may not be this far off
# Sharpness is asked for where the relative true error is above this: below, roundings decide how large an error is.
HUNDRED_ROUNDINGS = 100 * float(np.finfo(float).eps)


@dataclass(frozen=True, kw_only=True)
class Check:
    """One quantity of one scene at its worst step, everything relative.

    Attributes:
        quantity: Its name.
        error: Distance from the referee.
        stated: Error that the method stated.
        allowance: The referee's own uncertainty.
        sharpness: Stated over true error at the step where the true error is largest; None where that is within the
            referee's uncertainty or a hundred roundings.
    """

    quantity: str
    error: float
    stated: float
    allowance: float
    sharpness: float | None = None

    @property
    def holds(self) -> bool:
        """Whether the stated error covers the distance."""
        return self.error <= self.stated + self.allowance


@dataclass(frozen=True, kw_only=True)
class Trial:
    """One scene and how it ended.

    Attributes:
        number: Its number; with family and seed it repeats the scene.
        family: Kind of scene.
        method: Who answered.
        end: "within" the stated error, "refused" by name, "beyond" the stated error, or "crashed".
        message: Of the refusal or the crash, or what is beyond.
        referee: Who checked.
        checks: One for each quantity.
        seconds: Processor time of the answer [s].
    """

    number: int
    family: Family | Literal["pressure"]
    method: str
    end: End
    message: str
    referee: Referee
    checks: tuple[Check, ...] = ()
    seconds: float


@dataclass(frozen=True, kw_only=True)
class CampaignResult:
    """A campaign.

    Attributes:
        seed: Of its scenes.
        trials: In order.
    """

    seed: int
    trials: tuple[Trial, ...]
    counts: Mapping[str, int] = field(init=False)

    def __post_init__(self) -> None:
        """Count the ends."""
        ends = [trial.end for trial in self.trials]
        object.__setattr__(self, "counts", {end: ends.count(end) for end in ("within", "refused", "beyond", "crashed")})

    @property
    def defects(self) -> tuple[Trial, ...]:
        """Trials that gave a wrong number without a word, or crashed."""
        return tuple(trial for trial in self.trials if trial.end in ("beyond", "crashed"))

    @property
    def refusals(self) -> dict[str, int]:
        """How often each reason was given, numbers left out."""
        reasons = [re.sub(r"[-+.\d]+(e[-+]?\d+)?", "..", t.message) for t in self.trials if t.end == "refused"]
        return dict(Counter(reasons).most_common())

    def coverage(self) -> dict[str, Coverage]:
        """By quantity, how well stated errors cover true ones."""
        checks: dict[str, list[Check]] = {}
        for trial in self.trials:
            for check in trial.checks:
                checks.setdefault(check.quantity, []).append(check)
        return {quantity: coverage(found) for quantity, found in checks.items()}


@dataclass(frozen=True, kw_only=True)
class Coverage:
    """How stated errors compare with true ones.

    Attributes:
        count: Checks made.
        covered: Share whose stated error covers the distance from the referee.
        decided: How many of them are above the referee's uncertainty and a hundred roundings.
        sharpness: Median of stated over true error among the decided ones; 1 would be perfect, None without any.
        ratios: Stated over true error of the decided ones.
    """

    count: int
    covered: float
    decided: int
    sharpness: float | None
    ratios: tuple[float, ...]


def coverage(checks: Sequence[Check]) -> Coverage:
    """Coverage and sharpness of stated errors; `checks` must not be empty."""
    ratios = tuple(c.sharpness for c in checks if c.sharpness is not None)
    return Coverage(
        count=len(checks),
        covered=sum(c.holds for c in checks) / len(checks),
        decided=len(ratios),
        sharpness=float(np.median(ratios)) if ratios else None,
        ratios=ratios,
    )


def campaign(
    method: Method,
    *,
    seed: int,
    count: int,
    family: Family = "elastic",
    ratio: tuple[float, float] = RATIO,
    numbers: Iterable[int] | None = None,
    referee: Method | None = None,
    other_units: bool = True,
) -> CampaignResult:
    """Draw scenes, let the method answer, and check each answer.

    Args:
        method: Who answers.
        seed: Of the scenes.
        count: How many scenes.
        family: Kind of scenes.
        ratio: Range of a/h.
        numbers: Only these of the scenes; all if None.
        referee: Another method that checks what the second opinion cannot; the refined method itself if None.
        other_units: Whether each scene is solved in other units as well.
    """
    scenes = random_scenes(seed, count, family, ratio)
    chosen = range(count) if numbers is None else numbers
    jury = Jury(referee=referee, other_units=other_units)
    return CampaignResult(seed=seed, trials=tuple(trial(method, scenes[n], n, family, jury) for n in chosen))


@dataclass(frozen=True, kw_only=True)
class Jury:
    """Who checks: another method beside the second opinion, and whether other units are tried."""

    referee: Method | None = None
    other_units: bool = True


def trial(method: Method, scene: Scene, number: int = 0, family: Family = "elastic", jury: Jury | None = None) -> Trial:
    """Let the method answer one scene and check the answer; a warning counts as a crash."""
    start, jury = time.process_time(), jury or Jury()
    referee: Referee = "none"
    checks: tuple[Check, ...] = ()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            answer = method.solve(scene)
            seconds = time.process_time() - start
            referee, checks = _refereed(method, answer, number, jury.referee)
            elsewhere = _restated(method, answer) if jury.other_units else ()
            wrong = [c for c in (*checks, *elsewhere) if not c.holds]
        end: End = "beyond" if wrong else "within"
        message = "; ".join(f"{c.quantity} is off by {c.error:.1e}, stated {c.stated:.1e}" for c in wrong)
    except ContactError as error:
        end, message, seconds = "refused", f"{type(error).__name__}: {error!s:.300}", time.process_time() - start
    except Exception as error:  # any other exception is what a campaign looks for
        end, message, seconds = "crashed", f"{type(error).__name__}: {error!s:.300}", time.process_time() - start
    return Trial(
        number=number,
        family=family,
        method=method.name,
        end=end,
        message=message,
        referee=referee,
        checks=checks,
        seconds=seconds,
    )


def _refereed(method: Method, answer: Solution, number: int, other: Method | None) -> tuple[Referee, tuple[Check, ...]]:
    """Checks by the best referee there is."""
    scene = answer.scene
    if isinstance(answer, ContactPath) and not scene.effects:
        reach = LARGEST_RATIO * scene.layer.thickness
        if answer.contact_radius.max() <= reach:
            opinion = second_opinion(answer)
            checks = (_check(answer, q, value, opinion.uncertainty) for q, value in opinion.values.items())
            return "second opinion", tuple(checks)
        if number % _THIN_LAYERS_REFINED:
            return "other units", ()
    if other is None and isinstance(answer, HistoryPath) and _is_followed_by_springs(scene):
        return "spring by spring", (_against_springs(answer),)
    on_branch = _branch_checks(answer) if isinstance(answer, DetachmentPath) else ()
    try:
        finer = (other or method.refined()).solve(scene)
    except NotConvergedError:
        return "none", on_branch
    elsewhere = other is not None and other.name != method.name
    return "another method" if elsewhere else "refinement", on_branch + tuple(
        _check(answer, q, _values(finer, q), np.atleast_1d(finer.error_estimate.get(q, 0.0)))
        for q in _comparable(answer, finer)
        if q in answer.error_estimate
    )


def _is_followed_by_springs(scene: Scene) -> bool:
    return isinstance(scene.loading, DepthHistory) and scene.effect(Viscoelasticity) is not None


def _against_springs(answer: HistoryPath) -> Check:
    """The force at its worst instant."""
    opinion = spring_by_spring(answer.scene, float(answer.contact_radius.max()))
    allowance = np.full(answer.normal_force.shape, opinion.uncertainty) / _scale(answer, "normal_force")
    return _check(answer, "normal_force", opinion.force, allowance)


def _branch_checks(answer: DetachmentPath) -> tuple[Check, ...]:
    """Some states of a branch, as far as the second opinion reaches, each at its own contact radius."""
    scene = answer.scene
    first = np.flatnonzero(answer.contact_radius == answer.contact_radius[0])[-1]  # before it a punch's front is held
    chosen = np.linspace(first, len(answer.contact_radius) - 1, _STATES_OF_A_BRANCH).round().astype(int)
    radii = answer.contact_radius[chosen]
    if np.max(radii) > LARGEST_RATIO * scene.layer.thickness or np.min(radii) <= 0:
        return ()
    opinion = adhesive_states(scene, radii)
    return tuple(
        _check(answer, quantity, value, opinion.uncertainty, chosen) for quantity, value in opinion.values.items()
    )


def _comparable(answer: Solution, other: Solution) -> tuple[str, ...]:
    """Quantities of two answers that stand for the same states; an impact's samples lie where its steps fall."""
    if isinstance(answer, ImpactHistory):
        return IMPACT_NUMBERS
    if isinstance(answer, DetachmentPath):  # states of two branches lie at different radii
        return tuple(answer.SCALARS)
    if isinstance(answer, HistoryPath):  # its contact radius jumps where contact is lost
        same = isinstance(other, HistoryPath) and np.array_equal(answer.time, other.time)
        return tuple(answer.error_estimate) if same else ()
    names = (*answer.ARRAYS, *answer.SCALARS)
    return tuple(q for q in names if np.shape(getattr(other, q)) == np.shape(getattr(answer, q)))


def _values(answer: Solution, quantity: str) -> FloatArray:
    return np.atleast_1d(np.asarray(getattr(answer, quantity), dtype=np.float64))


def _check(
    answer: Solution,
    quantity: str,
    expected: FloatArray,
    allowance: FloatArray,
    chosen: NDArray[np.intp] | slice = _ALL,
) -> Check:
    """The step, among those chosen, with the largest excess of distance over what is allowed."""
    scale = np.maximum(answer.scale(quantity), np.finfo(float).tiny)
    values = _values(answer, quantity)
    error = np.abs(values[chosen] - expected) / np.broadcast_to(scale, values.shape)[chosen]
    stated = _fitted(answer.error_estimate.get(quantity, np.array(_UNLISTED_MOST)), values.shape)[chosen]
    allowance = _fitted(np.maximum(allowance, _ROUNDING), error.shape)
    worst = int(np.argmax(error - stated - allowance))
    return Check(
        quantity=quantity,
        error=float(error[worst]),
        stated=float(stated[worst]),
        allowance=float(allowance[worst]),
        sharpness=_sharpness(error, stated, allowance),
    )


def _sharpness(error: FloatArray, stated: FloatArray, allowance: FloatArray) -> float | None:
    """Stated over true error at the step with the largest true error that can be told."""
    told = np.where(error > np.maximum(allowance, HUNDRED_ROUNDINGS), error, 0.0)
    largest = int(np.argmax(told))
    return float(stated[largest] / error[largest]) if told[largest] > 0.0 else None


def _fitted(values: FloatArray, shape: tuple[int, ...]) -> FloatArray:
    """One value for each entry; a scalar that has errors along a whole path gets the largest."""
    return np.array(values) if np.shape(values) == shape else np.full(shape, np.max(values))


def _restated(method: Method, answer: Solution) -> tuple[Check, ...]:
    """The same scene in other units and, where there is relaxation, with that written down in other ways."""
    elsewhere = _in_other_units(method, answer)
    if not isinstance(answer, HistoryPath | ImpactHistory) or answer.scene.effect(Viscoelasticity) is None:
        return elsewhere
    quantities = IMPACT_NUMBERS if isinstance(answer, ImpactHistory) else _MOTION
    exact = isinstance(answer.scene.loading, DepthHistory)
    found = changes_when_restated(method, answer, quantities)
    allowed = 0.0 if exact else 2.0 * max(_largest_stated(answer, quantity) for quantity in quantities)
    return elsewhere + tuple(
        Check(quantity=name, error=change, stated=RESTATED_AGREEMENT, allowance=allowed)
        for name, change in found.items()
    )


def _in_other_units(method: Method, answer: Solution) -> tuple[Check, ...]:
    """The same scene with lengths, stresses and times in other units.

    Roundings differ there, and each of the two answers may miss the true one by what it states: they may be twice as
    far apart. That either is near the truth is what the referee checks.
    """
    other = method.solve(in_units(answer.scene, OTHER_UNITS))
    return tuple(
        Check(
            quantity=f"{q} in other units",
            error=float(
                np.max(np.abs(_values(answer, q) - _values(other, q) / OTHER_UNITS.factor(q)) / _scale(answer, q))
            ),
            stated=UNITS_AGREEMENT,
            allowance=_largest_stated(answer, q) + _largest_stated(other, q),
        )
        for q in _comparable(answer, other)
    )


def _largest_stated(answer: Solution, quantity: str) -> float:
    """The error stated for the quantity or, where none is, the largest stated for any."""
    stated = answer.error_estimate.get(quantity)
    found = answer.error_estimate.values() if stated is None else [stated]
    return max((float(np.max(error)) for error in found), default=0.0)


def _scale(answer: Solution, quantity: str) -> FloatArray:
    return np.maximum(answer.scale(quantity), np.finfo(float).tiny)
