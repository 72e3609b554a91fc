"""The sampled pressure carries the force: what it adds up to over the contact is the normal force of the answer."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from cases.declare.case import Case, CaseScene
from cases.declare.task import Answers
from cases.judgement.claims.declared import PerMethod, missing
from cases.judgement.rules.invariant import judge_invariant
from cases.judgement.rules.judgement import Judgement, nothing_compared
from cases.results.records.claim import Claim, Kind
from cases.results.records.scene_run import SceneRun
from cases.results.status import Status


@dataclass(frozen=True, kw_only=True)
class CarriedForce(PerMethod):
    """The loads of rings out to the contact's edge add up to the normal force of the last step."""

    kind: ClassVar[Kind] = Kind.INVARIANT

    def judge(self, case: Case, answers: Answers) -> Iterator[Claim]:
        """Judge each scene and method."""
        for scene, label, run, tolerance in self.answered(case, answers):
            judged = missing(run) or self._judged(scene, run, tolerance)
            yield self.record(judged, scene.name, (label,), tolerance=tolerance)

    def _judged(self, scene: CaseScene, run: SceneRun, tolerance: float) -> Judgement:
        pressures = [curve for curve in run.curves if curve.name == self.quantity]
        if not pressures:
            return nothing_compared(Status.SKIP, f"{run.method} gives no {self.quantity}")
        load = float(np.sum(scene.sampling.rings.loads(np.array(pressures[0].y))))
        return judge_invariant(load / run.quantity("normal_force").values[-1] - 1, tolerance=tolerance)
