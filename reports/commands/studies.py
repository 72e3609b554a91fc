"""Commands that measure: what matters in a scene, what breaks, how well errors are stated, what accuracy costs.

Each is declared here once, with its options; what it needs is imported when it is called.
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from cases.measurements.many_scenes import ManyScenes
    from cases.results.records.run import CaseResult
    from cases.run.executors import ExecutorFactory

FAILED = 1

Words = Annotated[list[str] | None, typer.Argument(metavar="[WORD]...", help="Only those with such a name.")]
Methods = Annotated[list[str] | None, typer.Option(help="Only this method. Repeatable.")]
Report = Annotated[Path | None, typer.Option(help="Folder for a report with figures and data.")]
Measured = Annotated[Path | None, typer.Option(help="Measurements of this machine from calibrate.")]
Seed = Annotated[int, typer.Option(help="Of the random scenes.")]


def advise(
    scene: Annotated[Path, typer.Argument(help="Scene in TOML.")],
    accuracy: Annotated[float, typer.Option(help="Relative change that does not matter.")] = 1e-2,
    method: Annotated[str, typer.Option(help="Method that solves with and without.")] = "mdr",
) -> None:
    """Say which effects, and whether the layer's finite thickness, matter at an accuracy: solved with and without."""
    from cases.declare.guarded_method import build_guarded  # noqa: PLC0415 - see the first lines of this module
    from cases.measurements.advice import advise as advice_on  # noqa: PLC0415
    from contact import load_scene  # noqa: PLC0415

    for line in advice_on(build_guarded(method, {}), load_scene(scene), accuracy).lines:
        _say(line)


def ladders(names: Words = None, method: Methods = None, out: Report = None) -> int:
    """Walk hard parameters until something breaks: digits left, and the rung where a method gives up by name.

    MDR climbs if no method is named.
    """
    from cases.measurements.ladders.ladder_study import CLIMBERS, chosen, ladder_case  # noqa: PLC0415
    from cases.measurements.ladders.ladder_table import LADDERS  # noqa: PLC0415

    plans, climbers = chosen(LADDERS, names or []), {name: CLIMBERS.get(name, {}) for name in method or ["mdr"]}
    total = len(plans) * len(climbers)
    return published(_told(lambda say, _: ladder_case(plans, climbers, progress=say), out, total), out)


def coverage(
    method: Methods = None,
    *,
    family: Annotated[list[str] | None, typer.Option(help="Only this kind of scenes. Repeatable.")] = None,
    seed: Annotated[int | None, typer.Option(help="Of the random scenes; by default one that tuned nothing.")] = None,
    out: Report = None,
) -> int:
    """Compare stated with true errors over hundreds of random scenes: how often they hold, how much they give away.

    At the end, each coefficient of the error models beside what was achieved for the errors it shapes.
    """
    from cases.measurements.campaigns.coverage import PLANS, SEED, coverage_case  # noqa: PLC0415
    from contact import InvalidInput  # noqa: PLC0415
    from reports.tables.coefficient_table import error_coefficients  # noqa: PLC0415
    from reports.terminal.terminal import console, show_table  # noqa: PLC0415

    plans = [p for p in PLANS if (not method or p.method in method) and (not family or p.family in family)]
    if not plans:
        raise InvalidInput(f"no such plan; methods are {', '.join(dict.fromkeys(plan.method for plan in PLANS))}")

    def study() -> CaseResult:
        """Measure, then show the coefficients."""
        case = _told(partial(coverage_case, plans, SEED if seed is None else seed), out)()
        if table := error_coefficients(case):
            show_table(table, on=console())
        return case

    return published(study, out)


def accuracy(
    count: Annotated[int, typer.Option(min=1, help="How many random scenes.")] = 300,
    *,
    seed: Seed = 2,
    evidence: Measured = None,
    out: Report = None,
) -> int:
    """Solve random scenes to random accuracies: are they met, and how near is the time to the shortest?"""
    from cases.measurements.evidence.audit import audit_case  # noqa: PLC0415
    from cases.measurements.evidence.records import read  # noqa: PLC0415

    measured = None if evidence is None else read(evidence)
    return published(lambda: audit_case(count, seed, measured, progress=_say), out)


