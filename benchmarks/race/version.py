"""A version of the source at work: a stopwatch process that imports from a given folder."""

import base64
import json
import os
import pickle
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, Self

from cases.declare.case import Case, CaseScene
from cases.declare.methods import MethodUse, location
from contact import InvalidInput, scene_to_mapping

_STOPWATCH = Path(__file__).with_name("stopwatch.py")
_ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")


class CannotSolve(InvalidInput):
    """A version has no answer to a subject, such as a revision from before a method or setting."""


@dataclass(frozen=True, kw_only=True)
class Subject:
    """What is timed: one method on one scene; ``order`` is the same as a word that every version understands."""

    case: str
    scene: str
    method: str
    order: str

    @property
    def label(self) -> str:
        """Case, scene and method in words."""
        return f"{self.case} / {self.scene} / {self.method}"


def subject(case: Case, scene: CaseScene, use: MethodUse) -> Subject:
    """Return what is timed when the method ``use`` solves ``scene``."""
    content = scene_to_mapping(scene.scene), *location(use.method or use.label), dict(use.settings)
    order = base64.b64encode(pickle.dumps(content)).decode()
    return Subject(case=case.name, scene=scene.name, method=use.label, order=order)


class Version:
    """The source below ``folder``, ready to be timed; use it in a ``with`` statement.

    Raises:
        InvalidInput: if the folder holds no source of this project.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder.resolve()
        self._process = subprocess.Popen(
            [sys.executable, "-P", str(_STOPWATCH)],  # -P: the folder of the stopwatch is no place to import from
            cwd=self._folder,
            env={**os.environ, **_ONE_THREAD, "PYTHONPATH": str(self._folder)},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        source = Path(self._reply()["source"])
        if not source.is_relative_to(self._folder):
            self._stop()
            raise InvalidInput(f"{folder} would be timed with the source in {source}; it has no package `contact`")

    def seconds(self, what: Subject, solves: int) -> float:
        """Return the CPU seconds of one solve, mean of ``solves``, after a warm-up at the first call.

        Raises:
            CannotSolve: if this version cannot solve that.
        """
        questions = _opened(self._process.stdin)
        questions.write(f"{what.order} {solves}\n")
        questions.flush()
        reply = self._reply()
        if "error" in reply:
            raise CannotSolve(f"{what.label} cannot be timed in {self._folder}: {reply['error']}")
        return float(reply["seconds"])

    def __enter__(self) -> Self:
        """Return this version."""
        return self

    def __exit__(self, *_: object) -> None:
        """End its process."""
        self._stop()

    def _reply(self) -> Mapping[str, Any]:
        line = _opened(self._process.stdout).readline()
        if not line:
            self._stop()
            raise InvalidInput(f"the process that times {self._folder} ended with code {self._process.returncode}")
        reply: Mapping[str, Any] = json.loads(line)
        return reply

    def _stop(self) -> None:
        """Close its input, which ends it; what it is in the middle of is not waited for."""
        if self._process.returncode is not None:
            return
        try:
            self._process.communicate(timeout=1)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.communicate()


def _opened(pipe: IO[str] | None) -> IO[str]:
    if pipe is None:
        # This never happens: the process was opened with pipes.
        raise InvalidInput("a stopwatch process without pipes")
    return pipe
