"""What accuracy costs on one scene: settings of several methods, timed alone on the machine."""

from collections.abc import Collection, Iterable, Iterator, Mapping, Set
from dataclasses import dataclass, replace
from itertools import pairwise

from cases.declare.case import Case
from cases.declare.methods import MethodUse
from cases.declare.task import Answers, Task
from cases.measurements.cost.cost_of_accuracy import (
    TOLERANCES,
    bound_of,
    cheapest,
    crossover,
    error_bound,
    pareto_front,
    price_of_a_digit,
)
from cases.results.records.cost import CheapestRun, DigitPrice, WorkPoint, WorkPrecision
from cases.results.records.scene_run import SceneRun
from cases.run.timing import summed_up


@dataclass(frozen=True, kw_only=True)
class WorkStudy:
    """Error against seconds of one quantity's last step.

    Attributes:
        scene: name of the scene.
        quantity: what the error is of.
        ladder: settings to try; the label of each names the setting, ``method`` the method.
        reference: the settings errors are measured against; its own stated uncertainty is u_ref.
        fast_method: the crossover asks how far down it wins.
        baseline_method: speed-ups are relative to it.
        cheap: the settings that the ci suite times; empty for all.
    """

    scene: str
    quantity: str
    ladder: tuple[MethodUse, ...]
    reference: MethodUse
    fast_method: str
    baseline_method: str
    cheap: tuple[MethodUse, ...] = ()

    def in_suite(self, suite: str) -> "WorkStudy":
        """Return the study as a suite carries it out: nightly all settings, otherwise the cheap ones."""
        return self if suite == "nightly" or not self.cheap else replace(self, ladder=self.cheap)

    def of_methods(self, methods: Collection[str], foreign: Iterable[MethodUse] = ()) -> "WorkStudy":
        """Return the study of these methods' settings, and of those of ``foreign`` ones."""
        own = tuple(use for use in self.ladder if use.method in methods)
        return replace(self, ladder=(*own, *foreign), cheap=())

    def left(self, solvers: Mapping[str, Set[str]]) -> "WorkStudy":
        """Return the study as it is: it solves its own settings, whatever methods a run keeps."""
        return self

    def tasks(self, case: Case) -> Iterator[Task]:
        """Return the reference and every timed setting."""
        yield self._task(case, self.reference, timed=False)
        for use in self.ladder:
            yield self._task(case, use, timed=True)

    def records(self, case: Case, answers: Answers) -> Iterator[WorkPrecision]:
        """Return the finished study; nothing when the reference itself has no numbers."""
        reference = answers.of(self._task(case, self.reference, timed=False))
        if not reference.solved or not reference.quantity(self.quantity).uncertainty:
            return
        expected, u_ref = _value_and_uncertainty(reference, self.quantity)
        points = [
            self._point(use, answers.of(self._task(case, use, timed=True)), expected, u_ref) for use in self.ladder
        ]
        spread = max((summed_up(point.samples).spread for point in points if point.bound is not None), default=0.0)
        front = pareto_front(points, spread)
        yield WorkPrecision(
            scene=self.scene,
            quantity=self.quantity,
            reference_source=f"{self.reference.method} ({self.reference.label})",
            reference_uncertainty=u_ref,
            baseline_method=self.baseline_method,
            fast_method=self.fast_method,
            null_spread=spread,
            points=tuple(replace(point, on_front=point in front) for point in points),
            cheapest=tuple(self._cheapest(points)),
            prices=tuple(_prices(points, spread)),
            crossover=crossover(_of(points, self.fast_method), _of(points, self.baseline_method), TOLERANCES),
        )

    def _task(self, case: Case, use: MethodUse, *, timed: bool) -> Task:
        scene = case.scene(self.scene)
        task = case.task(scene, use)
        role = "cost" if timed else "reference"
        return replace(task, method=use.method, variant=f"{role}: {use.label}", timed=timed)

    def _point(self, use: MethodUse, run: SceneRun, expected: float, u_ref: float) -> WorkPoint:
        base = WorkPoint(
            method=use.method,
            settings=run.settings,
            label=use.label,
            status=run.status,
            reason=run.reason,
            error=None,
            bound=None,
            samples=(),
            seconds=0.0,
            lower_quartile=0.0,
            upper_quartile=0.0,
            unknowns=0,
            peak_memory_bytes=0,
            on_front=False,
        )
        if not run.solved or run.cost is None or not run.samples:
            return base
        error = abs(run.quantity(self.quantity).values[-1] - expected) / abs(expected)
        timing = summed_up(run.samples)
        return replace(
            base,
            error=error,
            bound=error_bound(error, u_ref),
            samples=timing.samples,
            seconds=timing.median,
            cold_seconds=run.cold_seconds or 0.0,
            lower_quartile=timing.lower_quartile,
            upper_quartile=timing.upper_quartile,
            unknowns=run.cost.unknowns,
            peak_memory_bytes=run.cost.peak_memory_bytes,
            counters=run.cost.counters,
            stages=run.stages,
        )

    def _cheapest(self, points: list[WorkPoint]) -> Iterator[CheapestRun]:
        for tolerance in TOLERANCES:
            baseline = cheapest(_of(points, self.baseline_method), tolerance)
            for method in sorted({point.method for point in points}):
                yield _cheapest_row(_of(points, method), method, tolerance, baseline)


def _value_and_uncertainty(run: SceneRun, name: str) -> tuple[float, float]:
    quantity = run.quantity(name)
    value = quantity.values[-1]
    return value, quantity.uncertainty[-1] / abs(value)


def _of(points: list[WorkPoint], method: str) -> list[WorkPoint]:
    """The settings of one method that gave an answer."""
    return [point for point in points if point.method == method and point.bound is not None]


def _prices(points: list[WorkPoint], spread: float) -> Iterator[DigitPrice]:
    """Between neighbours on each method's own front."""
    for method in dict.fromkeys(point.method for point in points):
        ordered = sorted(pareto_front(_of(points, method), spread), key=bound_of, reverse=True)
        for cheap, accurate in pairwise(ordered):
            if bound_of(accurate) < bound_of(cheap):
                yield DigitPrice(
                    method=method,
                    from_label=f"{method}: {cheap.label}",
                    to_label=f"{method}: {accurate.label}",
                    decades_per_digit=price_of_a_digit(cheap, accurate),
                )


def _cheapest_row(own: list[WorkPoint], method: str, tolerance: float, baseline: WorkPoint | None) -> CheapestRun:
    best = cheapest(own, tolerance)
    shown = best or min(own, key=bound_of, default=None)
    return CheapestRun(
        tolerance=tolerance,
        method=method,
        reached=best is not None,
        label=shown.label if shown else "",
        seconds=shown.seconds if shown else None,
        cold_seconds=shown.cold_seconds if shown else None,
        bound=shown.bound if shown else None,
        peak_memory_bytes=shown.peak_memory_bytes if shown else None,
        speed_up=baseline.seconds / best.seconds if best and baseline else None,
    )
