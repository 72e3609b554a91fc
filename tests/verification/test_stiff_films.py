"""Roundings under a film that is much stiffer than its base are within the stated errors."""

import numpy as np
import pytest

from bem.flat_punch import IntegralEquation
from contact import ContactRadii, ElasticBase, LayerStack, Paraboloid, Scene, Sublayer
from mdr import Mdr


@pytest.mark.parametrize("contrast", [1e2, 1e3, 1e4])
def test_discretisations_differ_by_no_more_than_stated(contrast):
    film = Sublayer(thickness=1.0, youngs_modulus=contrast, poissons_ratio=0.3)
    layer = LayerStack(sublayers=(film,), interfaces=(), support=ElasticBase(youngs_modulus=1.0, poissons_ratio=0.3))
    scene = Scene(
        layer=layer, indenter=Paraboloid(radius_of_curvature=10.0), loading=ContactRadii([0.05, 0.3, 1.0, 3.0])
    )
    answer = Mdr().solve(scene)
    for nodes, width in ((32, 1.0), (30, 0.5), (40, 0.7), (27, 0.8)):
        other = Mdr(flat_punch=IntegralEquation(nodes=nodes, panel_width=width)).solve(scene)
        for name in ("contact_stiffness", "indentation_depth", "normal_force"):
            difference = np.abs(getattr(other, name) - getattr(answer, name))
            assert np.all(difference <= answer.uncertainty(name)), name
