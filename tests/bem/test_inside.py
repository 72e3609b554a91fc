"""The direct integral equation gives no fields inside: MDR and finite elements do."""

from __future__ import annotations

import pytest

from bem.direct_method import IntegralEquationMethod
from contact import Cone, ContactRadii, Layer, Scene, UnsupportedSceneError


def test_the_direct_equation_gives_no_fields_inside():
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.5)
    scene = Scene(layer=layer, indenter=Cone(slope=0.1), loading=ContactRadii([1.0]))
    with pytest.raises(UnsupportedSceneError, match="integral_equation gives no fields inside the body; use mdr"):
        IntegralEquationMethod().solve(scene).inside()
