"""Orders from errors that are known, and the ways in which a sequence of errors has none."""

import pytest

from cases.judgement.convergence.known_errors import behaviour_of_errors, errors_follow_order, order_of_errors
from cases.judgement.convergence.study import Refinements, study_of
from cases.results.records.convergence import ConvergenceClass
from cases.results.records.scene_run import Quantity

LENGTHS = (0.25, 0.5, 1.0)


def errors_of(order, size=1e-3):
    return tuple(size * length**order for length in LENGTHS)


def study(values, *, errors=(), reference=0.0, uncertainty=0.0, formal=2.0):
    nothing = (0,) * len(values)
    return study_of(
        Refinements(lengths=LENGTHS, values=values, unknowns=nothing, seconds=nothing, errors=errors),
        scene="s",
        method="m",
        quantity=Quantity(name="q", unit="1", scale=1.0, values=values[:1]),
        formal_order=formal,
        mesh_family="f",
        reference=reference,
        reference_uncertainty=uncertainty,
        reference_source="r",
        floor=1e-14,
    )


@pytest.mark.parametrize("order", [0.5, 2.0, 6.0])
def test_powers_have_their_order_and_follow_it(order):
    assert order_of_errors(errors_of(order), LENGTHS) == pytest.approx(order, rel=1e-12, abs=0)
    assert errors_follow_order(errors_of(order), LENGTHS, order)


def test_orders_that_wander_are_not_asymptotic():
    assert not errors_follow_order((1e-3, 1.5e-3, 4e-2), LENGTHS, 2.0)


def test_classes_of_errors():
    assert behaviour_of_errors(errors_of(2.0), floor=1e-9) is ConvergenceClass.MONOTONE
    assert behaviour_of_errors(errors_of(-1.0), floor=1e-9) is ConvergenceClass.DIVERGENT
    assert behaviour_of_errors(errors_of(2.0), floor=1e-5) is ConvergenceClass.FLOOR
    assert behaviour_of_errors(errors_of(2.0)[:2], floor=1e-9) is ConvergenceClass.TOO_FEW


def test_a_change_of_sign_hides_no_order_from_an_exact_reference():
    values = (1e-4, -4e-4, 1.6e-3)
    assert study(values).kind is ConvergenceClass.MONOTONE
    assert study(values).observed_order == pytest.approx(2.0, rel=1e-12, abs=0)
    assert study(values, reference=None).kind is ConvergenceClass.OSCILLATORY


def test_a_reference_no_better_than_the_finest_grid_is_not_believed():
    values = tuple(1 + error for error in errors_of(2.0))
    assert study(values, reference=1.0, uncertainty=1e-4).asymptotic == study(values, reference=None).asymptotic
    wrong = study(values, reference=1 + 5e-5, uncertainty=1e-4)
    assert wrong.observed_order == pytest.approx(2.0, rel=1e-9, abs=0)


def test_several_grids_of_a_refinement_count_by_their_errors():
    found = study((5e-4, 1e-9, 1e-3), errors=errors_of(2.0))
    assert found.observed_order == pytest.approx(2.0, rel=1e-12, abs=0)
    assert [grid.error for grid in found.grids] == list(errors_of(2.0))
