"""Processor time of this working tree and of another revision on the same rows, measured alternately.

    python -m benchmarks.race REVISION [ROW..] [--rounds 7]

Each sample is a fresh interpreter. Revision, working tree and the revision once more take turns, in reversed order
every other round, after one round that is not counted and that writes compiled bytecode. "First" rows time the whole
process, "warm" rows a second solve, "batch" rows one call after its imports. A row prints the median ratio of the
working tree to the revision with its 95 % interval, the limit of the ratio, the largest relative change of the answers
and the peak memory. Exit codes: 0 no row is slower than its limit; 1 some row is; 4 wrong usage.
"""

import argparse
import json
import math
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from cases.run.stamp import SOURCE, git
from cases.run.timing import SAMPLES
from cases.verdicts import ExitCode, Status
from contact import InvalidInput

# Resampled medians for the 95 % interval: with half as many its ends scatter by 2 % of its width, with twice by 1 %.
BOOTSTRAPS = 4000
# Seed of the resampling: equal times give an equal interval.
SEED = 20230420

PREPARED = """
import json, resource, time
import numpy as np
from contact import *
layer = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.45, support="bonded")
scene = Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=0.01), loading=IndentationDepths([5e-5]))
def numbers(path):
    return np.concatenate([path.normal_force, path.contact_radius, path.contact_stiffness]).tolist()
def report(seconds, answers):
    print(json.dumps([seconds, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024, answers]))
"""
FIRST = "\nfound = numbers(solve())\nreport(time.process_time(), found)"
ONCE = """
start = time.process_time()
path = solve()
report(time.process_time() - start, numbers(path))
"""
# Repeats the solve for a tenth of a second: shorter samples scatter by the resolution of the clock.
WARM = """
solve()
start = time.process_time()
solve()
count = 1 + int(0.1 / max(time.process_time() - start, 1e-6))
start = time.process_time()
for _ in range(count):
    path = solve()
report((time.process_time() - start) / count, numbers(path))
"""
MDR = "from mdr import Mdr\nsolve = lambda: Mdr().solve(scene)\n"
BEM = "from bem import Bem\nsolve = lambda: Bem(points=512).solve(scene)\n"
FEM = "from fem_reference import Fem\nsolve = lambda: Fem(accuracy={accuracy}).solve(scene)\n"
PULL_OFF = """
scene = scene.replace(loading=Detachment(control="force"), effects=(Adhesion(work_of_adhesion=0.05),))
numbers = lambda path: [path.pull_off_force, path.pull_off_depth]
"""
HISTORY = """
instants = np.linspace(0.0, 1.0, 100)
loading = DepthHistory(time=instants, depth=5e-5 * np.sin(np.pi * instants))
solid = StandardSolid(long_term_shear_modulus=1e5, maxwell_shear_modulus=3e5, viscosity=3e4)
soft = Layer.incompressible(thickness=1e-3, shear_modulus=4e5)
scene = Scene(layer=soft, indenter=scene.indenter, loading=loading, effects=(solid,))
numbers = lambda path: path.normal_force.tolist()
"""
IMPACTS = """
rng = np.random.default_rng(3)
solid = StandardSolid(long_term_shear_modulus=7.5e6 / 9, maxwell_shear_modulus=7.5e6, viscosity=7.5e3)
def blow(h, R):
    impact = Impact(mass=0.02, velocity=1.27479e-3 / R)
    soft = Layer.incompressible(thickness=h, shear_modulus=7.5e6 * 10 / 9)
    return Scene(layer=soft, indenter=Paraboloid(radius_of_curvature=R), loading=impact, effects=(solid,))
"""
ONE_IMPACT = """
method = Mdr(accuracy=1e-6)
solve = lambda: [method.solve(blow(1e-3, 1e-2)) for _ in range(20)][0]
numbers = lambda history: [history.coefficient_of_restitution]
"""
MANY_IMPACTS = """
from bem.flat_punch import IntegralEquation
from mdr.batches import impacts
scenes = [blow(*pair) for pair in zip(rng.uniform(5e-4, 5e-3, 1000), rng.uniform(2e-3, 5e-2, 1000))]
solve = lambda source=IntegralEquation(): impacts(scenes, source)
numbers = lambda found: found.coefficient_of_restitution.tolist()
"""
THICKNESSES = """
from bem.flat_punch import IntegralEquation
from mdr.batches import equilibria
cone = TruncatedCone(flat_radius=5e-4, slope=0.1)
scenes = [
    Scene(layer=layer.replace(thickness=float(h)), indenter=cone, loading=IndentationDepths([5e-5]))
    for h in np.geomspace(2e-4, 1e-2, 1000)
]
solve = lambda source=IntegralEquation(): equilibria(scenes, source)
equilibria(scenes[::50], IntegralEquation())
numbers = lambda found: np.concatenate([found.normal_force, found.contact_radius]).tolist()
"""
MILLION = """
scene = scene.replace(loading=IndentationDepths(np.linspace(1e-7, 1e-4, 1_000_000)))
Mdr().solve(scene.replace(loading=IndentationDepths(scene.loading.values[::100_000])))
numbers = lambda path: np.concatenate([path.normal_force[::1000], path.contact_radius[::1000]]).tolist()
"""
MAP = """
from mdr.curves import ForceCurve, fit_map
gel = scene.replace(layer=Layer(thickness=5e-6, youngs_modulus=5e3, poissons_ratio=0.5), indenter=Sphere(radius=1e-5))
gel = gel.replace(loading=IndentationDepths([2.5e-6]))
rng, depth = np.random.default_rng(1), np.linspace(-5e-7, 1.87e-6, 126)
clean = np.exp(0.5 * rng.standard_normal((4096, 1))) * ForceCurve(gel)(depth)
force = clean + 0.01 * clean.max(axis=1, keepdims=True) * rng.standard_normal(clean.shape)
solve = lambda: fit_map(gel, depth, force)
numbers = lambda found: found.youngs_modulus.tolist()
"""


