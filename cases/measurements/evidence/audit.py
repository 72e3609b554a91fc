"""Does a requested accuracy come out, and was there a faster way to it?  Random scenes, random accuracies."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from itertools import count as counting
from itertools import islice
from typing import Final

import numpy as np

from cases.declare.methods import build
from cases.measurements.campaigns.random_scenes import log_uniform, random_scene
from cases.measurements.evidence.calibrate import FAMILIES, CoarseReference, error_bound, timed_first
from cases.measurements.evidence.choice import solve, usable
from cases.measurements.evidence.kinds import BANDS
from cases.measurements.evidence.records import Evidence, Measurement, shipped
from cases.results.records.claim import Claim, Kind, Origin, Verdict
from cases.results.records.run import CaseResult
from cases.results.status import Status
from contact import ContactError, InvalidInput, NotConvergedError, Scene

NAME: Final = "requested_accuracy"
LEAST_MET: Final = 0.98
MOST_TIME: Final = 2.0  # over the fastest configuration that meets the accuracy, in the median
ACCURACIES: Final = (1e-9, 1e-2)
_SMALLEST_RATIO: Final = 1e-2
_SLOW: Final = "creep"  # whose reference takes as long as a hundred others
_FEW: Final = 30  # one scene in so many is of the slow family
_WORTH_TIMING: Final = 3.0  # configurations measured slower than this many times the answer are never the fastest
_MOST_DRAWS: Final = 10  # for each request that is answered

TEXT: Final = """
Random scenes of every kind are solved to a random accuracy with the methods and settings that stored measurements name,
one after the other until an answer states no larger error. The true error is the distance from an integral equation of
its own (elastic scenes) or from the fast method at its finest. Every configuration that might be faster is timed on the
same scene, each as a first solution; the time of the answer counts failed attempts.
"""


@dataclass(frozen=True, kw_only=True)
class Request:
    """One scene solved to an accuracy.

    Attributes:
        accuracy: Asked for.
        achieved: Bound of the true error.
        seconds: Processor time of a first solution [s], attempts that stated more included.
        fastest: Processor time [s] of the fastest configuration that meets the accuracy, or the same if none is faster.
    """

    accuracy: float
    achieved: float
    seconds: float
    fastest: float

    @property
    def met(self) -> bool:
        """Whether the accuracy came out."""
        return self.achieved <= self.accuracy


def audit_case(
    count: int = 300, seed: int = 2, evidence: Evidence | None = None, progress: Callable[[str], None] = lambda _: None
) -> CaseResult:
    """Solve so many scenes to random accuracies and claim that they are met, in about the shortest time."""
    found: list[Request] = []
    refused: Counter[str] = Counter()
    for scene, accuracy in islice(_requests(seed), _MOST_DRAWS * count):
        if len(found) == count:
            break
        try:
            found.append(_request(scene, accuracy, evidence or shipped()))
        except (ContactError, CoarseReference) as error:
            refused[_reason(error)] += 1
    claims = accuracy_is_met(found, refused), time_is_short(found)
    for claim in claims:
        progress(claim.message)
    return CaseResult(
        name=NAME,
        title="Accuracy on request",
        question="Is a requested accuracy reached, and in about the shortest time?",
        equations=(),
        text=TEXT.strip(),
        scenes=(),
        runs=(),
        claims=claims,
    )


def _requests(seed: int) -> Iterator[tuple[Scene, float]]:
    """Scenes of the families in turn, each with an accuracy between the limits, every decade equally likely."""
    families = [family for family in dict.fromkeys(FAMILIES.values()) if family != _SLOW]
    for n in counting():
        draw = np.random.default_rng([seed, n])
        family = _SLOW if n % _FEW == _FEW - 1 else families[n % len(families)]
        yield (
            random_scene(draw, family, (_SMALLEST_RATIO, BANDS[-1])),
            log_uniform(draw, *ACCURACIES),
        )


def _reason(error: Exception) -> str:
    """Why a request has no answer, or one that nothing is fine enough to judge."""
    match error:
        case CoarseReference():
            return "not judged since the reference is too coarse"
        case InvalidInput():
            return "beyond the evidence"
        case NotConvergedError():
            return "whose answers state more"
        case _:
            return "not modelled"


def _request(scene: Scene, accuracy: float, evidence: Evidence) -> Request:
    outcome, seconds = timed_first(partial(solve, scene, accuracy=accuracy, evidence=evidence))
    achieved = error_bound(outcome.answer)
    rivals = [m for m in usable(scene, evidence.measurements) if m.seconds <= _WORTH_TIMING * seconds]
    fastest = min([seconds, *(_seconds_if_good(scene, accuracy, rival) for rival in rivals)])
    return Request(accuracy=accuracy, achieved=achieved, seconds=seconds, fastest=fastest)


def _seconds_if_good(scene: Scene, accuracy: float, rival: Measurement) -> float:
    try:
        answer, seconds = timed_first(partial(build(rival.method, rival.settings).solve, scene))
    except ContactError:
        return float("inf")
    return seconds if error_bound(answer) <= accuracy else float("inf")


def accuracy_is_met(requests: list[Request], refused: Mapping[str, int]) -> Claim:
    """The claim that at most two requests in a hundred are missed."""
    if not requests:
        raise InvalidInput("no request was answered; calibrate first")
    missed = sum(not request.met for request in requests) / len(requests)
    worst = max(request.achieved / request.accuracy for request in requests)
    message = (
        f"{100 * (1 - missed):.1f} % of {len(requests)} requests met, largest error over accuracy {worst:.2g}; "
        f"{_listed(refused)}"
    )
    return _claim("accuracy is met", missed, 1 - LEAST_MET, message)


def _listed(refused: Mapping[str, int]) -> str:
    """How many requests have no answer that counts, and why."""
    reasons = ", ".join(f"{count} {reason}" for reason, count in sorted(refused.items()))
    return f"{sum(refused.values())} refused or not judged" + (f" ({reasons})" if reasons else "")


def time_is_short(requests: list[Request]) -> Claim:
    """The claim that the median time is within twice the fastest configuration's."""
    ratio = float(np.median([request.seconds / request.fastest for request in requests]))
    message = f"{ratio:.2f} times the fastest configuration that meets the accuracy, in the median"
    return _claim("time is short", ratio, MOST_TIME, message)


def _claim(name: str, observed: float, limit: float, message: str) -> Claim:
    holds = observed <= limit
    return Claim(
        name=name,
        kind=Kind.INVARIANT,
        scene="random scenes",
        methods=("mdr",),
        quantity="all quantities",
        unit="1",
        status=Status.PASS if holds else Status.FAIL,
        verdict=Verdict.PASS if holds else Verdict.FAIL,
        observed=observed,
        expected=None,
        tolerance=limit,
        fraction=observed / limit,
        origin=Origin.INDEPENDENT_METHOD,
        source="an integral equation of its own, or the fast method at its finest",
        because="settings come from scenes of the same kind; where an answer states more, the next ones solve",
        derived_from="two requests in a hundred; twice the fastest time",
        message=message,
    )
