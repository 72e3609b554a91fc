"""Runs the program `ccx` on a deck in a folder of its own and reads the reactions that it prints."""

import os
import shutil
import subprocess
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from contact import NotConvergedError
from contact.records.validation import FloatArray

# CalculiX expands the section to a wedge of two degrees and prints the forces on that.
WEDGES = 180.0
# Reactions at surface and base may differ by what seven printed digits leave.
PRINTED = 2e-6


@dataclass(frozen=True, kw_only=True)
class Reactions:
    """Vertical forces on the whole layer [N], pressing positive: (unit displacement, profile), shape (2,)."""

    contact: FloatArray
    edge: FloatArray


@cache
def program() -> str:
    """Path of `ccx`, empty where it is not installed."""
    return shutil.which("ccx") or ""


@cache
def version() -> str:
    """As in: 2.20."""
    told = subprocess.run([program(), "-v"], capture_output=True, text=True, check=False).stdout
    return told.split()[-1] if told.split() else "unknown"


def reactions(text: str) -> Reactions:
    """Solve a deck.

    Raises:
        NotConvergedError: if CalculiX fails, or if the base does not carry what presses on top.
    """
    with TemporaryDirectory(prefix="calculix-") as folder:
        Path(folder, "layer.inp").write_text(text, encoding="ascii")
        threads = {"OMP_NUM_THREADS": os.environ.get("OMP_NUM_THREADS", "1")}
        done = subprocess.run(
            [program(), "-i", "layer"],
            cwd=folder,
            capture_output=True,
            text=True,
            check=False,
            env={**os.environ, **threads},
        )
        printed = Path(folder, "layer.dat")
        if done.returncode or not printed.exists():
            raise NotConvergedError(f"calculix ended with code {done.returncode}: {_error(done.stdout)}")
        return _read(printed.read_text(encoding="ascii"))


def _error(told: str) -> str:
    """The error that CalculiX names, or its last words."""
    _, found, error = told.partition("*ERROR")
    return " ".join((error if found else told[-200:]).split())[:200]


def _read(printed: str) -> Reactions:
    """Three totals in each of two steps: contact, base, edge."""
    totals = [[float(word) for word in line.split()] for line in printed.splitlines() if _is_force(line)]
    if len(totals) != 6:
        raise NotConvergedError(f"calculix printed {len(totals)} total forces where six were asked for")
    contact, base, edge = np.array(totals).reshape(2, 3, 3)[:, :, 1].T * -WEDGES
    if np.any(np.abs(contact + base) > PRINTED * np.abs(contact)):
        raise NotConvergedError(f"calculix: the contact carries {contact} N and the base {-base} N; they must be equal")
    return Reactions(contact=contact, edge=edge)


def _is_force(line: str) -> bool:
    words = line.split()
    return len(words) == 3 and all(word[-4:-2] in ("E+", "E-") for word in words)
