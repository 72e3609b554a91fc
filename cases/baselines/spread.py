"""How far a number moves when its inputs move by one unit in the last place: the measure of its last stable digit."""

from collections.abc import Iterator

import numpy as np

from cases.results import SceneRun
from cases.solve import solve
from cases.task import Task
from cases.tolerance import relative_spread
from contact import Scene


def perturbed(scene: Scene) -> Iterator[Scene]:
    """Yield the scene with thickness, modulus and Poisson's ratio moved by one unit in the last place each."""
    layer = scene.layer
    if not layer.is_half_space:
        yield scene.replace(layer=layer.replace(thickness=float(np.nextafter(layer.thickness, np.inf))))
    if not scene.effects:  # a viscoelastic effect ties its moduli to the layer's
        yield scene.replace(layer=layer.replace(youngs_modulus=float(np.nextafter(layer.youngs_modulus, np.inf))))
        yield scene.replace(layer=layer.replace(poissons_ratio=float(np.nextafter(layer.poissons_ratio, 0.0))))


def measured_spreads(task: Task, answer: SceneRun) -> dict[str, float]:
    """Return the relative spread of each quantity over ``answer`` and its perturbed repeats, the worst step's."""
    repeats = [solve(task.changed(f"ulp {i}", problem=p), "") for i, p in enumerate(perturbed(task.problem))]
    solved = [answer, *(run for run in repeats if run.solved)]
    return {
        quantity.name: max(
            relative_spread([run.quantity(quantity.name).values[step] for run in solved], scale=0.0)
            for step in range(len(quantity.values))
        )
        for quantity in answer.quantities
    }
