"""Hostile input by the hundred: a named refusal or something valid, never a crash, never other numbers."""

from __future__ import annotations

import collections
import resource
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from tests.cases import hostile
from tests.cases.hostile import KINDS, hostile_trial, hostile_trials

ROOT = Path(__file__).resolve().parents[4]
DEFECTS = ("altered", "crashed")


def defects(trials):
    return [trial for trial in trials if trial.end in DEFECTS]


@pytest.mark.parametrize("kind", KINDS)
def test_damaged_input_is_refused_by_name(kind):
    trials = [hostile_trial(kind, 1, number) for number in range(60)]
    assert defects(trials) == []
    assert collections.Counter(t.end for t in trials)["refused"] > 10


@pytest.mark.slow
def test_two_thousand_hostile_inputs_within_bounded_memory_and_time():
    code = (
        "from tests.cases.hostile import hostile_trials\n"
        "print([t for t in hostile_trials(7, 2000) if t.end in ('altered', 'crashed')])"
    )
    start = time.monotonic()
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
        timeout=120,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30)),
    )
    assert done.stdout.strip() == "[]"
    assert time.monotonic() - start < 120


def test_the_writer_of_damaged_scenes_prints_whatever_it_is_given():
    """An integer that Python refuses to print, inside a list of sets, once counted as a crash of the reader."""
    assert hostile_trial("toml", 777, 521).end == "refused"


def test_a_trial_can_be_repeated():
    first, second = hostile_trials(3, 10), hostile_trials(3, 10)
    assert [(t.kind, t.number, t.end) for t in first] == [(t.kind, t.number, t.end) for t in second]


def test_a_crash_is_seen(monkeypatch):
    def crash(mapping):
        raise ZeroDivisionError("planted")

    monkeypatch.setattr(hostile, "scene_from_mapping", crash)
    trial = hostile_trial("mapping", 1, 0)
    assert (trial.end, trial.message) == ("crashed", "ZeroDivisionError: planted")


def test_a_warning_is_a_crash(monkeypatch):
    monkeypatch.setattr(hostile, "scene_from_mapping", lambda mapping: np.log(np.zeros(1)))
    assert hostile_trial("mapping", 1, 0).end == "crashed"


def test_altered_numbers_are_seen(monkeypatch):
    monkeypatch.setattr(hostile, "damaged_bytes", lambda draw, content: content)
    assert hostile_trial("hdf5", 1, 0).end == "accepted"
    read = hostile.read_tree
    others = iter(({}, {"method": "other"}))
    monkeypatch.setattr(hostile, "read_tree", lambda file: read(file) | next(others))
    assert hostile_trial("hdf5", 1, 0).end == "altered"


def test_a_message_too_long_for_a_person_is_a_defect(monkeypatch):
    def refuse(mapping):
        raise hostile.InvalidInput("x" * 3000)

    monkeypatch.setattr(hostile, "scene_from_mapping", refuse)
    assert hostile_trial("mapping", 1, 0).message == "message of 3000 characters"
