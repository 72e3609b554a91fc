"""`contact-verify advise, ladders, calibrate, campaign`: what matters, what breaks, what accuracy costs."""

from __future__ import annotations

from pathlib import Path

from cases.advice import advise as advice_on
from cases.methods import build
from contact import InvalidInput, load_scene
from reports.terminal import console

FAILED = 1


def advise(scene_file: Path, accuracy: float, method: str) -> None:
    """Print what a scene needs at an accuracy, from solving it with and without."""
    for line in advice_on(build(method, {}), load_scene(scene_file), accuracy).lines:
        console().print(line, markup=False, highlight=False)


def ladders(names: list[str], method: str) -> int:
    """Walk the ladders whose names contain one of the words; return 1 if a rung fails without a name.

    Raises:
        InvalidInput: If no ladder has such a name.
    """
    from cases.stability.ladder_table import LADDERS  # noqa: PLC0415 - only this command needs it
    from cases.stability.ladders import breakdown, climb_all, fewest_digits  # noqa: PLC0415
    from cases.status import Status  # noqa: PLC0415

    plans = [plan for plan in LADDERS if not names or any(word in plan.name for word in names)]
    if not plans:
        raise InvalidInput(f"no ladder called {names[0]!r}; there are {', '.join(plan.name for plan in LADDERS)}")
    unnamed, out = 0, console()
    for plan in plans:
        for ladder in climb_all([plan], {method: build(method, {})}):
            stop, digits = breakdown(ladder), fewest_digits(ladder)
            end = "climbed to the end" if stop is None else f"stops at {ladder.parameter} = {stop:g}"
            out.print(f"{ladder.name}: {end}, at least {0.0 if digits is None else digits:.1f} digits", markup=False)
            for rung in ladder.rungs:
                if rung.status is not Status.PASS:
                    out.print(f"  {ladder.parameter} = {rung.value:g}: {rung.status}: {rung.reason}", markup=False)
                unnamed += rung.status is Status.FAIL
    return FAILED if unnamed else 0


def calibrate(out: Path, seed: int) -> None:
    """Measure accuracy and time of all candidate settings on this machine and write them to a file."""
    from cases.evidence.calibrate import calibrate as measured  # noqa: PLC0415
    from cases.evidence.records import write  # noqa: PLC0415
    from cases.stamp import revision  # noqa: PLC0415

    write(out, measured(seed=seed, revision=revision(), progress=lambda line: console().print(line, markup=False)))
    console().print(f"written: {out}; use it with solve --accuracy .. --evidence {out}", markup=False)


def campaign(method: str, family: str, count: int, seed: int) -> int:
    """Solve random scenes and check each answer; return 1 if one is wrong without a word."""
    from cases.stability.campaign import campaign as run_campaign  # noqa: PLC0415
    from cases.stability.random_scenes import FAMILIES  # noqa: PLC0415

    if family not in FAMILIES:
        raise InvalidInput(f"family = {family!r}: must be one of {', '.join(FAMILIES)}")
    found, out = run_campaign(build(method, {}), seed=seed, count=count, family=family), console()
    out.print(", ".join(f"{end}: {number}" for end, number in found.counts.items()), markup=False)
    for quantity, coverage in found.coverage().items():
        sharp = "" if coverage.sharpness is None else f", stated over true error {coverage.sharpness:.3g} in the median"
        out.print(f"{quantity}: {100 * coverage.covered:.2f} % of {coverage.count} covered{sharp}", markup=False)
    for trial in found.defects:
        out.print(f"scene {trial.number} of seed {seed}: {trial.end}: {trial.message}", markup=False)
    return FAILED if found.defects else 0
