"""Profiles on layers up to a thousand times thinner than the contact is wide."""

import numpy as np
import pytest

import bem.large_ratio
import mdr.wide_profile
from bem.integral_equation import IntegralEquation
from bem.large_ratio import LargeRatioSolution
from contact import Cone, ContactRadii, InvalidInput, Layer, Paraboloid, Scene, Sphere, TruncatedCone
from mdr import Mdr, equivalent_system
from mdr.asymptotic import thin_profile

LAYERS = {
    "bonded 0.5": Layer(thickness=1.0, youngs_modulus=0.75, poissons_ratio=0.5),
    "unbonded": Layer(thickness=1.0, youngs_modulus=0.91, poissons_ratio=0.3, support="unbonded"),
}
INDENTERS = [Paraboloid(radius_of_curvature=1.0), Cone(slope=1.0), TruncatedCone(flat_radius=30.0, slope=1.0)]
SOURCE = IntegralEquation(nodes=20)


@pytest.mark.slow
@pytest.mark.parametrize("name", LAYERS)
@pytest.mark.parametrize("indenter", INDENTERS, ids=lambda i: type(i).__name__)
def test_thin_layer_profile_is_approached_with_first_order(name, indenter):
    """Eqs. (17), (20), (22): the difference halves as a/h doubles."""
    system, x = equivalent_system(LAYERS[name], indenter, 900.0, SOURCE), np.array([200.0, 400.0, 800.0])
    errors = system.mdr_profile(x) / thin_profile(LAYERS[name], indenter, x) - 1
    orders = np.log2(np.abs(errors[:-1] / errors[1:]))
    assert orders[1] == pytest.approx(1.0, abs=0.1)
    assert abs(orders[1] - 1) < abs(orders[0] - 1) + 1e-3


@pytest.mark.slow
@pytest.mark.parametrize("indenter", INDENTERS, ids=lambda i: type(i).__name__)
def test_other_panels_give_the_same_within_the_stated_error(indenter, monkeypatch):
    layer, x = LAYERS["bonded 0.5"], np.array([170.0, 333.0, 700.0, 890.0])
    system = equivalent_system(layer, indenter, 900.0, SOURCE)
    monkeypatch.setattr(bem.large_ratio, "PANEL_NODES", 40)
    other = equivalent_system(layer, indenter, 900.0, AnewBeyondNear())
    bound = system.relative_error
    assert bound["indentation_depth"] < 1e-8
    np.testing.assert_allclose(other.mdr_profile(x), system.mdr_profile(x), rtol=bound["indentation_depth"])
    np.testing.assert_allclose(other.elastic_force(x), system.elastic_force(x), rtol=bound["normal_force"])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("nu", "flat_radius", "end"), [(0.4999, 0.0, 200.0), (0.4999, 0.0, 1000.0), (0.3, 38.0, 240.0)]
)
def test_the_stated_error_covers_what_more_terms_change(nu, flat_radius, end, monkeypatch):
    """Few radii within reach, a layer that turns from film to bed, a rim beside the first radius: hard to fit."""
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=nu)
    indenter = TruncatedCone(flat_radius=flat_radius, slope=1.0) if flat_radius else INDENTERS[0]
    system, x = equivalent_system(layer, indenter, end, SOURCE), np.linspace(161.0, end, 200)
    monkeypatch.setattr(bem.large_ratio, "RADII", 60)
    monkeypatch.setattr(bem.large_ratio, "DEGREE", 36)
    monkeypatch.setattr(mdr.wide_profile, "DEGREE", 32)
    other, bound = equivalent_system(layer, indenter, end, AnewBeyondNear()), system.relative_error
    np.testing.assert_allclose(other.mdr_profile(x), system.mdr_profile(x), rtol=bound["indentation_depth"])
    np.testing.assert_allclose(other.elastic_force(x), system.elastic_force(x), rtol=bound["normal_force"])


@pytest.mark.slow
def test_narrow_and_wide_panels_meet_without_a_jump():
    for indenter in INDENTERS:
        system = equivalent_system(LAYERS["bonded 0.5"], indenter, 900.0, SOURCE)
        below, beyond = system.mdr_profile([160.0, 160.0 * (1 + 1e-12)])
        assert beyond == pytest.approx(below, rel=1e-8)
        x = np.array([1.0, 50.0, 150.0, 170.0, 600.0]) + indenter.flat_radius
        np.testing.assert_allclose(system.flat_radius + system.excess_at_force(system.elastic_force(x)), x, rtol=1e-11)


@pytest.mark.slow
def test_the_pressure_is_refused_where_only_moments_are_known():
    path = Mdr(flat_punch=SOURCE).solve(
        Scene(layer=LAYERS["unbonded"], indenter=INDENTERS[0], loading=ContactRadii([500.0]))
    )
    assert path.surface_displacement([1.0])[0] == pytest.approx(path.indentation_depth[0] - 0.5)
    with pytest.raises(InvalidInput, match="pressures are known up to"):
        path.pressure([1.0])


def test_breakpoints_far_out_and_short_indenters_are_refused_at_once():
    with pytest.raises(InvalidInput, match="breakpoint at 250"):
        equivalent_system(LAYERS["unbonded"], TruncatedCone(flat_radius=250.0, slope=1.0), 500.0, SOURCE)
    layer = LAYERS["unbonded"].replace(thickness=1e-3)
    with pytest.raises(InvalidInput, match=r"ends at 0\.5 m"):
        equivalent_system(layer, Sphere(radius=0.5), 0.4999, KnownRadii())


class AnewBeyondNear:
    """The source, with flat punches on wide panels made anew by settings that a test has changed."""

    def solution(self, layer, ratio):
        near = SOURCE.solution(layer, 160.0)
        return LargeRatioSolution(layer.support, layer.poissons_ratio, lambda: near)

    def refined(self):
        return self


class KnownRadii:
    """A source whose large-ratio solution knows its radii without having solved anything."""

    def solution(self, layer, ratio):
        solution = LargeRatioSolution(layer.support, layer.poissons_ratio, lambda: None)
        solution.__dict__["_punches"] = (None, None, 0.0, {160.0: None, 504.0: None})
        return solution

    def refined(self):
        return self
