"""A law that a method checks on its own answer, such as equal energy and reaction stiffness."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

from cases.declare.case import Case
from cases.declare.task import Answers
from cases.judgement.claims.declared import PerMethod, missing
from cases.judgement.rules.invariant import judge_invariant
from cases.judgement.rules.judgement import Judgement, nothing_compared, worst_judgement
from cases.results.records.claim import Claim, Kind
from cases.results.records.scene_run import SceneRun
from cases.results.status import Status


@dataclass(frozen=True, kw_only=True)
class Residual(PerMethod):
    """A residual that the answers carry as a quantity vanishes."""

    kind: ClassVar[Kind] = Kind.INVARIANT

    def judge(self, case: Case, answers: Answers) -> Iterator[Claim]:
        """Judge each scene and method by its worst step."""
        for scene, label, run, tolerance in self.answered(case, answers):
            judged = missing(run) or self._judged(run, tolerance)
            yield self.record(judged, scene.name, (label,), tolerance=tolerance)

    def _judged(self, run: SceneRun, tolerance: float) -> Judgement:
        if self.quantity not in {q.name for q in run.quantities}:
            return nothing_compared(Status.INCOMPARABLE, f"{run.method} publishes no {self.quantity}")
        values = run.quantity(self.quantity).values
        return worst_judgement([judge_invariant(value, tolerance=tolerance) for value in values])
