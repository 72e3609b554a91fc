"""A method of another package is asked whether it supports a scene, and blamed by its name for whatever goes wrong."""

from dataclasses import replace

import numpy as np
import pytest

from cases.declare import methods
from cases.declare.guarded_method import BrokenMethodError, GuardedMethod, build_guarded
from cases.foreign import LARGEST_CLAIM, claimed_accuracy, with_registered
from contact import (
    Cone,
    ContactRadii,
    InvalidInput,
    Layer,
    NotConvergedError,
    Paraboloid,
    Scene,
    Unsupported,
    UnsupportedSceneError,
)
from mdr import Mdr
from reports.command_line import INTERNAL_ERROR, run
from tests.cases.fake_case import fake_case
from tests.cases.fake_method import FakeHertz
from tests.reports.test_command_line import HERTZ

SCENE = Scene(
    layer=Layer.half_space(youngs_modulus=1e6, poissons_ratio=0.3),
    indenter=Paraboloid(radius_of_curvature=0.01),
    loading=ContactRadii(values=[0.5e-3, 1e-3]),
)
ANSWER = FakeHertz().solve(SCENE)


class Stranger(FakeHertz):
    """Does what a test wants in `solve`."""

    deed = staticmethod(lambda scene: ANSWER)
    support = staticmethod(lambda scene: True)

    def supports(self, scene):
        return type(self).support(scene)

    def solve(self, scene):
        return type(self).deed(scene)


@pytest.fixture
def register(install):
    def register(name="stranger", value="tests.cases.test_foreign:Stranger"):
        install({name: value})

    register()
    return register


def raises(error):
    def deed(*ignored):
        raise error

    return deed


UNUSABLE_NAMES = (
    "../../evil", "a/b", "a\\b", "<script>alert(1)</script>", "a&b", 'a"b', "a b", "", ".", "..", ".hidden", "-x",
    "x" * 61, "a\x1b[2J", "a\nb", "µ", "a|b", "tcp://host", "CON:", "\u202eevil",
)  # fmt: skip


@pytest.mark.parametrize("name", UNUSABLE_NAMES, ids=repr)
def test_a_name_that_is_no_plain_word_is_refused_before_anything_is_computed(register, name, tmp_path, capsys):
    register(name)
    for ask in (methods.registered, methods.method_names, lambda: with_registered(fake_case())):
        with pytest.raises(InvalidInput, match="rename the entry point of"):
            ask()
    assert run(["run", "truncated_cone", "--out", str(tmp_path / "out")]) == 4
    assert not (tmp_path / "out").exists()
    assert "rename the entry point" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["hertz_half_space", "Fem-2.1", "x"])
def test_plain_names_are_taken(register, name):
    register(name)
    assert set(methods.registered()) - set(methods.REFEREES) == {name}


@pytest.mark.parametrize("claimed", [0.11, 1.0, 1e9, -1e-3, np.nan, np.inf, "1e-3", True, None, [1e-3]], ids=repr)
def test_a_claim_of_accuracy_has_a_limit(register, monkeypatch, claimed):
    monkeypatch.setattr(Stranger, "claimed_accuracy", claimed, raising=False)
    with pytest.raises(InvalidInput, match=r"'stranger': claimed_accuracy = .* is no relative accuracy from 0 to 0\.1"):
        with_registered(fake_case())


def test_the_largest_claim_and_none_at_all_are_taken(register, monkeypatch):
    assert claimed_accuracy("stranger") == 0.0
    monkeypatch.setattr(Stranger, "claimed_accuracy", LARGEST_CLAIM, raising=False)
    assert claimed_accuracy("stranger") == LARGEST_CLAIM


def test_it_is_asked_first_whether_it_supports_the_scene(register, monkeypatch):
    monkeypatch.setattr(Stranger, "support", staticmethod(lambda scene: Unsupported("only on Mondays")))
    monkeypatch.setattr(Stranger, "deed", staticmethod(raises(AssertionError("solved"))))
    with pytest.raises(UnsupportedSceneError, match="'stranger' does not model this scene: only on Mondays"):
        build_guarded("stranger", {}).solve(SCENE)


