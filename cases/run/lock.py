"""One run at a time in a folder of results: a lock that the operating system frees when its owner ends, however."""

import fcntl
import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path
from typing import TextIO

from contact import InvalidInput

LOCK_NAME = ".lock"

# Folders that this thread has locked already: the parts of a command lock the same folder again without waiting.
_HELD: ContextVar[frozenset[Path]] = ContextVar("_HELD", default=frozenset())


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Keep every other process out of ``folder`` as long as the context lasts; the folder is made if need be.

    The file of the lock stays behind; a lock whose owner is dead is free, whatever its file says.

    Raises:
        InvalidInput: at once, with the owner's process number, if another run works in the folder.
    """
    place = folder.resolve()
    if place in _HELD.get():
        yield
        return
    folder.mkdir(parents=True, exist_ok=True)
    with (place / LOCK_NAME).open("a+", encoding="utf-8") as stream:
        _take(stream, folder)
        token = _HELD.set(_HELD.get() | {place})
        try:
            yield
        finally:
            _HELD.reset(token)


def _take(stream: TextIO, folder: Path) -> None:
    try:
        fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        stream.seek(0)
        owner = stream.read(200).strip() or "another process"
        raise InvalidInput(
            f"another run works in {folder} ({owner}); wait for its end, or name another --out"
        ) from None
    stream.truncate(0)
    stream.write(f"process {os.getpid()} on {socket.gethostname()}\n")
    stream.flush()
