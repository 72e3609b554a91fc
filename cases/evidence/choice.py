"""The cheapest measured settings that reach a requested accuracy, and the answer with what it achieved."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Final

from cases.evidence.calibrate import largest_stated_error
from cases.evidence.kinds import band_of, kind_of
from cases.evidence.records import Evidence, Measurement, shipped
from cases.methods import build
from contact import InvalidInput, Scene, Solution

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
        stated_error: Largest relative error that the answer states for itself.
        seconds: Processor time it took [s].
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
    if not 0.0 < accuracy < 1.0:
        raise InvalidInput(f"accuracy = {accuracy:g}: must lie between 0 and 1; it is a relative error")
    like = list(usable(scene, (evidence or shipped()).measurements))
    good = [m for m in like if SAFETY * m.bound <= accuracy]
    best = min(good, key=lambda m: m.seconds, default=None)
    if best is None or (within is not None and best.seconds > within):
        raise InvalidInput(_reachable(like, accuracy, within))
    return Choice(
        method=best.method,
        settings=best.settings,
        expected_error=SAFETY * best.bound,
        expected_seconds=best.seconds,
        evidence=best,
    )


def solve_to_accuracy(
    scene: Scene, accuracy: float, *, within: float | None = None, evidence: Evidence | None = None
) -> Outcome:
    """Choose settings and solve; arguments and errors as in `choose`, errors of the method besides."""
    choice = choose(scene, accuracy, within=within, evidence=evidence)
    start = time.process_time()
    answer = build(choice.method, choice.settings).solve(scene)
    seconds = time.process_time() - start
    return Outcome(choice=choice, answer=answer, stated_error=largest_stated_error(answer), seconds=seconds)


def usable(scene: Scene, measurements: Iterable[Measurement]) -> Iterable[Measurement]:
    """Measurements of scenes like this one, by methods that support it."""
    kind, band = kind_of(scene), band_of(scene)
    for m in measurements:
        like = m.kind == kind and m.band == band and m.refused <= MOST_REFUSED * m.scenes
        if like and build(m.method, m.settings).supports(scene):
            yield m


def _reachable(usable: list[Measurement], accuracy: float, within: float | None) -> str:
    wanted = f"accuracy = {accuracy:g}" + ("" if within is None else f" within {within:g} s")
    if not usable:
        return f"{wanted}: nothing was measured on scenes like this one; solve without --accuracy or run calibrate"
    finest = min(usable, key=lambda m: m.bound)
    fastest = min(usable, key=lambda m: m.seconds)
    return (
        f"{wanted} is beyond what was measured on such scenes; the finest reaches {SAFETY * finest.bound:.1e} in "
        f"{finest.seconds:.2g} s ({finest.method}), the fastest {SAFETY * fastest.bound:.1e} in {fastest.seconds:.2g} s"
    )
