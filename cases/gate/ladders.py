"""Accepted ladders: no method may give up earlier than it did, or lose more than one digit on a rung.

One file a method, ``baselines/ladders-<method>.json``, written by ``accept`` alone.
"""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path

from pydantic import TypeAdapter

from cases.gate.baseline import REMEDY
from cases.gate.checks.check import regression_claim
from cases.judgement.rules.judgement import Judgement, nothing_compared, passed_or_failed
from cases.results.files import write_whole
from cases.results.records.claim import Claim
from cases.results.records.reliability import Ladder
from cases.results.records.run import CaseResult
from cases.results.status import Status
from cases.results.strict_json import json_text, read_json, validated
from contact import InvalidInput

_LADDERS: TypeAdapter[tuple[Ladder, ...]] = TypeAdapter(tuple[Ladder, ...])
_NAME = "ladders-{}.json"


def read_ladders(folder: Path) -> tuple[Ladder, ...]:
    """Return every accepted ladder; none if there is no file.

    Raises:
        InvalidInput: if a file is damaged.
    """
    return tuple(ladder for path in sorted(folder.glob(_NAME.format("*"))) for ladder in _read(path))


def _read(path: Path) -> tuple[Ladder, ...]:
    return validated(_LADDERS, read_json(path, remedy=REMEDY).get("ladders"), place=f"{path}, ladders", remedy=REMEDY)


def ladder_claims(case: CaseResult, accepted: Iterable[Ladder]) -> Iterator[Claim]:
    """Return one regression claim for each ladder of the case; one that nobody accepted fails by its name.

    So does one that its method no longer climbs though it walks others and others walk it. Nothing is claimed as long
    as no ladder at all was accepted.
    """
    before = {(ladder.name, ladder.method): ladder for ladder in accepted}
    for ladder in case.ladders if before else ():
        yield _claim(ladder, before.get((ladder.name, ladder.method)))
    walked = {(ladder.name, ladder.method) for ladder in case.ladders}
    names, methods = {name for name, _ in walked}, {method for _, method in walked}
    for name, method in sorted(before.keys() - walked):
        if name in names and method in methods:
            yield _claim(replace(before[name, method], rungs=()), before[name, method])


def _claim(ladder: Ladder, before: Ladder | None) -> Claim:
    return regression_claim(
        "accepted rungs and digits",
        _judged(ladder, before),
        scene=ladder.name,
        methods=(ladder.method,),
        quantity=ladder.quantity,
        expected=None if before is None else 0.0,
        tolerance=0.5,
        source=f"baselines/{_NAME.format(ladder.method)}",
        because="a method should not give up earlier than it did",
        derived_from="one digit: repeats that differ by single roundings share about as many digits every time",
    )


def _judged(ladder: Ladder, before: Ladder | None) -> Judgement:
    if before is None:
        message = "extra: this ladder was never accepted; look at it, then accept the run"
        return nothing_compared(Status.INCOMPARABLE, message)
    worse = ladder.worse_than(before)
    message = "; ".join(worse) or "no rung lost, no more than one digit lost"
    return passed_or_failed(float(len(worse)), 0.5, message, failure=Status.DIFF)


def accept_ladders(folder: Path, ladders: Iterable[Ladder], *, loosen: bool = False) -> None:
    """Write ladders into ``folder``, those of a method over those accepted before.

    Raises:
        InvalidInput: if a ladder is worse than the accepted one and ``loosen`` is not said; nothing is written then.
    """
    accepted = {(ladder.name, ladder.method): ladder for ladder in read_ladders(folder)}
    new = {(ladder.name, ladder.method): ladder for ladder in ladders}
    worse = [line for place, ladder in new.items() if place in accepted for line in ladder.worse_than(accepted[place])]
    if worse and not loosen:
        raise InvalidInput(f"ladders are not accepted: {'; '.join(worse)}; find out why, then say --loosen")
    for method in dict.fromkeys(ladder.method for ladder in new.values()):
        merged = [ladder for ladder in (accepted | new).values() if ladder.method == method]
        _write(folder / _NAME.format(method), merged)


def _write(path: Path, ladders: list[Ladder]) -> None:
    tree = _LADDERS.dump_python(tuple(sorted(ladders, key=lambda ladder: ladder.name)), mode="json")
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, json_text({"ladders": tree}))
