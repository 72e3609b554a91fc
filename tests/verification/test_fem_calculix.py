"""Side by side with an independent finite element program."""

from __future__ import annotations

import shutil
import subprocess
import sys

import pytest

PROGRAM = """
from benchmarks.calculix_flat_punch import compare
for run in compare(1e-5):
    print(run.error, run.seconds, run.megabytes)
"""


@pytest.mark.slow
@pytest.mark.skipif(
    shutil.which("ccx") is None, reason="the program ccx is not installed (Debian package calculix-ccx)"
)
def test_flat_punch_to_1e_5_is_five_times_faster_than_calculix():
    """In a process of its own, whose memory is its own."""
    done = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, check=True)
    theirs, ours = ([float(word) for word in line.split()] for line in done.stdout.splitlines())
    assert max(theirs[0], ours[0]) < 1e-5
    assert ours[1] < theirs[1] / 5
    assert ours[2] < 500
