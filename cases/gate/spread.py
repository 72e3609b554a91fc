"""Spread of repeated answers, which sets the tolerance of a baseline.

Every accepted solution is repeated twice: with all its inputs one unit in the last place larger, and with them one unit
smaller by the plain kernels of OpenBLAS, those of another processor.  What differs then is rounding, and another
machine may differ by as much.
"""

import math
import os
from collections.abc import Iterator, Mapping
from concurrent.futures import BrokenExecutor
from contextlib import contextmanager
from functools import partial
from typing import Any

import numpy as np

from cases.answers import Answer, Table
from cases.case import Case, Task
from cases.rules import relative_spread
from cases.run.executors import closing, process_pool
from cases.run.solve_task import job_of, solve
from cases.units import changed
from contact import DepthFunction, InvalidInput, Scene
from contact.records.record import Record

# Fields of layers and loadings that are changed by one unit in the last place.
NUDGED = ("youngs_modulus", "thickness", "values", "depth", "force")
PLAIN_KERNEL = "Prescott"  # every x86-64 processor has it; a library other than OpenBLAS takes no notice

# The keys are method, scene and quantity.
Spreads = Mapping[tuple[str, str, str], float]


def measured_spreads(case: Case, answers: Table, *, jobs: int = 2) -> Spreads:
    """Return the relative spread of every quantity of the case's ``answers``, measured by repeating them.

    Raises:
        InvalidInput: If a repetition breaks down or gives another number of steps: such an answer cannot be accepted.
    """
    tasks = [case.task(scene, use) for scene in case.scenes for use in case.methods_of(scene)]
    solved = [(task, answer) for task in tasks if (answer := answers.get(task.identity)) is not None and answer.solved]
    repeated_tasks = [task for task, _ in solved]
    larger = _repeated(repeated_tasks, math.inf, jobs)
    with _plain_kernel():
        smaller = _repeated(repeated_tasks, 0.0, jobs)
    rows = zip(solved, larger, smaller, strict=True)
    return {place: spread for (task, answer), *others in rows for place, spread in _spreads(task, [answer, *others])}


def _repeated(tasks: list[Task], towards: float, jobs: int) -> list[Answer]:
    """The answers to each task's nudged scene, in fresh processes."""
    nudged = [task.changed("one ulp away", nudged_scene(task.problem, towards)) for task in tasks]
    try:
        with closing(process_pool(jobs)) as executor:
            answers = list(executor.map(solve, [job_of(task, estimates=False) for task in nudged]))
    except BrokenExecutor:
        raise InvalidInput("a process that repeated an answer died; accept nothing from such a run") from None
    for task, answer in zip(tasks, answers, strict=True):
        if not answer.solved:
            reason = f"this repetition should change nothing, but {answer.status}: {answer.reason}"
            raise InvalidInput(f"{task.label}: {reason}")
    return answers


def _spreads(task: Task, answers: list[Answer]) -> Iterator[tuple[tuple[str, str, str], float]]:
    """Yield method, scene and quantity with the largest relative spread of the answers over the steps."""
    for name, q in answers[0].quantities.items():
        if not q.at:
            place = task.use.label, task.scene, name
            repeated = [answer.quantities[name].values for answer in answers]
            if len({len(values) for values in repeated}) > 1:
                raise InvalidInput(f"{' / '.join(place)}: repetitions give other numbers of steps; they must not vary")
            steps = zip(*repeated, strict=True)
            yield place, max((relative_spread(step, q.scale) for step in steps), default=0.0)


def nudged_scene(scene: Scene, towards: float) -> Scene:
    """Return the scene with modulus, thickness and loading one unit in the last place nearer to ``towards``.

    The loading stays if the changed one is invalid, such as a radius beyond the end of a table.
    """
    nudge = partial(_nudged, towards)
    nudged = scene.replace(layer=changed(scene.layer, nudge))
    try:
        return nudged.replace(loading=changed(scene.loading, nudge))
    except InvalidInput:
        return nudged


def _nudged(towards: float, record: Record, name: str, value: Any) -> Any:
    """The number changed by one unit in the last place; zero and infinity stay."""
    if name not in NUDGED or isinstance(value, DepthFunction):
        return value
    neighbour = np.where((value == 0.0) | np.isinf(value), value, np.nextafter(value, towards))
    return neighbour if isinstance(value, np.ndarray) else float(neighbour)


@contextmanager
def _plain_kernel() -> Iterator[None]:
    """Processes started inside load OpenBLAS with its plain kernels."""
    before = os.environ.get("OPENBLAS_CORETYPE")
    os.environ["OPENBLAS_CORETYPE"] = PLAIN_KERNEL
    try:
        yield
    finally:
        if before is None:
            del os.environ["OPENBLAS_CORETYPE"]
        else:
            os.environ["OPENBLAS_CORETYPE"] = before
