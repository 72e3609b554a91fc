"""Records are values: equal by content, hashable, unchangeable, changed by copying."""

from __future__ import annotations

import dataclasses
import inspect
import pickle

import numpy as np
import pytest

from contact import Adhesion, ContactRadii, InvalidInput, Layer, Paraboloid, Scene
from contact.records.record import Record

LAYER = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.45)
SCENE = Scene(layer=LAYER, indenter=Paraboloid(radius_of_curvature=1e-2), loading=ContactRadii([1e-3, 2e-3]))


def test_equal_content_is_equal_and_hashes_alike():
    again = Scene(layer=LAYER.replace(), indenter=SCENE.indenter, loading=ContactRadii(np.array([1e-3, 2e-3])))
    assert again == SCENE
    assert hash(again) == hash(SCENE)
    assert pickle.loads(pickle.dumps(SCENE)) == SCENE


def test_effects_are_given_as_a_tuple_a_list_or_one():
    sticky = Adhesion(work_of_adhesion=0.1)
    first, *others = (SCENE.replace(effects=given) for given in ((sticky,), [sticky], sticky))
    assert first.effects == (sticky,)
    assert others == [first, first]


def test_other_content_or_another_kind_is_not_equal():
    assert SCENE.replace(loading=ContactRadii([1e-3])) != SCENE
    assert Paraboloid(radius_of_curvature=1.0) != 1.0


def test_fields_and_arrays_cannot_be_changed():
    with pytest.raises(dataclasses.FrozenInstanceError):
        LAYER.thickness = 2.0
    with pytest.raises(ValueError, match="read-only"):
        SCENE.loading.values[0] = 1.0


def test_the_callers_array_is_copied():
    radii = np.array([1e-3])
    loading = ContactRadii(radii)
    radii[0] = 5.0
    assert loading.values[0] == 1e-3


def test_a_record_takes_texts_with_units():
    """Units are read wherever records are made, not in files alone."""
    layer = Layer(thickness="1 mm", youngs_modulus="2 kPa", poissons_ratio=0.3)
    assert layer == Layer(thickness=1e-3, youngs_modulus=2e3, poissons_ratio=0.3)
    assert ContactRadii(["1 um", "2 um"]) == ContactRadii([1e-6, 2e-6])


def test_a_changed_copy_is_validated():
    with pytest.raises(InvalidInput, match=r"Layer\.thickness"):
        LAYER.replace(thickness=-1.0)


def test_moduli_of_a_layer():
    # Closed forms for E = 1 MPa: E* = E/(1-nu^2), G = E/(2(1+nu)), and at nu = 0 the confined modulus is E itself.
    layer = Layer(thickness=1.0, youngs_modulus=1e6, poissons_ratio=0.0)
    assert (layer.contact_modulus, layer.shear_modulus, layer.confined_modulus) == (1e6, 0.5e6, 1e6)
    soft = Layer.incompressible(thickness=1.0, shear_modulus=1e6)
    assert soft.contact_modulus == pytest.approx(4e6, rel=1e-15, abs=0.0)  # E* = 4 G at nu = 1/2
    assert soft.confined_modulus == np.inf
    assert Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.3).is_half_space


class _Plate(Record):
    width: float
    height: float = 2.0


def test_help_and_editors_show_the_fields_of_a_constructor():
    before = inspect.signature(_Plate)
    assert _Plate(width=1.0).height == 2.0
    assert before == inspect.signature(_Plate)
    assert str(before).replace("'", "") == "(*, width: float, height: float = 2.0)"
    given = "thickness: Thickness, youngs_modulus: Modulus, poissons_ratio: PoissonsRatio, support: Support = bonded"
    assert str(inspect.signature(Layer)).replace("'", "") == f"(*, {given})"
    assert str(inspect.signature(ContactRadii)).replace("'", "") == "(values: Vector)"
