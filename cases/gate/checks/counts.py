"""Deterministic counters against the accepted ones: a gate that no noise on the machine can open or close."""

from collections.abc import Iterator, Mapping

from cases.gate.baseline import AcceptedCounters
from cases.gate.checks.check import BaselineCheck, extra, missing
from cases.judgement.rules.regression import judge_counter, permitted_count_change
from cases.results.records.scene_run import SceneRun

UNKNOWNS = "unknowns"
FROM_COUNTS = "unknowns within 2 %; other counters within max(3, 20 %)"


def counters_of(run: SceneRun) -> dict[str, int]:
    """Return the counters of a solution, its unknowns among them; none where nothing was solved."""
    return {UNKNOWNS: run.cost.unknowns, **run.cost.counters} if run.cost else {}


def count_checks(rows: Mapping[str, SceneRun], accepted: Mapping[str, AcceptedCounters]) -> Iterator[BaselineCheck]:
    """Compare every counter of the accepted scenes of one method.

    Args:
        rows: solutions of the method by scene.
        accepted: counters by scene; a scene without any is found by its quantities.
    """
    for scene, record in accepted.items():
        run = rows.get(scene)
        found = counters_of(run) if run else {}
        for name in sorted({*record.counters, *found}):
            yield _compared(name, found.get(name), record, run)


def _compared(name: str, value: int | None, record: AcceptedCounters, run: SceneRun | None) -> BaselineCheck:
    accepted = record.counters.get(name)
    if accepted is None:
        judged = extra(name, record.scene)
    elif value is None:
        judged = missing(name, record.scene, run)
    else:
        judged = judge_counter(name, value, accepted)
    return BaselineCheck(
        scene=record.scene,
        what=name,
        unit="1",
        judgement=judged,
        derived_from=FROM_COUNTS,
        # Half a count permits not a single one.
        tolerance=max(permitted_count_change(name, accepted or 0), 0.5),
        expected=None if accepted is None else float(accepted),
    )
