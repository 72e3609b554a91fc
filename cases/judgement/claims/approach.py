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
        first, last = (self.labels(case, scene) for scene in (scenes[0], scenes[-1]))
        for label in (label for label in last if label in first):
            runs = [answers.of(case.task(scene, case.use(scene, label))) for scene in scenes]
            judged = first_missing(*runs) or self._judged(scenes, runs)
            yield self.record(judged, scenes[-1].name, (label,), expected=self.formal_order)

    def _judged(self, scenes: tuple[CaseScene, ...], runs: list[SceneRun]) -> Judgement:
        """Judge the rate; what fails inside the method's stated error stays open."""
        pairs = [
            (run.quantity(self.quantity), self.limit(scene.scene)) for scene, run in zip(scenes, runs, strict=True)
        ]
        far, near = (quantity.values[-1] / limit - 1 for quantity, limit in pairs)
        # A value that is too large does not widen its own error.
        sizes = [max(abs(found.values[-1]), abs(limit)) for found, limit in pairs]
        errors = [
            found.uncertainty[-1] / size if found.uncertainty else 0.0
            for (found, _), size in zip(pairs, sizes, strict=True)
        ]
        ratio = self.parameter(scenes[0].scene) / self.parameter(scenes[1].scene)
        judged = self._rate(far, near, ratio)
        if judged.status is not Status.FAIL or not self._may_hold((far, near), errors, ratio):
            return judged
        return nothing_compared(Status.INCONCLUSIVE, f"{judged.message}; error {max(errors):.1e}: refine")

    def _rate(self, far: float, near: float, ratio: float) -> Judgement:
        if abs(near) > self.largest:
            message = f"{near:+.1e} from the limit, at most {self.largest:g} claimed"
            return nothing_compared(Status.FAIL, message)
        if near == 0 or far == 0:
            return nothing_compared(Status.INCONCLUSIVE, "at the limit to the last bit: no rate to measure")
        order = math.log(abs(far / near)) / math.log(ratio)
        kind = ConvergenceClass.MONOTONE if far * near > 0 else ConvergenceClass.OSCILLATORY
        judged = judge_order(order, self.formal_order, kind)
        return replace(judged, message=f"{judged.message}; {near:+.1e} from the limit")

    def _may_hold(self, distances: tuple[float, float], errors: list[float], ratio: float) -> bool:
        """Whether true distances within the errors could be near the limit and fall at the formal order."""
        (least_far, least_near), (most_far, most_near) = (
            [max(abs(d) + sign * e, 0.0) for d, e in zip(distances, errors, strict=True)] for sign in (-1, 1)
        )
        fall = ratio**self.formal_order
        return least_near <= self.largest and least_far <= fall * most_near and fall * least_near <= most_far
