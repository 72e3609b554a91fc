"""An invariance: the scene is changed in a way whose effect on the answer is known without solving anything."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import ClassVar

from cases.declare.case import Case
from cases.declare.task import Answers, Task
from cases.judgement.claims.declared import PerMethod, first_missing
from cases.judgement.rules.invariant import judge_invariant
from cases.judgement.rules.judgement import Judgement, nothing_compared, worst_judgement
from cases.results.records.claim import Claim, Kind
from cases.results.records.scene_run import SceneRun
from cases.results.status import Status
from contact import Scene


@dataclass(frozen=True, kw_only=True)
class ScalingLaw(PerMethod):
    """The changed scene gives the same answer times known factors.

    Attributes:
        change: from the scene to the one with a known answer.
        factors: expected answer of the changed scene over that of the original, by name of the quantity.
    """

    kind: ClassVar[Kind] = Kind.INVARIANT

    change: Callable[[Scene], Scene]
    factors: Mapping[str, float]

    def tasks(self, case: Case) -> Iterable[Task]:
        """Return the changed scenes to solve."""
        for scene in self.scenes_of(case):
            for label in self.labels(case, scene):
                yield self._changed(case.task(scene, case.use(scene, label)))

    def judge(self, case: Case, answers: Answers) -> Iterator[Claim]:
        """Judge each scene and method by its worst quantity and step."""
        for scene, label, original, tolerance in self.answered(case, answers):
            changed = answers.of(self._changed(case.task(scene, case.use(scene, label))))
            judged = first_missing(original, changed) or self._judged(original, changed, tolerance)
            identity = self.identity(scene, (label,))
            yield self.record(judged, scene.name, (label,), tolerance=tolerance, identity=identity)

    def _changed(self, task: Task) -> Task:
        return task.changed(self.name, problem=self.change(task.problem))

    def _judged(self, original: SceneRun, changed: SceneRun, tolerance: float) -> Judgement:
        residuals: list[float] = []
        for name, factor in self.factors.items():
            a, b = original.quantity(name), changed.quantity(name)
            if len(a.values) != len(b.values):
                return nothing_compared(Status.INCOMPARABLE, f"the changed scene has {len(b.values)} steps of {name}")
            residuals += [(y - factor * x) / (factor * a.scale) for x, y in zip(a.values, b.values, strict=True)]
        return worst_judgement([judge_invariant(residual, tolerance=tolerance) for residual in residuals])
