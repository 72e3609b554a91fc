"""A run: its cases in words, its answers, its verdicts and studies, and where it was made.

On disk a folder: ``answers.jsonl`` holds the answers, one per line (`cases.answers`), ``run.json`` all the rest.
"""

from dataclasses import dataclass as plain
from dataclasses import field
from pathlib import Path

from pydantic import TypeAdapter
from pydantic.dataclasses import dataclass

from cases.answers import NAME, Table, read_answers
from cases.files import read_record
from cases.studies import Convergence, CostOfAccuracy, Effect, StressTest
from cases.verdicts import RECORD, Kind, Mapping, NotNegative, Status, Verdict
from contact import InvalidInput
from contact.files.whole import write_whole

RUN = "run.json"
REMEDY = "run the cases again (with --resume finished solutions are kept)"


@dataclass(frozen=True, kw_only=True, config=RECORD)
class Stamp:
    """Where and with what a run was made.

    Attributes:
        started: UTC, ISO 8601.
        wall_seconds: Duration of the run.
        revision: Commit of the source; "unknown" outside a repository.
        dirty: Whether the working tree had changes.
        python: Version.
        platform: Operating system and machine.
        processor: Model name.
        cores: Processors this run could use.
        threads: Threads of each numerical library really loaded, by name ("openblas 0.3.27 Haswell": 1).
        versions: Versions of the packages computed with.
    """

    started: str
    wall_seconds: NotNegative
    revision: str
    dirty: bool
    python: str
    platform: str
    processor: str
    cores: int
    threads: dict[str, int]
    versions: dict[str, str]


@dataclass(frozen=True, kw_only=True, config=RECORD)
class CaseText:
    """Text of a case for its page; ``scenes`` has the parameters of each scene by name."""

    name: str
    title: str
    question: str
    equations: str = ""
    text: str = ""
    scenes: dict[str, Mapping] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True, config=RECORD)
class Judged:
    """A run without its answers; ``complete`` is False if it was interrupted, and its records are valid all the same.

    ``methods`` are those chosen on the command line; empty if every case was solved by its own methods.
    """

    suite: str = ""
    methods: tuple[str, ...] = ()
    complete: bool = True
    stamp: Stamp
    cases: tuple[CaseText, ...] = ()
    verdicts: tuple[Verdict, ...] = ()
    convergence: tuple[Convergence, ...] = ()
    costs: tuple[CostOfAccuracy, ...] = ()
    stress_tests: tuple[StressTest, ...] = ()
    effects: tuple[Effect, ...] = ()


_JUDGED: TypeAdapter[Judged] = TypeAdapter(Judged)


@plain(frozen=True, kw_only=True)
class Run:
    """A run with its answers."""

    judged: Judged
    answers: Table

    @property
    def statuses(self) -> tuple[Status, ...]:
        """Every status that counts: of verdicts, and of answers on the scenes of cases themselves."""
        of_answers = (answer.status for answer in self.answers if not answer.variant)
        return (*of_answers, *(verdict.status for verdict in self.judged.verdicts))

    @property
    def unjudged(self) -> tuple[str, ...]:
        """The chosen methods about which no claim was judged; numbers accepted earlier are no claim."""
        return self.unjudged_in("")

    def unjudged_in(self, case: str) -> tuple[str, ...]:
        """Return the chosen methods about which no claim of a case (of any, if none is named) was judged."""
        judged_labels = {
            label
            for verdict in self.judged.verdicts
            if verdict.kind is not Kind.REGRESSION and verdict.status is not Status.SKIP
            if not case or verdict.case == case
            for label in verdict.methods
        }
        return tuple(label for label in self.judged.methods if label not in judged_labels)


def write_run(run: Judged, folder: Path) -> None:
    """Write ``run.json``, completely or not at all; the answers are in the same folder already."""
    folder.mkdir(parents=True, exist_ok=True)
    write_whole(folder / RUN, _JUDGED.dump_json(run, indent=1, exclude_defaults=True))


def read_run(folder: Path) -> Run:
    """Return the run in a folder.

    Raises:
        InvalidInput: If there is none, or it cannot be read, in one line.
    """
    if not (folder / RUN).is_file():
        raise InvalidInput(f"no {RUN} in {folder}; give the directory of a finished run")
    answers = folder / NAME
    table = Table(read_answers(answers) if answers.is_file() else ())
    return Run(judged=read_record(_JUDGED, folder / RUN, remedy=REMEDY), answers=table)
