"""JSON files that only this program writes: one canonical text under a digest, and one reader that refuses the rest."""

import hashlib
import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

from pydantic import TypeAdapter, ValidationError

from cases.results.canonical import indented, key_text
from contact import InvalidInput
from contact.records.record import shown

T = TypeVar("T")

# A larger file is refused before it is read: its values would need several times these bytes of memory.
MAX_BYTES = 500_000_000
# An integer with more digits is refused: a 64-bit one, the largest that a record needs, has 20.
MAX_DIGITS = 40


def sealed_text(content: Mapping[str, Any], covered: str = "") -> str:
    """Return the canonical text of ``content`` with its digest.

    Args:
        content: plain values; an entry "digest" is added.
        covered: name of the entry that the digest is computed from; empty for the whole content.
    """
    entries = {name: indented(value, 1) for name, value in content.items()}
    return _of_entries({**entries, "digest": f'"{_seal(entries, covered)}"'})


def digest_of(text: str) -> str:
    """Return the digest that tells whether a text was changed: half of a SHA-256, 32 hexadecimal digits."""
    return hashlib.sha256(text.encode()).hexdigest()[:32]


def _seal(entries: Mapping[str, str], covered: str) -> str:
    """Return the digest of the entry that it covers, or of them all."""
    # A line ends between values only: within words its end is written as a backslash and a letter.
    return digest_of(entries[covered].replace("\n ", "\n") + "\n" if covered else _of_entries(entries))


def _of_entries(entries: Mapping[str, str]) -> str:
    """Return the canonical text of an object from those of its entries."""
    lines = (f" {key_text(name)}{entries[name]}" for name in sorted(entries))
    return "{\n" + ",\n".join(lines) + "\n}\n" if entries else "{}\n"


def read_sealed(path: Path, *, remedy: str, covered: str = "") -> dict[str, Any]:
    """Return the content of a file that was written with `sealed_text`.

    Args:
        path: the file.
        remedy: what a user does about a file that is refused.
        covered: as it was written.

    Raises:
        InvalidInput: in one line, if the file cannot be read or one byte of it differs from what was written.
    """
    return unsealed(_bytes_of(path, remedy), place=str(path), remedy=remedy, covered=covered)


def unsealed(data: bytes, *, place: str, remedy: str, covered: str = "") -> dict[str, Any]:
    """Return the content of ``data``, the bytes of a sealed text; arguments and errors as of `read_sealed`."""
    try:
        tree = parsed(data)
        entries = {name: indented(value, 1) for name, value in tree.items()} if isinstance(tree, dict) else {}
    except (ValueError, RecursionError) as error:
        raise InvalidInput(f"{place} is not readable: {_words(error)}; {remedy}") from None
    if not isinstance(tree, dict) or "digest" not in tree:
        raise InvalidInput(f"{place} has no seal: an older version or something else wrote it; {remedy}")
    whole = _of_entries(entries).encode() == data
    del entries["digest"]
    digest = tree.pop("digest")
    if covered and tree.keys() != {covered}:
        raise InvalidInput(f"{place} has other entries than {covered!r} and its digest; {remedy}")
    if not whole or digest != _seal(entries, covered):
        raise InvalidInput(f"{place} was changed after it was written: its seal does not fit; {remedy}")
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
