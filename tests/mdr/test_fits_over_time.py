"""Fits of relaxation, creep and withdrawal over time: the model is the solver's, and intervals hold."""

import numpy as np
import pytest

from contact import (
    Adhesion,
    DepthHistory,
    ForceHistory,
    InvalidInput,
    KelvinVoigt,
    Layer,
    Paraboloid,
    PronySeries,
    Scene,
    StandardSolid,
)
from mdr import Mdr
from mdr.curves import fit_history
from reports.command_line import run

LAYER = Layer(thickness=10e-6, youngs_modulus=9e3, poissons_ratio=0.5)
TIME = np.concatenate([np.linspace(0, 1, 40), np.linspace(1, 6, 90)[1:], np.linspace(6, 7.5, 50)[1:]])
DEPTH = np.interp(TIME, [0, 1, 6, 7.5], [0, 5e-7, 5e-7, 0])
HOLD = int(np.searchsorted(TIME, 6.0)) + 1
FORCE = np.interp(TIME[:HOLD], [0, 1, 6], [0, 1e-8, 1e-8])
SOLID = StandardSolid(long_term_shear_modulus=1e3, maxwell_shear_modulus=2e3, viscosity=2e3)
PRONY = PronySeries(long_term_shear_modulus=1e3, shear_moduli=[1e3, 1e3], relaxation_times=[0.2, 3.0])
VOIGT = KelvinVoigt(shear_modulus=3e3, viscosity=1.5e3)
# First guesses far from these: other moduli and times.
GUESSES = {
    SOLID: StandardSolid(long_term_shear_modulus=2.9e3, maxwell_shear_modulus=1e2, viscosity=1e2),
    PRONY: PronySeries(long_term_shear_modulus=1e3, shear_moduli=[1e3, 1e3], relaxation_times=[0.01, 0.02]),
    VOIGT: KelvinVoigt(shear_modulus=3e3, viscosity=1.0),
}


def scene(effect, loading):
    return Scene(layer=LAYER, indenter=Paraboloid(radius_of_curvature=5e-6), loading=loading, effects=(effect,))


@pytest.fixture(scope="module")
def relaxed():
    """Force [N] of each solid under DEPTH, by the solver of histories."""
    return {
        effect: Mdr(accuracy=1e-6).solve(scene(effect, DepthHistory(time=TIME, depth=DEPTH))).normal_force
        for effect in (SOLID, PRONY)
    }


TRUE = {
    SOLID: {"long_term_shear_modulus": 1e3, "maxwell_shear_modulus": 2e3, "relaxation_time": 1.0},
    PRONY: {
        "long_term_shear_modulus": 1e3,
        "shear_moduli[0]": 1e3,
        "shear_moduli[1]": 1e3,
        "relaxation_times[0]": 0.2,
        "relaxation_times[1]": 3.0,
    },
    VOIGT: {"shear_modulus": 3e3, "viscosity": 1.5e3},
}


@pytest.mark.first(1)
@pytest.mark.parametrize(("effect", "end"), [(SOLID, HOLD), (PRONY, TIME.size)], ids=["hold", "withdrawal"])
def test_force_over_time_gives_the_moduli_and_times_that_made_it(effect, end, relaxed):
    """Contact point and baseline are shifted, and fitted."""
    guess = scene(GUESSES[effect], DepthHistory(time=[0, 1], depth=[0, 1e-7]))
    found = fit_history(guess, TIME[:end], DEPTH[:end] + 3e-8, relaxed[effect][:end] + 1e-9)
    for name, value in TRUE[effect].items():
        assert found.values[name] == pytest.approx(value, rel=5e-3, abs=0.0), name
    assert found.values["contact_point"] == pytest.approx(3e-8, rel=0.0, abs=1e-10)


@pytest.mark.parametrize("effect", [SOLID, PRONY, VOIGT], ids=["solid", "prony", "voigt"])
def test_depth_over_time_gives_the_moduli_and_times_that_made_it(effect):
    loading = ForceHistory(time=TIME[:HOLD], force=FORCE)
    depth = Mdr(accuracy=1e-5).solve(scene(effect, loading)).indentation_depth
    names = ("moduli", "times", "contact_point")
    found = fit_history(scene(GUESSES[effect], loading), TIME[:HOLD], depth - 2e-8, FORCE, parameters=names)
    for name, value in TRUE[effect].items():
        assert found.values[name] == pytest.approx(value, rel=5e-3, abs=0.0), name
    assert found.response == "depth"


@pytest.mark.slow
def test_times_that_are_kept_are_not_fitted_and_another_solid_warns(relaxed):
    kept = PRONY.replace(shear_moduli=[1.9e3, 0.1e3])
    loading = DepthHistory(time=[0, 1], depth=[0, 1e-7])
    found = fit_history(scene(kept, loading), TIME, DEPTH, relaxed[PRONY], parameters=("moduli", "contact_point"))
    assert "relaxation_times[0]" not in found.values
    assert found.values["shear_moduli[1]"] == pytest.approx(1e3, rel=5e-3, abs=0.0)
    other = fit_history(scene(SOLID, loading), TIME, DEPTH, relaxed[PRONY])
    assert any("residuals are not noise" in line for line in other.warnings)


