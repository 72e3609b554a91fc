"""A run against what is accepted: every number, every counter; what is missing or extra fails by name."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from cases.baselines.history import read_history
from cases.baselines.records import (
    AcceptedCounters,
    AcceptedQuantity,
    Baseline,
    accepted_methods,
    counters_of,
    read_baseline,
    specification,
)
from cases.results import CaseResult, Claim, Kind, Origin, Quantity, RunResult, SceneRun
from cases.rules.judgement import Judgement, nothing_compared, worst_judgement
from cases.rules.regression import judge_counter, judge_regression
from cases.status import Status


def gated(run: RunResult, directory: Path) -> RunResult:
    """Return ``run`` with its regression claims and the history of accepted changes."""
    cases = tuple(replace(case, claims=(*case.claims, *gate_case(case, directory))) for case in run.cases)
    return replace(run, cases=cases, acceptances=read_history(directory))


def gate_case(case: CaseResult, directory: Path) -> tuple[Claim, ...]:
    """Return the regression claims of one case, for every method that ran or has a baseline."""
    ran = {run.method for run in case.runs if run.status is not Status.SKIP}
    methods = sorted(ran | accepted_methods(directory, case.name))
    return tuple(claim for method in methods for claim in _gate_method(case, method, directory))


def _gate_method(case: CaseResult, method: str, directory: Path) -> Iterator[Claim]:
    baseline = read_baseline(directory, case.name, method) or Baseline(case=case.name, method=method)
    scenes = {scene.name: scene for scene in case.scenes}
    runs = {run.scene: run for run in case.runs if run.method == method and run.status is not Status.SKIP}
    accepted = {(record.scene, record.quantity): record for record in baseline.quantities}
    counted = {record.scene: record for record in baseline.counters}
    for name, run in runs.items():
        asked = specification(scenes[name], run)
        for quantity in run.quantities:
            yield _quantity_claim(run, quantity, accepted.pop((name, quantity.name), None), asked)
        yield from _counter_claims(run, counted.get(name), asked)
    for (name, quantity_name), record in accepted.items():
        yield _missing_claim(method, name, quantity_name, record, runs.get(name))


def _quantity_claim(run: SceneRun, quantity: Quantity, record: AcceptedQuantity | None, asked: str) -> Claim:
    if record is None:
        extra = nothing_compared(Status.INCOMPARABLE, f"extra: nothing is accepted for {quantity.name}; accept it")
        return _claim(run.method, run.scene, quantity.name, quantity.unit, extra, tolerance=1e-12)
    refused = _incomparable(quantity, record, asked)
    judged = refused or worst_judgement(
        [
            judge_regression(value, accepted, scale=record.scale, rtol=record.rtol, atol=record.atol)
            for value, accepted in zip(quantity.values, record.values, strict=True)
        ]
    )
    expected = record.values[0] if len(record.values) == 1 else None
    return _claim(
        run.method,
        run.scene,
        quantity.name,
        quantity.unit,
        judged,
        tolerance=record.rtol * max(*(abs(v) for v in record.values), record.scale),
        expected=expected,
        because=record.reason,
    )


def _incomparable(quantity: Quantity, record: AcceptedQuantity, asked: str) -> Judgement | None:
    differ = [
        ("unit", quantity.unit, record.unit),
        ("number of steps", len(quantity.values), len(record.values)),
        ("specification", asked, record.specification),
    ]
    for what, now, then in differ:
        if now != then:
            message = f"{what} is {now}, accepted was {then}: not the same problem; accept it anew"
            return nothing_compared(Status.INCOMPARABLE, message)
    return None


def _counter_claims(run: SceneRun, record: AcceptedCounters | None, asked: str) -> Iterator[Claim]:
    if record is None or record.specification != asked:
        return  # the quantities of this scene already fail as extra or as another problem
    now = counters_of(run)
    for name in sorted({*now, *record.counters}):
        if name not in now or name not in record.counters:
            where = "run" if name not in now else "baseline"
            judged = nothing_compared(Status.INCOMPARABLE, f"counter {name} is missing from the {where}")
        else:
            judged = judge_counter(name, now[name], record.counters[name])
        expected = float(record.counters[name]) if name in record.counters else None
        yield _claim(run.method, run.scene, f"counter {name}", "1", judged, tolerance=2.0, expected=expected)


def _missing_claim(method: str, scene: str, quantity: str, record: AcceptedQuantity, run: SceneRun | None) -> Claim:
    why = f"{run.status.value}: {run.reason}" if run is not None and not run.solved else "it is not in this run"
    status = run.status if run is not None and not run.solved else Status.INCOMPARABLE
    return _claim(
        method, scene, quantity, record.unit, nothing_compared(status, f"missing: {why}"), tolerance=record.rtol
    )


def _claim(
    method: str,
    scene: str,
    quantity: str,
    unit: str,
    judged: Judgement,
    *,
    tolerance: float,
    expected: float | None = None,
    because: str = "an accepted number does not move unnoticed",
) -> Claim:
    return Claim(
        name=f"regression of {quantity}",
        kind=Kind.REGRESSION,
        scene=scene,
        methods=(method,),
        quantity=quantity,
        unit=unit,
        status=judged.status,
        verdict=judged.verdict,
        observed=judged.observed,
        expected=expected,
        tolerance=tolerance,
        fraction=judged.fraction,
        origin=Origin.OWN_EARLIER_OUTPUT,
        source=f"baselines, {method}",
        because=because,
        derived_from="max(10 x measured spread, 1e-12); unknowns exact, other counters max(2, 10 %)",
        message=judged.message,
    )
