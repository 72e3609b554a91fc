"""Files that are written whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path

from contact.records.errors import InvalidInput


def write_whole(path: Path, content: str | bytes) -> None:
    """Write a text or bytes so that readers get the old file or the new one, never a part (fsync, rename).

    The target of a link is written; a device or pipe is written directly.

    Raises:
        InvalidInput: If the folder is missing or the disk is full; no partial file remains.
    """
    data = content.encode("utf-8") if isinstance(content, str) else content
    target = path.resolve()
    try:
        if target.exists() and not target.is_file():
            target.write_bytes(data)
        else:
            _replace(target, data)
    except OSError as error:
        remedy = "make room, or name another place" if path.parent.is_dir() else "check that the folder exists"
        raise InvalidInput(f"{path}: cannot be written ({error.strerror}); {remedy}") from None


def _replace(path: Path, data: bytes) -> None:
    """Write a temporary file in the same folder, then rename it to ``path``."""
    unfinished = path.with_name(f".{path.name}.{os.getpid()}.partial")
    try:
        with unfinished.open("wb") as stream:
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())
        unfinished.replace(path)
    finally:
        unfinished.unlink(missing_ok=True)
