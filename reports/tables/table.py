"""A table before anyone prints it: in a terminal, in HTML."""

from dataclasses import dataclass


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
