"""A quantity of one method against that of another, with the uncertainty of both."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

from cases.declare.case import Case, CaseScene
from cases.declare.task import Answers
from cases.judgement.claims.declared import DeclaredClaim, first_missing
from cases.judgement.rules.agreement import judge_agreement
from cases.judgement.rules.judgement import Judgement, nothing_compared, worst_judgement
from cases.results.records.claim import Claim, Kind
from cases.results.records.scene_run import Quantity, SceneRun
from cases.results.status import Status


@dataclass(frozen=True, kw_only=True)
class Agreement(DeclaredClaim):
    """Two methods give the same values within the tolerance, their uncertainties counted.

    Attributes:
        fast: label of the method under test.
        reference: label of the method it is compared with.
        input_uncertainty: relative, of the data both start from.
        model_gap: declared relative difference of the models, signed.
        valid_range: where that gap holds; needed when there is one.
    """

    kind: ClassVar[Kind] = Kind.AGREEMENT

    fast: str
    reference: str
    input_uncertainty: float = 0.0
    model_gap: float = 0.0
    valid_range: str = ""

    def labels(self, case: Case, scene: CaseScene) -> tuple[str, ...]:
        """Return both labels."""
        return self.fast, self.reference

    def judge(self, case: Case, answers: Answers) -> Iterator[Claim]:
        """Judge each scene by its worst step."""
        for scene in self.scenes_of(case):
            fast, reference = (answers.of(case.task(scene, case.use(scene, m))) for m in self.labels(case, scene))
            labels, shared = self.labels(case, scene), self.shared(case, fast, reference)
            judged = first_missing(fast, reference, quantity=self.quantity)
            if judged is not None:
                yield self.record(judged, scene.name, labels, shared=shared)
                continue
            judged, uncertainty = self._compared(fast, reference)
            yield self.record(
                judged,
                scene.name,
                labels,
                expected=0.0,
                uncertainty=uncertainty,
                shared=shared,
                identity=self.identity(scene, labels),
            )

    def _compared(self, fast: SceneRun, reference: SceneRun) -> tuple[Judgement, dict[str, float]]:
        a, b = fast.quantity(self.quantity), reference.quantity(self.quantity)
        refused = _incomparable(a, b, fast.method, reference.method)
        if refused is not None:
            return refused, {}
        steps = range(len(b.values))
        scales = [max(abs(b.values[i]), b.scale if b.values[i] == 0 else 0.0) for i in steps]
        u_fast = [a.uncertainty[i] / scales[i] for i in steps]
        u_reference = [b.uncertainty[i] / scales[i] for i in steps]
        judgements = [
            judge_agreement(
                (a.values[i] - b.values[i]) / scales[i],
                {fast.method: u_fast[i], reference.method: u_reference[i]},
                tolerance=self.tolerance,
                input_uncertainty=self.input_uncertainty,
                model_gap=self.model_gap,
            )
            for i in steps
        ]
        worst = worst_judgement(judgements)
        step = judgements.index(worst)
        return worst, {fast.method: u_fast[step], reference.method: u_reference[step]}


def _incomparable(a: Quantity, b: Quantity, first: str, second: str) -> Judgement | None:
    """Return why two quantities cannot be compared, or None."""
    if a.unit != b.unit or len(a.values) != len(b.values):
        message = f"{len(a.values)} values in {a.unit} against {len(b.values)} in {b.unit}"
        return nothing_compared(Status.INCOMPARABLE, message)
    for quantity, method in ((a, first), (b, second)):
        if not quantity.uncertainty:
            message = f"{method} states no uncertainty of {quantity.name}: no verdict is possible"
            return nothing_compared(Status.INCONCLUSIVE, message)
    return None
