import dataclasses
import math

import pytest
from pydantic import ValidationError

from cases.results.records.scene_run import Curve, Quantity
from cases.results.status import Status
from tests.cases.example_run import SCENE, agreement_claim, example_run, fast_run, quantities


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_a_non_finite_value_cannot_be_stored(bad):
    with pytest.raises(ValidationError, match="finite"):
        Quantity(name="normal_force", unit="N", scale=1.0, values=(1.0, bad))


def test_a_non_finite_observation_cannot_be_stored():
    with pytest.raises(ValidationError, match="finite"):
        dataclasses.replace(agreement_claim(), observed=math.nan)


def test_uncertainty_has_one_entry_per_value():
    with pytest.raises(ValidationError, match="2 uncertainties for 1 values"):
        Quantity(name="normal_force", unit="N", scale=1.0, values=(1.0,), uncertainty=(0.1, 0.1))


def test_a_negative_uncertainty_and_a_zero_scale_are_refused():
    with pytest.raises(ValidationError):
        Quantity(name="normal_force", unit="N", scale=1.0, values=(1.0,), uncertainty=(-0.1,))
    with pytest.raises(ValidationError):
        Quantity(name="normal_force", unit="N", scale=0.0, values=(1.0,))


def test_a_curve_needs_an_ordinate_for_each_abscissa():
    with pytest.raises(ValidationError, match="2 abscissae for 1 ordinates"):
        Curve(name="pressure", x_name="radius", x_unit="m", x=(0.0, 1.0), unit="Pa", y=(1.0,))


def test_an_unknown_field_is_refused():
    with pytest.raises(ValidationError, match="colour"):
        Quantity(name="normal_force", unit="N", scale=1.0, values=(1.0,), colour="red")


def test_records_are_found_by_name():
    run = fast_run(SCENE)
    assert run.quantity("normal_force") == quantities(0.0, 1e-12)[1]
    assert run.curve("pressure").unit == "Pa"
    with pytest.raises(KeyError):
        run.quantity("torque")


def test_a_broken_solution_decides_the_status_of_its_case():
    run = example_run()
    assert run.case("example_cone").status is Status.PASS
    assert run.case("example_failures").status is Status.INVALID
