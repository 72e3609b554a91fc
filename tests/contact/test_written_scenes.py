"""Scenes as people write them: units, ranges, columns of files, half angles, one modulus, all errors at once."""

import math
import subprocess
import sys
import tomllib
from dataclasses import fields

import jsonschema
import numpy as np
import pytest

from contact import (
    Cone,
    IndentationDepths,
    InvalidInput,
    KelvinVoigt,
    Layer,
    Pyramid,
    Scene,
    Tabulated,
    TruncatedCone,
    load_scene,
    scene_from_mapping,
    scene_to_mapping,
)
from contact.files.scene_file import scene_schema
from contact.records.record import unit_of
from contact.records.units import MEASURES, in_si
from contact.scene.effects import EFFECTS
from contact.scene.graded_layer import DEPTH_FUNCTIONS
from contact.scene.layer import ElasticBase, Sublayer
from contact.scene.loading import LOADINGS
from contact.scene.profiles import PROFILES
from contact.scene.shapes import SHAPES, Harmonic

LAYER = {"thickness": "5 um", "youngs_modulus": "5 kPa", "poissons_ratio": 0.5}
TIP = {"kind": "sphere", "radius": "10 um"}
PRESS = {"kind": "indentation_depths", "values": ["100 nm", "200 nm"]}
PURE_NUMBERS = {
    "poissons_ratio",
    "slope",
    "exponent",
    "coefficient",
    "support",
    "control",
    "interface",
    "sides",
    "order",
    "share",
    "profile",
    "terms",
}


def scene(layer=LAYER, indenter=TIP, loading=PRESS, effects=(), folder=None):
    mapping = {"layer": layer, "indenter": indenter, "loading": loading, "effects": list(effects)}
    return scene_from_mapping(mapping, folder)


def test_units_give_the_very_numbers_that_si_gives():
    plain = scene(
        {"thickness": 5e-6, "youngs_modulus": 5e3, "poissons_ratio": 0.5},
        {"kind": "sphere", "radius": 1e-5},
        {"kind": "indentation_depths", "values": [1e-7, 2e-7]},
    )
    assert scene() == plain


def test_every_field_with_a_unit_takes_one_and_every_unit_has_words():
    for cls in (Layer, Sublayer, ElasticBase, *PROFILES, *SHAPES, Harmonic, *LOADINGS, *EFFECTS, *DEPTH_FUNCTIONS):
        for field in fields(cls):
            unit = unit_of(cls, field.name)
            assert unit is not None or field.name in PURE_NUMBERS, f"{cls.__name__}.{field.name}"
            if unit is not None:
                assert isinstance(in_si(MEASURES[unit][1], unit), float)


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ("5", r"layer\.thickness = '5': must be a number"),
        ("9**9**9**9 m", r"must be a number"),
        ("1e999 m", r"layer\.thickness"),
    ],
)
def test_a_wrong_unit_is_told_in_the_users_words(value, message):
    with pytest.raises(InvalidInput, match=message):
        scene(layer=LAYER | {"thickness": value})


def test_ranges_have_both_ends():
    even = scene(loading=PRESS | {"values": {"start": 0, "stop": "2 um", "count": 5}}).loading.values
    assert even.tolist() == [0.0, 5e-7, 1e-6, 1.5e-6, 2e-6]
    factors = scene(loading=PRESS | {"values": {"start": "1 nm", "stop": "1 um", "count": 4, "spacing": "log"}})
    assert factors.loading.values == pytest.approx([1e-9, 1e-8, 1e-7, 1e-6], rel=1e-14, abs=0.0)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"count": 1}, r"loading\.values\.count = 1: must be a whole number from 2"),
        ({"count": 10**9}, r"loading\.values\.count"),
        ({"spacing": "cubic"}, r"loading\.values\.spacing = 'cubic'"),
        ({"spacing": "log"}, "equal factors need ends above 0"),
        ({"stop": "2 kPa"}, r"loading\.values\.stop = '2 kPa': must be a length"),
        ({"stop": None}, r"loading\.values\.stop = None: must be a number; give one up to 1e\+75"),
        ({"stop": 10**400}, r"loading\.values\.stop = 1000.*: must fit into double precision"),
    ],
)
def test_a_wrong_range_is_named(changed, message):
    with pytest.raises(InvalidInput, match=message):
        scene(loading=PRESS | {"values": {"start": 0, "stop": 1e-6, "count": 5} | changed})


