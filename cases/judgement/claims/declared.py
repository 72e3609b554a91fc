"""What every claim states before anything is computed, and how its judgement becomes a record."""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Mapping, Set
from dataclasses import dataclass, field, replace
from typing import ClassVar, Self

from cases.declare.case import Case, CaseScene
from cases.declare.shared import in_common
from cases.declare.task import Answers, Task
from cases.judgement.rules.judgement import Judgement, nothing_compared
from cases.judgement.rules.tolerance import positive_tolerance
from cases.results.records.claim import Claim, Kind, Origin
from cases.results.records.scene_run import SceneRun
from cases.results.status import Status
from contact import InvalidInput

# On the half-space MDR on a table reads no table: it is MDR itself, by construction.
TABLE, NO_TABLE = "mdr_table", "on the half-space no table is read"


@dataclass(frozen=True, kw_only=True)
class Reason:
    """Why a claim should hold, where its expected number comes from, and how its tolerance was chosen.

    Attributes:
        because: why it should hold.
        derived_from: theory, then the numerical uncertainty, then ten times a measured spread; never today's result.
        origin: one of the four origins of an expected number.
        source: closed form, page and table, or method.
    """

    because: str
    derived_from: str
    origin: Origin
    source: str

    def __post_init__(self) -> None:
        """Refuse a reason that says nothing."""
        for what in ("because", "derived_from", "source"):
            if not getattr(self, what).strip():
                raise InvalidInput(f"{what} is empty; a claim states its reason, its tolerance's origin and its source")


@dataclass(frozen=True, kw_only=True)
class DeclaredClaim(ABC):
    """A claim of a case.

    Attributes:
        name: unique within the case.
        quantity: what is compared.
        tolerance: largest permitted error, relative.
        reason: why it should hold, and where its numbers come from.
        scenes: names of the scenes it speaks about; empty for all.
        expected_to_fail: reason, for a known failure that is tracked; empty otherwise.
        identities: of methods for which it holds by construction, by label: why; such checks are not counted.
        nightly: whether it takes too long for the suite "ci".
    """

    kind: ClassVar[Kind]

    name: str
    quantity: str
    tolerance: float
    reason: Reason
    scenes: tuple[str, ...] = ()
    expected_to_fail: str = ""
    identities: Mapping[str, str] = field(default_factory=dict)
    nightly: bool = False

    def __post_init__(self) -> None:
        """Refuse a claim without a reason, and a tolerance of the wrong sign."""
        positive_tolerance(self.tolerance)
        for what in ("name", "quantity"):
            if not getattr(self, what).strip():
                raise InvalidInput(f"claim {self.name!r}: {what} is empty; say what is claimed of what")

    def check(self, case: Case) -> None:
        """Refuse scenes or methods that the case does not have.

        Raises:
            InvalidInput: naming the first of them.
        """
        for scene in self.scenes_of(case):
            for label in self.labels(case, scene):
                case.use(scene, label)

    def scenes_of(self, case: Case) -> tuple[CaseScene, ...]:
        """Return the scenes this claim speaks about."""
        return tuple(case.scene(name) for name in self.scenes) or case.scenes

    @abstractmethod
    def labels(self, case: Case, scene: CaseScene) -> tuple[str, ...]:
        """Return the labels of the methods compared on ``scene``."""

    def tasks(self, case: Case) -> Iterable[Task]:
        """Return what must be solved beside the case's own scenes."""
        return ()

    def left(self, case: Case, solvers: Mapping[str, Set[str]]) -> tuple[Self, ...]:
        """Return the claim on the scenes whose methods are all left in ``solvers``; nothing where no scene is."""
        return self._on(
            scene.name for scene in self.scenes_of(case) if solvers[scene.name] >= set(self.labels(case, scene))
        )

    def _on(self, scenes: Iterable[str]) -> tuple[Self, ...]:
        names = tuple(scenes)
        return (replace(self, scenes=names),) if names else ()

    @abstractmethod
    def judge(self, case: Case, answers: Answers) -> Iterator[Claim]:
        """Judge the finished answers, one record a scene and method."""

    def shared(self, case: Case, first: SceneRun, second: SceneRun) -> tuple[str, ...]:
        """Return what both answers rest on: their agreement says nothing about it."""
        return in_common(first.shared_inputs, second.shared_inputs, quantity=self.quantity, case=case.name)

    def identity(self, scene: CaseScene, labels: Iterable[str]) -> str:
        """Return why the comparison cannot fail on ``scene``, empty where it can."""
        known = {TABLE: NO_TABLE} if scene.scene.layer.is_half_space else {}
        return next((why[label] for why in (self.identities, known) for label in labels if label in why), "")

    def record(
        self,
        judgement: Judgement,
        scene: str,
        methods: tuple[str, ...],
        *,
        expected: float | None = None,
        uncertainty: Mapping[str, float] | None = None,
        shared: tuple[str, ...] = (),
        tolerance: float = 0.0,
        identity: str = "",
    ) -> Claim:
        """Return the record of a judgement."""
        status, message = self._declared(judgement)
        return judgement.claim(
            self.name,
            kind=self.kind,
            scene=scene,
            methods=methods,
            quantity=self.quantity,
            status=status,
            expected=expected,
            tolerance=tolerance or self.tolerance,
            uncertainty=dict(uncertainty or {}),
            origin=self._origin(shared),
            source=self.reason.source,
            because=self.reason.because,
            derived_from=self.reason.derived_from,
            shared_inputs=shared,
            message=message,
            identity=identity,
        )

    def _origin(self, shared: tuple[str, ...]) -> Origin:
        """Return the declared origin; a method is independent only where nothing is shared."""
        independent = self.reason.origin is Origin.INDEPENDENT_METHOD
        return Origin.RELATED_METHOD if independent and shared else self.reason.origin

    def _declared(self, judgement: Judgement) -> tuple[Status, str]:
        """Turn a declared failure into XFAIL, and its unexpected success into XPASS."""
        if not self.expected_to_fail or judgement.status not in (Status.PASS, Status.FAIL):
            return judgement.status, judgement.message
        status = Status.XPASS if judgement.status is Status.PASS else Status.XFAIL
        return status, f"{judgement.message} (declared to fail: {self.expected_to_fail})"


