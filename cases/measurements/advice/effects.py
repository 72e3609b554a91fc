"""What each effect of a scene costs and moves: one more solution without it, for the effect ledger of a report."""

from collections.abc import Iterator, Mapping, Set
from dataclasses import dataclass, replace

from cases.declare.case import Case
from cases.declare.quantities import IMPACT_NUMBERS
from cases.declare.task import Answers, Task
from cases.measurements.advice.ablation import NOTHING_PULLS, STATIC, parts_of, without
from cases.results.records.cost import EffectEntry
from cases.results.records.scene_run import SceneRun
from contact import Adhesion, Detachment, DetachmentPath

_COMPARED = (*IMPACT_NUMBERS, *DetachmentPath.SCALARS, *STATIC)


@dataclass(frozen=True, kw_only=True)
class AblationStudy:
    """Every part of one scene left out in turn.

    Attributes:
        scene: name of the scene.
        methods: labels of the methods that solve it with and without.
        nightly: labels of those that do so in the nightly suite only.
    """

    scene: str
    methods: tuple[str, ...] = ("mdr",)
    nightly: tuple[str, ...] = ()

    def in_suite(self, suite: str) -> "AblationStudy":
        """Return the study as a suite carries it out."""
        return replace(self, methods=(*self.methods, *self.nightly), nightly=()) if suite == "nightly" else self

    def left(self, solvers: Mapping[str, Set[str]]) -> "AblationStudy":
        """Return the study with the methods that are left in ``solvers`` on its scene."""
        return replace(self, methods=tuple(label for label in self.methods if label in solvers[self.scene]))

    def tasks(self, case: Case) -> Iterator[Task]:
        """Return the whole scene and the scene without each of its parts, as first solutions."""
        for label in self.methods:
            yield self._task(case, label)
            yield from (task for _, task in self._ablated(case, label))

    def records(self, case: Case, answers: Answers) -> Iterator[EffectEntry]:
        """Return one entry for each part and method; nothing for a method that does not solve the whole scene."""
        for label in self.methods:
            whole = answers.of(self._task(case, label))
            if whole.solved:
                yield from (_entry(whole, part, answers.of(task)) for part, task in self._ablated(case, label))
                yield from self._indispensable(case, whole)

    def _task(self, case: Case, label: str) -> Task:
        scene = case.scene(self.scene)
        return replace(case.task(scene, case.use(scene, label)), variant="whole, as a first solution", forgetful=True)

    def _ablated(self, case: Case, label: str) -> Iterator[tuple[str, Task]]:
        whole = self._task(case, label)
        for part in parts_of(whole.problem):
            if not _holds_all(whole.problem, part):
                yield part, whole.changed(f"without {part}", problem=without(whole.problem, [part]))

    def _indispensable(self, case: Case, whole: SceneRun) -> Iterator[EffectEntry]:
        problem = case.scene(self.scene).scene
        for part in parts_of(problem):
            if _holds_all(problem, part):
                yield _unanswered(whole, part, NOTHING_PULLS)


def _holds_all(problem: object, part: str) -> bool:
    """Whether nothing is left to solve without the part: the adhesion of a detachment."""
    return part == Adhesion.__name__ and isinstance(getattr(problem, "loading", None), Detachment)


def _entry(whole: SceneRun, part: str, less: SceneRun) -> EffectEntry:
    if not less.solved:
        return _unanswered(whole, part, less.reason)
    return EffectEntry(
        scene=whole.scene,
        method=whole.method,
        effect=part,
        seconds=_seconds(whole),
        seconds_without=_seconds(less),
        changes=dict(_changes(whole, less)),
    )


def _unanswered(whole: SceneRun, part: str, remark: str) -> EffectEntry:
    seconds = _seconds(whole)
    return EffectEntry(
        scene=whole.scene, method=whole.method, effect=part, seconds=seconds, seconds_without=None, remark=remark
    )


def _changes(whole: SceneRun, less: SceneRun) -> Iterator[tuple[str, float]]:
    """Largest change over the steps relative to the largest value; of single numbers where an answer has any."""
    after = {quantity.name: quantity.values for quantity in less.quantities}
    single = any(len(q.values) == 1 and q.name in _COMPARED for q in whole.quantities)
    for quantity in whole.quantities:
        values, others = quantity.values, after.get(quantity.name, ())
        if quantity.name in _COMPARED and len(values) == len(others) and (len(values) == 1 or not single):
            largest = max(map(abs, values))
            if largest > 0:
                yield quantity.name, max(abs(x - y) for x, y in zip(values, others, strict=True)) / largest


def _seconds(run: SceneRun) -> float:
    return run.cost.cpu_seconds if run.cost else 0.0
