"""An answer is the result of one method on one scene. Store, result and baseline are files of one answer per line."""

import json
from collections.abc import Iterable, Iterator
from dataclasses import field
from pathlib import Path
from typing import Self, TypeAlias

from pydantic import TypeAdapter, model_validator
from pydantic.dataclasses import dataclass

from cases.files import validated
from cases.verdicts import RECORD, Mapping, NotNegative, Positive, Status, Vector

NAME = "answers.jsonl"
# Case, scene, method, variant: unique within a run.
Identity: TypeAlias = tuple[str, str, str, str]


@dataclass(frozen=True, kw_only=True, config=RECORD)
class Values:
    """A quantity along the steps of the loading, or a field at points.

    Attributes:
        unit: SI unit, "1" for a ratio.
        scale: Positive value, same unit, by which errors are divided, so that a zero crossing does no harm.
        values: Shape (n,).
        error: Stated error. Quantities: absolute, shape (n,). Fields: a single number, relative in the field's norm.
            Empty where the method states none.
        at: Radii or numbers of the points of a field, shape (n,); empty for a quantity.
        spread: Largest relative difference between answers that should be equal, in a baseline.
    """

    unit: str
    scale: Positive
    values: Vector
    error: tuple[NotNegative, ...] = ()
    at: Vector = ()
    spread: NotNegative = 0.0

    @model_validator(mode="after")
    def _one_error_per_value(self) -> Self:
        wanted = 1 if self.at else len(self.values)
        if self.error and len(self.error) != wanted:
            raise ValueError(f"{len(self.error)} errors for {wanted} values; give one each")
        return self


@dataclass(frozen=True, kw_only=True, config=RECORD)
class Answer:
    """One method on one scene: PASS with quantities, or another status with its reason.

    Attributes:
        case: Name of the case.
        scene: Name of the scene within the case.
        method: Label of the method in the case.
        variant: "" for the scene itself, else what was changed ("doubling E doubles F", "grid nodes=8").
        question: Hash of the scene and of the requested settings; equal on every processor.
        code: Hash of the sources and versions that answered.
        status: PASS when solved.
        reason: Reason why it was not solved, one sentence.
        settings: Numerical settings that the answer reports.
        quantities: Quantities along the steps and fields at points (`Values.at`), by name.
        shared: Names of inputs (a flat-punch table, a kernel) that other methods may use as well.
        seconds: Processor time of the solution [s].
        wall_seconds: Duration of the solution [s].
        memory: Peak memory [bytes].
        unknowns: Number of unknowns of its largest system.
        counters: Factorisations, iterations, steps.
        samples: Seconds of each repeated solution of a timed task.
        cold_seconds: First solution of a timed task, with empty caches.
        notes: Remarks of the method.
    """

    case: str
    scene: str
    method: str
    variant: str = ""
    question: str = ""
    code: str = ""
    status: Status = Status.PASS
    reason: str = ""
    settings: Mapping = field(default_factory=dict)
    quantities: dict[str, Values] = field(default_factory=dict)
    shared: tuple[str, ...] = ()
    seconds: NotNegative = 0.0
    wall_seconds: NotNegative = 0.0
    memory: int = 0
    unknowns: int = 0
    counters: dict[str, int] = field(default_factory=dict)
    samples: tuple[NotNegative, ...] = ()
    cold_seconds: NotNegative = 0.0
    notes: tuple[str, ...] = ()

    @property
    def identity(self) -> Identity:
        """Case, scene, method and variant: unique within a run."""
        return self.case, self.scene, self.method, self.variant

    @property
    def solved(self) -> bool:
        """Whether the method gave an answer with quantities."""
        return self.status is Status.PASS

    def line(self) -> str:
        """The answer as one line of JSON: sorted keys, every digit; defaults are left out."""
        tree = _ANSWER.dump_python(self, mode="json", exclude_defaults=True)
        return json.dumps(tree, sort_keys=True, allow_nan=False) + "\n"


_ANSWER: TypeAdapter[Answer] = TypeAdapter(Answer)


class Table:
    """Answers by identity; the later of two with the same identity counts."""

    def __init__(self, answers: Iterable[Answer] = ()) -> None:
        self._answers = {answer.identity: answer for answer in answers}

    def __iter__(self) -> Iterator[Answer]:
        return iter(self._answers.values())

    def __len__(self) -> int:
        return len(self._answers)

    def get(self, identity: Identity) -> Answer | None:
        """Return the answer of that identity; None if there is none."""
        return self._answers.get(identity)

    def of_case(self, case: str) -> list[Answer]:
        """Return the answers of a case on its own scenes, without those on changed ones."""
        return [answer for answer in self if answer.case == case and not answer.variant]

    def rows(self) -> Iterator[dict[str, object]]:
        """The long table, one row per value: for CSV files, data frames and spreadsheets."""
        for answer in self:
            place = dict(zip(("case", "scene", "method", "variant"), answer.identity, strict=True))
            for name, q in answer.quantities.items():
                for step, value in enumerate(q.values):
                    error = q.error[step] if q.error and not q.at else None
                    yield {**place, "quantity": name, "step": step, "value": value, "unit": q.unit, "error": error}


def read_answers(path: Path, skip: int = 0) -> Iterator[Answer]:
    """Yield the answers of a file after ``skip`` lines, without an incomplete last line left by a killed writer.

    Raises:
        InvalidInput: Naming the file and the line that holds no answer.
    """
    for number, line in enumerate(path.read_bytes().splitlines(keepends=True)[skip:], skip + 1):
        if not line.endswith(b"\n"):
            return
        yield validated(_ANSWER, line, place=f"{path}, line {number}", remedy="delete the line and resume")
