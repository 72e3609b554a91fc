"""Periodic images of a contact act on it by what the layer lets through: exponentially less with the gap between."""

import numpy as np
import pytest

from bem import Bem
from bem.grid import equilibrium
from contact import IndentationDepths, Layer, Paraboloid, Scene

CELLS = 96


@pytest.mark.parametrize(
    ("poissons_ratio", "support", "gaps", "per_thickness"),
    [(0.5, "bonded", (2.0, 4.0, 6.0, 8.0), 0.739), (0.3, "unbonded", (1.0, 2.0), 1.5)],
)
def test_images_fade_exponentially_with_the_gap(poissons_ratio, support, gaps, per_thickness, monkeypatch):
    """On cells of one size; 11 % at two thicknesses, 5e-4 at eight, so that 1e-6 is left at the 16 that are taken."""
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=poissons_ratio, support=support)
    scene = Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=10.0), loading=IndentationDepths([0.05]))
    free = Bem(points=CELLS).solve(scene)
    width = 2.0 * free.contact_radius[0]
    changes = []
    # At two thicknesses the slope of force over depth tells another radius than the cells, which is refused.
    monkeypatch.setattr("bem.method._refuse_jump", lambda state: None)
    for gap in gaps:
        monkeypatch.setattr(equilibrium, "IMAGE_GAP", gap)
        cells = 4 * round(CELLS * equilibrium.FILL * (1.0 + gap / width) / 4)
        images = Bem(points=cells, boundary="periodic").solve(scene)
        changes.append(abs(images.normal_force[0] / free.normal_force[0] - 1.0))
    rates = -np.diff(np.log(changes)) / np.diff(gaps)
    assert np.all(rates > per_thickness)
