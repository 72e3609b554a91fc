"""Promised times and memory on one core, in processor seconds; other work on the machine may cost them half as much."""

from __future__ import annotations

import subprocess
import sys

import pytest

from benchmarks.fem_speed import tasks

PROGRAM = """
import sys
from benchmarks.fem_speed import megabytes, seconds, tasks
print(seconds(tasks()[int(sys.argv[1])]), megabytes())
"""


@pytest.mark.slow
@pytest.mark.parametrize("number", range(4))
def test_task_is_done_in_its_time(number):
    """In a process of its own, whose memory is its own."""
    command = [sys.executable, "-c", PROGRAM, str(number)]
    answer = subprocess.run(command, capture_output=True, text=True, check=True)
    seconds, megabytes = map(float, answer.stdout.split())
    assert seconds < 1.5 * tasks()[number].allowed
    assert megabytes < 1000
