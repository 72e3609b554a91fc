"""The same run on a real Dask scheduler with two workers over TCP, one of which is killed on the way."""

import json
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import pytest

from cases.run import runner
from cases.run.executors import by_name, serial
from cases.run.runner import RunOptions, run_cases
from cases.runs import read_run
from cases.verdicts import Status
from contact import InvalidInput
from reports import command_line
from tests.cases.fake_case import SLOW, fake_case, spoiled
from tests.cases.test_runner import numbers

distributed = pytest.importorskip("distributed", reason="the optional extra 'cluster' is not installed")

pytestmark = [
    pytest.mark.slow,
    pytest.mark.filterwarnings("default"),  # the cluster library warns about itself when a worker dies
]


@pytest.fixture
def cluster():
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, protocol="tcp://", dashboard_address=None
    ) as running:
        yield running


def test_a_killed_worker_loses_nothing(cluster, tmp_path):
    victims = [worker.process.pid for worker in cluster.workers.values()][:1]

    def kill_one(event):
        if event.kind == "finished" and event.done >= 3 and victims:
            os.kill(victims.pop(), signal.SIGKILL)

    options = RunOptions(out=tmp_path / "cluster", executor=by_name(cluster.scheduler_address), progress=kill_one)
    result = run_cases([fake_case()], options)
    alone = run_cases([fake_case()], RunOptions(out=tmp_path / "alone", executor=serial))
    assert not victims
    assert result.judged.complete
    assert numbers(result) == numbers(alone)


def test_a_task_beyond_its_time_is_a_timeout_and_its_worker_goes_on(cluster, tmp_path):
    slow = spoiled(SLOW, plant="compute")
    options = RunOptions(out=tmp_path, executor=by_name(cluster.scheduler_address), time_limit=0.3)
    result = run_cases([fake_case(slow=slow, ladder={"cell": 0.1})], options)
    assert {row.status for row in result.answers if not row.variant and row.method == "slow"} == {Status.TIMEOUT}
    assert {row.status for row in result.answers if not row.variant and row.method == "fast"} == {Status.PASS}


ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def scheduler(tmp_path):
    """The address of a scheduler in a process of its own with one worker, and that process."""
    file = tmp_path / "scheduler.json"
    begin = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0"]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": ROOT}
    with subprocess.Popen([*begin, "--no-dashboard", "--scheduler-file", str(file)], **quiet) as process:
        while not file.exists():
            time.sleep(0.1)
        address = json.loads(file.read_text(encoding="utf-8"))["address"]
        options = ["--nthreads", "1", "--no-nanny", "--no-dashboard"]
        with subprocess.Popen(
            [sys.executable, "-m", "distributed.cli.dask_worker", address, *options], **quiet
        ) as worker:
            yield address, process
            worker.kill()
            process.kill()


def killing(process, after):
    """Kills a process when some tasks are finished, and keeps the events."""

    def listen(event):
        listen.events.append(event)
        if event.kind == "finished" and event.done == after:
            process.kill()

    listen.events = []
    return listen


def test_a_killed_scheduler_is_one_line_and_a_run_that_can_go_on(scheduler, tmp_path):
    address, process = scheduler
    listen = killing(process, after=3)
    options = RunOptions(out=tmp_path / "out", executor=by_name(address), progress=listen)
    stopped = run_cases([fake_case()], options)
    assert not stopped.judged.complete
    assert read_run(tmp_path / "out").judged == stopped.judged
    (line,) = (event.reason for event in listen.events if event.kind == "stopped")
    assert (
        line
        == f"the Dask scheduler at {address} does not answer any more; finished solutions are kept, go on with --resume"
    )
    again = []
    whole = run_cases([fake_case()], replace(options, executor=serial, resume=True, progress=again.append))
    assert whole.judged.complete
    assert [event.kind for event in again].count("reused") >= 3
    alone = run_cases([fake_case()], RunOptions(out=tmp_path / "alone", executor=serial))
    assert numbers(whole) == numbers(alone)


def test_the_command_ends_as_interrupted_without_a_traceback(scheduler, tmp_path, monkeypatch, capfd):
    address, process = scheduler
    case = fake_case()
    monkeypatch.setattr("reports.commands.runs.load_cases", lambda: {case.name: case})
    finish = runner._Run.finish

    def finish_and_kill(*arguments, **more):
        finish(*arguments, **more)
        process.kill()

    monkeypatch.setattr(runner._Run, "finish", finish_and_kill)
    assert command_line.run(["run", "--executor", address, "--out", str(tmp_path / "out")]) == 2
    printed = "".join(capfd.readouterr())
    assert "Traceback" not in printed
    assert " ".join(printed.split()).count("does not answer any more; finished solutions are kept") == 1


def test_no_scheduler_at_an_address_is_one_line(tmp_path, monkeypatch):
    monkeypatch.setattr("cases.run.executors.PATIENCE", 0.5)
    with pytest.raises(InvalidInput, match=r"no Dask scheduler answers at tcp://127\.0\.0\.1:9") as error:
        run_cases([fake_case()], RunOptions(out=tmp_path, executor=by_name("tcp://127.0.0.1:9")))
    assert str(error.value).isprintable()
