"""Measured settings in the order worth trying for a requested accuracy, and the first answer that achieves it."""

import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Final, Generic, overload

import numpy as np
from typing_extensions import TypeVar

from cases.declare.methods import build, method_names
from cases.measurements.evidence.calibrate import largest_stated_error
from cases.measurements.evidence.kinds import band_of, kind_of
from cases.measurements.evidence.records import Evidence, MeasuredSetting, shipped
from contact import (
    ContactPath,
    Detachment,
    DetachmentPath,
    EquilibriumLoading,
    HistoryLoading,
    HistoryPath,
    Impact,
    ImpactHistory,
    InvalidInput,
    NotConvergedError,
    Scene,
    Solution,
    refuse_other_layers,
)
from contact.answer.accuracy import shortfalls, told_where_less

AnswerT = TypeVar("AnswerT", bound=Solution, default=Solution)

# Safety factor, since a scene at hand is another than the sample's.
SAFETY: Final = 2.0


@dataclass(frozen=True, kw_only=True)
class Choice:
    """What to solve with, and why.

    Attributes:
        method: Name in the method table.
        settings: Of the method.
        expected_error: Median relative error on the sample, as stated or as found against a reference.
        expected_seconds: Median processor time on the sample [s].
        reached: In how many scenes of the sample that error, times `SAFETY`, is within the accuracy asked for.
        evidence: The measurement behind it.
    """

    method: str
    settings: Mapping[str, bool | int | float | str]
    expected_error: float
    expected_seconds: float
    reached: int
    evidence: MeasuredSetting


@dataclass(frozen=True, kw_only=True)
class Outcome(Generic[AnswerT]):
    """An answer with what was expected and what was achieved.

    Attributes:
        choice: What it was solved with.
        answer: The solution.
        stated_error: Largest relative error that the answer states of what an accuracy is asked of; at most that.
        seconds: Processor time it took [s], attempts that stated more included.
    """

    choice: Choice
    answer: AnswerT
    stated_error: float
    seconds: float


def choose(scene: Scene, accuracy: float, *, within: float | None = None, evidence: Evidence | None = None) -> Choice:
    """The measured settings to try first; arguments and errors as in `choices`."""
    return choices(scene, accuracy, within=within, evidence=evidence)[0]


def choices(
    scene: Scene, accuracy: float, *, within: float | None = None, evidence: Evidence | None = None
) -> list[Choice]:
    """Measured settings worth trying, in an order that takes little time on the average.

    Settings that take T seconds and reach the accuracy in a share p of the sample come in the order of T/p, as in any
    search that ends with the first success. After settings that failed, coarser ones of the same method fail too:
    they are left out. So are settings that reached the accuracy in no scene of the sample.

    Args:
        scene: What is to be solved.
        accuracy: Largest relative error wanted.
        within: Processor time that may be spent [s].
        evidence: Measurements; by default those shipped with the package.

    Raises:
        InvalidInput: If nothing measured reaches that; the message says what is reachable.
    """
    refuse_other_layers("the choice by accuracy", scene.layer)
    if not 0.0 < accuracy < 1.0:
        raise InvalidInput(f"accuracy = {accuracy:g}: must lie between 0 and 1; it is a relative error")
    if within is not None and not 0.0 < within < np.inf:
        raise InvalidInput(f"within = {within:g}: must be positive and finite; give seconds of processor time")
    like = list(usable(scene, (evidence or shipped()).measurements))
    able = [m for m in like if m.reached(accuracy / SAFETY) and (within is None or m.seconds <= within)]
    if not able:
        raise InvalidInput(_reachable(scene, like, accuracy, within))
    ordered = sorted(able, key=lambda m: m.seconds / m.share(accuracy / SAFETY))
    return [_choice(m, accuracy) for m in _ever_finer(ordered)]


def _choice(measurement: MeasuredSetting, accuracy: float) -> Choice:
    return Choice(
        method=measurement.method,
        settings=measurement.settings,
        expected_error=measurement.typical,
        expected_seconds=measurement.seconds,
        reached=measurement.reached(accuracy / SAFETY),
        evidence=measurement,
    )


def _ever_finer(measurements: Iterable[MeasuredSetting]) -> Iterable[MeasuredSetting]:
    """Without those that are no finer on their sample than an earlier one of the same method."""
    finest: dict[str, float] = {}
    for m in measurements:
        if m.typical < finest.get(m.method, np.inf):
            finest[m.method] = m.typical
            yield m


