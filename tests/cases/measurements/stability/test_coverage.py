"""Coverage sees stated errors that are too small and fails by name: below 95 %."""

import dataclasses

import pytest

from bem import Bem
from cases.measurements.campaigns import coverage
from cases.measurements.campaigns.coverage import (
    CoveragePlan,
    coverage_case,
    errors_are_covered,
)
from cases.results.status import Status
from contact import ContactRadii, FlatPunch
from fem_reference import Fem
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


@pytest.fixture(scope="module")
def found():
    """Records of the plan by quantity."""
    return records()


@pytest.fixture
def record(found):
    """The first of them, to be changed."""
    return next(iter(found.values()))


def test_the_fast_method_on_a_few_nodes_is_covered(found):
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
    by_name = {claim.name: claim.status for claim in case.claims}
    assert by_name["stated errors hold, normal force"] is Status.FAIL
    assert by_name["stated errors hold, contact stiffness"] is Status.PASS


def test_a_crash_fails_the_claim(record):
    assert errors_are_covered(record).status is Status.PASS
    assert errors_are_covered(dataclasses.replace(record, crashed=1)).status is Status.FAIL


@pytest.mark.parametrize(("covered", "status"), [(0.951, Status.PASS), (0.949, Status.FAIL)])
def test_the_limit_is_ninety_five_percent(record, covered, status):
    assert errors_are_covered(dataclasses.replace(record, covered=covered)).status is status


def test_a_plan_without_search_draws_radii_and_punches_only():
    plan = dataclasses.replace(PLAN, only_radii=True)
    for scene in coverage._scenes(plan, 1, Mdr()):
        assert isinstance(scene.loading, ContactRadii) or isinstance(scene.indenter, FlatPunch)


def test_suite_nightly_judges_what_no_other_plan_does():
    kinds = {(plan.method, plan.family, plan.settings.get("points")) for plan in coverage.NIGHTLY_PLANS}
    wanted = {("bem", "elastic", 256), ("bem", "elastic", 512), ("bem", "adhering_table", 128)}
    by_elements = {("fem", family, None) for family in ("adhering_table", "many_loads", "elastic")}
    of_pressure = {("bem", "pressure", 128), ("mdr", "pressure on stacks", None)}
    of_pressure |= {(method, "pressure", None) for method in ("mdr", "integral_equation", "fem", "mdr_table")}
    assert kinds == wanted | by_elements | of_pressure | {("mdr", "growing", None)}
    assert all(plan in coverage.PLANS for plan in coverage.NIGHTLY_PLANS)


def planted(solve, **changes):
    """A method's answers, each named number times a factor."""

    def wrong(self, scene):
        path = solve(self, scene)
        return dataclasses.replace(path, **{name: factor * getattr(path, name) for name, factor in changes.items()})

    return wrong


@dataclasses.dataclass(frozen=True)
class OffByAPart:
    """The fast method with pressures a little too large, or stated too largely."""

    own: Mdr
    much: float
    stated: float
    name: str = "mdr"

    def supports(self, scene):
        return self.own.supports(scene)

    def solve(self, scene):
        path = self.own.solve(scene)
        errors = {name: self.stated * error for name, error in path.error_estimate.items()}
        return dataclasses.replace(path, fields=MorePressure(path.fields, 1.0 + self.much), error_estimate=errors)


@dataclasses.dataclass(frozen=True)
class MorePressure:
    fields: object
    factor: float

    def pressure(self, radius, step):
        return self.factor * self.fields.pressure(radius, step)


@pytest.mark.parametrize(
    ("much", "stated", "failed"),
    [(0.0, 1.0, set()), (1e-6, 1.0, {"stated errors hold"})],
    ids=["as it is", "a millionth too much"],
)
def test_pressures_on_stacks_are_judged(monkeypatch, much, stated, failed):
    """A slice of the nightly plan."""
    plan = next(plan for plan in coverage.NIGHTLY_PLANS if plan.family == "pressure on stacks")
    own = coverage.build
    planted = OffByAPart(own("mdr", plan.settings), much, stated)
    monkeypatch.setattr(coverage, "build", lambda name, s: planted if s == plan.settings else own(name, s))
    claims = coverage_case([dataclasses.replace(plan, count=16)], seed=3).claims
    of_pressure = [claim for claim in claims if claim.name.endswith(", pressure")]
    assert len(of_pressure) == 1
    assert {claim.name.split(",")[0] for claim in of_pressure if claim.status is not Status.PASS} == failed


@pytest.mark.parametrize(
    ("method", "changes", "failed"),
    [
        ("mdr", {}, set()),
        ("integral_equation", {"indentation_depth": 1.0 + 1e-9}, {"indentation_depth"}),
        ("bem", {"normal_force": 1.5}, {"normal_force", "force_of_the_pressure"}),
    ],
)
def test_contacts_beside_ends_are_judged(monkeypatch, method, changes, failed):
    """A slice of the nightly plans; depth and force are compared as well as pressures."""
    plan = next(plan for plan in coverage.NIGHTLY_PLANS if (plan.method, plan.family) == (method, "pressure"))
    kind = type(coverage.build(method, plan.settings))
    monkeypatch.setattr(kind, "solve", planted(kind.solve, **changes))
    claims = coverage_case([dataclasses.replace(plan, count=5)], seed=3).claims
    assert {claim.quantity.replace(" ", "_") for claim in claims if claim.status is not Status.PASS} == failed


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "family", "points", "changes"),
    [
        (Bem, "elastic", 256, {"normal_force": 1.01}),
        (Bem, "elastic", 512, {"contact_radius": 1.001}),
        (Bem, "adhering_table", 128, {"pull_off_force": 1.1}),
        (Fem, "adhering_table", None, {"pull_off_force": 1.1}),
        (Fem, "many_loads", None, {"contact_stiffness": 1.01}),
    ],
)
def test_nightly_plans_see_planted_errors(monkeypatch, kind, family, points, changes):
    wanted = (kind.name, family, points)
    (plan,) = (p for p in coverage.NIGHTLY_PLANS if (p.method, p.family, p.settings.get("points")) == wanted)
    plan, (quantity,) = dataclasses.replace(plan, count=2), changes
    monkeypatch.setattr(kind, "solve", planted(kind.solve, **changes))
    by_name = {claim.name: claim.status for claim in coverage_case([plan]).claims}
    assert by_name[f"stated errors hold, {quantity.replace('_', ' ')}"] is Status.FAIL
