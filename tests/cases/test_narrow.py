"""A case in one suite or with chosen methods: what cannot be answered is left out, and nothing else."""

import dataclasses

import pytest

from cases.declare.registry import load_cases
from cases.declare.selection import in_suite, nightly_only, only_methods
from cases.judgement.claims.exact import Exact
from contact import InvalidInput
from tests.cases.fake_case import SLOW, fake_case


def with_a_nightly_method():
    """The slow method solves the second scene at night only."""
    case = fake_case()
    return dataclasses.replace(case, scenes=(case.scenes[0], dataclasses.replace(case.scenes[1], nightly=("slow",))))


def places(case, kind=""):
    return {
        (claim.name, scene.name, label)
        for claim in case.claims
        if claim.kind == kind or not kind
        for scene in claim.scenes_of(case)
        for label in claim.labels(case, scene)
    }


def test_a_scene_of_other_methods_alone_is_left_out_with_its_claims():
    case = fake_case()
    only_slow = dataclasses.replace(case.scenes[1], methods=(SLOW,))
    case = dataclasses.replace(case, scenes=(case.scenes[0], only_slow), claims=case.claims[-1:])
    narrowed = only_methods(case, ["fast"])
    assert [scene.name for scene in narrowed.scenes] == [case.scenes[0].name]
    assert [use.label for use in narrowed.methods] == ["fast"]


def test_a_nightly_method_is_missing_in_ci_only_where_it_is_declared():
    case = with_a_nightly_method()
    night = case.scenes[1].name
    assert in_suite(case, "nightly").scenes == in_suite(case, "").scenes == case.scenes
    lost = {(task.scene, task.method) for task in case.tasks()} - {
        (task.scene, task.method) for task in in_suite(case, "ci").tasks()
    }
    assert lost == {(night, "slow")} == nightly_only(case)


def test_a_nightly_claim_is_left_to_the_nightly_suite():
    case = fake_case()
    last = dataclasses.replace(case.claims[-1], nightly=True)
    case = dataclasses.replace(case, claims=(*case.claims[:-1], last))
    assert last.name not in {claim.name for claim in in_suite(case, "ci").claims}
    assert in_suite(case, "nightly").claims == case.claims


def test_ci_loses_no_claim_that_its_methods_can_answer():
    case = with_a_nightly_method()
    night = case.scenes[1].name
    exact = {place for place in places(case, "exact") if place[1:] != (night, "slow")}
    assert places(in_suite(case, "ci"), "exact") == exact
    assert not {place for place in places(in_suite(case, "ci"), "agreement") if place[1] == night}


def test_a_claim_that_names_its_methods_keeps_those_that_are_left_somewhere():
    case = with_a_nightly_method()
    claim = next(claim for claim in case.claims if isinstance(claim, Exact))
    named = dataclasses.replace(case, claims=(dataclasses.replace(claim, methods=("fast", "slow")),))
    (left,) = in_suite(named, "ci").claims
    assert left.methods == ("fast", "slow")
    assert left.scenes_of(case) == claim.scenes_of(case)


def test_an_unknown_nightly_method_is_refused():
    case = fake_case()
    scene = dataclasses.replace(case.scenes[0], nightly=("sow",))
    with pytest.raises(InvalidInput, match="'sow'"):
        dataclasses.replace(case, scenes=(scene, case.scenes[1]))


@pytest.mark.parametrize("name", sorted(load_cases()))
def test_ci_judges_each_case_of_the_library_by_every_method_the_case_has(name):
    case = load_cases()[name]
    small = in_suite(case, "ci")
    everywhere = {task.method for task in small.tasks()}
    assert everywhere >= {use.label for use in case.methods}
    assert {claim.name for claim in small.claims} <= {claim.name for claim in case.claims}
