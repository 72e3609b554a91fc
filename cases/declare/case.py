"""A case: a short paper that is also a test.  Pure description; nothing here solves anything."""

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Set
from dataclasses import dataclass, field
from typing import Any, Protocol, Self

from cases.declare.methods import MethodUse
from cases.declare.task import Answers, Sampling, Task
from cases.results.records.claim import Claim, Kind
from cases.results.records.field_types import Scalar
from cases.results.records.figure import Figure
from contact import InvalidInput, Scene

# Suites that every case is in unless it says otherwise, and that of the outside referees.
USUAL_SUITES = ("ci", "nightly")
SUITES = (*USUAL_SUITES, "referees")


class ClaimOfCase(Protocol):
    """What a case asks of its claims; `cases.judgement.claims.declared.DeclaredClaim` offers it."""

    @property
    def name(self) -> str:
        """Unique within the case."""

    @property
    def kind(self) -> Kind:
        """What is compared with what."""

    @property
    def quantity(self) -> str:
        """What is compared."""

    @property
    def tolerance(self) -> float:
        """Largest permitted error, relative."""

    @property
    def reason(self) -> Any:
        """Why it should hold (`cases.judgement.claims.declared.Reason`)."""

    @property
    def nightly(self) -> bool:
        """Whether it takes too long for the suite "ci"."""

    def scenes_of(self, case: "Case") -> tuple["CaseScene", ...]:
        """Return the scenes this claim speaks about."""

    def check(self, case: "Case") -> None:
        """Refuse scenes or methods that the case does not have."""

    def tasks(self, case: "Case") -> Iterable[Task]:
        """Return what must be solved beside the case's own scenes."""

    def left(self, case: "Case", solvers: Mapping[str, Set[str]]) -> tuple[Self, ...]:
        """Return the claim on what the labels in ``solvers``, by scene, still answer; nothing where they do not."""

    def judge(self, case: "Case", answers: Answers) -> Iterator[Claim]:
        """Judge the finished answers."""


class StudyOfCase(Protocol):
    """What a case asks of its studies: what each effect costs and moves."""

    def in_suite(self, suite: str) -> Self:
        """Return the study as a suite carries it out."""

    def left(self, solvers: Mapping[str, Set[str]]) -> Self:
        """Return the study with the labels that are left in ``solvers``, by scene."""

    def tasks(self, case: "Case") -> Iterator[Task]:
        """Return what must be solved."""

    def records(self, case: "Case", answers: Answers) -> Iterator[Any]:
        """Return what the finished answers say."""


class WorkOfCase(StudyOfCase, Protocol):
    """What a case asks of its studies of what accuracy costs."""

    @property
    def ladder(self) -> tuple[MethodUse, ...]:
        """Settings that are timed."""

    def of_methods(self, methods: Collection[str], foreign: Iterable[MethodUse] = ()) -> Self:
        """Return the study of these methods, and of ``foreign`` ones with their settings."""