def _with_loading(loading: str) -> str:
    """Line of a program that replaces the loading of its scene."""
    return f"scene = scene.replace(loading={loading})\n"


# Program of each row and the largest accepted ratio of its times; ratios below 1.1 are noise.
ROWS: dict[str, tuple[str, float]] = {
    "first answer, Mdr": (MDR + FIRST, 1.2),
    "warm, Mdr by radius": (MDR + _with_loading("ContactRadii([1e-3])") + WARM, 2.0),
    "warm, Mdr by depth": (MDR + WARM, 2.0),
    "warm, Mdr by force": (MDR + _with_loading("NormalForces([0.05])") + WARM, 2.0),
    "warm, pull-off": (MDR + PULL_OFF + WARM, 1.1),
    "warm, history of 100 instants": (MDR + HISTORY + WARM, 2.0),
    "warm, 20 impacts to 1e-6, one by one": (MDR + IMPACTS + ONE_IMPACT + WARM, 2.0),
    "warm, 1 000 impacts": (MDR + IMPACTS + MANY_IMPACTS + WARM, 2.0),
    "batch, 1 000 thicknesses": (THICKNESSES + ONCE, 2.0),
    "batch, a million depths": (MDR + MILLION + ONCE, 2.0),
    "batch, a map of 4 096 curves": (MAP + ONCE, 2.0),
    "warm, Bem 512": (BEM + WARM, 2.0),
    "warm, Fem 1e-4": (FEM.format(accuracy=1e-4) + WARM, 2.0),
    "warm, Fem 1e-6": (FEM.format(accuracy=1e-6) + WARM, 2.0),
}


@dataclass(frozen=True, kw_only=True)
class Slowdown:
    """Median ratio of paired times and the ends of its 95 % interval."""

    ratio: float
    lower: float
    upper: float


def slowdown(base: Sequence[float], head: Sequence[float]) -> Slowdown:
    """Median ratio of times of head over base [s], shape (n,) each, with its bootstrap interval.

    Raises:
        InvalidInput: there are fewer than seven pairs, or a time is not positive.
    """
    pairs = np.asarray([base, head], dtype=np.float64) if len(base) == len(head) else np.empty((2, 0))
    if pairs.shape[1] < SAMPLES or not np.all(np.isfinite(pairs) & (pairs > 0)):
        raise InvalidInput(f"need at least {SAMPLES} pairs of positive times, got {len(base)} and {len(head)}")
    logs = np.log(pairs[1] / pairs[0])
    draws = np.random.default_rng(SEED).choice(logs, size=(BOOTSTRAPS, logs.size))
    lower, upper = np.exp(np.quantile(np.median(draws, axis=1), [0.025, 0.975]))
    return Slowdown(ratio=float(np.exp(np.median(logs))), lower=float(lower), upper=float(upper))


@dataclass(frozen=True, kw_only=True)
class Race:
    """Processor times of a row and its limit.

    Attributes:
        base: Times of the revision [s], shape (n,).
        head: Times of the working tree [s], shape (n,).
        repeated: Times of the revision, measured a second time [s], shape (n,).
        limit: Largest accepted ratio of head over base.
    """

    base: Sequence[float]
    head: Sequence[float]
    repeated: Sequence[float]
    limit: float = 1.1

    @property
    def null_spread(self) -> float:
        """Relative difference of identical code: root of the squares of ln(median ratio) and of its standard error."""
        null = slowdown(self.base, self.repeated)
        return math.hypot(math.log(null.ratio), math.log(null.upper / null.lower) / 4)

    @property
    def largest(self) -> float:
        """Largest accepted ratio: the limit of the row, or one plus three times the difference of identical code."""
        return max(self.limit, 1 + 3 * self.null_spread)


