"""An inequality: the answer is at least, or at most, a multiple of that of a changed scene."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import ClassVar

from cases.declare.case import Case
from cases.declare.task import Answers, Task
from cases.judgement.claims.declared import PerMethod, first_missing
from cases.judgement.rules.invariant import judge_invariant
from cases.judgement.rules.judgement import Judgement, worst_judgement
from cases.results.records.claim import Claim, Kind
from cases.results.records.scene_run import SceneRun
from contact import Scene


@dataclass(frozen=True, kw_only=True)
class NeverBelow(PerMethod):
    """At every step the quantity is at least that of the changed scene, but for the tolerance.

    Attributes:
        change: from the scene to the one that bounds it.
        multiple: of the changed scene's values that bounds the quantity, of the scene; one where omitted.
        at_most: whether it bounds it from above.
    """

    kind: ClassVar[Kind] = Kind.INVARIANT

    change: Callable[[Scene], Scene]
    multiple: Callable[[Scene], float] | None = None
    at_most: bool = False

    def tasks(self, case: Case) -> Iterable[Task]:
        """Return the changed scenes to solve."""
        for scene in self.scenes_of(case):
            for label in self.labels(case, scene):
                yield self._changed(case.task(scene, case.use(scene, label)))

    def judge(self, case: Case, answers: Answers) -> Iterator[Claim]:
        """Judge each scene and method by its worst step."""
        for scene, label, run, tolerance in self.answered(case, answers):
            bound = answers.of(self._changed(case.task(scene, case.use(scene, label))))
            multiple = 1.0 if self.multiple is None else self.multiple(scene.scene)
            judged = first_missing(run, bound, quantity=self.quantity) or self._judged(run, bound, tolerance, multiple)
            yield self.record(judged, scene.name, (label,), tolerance=tolerance)

    def _changed(self, task: Task) -> Task:
        return task.changed(self.name, problem=self.change(task.problem))

    def _judged(self, run: SceneRun, bound: SceneRun, tolerance: float, multiple: float = 1.0) -> Judgement:
        values, bounds = run.quantity(self.quantity), bound.quantity(self.quantity)
        steps = zip(values.values, bounds.values, strict=True)
        sign = -1.0 if self.at_most else 1.0
        lacking = (max(0.0, sign * (multiple * least - value)) / bounds.scale for value, least in steps)
        return worst_judgement([judge_invariant(share, tolerance=tolerance) for share in lacking])
