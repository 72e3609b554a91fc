"""Contacts that pull in a narrow dip beside the rim of a flat end."""

from __future__ import annotations

import pytest

from contact import IndentationDepths, LayerStack, Scene, Sublayer, TruncatedParaboloid, UnsupportedSceneError
from mdr import Mdr

FILM = LayerStack(
    sublayers=(
        Sublayer(thickness=0.05368454907664519, youngs_modulus=56.34706426370768, poissons_ratio=0.49),
        Sublayer(thickness=0.9463154509233548, youngs_modulus=1.0, poissons_ratio=0.0),
    ),
    interfaces=("bonded",),
)


def test_tension_between_two_places_that_are_looked_at_is_found():
    """The pressure is positive at all places looked at first; finite elements see a gap (scene 29 of lift_off)."""
    indenter = TruncatedParaboloid(flat_radius=1.9824317214896106, radius_of_curvature=10.0)
    scene = Scene(layer=FILM, indenter=indenter, loading=IndentationDepths([0.61374441]))
    with pytest.raises(UnsupportedSceneError, match=r"no single circle|would pull"):
        Mdr().solve(scene)
