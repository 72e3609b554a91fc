"""Every acceptance, oldest first, in ``baselines/history.jsonl``: one line each, only ever appended to."""

import json
from collections.abc import Iterable
from pathlib import Path

from pydantic import TypeAdapter, ValidationError

from cases.gate.write_permission import WriteConditions
from cases.results.files import write_whole
from cases.results.records.run import Acceptance
from cases.results.sealed import parsed
from contact import InvalidInput

_ACCEPTANCE: TypeAdapter[Acceptance] = TypeAdapter(Acceptance)


def history_path(folder: Path) -> Path:
    """Return where the history of the baselines in ``folder`` lies."""
    return folder / "history.jsonl"


def read_history(folder: Path) -> tuple[Acceptance, ...]:
    """Return every acceptance so far.

    Raises:
        InvalidInput: if a line is no acceptance.
    """
    path = history_path(folder)
    lines = path.read_bytes().splitlines() if path.is_file() else []
    return tuple(_entry(line, f"{path}, line {number}") for number, line in enumerate(lines, start=1))


def append_history(folder: Path, entries: Iterable[Acceptance]) -> None:
    """Append ``entries``, all or none; what stands there already is not touched."""
    folder.mkdir(parents=True, exist_ok=True)
    path = history_path(folder)
    before = path.read_text(encoding="utf-8") if path.is_file() else ""
    write_whole(path, before + "".join(_line(entry) for entry in entries))


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
        return _ACCEPTANCE.validate_python(parsed(line))
    except ValidationError as error:
        raise InvalidInput(f"{place} is no acceptance: {error.errors()[0]['msg']}; restore the file") from error
    except (ValueError, RecursionError) as error:
        raise InvalidInput(f"{place} is not readable ({error!s:.160}); restore the file") from None


def _line(entry: Acceptance) -> str:
    tree = _ACCEPTANCE.dump_python(entry, mode="json")
    return json.dumps(tree, sort_keys=True, allow_nan=False) + "\n"
