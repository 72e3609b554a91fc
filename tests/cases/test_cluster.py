"""The same run on a real Dask scheduler with two workers over TCP, one of which is killed on the way."""

import os
import signal

import pytest

from cases.results.status import Status
from cases.run.executors import by_name, serial
from cases.run.runner import RunOptions, run_cases
from tests.cases.fake_case import SLOW, fake_case, spoiled
from tests.cases.test_runner import strip_times

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
    assert result.complete
    assert strip_times(alone, result).cases == alone.cases


def test_a_task_beyond_its_time_is_a_timeout_and_its_worker_goes_on(cluster, tmp_path):
    slow = spoiled(SLOW, plant="compute")
    options = RunOptions(out=tmp_path, executor=by_name(cluster.scheduler_address), time_limit=0.3)
    result = run_cases([fake_case(slow=slow, ladder={"cell": 0.1})], options)
    assert {row.status for row in result.cases[0].runs if row.method == "slow"} == {Status.TIMEOUT}
    assert {row.status for row in result.cases[0].runs if row.method == "fast"} == {Status.PASS}


def test_both_workers_take_part(cluster, tmp_path):
    run_cases([fake_case()], RunOptions(out=tmp_path, executor=by_name(cluster.scheduler_address), jobs=2))
    client = distributed.Client(cluster)
    try:
        assert len(client.scheduler_info()["workers"]) == 2
    finally:
        client.close()
