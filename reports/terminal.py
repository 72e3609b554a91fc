"""Tables, facts and bars on a terminal, which shows control characters as escapes."""

import os
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from threading import Timer
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.table import Table as RichTable
from rich.text import Text

from contact.records.errors import printable
from reports.words import Table

WIDTH_WITHOUT_TERMINAL = 160
# Seconds after which a bar is shown: at half of it short computations flicker, at twice of it a user sees nothing.
PATIENCE = 2.0
STYLES = {"bad": "bold white on red", "warn": "black on yellow", "skip": "dim", "good": "green"}


class Terminal(Console):
    """A console that shows control characters as escapes."""

    def print(self, *objects: Any, **options: Any) -> None:
        """Print; a text with control characters loses its styles."""
        super().print(*(_plain(item) for item in objects), **options)


def _plain(item: Any) -> Any:
    """A text without control characters; anything else as it is."""
    text = item.plain if isinstance(item, Text) else item
    if not isinstance(text, str):
        return item
    plain = printable(text, keep="\n")
    return item if plain == text else Text(plain)


def console(*, stderr: bool = False) -> Terminal:
    """The terminal; a pipe or a log file gets wide plain lines that nothing wraps in the middle of a number."""
    stream = sys.stderr if stderr else sys.stdout
    width = None if stream.isatty() or "COLUMNS" in os.environ else WIDTH_WITHOUT_TERMINAL
    return Terminal(stderr=stderr, width=width, highlight=False, markup=False)


def show_table(table: Table, *, on: Console) -> None:
    """A table with its title above and its note below; numbers flush right."""
    rich = RichTable(box=None)
    for place, head in enumerate(table.heads):
        number = place >= table.words
        rich.add_column(Text(printable(head)), justify="right" if number else "left", no_wrap=number, overflow="fold")
    for row in table.rows:
        rich.add_row(*(Text(printable(cell, keep="\n")) for cell in row))
    for part in (Text(table.title, style="bold"), rich, Text(table.note, style="dim")):
        if part:
            on.print(part)


def show_facts(facts: Iterable[tuple[str, str]], *, on: Console) -> None:
    """Print one fact per line, after its name in dim letters."""
    for name, fact in facts:
        on.print(Text.assemble((f"{name}: ", "dim"), fact))


@contextmanager
def progress_bar(what: str, on: Terminal | None = None, *, hidden: bool = False) -> Iterator[Callable[..., None]]:
    """A bar with the time spent and left, on a terminal after two seconds; yields a function that moves it.

    The function takes the completed number, the total, and optionally words in place of those given. Inside, nothing
    but the terminal of the bar may print.
    """
    terminal = on or console(stderr=True)
    if hidden or not terminal.is_terminal:
        yield lambda *_: None
        return
    columns = TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn(), TimeRemainingColumn()
    bar = Progress(*columns, console=terminal, transient=True)
    task = bar.add_task(what, total=None)
    patience = Timer(PATIENCE, bar.start)
    patience.start()

    def update(completed: int, total: int, words: str = "") -> None:
        description = f"{words or what}, {completed} of {total}"
        bar.update(task, completed=completed, total=total, description=description)

    try:
        yield update
    finally:
        patience.cancel()
        patience.join()
        if bar.live.is_started:
            bar.stop()
