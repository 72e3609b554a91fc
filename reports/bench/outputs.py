"""Files that a command of the bench writes: CSV and SVG, checked before anything is computed."""

from collections.abc import Callable, Sequence
from pathlib import Path

from cases.results.files import write_whole
from cases.results.records.figure import Figure
from contact import InvalidInput
from reports.terminal.terminal import console


def check_outputs(outputs: Sequence[Path]) -> None:
    """Refuse files that cannot be written.

    Raises:
        InvalidInput: For another ending than .csv or .svg, or a folder that is not there.
    """
    for path in outputs:
        if path.suffix not in (".csv", ".svg"):
            raise InvalidInput(f"--write {path}: the ending says the format; use .csv or .svg")
        if path.is_dir() or not path.parent.is_dir():
            raise InvalidInput(f"--write {path}: no file can be there; check that the folder exists")


def write_outputs(outputs: Sequence[Path], table: Callable[[], str], figure: Callable[[], Figure]) -> None:
    """Write the table to files that end with .csv, the figure to the others."""
    for path in outputs:
        if path.suffix == ".csv":
            write_whole(path, table())
        else:
            from reports.figures.renderer import figure_svg  # noqa: PLC0415 - Matplotlib only where it is asked for

            write_whole(path, figure_svg(figure()))
        console().print(f"written: {path}")
