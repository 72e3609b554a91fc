"""A quantity against a closed form or the literature."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from cases.declare.case import Case, CaseScene
from cases.declare.task import Answers
from cases.judgement.claims.declared import PerMethod, missing
from cases.judgement.rules.exact import judge_exact
from cases.judgement.rules.judgement import Judgement, nothing_compared, worst_judgement
from cases.results.records.claim import Claim, Kind
from cases.results.records.scene_run import Quantity
from cases.results.status import Status
from contact import InvalidInput, Scene

Expected = Mapping[str, Sequence[float]] | Callable[[Scene], Sequence[float]]


@dataclass(frozen=True, kw_only=True)
class Exact(PerMethod):
    """The values along the steps equal ``expected``: by name of the scene, or a function of the scene."""

    kind: ClassVar[Kind] = Kind.EXACT

    expected: Expected

    def scenes_of(self, case: Case) -> tuple[CaseScene, ...]:
        """Return the scenes named, or those that have an expected value."""
        if isinstance(self.expected, Mapping) and not self.scenes:
            return tuple(case.scene(name) for name in self.expected)
        return super().scenes_of(case)

    def judge(self, case: Case, answers: Answers) -> Iterator[Claim]:
        """Judge each scene and method by its worst step."""
        for scene, label, run, tolerance in self.answered(case, answers):
            expected = self.expected_on(scene)
            judged, stated = missing(run, self.quantity), None
            if judged is None:
                judged, stated, _ = worst_step(run.quantity(self.quantity), expected, tolerance)
            single = expected[0] if len(expected) == 1 else None
            yield self.record(
                judged,
                scene.name,
                (label,),
                expected=single,
                uncertainty={} if stated is None else {label: stated},
                tolerance=tolerance,
                identity=self.identity(scene, (label,)),
            )

    def expected_on(self, scene: CaseScene) -> Sequence[float]:
        """Return the expected values on one scene."""
        if not isinstance(self.expected, Mapping):
            return [float(value) for value in self.expected(scene.scene)]
        if scene.name not in self.expected:
            raise InvalidInput(f"claim {self.name!r}: no expected value for scene {scene.name!r}")
        return self.expected[scene.name]


def worst_step(
    quantity: Quantity, expected: Sequence[float], tolerance: float, inputs: ArrayLike = 0.0
) -> tuple[Judgement, float | None, int]:
    """Judge every step.

    Args:
        quantity: along the steps.
        expected: values, one a step.
        tolerance: relative.
        inputs: absolute uncertainty of the values by their inputs, one number or one a step.

    Returns:
        The judgement of the worst step, the error that the method states there, relative (None if it states none),
        and which step it is.
    """
    if len(expected) != len(quantity.values):
        message = f"{len(quantity.values)} steps for {len(expected)} expected values of {quantity.name}"
        return nothing_compared(Status.INCOMPARABLE, message), None, 0
    scale = quantity.scale if any(value == 0 for value in expected) else 0.0
    stated = quantity.uncertainty or (0.0,) * len(expected)
    total = np.hypot(stated, inputs)
    judged = [
        judge_exact(v, e, scale=scale, tolerance=tolerance, uncertainty=float(u))
        for v, e, u in zip(quantity.values, expected, total, strict=True)
    ]
    worst = worst_judgement(judged)
    step = judged.index(worst)
    return worst, stated[step] / max(abs(expected[step]), scale) if quantity.uncertainty else None, step