@overload
def solve(
    scene: Scene[EquilibriumLoading],
    *,
    accuracy: float,
    pressure_accuracy: float | None = None,
    within: float | None = None,
    evidence: Evidence | None = None,
) -> Outcome[ContactPath]: ...
@overload
def solve(
    scene: Scene[Detachment], *, accuracy: float, within: float | None = None, evidence: Evidence | None = None
) -> Outcome[DetachmentPath]: ...
@overload
def solve(
    scene: Scene[Impact], *, accuracy: float, within: float | None = None, evidence: Evidence | None = None
) -> Outcome[ImpactHistory]: ...
@overload
def solve(
    scene: Scene[HistoryLoading], *, accuracy: float, within: float | None = None, evidence: Evidence | None = None
) -> Outcome[HistoryPath]: ...
@overload
def solve(
    scene: Scene,
    *,
    accuracy: float,
    pressure_accuracy: float | None = None,
    within: float | None = None,
    evidence: Evidence | None = None,
) -> Outcome: ...
def solve(
    scene: Scene,
    *,
    accuracy: float,
    pressure_accuracy: float | None = None,
    within: float | None = None,
    evidence: Evidence | None = None,
) -> Outcome[Any]:
    """The first answer that states no larger error than wanted, settings tried in the order of `choices`.

    Args:
        scene: What is to be solved.
        accuracy: Largest relative error wanted of what an accuracy is asked of (`Solution.ASKED`): radius, depth, force
            and stiffness, or critical numbers, or restitution and peaks. What states more is told in the notes.
        pressure_accuracy: The same of the contact pressure; None if it does not matter.
        within: Processor time that may be spent [s], as far as it was measured on such scenes.
        evidence: Measurements; by default those shipped with the package.

    Raises:
        InvalidInput: If nothing measured reaches that; the message says what is reachable.
        NotConvergedError: If the answers of all these settings, or of those there is time for, state larger errors.
        ContactError: As raised by the method.
    """
    seconds, best, why = 0.0, np.inf, ""
    for choice in choices(scene, accuracy, within=within, evidence=evidence):
        if within is not None and seconds + choice.expected_seconds > within:
            continue
        start = time.process_time()
        answer, failure = _tried(choice, scene)
        seconds += time.process_time() - start
        stated = np.inf if answer is None else largest_stated_error(answer)
        if answer is not None and not shortfalls(answer, accuracy, pressure_accuracy):
            answer = told_where_less(answer, accuracy, pressure_accuracy)
            return Outcome(choice=choice, answer=answer, stated_error=stated, seconds=seconds)
        best, why = min(best, stated), failure or why
    found = f"answers to this scene state {best:.1e} at best" if best < np.inf else f"no answer ({why})"
    message = f"accuracy = {accuracy:g}: {found}, after {seconds:.2g} s; ask for less, or allow more time"
    raise NotConvergedError(message, {"stated_error": best})


def _tried(choice: Choice, scene: Scene) -> tuple[Solution | None, str]:
    """The answer, or why these settings have none; finer ones may."""
    try:
        return build(choice.method, choice.settings).solve(scene), ""
    except NotConvergedError as error:
        return None, str(error)


def usable(scene: Scene, measurements: Iterable[MeasuredSetting]) -> Iterable[MeasuredSetting]:
    """Measurements of scenes like this one, by methods that support it."""
    kind, band = kind_of(scene), band_of(scene)
    for m in measurements:
        if m.kind == kind and m.band == band and build(m.method, m.settings).supports(scene):
            yield m


def _reachable(scene: Scene, usable: list[MeasuredSetting], accuracy: float, within: float | None) -> str:
    wanted = f"accuracy = {accuracy:g}" + ("" if within is None else f" within {within:g} s")
    if not usable:
        able = [name for name in method_names() if build(name, {}).supports(scene)]
        remedy = f"name a method that models it ({', '.join(able)})" if able else "no method here models it"
        return f"{wanted}: no measured method answers scenes like this one; {remedy}"
    best = SAFETY * min(m.best for m in usable)
    surest, fastest = min(usable, key=lambda m: (m.refused, m.worst)), min(usable, key=lambda m: m.seconds)
    return (
        f"{wanted} is beyond what was measured on such scenes; reached was {best:.1e} in the best of them, "
        f"{_reached(surest)}, and {_reached(fastest)} the fastest way"
    )


def _reached(found: MeasuredSetting) -> str:
    answered = f"{len(found.bounds)} of {found.scenes}"
    return f"{SAFETY * found.worst:.1e} in {answered} ({found.method}, {found.seconds:.2g} s)"
