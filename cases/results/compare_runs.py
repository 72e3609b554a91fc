"""Two runs side by side: two versions, two methods or two machines. Did anything move by more than its uncertainty?"""

import math
from dataclasses import dataclass
from enum import StrEnum

from cases.results.records.claim import Claim
from cases.results.records.run import RunResult
from cases.results.records.scene_run import Quantity, SceneRun
from cases.results.status import Status


class ChangeKind(StrEnum):
    """How two numbers differ, measured by the combined uncertainty of both."""

    IDENTICAL = "identical"  # every digit
    WITHIN = "within"
    BEYOND = "beyond"
    UNKNOWN = "unknown"
    INCOMPARABLE = "incomparable"  # unit or number of steps differ


@dataclass(frozen=True, kw_only=True)
class NumberChange:
    """A quantity of one scene in both runs, at the step where they differ most.

    `difference` is second minus first over the scale; `uncertainty` is the combined one, over the same scale.
    Both are None where nothing could be subtracted.
    """

    case: str
    scene: str
    quantity: str
    unit: str
    methods: tuple[str, str]
    change: ChangeKind
    values: tuple[float, float] | None
    uncertainties: tuple[float, float] | None
    difference: float | None
    uncertainty: float | None


@dataclass(frozen=True, kw_only=True)
class ClaimChange:
    """A claim that ended otherwise, or exists in one run only (then its status there is None)."""

    case: str
    claim: str
    scene: str
    methods: tuple[str, ...]
    statuses: tuple[Status | None, Status | None]
    fractions: tuple[float | None, float | None]
    message: str


@dataclass(frozen=True, kw_only=True)
class TimeChange:
    """Seconds of one solution in both runs."""

    case: str
    scene: str
    methods: tuple[str, str]
    seconds: tuple[float, float]

    @property
    def ratio(self) -> float:
        """Second over first."""
        return self.seconds[1] / self.seconds[0]


@dataclass(frozen=True, kw_only=True)
class RunComparison:
    """All that differs; `missing` names solutions that only one of the runs has."""

    numbers: tuple[NumberChange, ...]
    claims: tuple[ClaimChange, ...]
    times: tuple[TimeChange, ...]
    missing: tuple[str, ...]


def compare(first: RunResult, second: RunResult) -> RunComparison:
    """Compare two runs; where each has a single, different method for a scene, the two methods are compared."""
    pairs, missing = _pairs(first, second)
    return RunComparison(
        numbers=tuple(change for case, one, two in pairs for change in _numbers(case, one, two)),
        claims=tuple(_claims(first, second)),
        times=tuple(_times(pairs)),
        missing=tuple(missing),
    )


Pair = tuple[str, SceneRun, SceneRun]


def _pairs(first: RunResult, second: RunResult) -> tuple[list[Pair], list[str]]:
    """Solutions of equal case, scene and method; else of equal case and scene when each run has one method there."""
    solved = [_solved(run) for run in (first, second)]
    pairs: list[Pair] = []
    missing: list[str] = []
    for place in dict.fromkeys([*solved[0], *solved[1]]):
        one, two = (runs.get(place, {}) for runs in solved)
        if len(one) == len(two) == 1:
            pairs.append((place[0], next(iter(one.values())), next(iter(two.values()))))
            continue
        pairs += [(place[0], one[method], two[method]) for method in one if method in two]
        missing += [f"{' / '.join(place)} by {method}" for method in one.keys() ^ two.keys()]
    return pairs, sorted(missing)


def _solved(run: RunResult) -> dict[tuple[str, str], dict[str, SceneRun]]:
    found: dict[tuple[str, str], dict[str, SceneRun]] = {}
    for case in run.cases:
        for solution in case.runs:
            if solution.solved:
                found.setdefault((case.name, solution.scene), {})[solution.method] = solution
    return found


def _numbers(case: str, one: SceneRun, two: SceneRun) -> list[NumberChange]:
    theirs = {quantity.name: quantity for quantity in two.quantities}
    return [_number(case, one, two, q, theirs[q.name]) for q in one.quantities if q.name in theirs]


def _number(case: str, one: SceneRun, two: SceneRun, first: Quantity, second: Quantity) -> NumberChange:
    values = uncertainties = difference = uncertainty = None
    change = ChangeKind.INCOMPARABLE
    if first.unit == second.unit and len(first.values) == len(second.values) > 0:
        step = max(range(len(first.values)), key=lambda i: abs(second.values[i] - first.values[i]))
        scale = max(first.scale, second.scale)
        values = first.values[step], second.values[step]
        difference = (values[1] - values[0]) / scale
        if first.uncertainty and second.uncertainty:
            uncertainties = first.uncertainty[step], second.uncertainty[step]
            uncertainty = math.hypot(*uncertainties) / scale
        change = _change(difference, uncertainty)
    return NumberChange(
        case=case,
        scene=one.scene,
        quantity=first.name,
        unit=first.unit,
        methods=(one.method, two.method),
        change=change,
        values=values,
        uncertainties=uncertainties,
        difference=difference,
        uncertainty=uncertainty,
    )


def _change(difference: float, uncertainty: float | None) -> ChangeKind:
    if difference == 0.0:
        return ChangeKind.IDENTICAL
    if uncertainty is None:
        return ChangeKind.UNKNOWN
    return ChangeKind.WITHIN if abs(difference) <= uncertainty else ChangeKind.BEYOND


def _claims(first: RunResult, second: RunResult) -> list[ClaimChange]:
    before, after = _claims_by_place(first), _claims_by_place(second)
    changes = [_claim(place[0], before.get(place), after.get(place)) for place in after | before]
    return [change for change in changes if change.statuses[0] is not change.statuses[1]]


Place = tuple[str, str, str, tuple[str, ...]]


def _claims_by_place(run: RunResult) -> dict[Place, Claim]:
    """Claims by case, name, scene and methods."""
    return {(case.name, c.name, c.scene, c.methods): c for case in run.cases for c in case.claims}


def _claim(case: str, before: Claim | None, after: Claim | None) -> ClaimChange:
    (shown, *_) = [claim for claim in (after, before) if claim is not None]
    return ClaimChange(
        case=case,
        claim=shown.name,
        scene=shown.scene,
        methods=shown.methods,
        statuses=(before.status if before else None, after.status if after else None),
        fractions=(before.fraction if before else None, after.fraction if after else None),
        message=shown.message,
    )


def _times(pairs: list[Pair]) -> list[TimeChange]:
    timed = ((case, one, two, one.cost, two.cost) for case, one, two in pairs)
    return [
        TimeChange(
            case=case,
            scene=one.scene,
            methods=(one.method, two.method),
            seconds=(before.wall_seconds, after.wall_seconds),
        )
        for case, one, two, before, after in timed
        if before and after and before.wall_seconds > 0.0
    ]
