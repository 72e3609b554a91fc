"""Flat punch on a bonded layer (nu = 0.3, a/h = 1) to 1e-5: CalculiX and this project, side by side in one run.

CalculiX solves quadratic axisymmetric triangles (CAX6) on the same kind of graded mesh, refined until its error is
below 1e-5.  Run ``python -m benchmarks.calculix_flat_punch``; it needs the program ``ccx`` (Debian: calculix-ccx).
"""

from __future__ import annotations

import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from contact import FlatPunch, IndentationDepths, Layer, Scene
from fem_reference import Fem
from fem_reference.discrete_layer.elements import PAIRS
from fem_reference.discrete_layer.mesh import Grading, layer_mesh
from fem_reference.discrete_layer.problem import LayerProblem

POISSONS_RATIO = 0.3
# k_N / (E* a), from the integral equation.
STIFFNESS = 2 * 2.48352462914
# Outer radius of the section: it costs exp(-2 s (R - a) / h) = 5e-7 of the stiffness, s = 0.913.
OUTER_RADIUS = 9.0
ACCURACY = 1e-5
# CalculiX turns an axisymmetric mesh into a wedge of two degrees, of which 180 make the whole.
WEDGES = 180.0


@dataclass(frozen=True)
class Run:
    """One solved punch: relative error of the stiffness, CPU seconds, peak memory of the solving process."""

    error: float
    seconds: float
    unknowns: int
    megabytes: float


def calculix_input(growth: float) -> tuple[str, int]:
    """Input deck of a unit depth at E* = 1, and its number of nodes."""
    mesh = layer_mesh(1.0, OUTER_RADIUS, Grading(points=((1.0, 1e-5),), growth=growth, max_cell=growth))
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


def run_calculix(growth: float) -> Run:
    """Mesh and solve by CalculiX; CPU seconds of both."""
    start = time.process_time()
    deck, nodes = calculix_input(growth)
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


def run_ours(growth: float) -> Run:
    """Solve by this project, error estimate included; its error is the stated one if that is larger than the true."""
    layer = Layer(thickness=1.0, youngs_modulus=1 - POISSONS_RATIO**2, poissons_ratio=POISSONS_RATIO)
    scene = Scene(layer=layer, indenter=FlatPunch(radius=1.0), loading=IndentationDepths([1.0]))
    path = Fem(growth=growth, edge_cell=1e-5, truncation=1e-6).solve(scene)
    error = max(abs(path.contact_stiffness[0] / STIFFNESS - 1), path.error_estimate["contact_stiffness"][0])
    return Run(float(error), path.cost.cpu_seconds, path.cost.unknowns, path.cost.peak_memory_bytes / 2**20)


def compare() -> tuple[Run, Run]:
    """Each program on the coarsest of a row of meshes on which it reaches 1e-5.

    Raises:
        RuntimeError: CalculiX is not installed, or a program reaches 1e-5 on no mesh of its row.
    """
    if shutil.which("ccx") is None:
        raise RuntimeError("the program ccx is not installed (Debian package calculix-ccx)")
    # Both are timed after a first run.
    run_ours(2.0)
    return _coarsest(run_calculix, (0.25, 0.18, 0.14, 0.11, 0.09)), _coarsest(run_ours, (1.0, 0.85, 0.7, 0.6, 0.5))


def _coarsest(run: Callable[[float], Run], growths: tuple[float, ...]) -> Run:
    for growth in growths:
        result = run(growth)
        if result.error < ACCURACY:
            return result
    raise RuntimeError(f"{run.__name__} ends at an error of {result.error:.1e}")


def main() -> None:
    """Write one line for each program."""
    theirs, ours = compare()
    for name, run in (("CalculiX", theirs), ("ours", ours)):
        size = f"{run.unknowns:6d} unknowns  {run.megabytes:.0f} MB"
        sys.stdout.write(f"{name:9} error {run.error:.1e}  CPU {run.seconds:7.3f} s  {size}\n")
    sys.stdout.write(f"ours is {theirs.seconds / ours.seconds:.1f} times faster\n")


if __name__ == "__main__":
    main()
