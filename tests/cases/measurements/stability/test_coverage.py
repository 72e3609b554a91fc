"""Coverage sees stated errors that are too small, counts only what the referee can tell, and fails below 95 %."""

import dataclasses

import pytest

from cases.measurements.campaigns import coverage
from cases.measurements.campaigns.coverage import CoveragePlan, coverage_case, errors_are_covered
from cases.results.status import Status
from contact import ContactRadii, FlatPunch
from mdr import Mdr

PLAN = CoveragePlan(method="mdr", settings={"nodes": 12}, family="elastic", count=12, smallest=0.1, largest=5.0)


class TooSure:
    """The fast method with a hundredth of its stated errors and a mistake of half its stated ones."""

    name = "mdr"

    def __init__(self, nodes):
        self.own = Mdr()

    def supports(self, scene):
        return self.own.supports(scene)

    def solve(self, scene):
        path = self.own.solve(scene)
        return dataclasses.replace(path, normal_force=path.normal_force * (1 + 1e-6))

    def refined(self):
        return self


def records(plan=PLAN):
    return {record.quantity: record for record in coverage_case([plan]).coverage}


def test_the_fast_method_on_a_few_nodes_is_covered():
    found = records()
    assert set(found) == {"contact_radius", "indentation_depth", "normal_force", "contact_stiffness"}
    assert all(record.covered == 1.0 and record.scenes == 12 and record.crashed == 0 for record in found.values())


def test_a_planted_error_beyond_the_stated_one_is_seen(monkeypatch):
    own = coverage.build
    monkeypatch.setattr(
        coverage,
        "build",
        lambda name, settings: TooSure(**settings) if settings == PLAN.settings else own(name, settings),
    )
    case = coverage_case([PLAN])
    by_quantity = {claim.quantity: claim.status for claim in case.claims}
    assert by_quantity["normal_force"] is Status.FAIL
    assert by_quantity["contact_stiffness"] is Status.PASS


def test_a_crash_fails_the_claim():
    (record, *_) = records().values()
    assert errors_are_covered(record).status is Status.PASS
    assert errors_are_covered(dataclasses.replace(record, crashed=1)).status is Status.FAIL


@pytest.mark.parametrize(("covered", "status"), [(0.951, Status.PASS), (0.949, Status.FAIL)])
def test_the_limit_is_ninety_five_percent(covered, status):
    (record, *_) = records().values()
    assert errors_are_covered(dataclasses.replace(record, covered=covered)).status is status


def test_a_plan_without_search_draws_radii_and_punches_only():
    plan = dataclasses.replace(PLAN, only_radii=True)
    for scene in coverage._scenes(plan, 1, Mdr()):
        assert isinstance(scene.loading, ContactRadii) or isinstance(scene.indenter, FlatPunch)