def scaling(out: Report = Path("build/scaling")) -> int:
    """Measure how the time grows with a/h, radii, Prony terms, pieces of a history, grid cells, against theory."""
    from cases.measurements.cost.scaling import PLANS, scaling_case  # noqa: PLC0415

    return published(_told(partial(scaling_case, PLANS), out, len(PLANS)), out)


def maps(names: Words = None, method: Methods = None, out: Report = Path("build/maps")) -> int:
    """Map the signed error of each closed form and method over a/h and Poisson's ratio: where it is good to 1 %.

    A method of an installed package is mapped with the settings it comes with.
    """
    from cases.measurements.advice.error_maps import map_case, plans_of  # noqa: PLC0415

    plans = list(plans_of(names or [], method or []))
    return published(_told(partial(map_case, plans), out, sum(len(plan.given) for plan in plans)), out)


def calibrate(
    out: Annotated[Path, typer.Argument(help="File for the measurements, JSON.")],
    seed: Seed = 1,
) -> None:
    """Measure on this machine how accurate and how fast the settings are; takes some minutes, alone on the machine."""
    from cases.measurements.evidence.calibrate import calibrate as measured  # noqa: PLC0415
    from cases.measurements.evidence.records import write  # noqa: PLC0415
    from cases.run.stamp import revision  # noqa: PLC0415
    from contact import InvalidInput  # noqa: PLC0415

    if out.is_dir() or not out.parent.is_dir():
        raise InvalidInput(f"{out}: no file can be there; check that the folder exists")
    write(out, measured(seed=seed, revision=revision(), progress=_say))
    _say(f"written: {out}; use it with solve --accuracy .. --evidence {out}")


def campaign(
    family: Annotated[
        str,
        typer.Argument(
            help="elastic, many_loads, pressure, displacement, inside, adhesive, adhering_table, impact, history (of "
            "depth), creep (force), growing (force in closed form, against steps) or reloading."
        ),
    ] = "elastic",
    method: Annotated[str, typer.Option(help="Method that answers.")] = "mdr",
    count: Annotated[int, typer.Option(min=1, help="How many random scenes.")] = 100,
    seed: Seed = 1,
    *,
    jobs: Annotated[
        int, typer.Option(min=1, help="Blocks of scenes at a time; on a cluster at least its threads.")
    ] = 2,
    executor: Annotated[
        str, typer.Option(help="serial, processes, or the address of a Dask scheduler (tcp://host:port).")
    ] = "serial",
    out: Annotated[Path | None, typer.Option(help="Folder that keeps finished scenes.")] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Go on with the scenes that OUT keeps.")] = False,
) -> int:
    """Solve random scenes and check each answer: within its stated error of an independent one, or refused by name."""
    from cases.declare.guarded_method import build_guarded  # noqa: PLC0415 - see the first lines of this module
    from cases.measurements.many_scenes import ManyScenes, campaign_of  # noqa: PLC0415
    from cases.run.executors import by_name  # noqa: PLC0415
    from contact import InvalidInput  # noqa: PLC0415

    if resume and out is None:
        raise InvalidInput("--resume goes on with the scenes that a folder keeps; name it by --out")
    scenes = ManyScenes(
        campaign=campaign_of(family), family=family, method=build_guarded(method, {}), seed=seed, count=count
    )
    return _counted_out(scenes, by_name(executor), jobs, out, resume=resume)


