"""What a user waits for, this source against another revision in turn: processor times, their ratio, and what moved.

    python -m benchmarks.waiting REVISION [ROW..] [--rounds 7]

Each row runs in a fresh interpreter of each source, in reversed order every other round, after one round that nobody
counts and that leaves compiled bytecode, as an installed package has it.  "First" rows take the whole process from its
start; "warm" rows what a second call takes; "data" rows the first call of a process, without the imports.  The ratio
is this source over the revision, the median over the rounds with its 95 % interval; rows that lose are printed first.
The last columns are the largest relative change of the answers and the peak memory of the process.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from benchmarks.race.slowdown import Slowdown, slowdown
from benchmarks.race.worktree import worktree
from cases.gate.write_permission import SOURCE
from cases.run.timing import SAMPLES

HEAD = """
import json, resource, time
import numpy as np
from contact import *
layer = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.45, support="bonded")
ball, loading = Paraboloid(radius_of_curvature=0.01), IndentationDepths([5e-5])
scene = Scene(layer=layer, indenter=ball, loading=loading)
def forces(path):
    return np.concatenate([path.normal_force, path.contact_radius, path.contact_stiffness]).tolist()
def tell(seconds, answers):
    print(json.dumps([seconds, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024, answers]))
"""
FIRST = "\nfound = forces(solve())\ntell(time.process_time(), found)"
ONCE = """
start = time.process_time()
path = solve()
tell(time.process_time() - start, forces(path))
"""
WARM = "\nsolve()" + ONCE
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
THICKNESSES = """
from bem.layer_equation.flat_punch_source import IntegralEquation
from mdr.batches import equilibria
def pressed(h):
    return Scene(layer=layer.replace(thickness=float(h)), indenter=indenter, loading=prescribed)
scenes = [pressed(h) for h in np.geomspace(2e-4, 1e-2, 1000)]
solve = lambda source=IntegralEquation(): equilibria(scenes, source)
equilibria(scenes[::50], IntegralEquation())
forces = lambda found: np.concatenate([found.normal_force, found.contact_radius, found.indentation_depth]).tolist()
"""
# Where a source has compiled impacts and numba is installed; otherwise the row is what NumPy takes.
COMPILED = """
from importlib.util import find_spec
fast = {"compiled": True} if hasattr(Mdr(), "compiled") and find_spec("numba") else {}
"""
FAST_MANY = MANY.replace("impacts(scenes, source)", "impacts(scenes, source, **fast)")
FAST_ONE = ONE.replace("accuracy=1e-6", "accuracy=1e-6, **fast")
CONE, SPHERE = "indenter = TruncatedCone(flat_radius=5e-4, slope=0.1)\n", "indenter = Sphere(radius=0.01)\n"
DEEP, WIDE = "prescribed = IndentationDepths([5e-5])", "prescribed = ContactRadii([1e-3])"
MILLION = """
from mdr import Mdr
loading = {loading}
scene = scene.replace(loading=loading)
Mdr().solve(scene.replace(loading=type(loading)(loading.values[::100_000])))
solve = lambda: Mdr().solve(scene)
forces = lambda path: np.concatenate([getattr(path, name)[::1000] for name in path.ARRAYS]).tolist()
"""
DATA = (
    MDR
    + """
