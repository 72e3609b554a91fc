"""Conformance of every case of the library, just by being listed."""

from fnmatch import fnmatchcase

import pytest

from cases.claims import Claim
from cases.declare.registry import load_cases
from cases.library import _common
from cases.verdicts import Kind, Origin
from contact import InvalidInput

CASES = load_cases()
# Stress tests, and finite elements as a program, have no scenes and no claims about them.
ON_SCENES = sorted(name for name, case in CASES.items() if case.scenes)


@pytest.mark.parametrize("name", sorted(CASES))
def test_a_case_asks_a_question_and_names_its_source(name):
    case = CASES[name]
    assert case.question.endswith("?")
    assert case.equations
    assert len(case.text) > 200


@pytest.mark.parametrize("name", ON_SCENES)
def test_a_case_has_a_claim_that_no_own_output_decides(name):
    claims = [claim for claim in CASES[name].claims if isinstance(claim, Claim)]
    assert Origin.OWN_EARLIER_OUTPUT not in {claim.why.origin for claim in claims}
    assert {claim.kind for claim in claims} & {Kind.EXACT, Kind.AGREEMENT, Kind.ORDER}


@pytest.mark.parametrize("name", ON_SCENES)
def test_an_independent_method_takes_part(name):
    """Finite elements share nothing with MDR; a case without them would verify the kernel with itself."""
    assert "fem" in {use.label for use in CASES[name].methods}
    claims = [claim for claim in CASES[name].claims if isinstance(claim, Claim)]
    assert any("fem" in claim.labels(use) for claim in claims for _, use in claim.places(CASES[name]))


def test_a_method_that_solves_some_scenes_only_is_judged_on_these():
    """In the suite ci finite elements solve one of four scenes; a claim that named them then judged them on none."""
    case = CASES["inside_half_space"].in_suite("ci")
    claim = next(claim for claim in case.claims if claim.name == "the force passes every depth")
    assert [(scene.name, use.label) for scene, use in claim.places(case)] == [
        ("paraboloid nu=0.3", "mdr"),
        ("paraboloid nu=0.3", "fem"),
        ("paraboloid nu=0.5", "mdr"),
    ]


@pytest.mark.parametrize("name", sorted(CASES))
def test_every_task_can_be_planned_and_its_identity_is_unique_or_the_same_question(name):
    tasks = {}
    for task in CASES[name].tasks():
        known = tasks.setdefault(task.identity, task)
        assert (known.problem, known.use, known.timed) == (task.problem, task.use, task.timed), task.label


@pytest.mark.parametrize("name", sorted(CASES))
def test_timed_settings_name_their_method(name):
    """Their labels name settings: a report once said what accuracy costs by a method without a name."""
    assert all(use.method for study in CASES[name].costs for use in (*study.ladder, *study.cheap, study.reference))


def test_every_pattern_of_the_suite_ci_is_about_a_scene_and_a_method_of_its_case():
    for name, lists in _common.IN_CI.items():
        case = CASES[name]
        assert set(lists) <= {"*"} | {use.label for scene in case.scenes for use in case.methods_of(scene)}, name
        patterns = (pattern for own in lists.values() for pattern in own)
        assert [p for p in patterns if not any(fnmatchcase(scene.name, p) for scene in case.scenes)] == [], name


def test_a_docstring_without_a_question_is_refused_by_the_name_of_its_file():
    with pytest.raises(InvalidInput, match=r"hertz\.py: a docstring is"):
        _common.paper("cases.hertz", "Title.\n\nText.", (), (), ())