def test_columns_of_files_with_units_in_their_heads(tmp_path):
    (tmp_path / "curve.csv").write_text("# measured\ntime [s];depth [nm]\n0;100\n1;200\n", encoding="utf-8")
    values = {"file": "curve.csv", "column": "depth"}
    assert scene(loading=PRESS | {"values": values}, folder=tmp_path).loading == IndentationDepths([1e-7, 2e-7])
    with pytest.raises(InvalidInput, match=r"curve\.csv has no such column; it has time, depth"):
        scene(loading=PRESS | {"values": values | {"column": "force"}}, folder=tmp_path)
    with pytest.raises(InvalidInput, match="only scene files name other files"):
        scene(loading=PRESS | {"values": values})


@pytest.mark.parametrize(
    ("text", "message"),
    [("", "holds no numbers"), ("a,b\n", "holds no numbers"), ("1,2\n3\n", "line 2"), ("1,nan\n", "line 1")],
)
def test_a_file_that_is_no_table_is_named(tmp_path, text, message):
    (tmp_path / "bad.csv").write_text(text)
    with pytest.raises(InvalidInput, match=message):
        scene(loading=PRESS | {"values": {"file": "bad.csv"}}, folder=tmp_path)


def test_a_tip_from_a_file_relative_to_the_scene(tmp_path):
    r = np.linspace(0.0, 2.0, 9)
    rows = "\n".join(f"{x},{x**2 / 20}" for x in r)
    (tmp_path / "tip.csv").write_text(f"r [um],z [um]\n{rows}\n")
    file = tmp_path / "scene.toml"
    file.write_text(
        '[layer]\nhalf_space = true\nyoungs_modulus = "5 kPa"\npoissons_ratio = 0.5\n[indenter]\n'
        'kind = "tabulated"\nfile = "tip.csv"\n[loading]\nkind = "contact_radii"\nvalues = ["1 um"]\n'
    )
    tip = load_scene(file).indenter
    np.testing.assert_allclose(tip.radii, r * 1e-6, rtol=1e-15)
    np.testing.assert_allclose(tip.heights, 1e-6 * r**2 / 20, rtol=1e-15)


def test_half_angles_are_slopes():
    cone = scene(indenter={"kind": "cone", "half_angle": "70 deg"}).indenter
    assert cone == Cone(slope=1 / math.tan(math.radians(70)))
    blunt = scene(indenter={"kind": "truncated_cone", "half_angle": "45 deg", "flat_radius": "1 um"}).indenter
    assert blunt == TruncatedCone(flat_radius=1e-6, slope=1 / math.tan(math.pi / 4))


def test_a_pyramid_is_given_by_the_half_angle_of_its_faces():
    pyramid = scene(indenter={"kind": "pyramid", "half_angle": "35 deg"}).indenter
    assert pyramid == Pyramid(slope=1 / math.tan(math.radians(35)))
    z = 2.0
    side = 2 * z * math.tan(math.radians(35))
    assert math.pi * (z / pyramid.substitute.slope) ** 2 == pytest.approx(side**2, rel=1e-14, abs=0.0)
    assert pyramid.polar(side / 2, [0.0, math.pi / 2]) == pytest.approx(z, rel=1e-14, abs=0.0)
    assert pyramid.polar(side / math.sqrt(2.0), math.pi / 4) == pytest.approx(z, rel=1e-14, abs=0.0)


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ({"kind": "cone", "half_angle": 1.2}, "must be an angle with its unit"),
        ({"kind": "cone", "half_angle": "95 deg"}, "must lie between 0 and 90 degrees"),
        ({"kind": "cone", "half_angle": "35 deg", "slope": 1.0}, "follows from half_angle"),
        ({"kind": "pyramid"}, "slope is missing"),
        ({"kind": "tabulated", "file": "a.csv", "radii": [0, 1]}, "stands in the file already"),
    ],
)
def test_a_wrong_shorthand_is_named(table, message):
    with pytest.raises(InvalidInput, match=message):
        scene(indenter=table)


def test_the_modulus_is_given_once():
    layer = {"thickness": "1 mm", "poissons_ratio": 0.5}
    relaxing = scene(layer, effects=[{"kind": "kelvin_voigt", "shear_modulus": "1 kPa", "viscosity": "2 Pa s"}])
    assert relaxing.layer.youngs_modulus == 3e3
    assert relaxing.effect(KelvinVoigt).viscosity == 2.0
    with pytest.raises(InvalidInput, match=r"layer\.youngs_modulus is missing"):
        scene(layer)


