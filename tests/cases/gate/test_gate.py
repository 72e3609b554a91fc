"""The gate passes what was accepted, and nothing else: each way to differ is planted once."""

import dataclasses

import pytest

from cases.results.records.claim import Kind
from cases.results.status import ExitCode, Status, exit_code
from contact.records.extras import NOT_INSTALLED
from reports.pages.annotations import MOST, annotation_lines
from tests.cases.example_run import OTHER_SCENE, SCENE, fast_run, passing_case
from tests.cases.gate.example_baselines import accepted, clean_run, gated, regressions, scaled, with_force, with_rows


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return accepted(tmp_path_factory.mktemp("baselines"))


def failures(run, folder):
    return [claim for claim in regressions(gated(run, folder)) if claim.status.is_failure]


def test_the_accepted_run_passes(folder):
    claims = regressions(gated(clean_run(), folder))
    assert len(claims) == 4 * (2 + 2 + 1)  # solutions times two quantities, unknowns and one counter, error bars
    assert {claim.status for claim in claims} == {Status.PASS}
    assert exit_code(gated(clean_run(), folder).statuses) is ExitCode.PASSED


def test_gating_twice_claims_nothing_twice(folder):
    once = gated(clean_run(), folder)
    assert gated(once, folder) == once


@pytest.mark.parametrize(("method", "fraction"), [("mdr", 100), ("fem", 10)])
@pytest.mark.parametrize("factor", [1 + 1e-7, 1 - 1e-7])
def test_a_change_of_1e_7_with_tolerance_1e_9_always_fails(folder, method, fraction, factor):
    found = failures(with_force(method, scaled(factor)), folder)
    assert {(claim.status, claim.quantity, claim.methods) for claim in found} == {
        (Status.DIFF, "normal_force", (method,))
    }
    assert all(claim.fraction == pytest.approx(fraction, rel=1e-3, abs=0.0) for claim in found)


def test_a_change_of_half_a_tolerance_passes(folder):
    assert not failures(with_force("mdr", scaled(1 + 5e-10)), folder)


@pytest.mark.parametrize(("change", "passes"), [(5e-9, True), (2e-8, False)])
def test_a_value_may_move_by_a_hundredth_of_its_stated_error(folder, change, passes):
    # Finite elements state 1e-6 here, and their accepted spread alone would permit 1e-9.
    assert bool(failures(with_force("fem", scaled(1 + change)), folder)) is not passes


def test_only_the_worst_step_is_shown_with_its_accepted_value(tmp_path):
    def three_steps(last):
        return lambda q: dataclasses.replace(q, values=(1.0, 2.0, last), uncertainty=())

    folder = accepted(tmp_path, with_force("mdr", three_steps(4.0)))
    (claim, *_) = failures(with_force("mdr", three_steps(4.1)), folder)
    assert (claim.observed, claim.expected) == (4.1, 4.0)
    assert claim.tolerance == pytest.approx(4e-9, rel=1e-12, abs=0.0)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda q: dataclasses.replace(q, unit="kN"), "unit changed: kN, accepted N"),
        (lambda q: dataclasses.replace(q, values=(*q.values, 1.0), uncertainty=()), "number of steps changed: 2"),
    ],
)
def test_another_unit_or_shape_is_incomparable(folder, change, message):
    (claim, *_) = failures(with_force("mdr", change), folder)
    assert claim.status is Status.INCOMPARABLE
    assert message in claim.message


def test_another_question_is_incomparable_and_not_a_change_of_number(folder):
    changed = with_rows(lambda row: dataclasses.replace(row, specification="0" * 16))
    assert {claim.status for claim in failures(changed, folder)} == {Status.INCOMPARABLE}


def test_settings_that_only_the_answer_reports_are_no_other_question(folder):
    changed = with_rows(lambda row: dataclasses.replace(row, settings={**row.settings, "mesh": "0123"}))
    assert not failures(changed, folder)


def test_a_missing_quantity_fails_by_its_name(folder):
    found = failures(with_force("fem", lambda _: None), folder)
    assert len(found) == 2
    assert all("missing: normal_force" in claim.message for claim in found)


def test_a_missing_solution_and_a_missing_method_fail_by_name(folder):
    lost_scene = with_rows(lambda row: None if (row.method, row.scene) == ("fem", SCENE) else row)
    assert {(c.scene, c.methods, c.status) for c in failures(lost_scene, folder)} == {
        (SCENE, ("fem",), Status.INCOMPARABLE)
    }
    lost_method = with_rows(lambda row: None if row.method == "fem" else row)
    assert {claim.quantity for claim in failures(lost_method, folder)} == {
        "indentation_depth",
        "normal_force",
        "unknowns",
        "solves",
    }