def _counted_out(scenes: ManyScenes, executor: ExecutorFactory, jobs: int, out: Path | None, *, resume: bool) -> int:
    """Carry a campaign out, count its scenes, and say what was found; 2 if the cluster was lost."""
    from cases.measurements.kept_scenes import KeptScenes  # noqa: PLC0415
    from cases.measurements.tally import Tally  # noqa: PLC0415
    from cases.results.status import ExitCode  # noqa: PLC0415
    from cases.run.executors import ClusterLost  # noqa: PLC0415
    from cases.run.lock import locked  # noqa: PLC0415

    tally = Tally()
    try:
        with nullcontext() if out is None else locked(out):
            kept = None if out is None else KeptScenes(out, scenes.key, resume=resume)
            for found in scenes.tallies(scenes.in_blocks(executor, jobs), kept):
                tally.join(found)
    except ClusterLost as error:
        remedy = "name a folder by --out to keep finished scenes" if out is None else "go on with --resume"
        _say(f"{error}; {tally.scenes} of {scenes.count} scenes are finished, {remedy}")
        return ExitCode.INTERRUPTED
    for line in tally.report():
        _say(line)
    for scene, end, why in tally.defects:
        _say(f"scene {scene} of seed {scenes.seed}: {end}: {why}")
    return FAILED if tally.defects else 0


COMMANDS: tuple[Callable[..., Any], ...] = (advise, ladders, coverage, accuracy, scaling, maps, calibrate, campaign)


def published(study: Callable[[], CaseResult], out: Path | None) -> int:
    """Carry out a study, write it as a run of its own if asked, and return 1 if it failed."""
    from cases.measurements.suites import run_of  # noqa: PLC0415
    from cases.run.lock import locked  # noqa: PLC0415
    from contact import InvalidInput  # noqa: PLC0415
    from reports.commands.report import write_pages  # noqa: PLC0415

    if out is None:
        return FAILED if study().status.is_failure else 0
    # This is said before the study, not after it.
    if out.exists() and not out.is_dir():
        raise InvalidInput(f"--out {out}: a file is in the way; name a folder")
    with locked(out):
        run = run_of((make() for make in [study]), out)
        write_pages(run, out)
    _say(f"report: {out / 'report.html'}")
    return FAILED if any(status.is_failure for status in run.statuses) else 0


PARTIAL = "partial.txt"


def _told(
    study: Callable[[Callable[[str], None], Callable[[str], None]], CaseResult],
    out: Path | None,
    total: int | None = None,
) -> Callable[[], CaseResult]:
    """A study that says its results and what it is at."""

    def run() -> CaseResult:
        """Carry it out."""
        with _counted(out, total) as (say, at_work):
            return study(say, at_work)

    return run


@contextmanager
def _counted(
    out: Path | None, total: int | None = None
) -> Iterator[tuple[Callable[[str], None], Callable[[str], None]]]:
    """Says each result when it is there, with its number and the time; with a folder it is kept there at once.

    What a study has found before it is interrupted stands in `PARTIAL`. The second says what is being worked at, on a
    terminal in a line of its own that goes with the work, elsewhere not at all.
    """
    from rich.text import Text  # noqa: PLC0415 - see the first lines of this module

    from reports.terminal.terminal import console  # noqa: PLC0415 - see the first lines of this module

    on, start, number = console(), time.monotonic(), itertools.count(1)

    def say(line: str) -> None:
        """One result, of one or more lines."""
        count = next(number)
        words = f"[{count}{f' of {total}' if total else ''}, {time.monotonic() - start:.0f} s] {line}"
        on.print(words, markup=False, highlight=False, soft_wrap=True)
        if out is not None:
            out.mkdir(parents=True, exist_ok=True)
            with (out / PARTIAL).open("w" if count == 1 else "a", encoding="utf-8") as file:
                file.write(f"{line}\n")

    if not on.is_terminal:
        yield say, lambda _: None
        return
    with on.status("") as shown:
        yield say, lambda line: shown.update(Text(line))


def _say(line: str) -> None:
    from reports.terminal.terminal import console  # noqa: PLC0415

    console().print(line, markup=False, highlight=False, soft_wrap=True)
