"""Contacts of all sizes on one path: beside a flat end or a bend far smaller than the largest, each keeps its bar."""

from __future__ import annotations

import numpy as np
import pytest

from bem.layer_equation.flat_punch_source import IntegralEquation
from cases.measurements.campaigns.referee import second_opinion
from contact import (
    ContactPath,
    ContactRadii,
    Layer,
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


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("kind", ["cone", "paraboloid", "spheroconical", "table"])
@pytest.mark.parametrize("nodes", [12, pytest.param(20, marks=pytest.mark.slow)])
def test_a_path_from_the_tip_to_the_thickness_keeps_its_bars(kind: str, body: str, nodes: int) -> None:
    """Depth and force at radii from b to h, for b/h from 1e-8 to 0.1, against one equation for each radius."""
    for b in (1e-8, 3e-6, 1e-4, 0.1):
        radii = np.geomspace(1.01 * b, 1.0, 7)
        scene = Scene(layer=BODIES[body], indenter=indenter(kind, b), loading=ContactRadii(values=radii))
        path = Mdr(flat_punch=IntegralEquation(nodes=nodes)).solve(scene)
        assert isinstance(path, ContactPath)
        other = second_opinion(path)
        for name in ("indentation_depth", "normal_force"):
            error = np.abs(getattr(path, name) / other.values[name] - 1.0)
            assert np.all(error <= path.error_estimate[name] + other.uncertainty), (b, name)
            # Bars of use: the flat-punch data allow 1e-7 on 12 nodes.
            assert path.error_estimate[name].max() < 1e-6, (b, name)
