"""What accuracy costs: error against seconds. All ranking uses the bound U = e + u_ref, and nothing is interpolated."""

import math
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

from cases.answers import Answer, Table
from cases.case import Case, Task
from cases.claims import Study
from cases.declare.methods import MethodUse
from cases.run.timing import quartiles
from cases.studies import CostOfAccuracy, Point
from cases.verdicts import Status
from contact import InvalidInput


@dataclass(frozen=True, kw_only=True)
class Cost(Study):
    """Error against seconds of one quantity's last step, for settings that are timed alone on the machine.

    Attributes:
        scene: Name of the scene.
        quantity: Quantity whose error is measured.
        ladder: Timed settings; ``label`` names the setting, ``method`` the method.
        reference: Method and settings of the reference solution, whose stated error is u_ref.
        cheap: The settings that are timed outside of the suite nightly; empty for all.
    """

    kind: ClassVar[str] = "cost"
    timed: ClassVar[bool] = True

    scene: str
    quantity: str
    ladder: tuple[MethodUse, ...]
    reference: MethodUse
    cheap: tuple[MethodUse, ...] = ()

    def in_suite(self, suite: str) -> "Cost | None":
        """Return the study as a suite carries it out: nightly all settings, otherwise the cheap ones."""
        if super().in_suite(suite) is None:
            return None
        return self if suite == "nightly" or not self.cheap else replace(self, ladder=self.cheap)

    def of_methods(self, methods: Collection[str], foreign: Iterable[MethodUse]) -> "Cost":
        """Return the study of these methods' settings, and of those of ``foreign`` ones."""
        settings = tuple(use for use in self.ladder if use.method in methods)
        return replace(self, ladder=(*settings, *foreign), cheap=())

    def tasks(self, case: Case) -> Iterator[Task]:
        """Yield the reference and every timed setting."""
        if self.scene in case.by_name:
            yield self._task(case, self.reference, timed=False)
            for use in self.ladder:
                yield self._task(case, use, timed=True)

    def records(self, case: Case, answers: Table) -> Iterator[CostOfAccuracy]:
        """Yield the finished study; nothing when an answer is missing or the reference itself has no numbers."""
        present = [answer for task in self.tasks(case) if (answer := answers.get(task.identity)) is not None]
        if not present or len(present) < len(list(self.tasks(case))):
            return
        reference, *timed = present
        if not reference.solved or not reference.quantities[self.quantity].error:
            return
        exact = reference.quantities[self.quantity]
        u_ref = exact.error[-1] / abs(exact.values[-1])
        points = [self._point(*pair, exact.values[-1], u_ref) for pair in zip(self.ladder, timed, strict=True)]
        times = [quartiles(answer.samples) for answer in timed if answer.samples]
        noise = max(((upper - lower) / 2 / median for lower, median, upper in times), default=0.0)
        front = pareto_front(points, noise)
        yield CostOfAccuracy(
            case=case.name,
            scene=self.scene,
            quantity=self.quantity,
            reference=f"{self.reference.method} ({self.reference.label})",
            reference_error=u_ref,
            noise=noise,
            points=tuple(replace(point, on_front=point in front) for point in points),
        )

    def _task(self, case: Case, use: MethodUse, *, timed: bool) -> Task:
        """Task of the study's scene by one setting, which the variant names."""
        task = case.task(case.scene(self.scene), use)
        role = "cost" if timed else "reference"
        # The answer belongs to the method; the setting stands in the variant.
        named = replace(use, label=use.method, method="")
        return replace(task, use=named, variant=f"{role}: {use.label}", timed=timed)

    def _point(self, use: MethodUse, answer: Answer, exact: float, u_ref: float) -> Point:
        """Error against ``exact``, its bound with the relative error ``u_ref``, and times of a setting."""
        point = Point(method=use.method, setting=use.label, settings=answer.settings, reason=answer.reason)
        if answer.status is not Status.PASS or not answer.samples:
            return point
        error = abs(answer.quantities[self.quantity].values[-1] - exact) / abs(exact)
        lower, median, upper = quartiles(answer.samples)
        return replace(
            point,
            error=error,
            bound=error + u_ref,
            seconds=median,
            quartiles=(lower, upper),
            cold_seconds=answer.cold_seconds,
            unknowns=answer.unknowns,
            memory=answer.memory,
        )


def bound_of(point: Point) -> float:
    """Return the bound of a setting, infinite without an answer."""
    return math.inf if point.bound is None else point.bound


def pareto_front(points: Sequence[Point], noise: float) -> list[Point]:
    """Return the settings on the front, in their order.

    Setting k is dropped iff some j has U_j <= U_k and T_j < T_k (1 - d), d the relative spread of repeated times.
    """
    solved = [point for point in points if point.bound is not None]
    return [
        k for k in solved if not any(bound_of(j) <= bound_of(k) and j.seconds < k.seconds * (1 - noise) for j in solved)
    ]


def cheapest(points: Iterable[Point], tolerance: float) -> Point | None:
    """Return the setting with the shortest time T*(tau) such that U <= tau; None if no setting reaches tau."""
    return min((point for point in points if bound_of(point) <= tolerance), key=lambda p: p.seconds, default=None)


def price_of_a_digit(cheap: Point, accurate: Point) -> float:
    """Return d log10(T) / d DoA between neighbours on the front: decades of time per digit of accuracy.

    Raises:
        InvalidInput: Unless the second setting is the more accurate one.
    """
    if not bound_of(accurate) < bound_of(cheap):
        raise InvalidInput(f"{accurate.method} is not more accurate than {cheap.method}")
    return math.log10(accurate.seconds / cheap.seconds) / math.log10(bound_of(cheap) / bound_of(accurate))
