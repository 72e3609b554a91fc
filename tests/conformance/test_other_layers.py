"""Whoever does not model stacks and graded layers says so, with the reason; nobody takes one for a plain layer."""

from __future__ import annotations

import pytest

from cases.declare.methods import build
from cases.measurements.advice.advise import advise
from cases.measurements.evidence.choice import solve
from contact import (
    ContactRadii,
    ExponentialDepth,
    Friction,
    GradedLayer,
    InvalidInput,
    LayerStack,
    Paraboloid,
    Scene,
    Sublayer,
    UnsupportedSceneError,
)
from mdr.friction.statement import friction_effect

TOP = Sublayer(thickness=0.5, youngs_modulus=1.0, poissons_ratio=0.3)
LAYERS = (
    LayerStack(sublayers=(TOP, TOP), interfaces=("unbonded",)),
    GradedLayer(thickness=1.0, youngs_modulus=ExponentialDepth(surface=1.0, base=2.0), poissons_ratio=0.3),
)
PLAIN_ONLY = {"bem": {"points": 96}}


def scene_of(layer):
    return Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=5.0), loading=ContactRadii([0.5]))


@pytest.mark.parametrize("layer", LAYERS, ids=lambda layer: layer.title)
@pytest.mark.parametrize("name", PLAIN_ONLY)
def test_methods_for_plain_layers_refuse_others(name, layer):
    method = build(name, PLAIN_ONLY[name])
    assert type(layer).__name__ in method.supports(scene_of(layer)).reason
    with pytest.raises(UnsupportedSceneError, match=f"models one uniform layer.*not a {type(layer).__name__}; ask mdr"):
        method.solve(scene_of(layer))


@pytest.mark.parametrize("layer", LAYERS, ids=lambda layer: layer.title)
def test_friction_on_other_layers_is_refused(layer):
    scene = scene_of(layer).replace(effects=(Friction(coefficient=float("inf")),))
    assert type(layer).__name__ in build("mdr", {}).supports(scene).reason
    path = build("mdr", {}).solve(scene_of(layer))
    with pytest.raises(UnsupportedSceneError, match=f"the bound of friction models .* {type(layer).__name__}"):
        friction_effect(path, 0.1, build("mdr", {}).solve)


@pytest.mark.parametrize("layer", LAYERS, ids=lambda layer: layer.title)
def test_flat_punch_tables_refuse_other_layers(layer):
    with pytest.raises((UnsupportedSceneError, InvalidInput), match=f"a {type(layer).__name__}"):
        build("mdr_table", {"cells": 64, "ratios": 60, "radii": 100}).solve(scene_of(layer))


@pytest.mark.parametrize("layer", LAYERS, ids=lambda layer: layer.title)
def test_advice_and_the_choice_by_accuracy_refuse_other_layers(layer):
    with pytest.raises(UnsupportedSceneError, match=type(layer).__name__):
        advise(build("mdr", {}), scene_of(layer), 1e-3)
    with pytest.raises(UnsupportedSceneError, match=type(layer).__name__):
        solve(scene_of(layer), accuracy=1e-3)
