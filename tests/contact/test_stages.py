"""The stage log counts calls, gives nested time to the nested stage, and adds up to the whole."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

import pytest

from contact import StageLog
from contact.answer.stages import peak_memory_bytes


def test_nested_stages_are_timed_apart():
    log = StageLog()
    with log.stage("outer"):
        time.sleep(0.002)
        with log.stage("inner"):
            time.sleep(0.2)
            log.hold(100, 20)
        with log.stage("inner"):
            pass
    outer, inner = log.records
    assert (outer.name, outer.calls, inner.name, inner.calls) == ("outer", 1, "inner", 2)
    assert inner.bytes == 120
    assert inner.wall_seconds >= 0.2
    assert outer.wall_seconds < inner.wall_seconds
    assert outer.wall_seconds + inner.wall_seconds <= log.cost(unknowns=1).wall_seconds


def test_a_stage_that_raises_is_closed():
    log = StageLog()
    with pytest.raises(ZeroDivisionError), log.stage("a"):
        raise ZeroDivisionError
    with log.stage("b"):
        pass
    assert [record.name for record in log.records] == ["a", "b"]


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="elsewhere the system tells no program's own peak")
def test_peak_memory_is_not_that_of_the_program_that_started_this_one():
    child = "from contact.answer.stages import peak_memory_bytes; print(peak_memory_bytes())"
    parent = (
        "import subprocess, sys; ballast = bytearray(600_000_000)\n"
        f"print(subprocess.run([sys.executable, '-c', {child!r}], capture_output=True, text=True).stdout)"
    )
    done = subprocess.run([sys.executable, "-c", parent], capture_output=True, text=True, check=True)
    assert int(done.stdout) < 500_000_000


BUSY = "import time\nwhile time.process_time() < 0.3: pass\nx = bytearray(60_000_000)"


def test_processor_time_and_memory_of_a_child_count():
    """A method that computes in processes of its own is not free."""
    log, before = StageLog(), peak_memory_bytes()
    with log.stage("elsewhere"):
        subprocess.run([sys.executable, "-c", BUSY], check=True)
    cost = log.cost(unknowns=1)
    assert cost.cpu_seconds >= 0.3
    assert log.records[0].cpu_seconds >= 0.3
    assert cost.peak_memory_bytes >= max(before, 60_000_000)
