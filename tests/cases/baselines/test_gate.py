import dataclasses
import json

import pytest

from cases.baselines.accept import accept
from cases.baselines.gate import gate_case, gated
from cases.baselines.history import read_history
from cases.baselines.records import baseline_path, read_baseline
from cases.results import Kind
from cases.status import ExitCode, Status, exit_code
from contact import InvalidInput
from tests.cases.example_run import SCENE, broken_run, example_run, example_stamp, failing_case, passing_case

SPREAD = 1e-10  # hence a relative tolerance of 1e-9


def spreads(case, run):
    return {q.name: SPREAD for q in run.quantities}


def accepted(directory, case=None, *, write=True, **options):
    settings = {"reason": "first numbers", "spreads": spreads, "environment": {}, **options}
    return accept(case or passing_case(), example_stamp(), directory, write=write, **settings)


def moved(case, relative, *, quantity="normal_force", method="mdr"):
    """The case with one quantity of one method moved."""

    def run_of(run):
        if run.method != method:
            return run
        changed = tuple(
            dataclasses.replace(q, values=tuple(v * (1 + relative) for v in q.values)) if q.name == quantity else q
            for q in run.quantities
        )
        return dataclasses.replace(run, quantities=changed)

    return dataclasses.replace(case, runs=tuple(run_of(run) for run in case.runs))


def ends(case, directory):
    return {claim.status for claim in gate_case(case, directory)}


def test_identical_numbers_pass(tmp_path):
    accepted(tmp_path)
    claims = gate_case(passing_case(), tmp_path)
    assert {c.status for c in claims} == {Status.PASS}
    assert {c.kind for c in claims} == {Kind.REGRESSION}
    assert {c.quantity for c in claims} >= {"normal_force", "counter unknowns", "counter factorisations"}


def test_a_change_of_1e_7_with_tolerance_1e_9_always_fails(tmp_path):
    accepted(tmp_path)
    for sign in (1, -1):
        for quantity in ("normal_force", "indentation_depth"):
            for method in ("mdr", "fem"):
                case = moved(passing_case(), sign * 1e-7, quantity=quantity, method=method)
                assert Status.DIFF in ends(case, tmp_path)


def test_a_change_within_the_tolerance_passes(tmp_path):
    accepted(tmp_path)
    assert ends(moved(passing_case(), 5e-10), tmp_path) == {Status.PASS}


def test_a_changed_counter_fails(tmp_path):
    accepted(tmp_path)
    case = passing_case()
    cost = dataclasses.replace(case.runs[0].cost, unknowns=case.runs[0].cost.unknowns + 1)
    grown = dataclasses.replace(case, runs=(dataclasses.replace(case.runs[0], cost=cost), *case.runs[1:]))
    failed = [c for c in gate_case(grown, tmp_path) if c.status is Status.DIFF]
    assert [c.quantity for c in failed] == ["counter unknowns"]


def test_a_missing_quantity_fails_by_name(tmp_path):
    accepted(tmp_path)
    case = passing_case()
    fewer = dataclasses.replace(case.runs[0], quantities=case.runs[0].quantities[1:])
    claims = gate_case(dataclasses.replace(case, runs=(fewer, *case.runs[1:])), tmp_path)
    failed = [c for c in claims if c.status.is_failure]
    assert [(c.quantity, c.status) for c in failed] == [("indentation_depth", Status.INCOMPARABLE)]
    assert "missing" in failed[0].message


def test_a_missing_method_fails_by_name(tmp_path):
    accepted(tmp_path)
    case = passing_case()
    only_fast = dataclasses.replace(case, runs=tuple(r for r in case.runs if r.method == "mdr"))
    failed = [c for c in gate_case(only_fast, tmp_path) if c.status.is_failure]
    assert {c.methods for c in failed} == {("fem",)}


def test_an_extra_quantity_fails_by_name(tmp_path):
    case = passing_case()
    fewer = dataclasses.replace(case.runs[0], quantities=case.runs[0].quantities[1:])
    accepted(tmp_path, dataclasses.replace(case, runs=(fewer, *case.runs[1:])))
    failed = [c for c in gate_case(case, tmp_path) if c.status.is_failure]
    assert [(c.quantity, c.status) for c in failed] == [("indentation_depth", Status.INCOMPARABLE)]
    assert "extra" in failed[0].message


def test_without_any_baseline_nothing_passes(tmp_path):
    assert ends(passing_case(), tmp_path) == {Status.INCOMPARABLE}


def test_a_broken_solution_is_invalid_not_missing(tmp_path):
    accepted(tmp_path)
    case = passing_case()
    broken = dataclasses.replace(case, runs=(case.runs[0], broken_run(SCENE), *case.runs[2:]))
    failed = [c for c in gate_case(broken, tmp_path) if c.status.is_failure]
    assert {c.status for c in failed} == {Status.INVALID}


