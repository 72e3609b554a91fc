"""Flat punch on a bonded layer (nu = 0.3, a/h = 1): CalculiX and this project, side by side to equal errors.

CalculiX solves quadratic axisymmetric triangles (CAX6) on the same kind of graded mesh, judged by its true error; this
project is judged by the error that it states.  Of all growths and edge cells or degrees tried the quickest counts.
Run ``python -m benchmarks.calculix_flat_punch [accuracies]``; it needs the program ``ccx`` (Debian: calculix-ccx).
"""

from __future__ import annotations

import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from contact import FlatPunch, IndentationDepths, Layer, Scene
from fem_reference import Fem
from fem_reference.discrete_layer.elements import PAIRS
from fem_reference.discrete_layer.grading import Grading
from fem_reference.discrete_layer.mesh import layer_mesh
from fem_reference.discrete_layer.problem import LayerProblem

POISSONS_RATIO = 0.3
# k_N / (E* a), from the integral equation.
STIFFNESS = 2 * 2.48352462914
# An outer radius R of the section costs exp(-2 s (R - a) / h) of the stiffness, s = 0.913.
DECAY = 2 * 0.913
ACCURACIES = (1e-2, 3e-3, 1e-3, 2e-4, 1e-5)
# Growths, coarsest first, of both and of CalculiX alone, and edge cells over the accuracy.
GROWTHS = (2.0, 1.4, 1.2, 1.0, 0.85, 0.7, 0.6, 0.5, 0.4)
THEIR_GROWTHS = (*GROWTHS, 0.32, 0.25, 0.18, 0.14, 0.11, 0.09)
EDGE_CELLS = (10.0, 3.0, 1.0)
DEGREES = (3, 4)
# Each is timed so often; the least counts.
REPEATS = 3
# CalculiX turns an axisymmetric mesh into a wedge of two degrees, of which 180 make the whole.
WEDGES = 180.0


@dataclass(frozen=True)
class Run:
    """One solved punch: relative error of the stiffness, CPU seconds, peak memory of the solving process."""

    error: float
    seconds: float
    unknowns: int
    megabytes: float


def calculix_input(growth: float, edge_cell: float, outer_radius: float) -> tuple[str, int]:
    """Input deck of a unit depth at E* = 1, and its number of nodes."""
    mesh = layer_mesh(1.0, outer_radius, Grading(points=((1.0, edge_cell),), growth=growth, max_cell=growth))
    problem = LayerProblem(mesh, PAIRS["P2"], POISSONS_RATIO, "bonded")
    r, z = problem.positions
    # Vertices 0, 1, 2, then the midpoints of 01, 12 and 02.
    corners = np.array(problem.space.displacement_dofs.element_dofs[:6].T)
    first, second, third = mesh.mesh.p[:, mesh.mesh.t].transpose(1, 0, 2)
    turned = (
        np.cross(np.vstack([second - first, 0 * first[:1]]).T, np.vstack([third - first, 0 * first[:1]]).T)[:, 2] < 0
    )
    corners[turned] = corners[turned][:, [0, 2, 1, 5, 4, 3]]
    # CalculiX reads twenty characters of a number
    nodes = "\n".join(f"{i + 1},{x:.12g},{y:.12g}" for i, (x, y) in enumerate(zip(r, z, strict=True)))
    elements = "\n".join(",".join(map(str, [i + 1, *(row + 1)])) for i, row in enumerate(corners))

    def node_set(name: str, members: np.ndarray) -> str:
        return f"*NSET,NSET={name}\n" + "\n".join(f"{n + 1}," for n in members)

    young = 1 - POISSONS_RATIO**2
    deck = f"""*NODE
{nodes}
*ELEMENT,TYPE=CAX6,ELSET=LAYER
{elements}
{node_set("AXIS", problem.nodes_on("axis"))}
{node_set("BASE", problem.nodes_on("base"))}
{node_set("PUNCH", problem.top_nodes(1.0))}
*MATERIAL,NAME=ELASTIC
*ELASTIC
{young:.12g},{POISSONS_RATIO}
*SOLID SECTION,ELSET=LAYER,MATERIAL=ELASTIC
*STEP
*STATIC
*BOUNDARY
AXIS,1,1
BASE,1,2
PUNCH,2,2,1.
*NODE PRINT,NSET=PUNCH,TOTALS=ONLY
RF
*END STEP
"""
    return deck, len(r)


