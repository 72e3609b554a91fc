"""How much an answer moves when nothing has changed: the spread that sets the tolerance of a baseline.

Every accepted solution is repeated twice: with all its inputs one unit in the last place larger, and with them one unit
smaller by the plain kernels of OpenBLAS, those of another processor.  What differs then is rounding, and another
machine may differ by as much.
"""

import math
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import partial

import numpy as np

from cases.declare.case import Case
from cases.declare.task import Task
from cases.judgement.rules.tolerance import relative_spread
from cases.results.records.scene_run import Quantity, SceneRun
from cases.run.executors import ahead, closing, process_pool
from cases.run.solve_task import solve
from cases.run.window import Window
from contact import (
    ContactRadii,
    DepthHistory,
    ElasticLayer,
    ForceHistory,
    IndentationDepths,
    InvalidInput,
    Layer,
    Loading,
    NormalForces,
    Scene,
)
from contact.records.validation import FloatArray

# What each loading prescribes.
PRESCRIBED: Mapping[type[Loading], str] = {
    ContactRadii: "values",
    IndentationDepths: "values",
    NormalForces: "values",
    DepthHistory: "depth",
    ForceHistory: "force",
}
PLAIN_KERNEL = "Prescott"  # every x86-64 processor has it; a library other than OpenBLAS takes no notice

# The keys are method, scene and quantity.
Spreads = Mapping[tuple[str, str, str], float]


def measured_spreads(case: Case, runs: Mapping[tuple[str, str], SceneRun], *, jobs: int = 2) -> Spreads:
    """Return the relative spread of every quantity of ``runs`` (by scene and method), measured by repeating them.

    Raises:
        InvalidInput: if a repetition breaks down or gives another number of steps: such an answer cannot be accepted.
    """
    # Only methods of the run are built: others may not be installed.
    uses = ((scene, use) for scene in case.scenes for use in case.methods_of(scene) if (scene.name, use.label) in runs)
    tasks = [case.task(scene, use) for scene, use in uses]
    solved = [task for task in tasks if (task.scene, task.method) in runs and runs[task.scene, task.method].solved]
    answers = {task.identity: [runs[task.scene, task.method]] for task in solved}
    repeated = _repeated(solved, math.inf, jobs)
    with _plain_kernel():
        repeated += _repeated(solved, 0.0, jobs)
    for task, row in repeated:
        answers[task.identity].append(row)
    return {place: spread for task in solved for place, spread in _spreads(task, answers[task.identity])}


def _repeated(tasks: list[Task], towards: float, jobs: int) -> list[tuple[Task, SceneRun]]:
    """Solve each task's nudged scene, in fresh processes."""
    nudged = [(task, task.changed("one ulp away", nudged_scene(task.problem, towards))) for task in tasks]
    with closing(process_pool(jobs)) as executor:
        window: Window[tuple[Task, Task], SceneRun] = Window(
            lambda pair: executor.submit(solve, pair[1], "", estimates=False), partial(ahead, executor, jobs)
        )
        rows = {task.identity: row for (task, _), row in window.results(nudged)}
    for _, repetition in window.broken:
        raise InvalidInput(f"{repetition.label}: the process that repeated it died; accept nothing from such a run")
    return [(task, _numbers(repetition, rows[task.identity])) for task, repetition in nudged]


def _numbers(repetition: Task, row: SceneRun) -> SceneRun:
    if row.solved:
        return row
    raise InvalidInput(f"{repetition.label}: this repetition should change nothing, but {row.status}: {row.reason}")


def _spreads(task: Task, answers: list[SceneRun]) -> Iterator[tuple[tuple[str, str, str], float]]:
    for quantity in answers[0].quantities:
        place = task.method, task.scene, quantity.name
        yield place, _spread(place, [answer.quantity(quantity.name) for answer in answers])


def nudged_scene(scene: Scene, towards: float) -> Scene:
    """Return the scene with modulus, thickness and loading one unit in the last place nearer to ``towards``.

    Where that is no scene (a radius beyond the end of a table) the loading stays as it is.
    """
    nudged = scene.replace(layer=_nudged_layer(scene.layer, towards))
    name = next((name for kind, name in PRESCRIBED.items() if isinstance(scene.loading, kind)), "")
    if not name:
        return nudged
    values = getattr(scene.loading, name)
    try:
        return nudged.replace(loading=scene.loading.replace(**{name: _nudged(values, towards)}))
    except InvalidInput:
        return nudged


def _nudged(values: FloatArray, towards: float) -> FloatArray:
    """Each number one unit in the last place away; a zero means that nothing is pressed, and stays."""
    return np.where(values == 0.0, values, np.nextafter(values, towards))


def _nudged_layer(layer: ElasticLayer, towards: float) -> ElasticLayer:
    """Modulus and thickness one unit in the last place away; of stacks and graded layers all depths."""
    if not isinstance(layer, Layer):
        return layer.stretched(math.nextafter(1.0, towards))
    layer = layer.replace(youngs_modulus=math.nextafter(layer.youngs_modulus, towards))
    return layer if layer.is_half_space else layer.replace(thickness=math.nextafter(layer.thickness, towards))


def _spread(place: tuple[str, str, str], repeated: list[Quantity]) -> float:
    lengths = {len(quantity.values) for quantity in repeated}
    if len(lengths) > 1:
        raise InvalidInput(f"{' / '.join(place)}: repetitions give {sorted(lengths)} steps; the steps must not vary")
    steps = zip(*(quantity.values for quantity in repeated), strict=True)
    return max((relative_spread(step, repeated[0].scale) for step in steps), default=0.0)


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
