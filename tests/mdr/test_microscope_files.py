"""Curves from files of microscopes, written by afmformats itself and read back; and layers as models of nanite."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from contact import IndentationDepths, InvalidInput, Layer, Paraboloid, Scene
from examples.pyjibe_layer import layer_model
from mdr.curves import ForceCurve, fit_curve, read_curve, read_map
from mdr.curves.reading import Cantilever
from reports.command_line import run

ROOT = Path(__file__).parents[2]
INTERPRETER = os.environ.get("CONTACT_REFEREES_PYTHON") or sys.executable
GEL = Layer(thickness=5e-6, youngs_modulus=5e3, poissons_ratio=0.5)
SCENE = Scene(layer=GEL, indenter=Paraboloid(radius_of_curvature=1e-5), loading=IndentationDepths([2e-6]))
CANTILEVER = 0.05


def written(folder, ending, scatter=1e-11):
    """A curve of E = 5 kPa as a microscope stores it: piezo height [m] that falls, force [N] with a constant."""
    afmformats = pytest.importorskip("afmformats")
    tip = np.linspace(4e-6, -1.5e-6, 400)
    force = ForceCurve(SCENE)(-tip)
    noise = scatter * np.random.default_rng(21).standard_normal(force.size)
    height = tip - force / CANTILEVER
    both = {"force": force + noise + 2e-10, "height (measured)": height}
    columns = {name: np.concatenate([values, values[::-1]]) for name, values in both.items()}
    columns["segment"] = np.repeat([0, 1], tip.size).astype(np.uint8)
    file = folder / f"curve{ending}"
    metadata = {"spring constant": CANTILEVER, "imaging mode": "force-distance", "enum": 0, "path": file}
    measured = afmformats.AFMForceDistance(columns, metadata)
    measured.export_data(file, metadata=True, fmt={".h5": "hdf5", ".tab": "tab"}[ending])
    return file


@pytest.mark.parametrize("ending", [".h5", ".tab"])
def test_a_curve_of_a_microscope_gives_its_modulus_back(tmp_path, ending):
    depth, force = read_curve(written(tmp_path, ending))
    assert np.all(np.diff(depth) > 0.0)
    found = fit_curve(SCENE, depth, force, parameters=("youngs_modulus", "contact_point", "baseline"))
    low, high = found.interval("youngs_modulus")
    # The bending of the cantilever carries the noise into the depth, which least squares take for exact.
    assert found.youngs_modulus == pytest.approx(5e3, rel=1e-3, abs=0.0)
    assert high - low < 100.0


def test_tables_of_afm_workshop_and_nt_mdt_need_the_cantilever(tmp_path):
    pytest.importorskip("afmformats")
    depth = np.linspace(-2e-6, 1.5e-6, 300)
    force = ForceCurve(SCENE)(depth)
    way, volts = depth + force / CANTILEVER, force / CANTILEVER / 50e-9
    workshop, nova = tmp_path / "curve.csv", tmp_path / "nova.txt"
    heads = ["Force-Distance Curve", "Mode: Single", "Point: 1", "X, um: 2.5", "Y, um: 3.5"]
    heads += ["Extend Z-Sense(nm),Extend T-B(V),Retract Z-Sense(nm),Retract T-B(V)"]
    rows = [f"{1e9 * z:.5f},{v:.7f},{1e9 * z:.5f},{v:.7f}" for z, v in zip(way, volts, strict=True)]
    workshop.write_text("\n".join([*heads, *rows]))
    nova.write_text("\n".join(f"{-1e9 * z:.5f}\t{1e9 * v:.4f}\t{1e9 * v:.4f}" for z, v in zip(way, volts, strict=True)))
    for file in (workshop, nova):
        with pytest.raises(InvalidInput, match=r"--spring-constant|--units"):
            read_curve(file)
        found = fit_curve(SCENE, *read_curve(file, cantilever=Cantilever(CANTILEVER, 50e-9)))
        assert found.youngs_modulus == pytest.approx(5e3, rel=1e-3, abs=0.0)
    (curve,) = read_map(workshop, cantilever=Cantilever(CANTILEVER, 50e-9))
    assert curve.position == pytest.approx((2.5e-6, 3.5e-6), rel=1e-12, abs=0.0)


def test_the_command_reads_it_too(tmp_path, capsys):
    scene = tmp_path / "gel.toml"
    scene.write_text(
        "layer = {thickness = 5e-6, youngs_modulus = 1e3, poissons_ratio = 0.5}\n"
        'indenter = {kind = "paraboloid", radius_of_curvature = 1e-5}\n'
        'loading = {kind = "indentation_depths", values = [1e-6]}\n'
    )
    file = written(tmp_path, ".h5")
    assert run(["fit", str(file), str(scene), "--with", "contact_point,baseline"]) == 0
    assert "kPa" in capsys.readouterr().out
    assert run(["fit", str(file), str(scene), "--curve", "3"]) == 4
    assert "has no curve 3; it has 1" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda folder: folder / "nothing.jpk-force", "no such file"),
        (lambda folder: _garbage(folder / "a.jpk-force"), "afmformats cannot read it"),
        (lambda folder: _garbage(folder / "a.h5"), "afmformats cannot read it"),
    ],
)
def test_what_cannot_be_read_is_refused_in_one_line(tmp_path, make, message):
    pytest.importorskip("afmformats")
    with pytest.raises(InvalidInput, match=message):
        read_curve(make(tmp_path))


def _garbage(file):
    file.write_bytes(b"no curve")
    return file


def test_a_contact_before_the_first_depth_is_fitted():
    """The fit may look for the contact point before the first depth: the master curve has to reach that far."""
    depth = np.linspace(-1e-6, 1e-8, 60)
    force = ForceCurve(SCENE)(depth + 1.48e-6)
    found = fit_curve(SCENE, depth, force, parameters=("youngs_modulus", "contact_point"))
    assert found.values["contact_point"] == pytest.approx(-1.48e-6, rel=1e-4, abs=0.0)


def test_models_are_the_solver():
    for tip, number in (("paraboloid", 1e-5), ("sphere", 1e-5), ("cone", 45.0)):
        model = layer_model(tip, "bonded")
        force = model.model_func(-np.array([1e-6, -1e-6]), 5e3, number, 0.5, 5e-6, 0.0, 1e-9)
        assert force[1] == 1e-9
        assert force[0] > 2e-9
    paraboloid = layer_model("paraboloid", "bonded").model_func
    ours = paraboloid(np.array([-1.5e-6]), E=5e3, R=1e-5, nu=0.5, h=5e-6, contact_point=0.0, baseline=0.0)
    assert ours[0] == pytest.approx(float(ForceCurve(SCENE)(1.5e-6)), rel=1e-8, abs=0.0)
    with pytest.raises(InvalidInput, match="paraboloid, sphere, cone"):
        layer_model("punch", "bonded")


IN_NANITE = """
import sys, warnings
warnings.simplefilter("ignore")
import nanite
from mdr.curves.reading import Cantilever
from examples.pyjibe_layer import register
register()
curve = nanite.load_group(sys.argv[1])[0]
curve.apply_preprocessing(["compute_tip_position", "correct_force_offset", "correct_tip_offset"])
for key in ("hertz_para", "layer_paraboloid_bonded"):
    start = nanite.model.models_available[key].get_parameter_defaults()
    start["R"].value = 1e-5
    curve.fit_model(model_key=key, params_initial=start, weight_cp=0)
    print(curve.fit_properties["success"], curve.fit_properties["params_fitted"]["E"].value)
extension = nanite.model.load_model_from_file(sys.argv[2], register=True)
print(extension.model_key)
"""


def test_nanite_fits_a_curve_with_the_layer(tmp_path):
    asked = subprocess.run([INTERPRETER, "-c", "import nanite"], capture_output=True, check=False)
    if asked.returncode:
        pytest.skip("nanite is not installed; CONTACT_REFEREES_PYTHON may name an interpreter that has it")
    file = written(tmp_path, ".h5")
    done = subprocess.run(
        [INTERPRETER, "-c", IN_NANITE, str(file), str(ROOT / "examples" / "pyjibe_layer.py")],
        capture_output=True,
        text=True,
        check=False,
        cwd=ROOT,
    )
    assert done.returncode == 0, done.stderr
    (_, hertz), (fitted, layer), (key,) = (line.split() for line in done.stdout.splitlines()[-3:])
    assert fitted == "True"
    assert float(layer) == pytest.approx(5e3, rel=0.02, abs=0.0)
    assert float(hertz) > 1.5 * 5e3
    assert key == "layer_paraboloid_bonded"