def judge(race: Race) -> Status:
    """PERF if the interval lies above the largest accepted ratio, INCONCLUSIVE if it contains that ratio, else PASS."""
    measured = slowdown(race.base, race.head)
    if measured.lower > race.largest:
        return Status.PERF
    return Status.INCONCLUSIVE if measured.upper > race.largest else Status.PASS


@contextmanager
def worktree(repository: Path, revision: str) -> Iterator[Path]:
    """Folder with the sources of ``revision`` during a `with` statement; the working tree does not change.

    Raises:
        InvalidInput: there is no such revision; the message is that of git.
    """
    commit = git(repository, "rev-parse", "--verify", f"{revision}^{{commit}}").strip()
    with tempfile.TemporaryDirectory(prefix="contact-verify-") as folder:
        path = Path(folder) / "source"
        git(repository, "worktree", "add", "--detach", "--quiet", str(path), commit)
        try:
            yield path
        finally:
            git(repository, "worktree", "remove", "--force", str(path))


@dataclass(frozen=True, kw_only=True)
class Sample:
    """One run of a row: processor time [s], peak memory [MB], and numbers of its answer."""

    seconds: float
    memory: float
    answers: Sequence[float]


def sampled(folder: Path, program: str, bytecode: str) -> Sample:
    """Run a program in a fresh interpreter on the source in ``folder``, on one thread.

    Raises:
        InvalidInput: the program fails; the message is the last line of its error.
    """
    environment = {**os.environ, "PYTHONPATH": str(folder), "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    environment |= {"PYTHONPYCACHEPREFIX": bytecode, "PYTHONDONTWRITEBYTECODE": ""}
    command = [sys.executable, "-c", program]
    run = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    if run.returncode:
        raise InvalidInput((run.stderr.strip().splitlines() or [f"exit code {run.returncode}"])[-1])
    seconds, memory, answers = json.loads(run.stdout)
    return Sample(seconds=seconds, memory=memory, answers=answers)


def raced(program: str, limit: float, base: Path, head: Path, rounds: int) -> tuple[Race, str]:
    """Times of one program on the sources in two folders, and its line of the table without name and verdict."""
    folders = (base, head, base)
    runs: list[list[Sample]] = [[], [], []]
    with tempfile.TemporaryDirectory() as bytecode:
        for number in range(rounds + 1):
            for folder_index in (0, 1, 2) if number % 2 else (2, 1, 0):
                runs[folder_index].append(sampled(folders[folder_index], program, bytecode))
    # The first round wrote the bytecode.
    seconds = [[sample.seconds for sample in samples[1:]] for samples in runs]
    race = Race(base=seconds[0], head=seconds[1], repeated=seconds[2], limit=limit)
    before, now = (np.asarray(samples[-1].answers) for samples in runs[:2])
    change = float(np.max(np.abs(now - before)[before != 0] / np.abs(before[before != 0])))
    measured = slowdown(race.base, race.head)
    return race, (
        f"{np.median(race.base):.3g} s | {np.median(race.head):.3g} s | {measured.ratio:.3g} "
        f"({measured.lower:.3g} to {measured.upper:.3g}) | {race.largest:.3g} | {change:.0e} | "
        f"{runs[0][-1].memory:.0f} | {runs[1][-1].memory:.0f}"
    )


def main(arguments: Sequence[str]) -> int:
    """Print one line per row and return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.race", description="Is this source slower?")
    parser.add_argument("revision", help="revision to compare with, anything git understands")
    parser.add_argument("rows", nargs="*", help="only rows whose names contain one of these words")
    parser.add_argument("--rounds", type=int, choices=range(SAMPLES, 100), default=SAMPLES, metavar="7..99")
    options = parser.parse_args(arguments)
    try:
        rows = _rows(options.rows)
        with worktree(SOURCE, options.revision) as base:
            return _run(rows, base, options.rounds)
    except InvalidInput as error:
        sys.stderr.write(f"{error}\n")
        return ExitCode.USAGE


def _rows(words: Sequence[str]) -> list[str]:
    """Names of the rows that contain one of the words; all rows without words."""
    rows = [row for row in ROWS if not words or any(word in row for word in words)]
    if not rows:
        raise InvalidInput(f"no row is named {' or '.join(words)}; rows are: {'; '.join(ROWS)}")
    return rows


def _run(rows: Sequence[str], base: Path, rounds: int) -> int:
    """Measure the rows, print their lines and return the exit code."""
    sys.stdout.write("row | before | now | ratio | limit | answers changed | MB before | MB now\n")
    slower = False
    for row in rows:
        program, limit = ROWS[row]
        try:
            race, line = raced(PREPARED + program, limit, base, SOURCE, rounds)
            status = judge(race)
        except InvalidInput as error:
            status, line = Status.SKIP, str(error)
        slower = slower or status is Status.PERF
        sys.stdout.write(f"{status}: {row} | {line}\n")
        sys.stdout.flush()
    return ExitCode.GATE_FAILED if slower else ExitCode.PASSED


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
