"""What stands in the terminal: tables, and the progress of a run."""

import os
import sys
from collections.abc import Iterable

from rich.console import Console
from rich.table import Table as RichTable
from rich.text import Text

from reports.tables.table import Table

WIDTH_WITHOUT_TERMINAL = 160
STYLES = {"bad": "bold white on red", "warn": "black on yellow", "skip": "dim", "good": "green"}


def console(*, stderr: bool = False) -> Console:
    """The terminal; a pipe or a log file gets wide plain lines that nothing wraps in the middle of a number."""
    stream = sys.stderr if stderr else sys.stdout
    width = None if stream.isatty() or "COLUMNS" in os.environ else WIDTH_WITHOUT_TERMINAL
    return Console(stderr=stderr, width=width, highlight=False, markup=False)


def show_table(table: Table, *, on: Console) -> None:
    """A table with its title above and its note below; numbers flush right."""
    rich = RichTable(box=None)
    for place, head in enumerate(table.heads):
        number = place >= table.words
        rich.add_column(Text(head), justify="right" if number else "left", no_wrap=number, overflow="fold")
    for row in table.rows:
        rich.add_row(*(Text(cell) for cell in row))
    for part in (Text(table.title, style="bold"), rich, Text(table.note, style="dim")):
        if part:
            on.print(part)


def show_facts(facts: Iterable[tuple[str, str]], *, on: Console) -> None:
    """One fact a line, its name dim before it."""
    for name, fact in facts:
        on.print(Text.assemble((f"{name}: ", "dim"), fact))
