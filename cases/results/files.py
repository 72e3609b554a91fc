"""A run on disk: ``results.json`` is the whole run without loss; ``results.h5`` holds its arrays for other programs."""

import os
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import TypeAdapter

from cases.results.records.run import SCHEMA_VERSION, CaseResult, RunResult
from cases.results.strict_json import json_object, json_text, read_json, validated
from contact import InvalidInput
from contact.files.storage import write_tree
from contact.records.errors import shown

_RUN: TypeAdapter[RunResult] = TypeAdapter(RunResult)
_NAME = "results.json"
_REMEDY = "run the cases again (with --resume finished solutions are kept)"


def to_json(run: RunResult) -> str:
    """Return ``run`` as JSON text; every float keeps all its digits, none can be non-finite."""
    return json_text(_RUN.dump_python(run, mode="json"))


def from_json(text: str) -> RunResult:
    """Return the run stored in ``text``.

    Raises:
        InvalidInput: if the text is no such JSON.
    """
    return _validated(json_object(text.encode("utf-8", "surrogatepass"), place=_NAME, remedy=_REMEDY), _NAME)


def _validated(tree: dict[str, Any], place: str) -> RunResult:
    version = tree.get("schema_version")
    if version != SCHEMA_VERSION:
        raise InvalidInput(f"{place} has schema version {shown(version)}, this program reads {SCHEMA_VERSION}")
    return validated(_RUN, tree, place=place, remedy=_REMEDY)


def json_schema() -> dict[str, Any]:
    """Return the JSON Schema of results.json."""
    return _RUN.json_schema()


def write_run(run: RunResult, directory: Path) -> None:
    """Write ``results.json`` and ``results.h5`` into ``directory``; each file is whole or absent, never torn."""
    write_verdicts(run, directory)
    write_tree(directory / "results.h5", arrays(run))


def write_verdicts(run: RunResult, directory: Path) -> None:
    """Write ``results.json`` alone: of a run whose arrays are stored and whose claims have changed."""
    directory.mkdir(parents=True, exist_ok=True)
    write_whole(directory / _NAME, to_json(run))


def read_run(directory: Path) -> RunResult:
    """Return the run stored in ``directory``.

    Raises:
        InvalidInput: in one line, if there is none, or it cannot be read.
    """
    path = require_run(directory)
    return _validated(read_json(path, remedy=_REMEDY), str(path))


def require_run(directory: Path) -> Path:
    """Return where the run in ``directory`` is stored.

    Raises:
        InvalidInput: if there is none.
    """
    path = directory / _NAME
    if not path.is_file():
        raise InvalidInput(f"no {_NAME} in {directory}; give the directory of a finished run")
    return path


def write_whole(path: Path, content: str | bytes) -> None:
    """Write a text or bytes so that a reader finds the old file or the new one, never a part (fsync, rename).

    A link stays a link; a device or pipe is written to as it stands.

    Raises:
        InvalidInput: if the disk is full or does not let the file be written; nothing is left of it then.
    """
    data = content.encode("utf-8") if isinstance(content, str) else content
    target = path.resolve()
    special = target.exists() and not target.is_file()
    try:
        if special:
            target.write_bytes(data)
        else:
            _replace(target, data)
    except OSError as error:
        raise InvalidInput(f"{path}: cannot be written ({error.strerror}); make room, or name another place") from None


def _replace(path: Path, data: bytes) -> None:
    unfinished = path.with_name(f".{path.name}.{os.getpid()}.partial")
    try:
        with unfinished.open("wb") as stream:
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())
        unfinished.replace(path)
    finally:
        unfinished.unlink(missing_ok=True)


def arrays(run: RunResult) -> dict[str, Any]:
    """Return the arrays of ``run``: case / scene / method / quantity and curve names."""
    return {case.name: _case_arrays(case) for case in run.cases}


def _case_arrays(case: CaseResult) -> dict[str, Any]:
    tree: dict[str, Any] = {}
    for solved in (r for r in case.runs if r.solved):
        place = tree.setdefault(solved.scene.replace("/", " over "), {}).setdefault(solved.method, {})
        for q in solved.quantities:
            place[q.name] = {"values": np.array(q.values), "uncertainty": np.array(q.uncertainty)}
        for curve in solved.curves:
            place[f"{curve.name} curve"] = {curve.x_name: np.array(curve.x), curve.name: np.array(curve.y)}
    return tree
