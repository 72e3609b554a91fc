"""Direct contact with stacks: depth and radius are read from a slope of force over depth that is not of a power law."""

from __future__ import annotations

import numpy as np
import pytest

from bem import Bem
from contact import IndentationDepths
from mdr import Mdr
from tests.stacked_scenes import random_stack, scene


@pytest.mark.parametrize("prescribed", ["radius", "depth"])
def test_slopes_are_those_at_the_depth_itself_where_a_stiff_sublayer_bends(prescribed):
    """Over a step of 3 % the slope was 3e-4 off on all grids alike: depths 2.7e-4, where 8e-5 was stated."""
    rng = np.random.default_rng(18)
    layer, radius = random_stack(rng, contrast=1e4), float(np.exp(rng.uniform(np.log(0.1), np.log(5.0))))
    pressed = scene(layer, "truncated cone", radius)
    exact = Mdr().solve(pressed)
    if prescribed == "depth":
        pressed = pressed.replace(loading=IndentationDepths(exact.indentation_depth))
    path = Bem(points=256).solve(pressed)
    for name in ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness"):
        error = np.abs(getattr(path, name) / getattr(exact, name) - 1)
        assert error <= path.error_estimate[name] + 1e-12
        assert error < 8e-5
