"""Limits of the fields inside as the surface comes near, and points against extended precision."""

import numpy as np
import pytest

from contact import (
    Cone,
    ContactRadii,
    FlatPunch,
    IndentationDepths,
    Layer,
    Paraboloid,
    PowerLaw,
    Scene,
    Sphere,
    TruncatedCone,
)
from mdr import Mdr

INDENTERS = [
    Paraboloid(radius_of_curvature=10.0),
    Cone(slope=0.1),
    TruncatedCone(flat_radius=0.3, slope=0.1),
    PowerLaw(exponent=3.0, reference_radius=1.0, reference_height=0.05),
    Sphere(radius=4.0),
    FlatPunch(radius=1.0),
]
LAYERS = {
    "bonded": Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3),
    "incompressible": Layer(thickness=0.2, youngs_modulus=1.0, poissons_ratio=0.5),
    "unbonded": Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3, support="unbonded"),
    "half-space": Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.4),
}
# Between rims, by the contact radius.
RADII = np.array([0.05, 0.2, 0.45, 0.6, 0.8, 0.95, 1.2])
BELOW = 1e-8


@pytest.mark.first(3)
@pytest.mark.parametrize(
    ("indenter", "layer"),
    [*zip(INDENTERS, [*LAYERS.values()] * 2, strict=False), (INDENTERS[2], LAYERS["incompressible"])],
    ids=lambda one: type(one).__name__,
)
def test_the_pressure_and_no_shear_come_back_at_the_surface(layer, indenter):
    """sigma_zz = -p, and what equilibrium leaves of sigma_rz = 0 at a depth z: -z (d sigma_rr/dr + (rr - tt)/r)."""
    loading = IndentationDepths([0.01]) if isinstance(indenter, FlatPunch) else ContactRadii([1.0])
    path = Mdr().solve(Scene(layer=layer, indenter=indenter, loading=loading))
    inside, mean = path.inside(), float(path.normal_force[0]) / np.pi
    found, surface = inside.at(RADII, BELOW), inside.at(RADII, 0.0)
    assert found.axial_stress == pytest.approx(-path.pressure(RADII), rel=0, abs=1e-10 * mean)
    step = 1e-3
    near = [inside.at(RADII + n * step, 0.0).radial_stress for n in (-2, -1, 1, 2)]
    slope = (near[0] - 8.0 * near[1] + 8.0 * near[2] - near[3]) / (12.0 * step)
    left = -BELOW * (slope + (surface.radial_stress - surface.hoop_stress) / RADII)
    assert found.shear_stress == pytest.approx(left, rel=0, abs=1e-10 * mean)
