"""Code and data that two methods share, in one list for claims, reports and tests of planted faults.

Agreement of two methods does not check what both use. `tests/planted/sharing.py` changes each entry of `shared.toml` by
one per cent; `docs/shared.md` lists the checks that then fail.
"""

import tomllib
from enum import StrEnum
from pathlib import Path

from pydantic.dataclasses import dataclass

EVERY = ("mdr", "mdr_table", "bem", "integral_equation", "fem")
NOT_SAID = "not said by its package"


class Sharing(StrEnum):
    """What kind of thing is shared."""

    CODE = "code"  # lines that compute numbers of the answer
    QUESTION = "question"  # the scene as the user gave it: without it there is nothing to compare
    RECORD = "record"  # how answers of all methods are stored and compared


@dataclass(frozen=True, kw_only=True)
class Shared:
    """Something that several methods use.

    Attributes:
        name: Name in reports and records.
        place: Module of the sources.
        guard: Check that detects a mistake that the sharing methods make together.
        kind: Code counts against independence; the question and the records are common to every comparison.
        methods: Names in the method table.
        quantities: Compared quantities that it enters; empty for all.
        cases: Cases that it enters; empty for all.
    """

    name: str
    place: str
    guard: str
    kind: Sharing = Sharing.CODE
    methods: tuple[str, ...] = EVERY
    quantities: tuple[str, ...] = ()
    cases: tuple[str, ...] = ()

    def enters(self, quantity: str, case: str) -> bool:
        """Whether a comparison of ``quantity`` in ``case`` rests on it."""
        return (not self.quantities or quantity in self.quantities) and (not self.cases or case in self.cases)


_TABLE = tomllib.loads(Path(__file__).with_name("shared.toml").read_text(encoding="utf-8"))
SHARED = tuple(Shared(name=name, **entry) for name, entry in _TABLE.items())
BY_NAME = {entry.name: entry for entry in SHARED}


def used_by(method: str) -> tuple[str, ...]:
    """Names of the code and data that a built-in method shares with others; `NOT_SAID` for any other method."""
    return tuple(entry.name for entry in SHARED if method in entry.methods) or (NOT_SAID,)


def in_common(first: tuple[str, ...], second: tuple[str, ...], *, quantity: str, case: str) -> tuple[str, ...]:
    """Names of the code and data that both answers use, which their agreement cannot check.

    Args:
        first: Names that the first answer used (`used_by`, or the `shared_inputs` of a method of another package).
        second: Names that the second answer used.
        quantity: Quantity that is compared.
        case: Name of the case.
    """
    both = [name for name in first if name in second]
    counted = [name for name in both if name not in BY_NAME or _counts(BY_NAME[name], quantity, case)]
    unknown = NOT_SAID in {*first, *second} and NOT_SAID not in both
    return (*counted, *((NOT_SAID,) if unknown else ()))


def _counts(entry: Shared, quantity: str, case: str) -> bool:
    return entry.kind is Sharing.CODE and entry.enters(quantity, case)
