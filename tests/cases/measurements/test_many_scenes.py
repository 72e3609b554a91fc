"""Campaigns of any size: summed up in blocks as they would be scene by scene, kept, and gone on with."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import pytest

from cases.measurements import measurement
from cases.measurements.campaigns.campaign import campaign
from cases.measurements.kept_scenes import NAME, KeptScenes
from cases.measurements.many_scenes import ManyScenes, campaign_of
from cases.measurements.measurement import Measurement
from cases.measurements.tally import Tally
from cases.results.status import Status
from cases.run.executors import ClusterLost, serial
from cases.run.many.blocks import Cutter
from contact import InvalidInput
from mdr import Mdr
from tests.cases.in_flight import recording

COUNT = 60


def rows_of(number):
    """A scene of some kind: answers, refusals, crashes, wrong numbers."""
    of = partial(Measurement, method="made up", scene=f"{number}", seed=3, counters={"steps": number})
    if number % 7 == 1:
        return [of(status=Status.INVALID, reason=f"a/h = {number} is too large")]
    if number % 31 == 2:
        return [of(status=Status.FAIL, reason="ValueError: planted")]
    row = of(quantity="force", error=1e-9 * number, stated=3e-8, reference="somebody", sharpness=1.0 + number)
    return [of(), row]


def made_up(method, *, seed, count, numbers: Sequence[int]):
    return [row for number in numbers for row in rows_of(number)]


def scenes(count=COUNT, campaign=made_up):
    return ManyScenes(campaign=campaign, family="made up", method=Mdr(), seed=3, count=count)


def carried_out(of, factory=serial, kept=None):
    tally = Tally()
    for found in of.tallies(of.in_blocks(factory, 3), kept):
        tally.join(found)
    return tally


@pytest.fixture
def _short_blocks(monkeypatch):
    monkeypatch.setattr(Cutter, "_next_size", lambda self: 7)


@pytest.mark.usefixtures("_short_blocks")
def test_blocks_come_to_what_all_rows_together_come_to():
    rows = [row for number in range(COUNT) for row in rows_of(number)]
    made = []
    for factory in (serial, recording(made)):
        tally = carried_out(scenes(), factory)
        assert tally.ends == {end: n for end, n in measurement.ends(rows).items() if n}
        assert tally.refusals == measurement.refusals(rows)
        assert sorted(tally.defects) == sorted(measurement.defects(rows))
        force = measurement.by_quantity(rows)["force"]
        (line,) = (line for line in tally.report() if line.startswith("force"))
        share, sharp = measurement.covered(force), measurement.median(measurement.sharpness(force))
        assert line.startswith(f"force: {100 * share:.2f} % of {len(force)} covered")
        assert line.endswith(f"stated over true error {sharp:.3g} in the median")
    assert made[0].submitted == 9


def test_a_scene_is_the_same_alone_and_among_others():
    """Seen to fail to end: each block drew all scenes up to its own."""
    together = campaign(Mdr(), seed=11, count=4, ratio=(0.1, 1.0), other_units=False)
    alone = campaign(Mdr(), seed=11, count=10**9, ratio=(0.1, 1.0), other_units=False, numbers=[3])
    last = [row for row in together if row.scene == "3"]
    assert [(row.quantity, row.error, row.stated) for row in alone] == [(r.quantity, r.error, r.stated) for r in last]


# -- scenes that are kept ----------------------------------------------------------------------------------------------


def kept_in(folder, of=None, *, resume=False):
    return KeptScenes(folder, (of or scenes()).key, resume=resume)


def test_kept_rows_are_the_rows(tmp_path):
    carried_out(scenes(), kept=kept_in(tmp_path))
    assert dict(kept_in(tmp_path, resume=True).read()) == {number: rows_of(number) for number in range(COUNT)}


class Stops:
    """A campaign whose cluster is lost at a scene."""

    def __init__(self, at):
        self.at, self.solved = at, []

    def __call__(self, method, *, seed, count, numbers):
        if self.at in numbers:
            raise ClusterLost("the Dask scheduler at tcp://nowhere does not answer any more")
        self.solved += numbers
        return made_up(method, seed=seed, count=count, numbers=numbers)


@pytest.mark.usefixtures("_short_blocks")
def test_a_campaign_that_was_stopped_goes_on_and_solves_only_what_is_missing(tmp_path):
    first, second = Stops(at=40), Stops(at=None)
    with pytest.raises(ClusterLost):
        carried_out(scenes(campaign=first), kept=kept_in(tmp_path))
    kept = kept_in(tmp_path, resume=True)
    saved = {number for number, _ in kept.read()}
    assert saved == set(range(35))
    tally = carried_out(scenes(campaign=second), kept=kept)
    assert sorted(second.solved) == sorted(set(range(COUNT)) - saved)
    assert (tally.ends, sorted(tally.defects)) == (carried_out(scenes()).ends, sorted(carried_out(scenes()).defects))


def test_the_line_that_was_being_written_is_solved_again(tmp_path):
    carried_out(scenes(), kept=kept_in(tmp_path))
    text = (tmp_path / NAME).read_bytes()
    (tmp_path / NAME).write_bytes(text[:-10])
    assert len(dict(kept_in(tmp_path, resume=True).read())) == COUNT - 1
    carried_out(scenes(), kept=kept_in(tmp_path, resume=True))
    assert (tmp_path / NAME).read_bytes() == text


def test_scenes_of_another_campaign_are_refused(tmp_path):
    kept_in(tmp_path)
    other = ManyScenes(campaign=made_up, family="made up", method=Mdr(accuracy=1e-6), seed=3, count=COUNT)
    with pytest.raises(InvalidInput, match="another campaign or other code; leave out --resume"):
        kept_in(tmp_path, other, resume=True)
    assert not list(kept_in(tmp_path, other).read())


def test_more_scenes_of_the_same_campaign_go_on(tmp_path):
    carried_out(scenes(20), kept=kept_in(tmp_path, scenes(20)))
    more = Stops(at=None)
    assert carried_out(scenes(30, more), kept=kept_in(tmp_path, scenes(30), resume=True)).scenes == 30
    assert sorted(more.solved) == list(range(20, 30))


@pytest.mark.parametrize("line", ["nonsense", "[1]", '[1, {"colour": 3}, []]', '["x", {}, []]'])
def test_a_damaged_line_is_one_clear_error(tmp_path, line):
    kept = kept_in(tmp_path)
    kept.add(f"{line}\n")
    with pytest.raises(InvalidInput, match=r"line 2, holds no scene .*; delete that line"):
        list(kept.read())


def test_every_family_can_be_drawn_in_blocks():
    for family in ("elastic", "pressure", "displacement", "impact"):
        assert callable(campaign_of(family))
    with pytest.raises(InvalidInput, match="must be one of elastic"):
        campaign_of("plastic")
