"""The two limits in Fig. 7: both pressures carry the mean load, and the half-space one is that of the solver."""

import numpy as np
import pytest

from contact import ContactRadii, Layer, Scene, TruncatedCone
from docs.gallery._truncated_cone_limits import pressure_limits, profile_limits
from mdr import Mdr

A = 1e-3
CONE = TruncatedCone(flat_radius=0.5 * A, slope=0.1)
RADII = np.linspace(0.0, 0.999, 100) * A


@pytest.mark.parametrize("label", ["unbonded", "bonded nu=0.45", "bonded nu=0.5"])
def test_limit_pressures_carry_the_mean_load(label):
    edges = np.linspace(0.0, 1.0, 401)
    rho = (edges[1:] + edges[:-1]) / 2  # midpoints avoid b
    for series in pressure_limits(label, CONE, A, rho * A):
        load = np.sum(np.array(series.y) * 2 * rho * np.diff(edges))  # of p/p_mean over the unit disc: 1
        assert load == pytest.approx(1.0, abs=2e-3)  # midpoint rule over a logarithmic singularity


def test_half_space_pressure_is_the_solver_s():
    layer = Layer.half_space(youngs_modulus=1e6, poissons_ratio=0.3)
    path = Mdr().solve(Scene(layer=layer, indenter=CONE, loading=ContactRadii([A])))
    mean = path.normal_force[0] / (np.pi * A**2)
    half_space, _ = pressure_limits("unbonded", CONE, A, RADII)
    np.testing.assert_allclose(half_space.y, path.pressure(RADII) / mean, rtol=1e-8)


def test_profiles_end_where_the_closed_forms_say():
    half_space, thin = profile_limits("bonded nu=0.5", CONE, A, np.array([A]))
    assert half_space.y[0] == pytest.approx(2 * np.pi / 3, rel=1e-12, abs=0.0)  # a arccos(1/2) / (a - a/2)
    assert thin.y[0] == pytest.approx(2.5 / 3 * 0.25 / 0.5, rel=1e-12, abs=0.0)  # Eq. (37) with b/a = 1/2
