"""Averages of a load on the panels of a contact whose end is that of a panel, to rounding."""

import numpy as np

from contact import ContactRadii, ElasticBase, LayerStack, NormalForces, Scene, Sublayer, TruncatedCone
from mdr import Mdr


def test_a_contact_that_ends_with_a_panel_has_no_panel_of_width_zero():
    """Seen to fail with 'invalid value encountered in divide': a piece of one rounding lay on a panel of its own."""
    top = Sublayer(
        thickness=0.0011415409796560025, youngs_modulus=33800419420.441372, poissons_ratio=0.25415400861368026
    )
    base = ElasticBase(youngs_modulus=778020806563.0015, poissons_ratio=0.5)
    scene = Scene(
        layer=LayerStack(sublayers=(top,), interfaces=(), support=base),
        indenter=TruncatedCone(flat_radius=0.0011415408625989267, slope=9.350569085888741e-05),
        loading=ContactRadii(values=[top.thickness]),
    )
    there = Mdr().solve(scene)
    again = Mdr().solve(scene.replace(loading=NormalForces(there.normal_force)))
    r = top.thickness * np.array([0.0, 0.3, 0.99])
    np.testing.assert_allclose(again.pressure(r), there.pressure(r), rtol=1e-7, atol=0.0)
