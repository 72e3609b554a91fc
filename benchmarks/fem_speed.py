"""What the finite element reference costs on one core: processor seconds and memory of four typical tasks.

Run ``OMP_NUM_THREADS=1 python -m benchmarks.fem_speed``; with CalculiX installed, its time is shown beside.
"""

from __future__ import annotations

import shutil
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from benchmarks import calculix_flat_punch
from contact import FlatPunch, IndentationDepths, Layer, Paraboloid, Scene, StageLog
from contact.answer.stages import peak_memory_bytes
from fem_reference import Fem
from fem_reference.discrete_layer.settings import Discretisation
from fem_reference.elastic.contact_search import ContactSearch
from tests.mdr.viscoelastic_scenes import figure_12

REPEATS = 5
LAYER = Layer.incompressible(thickness=1e-3, shear_modulus=1e6)


@dataclass(frozen=True)
class Task:
    """Name, what to time after what set-up, and the CPU seconds it may take."""

    name: str
    run: Callable[[], object]
    allowed: float


def flat_punch(accuracy: float) -> Callable[[], object]:
    """A flat punch on an incompressible layer, a/h = 1, error estimate included."""
    scene = Scene(layer=LAYER, indenter=FlatPunch(radius=1e-3), loading=IndentationDepths([1e-6]))
    return lambda: Fem(accuracy=accuracy).solve(scene)


def curve_of_200_depths() -> Callable[[], object]:
    """Force over depth of a paraboloid up to a/h = 1, contact sets found; the factorisation is made before."""
    depths = np.linspace(0.01, 1, 200) * 5.6e-5
    scene = Scene(layer=LAYER, indenter=Paraboloid(radius_of_curvature=1e-2), loading=IndentationDepths(depths))
    search = ContactSearch(scene, 1.2e-3, Discretisation(), "superlu", StageLog())
    return lambda: [search.at_depth(float(depth)).force for depth in depths]


def tasks() -> list[Task]:
    """All tasks with what they may take."""
    return [
        Task("flat punch to 1e-5", flat_punch(1e-5), 1.0),
        Task("flat punch to 1e-6", flat_punch(1e-6), 1.0),
        Task("curve of 200 depths after set-up", curve_of_200_depths(), 0.5),
        Task("impact of Fig. 12, h = 2 mm", lambda: Fem().solve(figure_12(2e-3)), 0.5),
    ]


def seconds(task: Task) -> float:
    """Least CPU seconds of a few runs, the first one to warm up."""
    task.run()
    taken = []
    for _ in range(REPEATS):
        start = time.process_time()
        task.run()
        taken.append(time.process_time() - start)
    return min(taken)


def megabytes() -> float:
    """Peak resident memory of this process, its libraries included."""
    return peak_memory_bytes() / 2**20


def main() -> None:
    """One line for each task, then memory, then the comparison with CalculiX."""
    for task in tasks():
        sys.stdout.write(f"{task.name:34} {seconds(task):6.3f} s CPU (allowed {task.allowed:g})\n")
    sys.stdout.write(f"{'peak memory of all of them':34} {megabytes():6.0f} MB (allowed 500)\n")
    if shutil.which("ccx") is None:
        sys.stdout.write("CalculiX is not installed (Debian package calculix-ccx): no comparison\n")
    else:
        calculix_flat_punch.main()


if __name__ == "__main__":
    main()
