"""The text of a scene file: read without waiting for ever, decoded, and short enough to be parsed at once."""

from __future__ import annotations

import codecs
import os
import re
import select
import stat
import time
from pathlib import Path
from typing import Final

from contact.records.errors import InvalidInput

# A scene file beyond this number of bytes is not a scene.
MAX_BYTES: Final = 32_000_000

# Seconds that a pipe may stay silent before it is refused: enough for a program that writes a scene into it.
PIPE_PATIENCE: Final = 5.0

# Parts of a dotted key beyond which no scene is meant: places in a scene have three.  The time and the nesting of
# Python's TOML parser grow with the square of this number.
MAX_KEY_PARTS: Final = 16

# What stands between quotes or after "#" is no key; an open quote ends with its line, so that the search is linear.
_PART = r"""(?:"(?:[^"\\\n]|\\.)*+"?|'[^'\n]*+'?|[\w+-]++)"""
_CHAINS: Final = re.compile(
    rf'''#[^\n]*+|"""(?:[^"\\]|\\.|"(?!""))*+(?:""")?|{"'" * 3}(?:[^']|'(?!''))*+(?:{"'" * 3})?'''
    rf"""|(?P<long>{_PART}(?:[ \t]*+\.[ \t]*+{_PART}){{{MAX_KEY_PARTS},}}+)|{_PART}(?:[ \t]*+\.[ \t]*+{_PART})*+""",
    re.DOTALL,
)


def scene_text(file: Path) -> str:
    """The text of a scene file, without a byte-order mark.

    Raises:
        InvalidInput: If the file cannot be read, is silent, too large or empty, is no UTF-8, or has endless keys.
    """
    try:
        content = _pipe_content(file) if stat.S_ISFIFO(file.stat().st_mode) else _file_content(file)
    except (OSError, ValueError) as error:
        # A path with a zero byte raises a ValueError.
        reason = getattr(error, "strerror", None) or error
        raise InvalidInput(f"{file}: cannot be read ({reason}); check the path") from None
    if len(content) > MAX_BYTES:
        raise InvalidInput(f"{file}: more than a scene can have ({MAX_BYTES} bytes)")
    text = _decoded(file, content)
    if not text.strip():
        raise InvalidInput(f"{file}: the file is empty; a scene needs [layer], [indenter] and [loading]")
    if any(found["long"] for found in _CHAINS.finditer(text)):
        raise InvalidInput(f"{file}: a key of more than {MAX_KEY_PARTS} parts joined by dots; no scene has such a key")
    return text


def _file_content(file: Path) -> bytes:
    """At most one byte more than allowed: a device has no size and no end."""
    with file.open("rb") as stream:
        return stream.read(MAX_BYTES + 1)


def _pipe_content(file: Path) -> bytes:
    """What a pipe's writer sends until it closes the pipe.

    Raises:
        InvalidInput: If nothing comes for `PIPE_PATIENCE` seconds.
    """
    descriptor = os.open(file, os.O_RDONLY | os.O_NONBLOCK)
    try:
        content, poll = bytearray(), select.poll()
        poll.register(descriptor, select.POLLIN)
        deadline = time.monotonic() + PIPE_PATIENCE
        while len(content) <= MAX_BYTES:
            if not poll.poll(1e3 * max(deadline - time.monotonic(), 0.0)):
                raise InvalidInput(
                    f"{file}: a pipe into which nobody has written all of a scene within {PIPE_PATIENCE:g} s; "
                    "write the scene into a file, and name that"
                )
            piece = os.read(descriptor, 1 << 20)
            if not piece:
                break
            content += piece
        return bytes(content)
    finally:
        os.close(descriptor)


def _decoded(file: Path, content: bytes) -> str:
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        what = "the text is UTF-16" if _is_utf16(content) else f"not a text file (byte {error.start})"
        raise InvalidInput(f"{file}: {what}; save the scene as TOML in UTF-8") from None


def _is_utf16(content: bytes) -> bool:
    """Whether the bytes begin with a mark of UTF-16 and are text in it."""
    try:
        return content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)) and bool(content.decode("utf-16"))
    except UnicodeDecodeError:
        return False
