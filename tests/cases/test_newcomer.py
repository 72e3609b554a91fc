"""A registered method joins every case: which claims are put to it, and with which tolerance."""

from dataclasses import replace

import pytest

from cases.claims import Agree, Equal, Law, Zero
from cases.convergence import Order
from cases.declare.registry import load_cases
from cases.foreign import with_foreign_methods, with_registered
from contact import InvalidInput
from tests.cases.fake_case import fake_case


def claims_of(case, kind):
    return [claim for claim in case.claims if isinstance(claim, kind)]


def test_claims_about_single_methods_extend_to_the_newcomer():
    case = with_foreign_methods(fake_case(), {"newcomer": 0.0})
    (exact,), (twin,) = claims_of(case, Equal), claims_of(case, Law)
    assert exact.methods == ("fast", "newcomer")
    assert [use.label for scene, use in twin.places(case) if scene is case.scenes[0]] == ["fast", "slow", "newcomer"]


def test_it_is_compared_with_both_methods_of_the_case():
    case = with_foreign_methods(fake_case(), {"newcomer": 0.0})
    compared = {(claim.fast, claim.reference) for claim in claims_of(case, Agree)}
    assert compared == {("fast", "slow"), ("newcomer", "fast"), ("newcomer", "slow")}


@pytest.mark.parametrize(("claimed", "exact", "fast"), [(1e-3, 1e-10, 1e-5), (1e-12, 1e-11, 1e-11), (0.0, 1e-10, 1e-5)])
def test_a_claimed_accuracy_tightens_and_never_loosens(claimed, exact, fast):
    case = with_foreign_methods(fake_case(), {"newcomer": claimed})
    (closed_form,) = claims_of(case, Equal)
    assert closed_form.tolerance_of("newcomer") == pytest.approx(exact, rel=1e-12, abs=0.0)
    assert closed_form.tolerance_of("fast") == 1e-10
    tolerances = {(claim.fast, claim.reference): claim.tolerance for claim in claims_of(case, Agree)}
    assert tolerances["newcomer", "fast"] == pytest.approx(fast, rel=1e-12, abs=0.0)
    assert tolerances["newcomer", "slow"] == tolerances["fast", "slow"] == 1e-5


def test_without_a_claimed_accuracy_it_meets_the_widest_tolerance_of_the_others():
    case = fake_case()
    (exact,) = claims_of(case, Equal)
    wide = replace(exact, tolerances={"fast": 1e-5})
    case = with_foreign_methods(replace(case, claims=(wide,)), {"newcomer": 0.0})
    assert claims_of(case, Equal)[0].tolerance_of("newcomer") == 1e-5


def test_orders_and_residuals_stay_with_the_methods_they_belong_to():
    case = fake_case()
    (twin,) = claims_of(case, Law)
    residual = Zero(name="energy", quantity="energy_residual", tolerance=1e-8, why=twin.why)
    case = with_foreign_methods(replace(case, claims=(*case.claims, residual)), {"newcomer": 0.0})
    assert claims_of(case, Zero)[0].methods == ("fast", "slow")
    assert [order.method for order in claims_of(case, Order)] == ["slow"]


def test_a_chosen_method_is_in_every_case_of_the_library(install):
    install({"stranger": "tests.cases.fake_method:FakeHertz"})
    for case in load_cases().values():
        assert "stranger" in {use.label for use in with_registered(case, ["stranger"]).methods}


def test_without_registered_methods_a_case_is_unchanged(install):
    install({})
    case = fake_case()
    assert with_registered(case) is case


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("stranger", "no_such_package:Solver", "cannot be imported from no_such_package"),
        ("stranger", "tests.cases.fake_method:Nothing", "Nothing"),
        ("mdr", "tests.cases.fake_method:FakeHertz", "two methods are called 'mdr'"),
    ],
)
def test_a_method_that_cannot_join_says_why(install, name, value, message):
    install({name: value})
    with pytest.raises(InvalidInput, match=message):
        with_registered(fake_case())