solve()
scene = scene.replace(indenter=Paraboloid(radius_of_curvature=1.0), loading=ContactRadii([{ratio} * 1e-3]))
"""
)
PRONY = """
def blow(h, R, own=blow):
    series = PronySeries(long_term_shear_modulus=7.5e6 / 9, shear_moduli=[7.5e6], relaxation_times=[1e-3])
    return own(h, R).replace(effects=(series,))
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
    "warm, 2 000 impacts, compiled": IMPACTS + COMPILED + FAST_MANY + WARM,
    "warm, 10 000 impacts, compiled": IMPACTS + COMPILED + FAST_MANY.replace("2000", "10_000") + WARM,
    "warm, 20 impacts one by one, compiled": IMPACTS + COMPILED + FAST_ONE + WARM,
    "warm, 20 impacts one by one to 1e-9, compiled": IMPACTS + COMPILED + FAST_ONE.replace("1e-6", "1e-9") + WARM,
    "first impact, compiled": IMPACTS + COMPILED + FAST_ONE.replace("range(20)", "range(1)") + FIRST,
    "warm, 20 impacts one by one": IMPACTS + ONE + WARM,
    "warm, 20 impacts one by one to 1e-9": IMPACTS + ONE.replace("1e-6", "1e-9") + WARM,
    "warm, 20 impacts one by one, one Prony branch": IMPACTS + PRONY + ONE + WARM,
    "warm, 1 000 thicknesses, truncated cone by depth": CONE + DEEP + THICKNESSES + ONCE,
    "warm, 1 000 thicknesses, truncated cone by radius": CONE + WIDE + THICKNESSES + ONCE,
    "warm, 1 000 thicknesses, sphere by depth": SPHERE + DEEP + THICKNESSES + ONCE,
    "warm, 1 000 thicknesses, sphere by radius": SPHERE + WIDE + THICKNESSES + ONCE,
    "data, a million depths": MILLION.format(loading="IndentationDepths(np.linspace(1e-7, 1e-4, 1_000_000))") + ONCE,
    "data, a million forces": MILLION.format(loading="NormalForces(np.linspace(1e-6, 0.3, 1_000_000))") + ONCE,
    **{f"data, first solve at a/h = {ratio}": DATA.format(ratio=ratio) + ONCE for ratio in (60, 159, 165, 900)},
}


def asked(folder: Path, row: str, bytecode: str) -> tuple[float, float, np.ndarray]:
    """Processor seconds, peak memory [MB] and answers of one row in one source."""
    environment = {**os.environ, "PYTHONPATH": str(folder), "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    environment |= {"PYTHONPYCACHEPREFIX": bytecode, "PYTHONDONTWRITEBYTECODE": ""}
    run = subprocess.run(
        [sys.executable, "-c", HEAD + ROWS[row]],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    )
    seconds, memory, answers = json.loads(run.stdout)
    return seconds, memory, np.array(answers)


def raced(row: str, base: Path, head: Path, rounds: int, bytecode: str) -> tuple[Slowdown, str]:
    """The ratio and one line of the table."""
    times: dict[Path, list[float]] = {base: [], head: []}
    answers, memory = {}, {}
    for number in range(rounds + 1):
        for source in reversed(times) if number % 2 else times:
            seconds, memory[source], answers[source] = asked(source, row, bytecode)
            # The first round leaves bytecode.
            times[source] += [seconds] if number else []
    ratio = slowdown(times[base], times[head])
    moved = float(np.max(np.abs(answers[head] / answers[base] - 1)))
    spread = f"{ratio.ratio:.3g} ({ratio.lower:.3g} to {ratio.upper:.3g})"
    before, now = (float(np.median(times[source])) for source in (base, head))
    sizes = f"{memory[base]:.0f} | {memory[head]:.0f}"
    return ratio, f"| {row} | {before:.3g} | {now:.3g} | {spread} | {moved:.0e} | {sizes} |"


def main() -> None:
    """Print the table, losing rows first."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.waiting")
    parser.add_argument("revision", help="what to compare with, anything git understands")
    parser.add_argument("rows", nargs="*", help="only rows whose names contain one of these")
    parser.add_argument("--rounds", type=int, default=SAMPLES, help=f"how often each is timed, at least {SAMPLES}")
    given = parser.parse_args()
    rows = [row for row in ROWS if not given.rows or any(word in row for word in given.rows)]
    found = []
    with worktree(SOURCE, given.revision) as folder, tempfile.TemporaryDirectory() as bytecode:
        for row in rows:
            found.append(raced(row, folder, SOURCE, given.rounds, bytecode))
            sys.stderr.write(f"{found[-1][1]}\n")
    sys.stdout.write(
        "| row | seconds before | now | ratio | answers moved | MB before | now |\n|---|---|---|---|---|---|---|\n"
    )
    for _, text in sorted(found, key=lambda pair: -pair[0].ratio):
        sys.stdout.write(f"{text}\n")


if __name__ == "__main__":
    main()
