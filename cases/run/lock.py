"""One run at a time in a folder of results: a lock that the operating system frees when its owner ends, however."""

import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path

from contact import InvalidInput

LOCK_NAME = ".lock"
# Who has the lock: on Windows no other process can read a locked file.
OWNER_NAME = ".lock_owner"

# Folders that this thread has locked already: the parts of a command lock the same folder again without waiting.
_HELD: ContextVar[frozenset[Path]] = ContextVar("_HELD", default=frozenset())


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Keep every other process out of ``folder`` as long as the context lasts; the folder is made if need be.

    The files of the lock stay behind; a lock whose owner is dead is free, whatever they say.

    Raises:
        InvalidInput: If another run works in the folder, at once, with the owner's process number.
    """
    # Commands that only solve need not wait 0.04 s for this import.
    from filelock import FileLock, Timeout  # noqa: PLC0415

    place = folder.resolve()
    if place in _HELD.get():
        yield
        return
    folder.mkdir(parents=True, exist_ok=True)
    try:
        lock = FileLock(place / LOCK_NAME, blocking=False).acquire()
    except Timeout:
        raise InvalidInput(
            f"another run works in {folder} ({_owner(place)}); wait for its end, or name another --out"
        ) from None
    with lock:
        (place / OWNER_NAME).write_text(f"process {os.getpid()} on {socket.gethostname()}\n", encoding="utf-8")
        token = _HELD.set(_HELD.get() | {place})
        try:
            yield
        finally:
            _HELD.reset(token)


def _owner(place: Path) -> str:
    """The text that the owner of a lock has left, if any."""
    try:
        return (place / OWNER_NAME).read_text(encoding="utf-8")[:200].strip()
    except OSError:
        return "another process"
