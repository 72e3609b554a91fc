"""Judge a case: its claims, convergence and work studies, and figures, from the finished answers."""

import json
from collections.abc import Iterable, Iterator
from typing import TypeVar

from cases.declare.case import Case
from cases.declare.task import Answers, MissingAnswer
from cases.judgement.claims.order import Order
from cases.results.records.run import CaseResult, SceneDescription
from contact import scene_to_mapping

T = TypeVar("T")


def case_result(case: Case, answers: Answers, *, complete: bool = True) -> CaseResult:
    """Return the judged case.

    Args:
        case: the case.
        answers: finished tasks.
        complete: whether all its tasks are there; if not, what needs a missing one is left out.

    Raises:
        MissingAnswer: if a task is missing from a complete run.
    """

    def there(records: Iterable[T]) -> Iterator[T]:
        """Yield the records whose answers are there."""
        try:
            yield from records
        except MissingAnswer:
            if complete:
                raise

    main = [case.task(scene, use) for scene in case.scenes for use in case.methods_of(scene)]
    orders = [claim for claim in case.claims if isinstance(claim, Order)]
    return CaseResult(
        name=case.name,
        title=case.title,
        question=case.question,
        equations=case.equations,
        text=case.text,
        scenes=tuple(
            SceneDescription(
                name=scene.name,
                parameters=scene.parameters,
                canonical=json.dumps(scene_to_mapping(scene.scene), sort_keys=True),
            )
            for scene in case.scenes
        ),
        runs=tuple(answers.of(task) for task in main if complete or answers.has(task)),
        claims=tuple(record for claim in case.claims for record in there(claim.judge(case, answers))),
        convergence=tuple(study for order in orders for study in there(order.studies(case, answers))),
        work_precision=tuple(record for study in case.work for record in there(study.records(case, answers))),
        effects=tuple(entry for study in case.ablations for entry in there(study.records(case, answers))),
        figures=tuple(figure for draw in case.figures for figure in there(draw(case, answers))),
    )