def run_calculix(growth: float, edge_cell: float, outer_radius: float) -> Run:
    """Mesh and solve by CalculiX; CPU seconds of both."""
    start = time.process_time()
    deck, nodes = calculix_input(growth, edge_cell, outer_radius)
    meshing = time.process_time() - start
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "punch.inp").write_text(deck)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(["ccx", "punch"], cwd=folder, check=True, capture_output=True, env={"OMP_NUM_THREADS": "1"})
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        lines = Path(folder, "punch.dat").read_text().split("\n")
    headline = next(i for i, line in enumerate(lines) if "total force" in line)
    force = float(lines[headline + 2].split()[1])
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    error = abs(WEDGES * force) / STIFFNESS - 1
    return Run(abs(error), meshing + seconds, 2 * nodes, after.ru_maxrss / 1024)


def run_ours(degree: int, growth: float, edge_cell: float, truncation: float) -> Run:
    """Solve by this project, error estimate included; its error is the stated one if that is larger than the true."""
    layer = Layer(thickness=1.0, youngs_modulus=1 - POISSONS_RATIO**2, poissons_ratio=POISSONS_RATIO)
    scene = Scene(
        layer=layer, indenter=FlatPunch(radius=1.0), loading=IndentationDepths([1.0]), beyond_small_strains=True
    )
    path = Fem(order=degree, growth=growth, edge_cell=edge_cell, truncation=truncation).solve(scene)
    error = max(abs(path.contact_stiffness[0] / STIFFNESS - 1), path.error_estimate["contact_stiffness"][0])
    return Run(float(error), path.cost.cpu_seconds, path.cost.unknowns, path.cost.peak_memory_bytes / 2**20)


def compare(accuracy: float) -> tuple[Run, Run]:
    """Each program at the quickest settings that reach the accuracy; the outer edge costs a tenth of it.

    Raises:
        RuntimeError: CalculiX is not installed, or a program does not reach the accuracy.
    """
    if shutil.which("ccx") is None:
        raise RuntimeError("the program ccx is not installed (Debian package calculix-ccx)")
    outer_radius = 1.0 + float(np.log(10 / accuracy)) / DECAY
    cells = [min(times * accuracy, 0.1) for times in EDGE_CELLS]

    def theirs(cell: float) -> Callable[[float], Run]:
        return lambda growth: run_calculix(growth, cell, outer_radius)

    def ours(degree: int) -> Callable[[float], Run]:
        return lambda growth: run_ours(degree, growth, accuracy, accuracy / 10)

    best = (
        _quickest([theirs(cell) for cell in cells], THEIR_GROWTHS, accuracy),
        _quickest([ours(degree) for degree in DEGREES], GROWTHS, accuracy),
    )
    # Both are timed in turn.
    runs = [[run() for run in best] for _ in range(REPEATS)]
    their_best, our_best = (min(found, key=lambda run: run.seconds) for found in zip(*runs, strict=True))
    return their_best, our_best


def _quickest(rows: Sequence[Callable[[float], Run]], growths: Sequence[float], accuracy: float) -> Callable[[], Run]:
    """Of the first growth of every row that reaches the accuracy, the quickest in a second run."""
    reached = [(row, next((g for g in growths if row(g).error < accuracy), None)) for row in rows]
    runs = [(row(growth).seconds, partial(row, growth)) for row, growth in reached if growth is not None]
    if not runs:
        raise RuntimeError(f"an error of {accuracy:g} was not reached")
    return min(runs, key=lambda run: run[0])[1]


def main() -> None:
    """Write two lines for each accuracy."""
    for accuracy in [float(word) for word in sys.argv[1:]] or ACCURACIES:
        theirs, ours = compare(accuracy)
        for name, run in (("CalculiX", theirs), ("ours", ours)):
            size = f"{run.unknowns:6d} unknowns  {run.megabytes:.0f} MB"
            sys.stdout.write(f"{accuracy:g} {name:9} error {run.error:.1e}  CPU {run.seconds:7.3f} s  {size}\n")
        sys.stdout.write(f"ours is {theirs.seconds / ours.seconds:.1f} times faster\n")


if __name__ == "__main__":
    main()
