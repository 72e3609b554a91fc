"""The history of accepted numbers as a chart of the report, and what long studies say while they run."""

import datetime
import time

import pytest

from cases.results.records.run import Acceptance
from reports.charts.history import accepted_steps, figures
from reports.commands.studies import PARTIAL, _counted
from reports.figures.figure import write_figure
from reports.pages.report import tolerance_history
from tests.cases.example_run import accepted_numbers


def entry(revision, method, old, new):
    return Acceptance(
        date=str(datetime.date(2026, 11, 20)),
        case="cone",
        method=method,
        quantity="force",
        old=old,
        new=new,
        old_tolerance=1e-12,
        new_tolerance=1e-12,
        reason="finer",
        revision=revision * 8,
    )


HISTORY = (
    entry("a", "mdr", None, None),
    entry("b", "mdr", 2.0, 2.2),
    entry("b", "mdr", 1.0, 1.3),
    entry("b", "fem", 1.0, 1.0),
    entry("c", "fem", -4.0, -5.0),
)


def test_each_accepted_run_that_changed_numbers_is_a_step():
    steps = accepted_steps(HISTORY)
    assert [(step.run, step.method, len(step.changes)) for step in steps] == [(0, "mdr", 2), (1, "fem", 1)]
    assert steps[0].changes == pytest.approx((0.1, 0.3), rel=1e-12, abs=0.0)
    assert steps[1].changes == pytest.approx((0.25,), rel=1e-12, abs=0.0)


def test_the_chart_is_drawn_with_its_data_and_left_out_where_nothing_changed(tmp_path):
    (figure,) = figures(HISTORY)
    assert "MDR" in write_figure(figure, tmp_path)
    assert (tmp_path / "accepted-runs.csv").read_text().splitlines()[1].startswith("2026-11-20,bbbbbbb,mdr,2,0.2")
    assert figures(HISTORY[:1]) == []


def test_a_study_tells_how_far_it_is_and_keeps_what_it_has_found(tmp_path, capsys):
    with _counted(tmp_path / "maps", 3) as (say, at_work):
        at_work("1 of 2: Hertz")
        say("Hertz: 1 %")
        say("Dimitriadis: 5 %")
    assert capsys.readouterr().out.splitlines() == ["[1 of 3, 0 s] Hertz: 1 %", "[2 of 3, 0 s] Dimitriadis: 5 %"]
    assert (tmp_path / "maps" / PARTIAL).read_text() == "Hertz: 1 %\nDimitriadis: 5 %\n"
    with _counted(tmp_path / "maps") as (say, _):
        say("again")
    assert (tmp_path / "maps" / PARTIAL).read_text() == "again\n"


def test_on_a_terminal_a_study_says_what_it_is_at(monkeypatch, capsys):
    """Seen to fail before: minutes of finite elements went by without a word."""
    monkeypatch.setenv("FORCE_COLOR", "1")
    with _counted(None) as (say, at_work):
        at_work("[3 of 6]: FEM, Poisson's ratio 0.3")
        time.sleep(0.2)
        say("FEM: 1 %")
    shown = capsys.readouterr().out
    assert "[3 of 6]: FEM, Poisson's ratio 0.3" in shown
    assert "[1, 0 s] FEM: 1 %\n" in shown


def test_the_tolerance_history_has_a_row_a_case_of_each_run_and_names_what_was_loosened():
    table = tolerance_history(accepted_numbers(770))
    headings = [row[0] for row in table.rows if len(row) == 1]
    assert headings == sorted(headings, reverse=True)
    assert len(headings) == 11
    rows = [row for row in table.rows if len(row) > 1]
    assert len(rows) == 77
    assert sum(int(row[4]) for row in rows) == 770
    assert all("2 LOOSENED, normal_force of scene" in row[3] for row in rows)
    assert all(row[3].endswith("of mdr from 1.5e-9 to 3.0e-9") for row in rows)


def test_numbers_that_came_and_went_are_counted_apart_from_those_that_moved():
    entries = (
        entry("a", "mdr", None, 1.0),
        entry("a", "fem", 1.0, None),
        entry("a", "fem", 1.0, 1.5),
        entry("a", "bem", None, None),
    )
    _, row = tolerance_history(entries).rows
    assert row == ("cone", "bem, fem, mdr", "1 new, 1 gone, force", "", "1", "0.5")
    assert tolerance_history(()) is None
