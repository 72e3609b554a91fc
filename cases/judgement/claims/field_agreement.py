"""A sampled field of one method against that of another, in a norm that converges at a sharp rim, or at points."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np

from cases.declare.case import Case, CaseScene
from cases.declare.task import Answers, Task
from cases.judgement.claims.declared import DeclaredClaim, first_missing
from cases.judgement.rules.agreement import judge_agreement, without_uncertainty
from cases.judgement.rules.judgement import Judgement, nothing_compared
from cases.judgement.rules.norms import RingQuadrature, relative_difference, ring_load_difference, ring_quadrature
from cases.results.records.claim import Claim, Kind
from cases.results.records.scene_run import Curve, SceneRun
from cases.results.status import Status
from contact.records.validation import FloatArray

Norm = Literal["weighted L2", "ring loads", "largest", "root mean square"]

_NORMS: dict[str, Callable[[FloatArray, FloatArray, RingQuadrature], float]] = {
    "weighted L2": relative_difference,
    "ring loads": ring_load_difference,
    # Of fields that are kept over their scale, at points.
    "largest": lambda first, second, _: float(np.abs(first - second).max()),
    "root mean square": lambda first, second, _: float(np.sqrt(np.mean((first - second) ** 2))),
}
# Fields at points need no rings.
NO_RINGS = ring_quadrature((0.0, 1.0), 1)


@dataclass(frozen=True, kw_only=True)
class FieldAgreement(DeclaredClaim):
    """Two methods give the same pressure in the 2 pi r weighted L2 norm, loads of rings, or fields at points.

    Attributes:
        fast: label of the method under test.
        reference: label of the method it is compared with.
        norm: how fields are compared.
        refined: labels of methods that state no uncertainty of the field; the change on halving their discretisation
            length takes its place.
    """

    kind: ClassVar[Kind] = Kind.AGREEMENT

    fast: str
    reference: str
    norm: Norm
    refined: tuple[str, ...] = ()

    def labels(self, case: Case, scene: CaseScene) -> tuple[str, ...]:
        """Return both labels."""
        return self.fast, self.reference

    def tasks(self, case: Case) -> Iterable[Task]:
        """Return the refined solutions that stand for a missing uncertainty."""
        for scene in self.scenes_of(case):
            yield from (self._finer(case, scene, label) for label in self.refined)

    def judge(self, case: Case, answers: Answers) -> Iterator[Claim]:
        """Judge each scene."""
        for scene in self.scenes_of(case):
            labels = self.labels(case, scene)
            runs = [answers.of(case.task(scene, case.use(scene, label))) for label in labels]
            judged, uncertainty = first_missing(*runs), dict[str, float]()
            if judged is None:
                judged, uncertainty = self._compared(case, scene, answers, runs)
            shared = self.shared(case, *runs)
            yield self.record(judged, scene.name, labels, expected=0.0, uncertainty=uncertainty, shared=shared)

    def _compared(
        self, case: Case, scene: CaseScene, answers: Answers, runs: list[SceneRun]
    ) -> tuple[Judgement, dict[str, float]]:
        uncertainty: dict[str, float] = {}
        for run in runs:
            if _curve(run, self.quantity) is None:
                return nothing_compared(Status.SKIP, f"{run.method} gives no {self.quantity}"), uncertainty
            own = self._uncertainty(case, scene, answers, run)
            if own is not None:
                uncertainty[run.method] = own
        judged = judge_agreement(self._difference(scene, *runs), uncertainty, tolerance=self.tolerance)
        silent = [run.method for run in runs if run.method not in uncertainty]
        return (without_uncertainty(judged, silent[0], self.quantity) if silent else judged), uncertainty

    def _difference(self, scene: CaseScene, first: SceneRun, second: SceneRun) -> float:
        a, b = first.curve(self.quantity), second.curve(self.quantity)
        rings = scene.sampling.rings if scene.sampling.ring_edges else NO_RINGS
        return _NORMS[self.norm](np.array(a.y), np.array(b.y), rings)

    def _uncertainty(self, case: Case, scene: CaseScene, answers: Answers, run: SceneRun) -> float | None:
        if run.method not in self.refined:
            return run.curve(self.quantity).relative_uncertainty
        finer = answers.of(self._finer(case, scene, run.method))
        return self._difference(scene, run, finer) if finer.solved else None

    def _finer(self, case: Case, scene: CaseScene, label: str) -> Task:
        task = case.task(scene, case.use(scene, label))
        return task.changed("refined", solver=task.solver.refined())


def _curve(run: SceneRun, name: str) -> Curve | None:
    return next((curve for curve in run.curves if curve.name == name), None)
