"""HDF5 storage: nested mappings of arrays, and solutions, to a file and back without loss. The only user of h5py."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import os
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from io import BufferedReader
from pathlib import Path
from typing import Any, TypeAlias

import h5py
import numpy as np
from numpy.typing import NDArray

from contact.answer.friction import FrictionHistory, FrictionPath
from contact.answer.solution import ContactPath, CriticalPoint, DetachmentPath, HistoryPath, ImpactHistory, Solution
from contact.answer.stages import Cost, StageRecord
from contact.files.scene_file import scene_from_mapping, scene_to_mapping
from contact.records.errors import InvalidInput, shown
from contact.records.validation import FloatArray

# The values are arrays, numbers, strings, None, or mappings of the same.
Tree: TypeAlias = Mapping[str, Any]

SCHEMA = "contact-verification/solution/2"
# Files of the first layout differ in one entry, which only detachments have; the others are read as they are.
_READABLE = (SCHEMA, "contact-verification/solution/1")
SEAL = b"contact-verification sha256 "  # what a file begins with, before the digest of its content
# Deeper trees are refused, so that reading and writing them needs no deep recursion; a solution is three deep.
MAX_DEPTH = 32
# Longer names of entries are refused; those of solutions have fewer than thirty letters.
MAX_NAME = 200
# HDF5 leaves so many bytes to its user before its own; 512 is the smallest block that its format allows.
_BLOCK = 512

_KINDS: dict[str, type[Solution]] = {
    cls.__name__: cls
    for cls in (ContactPath, DetachmentPath, FrictionHistory, FrictionPath, HistoryPath, ImpactHistory)
}


def write_tree(path: str | Path, tree: Tree) -> None:
    """Write nested mappings of arrays and scalars; the file appears complete or not at all.

    The file begins with a digest of its content (in the block that HDF5 leaves to its user), so that a damaged file is
    refused before one number is read from it.

    Raises:
        InvalidInput: If the folder cannot be written, the disk is full, or an entry is of another type.
    """
    file = Path(path)
    data = _sealed(tree)
    try:
        handle, temporary = tempfile.mkstemp(dir=file.parent, prefix=f".{file.name}.")
    except OSError as error:
        raise InvalidInput(f"{file}: cannot be written ({error.strerror}); check that the folder exists") from None
    try:
        with open(handle, "wb") as stream:
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(temporary, file)
    except OSError as error:
        raise InvalidInput(f"{file}: cannot be written ({error.strerror}); make room, or name another place") from None
    finally:
        Path(temporary).unlink(missing_ok=True)


def _sealed(tree: Tree) -> bytes:
    """The bytes of a whole file. They are made in memory: HDF5 itself crashes when a disk fills up under it."""
    in_memory = {"driver": "core", "backing_store": False}
    with h5py.File("tree", "w", track_order=True, userblock_size=_BLOCK, **in_memory) as root:
        _write(root, tree, depth=0)
        root.flush()
        content = bytes(root.id.get_file_image())
    return (SEAL + hashlib.sha256(content).hexdigest().encode()).ljust(_BLOCK, b"\0") + content


def _digest(stream: BufferedReader) -> bytes:
    """What the first bytes of a whole file say."""
    stream.seek(_BLOCK)
    return SEAL + hashlib.file_digest(stream, "sha256").hexdigest().encode()


def _write(group: h5py.Group, tree: Tree, depth: int) -> None:
    if not isinstance(tree, Mapping) or depth > MAX_DEPTH:
        raise InvalidInput(f"{shown(tree)}: give mappings of arrays and numbers, at most {MAX_DEPTH} deep")
    for name, value in tree.items():
        if not isinstance(name, str) or not 0 < len(name) <= MAX_NAME or name == "." or set(name) & set("/\0"):
            raise InvalidInput(f"{group.name}: {shown(name)} cannot name an entry; give a short text without a slash")
        if isinstance(value, Mapping):
            _write(group.create_group(name, track_order=True), value, depth + 1)
        elif not _is_storable(value):
            kind = f"{type(value).__name__} of {value.dtype}" if isinstance(value, np.ndarray) else type(value).__name__
            raise InvalidInput(f"{group.name}/{name}: a {kind} cannot be stored; give an array or number")
        else:
            _write_leaf(group, name, value)


def _is_storable(value: object) -> bool:
    if isinstance(value, np.ndarray):
        return value.dtype.kind in "biufc" and not isinstance(value, np.ma.MaskedArray)
    return value is None or isinstance(value, bool | int | float | str | np.bool_ | np.number)


def _write_leaf(group: h5py.Group, name: str, value: Any) -> None:
    try:
        if isinstance(value, np.ndarray):
            group.create_dataset(name, data=value, track_times=False)
        else:
            group.attrs[name] = h5py.Empty("f8") if value is None else value  # HDF5 knows no None
    except (
        ValueError,
        TypeError,
        OverflowError,
        KeyError,
    ) as error:
        # HDF5 holds no integer beyond 64 bits and no text with a zero byte.
        raise InvalidInput(f"{group.name}/{name} = {shown(value)}: cannot be stored ({error!s:.160})") from None


def read_tree(path: str | Path) -> dict[str, Any]:
    """Read what `write_tree` wrote.

    Raises:
        InvalidInput: If the file is missing, was not written by `write_tree`, or is damaged.
    """
    file = Path(path)
    try:
        with file.open("rb") as stream:
            _check_seal(file, stream)
        with h5py.File(file, "r") as root:
            return _read(root)
    except InvalidInput:
        raise
    except (OSError, RuntimeError, KeyError, ValueError, TypeError) as error:
        raise InvalidInput(f"{file}: not a readable HDF5 file ({error!s:.160})") from None


def _check_seal(file: Path, stream: BufferedReader) -> None:
    start = stream.read(_BLOCK)
    if not start.startswith(SEAL):
        raise InvalidInput(f"{file}: not written by this program, or its beginning is lost; write it again")
    if start.rstrip(b"\0") != _digest(stream):
        raise InvalidInput(f"{file}: the content does not match its digest; the file is damaged or truncated")


def _read(group: h5py.Group) -> dict[str, Any]:
    tree = {name: _scalar(value) for name, value in group.attrs.items()}
    for name, item in group.items():
        tree[name] = _read(item) if isinstance(item, h5py.Group) else np.asarray(item[()])
    return tree


def _scalar(value: Any) -> Any:
    if isinstance(value, h5py.Empty):
        return None
    return value.item() if isinstance(value, np.generic) else value


@dataclass(frozen=True)
class SampledFields:
    """Surface fields known at stored radii only; any other radius is refused, never interpolated.

    Attributes:
        radius: r [m], shape (n, m): m radii for each of n steps.
        pressures: p [Pa], same shape.
        displacements: w [m], same shape.
    """

    radius: FloatArray
    pressures: FloatArray
    displacements: FloatArray

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """p [Pa] at stored radii."""
        return np.asarray(self.pressures[step, self._places(radius, step)])

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """w [m] at stored radii."""
        return np.asarray(self.displacements[step, self._places(radius, step)])

    def _places(self, radius: FloatArray, step: int) -> NDArray[np.intp]:
        stored = self.radius[step]
        places = np.minimum(np.searchsorted(stored, radius), stored.size - 1)
        missing = stored[places] != radius
        if missing.any():
            wanted = radius[missing][0]
            raise InvalidInput(
                f"radius = {wanted:.17g}: not among the {stored.size} stored radii; solve the scene again"
            )
        return np.asarray(places, dtype=np.intp)


def save_solution(path: str | Path, solution: Solution, radius: FloatArray | None = None) -> None:
    """Write a solution; `radius` [m], increasing, shape (m,) or (n, m), says where its surface fields are kept."""
    write_tree(path, solution_to_tree(solution, radius))


def load_solution(path: str | Path) -> Solution:
    """Read a solution back; every number equals the stored one.

    Raises:
        InvalidInput: If the file is not one that `save_solution` wrote.
    """
    tree = read_tree(path)
    try:
        return solution_from_tree(tree)
    except InvalidInput as error:
        raise InvalidInput(f"{path}: {error}") from None
    except (KeyError, TypeError, AttributeError, json.JSONDecodeError) as error:
        raise InvalidInput(f"{path}: not a stored solution ({error!r}); write it with save_solution") from None


def solution_to_tree(solution: Solution, radius: FloatArray | None = None) -> dict[str, Any]:
    """The solution as a tree of arrays and scalars."""
    arrays = {name: getattr(solution, name) for name in solution.ARRAYS}
    tree: dict[str, Any] = {
        "schema": SCHEMA,
        "kind": type(solution).__name__,
        "scene": json.dumps(scene_to_mapping(solution.scene)),
        "method": solution.method,
        "settings": dict(solution.settings),
        "error_estimate": dict(solution.error_estimate),
        "cost": json.dumps(dataclasses.asdict(solution.cost)),
        "stages": json.dumps([dataclasses.asdict(stage) for stage in solution.stages]),
        "notes": json.dumps(solution.notes),
        "arrays": arrays | {name: getattr(solution, name) for name in solution.SCALARS},
    }
    if isinstance(solution, DetachmentPath):
        tree["arrays"]["stable_displacement_control"] = solution.stable_displacement_control
        tree["arrays"]["stable_force_control"] = solution.stable_force_control
        tree["critical_points"] = json.dumps([dataclasses.asdict(point) for point in solution.critical_points])
    if isinstance(solution, ContactPath) and radius is not None:
        tree["fields"] = _sampled(solution, np.asarray(radius, dtype=np.float64))
    return tree


def _sampled(path: ContactPath, radius: FloatArray) -> dict[str, FloatArray]:
    rows = np.broadcast_to(radius, (len(path), radius.shape[-1]))
    if np.any(np.diff(rows, axis=1) <= 0.0):
        raise InvalidInput("radius: stored radii must increase strictly")
    return {
        "radius": np.array(rows),
        "pressures": np.array([path.pressure(row, step) for step, row in enumerate(rows)]),
        "displacements": np.array([path.surface_displacement(row, step) for step, row in enumerate(rows)]),
    }


def solution_from_tree(tree: Tree) -> Solution:
    """The inverse of `solution_to_tree`.

    Raises:
        InvalidInput: If the tree is of another schema, or of an older one without a number that is needed today.
    """
    if tree.get("schema") not in _READABLE:
        raise InvalidInput(f"schema = {tree.get('schema')!r}: this version reads {' and '.join(map(repr, _READABLE))}")
    kind = _KINDS[tree["kind"]]
    if missing := [name for name in (*kind.ARRAYS, *kind.SCALARS) if name not in tree["arrays"]]:
        raise InvalidInput(
            f"a stored {kind.__name__} without {', '.join(missing)} (schema {tree['schema']!r}): an older version wrote"
            " it; solve its scene again with this one"
        )
    extra: dict[str, Any] = {}
    if "critical_points" in tree:
        extra["critical_points"] = tuple(CriticalPoint(**point) for point in json.loads(tree["critical_points"]))
    if "fields" in tree:
        extra["fields"] = SampledFields(**tree["fields"])
    return kind(
        scene=scene_from_mapping(json.loads(tree["scene"])),
        method=tree["method"],
        settings=tree["settings"],
        error_estimate=tree["error_estimate"],
        cost=Cost(**json.loads(tree["cost"])),
        stages=tuple(StageRecord(**stage) for stage in json.loads(tree["stages"])),
        notes=tuple(json.loads(tree["notes"])),
        **tree["arrays"],
        **extra,
    )
