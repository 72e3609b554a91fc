"""The benchmark of a cluster runs, kills a worker and loses no scene; its estimate follows from what was measured."""

import pytest

from benchmarks import cluster


def test_the_estimate_is_the_formula():
    text = "".join(cluster.estimate(cluster.Seconds(scheduler=0.002, program=0.001, workers=0.01)))
    assert "max(0.19, 4.00) s for 95 %" in text


@pytest.mark.slow
@pytest.mark.filterwarnings("default")  # the cluster library warns about itself when a worker dies
def test_a_small_campaign_on_a_cluster(capsys):
    pytest.importorskip("distributed", reason="the optional extra 'cluster' is not installed")
    cluster.main(300)
    printed = capsys.readouterr().out
    assert "300 scenes on 2 workers" in printed
    assert "within: 300, refused: 0, beyond: 0, crashed: 0" in printed
    (known,) = (line for line in printed.splitlines() if "tasks known" in line)
    assert int(known.rpartition(" ")[2]) <= 6
