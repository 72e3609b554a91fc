"""What a user waits for, this source against another revision in turn: processor times, their ratio, and what moved.

    python -m benchmarks.waiting REVISION [ROW..] [--rounds 7]

Each row runs in a fresh interpreter of each source, in reversed order every other round.  "First" rows take the whole
process from its start; "warm" rows what a second call takes.  The ratio is this source over the revision, the median
over the rounds with its 95 % interval; rows that lose are printed first.  The last column is the largest relative
change of the answers.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np

from benchmarks.race.slowdown import Slowdown, slowdown
from benchmarks.race.worktree import worktree
from cases.gate.write_permission import SOURCE
from cases.run.timing import SAMPLES

HEAD = """
import json, time
import numpy as np
from contact import *
layer = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.45, support="bonded")
ball, loading = Paraboloid(radius_of_curvature=0.01), IndentationDepths([5e-5])
scene = Scene(layer=layer, indenter=ball, loading=loading)
def forces(path):
    return np.concatenate([path.normal_force, path.contact_radius, path.contact_stiffness]).tolist()
"""
FIRST = "\nfound = forces(solve())\nprint(json.dumps([time.process_time(), found]))"
WARM = """
solve()
start = time.process_time()
path = solve()
print(json.dumps([time.process_time() - start, forces(path)]))
"""
BEM = "from bem import Bem\nsolve = lambda: Bem(points={points}).solve(scene)"
FEM = "from fem_reference import Fem\nsolve = lambda: Fem(accuracy=1e-4).solve(scene)"
MDR = "from mdr import Mdr\nsolve = lambda: Mdr().solve(scene)"
IMPACTS = """
from mdr import Mdr
rng = np.random.default_rng(3)
solid = StandardSolid(long_term_shear_modulus=7.5e6 / 9, maxwell_shear_modulus=7.5e6, viscosity=7.5e3)
def blow(h, R):
    impact = Impact(mass=0.02, velocity=1.27479e-3 / R)
    soft = Layer.incompressible(thickness=h, shear_modulus=7.5e6 * 10 / 9)
    return Scene(layer=soft, indenter=Paraboloid(radius_of_curvature=R), loading=impact, effects=(solid,))
"""
MANY = """
from bem.layer_equation.flat_punch_source import IntegralEquation
from mdr.batches import impacts
scenes = [blow(*pair) for pair in zip(rng.uniform(5e-4, 5e-3, 2000), rng.uniform(2e-3, 5e-2, 2000))]
solve = lambda source=IntegralEquation(): impacts(scenes, source)
forces = lambda found: found.coefficient_of_restitution.tolist()
"""
ONE = """
one = Mdr(accuracy=1e-6)
solve = lambda: [one.solve(blow(1e-3, 1e-2)) for _ in range(20)][0]
forces = lambda found: [found.coefficient_of_restitution]
"""
ROWS = {
    "first answer, Mdr": MDR + FIRST,
    "first answer, Bem 256": BEM.format(points=256) + FIRST,
    "first answer, Fem 1e-4": FEM + FIRST,
    "warm, Bem 512": BEM.format(points=512) + WARM,
    "warm, Bem 512 by force": "loading = NormalForces([0.05])\nscene = scene.replace(loading=loading)\n"
    + BEM.format(points=512)
    + WARM,
    "warm, Bem 512 by radius": "scene = scene.replace(loading=ContactRadii([1e-3]))\n" + BEM.format(points=512) + WARM,
    "warm, Bem 512 truncated cone": "cone = TruncatedCone(flat_radius=5e-4, slope=0.1)\n"
    "scene = scene.replace(indenter=cone)\n" + BEM.format(points=512) + WARM,
    "warm, 2 000 impacts": IMPACTS + MANY + WARM,
    "warm, 20 impacts one by one": IMPACTS + ONE + WARM,
}


def asked(folder: Path, row: str) -> tuple[float, np.ndarray]:
    """Processor seconds and answers of one row in one source."""
    environment = {**os.environ, "PYTHONPATH": str(folder), "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    run = subprocess.run(
        [sys.executable, "-c", HEAD + ROWS[row]],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    )
    seconds, answers = json.loads(run.stdout)
    return seconds, np.array(answers)


def line(row: str, base: list[float], head: list[float], moved: float) -> tuple[Slowdown, str]:
    """The ratio and one line of the table."""
    ratio = slowdown(base, head)
    spread = f"{ratio.ratio:.3g} ({ratio.lower:.3g} to {ratio.upper:.3g})"
    return ratio, f"| {row} | {np.median(base):.3g} | {np.median(head):.3g} | {spread} | {moved:.0e} |"


def main() -> None:
    """Print the table, losing rows first."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.waiting")
    parser.add_argument("revision", help="what to compare with, anything git understands")
    parser.add_argument("rows", nargs="*", help="only rows whose names contain one of these")
    parser.add_argument("--rounds", type=int, default=SAMPLES, help=f"how often each is timed, at least {SAMPLES}")
    given = parser.parse_args()
    rows = [row for row in ROWS if not given.rows or any(word in row for word in given.rows)]
    found = []
    with worktree(SOURCE, given.revision) as folder:
        for row in rows:
            times: dict[Path, list[float]] = {folder: [], SOURCE: []}
            answers = {}
            for number in range(given.rounds):
                for source in reversed(times) if number % 2 else times:
                    seconds, answers[source] = asked(source, row)
                    times[source].append(seconds)
            moved = float(np.max(np.abs(answers[SOURCE] / answers[folder] - 1)))
            found.append(line(row, times[folder], times[SOURCE], moved))
            sys.stderr.write(f"{found[-1][1]}\n")
    sys.stdout.write("| row | seconds before | now | ratio | answers moved |\n|---|---|---|---|---|\n")
    for _, text in sorted(found, key=lambda pair: -pair[0].ratio):
        sys.stdout.write(f"{text}\n")


if __name__ == "__main__":
    main()
