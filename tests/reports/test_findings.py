"""What a run found: failures grouped per claim, worst first, and a sentence that narrows their cause."""

import dataclasses

import numpy as np
import pytest

from cases.runs import Run
from cases.verdicts import Kind, Status
from reports.findings import WORST_FIRST, causes, counts, findings, headline, is_wide
from tests.cases.example_run import FAILING, PASSING, example, only, verdict, with_verdicts


def test_reading_order_names_every_status_once():
    assert sorted(WORST_FIRST) == sorted(Status)


def test_failures_come_first_and_nothing_that_failed_is_left_out():
    run = example()
    found = findings(run)
    assert [one.status for one in found] == sorted((one.status for one in found), key=WORST_FIRST.index)
    failed = sum(status.is_failure for status in run.statuses)
    assert sum(len(one.scenes) for one in found if one.tone == "bad") == failed
    expected = {
        status: run.statuses.count(status) for status in WORST_FIRST if status.is_failure and status in run.statuses
    }
    assert {status: number for status, number in counts(run) if status.is_failure} == expected


@pytest.mark.parametrize(
    ("run", "words"),
    [
        (example(), "FAILED: 4 of 8 checks"),
        (only(PASSING), "PASSED: all 3 checks"),
        (only(PASSING, complete=False), "INCOMPLETE: 3 checks so far, none failed"),
        (only(), "Nothing ran"),
        (only(FAILING, complete=False), "FAILED: 4 of 5 checks"),
    ],
)
def test_headline(run, words):
    assert headline(run)[0] == words


def test_a_run_that_only_measures_times_did_run():
    timed = only(PASSING, verdicts=())
    timed = Run(judged=timed.judged, answers=type(timed.answers)())
    assert headline(timed) == ("MEASURED: 1 case, no claims", "good")
    assert headline(with_verdicts())[0] == "Nothing ran"


def test_an_identity_is_not_counted():
    first, *others = only(PASSING).judged.verdicts
    run = only(PASSING, verdicts=(dataclasses.replace(first, identity="the kernel has no nu"), *others))
    assert headline(run)[0] == "PASSED: all 2 checks"


def test_skips_of_one_reason_are_one_finding():
    run = only(FAILING, verdicts=())
    (skip,) = [answer for answer in run.answers if answer.status is Status.SKIP]
    again = [dataclasses.replace(skip, scene=f"scene {i}") for i in range(3)]
    other = dataclasses.replace(skip, scene="other", reason="models no punches")
    found = findings(Run(judged=run.judged, answers=type(run.answers)([skip, *again, other])))
    assert {one.message: len(one.scenes) for one in found} == {skip.reason: 4, "models no punches": 1}


def failing(errors, **changes):
    return [
        dataclasses.replace(
            verdict(), scene=f"scene {i}", error=error, status=Status.FAIL if error else Status.PASS, **changes
        )
        for i, error in enumerate(errors)
    ]


def test_failures_of_one_claim_are_one_finding_with_their_size():
    (found,) = findings(with_verdicts(*failing([1e-3] * 20)))
    assert (found.where, found.size) == ("20 of 20 scenes", "+1.0e-3 each")
    (found,) = findings(with_verdicts(*failing([1e-3, -2e-9, 0.0])))
    assert (found.where, found.size) == ("2 of 3 scenes", "-2.0e-9 to +1.0e-3")


def moved(changes, **names):
    accepted = dataclasses.replace(verdict(Kind.REGRESSION, Status.DIFF), expected=1.0, **names)
    return [
        dataclasses.replace(accepted, scene=f"s{i}", error=1.0 + change, status=Status.DIFF if change else Status.PASS)
        for i, change in enumerate(changes)
    ]


def test_accepted_numbers_that_moved_alike_are_one_finding_over_all_cases():
    forces = moved([1e-10] * 151)
    elsewhere = [dataclasses.replace(v, case="other") for v in moved([1e-10] * 3)]
    (found,) = findings(with_verdicts(*forces, *elsewhere))
    assert (found.case, found.where, found.size) == ("2 cases", "154 of 154 scenes", "+1.0e-10 each")


@pytest.mark.parametrize("seed", range(3))
def test_every_number_that_moved_is_counted_once(seed):
    draw = np.random.default_rng(seed)
    changes = draw.choice([0.0, 1e-9, 1.02e-9, -1e-6, 1e-3], 40)
    found = findings(with_verdicts(*(v for c in changes for v in moved([c], quantity=draw.choice(["a", "b"])))))
    assert sum(len(one.scenes) for one in found) == np.count_nonzero(changes)


def agreement(methods, error, quantity, status):
    base = verdict(Kind.AGREEMENT, Status.PASS)
    return dataclasses.replace(
        base, claim=f"{quantity} {methods}", methods=methods, error=error, quantity=quantity, status=status
    )


def test_a_method_that_all_others_contradict_is_named_with_the_place_to_look_at():
    verdicts = [
        agreement(("mdr", "fem"), 1e-3, "indentation_depth", Status.FAIL),
        agreement(("mdr", "integral_equation"), 1.01e-3, "indentation_depth", Status.FAIL),
        agreement(("bem", "fem"), 1e-7, "indentation_depth", Status.PASS),
        agreement(("mdr", "fem"), 1e-9, "contact_stiffness", Status.PASS),
        *failing([1e-3], quantity="indentation_depth"),
    ]
    (sentence,) = causes(with_verdicts(*verdicts))
    assert sentence.startswith("MDR: indentation depth is off against FEM, integral equation and closed form alike,")
    assert "+1.0e-3 each in 3 comparisons, as by one factor 1.001 (a modulus, a unit)" in sentence
    assert sentence.endswith("while contact stiffness passes: look at g, Eq. (8).")


def test_two_methods_alone_that_disagree_blame_neither():
    assert causes(with_verdicts(agreement(("mdr", "fem"), 1e-3, "normal_force", Status.FAIL))) == []


def test_a_method_that_one_of_three_partners_confirms_is_not_blamed():
    verdicts = [
        agreement(("mdr", "fem"), 1e-3, "normal_force", Status.FAIL),
        agreement(("mdr", "bem"), 1e-3, "normal_force", Status.FAIL),
        agreement(("mdr", "integral_equation"), 1e-12, "normal_force", Status.PASS),
    ]
    assert causes(with_verdicts(*verdicts)) == []


@pytest.mark.parametrize(("tolerance", "wide"), [(1e-2, False), (5e-2, True), (3.0, False)])
def test_a_wide_tolerance_is_a_relative_one_above_one_per_cent(tolerance, wide):
    agreed = dataclasses.replace(verdict(Kind.AGREEMENT, Status.PASS), tolerance=tolerance)
    assert is_wide(agreed) is wide
    assert not is_wide(dataclasses.replace(agreed, kind=Kind.ORDER))
    assert not is_wide(dataclasses.replace(agreed, kind=Kind.INVARIANT, expected=0.0))
