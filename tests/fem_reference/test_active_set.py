from __future__ import annotations

import numpy as np
import pytest

from contact import NotConvergedError
from fem_reference import contact_set
from fem_reference.contact_set import solve_complementarity


def random_problem(seed, size=40):
    rng = np.random.default_rng(seed)
    factor = rng.normal(size=(size, size))
    return factor @ factor.T + 0.01 * np.eye(size), rng.normal(size=size)


def assert_complementary(compliance, approach, solution):
    gap = compliance @ solution.pressure - approach
    assert solution.pressure.min() >= 0
    assert gap.min() > -1e-9 * np.abs(approach).max()
    assert np.abs(solution.pressure * gap).max() < 1e-8 * np.abs(solution.pressure).max() * np.abs(approach).max()


@pytest.mark.parametrize("seed", range(30))
def test_random_problems_from_any_start(seed):
    compliance, approach = random_problem(seed)
    rng = np.random.default_rng(1000 + seed)
    starts = [None, np.ones(40, bool), np.zeros(40, bool), rng.random(40) < 0.5]
    solutions = [solve_complementarity(compliance, approach, start) for start in starts]
    for solution in solutions:
        assert_complementary(compliance, approach, solution)
        assert solution.pressure == pytest.approx(solutions[0].pressure, abs=1e-8)


def test_a_cycle_ends_in_principal_pivoting(monkeypatch):
    compliance, approach = random_problem(3)
    expected = solve_complementarity(compliance, approach).pressure
    equality = contact_set.pressure_on
    flips = iter([True] * 4 + [False] * 1000)

    def flipping(compliance, approach, active):
        pressure = equality(compliance, approach, active)
        return -pressure if next(flips) else pressure

    monkeypatch.setattr(contact_set, "pressure_on", flipping)
    solution = solve_complementarity(compliance, approach)
    assert solution.pressure == pytest.approx(expected, abs=1e-8)


def test_no_overlap_gives_no_pressure():
    compliance, _ = random_problem(0)
    assert solve_complementarity(compliance, -np.ones(40)).pressure.max() == 0


def test_violated_conditions_are_refused(monkeypatch):
    compliance, approach = random_problem(1)
    right = contact_set.pressure_on

    def wrong(compliance, approach, active):
        return 1.01 * right(compliance, approach, active)

    monkeypatch.setattr(contact_set, "pressure_on", wrong)
    with pytest.raises(NotConvergedError, match="gap_under_pressure"):
        solve_complementarity(compliance, approach)
