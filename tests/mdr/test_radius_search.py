"""Radii of loads: radius, depth and force belong together, whatever is prescribed."""

from itertools import product

import numpy as np
import pytest

from bem.numerics import EPS
from contact import ContactRadii, InvalidInput, UnsupportedSceneError
from mdr import Mdr
from tests.random_scenes import INDENTERS, drawn_scene

STACKS = [
    pytest.param(name, marks=pytest.mark.slow) for name in ("bonded stack", "sliding stack", "stack on elastic base")
]


@pytest.mark.first(1)
@pytest.mark.parametrize("loading", ["IndentationDepths", "NormalForces"])
@pytest.mark.parametrize("layer", ["half-space", "bonded layer", "unbonded layer", *STACKS])
def test_radii_of_random_loads_give_the_loads_again(layer, loading):
    """Loads of blunt tips with steep flanks were off by a factor of two: slopes of secants change many times over."""
    quantity = {"IndentationDepths": "indentation_depth", "NormalForces": "normal_force"}[loading]
    compared = 0
    for seed, kind in product((2, 3), sorted(set(INDENTERS) - {"FlatPunch"})):
        draw = np.random.default_rng([seed, *kind.encode()])
        scene = drawn_scene(draw, layer=layer, indenter=kind, loading=loading, effect="no effect")
        try:
            path = Mdr().solve(scene)
        except (InvalidInput, UnsupportedSceneError):  # too deep, several contacts
            continue
        flat = scene.indenter.flat_radius
        radius, at = np.unique(path.contact_radius, return_index=True)
        at, radius = at[radius > flat * (1 + 1e-12)], radius[radius > flat * (1 + 1e-12)]
        if radius.size:
            again = Mdr().solve(scene.replace(loading=ContactRadii(radius)))
            off = np.abs(getattr(again, quantity) / getattr(path, quantity)[at] - 1)
            assert (off < 1e-12 + 8 * EPS / (1 - flat / radius)).all(), scene
            compared += 1
    assert compared >= 10
