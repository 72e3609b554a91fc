"""The observed order of convergence of one method on one scene."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from cases.declare.case import Case, CaseScene
from cases.declare.methods import MethodUse
from cases.declare.task import Answers, Task
from cases.judgement.claims.declared import DeclaredClaim, first_missing
from cases.judgement.convergence.study import Refinements, study_of
from cases.judgement.rules.judgement import Judgement, nothing_compared
from cases.judgement.rules.order import judge_digits, judge_order
from cases.results.records.claim import Claim, Kind
from cases.results.records.convergence import ConvergenceStudy
from cases.results.records.scene_run import SceneRun
from cases.results.status import Status
from contact import Scene


@dataclass(frozen=True, kw_only=True)
class Order(DeclaredClaim):
    """On a sequence of grids the quantity's last step converges at its formal order.

    Attributes:
        method: label of the method in the case.
        ladder: settings of each grid, coarsest first, in place of those of the case.
        ratio: of the discretisation lengths of neighbours.
        formal_order: p_f of this case, quantity and mesh family; None claims spectral convergence.
        least_digits: digits per refinement, for spectral convergence.
        mesh_family: what the formal order belongs to.
        reference: the value at vanishing length, or None.
        reference_uncertainty: relative.
        floor: round-off floor, relative.
    """

    kind: ClassVar[Kind] = Kind.ORDER

    method: str
    ladder: tuple[Mapping[str, Any], ...]
    ratio: float = 2.0
    formal_order: float | None = None
    least_digits: float = 1.0
    mesh_family: str
    reference: Callable[[Scene], float] | None = None
    reference_uncertainty: float = 0.0
    floor: float = 1e-14

    def labels(self, case: Case, scene: CaseScene) -> tuple[str, ...]:
        """Return the one label."""
        return (self.method,)

    def tasks(self, case: Case) -> Iterable[Task]:
        """Return the grids of every scene, coarsest first."""
        for scene in self.scenes_of(case):
            yield from self._grids(case, scene)

    def judge(self, case: Case, answers: Answers) -> Iterator[Claim]:
        """Judge each scene."""
        for scene in self.scenes_of(case):
            runs = [answers.of(task) for task in self._grids(case, scene)]
            judged = first_missing(*runs) or self._judged(self._study(scene, runs))
            yield self.record(judged, scene.name, (self.method,), expected=self.formal_order)

    def studies(self, case: Case, answers: Answers) -> Iterator[ConvergenceStudy]:
        """Return the convergence study of each scene whose grids were all solved."""
        for scene in self.scenes_of(case):
            runs = [answers.of(task) for task in self._grids(case, scene)]
            if first_missing(*runs) is None:
                yield self._study(scene, runs)

    def _grids(self, case: Case, scene: CaseScene) -> Iterator[Task]:
        use = case.use(scene, self.method)
        task = case.task(scene, use)
        for level, settings in enumerate(self.ladder):
            solver = MethodUse(label=use.label, method=use.method, settings=settings).build()
            yield task.changed(f"{self.name}, grid {level}", solver=solver)

    def _study(self, scene: CaseScene, runs: list[SceneRun]) -> ConvergenceStudy:
        finest_first = runs[::-1]
        sequence = Refinements(
            lengths=tuple(self.ratio**-level for level in range(len(runs)))[::-1],
            values=tuple(run.quantity(self.quantity).values[-1] for run in finest_first),
            unknowns=tuple(run.cost.unknowns if run.cost else 0 for run in finest_first),
            seconds=tuple(run.cost.cpu_seconds if run.cost else 0.0 for run in finest_first),
        )
        quantity = finest_first[0].quantity(self.quantity)
        return study_of(
            sequence,
            scene=scene.name,
            method=self.method,
            quantity=quantity,
            formal_order=self.formal_order,
            mesh_family=self.mesh_family,
            reference=self.reference(scene.scene) if self.reference else None,
            reference_uncertainty=self.reference_uncertainty,
            reference_source=self.reason.source,
            floor=self.floor,
        )

    def _judged(self, study: ConvergenceStudy) -> Judgement:
        if self.formal_order is not None:
            return judge_order(study.observed_order, self.formal_order, study.kind)
        if study.digits_per_refinement is None:
            return nothing_compared(Status.INCONCLUSIVE, "every grid is at the floor: start coarser")
        return judge_digits(study.digits_per_refinement, self.least_digits)
