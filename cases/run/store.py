"""Finished tasks on disk, one whole file each, so that a killed run can go on where it stopped."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter, ValidationError

from cases.results.files import write_whole
from cases.results.records.scene_run import SceneRun
from cases.results.strict_json import json_text, read_json
from cases.run.keys import content_key
from contact import InvalidInput

_RUN: TypeAdapter[SceneRun] = TypeAdapter(SceneRun)
_REMEDY = "delete it; the task is then solved again"


class TaskStore:
    """The folder of finished tasks; a file appears whole or not at all."""

    def __init__(self, directory: Path) -> None:
        self._directory = directory
        directory.mkdir(parents=True, exist_ok=True)

    def put(self, key: str, parts: Mapping[str, Any], run: SceneRun) -> None:
        """Store a finished task with everything its key was made of."""
        tree = {"parts": parts, "run": _RUN.dump_python(run, mode="json")}
        write_whole(self._path(key), json_text(tree))

    def get(self, key: str) -> SceneRun | None:
        """Return the stored row of ``key``; None when there is none.

        Raises:
            InvalidInput: if its file is damaged, was changed, or holds the answer to another question.
        """
        if not self._path(key).exists():
            return None
        tree = read_json(self._path(key), remedy=_REMEDY)
        try:
            run = _RUN.validate_python(tree["run"])
            same = content_key(tree["parts"]) == run.key == key
        except (ValidationError, KeyError) as error:
            raise InvalidInput(f"{self._path(key)} is no finished task ({type(error).__name__}); {_REMEDY}") from None
        if not same:
            raise InvalidInput(f"{self._path(key)} holds the answer to another question; {_REMEDY}")
        return run

    def _path(self, key: str) -> Path:
        return self._directory / f"{key}.json"
