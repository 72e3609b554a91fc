"""HDF5 storage of nested mappings of arrays, without loss of digits. No other module imports h5py."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeAlias

import h5py
import numpy as np

from contact.files.whole import write_whole
from contact.records.errors import InvalidInput, shown

# The values are arrays, numbers, strings, None, or mappings of the same.
Tree: TypeAlias = Mapping[str, Any]

SEAL = b"contact-verification sha256 "  # a file begins with it, before the digest of its content
# Bytes of the block before the content of HDF5, which is free for its user; 512 is the smallest that HDF5 allows.
_BLOCK = 512


def write_tree(path: str | Path, tree: Tree) -> None:
    """Write nested mappings of arrays and scalars; the file is complete or not written at all.

    It begins with a digest of its content (in the user block of HDF5), so that a damaged file is refused before any
    number is read.

    Raises:
        InvalidInput: If the folder cannot be written, the disk is full, or an entry is of another type.
    """
    # The whole file is built in memory: HDF5 itself crashes on a full disk.
    with h5py.File("tree", "w", track_order=True, userblock_size=_BLOCK, driver="core", backing_store=False) as root:
        _write(root, tree)
        root.flush()
        content = bytes(root.id.get_file_image())
    write_whole(Path(path), _seal(content) + content)


def _seal(content: bytes) -> bytes:
    """First block of a file with this content: mark and digest."""
    return (SEAL + hashlib.sha256(content).hexdigest().encode()).ljust(_BLOCK, b"\0")


def _write(group: h5py.Group, tree: Tree) -> None:
    """Write arrays as datasets, scalars as attributes and mappings as groups of a group."""
    for name, value in tree.items():
        if isinstance(value, Mapping):
            _write(group.create_group(name, track_order=True), value)
            continue
        if isinstance(value, list | tuple):
            raise InvalidInput(f"{group.name}/{name} = {shown(value)}: cannot be stored; give an array or a number")
        try:
            if isinstance(value, np.ndarray):
                group.create_dataset(name, data=value, track_times=False)
            else:
                group.attrs[name] = h5py.Empty("f8") if value is None else value  # HDF5 has no None
        except (ValueError, TypeError, OverflowError, KeyError) as error:
            # HDF5 stores no integer beyond 64 bits, no text with a zero byte and no objects of Python.
            raise InvalidInput(f"{group.name}/{name} = {shown(value)}: cannot be stored ({error!s:.160})") from None


def read_tree(path: str | Path) -> dict[str, Any]:
    """Nested mappings from a file that `write_tree` wrote.

    Raises:
        InvalidInput: If the file is missing, was not written by `write_tree`, or is damaged.
    """
    file = Path(path)
    try:
        with file.open("rb") as stream:
            start, content = stream.read(_BLOCK), stream.read()
        if start.startswith(SEAL) and start == _seal(content):
            with h5py.File(file, "r") as root:
                return _read(root)
    except (OSError, RuntimeError, KeyError, ValueError, TypeError) as error:
        raise InvalidInput(f"{file}: not a readable HDF5 file ({error!s:.160})") from None
    if start.startswith(SEAL):
        raise InvalidInput(f"{file}: the content does not match its digest; the file is damaged or truncated")
    raise InvalidInput(f"{file}: not written by this program, or its beginning is lost; write it again")


def _read(group: h5py.Group) -> dict[str, Any]:
    """Nested mappings of a group; the inverse of `_write`."""
    tree = {name: _scalar(value) for name, value in group.attrs.items()}
    for name, item in group.items():
        tree[name] = _read(item) if isinstance(item, h5py.Group) else np.asarray(item[()])
    return tree


def _scalar(value: Any) -> Any:
    """Python value of an attribute; None for an empty one."""
    if isinstance(value, h5py.Empty):
        return None
    return value.item() if isinstance(value, np.generic) else value
