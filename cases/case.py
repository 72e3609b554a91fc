"""A case is a short paper that is also a test: scenes, methods, claims. Nothing here solves anything."""

from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

from cases.answers import Identity, Table
from cases.declare.methods import HOW_TO_ADD, MethodUse
from cases.norms import RingQuadrature, ring_quadrature
from cases.verdicts import Scalar, Verdict
from contact import InvalidInput, Method, Scene

# Suites that every case is in unless it says otherwise, and that of outside solvers.
USUAL_SUITES = ("ci", "nightly")
SUITES = (*USUAL_SUITES, "referees")


@dataclass(frozen=True, kw_only=True)
class Sampling:
    """Fields of an answer that a run records in addition to its quantities.

    Attributes:
        ring_edges: Radii [m] between rings, at whose Gauss nodes the pressure of the last step is recorded; empty
            records no pressure.
        inside: Points of the layer at which fields of the last step are recorded: r over the contact radius, z over the
            smaller of contact radius and thickness; empty records none.
        laws: Whether the laws of elastic bodies are checked on these fields.
    """

    ring_edges: tuple[float, ...] = ()
    inside: tuple[tuple[float, float], ...] = ()
    laws: bool = True

    @property
    def rings(self) -> RingQuadrature:
        """Gauss nodes and weights on the rings."""
        return ring_quadrature(self.ring_edges)


@dataclass(frozen=True, kw_only=True)
class CaseScene:
    """A scene of a case.

    Attributes:
        name: Unique within the case.
        parameters: Parameters that distinguish the scene, for tables and figures.
        scene: Contact problem that is solved.
        sampling: Fields that are recorded from each answer.
        methods: Methods that solve the scene; empty for those of the case.
        nightly: Labels of the methods that take too long for the suite "ci".
    """

    name: str
    parameters: dict[str, Scalar]
    scene: Scene
    sampling: Sampling = field(default_factory=Sampling)
    methods: tuple[MethodUse, ...] = ()
    nightly: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Task:
    """One method on one scene of a case, or on a variant of it.

    Attributes:
        case: Name of the case.
        scene: Name of the scene within the case.
        variant: "" for the scene itself, else what was changed ("doubled E", "grid nodes=8").
        use: Method with its requested settings, under its label in the case.
        problem: Scene that is solved.
        refined: Number of refinements of the method before it solves.
        sampling: Fields that are recorded.
        timed: Whether the solution is repeated to measure its time, alone on the machine.
        first: Whether the cost of a first solution is measured: after imports, with empty caches.
        measure: Function of method and scene that returns fields of the `Answer`, in place of a solution.
    """

    case: str
    scene: str
    variant: str = ""
    use: MethodUse
    problem: Scene
    refined: int = 0
    sampling: Sampling = field(default_factory=Sampling)
    timed: bool = False
    first: bool = False
    measure: Callable[[Method, Scene], Mapping[str, Any]] | None = None

    @property
    def identity(self) -> Identity:
        """Case, scene, method and variant: unique within a run."""
        return self.case, self.scene, self.use.label, self.variant

    @property
    def label(self) -> str:
        """The identity in words."""
        return " / ".join(part for part in (self.case, self.scene, self.variant, self.use.label) if part)

    def changed(self, variant: str, problem: Scene | None = None, **more: Any) -> "Task":
        """Return a variant of this task: another scene, other settings, or both."""
        return replace(self, variant=variant, problem=problem or self.problem, **more)


