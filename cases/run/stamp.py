"""Where and with what a run was made."""

import os
import platform
import subprocess
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

# This package ships no types.
from threadpoolctl import threadpool_info  # type: ignore[import-untyped]

from cases.runs import Stamp
from contact import InvalidInput

_PACKAGES = ("numpy", "scipy", "scikit-fem", "gmsh", "pyfftw", "h5py", "pydantic", "contact-verification")
# The folder that holds every package.
SOURCE = Path(__file__).resolve().parents[2]


def stamp(started: datetime, wall_seconds: float) -> Stamp:
    """Return the stamp of a run that began at ``started`` (UTC) and took ``wall_seconds``."""
    return Stamp(
        started=started.astimezone(UTC).strftime("%Y-%m-%dT%H:%M:%SZ"),
        wall_seconds=wall_seconds,
        revision=revision(),
        dirty=is_dirty(),
        python=platform.python_version(),
        platform=f"{platform.system()} {platform.machine()}",
        processor=_processor(),
        cores=len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1,
        threads={_library(info): int(info["num_threads"]) for info in threadpool_info()},
        versions={name: number for name in _PACKAGES if (number := _version(name))},
    )


def repository() -> Path:
    """Return the repository that tracks this package; where it is installed, that of the working directory."""
    tracked = _git(SOURCE, "ls-files", "cases/run/stamp.py")
    directory = SOURCE if tracked else Path.cwd()
    return Path(_git(directory, "rev-parse", "--show-toplevel") or directory)


def revision(directory: Path | None = None) -> str:
    """Return the commit checked out in ``directory`` (or `repository`), "unknown" outside a repository."""
    return _git(directory or repository(), "rev-parse", "HEAD") or "unknown"


def is_dirty() -> bool:
    """Whether tracked files of `repository` differ from the commit."""
    return bool(_git(repository(), "status", "--porcelain", "--untracked-files=no"))


def git(directory: Path, *arguments: str) -> str:
    """Return the output of a git command.

    Raises:
        InvalidInput: If git fails, with its message.
    """
    command = ["git", "-C", str(directory), *arguments]
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True, timeout=20).stdout
    except FileNotFoundError:
        raise InvalidInput("git is not installed; a baseline belongs to a commit") from None
    except subprocess.TimeoutExpired:
        raise InvalidInput(f"git {arguments[0]}: no answer within 20 s") from None
    except subprocess.CalledProcessError as error:
        raise InvalidInput(f"git {arguments[0]}: {error.stderr.strip()}") from None


def _git(directory: Path, *arguments: str) -> str:
    """Output of a git command, empty if it fails."""
    try:
        return git(directory, *arguments).strip()
    except InvalidInput:
        return ""


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return ""


def _processor() -> str:
    """Model name of the processor."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or "unknown"
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or "unknown"


def _library(info: dict[str, object]) -> str:
    parts = [info.get("internal_api"), info.get("version"), info.get("architecture")]
    return " ".join(str(part) for part in parts if part)
