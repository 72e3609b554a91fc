"""What moved together is one sentence, and no number that moved is left out of the count."""

import dataclasses

import numpy as np
import pytest

from cases.gate.checks.check import missing, regression_claim
from cases.judgement.rules.regression import judge_regression
from reports.commands.runs import show_verdict
from reports.pages.moves import baseline_sentence, moves
from tests.cases.example_run import example_run, passing_case


def claim(judgement, expected=1.0, method="mdr", quantity="normal_force"):
    return regression_claim(
        "accepted",
        judgement,
        scene="s",
        methods=(method,),
        quantity=quantity,
        source="baselines",
        because="b",
        derived_from="d",
        expected=expected,
        tolerance=1e-12,
    )


def moved(change, expected=1.0, **names):
    judgement = judge_regression(expected * (1.0 + change), expected, scale=abs(expected), rtol=1e-12)
    return claim(judgement, expected, **names)


def run_with(*claims):
    case = dataclasses.replace(passing_case(), claims=claims)
    return dataclasses.replace(example_run(), cases=(case,))


def test_a_quantity_that_moved_as_a_whole_is_one_sentence():
    forces = np.random.default_rng(5).uniform(1e-3, 1e3, 151)
    run = run_with(*(moved(1e-10, force) for force in forces))
    assert moves(run) == ["all 151 normal_force of MDR moved by +1.0e-10 relative"]
    assert baseline_sentence(run) == f"Since the baseline: 151 of 151 numbers changed: {moves(run)[0]}."


def test_what_moved_otherwise_is_a_group_of_its_own_and_single_ones_are_counted():
    run = run_with(
        *(moved(-2e-9, method="fem") for _ in range(5)),
        *(moved(change, method="fem") for change in (1e-9, 1e-6, 1e-3, 0.0)),
        moved(1e-5, quantity="contact_stiffness"),
        claim(missing("normal_force", "s", None), expected=None),
    )
    assert moves(run) == [
        "5 of 9 normal_force of FEM moved by -2.0e-09 relative",
        "3 of 9 normal_force of FEM moved by +1.0e-09 to +1.0e-03 relative",
        "the rest: 1 DIFF, 1 INCOMPARABLE",
    ]


@pytest.mark.parametrize("seed", range(5))
def test_every_number_that_moved_is_counted_once(seed):
    draw = np.random.default_rng(seed)
    changes = draw.choice([0.0, 1e-9, 1.02e-9, -1e-6, 1e-3], 40)
    run = run_with(*(moved(change, quantity=draw.choice(["a", "b"])) for change in changes))
    counted = sum(int(words.split()[words.startswith(("all", "the"))].removesuffix(":")) for words in moves(run)[:-1])
    *_, last = moves(run)
    counted += int(last.split()[2] if last.startswith("the rest") else last.split()[last.startswith("all")])
    assert counted == np.count_nonzero(changes)


def test_nothing_is_said_where_nothing_moved(tmp_path, capsys):
    run = run_with(moved(0.0), moved(1e-13))
    assert moves(run) == []
    show_verdict(run, tmp_path, quiet=True)
    assert "moved" not in capsys.readouterr().out


def test_the_terminal_says_it_before_the_worst_rows(tmp_path, capsys):
    show_verdict(run_with(*(moved(1e-10) for _ in range(30))), tmp_path, quiet=True)
    assert capsys.readouterr().out.startswith("all 30 normal_force of MDR moved by +1.0e-10 relative")
