"""Accepted answers: one file per case, ``baselines/<case>.jsonl``, written by ``accept`` alone.

The first line is an `Accepted` record; each other line is an answer (`cases.answers`) with the measured spread of its
quantities. Of fields the stated errors alone are stored.
"""

from dataclasses import replace
from pathlib import Path

from pydantic import TypeAdapter
from pydantic.dataclasses import dataclass

from cases.answers import Answer, Values, read_answers
from cases.files import validated
from cases.rules import SMALLEST_RELATIVE
from cases.studies import StressTest
from cases.verdicts import RECORD, Kind
from contact import InvalidInput
from contact.files.whole import write_whole

REMEDY = "restore it from the repository, or accept the case anew"
# Fraction of the accepted stated error by which a value may change. Processors round differently, and a searched radius
# or a mesh amplifies that to 3e-9. Half of it is not enough for finite elements, twice is still far below any error.
OF_STATED_ERROR = 0.01
# Tolerance over the measured spread. Three repetitions show about a third of it; with half the factor a gate fails by
# chance, with twice the factor larger changes pass.
OF_SPREAD = 10.0


@dataclass(frozen=True, kw_only=True, config=RECORD)
class AcceptedClaim:
    """A claim that was judged when its case was accepted, and on how many scenes or groups of them."""

    name: str
    kind: Kind
    quantity: str
    methods: tuple[str, ...]
    judged: int

    @property
    def identity(self) -> tuple[str, Kind, str, tuple[str, ...]]:
        """Name, kind, quantity and methods of the claim."""
        return self.name, self.kind, self.quantity, self.methods


@dataclass(frozen=True, kw_only=True, config=RECORD)
class Accepted:
    """The accepted results of a case except its answers.

    Attributes:
        case: Name of the case.
        suites: Suites that must contain the case.
        reason: Reason of the last change.
        claims: Claims that were judged.
        stress_tests: Stress tests that were made.
    """

    case: str
    suites: tuple[str, ...]
    reason: str
    claims: tuple[AcceptedClaim, ...] = ()
    stress_tests: tuple[StressTest, ...] = ()


@dataclass(frozen=True, kw_only=True, config=RECORD)
class Baseline:
    """All that was accepted of one case."""

    accepted: Accepted
    answers: tuple[Answer, ...]


_ACCEPTED: TypeAdapter[Accepted] = TypeAdapter(Accepted)


def stored_part(answer: Answer) -> Answer:
    """Return the part of an answer that a baseline stores: fields have stated errors but no values."""
    quantities = {name: replace(q, values=(), at=(0.0,)) if q.at else q for name, q in answer.quantities.items()}
    return Answer(
        case=answer.case,
        scene=answer.scene,
        method=answer.method,
        question=answer.question,
        quantities=quantities,
        unknowns=answer.unknowns,
        counters=answer.counters,
    )


def relative_tolerance(values: Values) -> float:
    """Return max(10 x measured relative spread, 1e-12)."""
    return max(OF_SPREAD * values.spread, SMALLEST_RELATIVE)


def permitted_change(values: Values, step: int) -> float:
    """Return the largest change of an accepted value that counts as equal, in its unit."""
    stated = values.error[step] if values.error else 0.0
    size = max(abs(values.values[step]), values.scale)
    return max(relative_tolerance(values) * size, OF_STATED_ERROR * stated)


def write_baseline(folder: Path, baseline: Baseline) -> None:
    """Write the file of ``baseline``, whole or not at all; only ``accept`` calls this."""
    folder.mkdir(parents=True, exist_ok=True)
    first = _ACCEPTED.dump_json(baseline.accepted, exclude_defaults=True).decode() + "\n"
    lines = (answer.line() for answer in sorted(baseline.answers, key=lambda answer: answer.identity))
    write_whole(folder / f"{baseline.accepted.case}.jsonl", first + "".join(lines))


def read_baselines(folder: Path) -> tuple[Baseline, ...]:
    """Return every baseline in ``folder``, ordered by case; none if there is no folder.

    Raises:
        InvalidInput: If a file is damaged, or lies under another name than that of its case.
    """
    return tuple(_read(path) for path in sorted(folder.glob("*.jsonl")))


def _read(path: Path) -> Baseline:
    """The baseline in a file, whose name is that of the case."""
    first = path.read_bytes().partition(b"\n")[0]
    accepted = validated(_ACCEPTED, first, place=f"{path}, line 1", remedy=REMEDY)
    answers = tuple(read_answers(path, skip=1))
    if wrong := {accepted.case, *(answer.case for answer in answers)} - {path.stem}:
        raise InvalidInput(f"{path} has answers of {wrong.pop()}; {REMEDY}")
    return Baseline(accepted=accepted, answers=answers)