def test_another_scene_under_the_same_name_is_incomparable(tmp_path):
    accepted(tmp_path)
    case = passing_case()
    other = dataclasses.replace(case.scenes[0], canonical='{"indenter":{"kind":"Cone"}}')
    claims = gate_case(dataclasses.replace(case, scenes=(other, *case.scenes[1:])), tmp_path)
    assert {c.status for c in claims if c.scene == SCENE} == {Status.INCOMPARABLE}


def test_a_nan_in_a_baseline_is_refused_and_never_passes(tmp_path):
    accepted(tmp_path)
    path = baseline_path(tmp_path, "example_cone", "mdr")
    path.write_text(path.read_text(encoding="utf-8").replace("1.5", "NaN", 1), encoding="utf-8")
    with pytest.raises(InvalidInput, match="is no baseline"):
        gate_case(passing_case(), tmp_path)


def test_the_gated_run_decides_the_exit_code_and_shows_the_history(tmp_path):
    run = dataclasses.replace(example_run(), cases=(passing_case(),))
    accepted(tmp_path)
    assert exit_code(gated(run, tmp_path).statuses) is ExitCode.PASSED
    assert gated(run, tmp_path).acceptances == read_history(tmp_path)
    worse = dataclasses.replace(run, cases=(moved(passing_case(), 1e-7),))
    assert exit_code(gated(worse, tmp_path).statuses) is ExitCode.GATE_FAILED


# -- accept ------------------------------------------------------------------------------------------------------------


def test_accept_is_dry_by_default(tmp_path):
    changes = accepted(tmp_path, write=False)
    assert changes
    assert list(tmp_path.iterdir()) == []


def test_accept_shows_the_change_in_units_of_tolerance_and_of_uncertainty(tmp_path):
    accepted(tmp_path)
    changes = accepted(tmp_path, moved(passing_case(), 1e-7), write=False, reason="a better rule")
    change = next(c for c in changes if c.quantity == "normal_force")
    assert (change.old, change.new) == (1.5, 1.5 * (1 + 1e-7))
    assert change.in_tolerances == pytest.approx(100, rel=1e-6)
    assert change.in_uncertainties == pytest.approx(1e5, rel=1e-6)


def test_numbers_keep_every_digit_and_keys_are_sorted(tmp_path):
    case = moved(passing_case(), 1 / 3)
    accepted(tmp_path, case)
    stored = read_baseline(tmp_path, "example_cone", "mdr")
    force = next(q for q in stored.quantities if q.quantity == "normal_force")
    assert force.values == case.runs[0].quantity("normal_force").values
    keys = list(json.loads(baseline_path(tmp_path, "example_cone", "mdr").read_text(encoding="utf-8")))
    assert keys == sorted(keys)


@pytest.mark.parametrize("reason", ["", "  "])
def test_accept_needs_a_reason(tmp_path, reason):
    with pytest.raises(InvalidInput, match="needs a reason"):
        accepted(tmp_path, reason=reason)


def test_accept_refuses_ci(tmp_path):
    with pytest.raises(InvalidInput, match="CI"):
        accepted(tmp_path, environment={"CI": "true"})


def test_accept_refuses_a_dirty_tree(tmp_path):
    dirty = dataclasses.replace(example_stamp(), dirty=True)
    with pytest.raises(InvalidInput, match="working tree"):
        accept(passing_case(), dirty, tmp_path, reason="x", spreads=spreads, write=True, environment={})


def test_accept_refuses_a_broken_solution_and_a_failing_exact_claim(tmp_path):
    with pytest.raises(InvalidInput, match="has no numbers"):
        accepted(tmp_path, failing_case())
    failing = failing_case()
    solved = dataclasses.replace(failing, runs=tuple(r for r in failing.runs if not r.status.is_failure))
    with pytest.raises(InvalidInput, match="mend it, never accept it"):
        accepted(tmp_path, solved)


def test_loosening_is_refused_without_the_flag_and_visible_after_it(tmp_path):
    accepted(tmp_path)
    wider = {"spreads": lambda case, run: {q.name: 100 * SPREAD for q in run.quantities}, "reason": "noisier"}
    with pytest.raises(InvalidInput, match="--loosen"):
        accepted(tmp_path, **wider)
    accepted(tmp_path, loosen=True, **wider)
    latest = read_history(tmp_path)[-1]
    assert (latest.old_tolerance, latest.new_tolerance) == (pytest.approx(1e-9), pytest.approx(1e-7))
    assert latest.reason == "noisier"


def test_a_negative_spread_is_refused(tmp_path):
    with pytest.raises(InvalidInput, match="spread"):
        accepted(tmp_path, spreads=lambda case, run: {q.name: -1e-3 for q in run.quantities})


def test_history_is_only_appended(tmp_path):
    accepted(tmp_path)
    first = read_history(tmp_path)
    accepted(tmp_path, moved(passing_case(), 1e-7), reason="a better rule")
    second = read_history(tmp_path)
    assert second[: len(first)] == first
    assert len(second) > len(first)
    assert {a.reason for a in second[len(first) :]} == {"a better rule"}
