"""The gate passes what was accepted, and nothing else: each way to differ is planted once."""

import dataclasses

import pytest

from cases.answers import Table
from cases.verdicts import ExitCode, Status, exit_code
from contact.records.extras import NOT_INSTALLED
from tests.cases.example_run import OTHER_SCENE, PASSING, SCENE, fast
from tests.cases.gate.example_baselines import (
    accepted,
    clean_run,
    gated,
    regressions,
    scaled,
    with_answers,
    with_force,
    with_quantities,
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return accepted(tmp_path_factory.mktemp("baselines"))


def failures(run, folder):
    return [claim for claim in regressions(gated(run, folder)) if claim.status.is_failure]


def test_the_accepted_run_passes(folder):
    claims = regressions(gated(clean_run(), folder))
    # Answers times two quantities, unknowns, one counter and the stated errors; two stress tests.
    assert len(claims) == 4 * (2 + 2 + 1) + 2
    assert {claim.status for claim in claims} == {Status.PASS}
    assert exit_code(gated(clean_run(), folder).statuses) is ExitCode.PASSED


def test_gating_twice_claims_nothing_twice(folder):
    once = gated(clean_run(), folder)
    assert gated(once, folder).judged == once.judged


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
        return lambda q: dataclasses.replace(q, values=(1.0, 2.0, last), error=())

    folder = accepted(tmp_path, with_force("mdr", three_steps(4.0)))
    (claim, *_) = failures(with_force("mdr", three_steps(4.1)), folder)
    assert (claim.error, claim.expected) == (4.1, 4.0)
    assert claim.tolerance == pytest.approx(4e-9, rel=1e-12, abs=0.0)


def test_settings_that_only_the_answer_reports_are_no_other_question(folder):
    changed = with_answers(lambda row: dataclasses.replace(row, settings={**row.settings, "mesh": "0123"}))
    assert not failures(changed, folder)


def force_of_mdr(**changes):
    return with_force("mdr", lambda q: dataclasses.replace(q, **changes))


def without(lost):
    """The clean run without the answers for which `lost` is true."""
    return with_answers(lambda row: None if lost(row) else row)


def broken():
    bare = dataclasses.replace(fast(SCENE), status=Status.INVALID, reason="value is nan", quantities={}, counters={})
    return with_answers(lambda row: bare if (row.method, row.scene) == ("mdr", SCENE) else row)


def with_a_newcomer():
    run = clean_run()
    stranger = dataclasses.replace(fast(SCENE), method="newcomer")
    return dataclasses.replace(run, answers=Table([*run.answers, stranger]))


def counting(**counters):
    return with_answers(lambda row: dataclasses.replace(row, counters=counters))


def stated(factor, quantities=("normal_force", "indentation_depth", "pressure")):
    """Stated errors of some quantities, those of fields included, times `factor`."""
    return with_quantities(
        lambda _, name, q: dataclasses.replace(q, error=tuple(factor * u for u in q.error)) if name in quantities else q
    )


BOTH, ALL_METHODS, UNWATCHED = {SCENE, OTHER_SCENE}, {"mdr", "fem"}, Status.INCOMPARABLE
FORCE, ERROR = "accepted normal_force", "accepted uncertainty of "
NUMBERS = {f"accepted {name}" for name in ("indentation_depth", "normal_force", "unknowns", "solves")}
# By what differs: the run, and status, scenes, methods, claims and a word of all that fails because of it.
DIFFERENCES = {
    "another unit": (lambda: force_of_mdr(unit="kN"), UNWATCHED, BOTH, {"mdr"}, {FORCE}, "changed: kN, accepted N"),
    "another number of steps": (
        lambda: force_of_mdr(values=(1.5, 1.0), error=()), UNWATCHED, BOTH, {"mdr"}, {FORCE}, "steps changed: 2"
    ),
    "another question": (
        lambda: with_answers(lambda row: dataclasses.replace(row, question="0" * 16)),
        UNWATCHED, BOTH, ALL_METHODS, None, "",
    ),
    "a missing quantity": (
        lambda: with_force("fem", lambda _: None), UNWATCHED, BOTH, {"fem"}, {FORCE}, "missing: normal_force"
    ),
    "a missing answer": (
        lambda: without(lambda row: (row.method, row.scene) == ("fem", SCENE)), UNWATCHED, {SCENE}, {"fem"}, NUMBERS, ""
    ),
    "a missing method": (lambda: without(lambda row: row.method == "fem"), UNWATCHED, BOTH, {"fem"}, NUMBERS, ""),
    "a solver that broke down": (broken, Status.INVALID, {SCENE}, {"mdr"}, None, "value is nan"),
    "a method nobody accepted": (with_a_newcomer, UNWATCHED, {SCENE}, {"newcomer"}, None, "extra:"),
    "counters that vanish": (counting, UNWATCHED, BOTH, ALL_METHODS, None, "missing"),
    "a counter that appears": (
        lambda: counting(factorisations=1, solves=3, restarts=7), None, BOTH, ALL_METHODS, {"accepted restarts"}, ""
    ),
    "errors that grow a millionfold": (lambda: stated(1e6), Status.DIFF, BOTH, ALL_METHODS, {ERROR + "pressure"}, ""),
    "errors that grow fiftyfold": (lambda: stated(50.0), Status.DIFF, BOTH, ALL_METHODS, None, ""),
    "errors that shrink fiftyfold": (lambda: stated(1 / 50), Status.DIFF, BOTH, ALL_METHODS, None, ""),
    "errors that shrink a millionfold": (lambda: stated(1e-6), Status.DIFF, BOTH, ALL_METHODS, None, ""),
    "the error of a field": (
        lambda: stated(1e6, ("pressure",)), Status.DIFF, BOTH, ALL_METHODS, {ERROR + "pressure"}, ""
    ),
    "the error of a force": (
        lambda: stated(1e6, ("normal_force",)), Status.DIFF, BOTH, ALL_METHODS, {ERROR + "normal_force"}, ""
    ),
    "an error no longer stated": (
        lambda: with_force("fem", lambda q: dataclasses.replace(q, error=())),
        None, BOTH, {"fem"}, {ERROR + "normal_force"}, "missing: ",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", DIFFERENCES)
def test_what_differs_fails_by_its_name(folder, name):
    spoil, status, scenes, methods, claims, words = DIFFERENCES[name]
    found = failures(spoil(), folder)
    assert status is None or {claim.status for claim in found} == {status}
    assert {claim.scene for claim in found} == scenes
    assert {method for claim in found for method in claim.methods} == methods
    assert claims is None or {claim.claim for claim in found} >= claims
    assert all(words in claim.message for claim in found)


def skipped(reason, scenes=(SCENE, OTHER_SCENE)):
    """The clean run with every solution of finite elements on these scenes skipped for a reason."""

    def change(row):
        if row.method != "fem" or row.scene not in scenes:
            return row
        return dataclasses.replace(row, status=Status.SKIP, reason=reason, quantities={}, counters={})

    return with_answers(change, clean_run(verdicts=(), stress_tests=()))


ABSENT = f"fem {NOT_INSTALLED}: pip install something"


def test_a_method_that_is_not_installed_is_told_once_and_not_compared(folder):
    claims = [claim for claim in regressions(gated(skipped(ABSENT), folder)) if "fem" in claim.methods]
    assert [claim.status for claim in claims] == [Status.SKIP]
    assert ABSENT in claims[0].message
    assert "6 accepted numbers are not compared" in claims[0].message


@pytest.mark.parametrize(("reason", "scenes"), [("it models half-spaces", (SCENE, OTHER_SCENE)), (ABSENT, (SCENE,))])
def test_a_method_that_refuses_or_answers_some_scenes_only_still_misses_what_was_accepted(folder, reason, scenes):
    found = [claim for claim in failures(skipped(reason, scenes), folder) if "normal_force" in claim.quantity]
    assert {claim.scene for claim in found if claim.scene} == set(scenes)


def test_a_case_that_left_the_suite_fails_by_its_name(folder):
    other = dataclasses.replace(clean_run().judged.cases[0], name="another_case")
    run = dataclasses.replace(clean_run(cases=(other,), verdicts=(), stress_tests=()), answers=Table())
    assert {verdict.status for verdict in regressions(gated(run, folder)) if verdict.case == PASSING} == {
        Status.INCOMPARABLE
    }
    for suite in ("", "referees", "nightly"):
        elsewhere = dataclasses.replace(run, judged=dataclasses.replace(run.judged, suite=suite))
        assert PASSING not in {case.name for case in gated(elsewhere, folder).judged.cases}


@pytest.mark.parametrize(
    ("unknowns", "solves", "status"),
    [(21420, 6, Status.PASS), (21421, 3, Status.DIFF), (20579, 3, Status.DIFF), (21000, 7, Status.DIFF)],
)
def test_unknowns_within_2_percent_and_other_counters_within_a_fifth_or_three(folder, unknowns, solves, status):
    def counted(row):
        if row.method != "fem":
            return row
        return dataclasses.replace(row, unknowns=unknowns, counters={"solves": solves})

    statuses = {claim.status for claim in regressions(gated(with_answers(counted), folder))}
    assert statuses == {Status.PASS, status}


def test_an_empty_run_ran_nothing(folder):
    empty = dataclasses.replace(clean_run(cases=(), verdicts=(), suite=""), answers=Table())
    assert exit_code(gated(empty, folder).statuses) is ExitCode.NOTHING_RAN


@pytest.mark.parametrize("factor", [5.0, 1.0, 1 / 5])
def test_error_bars_that_hardly_move_pass(folder, factor):
    assert not failures(stated(factor), folder)


def test_claims_removed_from_a_case_fail_by_their_names(folder):
    names = {verdict.claim for verdict in clean_run().judged.verdicts}
    found = failures(clean_run(verdicts=()), folder)
    assert {claim.claim for claim in found} == {f"accepted claim {name!r}" for name in names} != set()
    assert {claim.status for claim in found} == {Status.INCOMPARABLE}


def test_a_single_claim_or_one_of_its_scenes_removed_fails_by_its_name(folder):
    own = clean_run().judged.verdicts
    for lost in own:
        (found,) = failures(clean_run(verdicts=tuple(v for v in own if v is not lost)), folder)
        assert found.claim == f"accepted claim {lost.claim!r}"
        assert "this run judges it on 0" in found.message


def test_a_new_claim_is_welcome(folder):
    own = clean_run().judged.verdicts
    assert not failures(clean_run(verdicts=(*own, dataclasses.replace(own[0], claim="a new claim"))), folder)
