"""Force curves: the master curve is the solver's, fits find what made the data, and intervals hold as often as said."""

import numpy as np
import pytest

from contact import (
    Adhesion,
    Cone,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    Layer,
    NormalForces,
    Paraboloid,
    Scene,
    Sphere,
)
from mdr import Mdr
from mdr.curves import ForceCurve, fit_curve, fit_map, formulas_for

GEL = Layer(thickness=5e-6, youngs_modulus=5e3, poissons_ratio=0.5)
SCENE = Scene(layer=GEL, indenter=Sphere(radius=10e-6), loading=IndentationDepths([2.5e-6]))
DEPTH = np.linspace(-0.5e-6, 1.87e-6, 126)
TIPS = (Sphere(radius=1e-5), Paraboloid(radius_of_curvature=1e-5), Cone(slope=0.5), FlatPunch(radius=1e-6))


@pytest.mark.parametrize("tip", TIPS, ids=lambda t: type(t).__name__)
@pytest.mark.parametrize("support", ["bonded", "unbonded"])
def test_the_master_curve_is_the_solvers_within_its_stated_error(tip, support):
    scene = SCENE.replace(indenter=tip, layer=GEL.replace(support=support, poissons_ratio=0.4))
    curve = ForceCurve(scene)
    depth = 2.5e-6 * np.sort(np.random.default_rng(1).uniform(0.0, 1.0, 60)) ** 2 + 3e-11
    solved = Mdr().solve(scene.replace(loading=IndentationDepths(depth)))
    assert np.abs(curve(depth) / solved.normal_force - 1.0).max() <= curve.error < 1e-7
    assert curve([-1e-6, 0.0]).tolist() == [0.0, 0.0]


def test_a_curve_is_linear_in_the_modulus_and_says_how_far_it_reaches():
    curve = ForceCurve(SCENE)
    np.testing.assert_allclose(curve(DEPTH, 1e4), 2 * curve(DEPTH), rtol=1e-15)
    with pytest.raises(InvalidInput, match=r"this curve reaches 2\.5e-06 m"):
        curve(3e-6)
    with pytest.raises(InvalidInput, match="prescribes indentation depths"):
        ForceCurve(SCENE.replace(loading=NormalForces([1e-9])))


def test_formulas_are_those_of_their_papers():
    """Dimitriadis 2002 gives 1.133, 1.283, 0.769, 0.0975 bonded and 0.884, 0.781, 0.386, 0.0048 not bonded."""
    found = {f.name: f for f in formulas_for(SCENE)}
    assert found["Dimitriadis"].coefficients == pytest.approx((1, 1.133, 1.283, 0.769, 0.0975), rel=1e-3, abs=0.0)
    loose = {f.name: f for f in formulas_for(SCENE.replace(layer=GEL.replace(support="unbonded")))}
    assert loose["Dimitriadis"].coefficients == pytest.approx((1, 0.884, 0.781, 0.386, 0.0048), rel=5e-3, abs=0.0)
    assert set(found) == {"Hertz", "Dimitriadis", "Garcia"}


@pytest.mark.parametrize("tip", TIPS, ids=lambda t: type(t).__name__)
def test_formulas_agree_with_the_solver_where_they_hold(tip):
    """At a/h = 0.02 all corrections are below 3 %, and their first coefficients right to 1 % of themselves."""
    small = 1e-4 if not isinstance(tip, FlatPunch) else 1.0
    thin = SCENE.replace(indenter=tip if small < 1 else FlatPunch(radius=1e-7))
    depth = np.array([{"Cone": 5e-8}.get(type(tip).__name__, 1e-9)])
    exact = ForceCurve(thin).per_modulus(depth)
    found = formulas_for(thin)
    assert len(found) >= 2
    for formula in found[1:]:
        assert formula.per_modulus(depth) == pytest.approx(exact, rel=1e-3, abs=0.0), formula.name


def noisy(scatter, count=1, seed=20261122, spread=0.0):
    """Moduli, contact points and forces of random curves, scatter relative to the largest force."""
    draw = np.random.default_rng(seed)
    modulus = 5e3 * np.exp(spread * draw.standard_normal(count))
    point = draw.uniform(-2e-7, 2e-7, count)
    clean = modulus[:, None] * ForceCurve(SCENE).per_modulus(DEPTH - point[:, None])
    return modulus, point, clean + scatter * clean.max(axis=1, keepdims=True) * draw.standard_normal(clean.shape)


def test_a_curve_without_scatter_gives_its_modulus_back():
    modulus, point, force = noisy(0.0)
    found = fit_curve(SCENE, DEPTH, force[0], parameters=("youngs_modulus", "contact_point", "baseline"))
    assert found.youngs_modulus == pytest.approx(modulus[0], rel=1e-7, abs=0.0)
    assert found.values["contact_point"] == pytest.approx(point[0], rel=0.0, abs=1e-14)
    assert found.interval("youngs_modulus")[0] <= modulus[0] <= found.interval("youngs_modulus")[1]


