"""Answers and runs on disk: every digit comes back, a torn line is left out, a damaged one is refused by its place."""

import dataclasses

import pytest

from cases.answers import NAME, Table
from cases.runs import Run, read_run, write_run
from cases.verdicts import Status
from tests.cases.example_run import example


@pytest.fixture
def run() -> Run:
    return example()


def written(run, folder):
    write_run(run.judged, folder)
    (folder / NAME).write_text("".join(answer.line() for answer in run.answers))
    return folder


def test_a_run_comes_back_with_every_digit(run, tmp_path):
    back = read_run(written(run, tmp_path))
    assert back.judged == run.judged
    assert list(back.answers) == list(run.answers)
    assert len(back.judged.verdicts) > 5
    assert back.statuses == run.statuses


def test_a_number_that_is_not_finite_is_refused(run):
    answer = next(answer for answer in run.answers if answer.quantities)
    name, values = next(iter(answer.quantities.items()))
    with pytest.raises(ValueError, match="finite"):
        dataclasses.replace(values, values=(float("nan"),))
    assert name


def test_a_later_answer_takes_the_place_of_an_earlier_one(run):
    first = next(iter(run.answers))
    table = Table([first, dataclasses.replace(first, status=Status.TIMEOUT, reason="late")])
    assert len(table) == 1
    assert table.get(first.identity).status is Status.TIMEOUT
