"""Bad input gets one clear error: the value, the field's path and the remedy."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from contact import (
    Adhesion,
    CoatedPair,
    Cone,
    ContactRadii,
    Detachment,
    FlatPunch,
    ForceHistory,
    Impact,
    IndentationDepths,
    InvalidInput,
    KelvinVoigt,
    Layer,
    NormalForces,
    Paraboloid,
    PowerLaw,
    PronySeries,
    Scene,
    StandardSolid,
    Tabulated,
    TruncatedCone,
)

LAYER = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.45)
CONE = TruncatedCone(flat_radius=0.5e-3, slope=0.1)

BAD = {
    "NaN modulus": (
        lambda: Layer(thickness=1e-3, youngs_modulus=math.nan, poissons_ratio=0.3),
        r"Layer\.youngs_modulus = nan: must be positive and finite",
    ),
    "fields without names": (
        lambda: Layer(1e-3, 1e6, 0.3),
        r"came without a name; write the fields as name=value",
    ),
    "a text for a list": (lambda: NormalForces("12"), r"NormalForces\.values = '12': must be a list of numbers"),
    "a matrix for a list": (lambda: IndentationDepths(np.ones((2, 2))), r"must be a one-dimensional array"),
    "an endless list": (lambda: IndentationDepths(np.zeros(1_000_001)), r"at most 1000000 numbers, got 1000001"),
    "an integer beyond double precision": (lambda: Cone(slope=10**400), r"must fit into double precision"),
    "a sharper tip than a cone": (
        lambda: PowerLaw(exponent=0.5, reference_radius=1.0, reference_height=1.0),
        r"PowerLaw\.exponent = 0\.5: must be finite and at least 1",
    ),
    "a table that goes back": (
        lambda: Tabulated(radii=[0.0, 2e-3, 1e-3], heights=[0.0, 1e-6, 2e-6]),
        r"Tabulated\.radii = .*must increase strictly, but entry 2 is 0\.001",
    ),
    "a table with a height too few": (
        lambda: Tabulated(radii=[0.0, 1e-3, 2e-3], heights=[0.0, 1e-6]),
        r"Tabulated: a table needs at least three radii and one height for each; got 3 radii and 2 heights",
    ),
    "a table that starts beside the tip": (
        lambda: Tabulated(radii=[1e-3, 2e-3, 3e-3], heights=[0.0, 1e-6, 2e-6]),
        r"a table starts at the tip \(0, 0\), got \(0\.001, 0\); shift it",
    ),
    "a history with a force too few": (
        lambda: ForceHistory(time=[0.0, 1.0], force=[0.0]),
        r"ForceHistory: a history needs at least two instants and one force for each; got 2 instants and 1 values",
    ),
    "negative Prony modulus": (
        lambda: PronySeries(long_term_shear_modulus=1.0, shear_moduli=[1.0, -1.0], relaxation_times=[1.0, 2.0]),
        r"PronySeries\.shear_moduli = .*must be at least 0, but entry 1 is -1",
    ),
    "a Prony series of nothing": (
        lambda: PronySeries(long_term_shear_modulus=0.0, shear_moduli=[0.0], relaxation_times=[1.0]),
        r"needs at least one positive shear modulus",
    ),
    "a flat punch with radii": (
        lambda: Scene(layer=LAYER, indenter=FlatPunch(radius=1e-3), loading=ContactRadii([1e-3])),
        r"Scene: loading = ContactRadii: a flat punch's contact radius is its own; give depths or forces",
    ),
    "a radius beyond the table": (
        lambda: Scene(
            layer=LAYER,
            indenter=Tabulated(radii=[0.0, 1e-3, 2e-3], heights=[0.0, 1e-6, 4e-6]),
            loading=ContactRadii([3e-3]),
        ),
        r"loading\.values = 0\.003: the indenter ends at 0\.002 m; stay within",
    ),
    "detachment without adhesion": (
        lambda: Scene(layer=LAYER, indenter=CONE, loading=Detachment()),
        r"loading = Detachment needs adhesion; add Adhesion",
    ),
    "a viscoelastic model at odds with the layer": (
        lambda: Scene(
            layer=LAYER,
            indenter=CONE,
            loading=Impact(mass=1.0, velocity=1.0),
            effects=(KelvinVoigt(shear_modulus=1e5, viscosity=1.0),),
        ),
        r"instantaneous shear modulus of KelvinVoigt is 100000 Pa, but that of the layer, .* is 344827\.5862 Pa",
    ),
    "no indenter": (
        lambda: Scene(layer=LAYER, indenter="cone", loading=ContactRadii([1e-3])),
        r"Scene\.indenter = 'cone': Input should be an instance of Profile",
    ),
    "two plane bodies": (
        lambda: CoatedPair(
            first_radius=math.inf,
            second_radius=math.inf,
            first_thickness=1e-3,
            second_thickness=1e-3,
            youngs_modulus=1e6,
            poissons_ratio=0.5,
            loading=NormalForces([1.0]),
        ),
        r"two plane bodies touch everywhere at once",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input_is_refused_with_value_place_and_remedy(name):
    make, message = BAD[name]
    with pytest.raises(InvalidInput, match=message):
        make()


@given(st.floats().filter(lambda x: not 0.0 < x < math.inf))
def test_no_float_slips_through_as_a_positive_number(value):
    with pytest.raises(InvalidInput, match=r"Paraboloid\.radius_of_curvature"):
        Paraboloid(radius_of_curvature=value)


def test_moduli_that_agree_are_accepted():
    layer = Layer.incompressible(thickness=1e-3, shear_modulus=3e5)
    effect = StandardSolid(long_term_shear_modulus=1e5, maxwell_shear_modulus=2e5, viscosity=10.0)
    scene = Scene(layer=layer, indenter=CONE, loading=Impact(mass=1.0, velocity=1.0), effects=(effect,))
    assert scene.effect(StandardSolid) is effect
    assert scene.effect(Adhesion) is None