def test_a_solver_that_broke_down_is_invalid_with_its_reason(folder):
    broken = dataclasses.replace(
        fast_run(SCENE), status=Status.INVALID, reason="value is nan", quantities=(), cost=None
    )
    run = with_rows(lambda row: broken if (row.method, row.scene) == ("mdr", SCENE) else row)
    found = failures(run, folder)
    assert {claim.status for claim in found} == {Status.INVALID}
    assert all("value is nan" in claim.message for claim in found)


def skipped(reason, scenes=(SCENE, OTHER_SCENE)):
    """The clean run with every solution of finite elements on these scenes skipped for a reason."""

    def change(row):
        if row.method != "fem" or row.scene not in scenes:
            return row
        return dataclasses.replace(row, status=Status.SKIP, reason=reason, quantities=(), curves=(), cost=None)

    run = with_rows(change)
    (case,) = run.cases
    return dataclasses.replace(run, cases=(dataclasses.replace(case, claims=()),))


ABSENT = f"fem {NOT_INSTALLED}: pip install something"


def test_a_method_that_is_not_installed_is_told_once_and_not_compared(folder):
    claims = [claim for claim in regressions(gated(skipped(ABSENT), folder)) if "fem" in claim.methods]
    assert [claim.status for claim in claims] == [Status.SKIP]
    assert ABSENT in claims[0].message
    assert "4 accepted numbers are not compared" in claims[0].message


def test_what_is_installed_is_compared_beside_what_is_not(folder):
    other = [claim for claim in regressions(gated(skipped(ABSENT), folder)) if claim.methods == ("mdr",)]
    assert Status.PASS in {claim.status for claim in other}
    assert len(other) > 8


@pytest.mark.parametrize(("reason", "scenes"), [("it models half-spaces", (SCENE, OTHER_SCENE)), (ABSENT, (SCENE,))])
def test_a_method_that_refuses_or_answers_some_scenes_only_still_misses_what_was_accepted(folder, reason, scenes):
    found = [claim for claim in failures(skipped(reason, scenes), folder) if "normal_force" in claim.quantity]
    assert {claim.scene for claim in found if claim.scene} == set(scenes)


def test_what_nobody_accepted_fails_by_its_name(folder):
    stranger = dataclasses.replace(fast_run(SCENE), method="newcomer")
    case = dataclasses.replace(passing_case(), runs=(*passing_case().runs, stranger))
    found = failures(clean_run(case), folder)
    assert {(claim.methods, claim.status) for claim in found} == {(("newcomer",), Status.INCOMPARABLE)}
    assert all("extra:" in claim.message for claim in found)


def test_a_case_that_left_the_suite_fails_by_its_name(folder):
    other = dataclasses.replace(passing_case(), name="another_case")
    result = gated(clean_run(other), folder)
    lost = result.case("example_cone")
    assert {claim.status for claim in lost.claims} == {Status.INCOMPARABLE}
    for suite in ("", "referees", "nightly"):
        elsewhere = dataclasses.replace(clean_run(other), suite=suite)
        assert "example_cone" not in {case.name for case in gated(elsewhere, folder).cases}


@pytest.mark.parametrize(
    ("unknowns", "solves", "status"),
    [(21420, 6, Status.PASS), (21421, 3, Status.DIFF), (20579, 3, Status.DIFF), (21000, 7, Status.DIFF)],
)
def test_unknowns_within_2_percent_and_other_counters_within_a_fifth_or_three(folder, unknowns, solves, status):
    def counted(row):
        if row.method != "fem":
            return row
        return dataclasses.replace(
            row, cost=dataclasses.replace(row.cost, unknowns=unknowns, counters={"solves": solves})
        )

    statuses = {claim.status for claim in regressions(gated(with_rows(counted), folder))}
    assert statuses == {Status.PASS, status}


def test_a_counter_that_vanishes_or_appears_fails(folder):
    def counting(counters):
        return lambda row: dataclasses.replace(row, cost=dataclasses.replace(row.cost, counters=counters))

    assert all("missing" in claim.message for claim in failures(with_rows(counting({})), folder))
    extra = failures(with_rows(counting({"factorisations": 1, "solves": 3, "restarts": 7})), folder)
    assert "restarts" in {claim.quantity for claim in extra}


def test_regression_is_never_called_verification(folder):
    for claim in regressions(gated(clean_run(), folder)):
        assert claim.kind is Kind.REGRESSION
        assert claim.origin == "own earlier output"


def test_without_any_baseline_everything_is_extra(tmp_path):
    result = gated(clean_run(), tmp_path)
    assert {claim.status for claim in regressions(result)} == {Status.INCOMPARABLE}
    assert exit_code(result.statuses) is ExitCode.GATE_FAILED


