"""The only writer of baselines: what accepting a case would change, and everything that is refused."""

import os
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from cases.answers import Answer, Values
from cases.gate.baseline import (
    OF_SPREAD,
    Accepted,
    Baseline,
    permitted_change,
    read_baselines,
    relative_tolerance,
    stored_part,
    write_baseline,
)
from cases.gate.gate import judged_claims
from cases.gate.spread import Spreads
from cases.rules import SMALLEST_RELATIVE
from cases.run.stamp import git, revision
from cases.runs import Run
from cases.stress import worse_than
from cases.verdicts import Kind, Verdict
from contact import InvalidInput


@dataclass(frozen=True, kw_only=True)
class WriteConditions:
    """Conditions under which a baseline may be written.

    Attributes:
        revision: Commit of the source; "unknown" outside a repository.
        changed: Files that differ from the commit, except baselines.
        in_ci: Whether this is a job of continuous integration.
    """

    revision: str
    changed: tuple[str, ...]
    in_ci: bool


def write_conditions(repository: Path, baselines: Path, environment: Mapping[str, str] = os.environ) -> WriteConditions:
    """Return the conditions of this process and the source in ``repository``."""
    return WriteConditions(
        revision=revision(repository),
        changed=_changed_files(repository, baselines),
        in_ci=environment.get("CI", "").lower() not in ("", "0", "false"),
    )


def _changed_files(repository: Path, baselines: Path) -> tuple[str, ...]:
    """Changed tracked files, and untracked files that are not ignored."""
    outside = f":(exclude){baselines.resolve()}" if baselines.resolve().is_relative_to(repository.resolve()) else "."
    listed = git(repository, "status", "--porcelain", "--", ".", outside)
    return tuple(line[3:] for line in listed.splitlines())


@dataclass(frozen=True, kw_only=True)
class Change:
    """One quantity before and after; ``old`` is None for a new one, ``new`` for one that would be withdrawn."""

    method: str
    scene: str
    quantity: str
    old: Values | None
    new: Values | None

    @property
    def step(self) -> int | None:
        """The step that changed most; None where the values cannot be subtracted."""
        old, new = self.old, self.new
        if old is None or new is None or old.unit != new.unit or not 0 < len(old.values) == len(new.values):
            return None
        return int(np.argmax(np.abs(np.subtract(new.values, old.values))))

    @property
    def values(self) -> tuple[float | None, float | None]:
        """Old and new value at that step."""
        old, new = (q.values[self.step or 0] if q is not None and q.values else None for q in (self.old, self.new))
        return old, new

    @property
    def in_tolerances(self) -> float | None:
        """New minus old value over the permitted change; None where they cannot be subtracted."""
        return self._over(permitted_change(self.old, self.step)) if self.old and self.step is not None else None

    @property
    def in_stated_errors(self) -> float | None:
        """New minus old value over the new stated error; None where the method states none, or zero."""
        return self._over(self.new.error[self.step]) if self.new and self.new.error and self.step is not None else None

    def _over(self, size: float) -> float | None:
        old, new = self.values
        return (new - old) / size if size and old is not None and new is not None else None

    @property
    def loosens(self) -> bool:
        """Whether later runs may differ more than before, or are no longer compared."""
        if self.old is None or self.new is None:
            return self.old is not None
        is_wider = _relative_width(self.new) > (1 + 1e-9) * _relative_width(self.old)
        has_grown = relative_tolerance(self.new) > relative_tolerance(self.old)
        return has_grown or (self.new.scale > self.old.scale and is_wider)


@dataclass(frozen=True, kw_only=True)
class Proposal:
    """A new baseline of a case, its changes against the old one, and counters and claims that it no longer checks."""

    baseline: Baseline
    changes: tuple[Change, ...]
    lost: tuple[str, ...]

    @property
    def case(self) -> str:
        """Name of the case."""
        return self.baseline.accepted.case