@dataclass(frozen=True, kw_only=True)
class Case:
    """A question, the scenes that answer it, the methods that solve them and what is claimed of the answers.

    Attributes:
        name: Unique; letters, digits and underscores.
        title: One line.
        question: Question that the case answers.
        equations: Equations of the source.
        text: The paper's body: set-up, what to expect and why.
        suites: "ci" (minutes) and "nightly"; "referees" runs outside solvers.
        scenes: Scenes, solved by every method unless they name their own.
        methods: Compared methods.
        claims: Claims, and studies of what is measured (`cases.claims.Study`).
        restricted: Whether methods or claims were removed; such a case may have no claims.
    """

    name: str
    title: str
    question: str
    equations: tuple[str, ...]
    text: str
    suites: tuple[str, ...] = USUAL_SUITES
    scenes: tuple[CaseScene, ...]
    methods: tuple[MethodUse, ...]
    claims: tuple[Any, ...]
    restricted: bool = False

    def __post_init__(self) -> None:
        """Refuse a case that would check less than it states."""
        if not self.name.replace("_", "").isalnum():
            raise InvalidInput(f"case name {self.name!r}: use letters, digits and underscores")
        if unknown := set(self.suites) - set(SUITES):
            raise InvalidInput(f"case {self.name}: suite {unknown.pop()!r} is none of {', '.join(SUITES)}")
        if self.restricted:
            return
        for what in ("scenes", "claims", "methods", "question", "title", "text"):
            # A stress test brings scenes of its own.
            if not getattr(self, what) and (what != "scenes" or next(self.tasks(), None) is None):
                raise InvalidInput(f"case {self.name}: {what} is empty; a case without it checks nothing")
        for what, names in (
            ("scenes", [s.name for s in self.scenes]),
            ("claims", [c.name for c in self.claims]),
            ("methods", [m.label for m in self.methods]),
        ):
            if twice := sorted({name for name in names if names.count(name) > 1}):
                raise InvalidInput(f"case {self.name}: {what}: {twice[0]!r} stands twice; names must be unique")
        for scene in self.scenes:
            for label in scene.nightly:
                self.use(scene, label)
        for claim in self.claims:
            claim.check(self)

    @cached_property
    def by_name(self) -> Mapping[str, CaseScene]:
        """The scenes by name."""
        return {scene.name: scene for scene in self.scenes}

    def scene(self, name: str) -> CaseScene:
        """Return the scene called ``name``.

        Raises:
            InvalidInput: If the case has none of that name.
        """
        if name not in self.by_name:
            raise InvalidInput(f"case {self.name} has no scene {name!r}; it has {', '.join(self.by_name)}")
        return self.by_name[name]

    def methods_of(self, scene: CaseScene) -> tuple[MethodUse, ...]:
        """Return the methods that solve ``scene``."""
        return scene.methods or self.methods

    def use(self, scene: CaseScene, label: str) -> MethodUse:
        """Return the method labelled ``label`` that solves ``scene``.

        Raises:
            InvalidInput: If no such method does.
        """
        for use in self.methods_of(scene):
            if use.label == label:
                return use
        raise InvalidInput(f"case {self.name}: no method {label!r} solves {scene.name!r}")

    def task(self, scene: CaseScene, use: MethodUse) -> Task:
        """Return the task of one method on one scene."""
        return Task(case=self.name, scene=scene.name, use=use, problem=scene.scene, sampling=scene.sampling)

    def tasks(self) -> Iterator[Task]:
        """Yield every scene by every method, then the tasks of each claim; several claims may need the same task."""
        for scene in self.scenes:
            yield from (self.task(scene, use) for use in self.methods_of(scene))
        for claim in self.claims:
            yield from claim.tasks(self)

    @property
    def costs(self) -> tuple[Any, ...]:
        """The studies of cost."""
        return tuple(claim for claim in self.claims if claim.timed)

    def verdicts(self, answers: Table) -> list[Verdict]:
        """Judge the claims whose answers are present."""
        return [verdict for claim in self.claims for verdict in claim.judge(self, answers)]

    def only(self, keep: Callable[[CaseScene, MethodUse], bool]) -> "Case":
        """Return the case with the methods on each scene for which ``keep`` is true, without scenes that have none."""
        uses = {s.name: tuple(use for use in self.methods_of(s) if keep(s, use)) for s in self.scenes}
        scenes = tuple(replace(s, methods=uses[s.name], nightly=()) for s in self.scenes if uses[s.name])
        return replace(self, scenes=scenes, restricted=True)

    def in_suite(self, suite: str) -> "Case":
        """Return the case as ``suite`` runs it: nightly as a whole, ci without methods and claims that take long.

        Without a suite each scene keeps its ``nightly`` methods; studies of cost and effects are those of ci.
        """
        claims = tuple(study for claim in self.claims if (study := claim.in_suite(suite)) is not None)
        if suite != "ci":
            return replace(self, claims=claims)
        restricted = replace(self, claims=claims, restricted=True)
        return restricted.only(lambda scene, use: use.label not in scene.nightly)

    def only_methods(self, wanted: Collection[str]) -> "Case":
        """Return the case with the wanted methods alone and without studies of cost; unchanged if none is wanted.

        Raises:
            InvalidInput: If the case has none of the methods.
        """
        if not wanted:
            return self
        methods = tuple(use for use in self.methods if use.label in wanted)
        if not methods:
            known = ", ".join(use.label for use in self.methods)
            raise InvalidInput(f"case {self.name} has no method {' or '.join(wanted)}; it has {known}; {HOW_TO_ADD}")
        restricted = self.only(lambda _, use: use.label in wanted)
        return replace(restricted, methods=methods, claims=tuple(claim for claim in self.claims if not claim.timed))

    def nightly_only(self) -> frozenset[tuple[str, str]]:
        """Return the scenes and methods that only the nightly suite solves."""
        return frozenset((scene.name, label) for scene in self.scenes for label in scene.nightly)
