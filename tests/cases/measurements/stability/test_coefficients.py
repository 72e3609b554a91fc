"""Every coefficient of the error models is listed once, with quantities and scenes that exist."""

import collections
import dataclasses
from importlib import import_module

import pytest

from cases.declare.methods import BUILT_IN
from cases.measurements.campaigns.coefficients import GROUPS, coefficients, values_of
from cases.measurements.campaigns.coverage import PLANS
from cases.results.records.reliability import CoverageRecord
from contact import UNITS
from reports.tables.coefficient_table import error_coefficients
from tests.cases.example_run import passing_case

MODULES = ("bem.grid", "bem.layer_equation", "mdr.springs", "fem_reference")
NO_COEFFICIENT = {"EPS", "FloatArray"}


def declared(package):
    """Names of all coefficients of an error model, however it holds them."""
    module = import_module(f"{package}.error_model")
    for name, value in vars(module).items():
        if name.isupper() and name not in NO_COEFFICIENT:
            fields = [field.name for field in dataclasses.fields(value)] if dataclasses.is_dataclass(value) else [""]
            yield from (".".join(filter(None, (package, name, field))) for field in fields)


@pytest.mark.parametrize("package", MODULES)
def test_every_coefficient_is_listed_exactly_once(package):
    listed = collections.Counter(name for group in GROUPS for name, _ in values_of(group))
    expected = set(declared(package))
    assert expected
    assert {name: listed[name] for name in expected} == dict.fromkeys(expected, 1)
    assert {name for name in listed if name.startswith(f"{package}.")} == expected


@pytest.mark.parametrize("group", GROUPS, ids=lambda group: group.place)
def test_groups_name_methods_scenes_coefficients_and_quantities_that_exist(group):
    assert set(group.methods) <= set(BUILT_IN)
    names = {name.rpartition(".")[2] for name, _ in values_of(group)}
    assert set(group.quantities) <= names
    assert {quantity for shaped in group.quantities.values() for quantity in shaped} <= {*UNITS, "pressure"}
    if group.families:
        assert {plan.family for plan in PLANS if plan.method in group.methods} & set(group.families)


def record(family, quantity, covered, sharpness):
    return CoverageRecord(
        method="bem",
        settings={},
        family=family,
        quantity=quantity,
        scenes=50,
        refused=0,
        crashed=0,
        checks=50,
        covered=covered,
        decided=50,
        sharpness=sharpness,
        percentiles=(10.0 * sharpness,) * 51,
    )


def test_a_coefficient_stands_beside_the_worst_of_what_it_shapes():
    records = (
        record("elastic", "normal_force", 0.98, 3.0),
        record("elastic", "contact_stiffness", 0.96, 7.0),
        record("adhesive", "pull_off_force", 0.9, 2.0),
    )
    achieved = {c.name: [r.quantity for r in c.achieved] for c in coefficients(records)}
    assert achieved["bem.grid.DIRECT.second_order"] == ["normal_force", "contact_stiffness"]
    assert achieved["bem.grid.DIRECT.exponent_growth"] == ["contact_stiffness"]
    assert achieved["bem.grid.DIRECT.kink_difference"] == achieved["bem.grid.CELLS.lag"] == []
    assert achieved["bem.grid.DISCS.difference"] == ["pull_off_force"]
    assert not any(name.startswith(("mdr", "fem")) for name in achieved)
    table = error_coefficients(dataclasses.replace(passing_case(), coverage=records))
    rows = {row[0]: row for row in table.rows}
    assert rows["bem.grid.DIRECT.second_order"][1:] == ("all quantities", "0.05", "2", "96.0 %", "7", "70")
    assert rows["bem.grid.DIRECT.kink_difference"][1:] == ("pressure", "3", "0", "", "", "")
