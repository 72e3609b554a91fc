"""Our methods and outside referees on the same scenes in turn: error against processor seconds; losing rows first.

    python -m benchmarks.side_by_side [--rounds 7]

Elastic scenes are those of `contact-verify cost outside_referees`, with the same settings from coarse to fine.  Every
round asks each setting once, the next round in the opposite order, all of them with empty caches.  Times are those of
all processes that a method starts; what a referee's script imports is its start, which is told apart and does not
count.  A referee's row names the fastest of ours of its kind (grids, finite elements, MDR beside closed forms)
that is at least as accurate: the ratio is their time over ours, below one where they are ahead.
"""

from __future__ import annotations

import argparse
import os
import resource
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from benchmarks.race.slowdown import Slowdown, slowdown
from cases.declare.case import CaseScene
from cases.declare.methods import REFEREES, MethodUse
from cases.library.referees import outside_referees as suite
from cases.referees.process import INTERPRETER, interpreter
from cases.run.empty_caches import forget
from cases.run.timing import SAMPLES
from contact import NotConvergedError
from contact.records.validation import FloatArray

# Which of our methods does what a referee does.
OF_ITS_KIND = {"calculix": "fem", "contact_mechanics": "bem", "tamaas": "bem", "nanite": "mdr", "adhesion_jkr": "mdr"}
# A setting whose error takes longer than this to tell is left out: seven rounds would take an hour.
LONGEST = 60.0
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


# What runs a referee's script: its imports are its start, the rest is told in a file beside.
TOLD = """#!{python}
import importlib.util, sys, time
if sys.argv[1] == "-c":
    exec(sys.argv[2])
    sys.exit()
script = importlib.util.spec_from_file_location("script", sys.argv[1])
module = importlib.util.module_from_spec(script)
script.loader.exec_module(module)
start = time.process_time()
module.main()
with open(__file__ + ".seconds", "a") as told:
    print(start, time.process_time() - start, file=told)
"""


class Clock:
    """Processor seconds of calls: of this process, of programs, and of referees' scripts without their imports."""

    def __init__(self, folder: Path) -> None:
        runner = folder / "python"
        runner.write_text(TOLD.format(python=interpreter()))
        runner.chmod(0o755)
        os.environ[INTERPRETER], self.told = str(runner), Path(f"{runner}.seconds")

    def seconds(self, call: Callable[[], object]) -> tuple[float, float]:
        """Of one call, and of the starts of scripts in it, which do not count."""
        self.told.write_text("")
        before = processor_seconds()
        call()
        taken = processor_seconds() - before
        starts = [[float(word) for word in line.split()] for line in self.told.read_text().splitlines()]
        if not starts:
            return taken[0] + taken[1], 0.0
        # Each script starts alike; what they were asked adds up.
        return taken[0] + float(np.sum(starts, axis=0)[1]), float(np.mean(starts, axis=0)[0])


@contextmanager
def beside_scripts() -> Iterator[Clock]:
    """A clock; referees' scripts tell it their seconds as long as it runs."""
    usual = os.environ.get(INTERPRETER, "")
    try:
        with tempfile.TemporaryDirectory() as folder:
            yield Clock(Path(folder))
    finally:
        os.environ[INTERPRETER] = usual


def processor_seconds() -> FloatArray:
    """Of this process, and of those that it started and that have ended."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return np.array([one.ru_utime + one.ru_stime for one in used])


def error(scene: CaseScene, use: MethodUse) -> float:
    """Of a setting; of grids the root mean square over it and over an eighth fewer and more points.

    A grid's error passes zero here and there: of 224, 256 and 288 points one was ten times as near as the others.
    """
    points = use.settings.get("points")
    settings = [{**use.settings, "points": points * share // 8} for share in (7, 8, 9)] if points else [use.settings]
    return float(np.sqrt(np.mean([_error(scene, replace(use, settings=own)) ** 2 for own in settings])))


def _error(scene: CaseScene, use: MethodUse) -> float:
    """Largest relative error of the forces; of a creeping contact, of its last depth."""
    answer = use.build().solve(scene.scene)
    if scene is suite.CREEPING:
        return float(abs(answer.indentation_depth[-1] / suite.creep(scene.scene)[0] - 1))  # type: ignore[attr-defined]
    if scene is suite.PULLED:
        return float(abs(answer.pull_off_force / suite.jkr_force(scene.scene)[0] - 1))  # type: ignore[attr-defined]
    expected = suite.EXPECTED["normal_force"].get(scene.name) or suite.hertz_force(scene.scene)
    return float(np.max(np.abs(answer.normal_force / np.array(expected) - 1)))  # type: ignore[attr-defined]


def entered(scene: CaseScene, uses: tuple[MethodUse, ...], clock: Clock) -> Iterator[Runner]:
    """The settings that answer the scene in time, each solved once; others are named and left out."""
    for use in uses:
        if not use.build().supports(scene.scene):
            continue
        found: list[float] = []
        try:
            took, start = clock.seconds(lambda use=use, found=found: found.append(error(scene, use)))  # type: ignore[misc]
        except NotConvergedError as failure:
            sys.stderr.write(f"{scene.name}, {use.label}: left out, {failure}\n")
            continue
        if took > LONGEST:
            sys.stderr.write(f"{scene.name}, {use.label}: left out, it takes {took:.0f} s\n")
            continue
        yield Runner(use, found[0], start, [])


def raced(scene: CaseScene, uses: tuple[MethodUse, ...], rounds: int, clock: Clock) -> list[Runner]:
    """All settings in turn."""
    runners = list(entered(scene, uses, clock))
    for number in range(rounds):
        for runner in reversed(runners) if number % 2 else runners:
            forget()
            taken, _ = clock.seconds(lambda runner=runner: runner.use.build().solve(scene.scene))  # type: ignore[misc]
            runner.seconds.append(taken)
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
    with beside_scripts() as clock:
        found = [row for scene, uses in entries for row in rows(scene, raced(scene, uses, rounds, clock))]
    head = "| scene | method | error | seconds | start | theirs over ours | which is |\n|---|---|---|---|---|---|---|\n"
    sys.stdout.write(head + "\n".join(line for _, line in sorted(found, key=lambda row: row[0])) + "\n")


if __name__ == "__main__":
    main()
