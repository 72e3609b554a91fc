"""A limit: along a sequence of scenes the answer approaches a closed form at a known rate."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import ClassVar

from cases.declare.case import Case, CaseScene
from cases.declare.task import Answers
from cases.judgement.claims.declared import PerMethod, first_missing
from cases.judgement.rules.judgement import Judgement, nothing_compared
from cases.judgement.rules.order import judge_order
from cases.results.records.claim import Claim, Kind
from cases.results.records.convergence import ConvergenceClass
from cases.results.records.scene_run import SceneRun
from cases.results.status import Status
from contact import Scene


@dataclass(frozen=True, kw_only=True)
class Approach(PerMethod):
    """Between the two last scenes the relative distance from ``limit`` falls like ``parameter`` to the formal order.

    Attributes:
        scenes: names, the one closest to the limit last.
        parameter: what tends to zero, for example h/a.
        limit: the closed form the quantity's last step tends to.
        formal_order: of the distance in the parameter.
        largest: the relative distance of the last scene must not exceed this.
    """

    kind: ClassVar[Kind] = Kind.ORDER

    # The band of an observed order around the formal one.
    tolerance: float = 0.2
    parameter: Callable[[Scene], float]
    limit: Callable[[Scene], float]
    formal_order: float = 1.0
    largest: float

    def judge(self, case: Case, answers: Answers) -> Iterator[Claim]:
        """Judge the sequence once for each method."""
        scenes = self.scenes_of(case)[-2:]
        for label in self.labels(case, scenes[-1]):
            runs = [answers.of(case.task(scene, case.use(scene, label))) for scene in scenes]
            judged = first_missing(*runs) or self._judged(scenes, runs)
            yield self.record(judged, scenes[-1].name, (label,), expected=self.formal_order)

    def _judged(self, scenes: tuple[CaseScene, ...], runs: list[SceneRun]) -> Judgement:
        far, near = (
            run.quantity(self.quantity).values[-1] / self.limit(scene.scene) - 1
            for scene, run in zip(scenes, runs, strict=True)
        )
        if abs(near) > self.largest:
            message = f"{near:+.1e} from the limit, at most {self.largest:g} claimed"
            return nothing_compared(Status.FAIL, message)
        if near == 0 or far == 0:
            return nothing_compared(Status.INCONCLUSIVE, "at the limit to the last bit: no rate to measure")
        ratio = self.parameter(scenes[0].scene) / self.parameter(scenes[1].scene)
        order = math.log(abs(far / near)) / math.log(ratio)
        kind = ConvergenceClass.MONOTONE if far * near > 0 else ConvergenceClass.OSCILLATORY
        judged = judge_order(order, self.formal_order, kind)
        return replace(judged, message=f"{judged.message}; {near:+.1e} from the limit")
