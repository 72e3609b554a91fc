"""Many calls through one executor: few are under way at a time, and a process that dies costs its own block only."""

import os
from collections import Counter
from functools import partial
from itertools import chain

import pytest

from cases.run.executors import ahead, closing, process_pool
from cases.run.many import blocks as many_blocks
from cases.run.many.blocks import Cutter, InBlocks, usual_seconds
from cases.run.many.window import Window
from cases.run.runner import RunOptions, run_cases
from tests.cases.fake_case import fake_case
from tests.cases.in_flight import Fragile, InFlight, recording

JOBS = 3


def in_blocks_of(size, monkeypatch):
    """Whatever a number costs, a block holds so many."""
    monkeypatch.setattr(Cutter, "_next_size", lambda self: size)


def test_a_window_stays_small_however_many_calls_there_are():
    """Seen to fail with a window that hands over all it is given."""
    with closing(InFlight(JOBS)) as executor:
        window = Window(partial(executor.submit, abs), partial(ahead, executor, JOBS))
        found = dict(window.results(-n for n in range(2000)))
        assert found == {-n: n for n in range(2000)}
        assert (executor.largest, executor.submitted) == (2 * JOBS, 2000)


def test_a_window_takes_arguments_only_when_there_is_room():
    taken = []
    with closing(InFlight(1)) as executor:
        window = Window(partial(executor.submit, abs), lambda: 2)
        results = window.results(taken.append(n) or n for n in range(1000))
        next(results)
        assert len(taken) == 2


def test_a_window_follows_a_cluster_that_grows():
    room = iter([1, 1, 1, 8, 8, 8])
    with closing(InFlight(1)) as executor:
        window = Window(partial(executor.submit, abs), lambda: next(room, 8))
        assert len(list(window.results(range(40)))) == 40
        assert executor.largest == 8


def test_a_campaign_has_few_blocks_under_way(monkeypatch):
    in_blocks_of(4, monkeypatch)
    made = []
    found = list(InBlocks(list, recording(made), JOBS, None).results(range(400)))
    assert sorted(chain(*found)) == list(range(400))
    assert made[0].largest <= 2 * JOBS
    assert made[0].submitted == 100


def test_a_run_has_few_tasks_under_way(tmp_path):
    made = []
    run_cases([fake_case()], RunOptions(out=tmp_path, executor=recording(made), jobs=1, timing=False))
    assert made[0].largest <= 2 < made[0].submitted


# -- blocks ----------------------------------------------------------------------------------------------------------


def sizes(cutter, cost):
    """Sizes of all blocks where a number costs so many seconds."""
    found = []
    for block in cutter:
        found.append(len(block))
        cutter.learn(len(block), cost * len(block))
    return found


def test_blocks_follow_the_cost_of_a_number():
    cost, places = 0.01, 4
    found = sizes(Cutter(range(20_000), lambda: places), cost)
    usual = round(usual_seconds(places) / cost)
    assert sum(found) == 20_000
    assert found[0] == 1
    assert max(found) == usual
    assert Counter(found)[usual] > 0.8 * len(found)
    # Towards the end they get shorter, but never so short that handing over costs much.
    assert found == [*sorted(found[:10]), *sorted(found[10:], reverse=True)]
    assert min(found[10:-1]) >= usual // 8


def test_more_places_have_longer_blocks():
    """One scheduler serves all of them: what it has to do in a second must not grow with the places."""
    found = sizes(Cutter(range(10**8), lambda: 1000), 0.01)
    assert max(found) == round(usual_seconds(1000) / 0.01)
    assert usual_seconds(1000) == pytest.approx(10 * usual_seconds(10), rel=1e-12, abs=0.0)


def test_a_number_that_cost_nothing_makes_no_huge_block():
    cutter = Cutter(range(10**6), lambda: 2)
    blocks = iter(cutter)
    next(blocks)
    cutter.learn(1, 1e-9)
    assert len(next(blocks)) <= many_blocks.GROWTH


@pytest.mark.parametrize("pool", [True, False], ids=["all calls are lost", "one call is lost"])
def test_what_dies_is_found_and_costs_nothing_else(monkeypatch, pool):
    in_blocks_of(30, monkeypatch)
    deadly, solved = {5, 63, 64}, Counter()

    def work(block):
        solved.update(block)
        return [(number, "solved") for number in block]

    in_blocks = InBlocks(work, lambda jobs: Fragile(deadly, pool=pool), 2, lambda number, words: [(number, words)])
    found = dict(chain(*in_blocks.results(range(120))))
    assert {number for number, words in found.items() if words != "solved"} == deadly
    assert sorted(found) == list(range(120))
    assert set(solved.values()) == {1}


def dies_of_seven(block):
    """Ends its process at 7."""
    if 7 in block:
        os._exit(1)
    return list(block)


@pytest.mark.slow
def test_a_real_process_that_dies():
    in_blocks = InBlocks(dies_of_seven, process_pool, 2, lambda number, words: [-number])
    assert sorted(chain(*in_blocks.results(range(12)))) == [-7, *range(7), *range(8, 12)]
