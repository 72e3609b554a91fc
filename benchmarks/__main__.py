"""All that users wait for against a revision, then our methods against the installed peers; losing rows come first.

    python -m benchmarks REVISION [--rounds 7]

Two tables: `benchmarks.waiting`, and `benchmarks.side_by_side`, error against seconds of at least four settings each.
Peers are found as by the suite `referees`; absent ones are left out.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path

from cases.run.timing import SAMPLES

ROOT = Path(__file__).resolve().parent.parent


def _told(module: str, *arguments: str) -> str:
    command = [sys.executable, "-m", f"benchmarks.{module}", *arguments]
    return subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True).stdout


def main() -> None:
    """Print both tables."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks")
    parser.add_argument("revision", help="what to compare with, anything git understands")
    parser.add_argument("--rounds", type=int, default=SAMPLES, help=f"how often each is timed, at least {SAMPLES}")
    given = parser.parse_args()
    rounds = ("--rounds", str(given.rounds))
    sys.stdout.write(f"{_told('waiting', given.revision, *rounds)}\n")
    sys.stdout.write(f"{_told('side_by_side', *rounds)}\n")


if __name__ == "__main__":
    main()
