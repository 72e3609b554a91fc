"""JSON files of this program: one text with sorted keys and every digit, and a reader that refuses damaged files."""

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

from pydantic import TypeAdapter, ValidationError

from contact import InvalidInput
from contact.records.errors import shown

T = TypeVar("T")

# A larger file is refused before it is read: its values would need several times these bytes of memory.
MAX_BYTES = 500_000_000
# An integer with more digits is refused: a 64-bit one, the largest that a record needs, has 20.
MAX_DIGITS = 40


def json_text(content: Mapping[str, Any]) -> str:
    """Return ``content`` as JSON with sorted keys; a number that is not finite raises ValueError."""
    return json.dumps(content, sort_keys=True, indent=1, allow_nan=False) + "\n"


def read_json(path: Path, *, remedy: str) -> dict[str, Any]:
    """Return the object in a file.

    Args:
        path: the file.
        remedy: what a user does about a file that is refused.

    Raises:
        InvalidInput: in one line, if the file cannot be read or holds no JSON object of finite numbers.
    """
    return json_object(_bytes_of(path, remedy), place=str(path), remedy=remedy)


def json_object(data: bytes, *, place: str, remedy: str) -> dict[str, Any]:
    """Return the object in ``data``; arguments and errors as of `read_json`."""
    try:
        tree = parsed(data)
    except (ValueError, RecursionError) as error:
        raise InvalidInput(f"{place} is not readable: {_words(error)}; {remedy}") from None
    if not isinstance(tree, dict):
        raise InvalidInput(f"{place} holds no JSON object; {remedy}")
    # Files of older versions hold a digest over their other entries.
    tree.pop("digest", None)
    return tree


def validated(adapter: TypeAdapter[T], tree: Any, *, place: str, remedy: str) -> T:
    """Return the records that ``tree`` holds.

    Raises:
        InvalidInput: in one line, naming the first entry that fits no record, its value, and the remedy.
    """
    try:
        return adapter.validate_python(tree)
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"])
        wrong = f"{place}: {where:.200}: {first['msg']:.200}, got {shown(first['input'])}"
        raise InvalidInput(f"{wrong}; {remedy}") from None


def parsed(data: bytes) -> Any:
    """Return the value of a JSON text.

    Raises:
        ValueError: for bytes that are no UTF-8, text that is no JSON, a name given twice, a number that is not finite
            or has too many digits.
        RecursionError: if it is nested too deeply.
    """
    return json.loads(
        data.decode("utf-8"),
        object_pairs_hook=_without_repetition,
        parse_constant=_refuse_constant,
        parse_float=_finite,
        parse_int=_integer,
    )


def _bytes_of(path: Path, remedy: str) -> bytes:
    if not path.is_file():
        raise InvalidInput(f"{path} is no file; {remedy}")
    try:
        if (size := path.stat().st_size) > MAX_BYTES:
            raise InvalidInput(f"{path} has {size} bytes, more than {MAX_BYTES}; {remedy}")
        return path.read_bytes()
    except OSError as error:
        raise InvalidInput(f"{path} cannot be read ({error.strerror}); {remedy}") from None


def _words(error: Exception) -> str:
    return "nested too deeply" if isinstance(error, RecursionError) else f"{error!s:.160}"


def _without_repetition(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    tree = dict(pairs)
    if len(tree) < len(pairs):
        names = [name for name, _ in pairs]
        raise ValueError(f"{shown(next(n for n in names if names.count(n) > 1))} is given twice")
    return tree


def _refuse_constant(name: str) -> float:
    raise ValueError(f"non-finite number {name}")


def _finite(digits: str) -> float:
    if not math.isfinite(number := float(digits)):
        raise ValueError(f"number {digits:.40} is beyond the range of a float")
    return number


def _integer(digits: str) -> int:
    if len(digits) > MAX_DIGITS:
        raise ValueError(f"an integer of {len(digits)} digits, {MAX_DIGITS} are permitted")
    return int(digits)
