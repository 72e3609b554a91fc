"""A table before anyone prints it: in a terminal, in HTML."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TypeVar

R = TypeVar("R")


@dataclass(frozen=True, kw_only=True)
class Table:
    """A table ready to print; the first `words` columns are words, the others numbers.

    A row of a single cell is a heading over the rows that follow it.
    """

    title: str
    note: str
    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    words: int = 1


def tabulated(
    records: Iterable[R], columns: Mapping[str, Callable[[R], str]], *, title: str, note: str = "", words: int = 1
) -> Table | None:
    """A table of one row a record; None without records.

    Args:
        records: in the order of the rows.
        columns: what each column shows of a record, by its head.
        title: over the table.
        note: below it.
        words: how many of the first columns are words.
    """
    rows = tuple(tuple(cell(record) for cell in columns.values()) for record in records)
    return Table(title=title, note=note, heads=tuple(columns), rows=rows, words=words) if rows else None
