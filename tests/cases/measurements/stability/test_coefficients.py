"""Every coefficient of the error models is listed once, with quantities and scenes that exist."""

import collections
import dataclasses
from importlib import import_module

import pytest

from cases.declare.methods import BUILT_IN
from cases.measurements.campaigns.coefficients import GROUPS, values_of
from cases.measurements.campaigns.coverage import PLANS
from cases.results.records.reliability import CoverageRecord
from contact import UNITS

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
