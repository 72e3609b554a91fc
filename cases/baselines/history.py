"""Who accepted which change and why: one line of JSON each, only ever appended."""

import json
import os
from collections.abc import Iterable
from pathlib import Path

from pydantic import TypeAdapter, ValidationError

from cases.results import Acceptance
from contact import InvalidInput

_ACCEPTANCE: TypeAdapter[Acceptance] = TypeAdapter(Acceptance)
_FILE = "history.jsonl"


def read_history(directory: Path) -> tuple[Acceptance, ...]:
    """Return every acceptance, oldest first.

    Raises:
        InvalidInput: naming the line that is none.
    """
    path = directory / _FILE
    if not path.is_file():
        return ()
    lines = path.read_text(encoding="utf-8").splitlines()
    return tuple(_parsed(path, number, line) for number, line in enumerate(lines, 1))


def append_history(directory: Path, acceptances: Iterable[Acceptance]) -> None:
    """Append acceptances."""
    directory.mkdir(parents=True, exist_ok=True)
    with (directory / _FILE).open("a", encoding="utf-8") as stream:
        for acceptance in acceptances:
            tree = _ACCEPTANCE.dump_python(acceptance, mode="json")
            stream.write(json.dumps(tree, sort_keys=True, allow_nan=False) + "\n")
        stream.flush()
        os.fsync(stream.fileno())


def _parsed(path: Path, number: int, line: str) -> Acceptance:
    try:
        return _ACCEPTANCE.validate_python(json.loads(line))
    except (ValidationError, ValueError) as error:
        raise InvalidInput(f"{path}, line {number} is no acceptance: {error}; restore it") from error