def propose(
    run: Run,
    case: str,
    *,
    suites: tuple[str, ...],
    before: Baseline | None,
    spreads: Spreads,
    reason: str,
    unsolved: Collection[tuple[str, str]] = (),
) -> Proposal:
    """Return the baseline that accepting a case would write, with its changes.

    Args:
        run: Answers and verdicts that are accepted.
        case: Name of the case.
        suites: Suites to which the case belongs.
        before: Baseline accepted so far.
        spreads: Measured relative spread by method, scene and quantity.
        reason: Reason in the user's words.
        unsolved: Scenes and methods that the run need not solve; their accepted answers stay.

    Raises:
        InvalidInput: If the spread of a quantity was not measured.
    """
    old = {(a.scene, a.method): a for a in before.answers} if before else {}
    solved = {(a.scene, a.method): a for a in run.answers.of_case(case) if a.solved}
    new = {place: _with_spreads(answer, old.get(place), spreads) for place, answer in solved.items()}
    unchanged = {place: answer for place, answer in old.items() if place in unsolved}
    answers = tuple(sorted((unchanged | new).values(), key=lambda answer: answer.identity))
    judged = run.judged
    accepted = Accepted(
        case=case,
        suites=suites,
        reason=reason,
        claims=judged_claims(verdict for verdict in judged.verdicts if verdict.case == case),
        stress_tests=tuple(test for test in judged.stress_tests if test.case == case),
    )
    if before is not None and answers == before.answers:
        # Where nothing changes the reason stays, too.
        with_old_reason = replace(accepted, reason=before.accepted.reason)
        accepted = before.accepted if with_old_reason == before.accepted else accepted
    after = Baseline(accepted=accepted, answers=answers)
    return Proposal(baseline=after, changes=tuple(_changes(before, after)), lost=tuple(_lost(before, after)))


def _with_spreads(answer: Answer, old: Answer | None, spreads: Spreads) -> Answer:
    """The answer as the baseline stores it, with the widest spread measured so far.

    A repetition that agrees by chance does not reduce the tolerance.
    """
    before: Mapping[str, Values] = old.quantities if old is not None else {}
    quantities = {}
    for name, q in stored_part(answer).quantities.items():
        place = answer.method, answer.scene, name
        if not q.at and place not in spreads:
            raise InvalidInput(f"the spread of {' / '.join(place)} was not measured; a tolerance needs one")
        spread = 0.0 if q.at else spreads[place]
        accepted = before[name].spread if name in before else 0.0
        is_within = OF_SPREAD * spread <= max(OF_SPREAD * accepted, SMALLEST_RELATIVE)
        quantities[name] = replace(q, spread=accepted if is_within else spread)
    return replace(stored_part(answer), quantities=quantities)


def _changes(before: Baseline | None, after: Baseline) -> Iterator[Change]:
    """Yield the quantities that differ between two baselines."""
    old, new = (_quantities(baseline) for baseline in (before, after))
    for place in dict.fromkeys([*old, *new]):
        if old.get(place) != new.get(place):
            method, scene, quantity = place
            yield Change(method=method, scene=scene, quantity=quantity, old=old.get(place), new=new.get(place))


def _quantities(baseline: Baseline | None) -> dict[tuple[str, str, str], Values]:
    """Quantities along the steps by method, scene and name."""
    answers = baseline.answers if baseline else ()
    return {(a.method, a.scene, name): q for a in answers for name, q in a.quantities.items() if not q.at}


def _lost(before: Baseline | None, after: Baseline) -> Iterator[str]:
    """Names of counters, claims and steps of stress tests that the new baseline lacks or has worse."""
    if before is None:
        return
    counters = {answer.identity: answer.counters for answer in after.answers}
    for answer in before.answers:
        lost = answer.counters.keys() - counters.get(answer.identity, {}).keys()
        yield from (f"counter {name} of {answer.scene} by {answer.method}" for name in sorted(lost))
    judged = {claim.identity: claim.judged for claim in after.accepted.claims}
    for claim in before.accepted.claims:
        if judged.get(claim.identity, 0) < claim.judged:
            yield f"claim {claim.name!r} about {claim.quantity} by {' and '.join(claim.methods)}"
    tests = {(test.name, test.method): test for test in after.accepted.stress_tests}
    for test in before.accepted.stress_tests:
        if (test.name, test.method) in tests:
            yield from worse_than(tests[test.name, test.method], test)


