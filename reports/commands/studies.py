"""Commands that measure: what matters in a scene, and what breaks.

Each is declared here once, with its options; what it needs is imported when it is called.
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from cases.results.records.run import CaseResult

FAILED = 1

Words = Annotated[list[str] | None, typer.Argument(metavar="[WORD]...", help="Only those with such a name.")]
Methods = Annotated[list[str] | None, typer.Option(help="Only this method. Repeatable.")]
Report = Annotated[Path | None, typer.Option(help="Folder for a report with figures and data.")]


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


COMMANDS: tuple[Callable[..., Any], ...] = (advise, ladders)


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
