"""Every file that the program reads again is sealed: damaged by the thousand, each is refused in one line."""

import collections

import pytest

from tests.cases.mutations import KINDS, trials


def ends(kind, seed, count):
    """How the files ended, and an example of each end but the good one."""
    done = trials(kind, seed, count)
    bad = {trial.end: trial for trial in done if trial.end != "refused"}
    return collections.Counter(trial.end for trial in done), bad


@pytest.mark.parametrize("kind", KINDS)
def test_a_hundred_and_fifty_damaged_files_of_each_kind_are_refused(kind):
    assert ends(kind, seed=7, count=150) == ({"refused": 150}, {})


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_three_thousand_damaged_files_of_each_kind_are_refused(kind):
    assert ends(kind, seed=1, count=3000) == ({"refused": 3000}, {})


@pytest.mark.parametrize("kind", KINDS)
def test_an_undamaged_file_would_be_seen(kind, monkeypatch):
    monkeypatch.setattr("tests.cases.mutations._other_than", lambda sound, damage, draw: sound)
    assert ends(kind, seed=1, count=1)[0] == {"rewritten": 1}


def test_a_reader_that_believes_its_file_would_be_seen(monkeypatch):
    monkeypatch.setattr("cases.results.sealed.digest_of", lambda text: "0")
    assert ends("results", seed=1, count=60)[0]["accepted"] > 5
