"""One run at a time in a folder of results: a lock that the operating system frees when its owner ends, however."""

import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from filelock import FileLock, Timeout

from contact import InvalidInput

LOCK_NAME = ".lock"
# File that names the owner of the lock: on Windows no other process can read a locked file.
OWNER_NAME = ".lock_owner"


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Keep every other process out of ``folder`` as long as the context lasts; the folder is made if need be.

    The parts of a command may lock the same folder again; another thread may not. The files of the lock stay behind. A
    lock whose owner is dead is free.

    Raises:
        InvalidInput: If another run works in the folder, at once, with the owner's process number.
    """
    folder.mkdir(parents=True, exist_ok=True)
    place = folder.resolve()
    try:
        # There is one lock per path, which counts how often a thread has acquired it.
        lock = FileLock(place / LOCK_NAME, blocking=False, is_singleton=True).acquire()
    except Timeout:
        raise InvalidInput(
            f"another run works in {folder} ({_owner(place)}); wait for its end, or name another --out"
        ) from None
    with lock:
        (place / OWNER_NAME).write_text(f"process {os.getpid()} on {socket.gethostname()}\n", encoding="utf-8")
        yield


def _owner(place: Path) -> str:
    """Process and machine of the owner of a lock, where they are known."""
    try:
        return (place / OWNER_NAME).read_text(encoding="utf-8")[:200].strip()
    except OSError:
        return "another process"
