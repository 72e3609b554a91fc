"""Settings come from measurements: the cheapest that are likely enough, or a refusal that says what is reachable."""

from __future__ import annotations

import numpy as np
import pytest

from bem.layer_equation.method import IntegralEquationMethod
from cases.measurements.campaigns.referee import second_opinion
from cases.measurements.driver import CoarseReference
from cases.measurements.evidence import Evidence, MeasuredSetting, choose, shipped, solve
from cases.measurements.evidence import calibrate as calibration
from cases.measurements.evidence.calibrate import Candidate, calibrate, error_bound, sample_of
from cases.measurements.evidence.choice import choices
from cases.measurements.evidence.kinds import BANDS, band_of, kind_of, rough_radius
from cases.measurements.evidence.records import read, write
from cases.results.sealed import sealed_text
from contact import (
    Adhesion,
    ContactRadii,
    Detachment,
    FlatPunch,
    Impact,
    IndentationDepths,
    InvalidInput,
    Layer,
    NormalForces,
    NotConvergedError,
    Paraboloid,
    Scene,
    StandardSolid,
    Tabulated,
)
from mdr import Mdr

LAYER = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3)
SCENE = Scene(layer=LAYER, indenter=Paraboloid(radius_of_curvature=5.0), loading=ContactRadii([0.5]))


def measured(bound, seconds, *, nodes, bad=0, refused=0, band=1.0):
    """On ten scenes: one bound, but a useless one in the bad scenes and none in the refused ones."""
    bounds = (bound,) * (10 - bad - refused) + (1e-1,) * bad
    settings = {"nodes": nodes}
    return MeasuredSetting(
        kind="radii", band=band, method="mdr", settings=settings, bounds=bounds, seconds=seconds, refused=refused
    )


def evidence_of(*measurements):
    return Evidence(machine="none", revision="none", seed=0, measurements=measurements)


EVIDENCE = evidence_of(
    measured(1e-6, 0.01, nodes=12),
    measured(1e-9, 0.02, nodes=16),
    measured(1e-12, 0.04, nodes=24),
    measured(1e-13, 0.001, nodes=20, band=10.0),  # of other scenes
)


@pytest.mark.parametrize(("accuracy", "nodes"), [(1e-2, 12), (2e-6, 12), (1.9e-6, 16), (1e-8, 16), (1e-11, 24)])
def test_the_cheapest_that_is_good_enough(accuracy, nodes):
    assert choose(SCENE, accuracy, evidence=EVIDENCE).settings == {"nodes": nodes}


@pytest.mark.parametrize(("accuracy", "within"), [(1e-13, None), (1e-8, 0.015)])
def test_beyond_the_evidence_it_says_what_is_reachable(accuracy, within):
    lucky = measured(2e-13, 0.03, nodes=20, bad=9)
    reachable = (
        r"reached was 4\.0e-13 in the best of them, 2\.0e-12 in 10 of 10 \(mdr, 0\.04 s\), "
        r"and 2\.0e-06 in 10 of 10 \(mdr, 0\.01 s\) the fastest way"
    )
    with pytest.raises(InvalidInput, match=reachable):
        choose(SCENE, accuracy, within=within, evidence=evidence_of(*EVIDENCE.measurements, lucky))


def tried_nodes(accuracy, *measurements, within=None):
    return [c.settings["nodes"] for c in choices(SCENE, accuracy, within=within, evidence=evidence_of(*measurements))]


def test_one_bad_scene_does_not_decide():
    found = choose(SCENE, 1e-6, evidence=evidence_of(measured(1e-9, 0.01, nodes=16, bad=1, refused=2)))
    assert (found.reached, found.evidence.scenes) == (7, 10)
    assert (found.expected_error, found.expected_seconds) == (1e-9, 0.01)


@pytest.mark.parametrize(
    ("sure_seconds", "order"),
    [
        (0.021, [12, 24]),
        (0.019, [24]),
    ],  # 0.01 s that suffice in half of all scenes cost as much as 0.02 s that always do
)
def test_settings_are_tried_in_the_order_of_time_over_chance(sure_seconds, order):
    cheap, sure = measured(1e-9, 0.01, nodes=12, bad=5), measured(1e-10, sure_seconds, nodes=24)
    assert tried_nodes(1e-6, sure, cheap) == order  # after the finer ones, coarser ones would fail, too


def test_a_refusal_is_no_success():
    cheap, sure = measured(1e-9, 0.01, nodes=12, refused=6), measured(1e-10, 0.02, nodes=24)
    assert tried_nodes(1e-6, cheap, sure) == [24]


def test_settings_that_never_reached_it_are_not_tried():
    assert tried_nodes(1e-6, measured(1e-5, 0.001, nodes=12), measured(1e-9, 0.02, nodes=24)) == [24]


