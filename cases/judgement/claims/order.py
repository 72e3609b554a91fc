"""The observed order of convergence of one method on one scene."""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, TypeAlias

import numpy as np

from cases.declare.case import Case, CaseScene
from cases.declare.methods import MethodUse
from cases.declare.task import Answers, Task
from cases.judgement.claims.declared import DeclaredClaim, first_missing
from cases.judgement.convergence.study import Refinements, study_of
from cases.judgement.rules.judgement import Judgement, nothing_compared
from cases.judgement.rules.order import judge_digits, judge_order
from cases.results.records.claim import Claim, Kind
from cases.results.records.convergence import ConvergenceStudy
from cases.results.records.scene_run import Quantity, SceneRun
from cases.results.status import Status
from contact import Scene
from contact.records.validation import FloatArray

# The settings of one grid, or of several grids that make one refinement.
Grids: TypeAlias = Mapping[str, Any] | tuple[Mapping[str, Any], ...]


@dataclass(frozen=True, kw_only=True)
class Order(DeclaredClaim):
    """On a sequence of grids the quantity's last step, or a field at points, converges at its formal order.

    Fields count by root mean squares over their points.

    Attributes:
        method: label of the method in the case.
        ladder: settings of each refinement, coarsest first, in place of those of the case; several grids of one
            refinement, whose errors scatter, count by their root mean square.
        ratio: of the discretisation lengths of neighbours.
        formal_order: p_f of this case, quantity and mesh family; None claims spectral convergence.
        least_digits: digits per refinement, for spectral convergence.
        mesh_family: what the formal order belongs to.
        reference: the value at vanishing length, or None.
        against: the method whose answer is the reference, where there is no such value: its label in the case, or one
            with settings of its own.
        reference_uncertainty: relative, of the reference; zero for what the method itself states.
        floor: round-off floor, relative.
    """

    kind: ClassVar[Kind] = Kind.ORDER

    method: str
    ladder: tuple[Grids, ...]
    ratio: float = 2.0
    formal_order: float | None = None
    least_digits: float = 1.0
    mesh_family: str
    reference: Callable[[Scene], float] | None = None
    against: str | MethodUse = ""
    reference_uncertainty: float = 0.0
    floor: float = 1e-14

    def labels(self, case: Case, scene: CaseScene) -> tuple[str, ...]:
        """Return the label of the method, and that of the one of the case that it is compared with."""
        return (self.method, self.against) if self.against and isinstance(self.against, str) else (self.method,)

    def tasks(self, case: Case) -> Iterable[Task]:
        """Return the grids of every scene, coarsest first."""
        return (task for scene in self.scenes_of(case) for task in self._tasks(case, scene))

    def judge(self, case: Case, answers: Answers) -> Iterator[Claim]:
        """Judge each scene."""
        for scene in self.scenes_of(case):
            judged = first_missing(*self._runs(case, scene, answers)) or self._judged(self._study(case, scene, answers))
            yield self.record(judged, scene.name, (self.method,), expected=self.formal_order)

    def studies(self, case: Case, answers: Answers) -> Iterator[ConvergenceStudy]:
        """Return the convergence study of each scene whose grids were all solved."""
        for scene in self.scenes_of(case):
            if first_missing(*self._runs(case, scene, answers)) is None:
                yield self._study(case, scene, answers)

    def _levels(self, case: Case, scene: CaseScene) -> Iterator[tuple[Task, ...]]:
        """The tasks of each refinement, named after their settings: claims about other quantities share them."""
        use = case.use(scene, self.method)
        for level in self.ladder:
            grids = (level,) if isinstance(level, Mapping) else level
            yield tuple(self._task(case, scene, replace(use, settings=settings)) for settings in grids)

    def _task(self, case: Case, scene: CaseScene, use: MethodUse) -> Task:
        words = ", ".join(f"{name}={value}" for name, value in use.settings.items())
        return case.task(scene, use).changed(f"grid {words}")

    def _referee(self, case: Case, scene: CaseScene) -> Iterator[Task]:
        """The task whose answer is the reference, if one is."""
        if isinstance(self.against, MethodUse):
            yield self._task(case, scene, self.against)
        elif self.against:
            yield case.task(scene, case.use(scene, self.against))

    def _tasks(self, case: Case, scene: CaseScene) -> Iterator[Task]:
        """Every answer the study needs."""
        yield from (task for level in self._levels(case, scene) for task in level)
        yield from self._referee(case, scene)

    def _runs(self, case: Case, scene: CaseScene, answers: Answers) -> list[SceneRun]:
        return [answers.of(task) for task in self._tasks(case, scene)]

    def _study(self, case: Case, scene: CaseScene, answers: Answers) -> ConvergenceStudy:
        levels = [[answers.of(task) for task in level] for level in self._levels(case, scene)][::-1]
        runs = [level[0] for level in levels]
        found = [_sampled(run, self.quantity) for run in runs]
        reference, uncertainty = self._reference(case, scene, answers)
        sequence = Refinements(
            lengths=tuple(self.ratio**-level for level in range(len(runs)))[::-1],
            values=tuple(_size(one.values) for one in found),
            unknowns=tuple(run.cost.unknowns if run.cost else 0 for run in runs),
            seconds=tuple(run.cost.cpu_seconds if run.cost else 0.0 for run in runs),
            errors=tuple(self._distance(level, reference) for level in levels) if reference is not None else (),
            stated=tuple((one.uncertainty or (None,))[-1] for one in found),
        )
        return study_of(
            sequence,
            scene=scene.name,
            method=self.method,
            quantity=found[0],
            formal_order=self.formal_order,
            mesh_family=self.mesh_family,
            reference=None if reference is None else _size(reference),
            reference_uncertainty=uncertainty,
            reference_source=self._referee_name or self.reason.source,
            floor=self.floor,
        )

    @property
    def _referee_name(self) -> str:
        return self.against.label if isinstance(self.against, MethodUse) else self.against

    def _reference(self, case: Case, scene: CaseScene, answers: Answers) -> tuple[FloatArray | None, float]:
        """The value or field at vanishing length, and its relative uncertainty."""
        for task in self._referee(case, scene):
            found = _sampled(answers.of(task), self.quantity)
            stated = (found.uncertainty or (0.0,))[-1] / found.scale
            return np.array(found.values), self.reference_uncertainty or stated
        return np.array([self.reference(scene.scene)]) if self.reference else None, self.reference_uncertainty

    def _distance(self, level: Sequence[SceneRun], reference: FloatArray) -> float:
        """Root mean square distance of the grids of one refinement, at all points of a field."""
        squares = [np.mean((np.array(_sampled(run, self.quantity).values) - reference) ** 2) for run in level]
        return math.sqrt(sum(map(float, squares)) / len(level))

    def _judged(self, study: ConvergenceStudy) -> Judgement:
        if self.formal_order is not None:
            return judge_order(study.observed_order, self.formal_order, study.kind)
        if study.digits_per_refinement is None:
            return nothing_compared(Status.INCONCLUSIVE, "every grid is at the floor: start coarser")
        return judge_digits(study.digits_per_refinement, self.least_digits)


def _sampled(run: SceneRun, name: str) -> Quantity:
    """The last value of a quantity alone, or a field at points, which is kept over its scale."""
    if any(quantity.name == name for quantity in run.quantities):
        found = run.quantity(name)
        return replace(found, values=found.values[-1:], uncertainty=found.uncertainty[-1:])
    field = run.curve(name)
    stated = () if field.relative_uncertainty is None else (field.relative_uncertainty,) * len(field.y)
    return Quantity(name=name, unit=field.unit, scale=1.0, values=field.y, uncertainty=stated)


def _size(values: Sequence[float] | FloatArray) -> float:
    """One value itself, or the root mean square of a field."""
    return float(values[0]) if len(values) == 1 else float(np.sqrt(np.mean(np.square(values))))
