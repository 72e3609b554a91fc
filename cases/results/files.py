"""A run on disk: ``results.json`` is the whole run without loss; ``results.h5`` holds its arrays for other programs."""

import json
import os
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import TypeAdapter, ValidationError

from cases.results.records import SCHEMA_VERSION, CaseResult, RunResult
from contact import InvalidInput
from contact.files.storage import write_tree
from contact.records.record import shown

_RUN: TypeAdapter[RunResult] = TypeAdapter(RunResult)


def to_json(run: RunResult) -> str:
    """Return ``run`` as JSON text with sorted keys; every float keeps all its digits, none can be non-finite."""
    return json.dumps(_RUN.dump_python(run, mode="json"), sort_keys=True, indent=1, allow_nan=False) + "\n"


def from_json(text: str) -> RunResult:
    """Return the run stored in ``text``.

    Raises:
        InvalidInput: if the text is no such JSON; names schema version or field.
    """
    try:
        tree = json.loads(text, parse_constant=_refuse_constant)
    except ValueError as error:
        raise InvalidInput(f"results.json is not readable: {error!s:.200}; run the cases again") from error
    version = tree.get("schema_version") if isinstance(tree, dict) else None
    if version != SCHEMA_VERSION:
        raise InvalidInput(f"results.json has schema version {shown(version)}, this program reads {SCHEMA_VERSION}")
    try:
        return _RUN.validate_python(tree)
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"])
        raise InvalidInput(f"results.json: {where:.200}: {first['msg']:.200}, got {shown(first['input'])}") from error


def json_schema() -> dict[str, Any]:
    """Return the JSON Schema of results.json."""
    return _RUN.json_schema()


def _refuse_constant(name: str) -> float:
    raise ValueError(f"non-finite number {name}")


def write_run(run: RunResult, directory: Path) -> None:
    """Write ``results.json`` and ``results.h5`` into ``directory``; each file is whole or absent, never torn."""
    directory.mkdir(parents=True, exist_ok=True)
    write_whole(directory / "results.json", to_json(run))
    write_tree(directory / "results.h5", arrays(run))


def read_run(directory: Path) -> RunResult:
    """Return the run stored in ``directory``.

    Raises:
        InvalidInput: if there is none or it cannot be read.
    """
    path = directory / "results.json"
    if not path.is_file():
        raise InvalidInput(f"no results.json in {directory}; give the directory of a finished run")
    return from_json(path.read_text(encoding="utf-8"))


def write_whole(path: Path, text: str) -> None:
    """Write ``text`` so that a reader finds the old file or the new one, never a part (fsync, rename)."""
    unfinished = path.with_name(f".{path.name}.{os.getpid()}.partial")
    with unfinished.open("w", encoding="utf-8") as stream:
        stream.write(text)
        stream.flush()
        os.fsync(stream.fileno())
    unfinished.replace(path)


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
