"""A run against what was accepted: every number, error bar, counter and claim, nothing missing and nothing extra."""

from collections.abc import Callable, Container, Iterable, Iterator
from dataclasses import replace

from cases.gate.baseline import Baseline
from cases.gate.checks.absent import absent_claims, not_installed
from cases.gate.checks.claims import missing_claims
from cases.gate.checks.counts import count_checks
from cases.gate.checks.uncertainties import uncertainty_checks
from cases.gate.checks.values import value_checks
from cases.gate.ladders import ladder_claims
from cases.measurements.measurement import grouped
from cases.results.records.claim import Claim, Kind
from cases.results.records.reliability import Ladder
from cases.results.records.run import CaseResult, RunResult
from cases.results.records.scene_run import SceneRun

Watched = Callable[[str, SceneRun], bool]


def gate(
    run: RunResult,
    baselines: Iterable[Baseline],
    ladders: Iterable[Ladder] = (),
    watched: Watched = lambda case, row: True,
) -> RunResult:
    """Return ``run`` with a regression claim for every quantity and counter that was accepted or is new.

    The stated uncertainty that moved most is another one for each solution, as is each accepted claim that is missing.
    A method that is not installed where the run was made is told once and not compared.

    Args:
        run: a run whose own claims are judged.
        baselines: what was accepted; a case of the run's suite that the run does not have counts as missing.
        ladders: accepted stability ladders.
        watched: whether a solution of a case needs accepted numbers; those of the nightly suite alone do not.
    """
    accepted_ladders = tuple(ladders)
    accepted = grouped(baselines, lambda baseline: baseline.case)
    present = {case.name for case in run.cases}
    lost = [_lost_case(name) for name in sorted(accepted) if name not in present and _belongs(accepted[name], run)]
    cases = tuple(_gated(case, accepted.get(case.name, []), accepted_ladders, watched) for case in (*run.cases, *lost))
    return replace(run, cases=cases)


def _belongs(baselines: list[Baseline], run: RunResult) -> bool:
    return any(run.suite in baseline.suites for baseline in baselines)


def _lost_case(name: str) -> CaseResult:
    return CaseResult(
        name=name,
        title="accepted, but not in this run",
        question="Where did this case go?",
        equations=(),
        text="Baselines of this case exist for the suite of this run, yet the run does not have it.",
        scenes=(),
        runs=(),
        claims=(),
    )


def _gated(case: CaseResult, baselines: list[Baseline], ladders: tuple[Ladder, ...], watched: Watched) -> CaseResult:
    """Return ``case`` with its regression claims; those of an earlier gate are replaced."""
    own = (claim for claim in case.claims if claim.kind is not Kind.REGRESSION)
    seen = replace(case, runs=tuple(row for row in case.runs if watched(case.name, row)))
    absent = not_installed(case)
    present = [_without(baseline, absent) for baseline in baselines if baseline.method not in absent]
    found = (
        *_regression_claims(seen, present),
        *missing_claims(case, present),
        *absent_claims(case.name, baselines, absent),
        *ladder_claims(case, ladders),
    )
    return replace(case, claims=(*own, *found))


def _without(baseline: Baseline, absent: Container[str]) -> Baseline:
    """The baseline without claims that need a method that is not installed."""
    claims = baseline.claims
    left = None if claims is None else tuple(c for c in claims if not any(name in absent for name in c.methods))
    return replace(baseline, claims=left)


def _regression_claims(case: CaseResult, baselines: list[Baseline]) -> Iterator[Claim]:
    accepted = {baseline.method: baseline for baseline in baselines}
    for method in dict.fromkeys([*(run.method for run in case.runs), *accepted]):
        rows = {run.scene: run for run in case.runs if run.method == method}
        records = accepted[method].records if method in accepted else ()
        counters = accepted[method].counters if method in accepted else ()
        for check in value_checks(rows, {record.place: record for record in records}):
            yield check.claim(case.name, method)
        for check in count_checks(rows, {record.scene: record for record in counters}):
            yield check.claim(case.name, method)
        for check in uncertainty_checks(rows, records, counters):
            yield check.claim(case.name, method)
