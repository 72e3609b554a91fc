"""Every acceptance, oldest first, in ``baselines/history.jsonl``: one line each, only ever appended to.

The last line is a seal over all lines before it: a history edited by hand is refused.
"""

import json
from collections.abc import Iterable, Sequence
from pathlib import Path

from pydantic import TypeAdapter

from cases.gate.write_permission import WriteConditions
from cases.results.canonical import indented
from cases.results.files import write_whole
from cases.results.records.run import Acceptance
from cases.results.sealed import digest_of, parsed, validated
from contact import InvalidInput

_ACCEPTANCE: TypeAdapter[Acceptance] = TypeAdapter(Acceptance)
REMEDY = "restore the file from the repository"


def history_path(folder: Path) -> Path:
    """Return where the history of the baselines in ``folder`` lies."""
    return folder / "history.jsonl"


def read_history(folder: Path) -> tuple[Acceptance, ...]:
    """Return every acceptance so far; none if there is no file.

    Raises:
        InvalidInput: if the file was changed after it was written, or if a line is no acceptance.
    """
    lines = _sealed_lines(history_path(folder))
    return tuple(_entry(line, f"{history_path(folder)}, line {number}") for number, line in enumerate(lines, start=1))


def append_history(folder: Path, entries: Iterable[Acceptance]) -> None:
    """Append ``entries``, all or none; what stands there already is not touched, and all of it is sealed anew.

    Raises:
        InvalidInput: if the file was changed after it was written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    write_history(folder, [*_sealed_lines(history_path(folder)), *map(_line, entries)])


def write_history(folder: Path, lines: Sequence[bytes]) -> None:
    """Write the history, whole or not at all: its lines and their seal."""
    write_whole(history_path(folder), b"".join([*lines, _seal(lines)]).decode("utf-8"))


def _sealed_lines(path: Path) -> list[bytes]:
    """The lines above the seal, with their ends; none if there is no file."""
    if not path.is_file():
        return []
    lines = path.read_bytes().splitlines(keepends=True)
    if not lines or lines[-1] != _seal(lines[:-1]):
        raise InvalidInput(f"{path} was changed after it was written: its last line does not seal it; {REMEDY}")
    return lines[:-1]


def _seal(lines: Iterable[bytes]) -> bytes:
    # Latin-1 has a letter for every byte: damaged bytes, too, have a digest of their own.
    text = b"".join(lines).decode("latin-1")
    digest = digest_of(indented(text) + "\n")
    return f'{{"digest": "{digest}"}}\n'.encode()


def blank_entry(now: WriteConditions, case: str, method: str, quantity: str, reason: str) -> Acceptance:
    """Return an entry about something that had no accepted value before."""
    return Acceptance(
        date=now.date,
        case=case,
        method=method,
        quantity=quantity,
        old=None,
        new=None,
        old_tolerance=None,
        new_tolerance=None,
        reason=reason,
        revision=now.revision,
    )


def _entry(line: bytes, place: str) -> Acceptance:
    try:
        tree = parsed(line)
    except (ValueError, RecursionError) as error:
        raise InvalidInput(f"{place} is not readable ({error!s:.160}); {REMEDY}") from None
    return validated(_ACCEPTANCE, tree, place=place, remedy=REMEDY)


def _line(entry: Acceptance) -> bytes:
    tree = _ACCEPTANCE.dump_python(entry, mode="json")
    return (json.dumps(tree, sort_keys=True, allow_nan=False) + "\n").encode()
