"""`repr` of an answer is a few readable lines, however many numbers it holds."""

from __future__ import annotations

import numpy as np
import pytest

from contact import UNITS, ContactPath, ContactRadii, Cost
from tests.contact.test_solution_and_storage import SCENE, path, solutions

MOST_CHARACTERS = 2000


def path_of(count, **changes):
    values = np.linspace(1e-3, 2e-3, count)
    numbers = dict.fromkeys(ContactPath.ARRAYS, values)
    numbers |= {
        "scene": SCENE.replace(loading=ContactRadii(values)),
        "error_estimate": {"normal_force": [1e-7] * count},
    }
    return path(**(numbers | changes))


@pytest.mark.parametrize("solution", solutions(), ids=lambda solution: type(solution).__name__)
def test_every_answer_shows_method_scene_quantities_units_and_what_is_next(solution):
    lines = repr(solution).splitlines()
    assert lines[0] == f"{type(solution).__name__} by test, 3 states"
    assert lines[1].startswith("  scene: Layer(thickness=1 mm, ")
    assert "  note: a note" in lines
    assert lines[-1].startswith("  next: ")
    for name in (*solution.ARRAYS, *solution.SCALARS):
        line = next(line for line in lines if line.split()[0] == name)
        assert f" {UNITS[name]} " in line
        assert f"{np.atleast_1d(getattr(solution, name))[-1]:.7g} " in line


@pytest.mark.parametrize("solution", solutions(), ids=lambda solution: type(solution).__name__)
def test_what_is_next_exists(solution):
    offered = repr(solution).splitlines()[-1].removeprefix("  next: ").split(", .")
    assert all(hasattr(solution, offer.lstrip(".").split("(")[0]) for offer in offered)


def test_a_long_path_is_as_short_as_a_short_one():
    assert len(repr(path_of(100_000))) < MOST_CHARACTERS
    assert "ContactRadii(values=[1 ... 2] mm (100000 values))" in repr(path_of(100_000))


def test_stated_errors_stand_beside_the_values_and_missing_ones_are_named():
    shown = repr(path_of(2))
    assert " 0.001 ... 0.002 N " in shown
    assert " +- 1e-10 ... 2e-10\n" in shown
    assert next(line for line in shown.splitlines() if "stiffness" in line).endswith("no error stated")


def test_one_state_shows_one_value():
    shown = repr(path_of(1))
    assert "1 state\n" in shown
    assert "..." not in shown


def test_the_cost_is_not_among_the_numbers_of_the_answer():
    seconds = Cost(wall_seconds=0.123456, cpu_seconds=1.0, peak_memory_bytes=1, unknowns=3, counters={})
    assert "0.123456" not in repr(path_of(2, cost=seconds))
