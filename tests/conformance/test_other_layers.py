"""Whoever does not model stacks and graded layers says so, with the reason; nobody takes one for a plain layer."""

from __future__ import annotations

import pytest

from cases.accuracy import solve
from cases.declare.methods import build
from cases.referees.calculix import CalculiX
from cases.referees.grids import ContactMechanics, Tamaas
from contact import (
    ContactRadii,
    ExponentialDepth,
    Friction,
    GradedLayer,
    IndentationDepths,
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


def scene_of(layer):
    return Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=5.0), loading=ContactRadii([0.5]))


@pytest.mark.parametrize(("layer", "names"), [(LAYERS[0], ("bem",)), (LAYERS[1], ("mdr", "fem", "bem"))])
def test_friction_on_other_layers_is_refused(layer, names):
    """Stacks stick by MDR and finite elements; nothing else of this kind is modelled."""
    scene = scene_of(layer).replace(effects=(Friction(coefficient=float("inf")),))
    for name in names:
        method = build(name, {})
        assert type(layer).__name__ in method.supports(scene).reason or "Friction" in method.supports(scene).reason
        with pytest.raises(UnsupportedSceneError):
            method.solve(scene)


@pytest.mark.slow
def test_the_bound_of_friction_refuses_graded_layers():
    path = build("mdr", {}).solve(scene_of(LAYERS[1]))
    with pytest.raises(UnsupportedSceneError, match=r"under friction .* not a GradedLayer"):
        friction_effect(path, 0.1)


def test_flat_punch_tables_refuse_graded_layers():
    with pytest.raises((UnsupportedSceneError, InvalidInput), match="a GradedLayer"):
        build("mdr_table", {"cells": 64, "ratios": 60, "radii": 100}).solve(scene_of(LAYERS[1]))


@pytest.mark.first(1)
@pytest.mark.parametrize("layer", LAYERS, ids=lambda layer: layer.title)
def test_the_choice_by_accuracy_answers_other_layers(layer):
    assert solve(scene_of(layer), accuracy=1e-3).stated_error <= 1e-3


@pytest.mark.parametrize("method", [CalculiX(), ContactMechanics(), Tamaas()], ids=lambda method: method.name)
@pytest.mark.parametrize("layer", LAYERS, ids=lambda layer: layer.title)
def test_outside_solvers_name_the_layer_that_they_do_not_model(method, layer):
    """A refusal counts as false: taken for none, a bonded stack once passed for a plain layer."""
    scene = scene_of(layer).replace(loading=IndentationDepths([0.01]))
    assert type(layer).__name__ in method.supports(scene).reason
