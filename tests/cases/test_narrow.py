"""A case in one suite or with chosen methods: what cannot be answered is left out, and nothing else."""

import dataclasses

import pytest

from cases.claims import Equal
from cases.declare.registry import load_cases
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
        for scene, use in claim.places(case)
        for label in claim.labels(use)
    }


def test_a_scene_of_other_methods_alone_is_left_out_with_its_claims():
    case = fake_case()
    only_slow = dataclasses.replace(case.scenes[1], methods=(SLOW,))
    case = dataclasses.replace(case, scenes=(case.scenes[0], only_slow), claims=case.claims[-1:])
    narrowed = case.only_methods(["fast"])
    assert [scene.name for scene in narrowed.scenes] == [case.scenes[0].name]
    assert [use.label for use in narrowed.methods] == ["fast"]


def test_a_nightly_method_is_missing_in_ci_only_where_it_is_declared():
    case = with_a_nightly_method()
    night = case.scenes[1].name
    assert case.in_suite("nightly").scenes == case.in_suite("").scenes == case.scenes
    lost = {(task.scene, task.use.label) for task in case.tasks()} - {
        (task.scene, task.use.label) for task in case.in_suite("ci").tasks()
    }
    assert lost == {(night, "slow")} == case.nightly_only()


def test_a_nightly_claim_is_left_to_the_nightly_suite():
    case = fake_case()
    last = dataclasses.replace(case.claims[-1], nightly=True)
    case = dataclasses.replace(case, claims=(*case.claims[:-1], last))
    assert last.name not in {claim.name for claim in case.in_suite("ci").claims}
    assert case.in_suite("nightly").claims == case.claims


def test_ci_loses_no_claim_that_its_methods_can_answer():
    case = with_a_nightly_method()
    night = case.scenes[1].name
    exact = {place for place in places(case, "exact") if place[1:] != (night, "slow")}
    assert places(case.in_suite("ci"), "exact") == exact
    assert not {place for place in places(case.in_suite("ci"), "agreement") if place[1] == night}


def test_a_claim_that_names_its_methods_keeps_those_that_are_left_somewhere():
    case = with_a_nightly_method()
    claim = next(claim for claim in case.claims if isinstance(claim, Equal))
    named = dataclasses.replace(case, claims=(dataclasses.replace(claim, methods=("fast", "slow")),))
    small = named.in_suite("ci")
    expected = places(named) - {(claim.name, case.scenes[1].name, "slow")}
    assert places(small) == expected


def test_an_unknown_nightly_method_is_refused():
    case = fake_case()
    scene = dataclasses.replace(case.scenes[0], nightly=("sow",))
    with pytest.raises(InvalidInput, match="'sow'"):
        dataclasses.replace(case, scenes=(scene, case.scenes[1]))


@pytest.mark.parametrize("name", sorted(name for name, case in load_cases().items() if case.scenes))
def test_ci_judges_each_case_of_the_library_by_every_method_the_case_has(name):
    case = load_cases()[name]
    small = case.in_suite("ci")
    everywhere = {task.use.label for task in small.tasks()}
    assert everywhere >= {use.label for use in case.methods}
    assert {claim.name for claim in small.claims} <= {claim.name for claim in case.claims}
