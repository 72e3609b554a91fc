"""Answers and runs on disk: every digit comes back, a torn line is left out, a damaged one is refused by its place."""

import dataclasses

import pytest

from cases.answers import NAME, Table, read_answers
from cases.runs import RUN, Run, read_run, write_run
from cases.verdicts import Status
from contact import InvalidInput
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


def test_a_torn_last_line_is_left_out(run, tmp_path):
    path = written(run, tmp_path) / NAME
    path.write_bytes(path.read_bytes()[:-20])
    assert len(list(read_answers(path))) == len(run.answers) - 1


@pytest.mark.parametrize("damage", ["{}", "nonsense", '{"case": 3}'])
def test_a_damaged_line_is_refused_by_its_place(run, tmp_path, damage):
    path = written(run, tmp_path) / NAME
    path.write_text(damage + "\n" + path.read_text())
    with pytest.raises(InvalidInput, match="line 1: "):
        list(read_answers(path))


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


def test_a_damaged_run_is_refused_with_its_place_and_remedy(run, tmp_path):
    path = written(run, tmp_path) / RUN
    path.write_text(path.read_text().replace('"PASS"', '"SURE"', 1))
    with pytest.raises(InvalidInput, match=r"run.json: .*SURE.*run the cases again"):
        read_run(tmp_path)


def test_a_folder_without_a_run_is_refused(tmp_path):
    with pytest.raises(InvalidInput, match=r"no run.json in .*; give the directory of a finished run"):
        read_run(tmp_path)
