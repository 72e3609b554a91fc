"""Where a baseline would be written: commit, uncommitted changes, continuous integration."""

import os
import subprocess
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from cases.run import stamp
from contact import InvalidInput

# The folder that holds every package.
SOURCE = Path(__file__).resolve().parents[2]


@dataclass(frozen=True, kw_only=True)
class WriteConditions:
    """Conditions under which a baseline may be written.

    Attributes:
        revision: commit of the source; "unknown" outside a repository.
        changed: files that differ from it, baselines apart: those are what is being written.
        in_ci: whether a continuous integration job asks.
    """

    revision: str
    changed: tuple[str, ...]
    in_ci: bool


def write_conditions(repository: Path, baselines: Path, environment: Mapping[str, str] = os.environ) -> WriteConditions:
    """Return the conditions of this process and the source in ``repository``."""
    return WriteConditions(
        revision=stamp.revision(repository),
        changed=_changed_files(repository, baselines),
        in_ci=environment.get("CI", "").lower() not in ("", "0", "false"),
    )


def _changed_files(repository: Path, baselines: Path) -> tuple[str, ...]:
    """Changed tracked files, and untracked files that are not ignored."""
    outside = f":(exclude){baselines.resolve()}" if baselines.resolve().is_relative_to(repository.resolve()) else "."
    listed = git(repository, "status", "--porcelain", "--", ".", outside)
    return tuple(line[3:] for line in listed.splitlines())


def git(repository: Path, *arguments: str) -> str:
    """Return what git prints.

    Raises:
        InvalidInput: with git's own words if it refuses.
    """
    command = ["git", "-C", str(repository), *arguments]
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout
    except FileNotFoundError:
        raise InvalidInput("git is not installed; a baseline belongs to a commit") from None
    except subprocess.CalledProcessError as error:
        raise InvalidInput(f"git {arguments[0]}: {error.stderr.strip()}") from None