@dataclass(frozen=True, kw_only=True)
class CaseScene:
    """A scene of a case.

    Attributes:
        name: unique within the case.
        parameters: what sets it apart, for tables and figures.
        scene: the problem.
        sampling: what is kept of each answer.
        methods: the methods that solve it; empty for those of the case.
        nightly: labels of those that take too long for the suite "ci".
    """

    name: str
    parameters: dict[str, Scalar]
    scene: Scene
    sampling: Sampling = field(default_factory=Sampling)
    methods: tuple[MethodUse, ...] = ()
    nightly: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Case:
    """A question, the scenes that answer it, the methods that solve them and what is claimed of the answers.

    Attributes:
        name: unique; letters, digits and underscores.
        title: one line.
        question: what a reader learns.
        equations: of the source.
        text: the paper's body: set-up, what to expect and why.
        suites: "ci" (minutes) and "nightly"; "referees" (minutes) asks solvers of others.
        scenes: solved by every method.
        methods: compared methods.
        claims: what must hold.
        work: what accuracy costs.
        ablations: what each effect, and the finite thickness, costs and moves.
        figures: drawn from the finished answers.
        restricted: whether only some of its methods are left; then nothing may be left to claim.
    """

    name: str
    title: str
    question: str
    equations: tuple[str, ...]
    text: str
    suites: tuple[str, ...] = USUAL_SUITES
    scenes: tuple[CaseScene, ...]
    methods: tuple[MethodUse, ...]
    claims: tuple[ClaimOfCase, ...]
    work: tuple[WorkOfCase, ...] = ()
    ablations: tuple[StudyOfCase, ...] = ()
    figures: tuple[Callable[["Case", Answers], Iterator[Figure]], ...] = field(default=())
    restricted: bool = False

    def __post_init__(self) -> None:
        """Refuse what would silently check less than it says."""
        if not self.name.replace("_", "").isalnum():
            raise InvalidInput(f"case name {self.name!r}: use letters, digits and underscores")
        _refuse_empty(self.name, question=self.question, title=self.title, text=self.text)
        _refuse_empty(self.name, scenes=self.scenes, methods=self.methods, claims=self.claims or self.restricted)
        _refuse_duplicates(f"case {self.name}: scenes", [s.name for s in self.scenes])
        _refuse_duplicates(f"case {self.name}: claims", [c.name for c in self.claims])
        _refuse_duplicates(f"case {self.name}: methods", [m.label for m in self.methods])
        for suite in self.suites:
            if suite not in SUITES:
                raise InvalidInput(f"case {self.name}: suite {suite!r} is none of {', '.join(SUITES)}")
        for scene in self.scenes:
            for label in scene.nightly:
                self.use(scene, label)
        for claim in self.claims:
            claim.check(self)

    def scene(self, name: str) -> CaseScene:
        """Return the scene called ``name``.

        Raises:
            InvalidInput: if the case has none of that name.
        """
        for scene in self.scenes:
            if scene.name == name:
                return scene
        raise InvalidInput(f"case {self.name} has no scene {name!r}; it has {', '.join(s.name for s in self.scenes)}")

    def methods_of(self, scene: CaseScene) -> tuple[MethodUse, ...]:
        """Return the methods that solve ``scene``."""
        return scene.methods or self.methods

    def task(self, scene: CaseScene, use: MethodUse) -> Task:
        """Return the task of one method on one scene."""
        return Task(
            case=self.name,
            scene=scene.name,
            method=use.label,
            problem=scene.scene,
            solver=use.build(),
            settings=use.settings,
            sampling=scene.sampling,
        )

    def use(self, scene: CaseScene, label: str) -> MethodUse:
        """Return the method labelled ``label`` that solves ``scene``.

        Raises:
            InvalidInput: if no such method does.
        """
        for use in self.methods_of(scene):
            if use.label == label:
                return use
        raise InvalidInput(f"case {self.name}: no method {label!r} solves {scene.name!r}")

    def tasks(self) -> Iterator[Task]:
        """All tasks: every scene by every method, then what claims and work studies need beside."""
        for scene in self.scenes:
            for use in self.methods_of(scene):
                yield self.task(scene, use)
        for claim in self.claims:
            yield from claim.tasks(self)
        for ablation in self.ablations:
            yield from ablation.tasks(self)
        yield from self.cost_tasks()

    def cost_tasks(self) -> Iterator[Task]:
        """The tasks of the work studies alone."""
        for study in self.work:
            yield from study.tasks(self)


def text_of(docstring: str | None) -> str:
    """Return the text of a case from the docstring of its module: everything after the first line."""
    return (docstring or "").partition("\n")[2].strip()


def _refuse_empty(case: str, **fields: object) -> None:
    for name, value in fields.items():
        if not value:
            raise InvalidInput(f"case {case}: {name} is empty; a case without it checks nothing")


def _refuse_duplicates(place: str, names: list[str]) -> None:
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise InvalidInput(f"{place}: {twice[0]!r} stands twice; names must be unique")
