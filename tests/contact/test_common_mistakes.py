"""The twenty most common mistakes in scene files: each message has the place, the value and the remedy."""

import pytest

from contact import InvalidInput, load_scene

GOOD = """
[layer]
thickness = "5 um"
youngs_modulus = "5 kPa"
poissons_ratio = 0.5
support = "bonded"
[indenter]
kind = "sphere"
radius = "10 um"
[loading]
kind = "indentation_depths"
values = ["100 nm", "200 nm"]
[[effects]]
kind = "adhesion"
work_of_adhesion = "0.1 mJ/m^2"
"""
VALUES = 'values = ["100 nm", "200 nm"]'
EFFECT = '[[effects]]\nkind = "adhesion"\nwork_of_adhesion = "0.1 mJ/m^2"'

# Mistake: the line as it should be, as it is written, and the message, which names place, value and remedy.
MISTAKES = {
    "a misspelled field": (
        "thickness =",
        "thicknes =",
        "layer.thicknes = '5 um': no such field; write thickness instead",
    ),
    "a symbol for a name": (
        "youngs_modulus =",
        "E =",
        "layer.E = '5 kPa': no such field; write youngs_modulus instead",
    ),
    "base for support": ("support =", "base =", "layer.base = 'bonded': no such field; write support instead"),
    "a missing field": ("poissons_ratio = 0.5", "", "layer.poissons_ratio is missing; add it"),
    "a negative modulus": (
        '"5 kPa"',
        '"-5 kPa"',
        "layer.youngs_modulus = '-5 kPa': must be positive and finite; give the modulus in pascals",
    ),
    "nu above 1/2": (
        "= 0.5",
        "= 0.6",
        "layer.poissons_ratio = 0.6: must lie in [0, 0.5]; Poisson's ratio is 0.5 for incompressible materials",
    ),
    "nu in percent": ("= 0.5", '= "50 %"', "layer.poissons_ratio = '50 %': must be a number; Poisson's ratio is 0.5"),
    "a unit of another kind": (
        '"5 um"',
        '"5 kPa"',
        "layer.thickness = '5 kPa': must be a length; write a number in m, or as in \"5 um\"",
    ),
    "an unknown unit": (
        '"10 um"',
        '"10 micorn"',
        "indenter.radius = '10 micorn': the unit 'micorn' is not known, must be a length",
    ),
    "a comma for a point": (
        '"5 um"',
        '"5,0 um"',
        "layer.thickness = '5,0 um': must be a number; give the thickness in metres",
    ),
    "one number without its unit": (
        '"10 um"',
        "1e-5",
        "indenter.radius = 1e-05: no unit, but other numbers of this scene have one ('5 um')",
    ),
    "an unknown support": ('"bonded"', '"glued"', "layer.support = 'glued': Input should be 'bonded' or 'unbonded'"),
    "an unknown indenter": ('"sphere"', '"ball"', "indenter.kind = 'ball': must be one of cone, "),
    "no kind": ('kind = "sphere"', "", "indenter.kind = None: must be one of cone, "),
    "a field of another indenter": (
        "radius =",
        "radius_of_curvature =",
        "indenter.radius_of_curvature = '10 um': no such field; remove it or correct its spelling (there are radius)",
    ),
    "a text in a list": (
        VALUES,
        'values = ["100 nm", "deep"]',
        "loading.values = ['100 nm', 'deep']: must be a number; give indentation depths in metres",
    ),
    "an empty list": (VALUES, "values = []", "loading.values = []: must hold at least one number"),
    "a range without its count": (
        VALUES,
        'values = {start = "0 nm", stop = "200 nm"}',
        "loading.values.count is missing; a range is written {start = 0, stop = 1e-6, count = 20}",
    ),
    "a column of no file": (
        VALUES,
        'values = {file = "depths.csv"}',
        "depths.csv: cannot be read (No such file or directory); check the path",
    ),
    "[effects] for [[effects]]": ("[[effects]]", "[effects]", "must be a list of tables; write [[effects]]"),
    "the same effect twice": (
        EFFECT,
        f"{EFFECT}\n{EFFECT}",
        "effects = Adhesion, Adhesion: each effect, and one viscoelastic model, may stand only once",
    ),
    "pulling without adhesion": (
        f"{VALUES}\n{EFFECT}",
        'values = "-100 nm"',
        "loading.values = -1e-07: without adhesion only positive values press; list Adhesion or press",
    ),
    "a misspelled table": ("[layer]", "[layers]", "no such field; write layer instead"),
    "a bracket that is not closed": ("[layer]", "[layer", "not valid TOML: "),
}


def message_of(tmp_path, text):
    file = tmp_path / "scene.toml"
    file.write_text(text)
    with pytest.raises(InvalidInput) as caught:
        load_scene(file)
    assert str(file) in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_common_mistake_is_named_with_place_value_and_remedy(tmp_path, mistake):
    right, wrong, message = MISTAKES[mistake]
    assert right in GOOD
    assert message in message_of(tmp_path, GOOD.replace(right, wrong, 1))


def test_several_mistakes_are_named_at_once(tmp_path):
    several = (
        "a misspelled field",
        "a negative modulus",
        "nu above 1/2",
        "a field of another indenter",
        "a text in a list",
    )
    text = GOOD
    for right, wrong, _ in map(MISTAKES.get, several):
        text = text.replace(right, wrong, 1)
    message = message_of(tmp_path, text)
    for mistake in several:
        assert MISTAKES[mistake][2] in message