def test_the_story_hertz_is_five_times_off_and_this_is_not():
    """Without scatter: 5 kPa comes back; Hertz finds 23.7 kPa and Dimitriadis 5.49 kPa on the same curve."""
    found = fit_curve(SCENE, DEPTH, ForceCurve(SCENE)(DEPTH), parameters=("youngs_modulus", "contact_point"))
    biases = {fit.formula.name: fit.bias for fit in found.formulas}
    assert found.youngs_modulus == pytest.approx(5e3, rel=1e-8, abs=0.0)
    assert biases["Hertz"] == pytest.approx(3.74, rel=0.0, abs=0.02)
    assert biases["Dimitriadis"] == pytest.approx(0.098, rel=0.0, abs=0.002)


def test_intervals_hold_as_often_as_they_say():
    """Of 1000 curves 95 % within three standard deviations of a binomial, 2.1 %."""
    modulus, _, force = noisy(0.01, count=1000, spread=0.5)
    told = []
    found = fit_map(SCENE, DEPTH, force, progress=lambda done, total: told.append((done, total)))
    low, high = found.interval
    assert found.converged.all()
    assert 0.929 <= np.mean((low <= modulus) & (modulus <= high)) <= 0.971
    assert told[-1] == (1000, 1000)


@pytest.mark.slow
def test_thickness_and_modulus_that_cannot_be_told_apart_are_named():
    _, _, force = noisy(0.01)
    found = fit_curve(SCENE, DEPTH, force[0], parameters=("youngs_modulus", "contact_point", "thickness"))
    assert "thickness and youngs_modulus can hardly be told apart" in "\n".join(found.warnings)
    low, high = found.interval("thickness")
    assert low <= 5e-6 <= high
    exact = fit_curve(SCENE, DEPTH, ForceCurve(SCENE)(DEPTH), parameters=("youngs_modulus", "thickness"))
    assert exact.values["thickness"] == pytest.approx(5e-6, rel=1e-4, abs=0.0)


def test_work_of_adhesion_from_a_curve_of_withdrawal():
    adhering = SCENE.replace(effects=(Adhesion(work_of_adhesion=1e-4),))
    depth = np.linspace(-1e-7, 2e-6, 60)
    path = Mdr().solve(adhering.replace(loading=IndentationDepths(depth)))
    guess = SCENE.replace(effects=(Adhesion(work_of_adhesion=3e-4),))
    found = fit_curve(guess, depth, path.normal_force, parameters=("youngs_modulus", "work_of_adhesion"))
    assert found.youngs_modulus == pytest.approx(5e3, rel=1e-4, abs=0.0)
    assert found.values["work_of_adhesion"] == pytest.approx(1e-4, rel=1e-3, abs=0.0)
    assert found.formulas == ()
    misfit = np.abs(found.fitted - path.normal_force).max() / path.normal_force.max()
    assert misfit < 10 * found.numerical_error < 1e-4


def test_numbers_in_a_band_hold_the_true_curve():
    _, point, force = noisy(0.02, seed=3)
    found = fit_curve(SCENE, DEPTH, force[0])
    true = ForceCurve(SCENE)(DEPTH - point[0])
    assert np.mean(np.abs(found.fitted - true) <= found.band) > 0.6
    assert np.abs(found.fitted - true).max() <= 2.5 * found.band.max()


@pytest.mark.parametrize(
    ("depth", "force", "options", "message"),
    [
        ([0.0, 1.0], [0.0], {}, "one force for each depth"),
        ([0.0, 1e-6, 2e-6, 3e-6, 4e-6], [0.0, np.nan, 1.0, 2.0, 3.0], {}, "finite numbers"),
        ([-1e-6, -2e-6, -3e-6], [0.0, 1.0, 2.0], {"parameters": ("youngs_modulus",)}, "grow beyond 0"),
        (DEPTH, DEPTH, {"parameters": ("contact_point",)}, "fit youngs_modulus, and any of"),
        (DEPTH, DEPTH, {"parameters": ("youngs_modulus", "colour")}, "fit youngs_modulus, and any of"),
        (DEPTH, DEPTH, {"parameters": ("youngs_modulus", "work_of_adhesion")}, "list Adhesion among the effects"),
    ],
)
def test_what_is_no_curve_is_refused(depth, force, options, message):
    with pytest.raises(InvalidInput, match=message):
        fit_curve(SCENE, depth, force, **options)


def test_what_is_no_map_is_refused():
    for depth, force, message in (
        (DEPTH, DEPTH, "one row per curve"),
        (DEPTH[None], np.zeros((2, DEPTH.size)), "one depth for each force"),
    ):
        with pytest.raises(InvalidInput, match=message):
            fit_map(SCENE, depth, force)


def test_a_curve_of_noise_has_no_modulus_and_is_no_number():
    """A flat curve that pulls: nothing presses, and the reason is given."""
    found = fit_map(SCENE, DEPTH, -np.ones((1, DEPTH.size)))
    assert not found.converged[0]
    assert np.isnan(found.youngs_modulus[0])
    assert "no contact in the curve" in found.reasons[0]
