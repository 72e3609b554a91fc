"""Random scenes are valid, repeatable and cover every kind; other units are another description of the same scene."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from cases.measurements.campaigns.random_scenes import FAMILIES, log_uniform, random_scenes
from cases.measurements.campaigns.units import DIMENSIONS, Units, in_units
from contact import UNITS, Friction, scene_from_mapping, scene_to_mapping
from contact.scene.effects import EFFECTS
from contact.scene.layer import Layer
from contact.scene.loading import LOADINGS
from contact.scene.profiles import PROFILES, Spheroconical


@pytest.mark.parametrize("family", FAMILIES)
def test_random_scenes_are_valid_and_the_same_for_a_seed(family):
    scenes = random_scenes(5, 50, family)
    assert [scene_from_mapping(scene_to_mapping(scene)) for scene in scenes] == scenes
    assert random_scenes(5, 20, family) == scenes[:20]
    assert random_scenes(6, 20, family) != scenes[:20]


def test_every_profile_and_every_way_of_loading_occurs():
    scenes = [scene for family in FAMILIES for scene in random_scenes(1, 100, family)]
    # Spheroconical tips have their own tests: drawing them would change the scenes that coefficients were measured on.
    assert {type(scene.indenter) for scene in scenes} == set(PROFILES) - {Spheroconical}
    # Friction has its own tests (tests/mdr/test_full_stick.py) until a second method models it.
    assert {type(effect) for scene in scenes for effect in scene.effects} == set(EFFECTS) - {Friction}
    assert {type(scene.loading) for scene in scenes} == set(LOADINGS)


def test_parameters_span_their_decades():
    ratios = [s.loading.values[-1] / s.layer.thickness for s in random_scenes(2, 600) if "ContactRadii" in repr(s)]
    thin = [r for r in ratios if r > 0]
    assert min(thin) < 1e-2
    assert max(thin) > 1e2
    assert np.ptp(np.log10([s.layer.youngs_modulus for s in random_scenes(2, 100)])) > 10


def test_log_uniform_gives_every_decade_its_share():
    draws = np.array([log_uniform(np.random.default_rng(n), 1e-3, 1e3) for n in range(600)])
    counts, _ = np.histogram(np.log10(draws), bins=6, range=(-3, 3))
    assert counts.min() > 60  # 100 expected, standard deviation 9


@pytest.mark.parametrize("family", FAMILIES)
def test_there_and_back_is_the_same_scene(family):
    units = Units(length=2.0**20, stress=2.0**-30, time=2.0**7)
    back = Units(length=2.0**-20, stress=2.0**30, time=2.0**-7)
    for scene in random_scenes(3, 20, family):
        assert in_units(scene, units) != scene
        assert in_units(in_units(scene, units), back) == scene


def test_other_units_leave_ratios_alone():
    scene = random_scenes(4, 1)[0]
    other = in_units(scene, Units(length=8.0, stress=2.0, time=4.0))
    assert other.layer.poissons_ratio == scene.layer.poissons_ratio
    assert other.layer.youngs_modulus == 2.0 * scene.layer.youngs_modulus
    assert other.layer.thickness == 8.0 * scene.layer.thickness


def test_every_field_has_a_dimension_that_agrees_with_its_unit():
    for record in (Layer, *PROFILES, *LOADINGS, *EFFECTS):
        for field in dataclasses.fields(record):
            known = {field.name, f"{record.__name__}.{field.name}"} & DIMENSIONS.keys()
            assert known or field.name in ("support", "control"), field.name
    # SI units written with length L, stress S, time T: N = S L^2, J = S L^3, kg = S L T^2
    si = {"m": (1, 0, 0), "s": (0, 0, 1), "m/s": (1, 0, -1), "N": (2, 1, 0), "N/m": (1, 1, 0), "J": (3, 1, 0)}
    si |= {"Pa": (0, 1, 0), "1": (0, 0, 0)}
    for name in UNITS.keys() & DIMENSIONS.keys():
        assert DIMENSIONS[name] == si[UNITS[name]], name
