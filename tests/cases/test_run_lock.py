"""Two runs never work in one folder: the second ends at once, and a dead owner keeps nobody out."""

import os
import signal
import subprocess
import sys
import threading
from contextlib import contextmanager
from pathlib import Path

import pytest

from cases.run.executors import serial
from cases.run.lock import OWNER_NAME, locked
from cases.run.runner import RunOptions, run_cases
from cases.runs import read_run
from contact import InvalidInput
from tests.cases.fake_case import fake_case

ROOT = Path(__file__).resolve().parents[2]
HOLDER = """
import sys
from pathlib import Path
from cases.run.lock import locked
with locked(Path(sys.argv[1])):
    print("locked", flush=True)
    sys.stdin.read()
"""


@contextmanager
def other_process(folder):
    """A process that holds the lock of the folder until the context ends."""
    command = [sys.executable, "-c", HOLDER, str(folder)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=ROOT) as process:
        assert process.stdout.readline() == "locked\n"
        yield process
        process.stdin.close()


def test_a_folder_in_use_is_refused_in_one_line_that_names_the_owner(tmp_path):
    with other_process(tmp_path) as owner, pytest.raises(InvalidInput) as error, locked(tmp_path):
        pass
    assert f"(process {owner.pid} on " in str(error.value)
    assert str(error.value).isprintable()


def test_a_second_run_is_refused_before_anything_is_solved_and_the_first_loses_nothing(tmp_path):
    options = RunOptions(out=tmp_path, executor=serial)
    first = run_cases([fake_case(name="first")], options)
    events = []
    with other_process(tmp_path), pytest.raises(InvalidInput, match="another run works in"):
        run_cases([fake_case(name="second")], RunOptions(out=tmp_path, executor=serial, progress=events.append))
    assert events == []
    assert read_run(tmp_path).judged == first.judged


def test_the_lock_is_free_when_its_owner_has_ended_or_was_killed(tmp_path):
    with other_process(tmp_path):
        pass
    with locked(tmp_path):
        pass
    with other_process(tmp_path) as owner:
        os.kill(owner.pid, signal.SIGKILL)
        owner.wait()
        assert str(owner.pid) in (tmp_path / OWNER_NAME).read_text(encoding="utf-8")
        with locked(tmp_path):
            assert str(os.getpid()) in (tmp_path / OWNER_NAME).read_text(encoding="utf-8")


def test_parts_of_one_command_lock_again_and_another_thread_does_not(tmp_path):
    refused = []

    def elsewhere():
        try:
            with locked(tmp_path):
                pass
        except InvalidInput as error:
            refused.append(str(error))

    with locked(tmp_path), locked(tmp_path / "." / "x" / ".."):
        thread = threading.Thread(target=elsewhere)
        thread.start()
        thread.join()
    assert len(refused) == 1
    elsewhere()
    assert len(refused) == 1