@pytest.mark.parametrize("error", [ZeroDivisionError("1/0"), SystemExit(0), RecursionError(), KeyError("a")], ids=repr)
@pytest.mark.parametrize("place", ["deed", "support"])
def test_a_crash_is_told_under_its_name(register, monkeypatch, error, place):
    monkeypatch.setattr(Stranger, place, staticmethod(raises(error)))
    with pytest.raises(BrokenMethodError, match=f"'stranger' crashed in .*{type(error).__name__}"):
        build_guarded("stranger", {}).solve(SCENE)


@pytest.mark.parametrize("error", [InvalidInput("too deep"), NotConvergedError("no end", {"r": 1.0})], ids=repr)
def test_a_refusal_keeps_its_kind_and_gets_the_name(register, monkeypatch, error):
    monkeypatch.setattr(Stranger, "deed", staticmethod(raises(error)))
    with pytest.raises(type(error), match=f"^method 'stranger': {str(error)[:6]}"):
        build_guarded("stranger", {}).solve(SCENE)


def changed(**changes):
    return lambda scene: replace(ANSWER, **changes)


NONSENSE = {
    "nothing": (lambda scene: None, "None is no Solution"),
    "a number": (lambda scene: 1.0, r"1\.0 is no Solution"),
    "text that steers": (lambda scene: "\x1b[2J", r"'\\x1b\[2J' is no Solution"),
    "another scene": (changed(scene=SCENE.replace(indenter=Cone(slope=0.1))), "another scene"),
    "too few steps": (
        lambda scene: FakeHertz().solve(SCENE.replace(loading=ContactRadii(values=[1e-3]))),
        "another scene|values are prescribed",
    ),
    "other radii": (changed(contact_radius=2 * ANSWER.contact_radius), "its contact_radius is"),
    "a negative error": (changed(error_estimate={"normal_force": np.array([-1.0, 0.0])}), "negative error of normal_f"),
    "no cost": (changed(cost=None), "its cost is no Cost"),
    "numbers that are none": (
        lambda scene: replace(ANSWER, normal_force=np.array([np.nan, 1.0])),
        "'stranger'",
    ),
}


@pytest.mark.parametrize("kind", NONSENSE)
def test_nonsense_is_no_answer(register, monkeypatch, kind):
    deed, message = NONSENSE[kind]
    monkeypatch.setattr(Stranger, "deed", staticmethod(deed))
    with pytest.raises((BrokenMethodError, NotConvergedError), match=message) as caught:
        build_guarded("stranger", {}).solve(SCENE)
    assert "'stranger'" in str(caught.value)


def test_a_good_answer_passes_and_built_in_methods_are_not_guarded(register):
    assert build_guarded("stranger", {}).solve(SCENE) is ANSWER
    assert isinstance(build_guarded("stranger", {}).refined(), GuardedMethod)
    assert isinstance(build_guarded("mdr", {}), Mdr)


@pytest.mark.parametrize("value", ["tests.cases.no_such_module:X", "tests.cases.test_foreign:ANSWER"])
def test_what_is_no_method_is_told_under_its_name(register, value):
    register(value=value)
    with pytest.raises((InvalidInput, BrokenMethodError), match="'stranger'"):
        build_guarded("stranger", {})


@pytest.fixture
def stranger_solves(register, monkeypatch, tmp_path):
    (tmp_path / "scene.toml").write_text(HERTZ)

    def solve(deed):
        monkeypatch.setattr(Stranger, "deed", staticmethod(deed))
        return run(["solve", str(tmp_path / "scene.toml"), "--method", "stranger"])

    return solve


@pytest.mark.parametrize(
    ("deed", "code", "words"),
    [
        (raises(ZeroDivisionError("1/0")), INTERNAL_ERROR, "'stranger' crashed in solve: ZeroDivisionError: 1/0"),
        (lambda scene: 3, INTERNAL_ERROR, "'stranger' gives no answer: 3 is no Solution"),
        (raises(NotConvergedError("no end")), 1, "no answer: method 'stranger': no end"),
    ],
    ids=["crash", "nonsense", "no answer"],
)
def test_the_command_blames_it_in_one_line(stranger_solves, capsys, deed, code, words):
    assert stranger_solves(deed) == code
    told = capsys.readouterr().err
    assert words in told
    assert len(told.splitlines()) == 1


def test_installed_packages_are_read_once(monkeypatch):
    asked = []
    monkeypatch.setattr(methods, "entry_points", lambda group: asked.append(group) or [])
    assert methods.registered() == methods.registered() == dict(methods.REFEREES)
    assert len(asked) == 1
