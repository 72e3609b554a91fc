"""A scene and a changed one: known factors between their answers, or one that bounds the other."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import ClassVar

from cases.declare.case import Case, CaseScene
from cases.declare.task import Answers, Task
from cases.judgement.claims.declared import PerMethod, first_missing
from cases.judgement.rules.invariant import judge_invariant
from cases.judgement.rules.judgement import Judgement, nothing_compared, worst_judgement
from cases.results.records.claim import Claim, Kind
from cases.results.records.scene_run import SceneRun
from cases.results.status import Status
from contact import Scene


@dataclass(frozen=True, kw_only=True)
class ChangedScene(PerMethod, ABC):
    """A claim on an answer and on that of the changed scene.

    Attributes:
        change: from the scene to the other one.
    """

    kind: ClassVar[Kind] = Kind.INVARIANT

    change: Callable[[Scene], Scene]

    def tasks(self, case: Case) -> Iterable[Task]:
        """Return the changed scenes to solve."""
        for scene in self.scenes_of(case):
            for label in self.labels(case, scene):
                yield self._changed(case, scene, label)

    def judge(self, case: Case, answers: Answers) -> Iterator[Claim]:
        """Judge each scene and method by its worst quantity and step."""
        for scene, label, run, tolerance in self.answered(case, answers):
            other = answers.of(self._changed(case, scene, label))
            judged = first_missing(run, other) or self.judged(scene, run, other, tolerance)
            holds_anyway = self.holds_anyway(scene, label)
            yield self.record(judged, scene.name, (label,), tolerance=tolerance, identity=holds_anyway)

    @abstractmethod
    def judged(self, scene: CaseScene, run: SceneRun, other: SceneRun, tolerance: float) -> Judgement:
        """Judge one answer and that of the changed scene."""

    def holds_anyway(self, scene: CaseScene, label: str) -> str:
        """Return why the claim cannot fail for a method, empty where it can."""
        return ""

    def _changed(self, case: Case, scene: CaseScene, label: str) -> Task:
        task = case.task(scene, case.use(scene, label))
        return task.changed(self.name, problem=self.change(task.problem))


@dataclass(frozen=True, kw_only=True)
class ScalingLaw(ChangedScene):
    """The changed scene gives the same answer times known factors, without solving anything.

    Attributes:
        factors: expected answer of the changed scene over that of the original, by name of the quantity.
    """

    factors: Mapping[str, float]

    def judged(self, scene: CaseScene, run: SceneRun, other: SceneRun, tolerance: float) -> Judgement:
        """Judge the residuals of all quantities and steps."""
        residuals: list[float] = []
        for name, factor in self.factors.items():
            a, b = run.quantity(name), other.quantity(name)
            if len(a.values) != len(b.values):
                return nothing_compared(Status.INCOMPARABLE, f"the changed scene has {len(b.values)} steps of {name}")
            residuals += [(y - factor * x) / (factor * a.scale) for x, y in zip(a.values, b.values, strict=True)]
        return worst_judgement([judge_invariant(residual, tolerance=tolerance) for residual in residuals])

    def holds_anyway(self, scene: CaseScene, label: str) -> str:
        """Return why the law holds by construction."""
        return self.identity(scene, (label,))


@dataclass(frozen=True, kw_only=True)
class NeverBelow(ChangedScene):
    """At every step the quantity is at least that of the changed scene, but for the tolerance.

    Attributes:
        multiple: of the changed scene's values that bounds the quantity, of the scene; one where omitted.
        at_most: whether it bounds it from above.
    """

    multiple: Callable[[Scene], float] | None = None
    at_most: bool = False

    def judged(self, scene: CaseScene, run: SceneRun, other: SceneRun, tolerance: float) -> Judgement:
        """Judge what the quantity lacks."""
        absent = first_missing(run, other, quantity=self.quantity)
        if absent is not None:
            return absent
        multiple = 1.0 if self.multiple is None else self.multiple(scene.scene)
        values, bounds = run.quantity(self.quantity), other.quantity(self.quantity)
        steps = zip(values.values, bounds.values, strict=True)
        sign = -1.0 if self.at_most else 1.0
        lacking = (max(0.0, sign * (multiple * least - value)) / bounds.scale for value, least in steps)
        return worst_judgement([judge_invariant(share, tolerance=tolerance) for share in lacking])
