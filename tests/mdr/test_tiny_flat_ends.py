"""Contacts of all sizes on one path: each keeps its stated error, far above a flat end or a bend and close to it."""

from __future__ import annotations

import numpy as np
import pytest

from bem.direct_method import IntegralEquationMethod
from bem.flat_punch import IntegralEquation
from contact import (
    ContactPath,
    ContactRadii,
    IndentationDepths,
    Layer,
    NormalForces,
    Profile,
    Scene,
    Spheroconical,
    Tabulated,
    TruncatedCone,
    TruncatedParaboloid,
)
from mdr import Mdr

BODIES = {
    "layer": Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3, support="bonded"),
    "half-space": Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.3),
}


def indenter(kind: str, b: float) -> Profile:
    """With its smallest length b."""
    heights = b * np.array([0.0, 0.01, 0.05, 0.05 + 0.3 * (1.5 / b - 3.0)])
    return {
        "cone": TruncatedCone(flat_radius=b, slope=0.3),
        "paraboloid": TruncatedParaboloid(flat_radius=b, radius_of_curvature=5.0),
        "spheroconical": Spheroconical(radius=b, slope=0.3),
        "table": Tabulated(radii=np.array([0.0, b, 3.0 * b, 1.5]), heights=heights),
    }[kind]


@pytest.mark.first(4)
@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("kind", ["cone", "paraboloid", "spheroconical", "table"])
def test_a_path_from_the_tip_to_the_thickness_keeps_its_stated_errors(kind: str, body: str) -> None:
    """Depth and force at radii from b to h, for b/h from 1e-8 to 0.1, against one equation for each radius."""
    for b in (1e-8, 1e-4, 0.1):
        radii = np.geomspace(1.01 * b, 1.0, 7)
        scene = Scene(layer=BODIES[body], indenter=indenter(kind, b), loading=ContactRadii(values=radii))
        path = Mdr(flat_punch=IntegralEquation(nodes=12)).solve(scene)
        assert isinstance(path, ContactPath)
        directly = IntegralEquationMethod(nodes=24).solve(scene)
        for name in ("indentation_depth", "normal_force"):
            error = np.abs(getattr(path, name) / getattr(directly, name) - 1.0)
            assert np.all(error <= path.error_estimate[name] + directly.error_estimate[name]), (b, name)
            # The flat-punch data allow 1e-7 on 12 nodes.
            assert path.error_estimate[name].max() < 1e-6, (b, name)


@pytest.mark.parametrize("tip", [0.0, 1e-17, 1e-9, 1e-5])
@pytest.mark.parametrize("body", BODIES)
def test_the_first_slope_of_a_table_may_be_a_rounding(tip: float, body: str) -> None:
    """A sampled parabola was refused: it "stops rising at 8e-62 m", where its first slope of 4e-16 ends r^2."""
    radii = np.array([0.0, 9.25443262, 10.0651448, 33.53235365])
    indenter = Tabulated(radii=radii, heights=radii**2 / 10 + tip * radii)
    layer = BODIES[body] if body == "half-space" else BODIES[body].replace(thickness=30.0)
    scene = Scene(layer=layer, indenter=indenter, loading=ContactRadii([5.0, 9.6, 10.1, 30.0]))
    directly = IntegralEquationMethod().solve(scene)
    for loading in (scene.loading, IndentationDepths(directly.indentation_depth), NormalForces(directly.normal_force)):
        path = Mdr().solve(scene.replace(loading=loading))
        for name in "contact_radius", "indentation_depth", "normal_force":
            np.testing.assert_allclose(getattr(path, name), getattr(directly, name), rtol=1e-11, err_msg=name)


def test_a_contact_that_hardly_leaves_its_flat_end_raises_no_warning() -> None:
    """Its exponent at first touch, 1/2, is not looked for at excesses that have lost their digits: NaN came of it."""
    layer = Layer.half_space(youngs_modulus=13.748283497498566, poissons_ratio=0.12017379053410748)
    indenter = TruncatedCone(flat_radius=0.012932354904056786, slope=0.040494822826295414)
    path = Mdr().solve(Scene(layer=layer, indenter=indenter, loading=IndentationDepths([1.16977515e-12])))
    assert path.normal_force[0] > 0.0
