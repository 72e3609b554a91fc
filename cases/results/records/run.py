"""A whole run: its cases with all their records, and where it was made.

A non-finite number cannot be stored: what could not be computed is ``None`` beside a status that says why.
"""

from collections.abc import Iterable
from dataclasses import field
from typing import Literal

from pydantic.dataclasses import dataclass

from cases.results.records.claim import Claim, Kind
from cases.results.records.convergence import ConvergenceStudy
from cases.results.records.cost import EffectEntry, WorkPrecision
from cases.results.records.field_types import RECORD, Mapping, NotNegative
from cases.results.records.figure import Figure
from cases.results.records.reliability import Ladder
from cases.results.records.scene_run import SceneRun
from cases.results.status import Status, worst

# Files of another version are refused.
SCHEMA_VERSION = 2


@dataclass(frozen=True, kw_only=True, config=RECORD)
class SceneDescription:
    """A scene of a case: its name, the parameters that set it apart, and the scene itself as canonical JSON."""

    name: str
    parameters: Mapping
    canonical: str


@dataclass(frozen=True, kw_only=True, config=RECORD)
class CaseResult:
    """A case: its text, what each method answered, and how its claims ended."""

    name: str
    title: str
    question: str
    equations: tuple[str, ...]
    text: str
    scenes: tuple[SceneDescription, ...]
    runs: tuple[SceneRun, ...]
    claims: tuple[Claim, ...]
    convergence: tuple[ConvergenceStudy, ...] = ()
    work_precision: tuple[WorkPrecision, ...] = ()
    effects: tuple[EffectEntry, ...] = ()
    ladders: tuple[Ladder, ...] = ()
    figures: tuple[Figure, ...] = ()

    @property
    def status(self) -> Status:
        """The status that decides for this case, of claims and of solutions that broke down; SKIP if there is none."""
        broken = [run.status for run in self.runs if run.status.is_failure]
        measured = [Status.PASS] if self.work_precision and not self.claims else []
        return worst([claim.status for claim in self.claims] + broken + measured)

    def unjudged(self, methods: Iterable[str]) -> tuple[str, ...]:
        """Return those of ``methods`` about which no claim was judged; numbers accepted earlier are no claim."""
        claims = (claim for claim in self.claims if claim.kind is not Kind.REGRESSION)
        judged = {method for claim in claims if claim.status is not Status.SKIP for method in claim.methods}
        return tuple(method for method in methods if method not in judged)


@dataclass(frozen=True, kw_only=True, config=RECORD)
class Stamp:
    """Where and with what a run was made.

    Attributes:
        started: UTC, ISO 8601.
        wall_seconds: duration of the run.
        revision: commit of the source; "unknown" outside a repository.
        dirty: whether the working tree had changes.
        python: version.
        platform: operating system and machine.
        processor: model name.
        cores: processors this run could use.
        threads: threads of each numerical library really loaded, by name ("openblas 0.3.27 Haswell": 1).
        versions: of the packages computed with.
        mesh_hashes: by case, scene and method.
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
    mesh_hashes: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True, config=RECORD)
class RunResult:
    """A whole run; ``complete`` is False when it was interrupted, and its records are valid all the same.

    Its ``methods`` are those that were chosen; none if the cases were solved by their own.
    """

    schema_version: Literal[2] = 2
    suite: str
    methods: tuple[str, ...] = ()
    complete: bool
    stamp: Stamp
    cases: tuple[CaseResult, ...]

    def case(self, name: str) -> CaseResult:
        """Return the case called ``name``.

        Raises:
            KeyError: if the run has none of that name.
        """
        return {case.name: case for case in self.cases}[name]

    @property
    def unjudged(self) -> tuple[str, ...]:
        """The chosen methods about which no claim was judged in any case."""
        left = self.methods
        for case in self.cases:
            left = case.unjudged(left)
        return left

    @property
    def statuses(self) -> tuple[Status, ...]:
        """Every status of the run: of solutions and of claims."""
        runs = [run.status for case in self.cases for run in case.runs]
        claims = [claim.status for case in self.cases for claim in case.claims]
        return tuple(runs + claims)
