"""Runs an outside solver in a process of its own: inputs and arrays are passed as JSON.

Crashes, pinned versions and licences are confined to that process. It runs this interpreter, or the one that the
environment variable CONTACT_REFEREES_PYTHON names, for packages that do not fit into this environment.
"""

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from contact import Method, NotConvergedError, Scene, Supported, Unsupported, UnsupportedSceneError
from contact.records.extras import NOT_INSTALLED
from contact.records.validation import FloatArray

WORKERS = Path(__file__).with_name("workers")
INTERPRETER = "CONTACT_REFEREES_PYTHON"


def run_worker(worker: str, inputs: Mapping[str, Any]) -> dict[str, FloatArray]:
    """Return the arrays that a script of `workers` prints, by name.

    Args:
        worker: Name of the script, without the ending.
        inputs: Numbers, words and lists.

    Raises:
        NotConvergedError: If the process fails or prints no arrays, with the end of its output.
    """
    done = subprocess.run(
        [interpreter(), str(WORKERS / f"{worker}.py")],
        input=json.dumps(dict(inputs)),
        capture_output=True,
        text=True,
        check=False,
    )
    try:
        # Packages may print what they like before the answer, which is the last line.
        answer: Any = json.loads(done.stdout.splitlines()[-1]) if done.returncode == 0 else None
        return {name: np.asarray(values, dtype=np.float64) for name, values in answer.items()}
    except (AttributeError, IndexError, TypeError, ValueError):
        last = " ".join((done.stderr or done.stdout).split())[-300:]
        raise NotConvergedError(f"{worker} ended with code {done.returncode} and no answer: {last}") from None


@cache
def version(package: str) -> str:
    """The version of an installed package, empty where it is not installed."""
    script = f"import importlib.metadata as m; print(m.version({package!r}))"
    done = subprocess.run([interpreter(), "-c", script], capture_output=True, text=True, check=False)
    return done.stdout.strip() if done.returncode == 0 else ""


def lacks(package: str) -> str:
    """Reason why a package cannot be used, empty if it is installed."""
    if version(package):
        return ""
    return f"{package} {NOT_INSTALLED}: pip install 'contact-verification[referees]'"


def support(*reasons: str | Unsupported | None) -> Supported | Unsupported:
    """`Unsupported` with the first of the reasons that is not empty, or `Supported` if there is none."""
    for reason in reasons:
        if isinstance(reason, Unsupported):
            return reason
        if reason:
            return Unsupported(reason)
    return Supported()


def insist(method: Method, scene: Scene) -> None:
    """Refuse what a method does not support.

    Raises:
        UnsupportedSceneError: With the reason.
    """
    answer = method.supports(scene)
    if isinstance(answer, Unsupported):
        raise UnsupportedSceneError(answer.reason)


def interpreter() -> str:
    """The Python in which the packages of outside solvers are installed."""
    return os.environ.get(INTERPRETER) or sys.executable