def test_settings_that_take_too_long_are_not_tried():
    cheap, sure = measured(1e-9, 0.02, nodes=12, bad=8), measured(1e-10, 0.03, nodes=24)
    assert tried_nodes(1e-6, cheap, sure) == [24]
    assert tried_nodes(1e-6, cheap, sure, within=0.025) == [12]


@pytest.mark.parametrize("accuracy", [0.0, 1.0, -1e-3, float("nan")])
def test_an_accuracy_that_is_none_is_refused(accuracy):
    with pytest.raises(InvalidInput, match="must lie between 0 and 1"):
        choose(SCENE, accuracy, evidence=EVIDENCE)


@pytest.mark.parametrize("within", [0.0, -1.0, float("nan"), float("inf")])
def test_a_time_that_is_none_is_refused(within):
    with pytest.raises(InvalidInput, match="must be positive and finite"):
        choose(SCENE, 1e-3, within=within, evidence=EVIDENCE)


def test_a_scene_that_no_measured_method_models_is_refused_with_those_that_do():
    """Compressible and viscoelastic: measured methods do not model it, and measuring them again does not help."""
    solid = StandardSolid(
        long_term_shear_modulus=0.5 * LAYER.shear_modulus,
        maxwell_shear_modulus=0.5 * LAYER.shear_modulus,
        viscosity=1.0,
    )
    scene = SCENE.replace(loading=Impact(mass=1.0, velocity=1e-2), effects=(solid,))
    with pytest.raises(InvalidInput, match=r"no measured method answers scenes like this one.*\(fem"):
        choose(scene, 1e-2)


def test_where_settings_give_no_answer_the_next_ones_solve(monkeypatch):
    solved = IntegralEquationMethod.solve

    def failing(self, scene):
        if self.nodes == 12:
            raise NotConvergedError("too coarse")
        return solved(self, scene)

    monkeypatch.setattr(IntegralEquationMethod, "solve", failing)
    kind = {"kind": "radii", "band": 1.0, "method": "integral_equation"}
    rows = [MeasuredSetting(settings={"nodes": n}, seconds=1e-3 * n, bounds=(1e-7 / n,), **kind) for n in (12, 24)]
    assert solve(SCENE, accuracy=1e-6, evidence=evidence_of(*rows)).choice.settings == {"nodes": 24}
    with pytest.raises(NotConvergedError, match=r"no answer \(too coarse"):
        solve(SCENE, accuracy=1e-6, evidence=evidence_of(rows[0]))


def test_a_layer_thinner_than_all_that_was_measured_is_refused():
    thin = SCENE.replace(loading=ContactRadii([100.0]))
    with pytest.raises(InvalidInput, match="accuracy was measured up to a/h = 25"):
        choose(thin, 1e-3, evidence=EVIDENCE)


def test_the_rough_radius_is_the_half_space_s():
    half_space = Layer.half_space(youngs_modulus=3.0, poissons_ratio=0.5)  # E* = 4
    ball = Paraboloid(radius_of_curvature=2.0)
    depth = Scene(layer=half_space, indenter=ball, loading=IndentationDepths([0.125]))
    force = Scene(layer=half_space, indenter=ball, loading=NormalForces([4 / 3 * 4.0 * 0.5**3 / 2.0]))  # Hertz, a = 0.5
    assert rough_radius(depth) == pytest.approx(0.5, rel=0.01, abs=0.0)  # interpolated between trial radii 11 % apart
    assert rough_radius(force) == pytest.approx(0.5, rel=0.02, abs=0.0)
    assert rough_radius(depth.replace(indenter=FlatPunch(radius=0.3))) == 0.3
    assert kind_of(depth) == kind_of(force) == "equilibrium"
    assert band_of(depth) == BANDS[0]


def test_the_rough_radius_of_a_detachment_is_that_of_adhesion_alone():
    """Johnson, Kendall and Roberts (1971): a^3 = 9 pi Delta gamma R^2/(2 E*) without force; it had been almost 0."""
    layer = Layer(thickness=0.1, youngs_modulus=3.0, poissons_ratio=0.5)  # E* = 4
    scene = Scene(
        layer=layer,
        indenter=Paraboloid(radius_of_curvature=2.0),
        loading=Detachment(),
        effects=(Adhesion(work_of_adhesion=0.01),),
    )
    expected = (9 * np.pi * 0.01 * 2.0**2 / (2 * 4.0)) ** (1 / 3)
    assert rough_radius(scene) == pytest.approx(expected, rel=0.02, abs=0.0)  # between trial radii 11 % apart
    assert rough_radius(scene.replace(loading=Detachment(initial_contact_radius=0.3))) == 0.3
    assert band_of(scene) == 10.0


def test_the_answer_comes_with_what_was_expected_and_achieved():
    found = solve(SCENE, accuracy=1e-7, evidence=EVIDENCE)
    assert found.choice.expected_error == 1e-9
    numbers = ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness")
    assert found.stated_error == max(found.answer.error_estimate[name].max() for name in numbers)
    opinion = second_opinion(found.answer).values["normal_force"]
    np.testing.assert_allclose(found.answer.normal_force, opinion, rtol=1e-7)


