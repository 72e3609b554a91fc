"""Our methods and outside referees on the same scenes in turn: processor times, their ratios to MDR's, and errors.

    python -m benchmarks.side_by_side [--rounds 7]

Every round asks each method once, the next round in the opposite order, all of them with empty caches.  Times are those
of all processes that a method starts; what the start of a referee's process takes without a question is told apart.
The ratio is the median over the rounds with its 95 % interval.
"""

from __future__ import annotations

import argparse
import resource
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from benchmarks.race.slowdown import slowdown
from cases.declare.case import CaseScene
from cases.declare.methods import MethodUse
from cases.library._methods import BEM, FEM, MDR
from cases.library.referees import outside_referees as suite
from cases.referees.process import WORKERS, interpreter
from cases.run.empty_caches import forget
from cases.run.timing import SAMPLES

# Scripts of the referees; CalculiX is a program without one.
SCRIPTS = {
    "contact_mechanics": "contact_mechanics_grid",
    "tamaas": "tamaas_grid",
    "nanite": "nanite_formulas",
    "adhesion_jkr": "adhesion_jkr",
}
# Coarser meshes than in the suite: seven rounds of it would take an hour.
CALCULIX = replace(suite.REFEREES[0], settings={"cells": 8})


def processor_seconds() -> float:
    """Of this process and of those that it started and that have ended."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(one.ru_utime + one.ru_stime for one in used)


def seconds(call: Callable[[], object]) -> float:
    """Of processor time of one call."""
    before = processor_seconds()
    call()
    return processor_seconds() - before


def start(method: str) -> None:
    """Start a referee's process without a question: it imports its package and ends."""
    if method in SCRIPTS:
        script = str(WORKERS / f"{SCRIPTS[method]}.py")
        subprocess.run([interpreter(), script], stdin=subprocess.DEVNULL, capture_output=True, check=False)


def error(scene: CaseScene, use: MethodUse) -> float:
    """Largest relative error of the forces; of a creeping contact, of its last depth."""
    answer = use.build().solve(scene.scene)
    if scene is suite.CREEPING:
        return float(abs(answer.indentation_depth[-1] / suite.creep(scene.scene)[0] - 1))  # type: ignore[attr-defined]
    if scene is suite.PULLED:
        return float(abs(answer.pull_off_force / suite.jkr_force(scene.scene)[0] - 1))  # type: ignore[attr-defined]
    expected = suite.EXPECTED["normal_force"].get(scene.name) or suite.hertz_force(scene.scene)
    return float(np.max(np.abs(answer.normal_force / np.array(expected) - 1)))  # type: ignore[attr-defined]


def race(scene: CaseScene, uses: tuple[MethodUse, ...], rounds: int) -> None:
    """Print one line for each method."""
    uses = tuple(use for use in uses if use.build().supports(scene.scene))
    taken: dict[str, list[float]] = {use.label: [] for use in uses}
    for number in range(rounds):
        for use in reversed(uses) if number % 2 else uses:
            forget()
            taken[use.label].append(seconds(lambda use=use: use.build().solve(scene.scene)))  # type: ignore[misc]
    for use in uses:
        ratio = slowdown(taken["mdr"], taken[use.label])
        alone = float(np.median([seconds(lambda use=use: start(use.label)) for _ in range(3)]))  # type: ignore[misc]
        sys.stdout.write(
            f"| {scene.name} | {use.label} | {np.median(taken[use.label]):.3g} | {alone:.2g} | {ratio.ratio:.3g} "
            f"({ratio.lower:.3g} to {ratio.upper:.3g}) | {error(scene, use):.1e} |\n"
        )
        sys.stdout.flush()


def main() -> None:
    """Print the table of the page."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.side_by_side")
    parser.add_argument("--rounds", type=int, default=SAMPLES, help=f"how often each is timed, at least {SAMPLES}")
    rounds = parser.parse_args().rounds
    scenes = {scene.name: scene for scene in suite.SCENES}
    sys.stdout.write("| scene | method | seconds | of which start | times MDR | error |\n|---|---|---|---|---|---|\n")
    grids, nanite = suite.REFEREES[1:3], suite.REFEREES[3]
    race(scenes["paraboloid, half-space"], (MDR, FEM, BEM, *grids, nanite), rounds)
    race(scenes["flat punch, bonded nu=0.3"], (MDR, FEM, BEM, CALCULIX, grids[0]), rounds)
    race(suite.CURVES[0], (MDR, nanite, suite.GRIDS[0]), rounds)
    race(suite.PULLED, suite.PULLED.methods, rounds)
    race(suite.CREEPING, suite.CREEPING.methods, rounds)


if __name__ == "__main__":
    main()
