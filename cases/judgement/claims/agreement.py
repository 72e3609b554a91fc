"""A quantity of one method against that of another, with the uncertainty of both."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

from cases.declare.case import Case, CaseScene
from cases.declare.task import Answers
from cases.judgement.claims.declared import DeclaredClaim, first_missing
from cases.judgement.rules.agreement import judge_agreement, without_uncertainty
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
        refused = _incomparable(a, b)
        if refused is not None:
            return refused, {}
        steps = range(len(b.values))
        scales = [max(abs(b.values[i]), b.scale if b.values[i] == 0 else 0.0) for i in steps]
        u_fast, u_reference = (
            [u / (max(abs(x), scale) or 1.0) for x, u, scale in zip(q.values, _stated(q), scales, strict=True)]
            for q in (a, b)
        )
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
        silent = [run.method for run, q in ((fast, a), (reference, b)) if not q.uncertainty]
        if silent:
            return without_uncertainty(worst, silent[0], self.quantity), {}
        step = judgements.index(worst)
        return worst, {fast.method: u_fast[step], reference.method: u_reference[step]}


def _stated(quantity: Quantity) -> tuple[float, ...]:
    """Stated uncertainties of the values, zeros where the method states none."""
    return quantity.uncertainty or (0.0,) * len(quantity.values)


def _incomparable(a: Quantity, b: Quantity) -> Judgement | None:
    """Return why two quantities cannot be compared, or None."""
    if a.unit != b.unit or len(a.values) != len(b.values):
        message = f"{len(a.values)} values in {a.unit} against {len(b.values)} in {b.unit}"
        return nothing_compared(Status.INCOMPARABLE, message)
    return None
