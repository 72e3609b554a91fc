"""Finished tasks on disk, one whole file each, so that a killed run can go on where it stopped."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter, ValidationError

from cases.results.files import write_whole
from cases.results.records import SceneRun
from cases.run.keys import differences
from contact import InvalidInput

_RUN: TypeAdapter[SceneRun] = TypeAdapter(SceneRun)


class TaskStore:
    """The folder of finished tasks; a file appears whole or not at all."""

    def __init__(self, directory: Path) -> None:
        self._directory = directory
        directory.mkdir(parents=True, exist_ok=True)

    def put(self, key: str, parts: Mapping[str, Any], run: SceneRun) -> None:
        """Store a finished task with everything its key was made of."""
        tree = {"parts": parts, "run": _RUN.dump_python(run, mode="json")}
        write_whole(self._path(key), json.dumps(tree, sort_keys=True, allow_nan=False))

    def get(self, key: str) -> SceneRun | None:
        """Return the stored row of ``key``; None when there is none or its file is damaged."""
        try:
            return _RUN.validate_python(self._tree(key)["run"])
        except (InvalidInput, ValidationError, KeyError):
            return None

    def explain(self, key: str, parts: Mapping[str, Any]) -> list[str]:
        """Return what changed between the stored task ``key`` and ``parts``, one line each.

        Raises:
            InvalidInput: if no such task is stored.
        """
        return differences(self._tree(key)["parts"], parts)

    def _path(self, key: str) -> Path:
        return self._directory / f"{key}.json"

    def _tree(self, key: str) -> dict[str, Any]:
        try:
            tree = json.loads(self._path(key).read_text(encoding="utf-8"))
        except FileNotFoundError:
            raise InvalidInput(f"no finished task {key} in {self._directory}") from None
        except ValueError as error:
            raise InvalidInput(f"{self._path(key)} is damaged: {error}; delete it") from None
        if not isinstance(tree, dict):
            raise InvalidInput(f"{self._path(key)} is no finished task; delete it")
        return tree
