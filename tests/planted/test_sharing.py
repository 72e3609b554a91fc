"""Each thing that methods share is planted wrong by one per cent: their comparison, or a closed form, must notice."""

import importlib
from pathlib import Path

import pytest

from cases.declare.methods import BUILT_IN, build, shared_inputs
from cases.declare.registry import load_cases
from cases.declare.shared import NOT_SAID, SHARED, Sharing, in_common, used_by
from cases.verdicts import Kind
from tests.planted.planting import forget_computed
from tests.planted.sharing import FAULTS, OWN, shared_by_all
from tests.planted.sharing_table import BOTH, USERS, noticed

DOCS = Path(__file__).resolve().parents[2] / "docs" / "shared.md"
# One probe in which MDR and finite elements, or the methods that share the thing and one that does not, are compared.
COMPARED_IN = ("cone", "table", "punch impact", "sphere impact", "grids", "stack", "graded", "inside")


@pytest.fixture(autouse=True)
def _no_leftovers():
    forget_computed()
    yield
    forget_computed()


# These take seconds of processor time each.
LONG = {"graded", "inside", "stack", "sphere impact", "held", "pull-off", "table"}


def named(fault):
    return f"{fault.shared}: {fault.what}"


def marked(faults):
    return [pytest.param(f, marks=pytest.mark.slow if LONG & {*f.probes} else (), id=named(f)) for f in faults]


@pytest.mark.first(4)
@pytest.mark.parametrize("fault", marked(f for f in (*FAULTS, OWN) if not shared_by_all(f)))
def test_what_some_methods_share_parts_them_from_others(fault, monkeypatch):
    probe = next(name for name in COMPARED_IN if name in fault.probes)
    seen = noticed(fault, monkeypatch, probes=(probe,), kinds=(Kind.AGREEMENT,))
    apart = [claim for claim in seen.failing() if set(claim.methods) - set(USERS[fault.shared])]
    pair = [claim for claim in apart if claim.methods == BOTH]
    assert pair if seen.of(methods=BOTH) else apart


@pytest.mark.first(4)
@pytest.mark.parametrize("fault", marked(f for f in FAULTS if shared_by_all(f)))
def test_what_all_methods_share_is_noticed_by_a_closed_form_or_a_value(fault, monkeypatch):
    assert noticed(fault, monkeypatch, methods=("mdr",), kinds=(Kind.EXACT, Kind.INVARIANT)).failing()


def test_every_shared_thing_is_planted_and_every_place_exists():
    assert {fault.shared for fault in FAULTS} == {one.name for one in SHARED}
    for one in SHARED:
        importlib.import_module(one.place)
        assert set(one.methods) <= set(BUILT_IN)
        assert set(one.cases) <= set(load_cases())


def test_every_fault_can_be_planted(monkeypatch):
    """Those that take seconds to be noticed are planted here as well: one had lost the method that it replaces."""
    for fault in (*FAULTS, OWN):
        with monkeypatch.context() as patch:
            fault.plant(patch)
            assert patch._setattr, named(fault)


def test_finite_elements_and_mdr_share_code_in_few_quantities_only():
    code = [one for one in SHARED if one.kind is Sharing.CODE and {*BOTH} <= set(one.methods)]
    assert all(one.quantities or one.cases for one in code)
    assert in_common(used_by("mdr"), used_by("fem"), quantity="normal_force", case="paraboloid") == ()
    assert in_common(used_by("mdr"), used_by("fem"), quantity="contact_time", case="sphere_impact")
    assert "layer kernel" in in_common(used_by("mdr"), used_by("bem"), quantity="normal_force", case="paraboloid")


def test_a_method_on_a_table_says_so_and_a_stranger_that_says_nothing_is_no_independent_one():
    assert shared_inputs(build("mdr_table", {"cells": 64, "ratios": 20, "radii": 50})) == used_by("mdr_table")
    assert shared_inputs(build("mdr", {})) == used_by("mdr")
    assert used_by("stranger") == (NOT_SAID,)
    assert in_common(used_by("stranger"), used_by("fem"), quantity="normal_force", case="paraboloid") == (NOT_SAID,)


def test_the_page_lists_every_fault_and_none_goes_unnoticed():
    page = DOCS.read_text(encoding="utf-8")
    assert "**none**" not in page
    for fault in (*FAULTS, OWN):
        assert f"| {fault.shared} | {fault.what} | " in page
    assert {one.name for one in SHARED} <= {row.split(" | ")[0].removeprefix("| ") for row in page.splitlines()}
