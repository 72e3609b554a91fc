"""A sampled pressure of one method against that of another, in a norm that converges at a sharp rim."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from cases.case import Case, CaseScene
from cases.claims.agreement import shared
from cases.claims.declared import DeclaredClaim, first_missing
from cases.norms import RingQuadrature, relative_difference, ring_load_difference
from cases.results import Claim, Curve, Kind, SceneRun
from cases.rules.agreement import judge_agreement
from cases.rules.judgement import Judgement, nothing_compared
from cases.status import Status
from cases.task import Answers

Array = NDArray[np.float64]
Norm = Literal["weighted L2", "ring loads"]

_NORMS: dict[str, Callable[[Array, Array, RingQuadrature], float]] = {
    "weighted L2": relative_difference,
    "ring loads": ring_load_difference,
}


@dataclass(frozen=True, kw_only=True)
class FieldAgreement(DeclaredClaim):
    """Two methods give the same pressure in the 2 pi r weighted L2 norm, or the same loads of rings."""

    kind: ClassVar[Kind] = Kind.AGREEMENT

    fast: str
    reference: str
    norm: Norm

    def labels(self, case: Case, scene: CaseScene) -> tuple[str, ...]:
        """Return both labels."""
        return self.fast, self.reference

    def judge(self, case: Case, answers: Answers) -> Iterator[Claim]:
        """Judge each scene."""
        for scene in self.scenes_of(case):
            labels = self.labels(case, scene)
            fast, reference = (answers.of(case.task(scene, case.use(scene, m))) for m in labels)
            judged = first_missing(fast, reference)
            uncertainty: dict[str, float] = {}
            if judged is None:
                judged, uncertainty = self._compared(fast, reference, scene.sampling.rings)
            yield self.record(
                judged, scene.name, labels, expected=0.0, uncertainty=uncertainty, shared=shared(fast, reference)
            )

    def _compared(
        self, fast: SceneRun, reference: SceneRun, rings: RingQuadrature
    ) -> tuple[Judgement, dict[str, float]]:
        found = [_curve(run, self.quantity) for run in (fast, reference)]
        if found[0] is None or found[1] is None:
            without = (fast if found[0] is None else reference).method
            return nothing_compared(Status.SKIP, f"{without} gives no {self.quantity}"), {}
        a, b = found[0], found[1]
        uncertainty = {
            run.method: curve.relative_uncertainty
            for run, curve in ((fast, a), (reference, b))
            if curve.relative_uncertainty is not None
        }
        if len(uncertainty) < 2:
            without = next(run.method for run in (fast, reference) if run.method not in uncertainty)
            message = f"{without} states no uncertainty of {self.quantity}: no verdict is possible"
            return nothing_compared(Status.INCONCLUSIVE, message), uncertainty
        difference = _NORMS[self.norm](np.array(a.y), np.array(b.y), rings)
        return judge_agreement(difference, uncertainty, tolerance=self.tolerance), uncertainty


def _curve(run: SceneRun, name: str) -> Curve | None:
    return next((curve for curve in run.curves if curve.name == name), None)
