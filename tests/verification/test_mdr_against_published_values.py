"""MDR on the integral equation against closed forms and tables."""

import mpmath
import numpy as np
import pytest

from bem.flat_punch import IntegralEquation
from contact import Layer, Paraboloid, TruncatedCone
from tests.bed import bed_of

LAYER_OF = {
    nu: Layer(thickness=1.0, youngs_modulus=1 - nu**2, poissons_ratio=nu) for nu in (0.3, 0.4, 0.45, 0.5)
}  # E* = 1
LAYER_OF["unbonded"] = Layer(thickness=1.0, youngs_modulus=0.91, poissons_ratio=0.3, support="unbonded")
HALF_SPACE = Layer.half_space(youngs_modulus=0.75, poissons_ratio=0.5)

# Truncated cone with b/a = 0.5: a/h, delta/(a tan), F/(E* a^2 tan), printed to six decimals. Independent solution of
# the layer's integral equation, radius by radius, stable over its number of nodes.
TRUNCATED_CONE = {
    0.5: [
        (0.1, 0.964788, 1.481398),
        (0.5, 0.709504, 1.597749),
        (1, 0.556930, 2.096970),
        (2, 0.440614, 3.911228),
        (5, 0.333939, 15.328170),
        (10, 0.280490, 63.915489),
    ],
    0.45: [(1, 0.596365, 2.007889), (2, 0.502610, 3.420101), (5, 0.454734, 9.592890), (10, 0.460061, 22.436056)],
    "unbonded": [(1, 0.684694, 1.755223), (2, 0.592168, 2.498001), (5, 0.535528, 5.162418), (10, 0.517720, 9.730204)],
}
# Paraboloid, same origin: a/h, delta R/h^2, F R/(E* h^3), with the last digit that is printed.
PARABOLOID = {
    0.5: [
        (0.2, 0.034253, 0.010733, 1e-6),
        (1, 0.559415, 1.880667, 1e-6),
        (2, 1.819611, 27.71329, 1e-5),
        (5, 8.978117, 1657.7172, 1e-4),
        (10, 31.22602, 54813.51, 1e-2),
    ],
    "unbonded": [(1, 0.673981, 1.578123, 1e-6), (2, 2.360922, 17.83896, 1e-5), (5, 13.397682, 564.7204, 1e-4)],
}


@pytest.mark.parametrize("layer", TRUNCATED_CONE)
def test_truncated_cone_on_layers(layer):
    for ratio, depth, force in TRUNCATED_CONE[layer]:
        indenter = TruncatedCone(flat_radius=ratio / 2, slope=1.0)
        system = bed_of(LAYER_OF[layer], indenter, IntegralEquation())
        assert system.mdr_profile(ratio) / ratio == pytest.approx(depth, abs=0.51e-6)
        assert system.elastic_force(ratio) / ratio**2 == pytest.approx(force, abs=0.51e-6)


@pytest.mark.parametrize("layer", PARABOLOID)
def test_paraboloid_on_layers(layer):
    for ratio, depth, force, digit in PARABOLOID[layer]:
        system = bed_of(LAYER_OF[layer], Paraboloid(radius_of_curvature=1.0), IntegralEquation())
        assert system.mdr_profile(ratio) == pytest.approx(depth, abs=0.51 * (1e-5 if depth > 30 else 1e-6))
        assert system.elastic_force(ratio) == pytest.approx(force, abs=0.51 * digit)


@pytest.mark.parametrize("flat_over_contact", [1e-6, 0.25, 0.5, 0.75, 0.9, 1 - 1e-6])
def test_truncated_cone_on_the_half_space(flat_over_contact):
    """Sneddon's solution in the Handbook of Popov, Hess and Willert (2019): exact."""
    with mpmath.workdps(30):
        b = mpmath.mpf(flat_over_contact)
        depth = mpmath.acos(b)
        force = depth + b * mpmath.sqrt(1 - b**2)
    indenter = TruncatedCone(flat_radius=flat_over_contact, slope=1.0)
    system = bed_of(HALF_SPACE, indenter, IntegralEquation())
    assert system.mdr_profile(1.0) == pytest.approx(float(depth), rel=1e-14, abs=0.0)
    assert system.elastic_force(1.0) == pytest.approx(float(force), rel=1e-14, abs=0.0)


def test_printed_half_space_values():
    """The same as printed: b/a, delta/(a tan), F/(E* a^2 tan)."""
    for b, depth, force in [(0.25, 1.318116, 1.560178), (0.5, 1.047198, 1.480210), (0.9, 0.451027, 0.843328)]:
        system = bed_of(HALF_SPACE, TruncatedCone(flat_radius=b, slope=1.0), IntegralEquation())
        np.testing.assert_allclose([system.mdr_profile(1.0), system.elastic_force(1.0)], [depth, force], atol=0.51e-6)
