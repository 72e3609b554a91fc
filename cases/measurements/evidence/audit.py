"""Does a requested accuracy come out, and was there a faster way to it?  Random scenes, random accuracies."""

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import count as counting
from itertools import islice
from typing import Final

import numpy as np

from cases.declare.methods import build
from cases.measurements.campaigns.random_scenes import log_uniform, random_scene
from cases.measurements.driver import measured
from cases.measurements.evidence.calibrate import FAMILIES, judged_by_reference
from cases.measurements.evidence.choice import solve, usable
from cases.measurements.evidence.kinds import BANDS
from cases.measurements.evidence.records import Evidence, shipped
from cases.measurements.measurement import Measurement, covered, grouped
from cases.measurements.study import Say, silent, study_case, within_limit
from cases.results.records.claim import Claim
from cases.results.records.run import CaseResult
from cases.results.status import Status
from contact import InvalidInput, Scene, Solution

NAME: Final = "requested_accuracy"
LEAST_MET: Final = 0.98
# Most time over that of the fastest configuration that meets the accuracy, in the median.
MOST_TIME: Final = 2.0
ACCURACIES: Final = (1e-9, 1e-2)
_SMALLEST_RATIO: Final = 1e-2
_SLOW: Final = "creep"  # whose reference takes as long as a hundred others
# One scene in so many is of the slow family.
_FEW: Final = 30
# Configurations measured slower than this many times the answer are never the fastest.
_WORTH_TIMING: Final = 3.0
ON_REQUEST: Final = "as requested"

# Why a request has no answer, or one that nothing is fine enough to judge, by the error that said so.
REASONS: Final = {
    "CoarseReference": "not judged since the reference is too coarse",
    "InvalidInput": "beyond the evidence",
    "NotConvergedError": "whose answers state more",
    "TableTooShort": "whose answers state more",
}
# Most draws for each request that is answered.
_MOST_DRAWS: Final = 10

TEXT: Final = """
Random scenes of every kind are solved to a random accuracy with the methods and settings that stored measurements name,
one after the other until an answer states no larger error. The true error is the distance from an integral equation of
its own (elastic scenes) or from the fast method at its finest. Every configuration that might be faster is timed on the
same scene, each as a first solution; the time of the answer counts failed attempts.
"""


def audit_case(count: int = 300, seed: int = 2, evidence: Evidence | None = None, progress: Say = silent) -> CaseResult:
    """Solve so many scenes to random accuracies and claim that they are met, in about the shortest time."""
    rows: list[Measurement] = []
    met = 0
    for number, (scene, accuracy) in enumerate(islice(_requests(seed), _MOST_DRAWS * count)):
        if met == count:
            break
        of = Measurement(method=ON_REQUEST, scene=f"{number}", parameters={"accuracy": accuracy}, seed=seed)
        found = request_rows(scene, of, evidence or shipped())
        met += found[0].status is Status.PASS
        rows += found
    claims = accuracy_is_met(rows), time_is_short(rows)
    for claim in claims:
        progress(claim.message)
    return study_case(
        NAME,
        "Accuracy on request",
        "Is a requested accuracy reached, and in about the shortest time?",
        TEXT,
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


def request_rows(scene: Scene, of: Measurement, evidence: Evidence) -> list[Measurement]:
    """The answer on request, then every configuration that might be faster; what is stated is the accuracy wanted.

    Raises:
        RuntimeError: If a solution crashed.
    """
    accuracy = of.parameters["accuracy"]
    on_request = _timed(lambda: solve(scene, accuracy=accuracy, evidence=evidence).answer, of)
    seconds = on_request.seconds
    rivals = usable(scene, evidence.measurements) if on_request.status is Status.PASS else ()
    asked = (
        replace(of, method=rival.method, settings=rival.settings)
        for rival in rivals
        if rival.seconds <= _WORTH_TIMING * seconds
    )
    return [on_request, *(_timed(partial(build(a.method, a.settings).solve, scene), a) for a in asked)]


def _timed(solve: Callable[[], Solution], of: Measurement) -> Measurement:
    """The judged answer, or the row that says why there is none."""
    row = measured(solve, judged_by_reference, of=of, first=True)[-1]
    if row.status is Status.FAIL:
        raise RuntimeError(f"{of.method} {dict(of.settings)}: {row.reason}")
    return replace(row, stated=of.parameters["accuracy"])


def _requested(rows: Iterable[Measurement]) -> list[Measurement]:
    """The answers on request that could be judged.

    Raises:
        InvalidInput: If there are none.
    """
    found = [row for row in rows if row.method == ON_REQUEST and row.status is Status.PASS]
    if not found:
        raise InvalidInput("no request was answered; calibrate first")
    return found


def accuracy_is_met(rows: Sequence[Measurement]) -> Claim:
    """The claim that at most two requests in a hundred are missed."""
    found = _requested(rows)
    missed = 1.0 - covered(found)
    worst = max(row.bound / row.stated for row in found)
    message = (
        f"{100 * (1 - missed):.1f} % of {len(found)} requests met, largest error over accuracy {worst:.2g}; "
        f"{_listed(rows)}"
    )
    return _claim("accuracy is met", missed, 1 - LEAST_MET, message)


def _listed(rows: Iterable[Measurement]) -> str:
    """How many requests have no answer that counts, and why."""
    without = [row for row in rows if row.method == ON_REQUEST and row.status is not Status.PASS]
    refused = Counter(REASONS.get(row.reason.partition(":")[0], "not modelled") for row in without)
    reasons = ", ".join(f"{count} {reason}" for reason, count in sorted(refused.items()))
    return f"{len(without)} refused or not judged" + (f" ({reasons})" if reasons else "")


def time_is_short(rows: Sequence[Measurement]) -> Claim:
    """The claim that the median time is within twice the fastest configuration's that meets the accuracy."""
    scenes, found = grouped(rows, lambda row: row.scene), _requested(rows)
    ratio = float(np.median([row.seconds / _fastest(row, scenes[row.scene]) for row in found]))
    message = f"{ratio:.2f} times the fastest configuration that meets the accuracy, in the median"
    return _claim("time is short", ratio, MOST_TIME, message)


def _fastest(request: Measurement, rows: Sequence[Measurement]) -> float:
    return min([request.seconds, *(row.seconds for row in rows if row.status is Status.PASS and row.holds)])


def _claim(name: str, observed: float, limit: float, message: str) -> Claim:
    return within_limit(
        name,
        observed,
        limit,
        expected=None,
        scene="random scenes",
        methods=("mdr",),
        quantity="all quantities",
        source="an integral equation of its own, or the fast method at its finest",
        because="settings come from scenes of the same kind; where an answer states more, the next ones solve",
        derived_from="two requests in a hundred; twice the fastest time",
        message=message,
    )
