"""Accept a run's numbers as the new baseline: the only writer, dry unless told, and with reasons to refuse."""

import math
import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from cases.baselines.history import append_history
from cases.baselines.records import (
    AcceptedCounters,
    AcceptedQuantity,
    Baseline,
    counters_of,
    read_baseline,
    specification,
    write_baseline,
)
from cases.results import Acceptance, CaseResult, Kind, SceneRun, Stamp
from cases.status import Status
from cases.tolerance import permitted_difference, relative_tolerance
from contact import InvalidInput

Spreads = Callable[[str, SceneRun], Mapping[str, float]]  # (case, run) -> relative spread of each quantity
Key = tuple[str, str, str]  # method, scene, quantity


@dataclass(frozen=True, kw_only=True)
class Change:
    """One number that would be accepted: old and new, the change in units of tolerance and of U.

    ``old`` is None for a number accepted for the first time, ``new`` for one that is no longer computed.
    """

    method: str
    scene: str
    quantity: str
    unit: str
    old: float | None
    new: float | None
    old_rtol: float | None
    new_rtol: float | None
    in_tolerances: float | None
    in_uncertainties: float | None

    @property
    def loosens(self) -> bool:
        """Whether the tolerance would grow."""
        return self.old_rtol is not None and self.new_rtol is not None and self.new_rtol > self.old_rtol


def accept(
    case: CaseResult,
    stamp: Stamp,
    directory: Path,
    *,
    reason: str,
    spreads: Spreads,
    write: bool = False,
    loosen: bool = False,
    environment: Mapping[str, str] = os.environ,
) -> tuple[Change, ...]:
    """Return the changes that accepting ``case`` makes, and make them when ``write`` is set.

    Raises:
        InvalidInput: without a reason, in CI, from a dirty tree, with a broken or unfinished solution, with a failing
            exact or order claim, or with a tolerance that grows without ``loosen``.
    """
    _refuse(case, stamp, reason, environment)
    methods = sorted({run.method for run in case.runs if run.solved})
    old = {method: read_baseline(directory, case.name, method) for method in methods}
    new = {method: _baseline(case, method, reason, spreads, old[method]) for method in methods}
    changes = tuple(change for m in methods for change in _changes(m, old[m], new[m]))
    loosened = [change for change in changes if change.loosens]
    if loosened and not loosen:
        first = loosened[0]
        raise InvalidInput(
            f"the tolerance of {first.quantity} ({first.method}, {first.scene}) would grow from {first.old_rtol:.1e} "
            f"to {first.new_rtol:.1e}; loosen only on purpose, with --loosen"
        )
    if write:
        for baseline in new.values():
            write_baseline(directory, baseline)
        append_history(directory, _history(case.name, changes, reason, stamp))
    return changes


def _refuse(case: CaseResult, stamp: Stamp, reason: str, environment: Mapping[str, str]) -> None:
    if not reason.strip():
        raise InvalidInput("accept needs a reason: what changed, and why the new number is right")
    if environment.get("CI"):
        raise InvalidInput("accept does not run in CI: a person accepts, and commits the result")
    if stamp.dirty:
        raise InvalidInput("the working tree has changes: commit first, so that a number belongs to a revision")
    broken = [run for run in case.runs if run.status not in (Status.PASS, Status.SKIP)]
    if broken:
        raise InvalidInput(f"{broken[0].method} has no numbers on {broken[0].scene}: {broken[0].reason}; mend it first")
    for claim in case.claims:
        if claim.kind in (Kind.EXACT, Kind.ORDER) and claim.status.is_failure:
            raise InvalidInput(
                f"claim {claim.name!r} fails on {claim.scene}: {claim.message}; mend it, never accept it"
            )


def _baseline(case: CaseResult, method: str, reason: str, spreads: Spreads, old: Baseline | None) -> Baseline:
    scenes = {scene.name: scene for scene in case.scenes}
    runs = [run for run in case.runs if run.method == method and run.solved]
    known = {(q.scene, q.quantity): q for q in old.quantities} if old else {}
    quantities = tuple(
        record
        for run in runs
        for record in _records(run, specification(scenes[run.scene], run), reason, spreads(case.name, run), known)
    )
    counters = tuple(
        AcceptedCounters(
            scene=run.scene, specification=specification(scenes[run.scene], run), counters=counters_of(run)
        )
        for run in runs
    )
    return Baseline(case=case.name, method=method, quantities=quantities, counters=counters)


def _records(
    run: SceneRun,
    asked: str,
    reason: str,
    spreads: Mapping[str, float],
    known: Mapping[tuple[str, str], AcceptedQuantity],
) -> Iterator[AcceptedQuantity]:
    for q in run.quantities:
        before = known.get((run.scene, q.name))
        unchanged = before is not None and before.values == q.values and before.specification == asked
        yield AcceptedQuantity(
            scene=run.scene,
            quantity=q.name,
            unit=q.unit,
            scale=q.scale,
            values=q.values,
            uncertainty=q.uncertainty,
            spread=spreads[q.name],
            rtol=relative_tolerance(spreads[q.name]),
            reason=before.reason if unchanged and before else reason,
            specification=asked,
        )


def _changes(method: str, old: Baseline | None, new: Baseline) -> Iterator[Change]:
    before = {(q.scene, q.quantity): q for q in old.quantities} if old else {}
    after = {(q.scene, q.quantity): q for q in new.quantities}
    for key in sorted({*before, *after}):
        change = _change(method, key, before.get(key), after.get(key))
        if change.old != change.new or change.old_rtol != change.new_rtol:
            yield change


def _change(
    method: str, key: tuple[str, str], before: AcceptedQuantity | None, after: AcceptedQuantity | None
) -> Change:
    either = after or before
    step = _worst_step(before, after)
    old, new = (None if q is None else q.values[min(step, len(q.values) - 1)] for q in (before, after))
    moved = None if old is None or new is None else abs(new - old)
    tolerance = (
        None if before is None or old is None else permitted_difference(old, scale=before.scale, rtol=before.rtol)
    )
    uncertainty = before.uncertainty[min(step, len(before.uncertainty) - 1)] if before and before.uncertainty else None
    return Change(
        method=method,
        scene=key[0],
        quantity=key[1],
        unit=either.unit if either else "",
        old=old,
        new=new,
        old_rtol=before.rtol if before else None,
        new_rtol=after.rtol if after else None,
        in_tolerances=_ratio(moved, tolerance),
        in_uncertainties=_ratio(moved, uncertainty),
    )


def _worst_step(before: AcceptedQuantity | None, after: AcceptedQuantity | None) -> int:
    if before is None or after is None or len(before.values) != len(after.values):
        return 0
    moved = [abs(b - a) for a, b in zip(before.values, after.values, strict=True)]
    return moved.index(max(moved))


def _ratio(size: float | None, unit: float | None) -> float | None:
    if size is None or unit is None:
        return None
    return size / unit if unit > 0 else (0.0 if size == 0 else math.inf)


def _history(case: str, changes: Iterable[Change], reason: str, stamp: Stamp) -> Iterator[Acceptance]:
    today = datetime.now(UTC).strftime("%Y-%m-%d")
    for change in changes:
        yield Acceptance(
            date=today,
            case=case,
            method=change.method,
            quantity=f"{change.quantity} ({change.scene})",
            old=change.old,
            new=change.new,
            old_tolerance=change.old_rtol,
            new_tolerance=change.new_rtol,
            reason=reason,
            revision=stamp.revision,
        )
