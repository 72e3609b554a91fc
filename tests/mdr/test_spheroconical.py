"""A cone with a spherical apex is given by its half angle in a file."""

import pytest

from contact import scene_from_mapping


def test_a_file_gives_it_by_its_half_angle():
    mapping = {
        "layer": {"half_space": True, "youngs_modulus": "1 Pa", "poissons_ratio": 0.5},
        "indenter": {"kind": "spheroconical", "radius": "20 nm", "half_angle": "45 deg"},
        "loading": {"kind": "indentation_depths", "values": ["100 nm"]},
    }
    tip = scene_from_mapping(mapping).indenter
    assert tip.radius == 2e-8
    assert tip.slope == pytest.approx(1.0, rel=1e-15, abs=0.0)