def test_a_tip_is_smoothed_by_no_more_than_it_says():
    rng, r = np.random.default_rng(20261122), np.linspace(0.0, 1e-6, 200)
    exact, noise = r**2 / 2e-6, 2e-9
    rough = Tabulated(radii=r, heights=exact + noise * np.concatenate([[0.0], rng.standard_normal(r.size - 1)]))
    smooth = rough.smoothed(noise=noise)
    assert np.abs(smooth.heights - rough.heights).max() == smooth.smoothing
    assert np.std(smooth.heights - exact) < 0.5 * noise
    press = Scene(
        layer=Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.5),
        indenter=smooth,
        loading=IndentationDepths([1e-8]),
    )
    assert scene_from_mapping(scene_to_mapping(press)) == press
    with pytest.raises(InvalidInput, match="must be a positive length"):
        rough.smoothed(noise=0.0)
    with pytest.raises(InvalidInput, match="too few to smooth"):
        Tabulated(radii=[0.0, 1.0, 2.0], heights=[0.0, 1.0, 2.0]).smoothed(noise=0.1)


def test_smoothing_moves_the_force_by_at_most_what_its_bound_says():
    from mdr import Mdr

    rng, r = np.random.default_rng(5), np.linspace(0.0, 2e-6, 60)
    steep = Tabulated(radii=r, heights=np.concatenate([[0.0], (r[1:] ** 2 / 2e-6) * (1 + 0.002 * rng.random(59))]))
    smooth = steep.smoothed(noise=2e-9)
    layer = Layer(thickness=2e-6, youngs_modulus=5e3, poissons_ratio=0.45)
    one, other = (
        Mdr().solve(Scene(layer=layer, indenter=tip, loading=IndentationDepths([2e-7]))) for tip in (steep, smooth)
    )
    moved = abs(one.normal_force[0] - other.normal_force[0])
    assert 0.0 < moved <= 1.05 * other.contact_stiffness[0] * smooth.smoothing


@pytest.mark.slow
def test_pint_is_loaded_only_where_a_unit_is_met():
    code = (
        "import sys; from contact import scene_from_mapping as s; "
        "m = {'layer': {'half_space': True, 'youngs_modulus': 1.0, 'poissons_ratio': 0.3}, "
        "'indenter': {'kind': 'cone', 'slope': 0.1}, 'loading': {'kind': 'contact_radii', 'values': [1.0]}}; "
        "s(m); print('pint' in sys.modules); "
        "m['loading']['values'], m['layer']['youngs_modulus'] = ['1 m'], '1 Pa'; s(m); print('pint' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, check=True).stdout == b"False\nTrue\n"


def test_the_shorthands_follow_the_schema():
    import jsonschema

    written = tomllib.loads(
        '[layer]\nthickness = "5 um"\nyoungs_modulus = "5 kPa"\npoissons_ratio = 0.5\n[indenter]\nkind = "pyramid"\n'
        'half_angle = "35 deg"\n[loading]\nkind = "indentation_depths"\n'
        'values = {start = 0, stop = "1 um", count = 5}\n'
    )
    jsonschema.validate(written, scene_schema())
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(
            written | {"loading": {"kind": "contact_radii", "values": {"start": 0, "count": 5}}}, scene_schema()
        )


@pytest.mark.parametrize("written", ["5e-6", '"5 um"'])
def test_a_single_value_stands_for_a_list_of_one(tmp_path, written):
    from contact.files.scene_file import scene_schema as schema

    file = tmp_path / "scene.toml"
    units = ("1 mm", "1 MPa", "1 cm") if '"' in written else ("1e-3", "1e6", "1e-2")
    h, modulus, radius = (f'"{value}"' if '"' in written else value for value in units)
    file.write_text(
        f"layer = {{thickness = {h}, youngs_modulus = {modulus}, poissons_ratio = 0.3}}\n"
        f'indenter = {{kind = "sphere", radius = {radius}}}\n'
        f'loading = {{kind = "indentation_depths", values = {written}}}\n'
    )
    assert load_scene(file).loading == IndentationDepths([5e-6]) == IndentationDepths(5e-6)
    jsonschema.validate(tomllib.loads(file.read_text()), schema())
