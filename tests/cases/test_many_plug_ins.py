"""However many packages bring a method: each is compared with the case's own methods once, and none that was not chosen
appears.
"""

from collections import Counter

import pytest

from cases.claims import Agree, Claim
from cases.declare.registry import load_cases
from cases.foreign import with_registered
from tests.cases.fake_method import FakeHertz

NAMES = ("stranger_a", "stranger_b", "stranger_c", "stranger_d")
LIBRARY = sorted(load_cases())
COMPARISONS = (Agree,)


class ModestHertz(FakeHertz):
    """A method that claims 5 %."""

    claimed_accuracy = 0.05


@pytest.fixture
def install_four(install):
    """Lets four packages be installed when it is called, one of them modest; none before."""
    install({})
    others = dict.fromkeys(NAMES[1:], "tests.cases.fake_method:FakeHertz")
    return lambda: install({NAMES[0]: f"{__name__}:ModestHertz", **others})


def comparisons(case):
    """Agreements by what is compared, with whom, and where; with their tolerances."""
    found = [
        ((claim.quantity, getattr(claim, "norm", ""), frozenset((claim.fast, claim.reference)), scene.name), claim)
        for claim in case.claims
        if isinstance(claim, COMPARISONS)
        for scene in claim.scenes_of(case)
    ]
    assert len(found) == len({place for place, _ in found}), Counter(place for place, _ in found).most_common(3)
    return dict(found)


@pytest.mark.parametrize("name", LIBRARY)
def test_packages_never_meet_in_a_claim_and_each_pair_is_compared_once(install_four, name):
    case = load_cases()[name]
    install_four()
    joined = with_registered(case)
    for claim in joined.claims:
        if isinstance(claim, COMPARISONS):
            assert sum(stranger in repr((claim.name, claim.fast, claim.reference)) for stranger in NAMES) <= 1
    assert {claim.name for claim in case.claims} <= {claim.name for claim in joined.claims}
    comparisons(joined)


@pytest.mark.first(32)
@pytest.mark.parametrize("suite", ["", "ci"])
@pytest.mark.parametrize("name", LIBRARY)
def test_a_chosen_method_is_asked_the_same_whatever_else_is_installed(install_four, name, suite):
    """The modest package, installed as well, changes nothing for the chosen one."""
    case = load_cases()[name]
    chosen = ["mdr", "stranger_b"]
    install_four()
    among_four = with_registered(case).in_suite(suite).only_methods(chosen)
    assert {task.use.label for task in among_four.tasks() if task.use.label in NAMES} <= {"stranger_b"}
    alone = with_registered(case, chosen).in_suite(suite).only_methods(chosen)
    assert {use.label for use in alone.methods} & set(NAMES) == {"stranger_b"}
    assert asked_of(among_four) == asked_of(alone)


def asked_of(case):
    """Claims with what they ask of the methods that are left."""
    return {
        (
            claim.name,
            scene.name,
            use.label,
            claim.tolerance_of(use.label),
        )
        for claim in case.claims
        if isinstance(claim, Claim)
        for scene, use in claim.places(case)
    }


def test_the_library_itself_is_that_of_this_project(install_four):
    install_four()
    for case in load_cases().values():
        assert not set(NAMES) & {use.label for use in case.methods}
        assert not [stranger for stranger in NAMES if stranger in repr([claim.name for claim in case.claims])]
        assert with_registered(case, ["mdr"]) is case
