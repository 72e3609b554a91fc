"""A method that computes in processes of its own is not free: their processor time and memory are its."""

import subprocess
import sys

from contact import StageLog
from contact.answer.stages import peak_memory_bytes

BUSY = "import time\nwhile time.process_time() < 0.3: pass\nx = bytearray(60_000_000)"


def test_processor_time_and_memory_of_a_child_count():
    log, before = StageLog(), peak_memory_bytes()
    with log.stage("elsewhere"):
        subprocess.run([sys.executable, "-c", BUSY], check=True)
    cost = log.cost(unknowns=1)
    assert cost.cpu_seconds >= 0.3
    assert log.records[0].cpu_seconds >= 0.3
    assert cost.peak_memory_bytes >= max(before, 60_000_000)
