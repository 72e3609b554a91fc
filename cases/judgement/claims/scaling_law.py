"""An invariance: the scene is changed in a way whose effect on the answer is known without solving anything."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import ClassVar

from cases.declare.case import Case
from cases.declare.task import Answers, Task
from cases.judgement.claims.declared import PerMethod, first_missing
from cases.judgement.rules.invariant import judge_invariant
from cases.judgement.rules.judgement import Judgement, nothing_compared, worst_judgement
from cases.results.records import Claim, Kind, SceneRun
from cases.results.status import Status
from contact import Scene


@dataclass(frozen=True, kw_only=True)
class Twin(PerMethod):
    """The changed scene gives the same answer times known factors.

    Attributes:
        change: from the scene to its twin.
        factors: expected twin over original, by name of the quantity.
    """

    kind: ClassVar[Kind] = Kind.INVARIANT

    change: Callable[[Scene], Scene]
    factors: Mapping[str, float]

    def tasks(self, case: Case) -> Iterable[Task]:
        """Return the twins to solve."""
        for scene in self.scenes_of(case):
            for label in self.labels(case, scene):
                yield self._twin(case.task(scene, case.use(scene, label)))

    def judge(self, case: Case, answers: Answers) -> Iterator[Claim]:
        """Judge each scene and method by its worst quantity and step."""
        for scene in self.scenes_of(case):
            for label in self.labels(case, scene):
                task = case.task(scene, case.use(scene, label))
                original, twin = answers.of(task), answers.of(self._twin(task))
                tolerance = self.tolerance_of(label)
                judged = first_missing(original, twin) or self._judged(original, twin, tolerance)
                yield self.record(judged, scene.name, (label,), tolerance=tolerance)

    def _twin(self, task: Task) -> Task:
        return task.changed(self.name, problem=self.change(task.problem))

    def _judged(self, original: SceneRun, twin: SceneRun, tolerance: float) -> Judgement:
        residuals: list[float] = []
        for name, factor in self.factors.items():
            a, b = original.quantity(name), twin.quantity(name)
            if len(a.values) != len(b.values):
                return nothing_compared(Status.INCOMPARABLE, f"the twin has {len(b.values)} steps of {name}")
            residuals += [(y - factor * x) / (factor * a.scale) for x, y in zip(a.values, b.values, strict=True)]
        return worst_judgement([judge_invariant(residual, tolerance=tolerance) for residual in residuals])