def _relative_width(values: Values) -> float:
    """The widest permitted change over the largest value, from the tolerance and the declared scale."""
    largest = max(map(abs, values.values), default=0.0)
    return relative_tolerance(values) * max(1.0, values.scale / largest if largest > 0 else 1.0)


def accept(folder: Path, proposal: Proposal, run: Run, now: WriteConditions, *, loosen: bool = False) -> None:
    """Write the proposed baseline into ``folder``.

    Raises:
        InvalidInput: Naming every reason why this may not be accepted; nothing is written then.
    """
    refused = refusals(proposal, run, now, loosen=loosen)
    if refused:
        raise InvalidInput(f"{proposal.case} is not accepted: " + "; ".join(refused))
    write_baseline(folder, proposal.baseline)


def accepted_before(folder: Path, case: str) -> Baseline | None:
    """Return the baseline of a case; None if there is none."""
    return next((baseline for baseline in read_baselines(folder) if baseline.accepted.case == case), None)


def refusals(proposal: Proposal, run: Run, now: WriteConditions, *, loosen: bool = False) -> tuple[str, ...]:
    """Return every reason why ``proposal`` may not be accepted, each with its remedy."""
    reason = proposal.baseline.accepted.reason.strip()
    return (
        *refusals_beforehand(proposal.case, run, now),
        *(() if loosen else _loosenings(proposal)),
        *(() if reason else ("no reason is given; say why with --reason",)),
    )


def refusals_beforehand(case: str, run: Run, now: WriteConditions) -> tuple[str, ...]:
    """Return the reasons to refuse that are known before any solution is repeated to measure its spread."""
    verdicts = (verdict for verdict in run.judged.verdicts if verdict.case == case)
    return *_refused_circumstances(run, now), *_refused_run(run.answers.of_case(case), verdicts)


def _refused_circumstances(run: Run, now: WriteConditions) -> Iterator[str]:
    """Reasons in the state of the source tree and the stamp of the run."""
    stamp = run.judged.stamp
    if now.in_ci:
        yield "continuous integration must not accept its own numbers; accept them by hand and commit the files"
    if now.changed:
        yield f"uncommitted changes ({', '.join(now.changed[:3])}); a baseline belongs to a commit, so commit first"
    if stamp.dirty:
        yield "the run was made with uncommitted changes; run again on a clean tree"
    if stamp.revision != now.revision:
        yield f"the run belongs to {stamp.revision[:12]}, the source is at {now.revision[:12]}; run again"
    if not run.judged.complete:
        yield "the run was interrupted; resume it first"


def _refused_run(answers: Iterable[Answer], verdicts: Iterable[Verdict]) -> Iterator[str]:
    """Reasons in failed answers and failed claims of kind exact or order."""
    for answer in answers:
        if answer.status.is_failure:
            yield f"{answer.method} on {answer.scene!r} ended with {answer.status}: {answer.reason}"
    for verdict in verdicts:
        if verdict.kind in (Kind.EXACT, Kind.ORDER) and verdict.status.is_failure:
            yield f"the {verdict.kind} claim {verdict.claim!r} ended with {verdict.status}: {verdict.message}"


def _loosenings(proposal: Proposal) -> Iterator[str]:
    """Reasons to refuse a baseline that checks less than before, or with wider tolerances."""
    for change in proposal.changes:
        if change.loosens:
            name = f"{change.quantity} of {change.scene!r} by {change.method}"
            reason = f"{name} would no longer be watched"
            if change.old is not None and change.new is not None:
                old, new = (relative_tolerance(q) for q in (change.old, change.new))
                reason = f"the tolerance of {name} would grow from {old:.1e} to {new:.1e}"
            yield f"{reason}; find out why, then say --loosen"
    for name in proposal.lost:
        yield f"{name} would no longer be watched, or is worse; say --loosen if that is meant"