@pytest.mark.parametrize(("within", "solved"), [(None, {"nodes": 24}), (0.04, None)])
def test_where_an_answer_states_less_the_next_settings_solve(within, solved):
    """The sample said 1e-12 of six nodes; the answer knows better, and the next settings are tried if there is time."""
    hopeful = evidence_of(measured(1e-12, 0.02, nodes=6), measured(1e-13, 0.04, nodes=24))
    if solved is None:
        with pytest.raises(NotConvergedError, match="answers to this scene state"):
            solve(SCENE, accuracy=1e-10, within=within, evidence=hopeful)
    else:
        found = solve(SCENE, accuracy=1e-10, within=within, evidence=hopeful)
        assert found.choice.settings == solved
        assert found.stated_error <= 1e-10


def test_what_there_is_no_time_for_is_passed_over():
    """The first answer states more, the second settings would end beyond the time, the third ones within it."""
    first, slow = measured(1e-11, 1.0, nodes=6), measured(1e-12, 9.0, nodes=16)
    last = measured(1e-13, 6.0, nodes=24, bad=4)
    assert tried_nodes(1e-10, first, slow, last) == [6, 16, 24]
    found = solve(SCENE, accuracy=1e-10, within=9.0, evidence=evidence_of(first, slow, last))
    assert found.choice.settings == {"nodes": 24}


def test_calibration_measures_what_it_says(tmp_path):
    candidates = [Candidate(method="mdr", settings={"nodes": n}, kinds=("radii",), sample=3) for n in (12, 24)]
    found = calibrate(seed=3, candidates=candidates, bands=(1.0,))
    coarse, fine = found.measurements
    assert len(fine.bounds) == len(coarse.bounds) == 3
    assert fine.worst < 1e-11 < coarse.worst < 1e-4
    assert coarse.best < coarse.typical < coarse.worst
    write(tmp_path / "measured.json", found)
    assert read(tmp_path / "measured.json") == found


@pytest.mark.parametrize("kind", ["equilibrium", "detachment"])
def test_a_sample_is_of_its_kind_and_band(kind):
    """Half-spaces and thicker layers had been in it, which are looked up elsewhere."""
    for scene in sample_of(1, kind, 10.0, 5):
        assert kind_of(scene) == kind
        assert band_of(scene) == 10.0


def test_the_bound_counts_error_and_reference():
    answer = solve(SCENE, accuracy=1e-8, evidence=EVIDENCE).answer
    assert error_bound(answer) >= second_opinion(answer).uncertainty.max()


def test_a_scene_that_the_finest_settings_do_not_solve_measures_nothing(monkeypatch):
    class Failing:
        def solve(self, scene):
            raise NotConvergedError("not even these")

    scene = SCENE.replace(loading=Impact(mass=1.0, velocity=1e-2))
    answer = Mdr().solve(scene)
    monkeypatch.setattr(calibration, "build", lambda *_: Failing())
    with pytest.raises(CoarseReference):
        error_bound(answer)


def test_measurements_that_keep_only_the_worst_are_refused_with_the_remedy(tmp_path):
    row = {"kind": "radii", "band": 1.0, "method": "mdr", "settings": {}, "bound": 1e-6, "seconds": 1.0, "scenes": 8}
    tree = {"machine": "x", "revision": "x", "seed": 0, "measurements": [row]}
    (tmp_path / "measured.json").write_text(sealed_text(tree))
    with pytest.raises(InvalidInput, match=r"bounds: .*; measure it anew with contact-verify calibrate$"):
        read(tmp_path / "measured.json")


@pytest.mark.parametrize("text", ["", "{}", '{"machine": 1}', "[1, 2", '{"machine": "x", "revision": "x", "seed": 0}'])
def test_a_damaged_file_is_refused(tmp_path, text):
    (tmp_path / "measured.json").write_text(text)
    with pytest.raises(InvalidInput, match=r"measured\.json"):
        read(tmp_path / "measured.json")


def test_what_is_shipped_serves_static_scenes():
    assert {m.kind for m in shipped().measurements} >= {"radii", "equilibrium"}
    for accuracy in (1e-2, 1e-4, 1e-6):
        found = choose(SCENE, accuracy)
        assert found.expected_error <= accuracy
        assert 2 * found.reached > found.evidence.scenes


def test_a_table_of_nanometres_on_a_half_space_has_a_rough_radius():
    """Found by random scenes: every trial radius lay beyond the end of the table."""
    indenter = Tabulated(radii=np.linspace(0.0, 1e-10, 5), heights=np.linspace(0.0, 1e-5, 5) ** 2)
    layer = Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.3)
    scene = Scene(layer=layer, indenter=indenter, loading=IndentationDepths([1e-11]))
    assert 0.0 < rough_radius(scene) < 1e-10
