"""Commands of the bench: fit measured force curves, and solve a scene for a range of one of its numbers.

Each is declared here with its options; what it needs is imported when it is called.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any

import typer

SceneFile = Annotated[Path, typer.Argument(help="Scene in TOML.")]
Written = Annotated[list[Path] | None, typer.Option("--write", "-w", help="FILE.csv or FILE.svg. May be repeated.")]


def fit(
    curve: Annotated[
        Path,
        typer.Argument(
            help="CSV with columns of depth and force, units in the heads or SI; or .jpk-force, .h5, .tab, .ibw."
        ),
    ],
    scene: SceneFile,
    *,
    also: Annotated[
        str, typer.Option("--with", help="Fitted beside E: contact_point, baseline, thickness, work_of_adhesion.")
    ] = "contact_point",
    curves: Annotated[bool, typer.Option("--map", help="One force curve in each column after the depths.")] = False,
    uncertain: Annotated[
        str, typer.Option(help='What is known to a tolerance, "radius=5%, thickness=4e-6..6e-6"; joins the intervals.')
    ] = "",
    number: Annotated[int, typer.Option("--curve", help="Which curve of a microscope's file, from 0.")] = 0,
    confidence: Annotated[float, typer.Option(help="Of intervals and bands.")] = 0.95,
    write: Written = None,
) -> None:
    """Find Young's modulus from a force curve, or from all curves of a map, with intervals.

    Says what Hertz, Dimitriadis and other formulas would have found on the same curve.
    """
    from reports.commands.bench import fit_file, fit_map_file  # noqa: PLC0415 - see the first lines of this module

    names = [name.strip() for name in also.split(",") if name.strip()]
    with _bar("curves") as progress:
        if curves and uncertain:
            raise typer.BadParameter("--uncertain is for single curves: all curves of a map share the tolerance")
        if curves:
            fit_map_file(curve, scene, names, confidence=confidence, outputs=write or [], progress=progress)
        else:
            fit_file(
                curve, scene, names, uncertain=uncertain, number=number, confidence=confidence, outputs=write or []
            )


def sweep(
    scene: SceneFile,
    *,
    over: Annotated[
        str, typer.Option(help='Number and range, "thickness=1um..10um:20", ":log" behind it for equal factors.')
    ],
    method: Annotated[str, typer.Option(help="Method that solves.")] = "mdr",
    write: Written = None,
) -> None:
    """Solve a scene for a range of one of its numbers: a table, CSV and picture."""
    from reports.commands.bench import sweep_file  # noqa: PLC0415 - see the first lines of this module

    with _bar("scenes") as progress:
        sweep_file(scene, over, method=method, outputs=write or [], progress=progress)


COMMANDS: tuple[Callable[..., Any], ...] = (fit, sweep)


@contextmanager
def _bar(what: str) -> Iterator[Callable[[int, int], None]]:
    """A bar on a terminal, and nothing in a pipe or a log."""
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn  # noqa: PLC0415

    from reports.terminal.terminal import console  # noqa: PLC0415

    terminal = console(stderr=True)
    columns = TextColumn(what), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn()
    with Progress(*columns, console=terminal, disable=not terminal.is_terminal, transient=True) as bar:
        task = bar.add_task(what, total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)