def test_a_normalised_table_is_kept_and_its_scale_fitted(relaxed):
    """G(t)/G_0 in pascals: 1/3, 1/3 and 1/3."""
    third = PronySeries(long_term_shear_modulus=1 / 3, shear_moduli=[1 / 3, 1 / 3], relaxation_times=[0.2, 3.0])
    layer = LAYER.replace(youngs_modulus=3.0)
    guess = scene(PRONY, DepthHistory(time=[0, 1], depth=[0, 1e-7])).replace(layer=layer, effects=(third,))
    found = fit_history(guess, TIME, DEPTH, relaxed[PRONY], parameters=("scale", "contact_point", "baseline"))
    assert found.values["instantaneous_shear_modulus"] == pytest.approx(3e3, rel=1e-4, abs=0.0)


def test_the_scale_of_a_solid_with_a_dashpot_scales_the_dashpot_too():
    loading = ForceHistory(time=TIME[:HOLD], force=FORCE)
    depth = Mdr(accuracy=1e-5).solve(scene(VOIGT, loading)).indentation_depth
    doubled = KelvinVoigt(shear_modulus=2 * VOIGT.shear_modulus, viscosity=2 * VOIGT.viscosity)
    guess = scene(VOIGT, loading).replace(layer=LAYER.replace(youngs_modulus=18e3), effects=(doubled,))
    found = fit_history(guess, TIME[:HOLD], depth, FORCE, parameters=("scale", "contact_point"))
    assert found.values["instantaneous_shear_modulus"] == pytest.approx(3e3, rel=1e-3, abs=0.0)


def test_the_interval_of_a_relaxation_time_does_not_depend_on_the_unit_of_time():
    """The logarithm of a relaxation time of one unit vanishes; intervals of times and moduli are compared."""
    ratios = []
    for unit in (1.0, 3.0):
        solid = StandardSolid(long_term_shear_modulus=1e3, maxwell_shear_modulus=2e3, viscosity=2e3 * unit)
        loading = ForceHistory(time=unit * TIME[:HOLD], force=FORCE)
        depth = Mdr(accuracy=1e-5).solve(scene(solid, loading)).indentation_depth
        found = fit_history(scene(solid, loading), unit * TIME[:HOLD], depth, FORCE, parameters=("moduli", "times"))
        errors = found.standard_error
        ratios.append(errors["relaxation_time"] / unit / errors["maxwell_shear_modulus"])
    assert ratios[0] == pytest.approx(ratios[1], rel=1e-2, abs=0.0)


SCENE_FILE = """layer = {thickness = "10 um", youngs_modulus = "9 kPa", poissons_ratio = 0.5}
indenter = {kind = "paraboloid", radius_of_curvature = "5 um"}
loading = {kind = "depth_history", time = ["0 s", "1 s"], depth = ["0 nm", "100 nm"]}
[[effects]]
kind = "standard_solid"
long_term_shear_modulus = "2 kPa"
maxwell_shear_modulus = "1 kPa"
viscosity = "1 kPa s"
"""


@pytest.mark.slow
def test_the_command_fits_a_table_with_times_and_writes_every_number(tmp_path, capsys, relaxed):
    scene_file, curve, table = tmp_path / "solid.toml", tmp_path / "curve.csv", tmp_path / "fit.csv"
    scene_file.write_text(SCENE_FILE)
    lines = [f"{t},{1e9 * d},{1e9 * f}" for t, d, f in zip(TIME, DEPTH, relaxed[SOLID], strict=True)]
    curve.write_text("\n".join(["time [s],depth [nm],force [nN]", *lines]))
    assert run(["fit", str(curve), str(scene_file), "--write", str(table), "--write", str(tmp_path / "a.svg")]) == 0
    out = capsys.readouterr().out
    assert "relaxation time" in out
    found = np.genfromtxt(table, delimiter=",", names=True, deletechars="")
    assert found["maxwell_shear_modulus_[Pa]"][0] == pytest.approx(2e3, rel=5e-3, abs=0.0)
    assert (
        found["relaxation_time_low_[s]"][0] <= found["relaxation_time_[s]"][0] == pytest.approx(1.0, rel=5e-3, abs=0.0)
    )
    assert run(["fit", str(curve), str(scene_file), "--fit", "moduli", "--with", "contact_point"]) == 0
    assert "relaxation time" not in capsys.readouterr().out
    assert run(["fit", str(curve), str(scene_file), "--map"]) == 4
    assert "fit single curves" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("changes", "arrays", "message"),
    [
        ({"layer": LAYER.replace(poissons_ratio=0.4, youngs_modulus=8.4e3)}, {}, r"poissons_ratio = 0\.4: .* finite"),
        ({"effects": (Adhesion(work_of_adhesion=1e-4),)}, {}, "list one of KelvinVoigt"),
        ({}, {"time": TIME[::-1]}, "times have to increase"),
        ({}, {"depth": DEPTH * np.cos(TIME * 4) ** 2}, "grows again after it has fallen"),
        (
            {"loading": ForceHistory(time=[0, 1], force=[0, 1e-9])},
            {"force": 0.02 * DEPTH},
            "the force falls from point",
        ),
    ],
)
def test_other_histories_are_refused_with_the_remedy(changes, arrays, message):
    one = scene(SOLID, DepthHistory(time=[0, 1], depth=[0, 1e-7])).replace(**changes)
    with pytest.raises(InvalidInput, match=message):
        fit_history(one, **({"time": TIME, "depth": DEPTH, "force": 0.02 * DEPTH} | arrays))
