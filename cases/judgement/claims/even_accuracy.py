"""A method's error does not grow from scene to scene, such as finite elements toward incompressibility."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

from cases.declare.case import Case, CaseScene
from cases.declare.task import Answers
from cases.judgement.claims.declared import DeclaredClaim, first_missing
from cases.judgement.rules.invariant import judge_invariant
from cases.judgement.rules.judgement import Judgement, nothing_compared
from cases.results.records.claim import Claim, Kind
from cases.results.records.scene_run import SceneRun
from cases.results.status import Status


@dataclass(frozen=True, kw_only=True)
class EvenAccuracy(DeclaredClaim):
    """On one and the same mesh the error exceeds that of the first scene by no more than the fraction ``tolerance``.

    Attributes:
        method: label of the method judged; it says in its settings which mesh it used.
        reference: label of the far more accurate method that errors are taken against.
    """

    kind: ClassVar[Kind] = Kind.INVARIANT

    method: str
    reference: str

    def labels(self, case: Case, scene: CaseScene) -> tuple[str, ...]:
        """Return both methods."""
        return (self.method, self.reference)

    def judge(self, case: Case, answers: Answers) -> Iterator[Claim]:
        """Judge every scene after the first."""
        first, *others = self.scenes_of(case)
        base = self._runs(case, answers, first)
        for scene in others:
            runs = self._runs(case, answers, scene)
            judged = first_missing(*base, *runs) or self._judged(base, runs)
            yield self.record(judged, scene.name, (self.method,))

    def _runs(self, case: Case, answers: Answers, scene: CaseScene) -> tuple[SceneRun, SceneRun]:
        judged, reference = (answers.of(case.task(scene, case.use(scene, label))) for label in self.labels(case, scene))
        return judged, reference

    def _judged(self, base: tuple[SceneRun, SceneRun], runs: tuple[SceneRun, SceneRun]) -> Judgement:
        meshes = [run.settings.get("mesh") for run, _ in (base, runs)]
        if meshes[0] is None or meshes[0] != meshes[1]:
            return nothing_compared(Status.INCOMPARABLE, f"not one mesh: {meshes[0]} and {meshes[1]}")
        return judge_invariant(self._error(*runs) / self._error(*base) - 1, tolerance=self.tolerance)

    def _error(self, run: SceneRun, reference: SceneRun) -> float:
        value, exact = (r.quantity(self.quantity).values[-1] for r in (run, reference))
        return abs(value / exact - 1)
