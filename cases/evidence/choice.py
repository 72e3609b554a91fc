"""The cheapest measured settings that reach a requested accuracy, and the answer with what it achieved."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from cases.evidence.calibrate import largest_stated_error
from cases.evidence.kinds import band_of, kind_of
from cases.evidence.records import Evidence, Measurement, shipped
from cases.methods import build, method_names
from contact import InvalidInput, NotConvergedError, Scene, Solution

SAFETY: Final = 2.0  # the sample's worst scene is not the world's worst
MOST_REFUSED: Final = 0.2  # share of the sample that a setting may have refused by name


@dataclass(frozen=True, kw_only=True)
class Choice:
    """What to solve with, and why.

    Attributes:
        method: Name in the method table.
        settings: Of the method.
        expected_error: Worst relative error on the sample, times `SAFETY`.
        expected_seconds: Median processor time on the sample [s].
        evidence: The measurement behind it.
    """

    method: str
    settings: Mapping[str, bool | int | float | str]
    expected_error: float
    expected_seconds: float
    evidence: Measurement


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """An answer with what was expected and what was achieved.

    Attributes:
        choice: What it was solved with.
        answer: The solution.
        stated_error: Largest relative error that the answer states for itself, at most the accuracy asked for.
        seconds: Processor time it took [s], attempts that stated more included.
    """

    choice: Choice
    answer: Solution
    stated_error: float
    seconds: float


def choose(scene: Scene, accuracy: float, *, within: float | None = None, evidence: Evidence | None = None) -> Choice:
    """The fastest measured settings whose worst error times `SAFETY` is within the accuracy.

    Args:
        scene: What is to be solved.
        accuracy: Largest relative error wanted.
        within: Processor time that may be spent [s].
        evidence: Measurements; by default those shipped with the package.

    Raises:
        InvalidInput: If nothing measured reaches that; the message says what is reachable.
    """
    return choices(scene, accuracy, within=within, evidence=evidence)[0]


def choices(scene: Scene, accuracy: float, *, within: float | None, evidence: Evidence | None) -> list[Choice]:
    """All measured settings that reach it, fastest first; arguments and errors as in `choose`."""
    if not 0.0 < accuracy < 1.0:
        raise InvalidInput(f"accuracy = {accuracy:g}: must lie between 0 and 1; it is a relative error")
    if within is not None and not 0.0 < within < np.inf:
        raise InvalidInput(f"within = {within:g}: must be positive and finite; give seconds of processor time")
    like = list(usable(scene, (evidence or shipped()).measurements))
    good = sorted((m for m in like if SAFETY * m.bound <= accuracy), key=lambda m: m.seconds)
    if not good or (within is not None and good[0].seconds > within):
        raise InvalidInput(_reachable(scene, like, accuracy, within))
    return [
        Choice(
            method=m.method,
            settings=m.settings,
            expected_error=SAFETY * m.bound,
            expected_seconds=m.seconds,
            evidence=m,
        )
        for m in good
    ]


def solve(scene: Scene, *, accuracy: float, within: float | None = None, evidence: Evidence | None = None) -> Outcome:
    """Solve with the cheapest measured settings for an accuracy; where the answer states a larger error, with the next.

    Args:
        scene: What is to be solved.
        accuracy: Largest relative error wanted, of any quantity; the answer states no larger one.
        within: Processor time that may be spent [s], as far as it was measured on such scenes.
        evidence: Measurements; by default those shipped with the package.

    Raises:
        InvalidInput: If nothing measured reaches that; the message says what is reachable.
        NotConvergedError: If the answers of all measured settings, or of those there is time for, state larger errors.
        ContactError: As raised by the method.
    """
    seconds, best, why = 0.0, np.inf, ""
    for choice in choices(scene, accuracy, within=within, evidence=evidence):
        if within is not None and seconds + choice.expected_seconds > within:
            break
        start = time.process_time()
        answer, failure = _tried(choice, scene)
        seconds += time.process_time() - start
        stated = np.inf if answer is None else largest_stated_error(answer)
        if answer is not None and stated <= accuracy:
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


def usable(scene: Scene, measurements: Iterable[Measurement]) -> Iterable[Measurement]:
    """Measurements of scenes like this one, by methods that support it."""
    kind, band = kind_of(scene), band_of(scene)
    for m in measurements:
        like = m.kind == kind and m.band == band and m.refused <= MOST_REFUSED * m.scenes
        if like and build(m.method, m.settings).supports(scene):
            yield m


def _reachable(scene: Scene, usable: list[Measurement], accuracy: float, within: float | None) -> str:
    wanted = f"accuracy = {accuracy:g}" + ("" if within is None else f" within {within:g} s")
    if not usable:
        able = [name for name in method_names() if build(name, {}).supports(scene)]
        remedy = f"name a method that models it ({', '.join(able)})" if able else "no method here models it"
        return f"{wanted}: no measured method answers scenes like this one; {remedy}"
    finest = min(usable, key=lambda m: m.bound)
    fastest = min(usable, key=lambda m: m.seconds)
    return (
        f"{wanted} is beyond what was measured on such scenes; the finest reaches {SAFETY * finest.bound:.1e} in "
        f"{finest.seconds:.2g} s ({finest.method}), the fastest {SAFETY * fastest.bound:.1e} in {fastest.seconds:.2g} s"
    )