def test_sixteen_failures_make_at_most_nine_annotations(tmp_path):
    lines = annotation_lines(gated(clean_run(), tmp_path))
    assert len(lines) <= MOST == 9


def test_an_empty_run_ran_nothing(folder):
    empty = dataclasses.replace(clean_run(), cases=(), suite="")
    assert exit_code(gated(empty, folder).statuses) is ExitCode.NOTHING_RAN


def stated(factor):
    """Every stated uncertainty of every solution, curves included, times `factor`."""

    def changed(row):
        quantities = [
            dataclasses.replace(q, uncertainty=tuple(factor * u for u in q.uncertainty)) for q in row.quantities
        ]
        curves = [
            c
            if c.relative_uncertainty is None
            else dataclasses.replace(c, relative_uncertainty=factor * c.relative_uncertainty)
            for c in row.curves
        ]
        return dataclasses.replace(row, quantities=tuple(quantities), curves=tuple(curves))

    return with_rows(changed)


@pytest.mark.parametrize(
    ("factor", "methods"),
    [(1e6, {"mdr", "fem"}), (50.0, {"mdr", "fem"}), (1 / 50, {"fem"}), (1e-6, {"fem"})],  # mdr states roundings
)
def test_error_bars_that_grow_or_shrink_fail_by_name(folder, factor, methods):
    found = failures(stated(factor), folder)
    assert {(claim.scene, *claim.methods) for claim in found} == {
        (scene, method) for scene in (SCENE, OTHER_SCENE) for method in methods
    }
    assert all(claim.name.startswith("accepted uncertainty of ") for claim in found)
    assert {claim.status for claim in found} == {Status.DIFF}


@pytest.mark.parametrize("factor", [5.0, 1.0, 1 / 5])
def test_error_bars_that_hardly_move_pass(folder, factor):
    assert not failures(stated(factor), folder)


@pytest.mark.parametrize("quantity", ["normal_force", "indentation_depth"])
def test_the_error_bar_of_a_single_quantity_fails_under_its_name(folder, quantity):
    def grown(row):
        changed = [
            dataclasses.replace(q, uncertainty=tuple(1e6 * u for u in q.uncertainty)) if q.name == quantity else q
            for q in row.quantities
        ]
        return dataclasses.replace(row, quantities=tuple(changed)) if row.method == "fem" else row

    found = failures(with_rows(grown), folder)
    assert {claim.name for claim in found} == {f"accepted uncertainty of {quantity}"}


def test_the_error_bar_of_a_field_fails_under_its_name(folder):
    def grown(row):
        return dataclasses.replace(
            row, curves=tuple(dataclasses.replace(c, relative_uncertainty=1e6 * 1e-3) for c in row.curves)
        )

    with_bars = with_rows(
        lambda row: dataclasses.replace(
            row, curves=tuple(dataclasses.replace(c, relative_uncertainty=1e-3) for c in row.curves)
        )
    )
    where = accepted(folder / "of fields", with_bars)
    assert not failures(with_bars, where)
    assert {claim.name for claim in failures(with_rows(grown), where)} == {"accepted uncertainty of pressure curve"}


def test_an_error_bar_that_is_no_longer_stated_fails_by_name(folder):
    silent = with_force("fem", lambda q: dataclasses.replace(q, uncertainty=()))
    found = failures(silent, folder)
    assert {claim.name for claim in found} == {"accepted uncertainty of normal_force"}
    assert all("missing: " in claim.message for claim in found)


def test_claims_removed_from_a_case_fail_by_their_names(folder):
    case = passing_case()
    names = {claim.name for claim in case.claims if claim.kind is not Kind.REGRESSION}
    found = failures(clean_run(dataclasses.replace(case, claims=())), folder)
    assert {claim.name for claim in found} == {f"accepted claim {name!r}" for name in names} != set()
    assert {claim.status for claim in found} == {Status.INCOMPARABLE}


def test_a_single_claim_or_one_of_its_scenes_removed_fails_by_its_name(folder):
    case = passing_case()
    own = [claim for claim in case.claims if claim.kind is not Kind.REGRESSION]
    for lost in own:
        kept = tuple(claim for claim in case.claims if claim is not lost)
        (found,) = failures(clean_run(dataclasses.replace(case, claims=kept)), folder)
        assert found.name == f"accepted claim {lost.name!r}"
        assert "this run judges it on 0" in found.message


def test_a_new_claim_is_welcome(folder):
    case = passing_case()
    new = dataclasses.replace(case.claims[0], name="a new claim")
    assert not failures(clean_run(dataclasses.replace(case, claims=(*case.claims, new))), folder)
