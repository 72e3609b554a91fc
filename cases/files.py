"""Files of this program: written whole or not at all, and read strictly."""

import csv
import io
from collections.abc import Iterable
from pathlib import Path
from typing import TypeVar

from pydantic import TypeAdapter, ValidationError

from contact import InvalidInput
from contact.records.errors import shown

T = TypeVar("T")

# A larger file is refused before it is read: its values would need several times these bytes of memory.
MAX_BYTES = 500_000_000


def read_record(adapter: TypeAdapter[T], path: Path, *, remedy: str) -> T:
    """Return the record in a JSON file.

    Args:
        adapter: Adapter of the record's type, whose numbers are finite.
        path: The file.
        remedy: Advice about a file that is refused.

    Raises:
        InvalidInput: Naming the first entry that fits no record, its value, and the remedy, in one line.
    """
    try:
        if (size := path.stat().st_size) > MAX_BYTES:
            raise InvalidInput(f"{path} has {size} bytes, more than {MAX_BYTES}; {remedy}")
        return validated(adapter, path.read_bytes(), place=str(path), remedy=remedy)
    except OSError as error:
        raise InvalidInput(f"{path} cannot be read ({error.strerror}); {remedy}") from None


def validated(adapter: TypeAdapter[T], data: bytes, *, place: str, remedy: str) -> T:
    """Return the record that a JSON text holds; arguments and errors as of `read_record`."""
    try:
        return adapter.validate_json(data)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = ".".join(str(part) for part in first["loc"])
        wrong = f"{place}: {where:.200}: {first['msg']:.200}, got {shown(first['input'])}"
        raise InvalidInput(f"{wrong}; {remedy}") from None


def csv_text(heads: Iterable[str], rows: Iterable[Iterable[object]]) -> str:
    """Return a table as CSV; floats have all digits needed to read them back exactly, None is an empty cell."""
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(heads)
    writer.writerows(rows)
    return buffer.getvalue()
