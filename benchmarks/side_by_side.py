"""Our methods and outside referees on the same scenes in turn: error against processor seconds; losing rows first.

    python -m benchmarks.side_by_side [--rounds 7]

Elastic scenes are those of `contact-verify cost outside_referees`, with the same settings from coarse to fine.  Every
round asks each setting once, the next round in the opposite order, all of them with empty caches.  Times are those of
all processes that a method starts; what the start of a referee's process takes without a question is told apart and
does not count.  A referee's row names the fastest of ours of its kind (grids, finite elements, MDR beside closed forms)
that is at least as accurate: the ratio is their time over ours, below one where they are ahead.
"""

from __future__ import annotations

import argparse
import resource
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from benchmarks.race.slowdown import Slowdown, slowdown
from cases.declare.case import CaseScene
from cases.declare.methods import REFEREES, MethodUse
from cases.library.referees import outside_referees as suite
from cases.referees.process import WORKERS, interpreter
from cases.run.empty_caches import forget
from cases.run.timing import SAMPLES
from contact import NotConvergedError

# Scripts of the referees; CalculiX is a program without one.
SCRIPTS = {
    "contact_mechanics": "contact_mechanics_grid",
    "tamaas": "tamaas_grid",
    "nanite": "nanite_formulas",
    "adhesion_jkr": "adhesion_jkr",
}
# Which of our methods does what a referee does.
OF_ITS_KIND = {"calculix": "fem", "contact_mechanics": "bem", "tamaas": "bem", "nanite": "mdr", "adhesion_jkr": "mdr"}
# A setting that takes longer than this once is left out: seven rounds of it would take an hour.
LONGEST = 30.0
# Relative errors below this are all the same: roundings.
ROUNDING = 1e-13


@dataclass(frozen=True)
class Runner:
    """One setting of a method on one scene: its error, and processor seconds of each round without a start."""

    use: MethodUse
    error: float
    start: float
    seconds: list[float]

    @property
    def method(self) -> str:
        """Its name in the method table."""
        return self.use.method or self.use.label

    @property
    def name(self) -> str:
        """Method and setting."""
        return f"{self.method}, {self.use.label}" if self.use.method else self.method


def processor_seconds() -> float:
    """Of this process and of those that it started and that have ended."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(one.ru_utime + one.ru_stime for one in used)


def seconds(call: Callable[[], object]) -> float:
    """Of processor time of one call."""
    before = processor_seconds()
    call()
    return processor_seconds() - before


def start(method: str) -> float:
    """Seconds that the start of a referee's process takes without a question: it imports its package and ends."""
    if method not in SCRIPTS:
        return 0.0
    command = [interpreter(), str(WORKERS / f"{SCRIPTS[method]}.py")]

    def begin() -> None:
        subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, check=False)

    return float(np.median([seconds(begin) for _ in range(3)]))


def error(scene: CaseScene, use: MethodUse) -> float:
    """Largest relative error of the forces; of a creeping contact, of its last depth."""
    answer = use.build().solve(scene.scene)
    if scene is suite.CREEPING:
        return float(abs(answer.indentation_depth[-1] / suite.creep(scene.scene)[0] - 1))  # type: ignore[attr-defined]
    if scene is suite.PULLED:
        return float(abs(answer.pull_off_force / suite.jkr_force(scene.scene)[0] - 1))  # type: ignore[attr-defined]
    expected = suite.EXPECTED["normal_force"].get(scene.name) or suite.hertz_force(scene.scene)
    return float(np.max(np.abs(answer.normal_force / np.array(expected) - 1)))  # type: ignore[attr-defined]


def entered(scene: CaseScene, uses: tuple[MethodUse, ...]) -> Iterator[Runner]:
    """The settings that answer the scene in time, each solved once; others are named and left out."""
    for use in uses:
        if not use.build().supports(scene.scene):
            continue
        before = processor_seconds()
        try:
            found = error(scene, use)
        except NotConvergedError as failure:
            sys.stderr.write(f"{scene.name}, {use.label}: left out, {failure}\n")
            continue
        if (took := processor_seconds() - before) > LONGEST:
            sys.stderr.write(f"{scene.name}, {use.label}: left out, it takes {took:.0f} s\n")
            continue
        yield Runner(use, found, start(use.method or use.label), [])


def raced(scene: CaseScene, uses: tuple[MethodUse, ...], rounds: int) -> list[Runner]:
    """All settings in turn."""
    runners = list(entered(scene, uses))
    for number in range(rounds):
        for runner in reversed(runners) if number % 2 else runners:
            forget()
            taken = seconds(lambda runner=runner: runner.use.build().solve(scene.scene))  # type: ignore[misc]
            runner.seconds.append(max(taken - runner.start, 1e-3))
    return runners


def lead(runner: Runner, runners: list[Runner]) -> tuple[Slowdown, Runner] | None:
    """Their time over that of the fastest of ours of the kind that is at least as accurate, and which that is."""
    kind = OF_ITS_KIND.get(runner.method)
    ours = [one for one in runners if one.method == kind and one.error <= max(runner.error, ROUNDING)]
    if not ours:
        return None
    fastest = min(ours, key=lambda one: float(np.median(one.seconds)))
    return slowdown(fastest.seconds, runner.seconds), fastest


def rows(scene: CaseScene, runners: list[Runner]) -> Iterator[tuple[float, str]]:
    """For each setting a number, small where we lose, and its line of the table."""
    for runner in runners:
        place, beside = _beside_ours(runner, runners)
        median = float(np.median(runner.seconds))
        numbers = f"{runner.error:.1e} | {median:.3g} | {runner.start:.2g}"
        yield place, f"| {scene.name} | {runner.name} | {numbers} | {beside} |"


def _beside_ours(runner: Runner, runners: list[Runner]) -> tuple[float, str]:
    if runner.method not in REFEREES:
        return np.inf, "|"
    found = lead(runner, runners)
    if found is None:
        return 0.0, " | none of ours of its kind is as accurate"
    ratio, ours = found
    return ratio.ratio, f"{ratio.ratio:.3g} ({ratio.lower:.3g} to {ratio.upper:.3g}) | {ours.name}"


def main() -> None:
    """Print the table of the page."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.side_by_side")
    parser.add_argument("--rounds", type=int, default=SAMPLES, help=f"how often each is timed, at least {SAMPLES}")
    rounds = parser.parse_args().rounds
    scenes = {scene.name: scene for scene in suite.SCENES}
    entries = [(scenes[study.scene], study.ladder) for study in suite.CASE.work]
    entries += [(scene, scene.methods) for scene in (suite.CURVES[0], suite.PULLED, suite.CREEPING)]
    found = [row for scene, uses in entries for row in rows(scene, raced(scene, uses, rounds))]
    head = "| scene | method | error | seconds | start | theirs over ours | which is |\n|---|---|---|---|---|---|---|\n"
    sys.stdout.write(head + "\n".join(line for _, line in sorted(found, key=lambda row: row[0])) + "\n")


if __name__ == "__main__":
    main()
