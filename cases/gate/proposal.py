"""What accepting a case would change, record by record, in units of the tolerance and of the uncertainty."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

from cases.gate.baseline import AcceptedCounters, AcceptedQuantity, Baseline
from cases.gate.checks.claims import claims_of
from cases.gate.checks.counts import counters_of
from cases.gate.checks.uncertainties import curve_uncertainties
from cases.gate.checks.values import permitted_change
from cases.gate.spread import Spreads
from cases.judgement.rules.tolerance import relative_tolerance
from cases.results.records.run import CaseResult
from cases.results.records.scene_run import Quantity, SceneRun
from contact import InvalidInput


@dataclass(frozen=True, kw_only=True)
class BaselineChange:
    """One record before and after; ``old`` is None for a new one, ``new`` for one that would be withdrawn."""

    method: str
    old: AcceptedQuantity | None
    new: AcceptedQuantity | None

    @property
    def record(self) -> AcceptedQuantity:
        """The record that names the change: the new one if there is one."""
        (record, *_) = [r for r in (self.new, self.old) if r is not None]
        return record

    @property
    def comparable(self) -> bool:
        """Whether both exist with equal unit and number of steps."""
        old, new = self.old, self.new
        return old is not None and new is not None and old.unit == new.unit and len(old.values) == len(new.values)

    @property
    def step(self) -> int:
        """The step that moved most, 0 where nothing can be subtracted."""
        if self.old is None or self.new is None or not self.comparable:
            return 0
        moved = [abs(x - b) for x, b in zip(self.new.values, self.old.values, strict=True)]
        return moved.index(max(moved)) if moved else 0

    @property
    def values(self) -> tuple[float | None, float | None]:
        """Old and new value at that step."""
        return _value(self.old, self.step), _value(self.new, self.step)

    @property
    def in_tolerances(self) -> float | None:
        """New minus old over the permitted difference; None where nothing can be subtracted."""
        old, new = self.values
        if self.old is None or old is None or new is None or not self.comparable:
            return None
        return (new - old) / permitted_change(self.old, self.step)

    @property
    def in_uncertainty(self) -> float | None:
        """New minus old over the new uncertainty U; None where the method states none, or zero."""
        old, new = self.values
        stated = self.new.uncertainty[self.step] if self.new and self.new.uncertainty else 0.0
        return (new - old) / stated if stated and self.comparable and old is not None and new is not None else None

    @property
    def loosens(self) -> bool:
        """Whether later runs may differ more than before, or differ unseen."""
        if self.old is None or self.new is None:
            return self.old is not None
        wider = _relative_width(self.new) > (1 + 1e-9) * _relative_width(self.old)
        return self.new.tolerance > self.old.tolerance or (self.new.scale > self.old.scale and wider)

    @property
    def is_nothing(self) -> bool:
        """Whether nothing would change."""
        return self.old == self.new


@dataclass(frozen=True, kw_only=True)
class Proposal:
    """The baselines a case would have, every change this makes, and counters and claims no longer watched."""

    case: str
    reason: str
    baselines: tuple[Baseline, ...]
    changes: tuple[BaselineChange, ...]
    lost: tuple[str, ...]


def propose(
    case: CaseResult, *, suites: tuple[str, ...], accepted: Iterable[Baseline], spreads: Spreads, reason: str
) -> Proposal:
    """Return what accepting ``case`` as it ran would change.

    Args:
        case: the case as run.
        suites: suites the case belongs to.
        accepted: baselines so far, of any case.
        spreads: measured relative spread by method, scene and quantity.
        reason: why, in the user's words.

    Raises:
        InvalidInput: if the spread of a quantity was not measured.
    """
    before = {baseline.method: baseline for baseline in accepted if baseline.case == case.name}
    evidence = _Evidence(case, spreads, reason)
    after = {
        method: Baseline(
            case=case.name,
            method=method,
            suites=suites,
            records=tuple(evidence.records(method, before.get(method))),
            counters=tuple(evidence.counters(method)),
            claims=claims_of(case, method),
        )
        for method in dict.fromkeys([*before, *(run.method for run in case.runs if run.solved)])
    }
    return Proposal(
        case=case.name,
        reason=reason,
        baselines=tuple(after.values()),
        changes=tuple(change for method in after for change in _changes(before.get(method), after[method])),
        lost=tuple(name for method in before for name in _lost(before[method], after[method])),
    )


@dataclass(frozen=True)
class _Evidence:
    """What new records are made from."""

    case: CaseResult
    spreads: Spreads
    reason: str

    def records(self, method: str, before: Baseline | None) -> Iterator[AcceptedQuantity]:
        """One record for each quantity the method computed; an unchanged one stays as it was."""
        kept = {record.place: record for record in before.records} if before else {}
        for run in self._solved(method):
            for quantity in run.quantities:
                yield self._record(run, quantity, kept.get((run.scene, quantity.name)))

    def counters(self, method: str) -> Iterator[AcceptedCounters]:
        """One record for each scene the method solved."""
        for run in self._solved(method):
            yield AcceptedCounters(
                scene=run.scene,
                specification=run.specification,
                counters=counters_of(run),
                curves=curve_uncertainties(run),
            )

    def _solved(self, method: str) -> list[SceneRun]:
        return [run for run in self.case.runs if run.method == method and run.solved]

    def _record(self, run: SceneRun, quantity: Quantity, old: AcceptedQuantity | None) -> AcceptedQuantity:
        spread = self._spread(run, quantity)
        if old is not None and relative_tolerance(spread) <= old.tolerance:
            # The widest spread measured so far counts: a repetition that agrees by chance tightens nothing.
            spread = old.spread
        record = AcceptedQuantity(
            scene=run.scene,
            specification=run.specification,
            quantity=quantity.name,
            unit=quantity.unit,
            scale=quantity.scale,
            values=quantity.values,
            uncertainty=quantity.uncertainty,
            spread=spread,
            tolerance=relative_tolerance(spread),
            reason=self.reason,
        )
        return old if old is not None and replace(record, reason=old.reason) == old else record

    def _spread(self, run: SceneRun, quantity: Quantity) -> float:
        place = run.method, run.scene, quantity.name
        if place not in self.spreads:
            raise InvalidInput(f"the spread of {' / '.join(place)} was not measured; a tolerance needs one")
        return self.spreads[place]


def _changes(before: Baseline | None, after: Baseline) -> Iterator[BaselineChange]:
    old = {record.place: record for record in before.records} if before else {}
    new = {record.place: record for record in after.records}
    changes = (BaselineChange(method=after.method, old=old.get(p), new=new.get(p)) for p in dict.fromkeys([*old, *new]))
    yield from (change for change in changes if not change.is_nothing)


def _lost(before: Baseline, after: Baseline) -> Iterator[str]:
    new = {record.scene: record.counters for record in after.counters}
    for record in before.counters:
        lost = record.counters.keys() - new.get(record.scene, {}).keys()
        yield from (f"counter {name} of {record.scene} by {before.method}" for name in sorted(lost))
    judged = {claim.identity: claim.judged for claim in after.claims or ()}
    for claim in before.claims or ():
        if judged.get(claim.identity, 0) < claim.judged:
            yield f"claim {claim.name!r} about {claim.quantity} by {before.method}"


def _value(record: AcceptedQuantity | None, step: int) -> float | None:
    return record.values[step] if record is not None and record.values else None


def _relative_width(record: AcceptedQuantity) -> float:
    """The widest permitted difference over the largest value: what a tolerance and a declared scale allow together."""
    largest = max(map(abs, record.values), default=0.0)
    return record.tolerance * max(1.0, record.scale / largest if largest > 0 else 1.0)
