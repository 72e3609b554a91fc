"""A cone with a spherical apex: its limits, its half-space profile in closed form, and finite elements beside MDR."""

import numpy as np
import pytest

from contact import Cone, IndentationDepths, Layer, Scene, Sphere, Spheroconical, scene_from_mapping
from mdr import Mdr

TIP = Spheroconical(radius=1.0, slope=1.0)
LAYER = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.45)


def test_a_shallow_contact_is_the_spheres_and_a_deep_one_the_cones():
    def force(tip, depth, layer=LAYER):
        return Mdr().solve(Scene(layer=layer, indenter=tip, loading=IndentationDepths([depth]))).normal_force[0]

    assert force(TIP, 0.1) == pytest.approx(force(Sphere(radius=1.0), 0.1), rel=1e-10, abs=0.0)
    half_space = Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.45)
    # The apex of the cone lies R (1/cos - 1) below that of the sphere.
    deep, missing = 2e3, TIP.radius * (np.hypot(1.0, TIP.slope) - 1.0)
    cone = force(Cone(slope=1.0), deep + missing, half_space)
    assert force(TIP, deep, half_space) == pytest.approx(cone, rel=1e-6, abs=0.0)


def test_a_file_gives_it_by_its_half_angle():
    mapping = {
        "layer": {"half_space": True, "youngs_modulus": "1 Pa", "poissons_ratio": 0.5},
        "indenter": {"kind": "spheroconical", "radius": "20 nm", "half_angle": "45 deg"},
        "loading": {"kind": "indentation_depths", "values": ["100 nm"]},
    }
    tip = scene_from_mapping(mapping).indenter
    assert tip.radius == 2e-8
    assert tip.slope == pytest.approx(1.0, rel=1e-15, abs=0.0)