@dataclass(frozen=True, kw_only=True)
class PerMethod(DeclaredClaim, ABC):
    """A claim about single methods.

    Attributes:
        methods: their labels; empty for every method of the case.
        tolerances: of methods that need another one than ``tolerance``.
    """

    methods: tuple[str, ...] = ()
    tolerances: Mapping[str, float] = field(default_factory=dict)

    def labels(self, case: Case, scene: CaseScene) -> tuple[str, ...]:
        """Return the labels of the methods that solve ``scene``, of those that are named if any are."""
        solving = tuple(use.label for use in case.methods_of(scene))
        return tuple(label for label in self.methods if label in solving) if self.methods else solving

    def check(self, case: Case) -> None:
        """Refuse unknown scenes, and named methods that solve none of the claim's scenes.

        Raises:
            InvalidInput: naming the first of them.
        """
        scenes = self.scenes_of(case)
        solving = {label for scene in scenes for label in self.labels(case, scene)}
        for label in self.methods:
            if label not in solving:
                case.use(scenes[0], label)

    def left(self, case: Case, solvers: Mapping[str, Set[str]]) -> tuple[Self, ...]:
        """Return the claim on the scenes where a method is left, with the named methods that are left on any."""
        scenes = [s.name for s in self.scenes_of(case) if not solvers[s.name].isdisjoint(self.labels(case, s))]
        methods = tuple(label for label in self.methods if any(label in solvers[name] for name in scenes))
        return tuple(replace(claim, methods=methods) for claim in self._on(scenes))

    def answered(self, case: Case, answers: Answers) -> Iterator[tuple[CaseScene, str, SceneRun, float]]:
        """Return scene, label, answer and tolerance of every method on every scene."""
        for scene in self.scenes_of(case):
            for label in self.labels(case, scene):
                run = answers.of(case.task(scene, case.use(scene, label)))
                yield scene, label, run, self.tolerance_of(label)

    def tolerance_of(self, label: str) -> float:
        """Return the tolerance of one method."""
        return positive_tolerance(self.tolerances.get(label, self.tolerance))


def missing(run: SceneRun, quantity: str = "") -> Judgement | None:
    """Return why ``run`` cannot be compared (in ``quantity``, where one is named), or None when it has numbers."""
    if not run.solved:
        return nothing_compared(run.status, f"{run.method}: {run.reason}")
    if quantity and quantity not in {found.name for found in run.quantities}:
        return nothing_compared(Status.SKIP, f"{run.method} gives no {quantity.replace('_', ' ')}")
    return None


def first_missing(*runs: SceneRun, quantity: str = "") -> Judgement | None:
    """Return why the first of ``runs`` without numbers (of ``quantity``) cannot be compared, or None."""
    return next((judged for run in runs if (judged := missing(run, quantity)) is not None), None)
