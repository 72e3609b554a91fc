"""The one-dimensional system: consistency of profile, springs, force and their inverses."""

import numpy as np
import pytest

from bem.layer_equation.flat_punch_source import IntegralEquation
from contact import (
    Cone,
    FlatPunch,
    InvalidInput,
    Layer,
    Paraboloid,
    PowerLaw,
    Sphere,
    Tabulated,
    TruncatedCone,
    TruncatedParaboloid,
    UnsupportedSceneError,
)
from mdr.springs.assembly import equivalent_system

LAYER = Layer(thickness=2e-3, youngs_modulus=1e6, poissons_ratio=0.5)
UNBONDED = Layer(thickness=2e-3, youngs_modulus=1e6, poissons_ratio=0.4, support="unbonded")
HALF_SPACE = Layer.half_space(youngs_modulus=1e6, poissons_ratio=0.3)
LAYERS = [LAYER, UNBONDED, HALF_SPACE]
INDENTERS = [
    Paraboloid(radius_of_curvature=0.1),
    Sphere(radius=0.1),
    Cone(slope=0.1),
    TruncatedCone(flat_radius=1e-3, slope=0.1),
    TruncatedParaboloid(flat_radius=2.7e-3, radius_of_curvature=0.1),
    PowerLaw(exponent=1.7, reference_radius=1e-3, reference_height=1e-4),
    Tabulated(radii=np.linspace(0, 8e-3, 9), heights=5 * np.linspace(0, 8e-3, 9) ** 2),
]


def system_of(layer, indenter, max_radius=7e-3):
    return equivalent_system(layer, indenter, max_radius, IntegralEquation())


@pytest.mark.parametrize("layer", LAYERS, ids=["bonded", "unbonded", "half-space"])
@pytest.mark.parametrize("indenter", INDENTERS, ids=lambda i: type(i).__name__)
def test_radius_depth_and_force_invert_each_other(layer, indenter):
    system = system_of(layer, indenter)
    radii = np.linspace(indenter.flat_radius, 7e-3, 23)[1:]
    np.testing.assert_allclose(
        system.flat_radius + system.excess_at_depth(system.mdr_profile(radii)), radii, rtol=1e-13
    )
    np.testing.assert_allclose(
        system.flat_radius + system.excess_at_force(system.elastic_force(radii)), radii, rtol=2e-13
    )


@pytest.mark.parametrize("layer", LAYERS, ids=["bonded", "unbonded", "half-space"])
@pytest.mark.parametrize("indenter", INDENTERS, ids=lambda i: type(i).__name__)
def test_a_radius_is_found_to_rounding_when_it_is_sought_alone(layer, indenter):
    """In a list the slowest radius decides when the search ends; alone each needs its own last step."""
    system = system_of(layer, indenter)
    radii = indenter.flat_radius + (7e-3 - indenter.flat_radius) * np.random.default_rng(9).uniform(0.01, 1.0, 40)
    for forward, backward, rounding in (
        (system.mdr_profile, system.excess_at_depth, 1e-13),
        (system.elastic_force, system.excess_at_force, 2e-13),
    ):
        alone = [float(backward(forward(radius))) for radius in radii]
        np.testing.assert_allclose(np.add(system.flat_radius, alone), radii, rtol=rounding)


@pytest.mark.parametrize("layer", LAYERS, ids=["bonded", "unbonded", "half-space"])
@pytest.mark.parametrize("indenter", INDENTERS, ids=lambda i: type(i).__name__)
def test_contact_stiffness_is_the_derivative_of_force_by_depth(layer, indenter):
    """Eq. (5), by central differences of relative step 1e-4: their error is about 1e-8 of the value."""
    system = system_of(layer, indenter)
    a = np.array([3.1e-3, 4.4e-3, 6.3e-3])
    step = 1e-4 * (a - indenter.flat_radius)
    rise = system.elastic_force(a + step) - system.elastic_force(a - step)
    run = system.mdr_profile(a + step) - system.mdr_profile(a - step)
    np.testing.assert_allclose(rise / run, system.contact_stiffness(a), rtol=1e-7)
    np.testing.assert_allclose(run / (2 * step), system.mdr_profile_slope(a), rtol=1e-7)


@pytest.mark.parametrize("indenter", INDENTERS, ids=lambda i: type(i).__name__)
def test_a_thick_layer_is_a_half_space_to_first_order_in_the_ratio(indenter):
    """delta = g_hs (1 + O(a/h)): the difference shrinks with the thickness."""
    a = 7e-3
    exact = system_of(HALF_SPACE, indenter).mdr_profile(a)
    errors = [
        abs(system_of(LAYER.replace(thickness=h), indenter).mdr_profile(a) / exact - 1) for h in (1e3 * a, 1e4 * a)
    ]
    assert errors[0] / errors[1] == pytest.approx(10, rel=0.01, abs=0.0)
    assert errors[1] < 2e-4


def test_the_flat_punch_has_no_profile():
    system = system_of(LAYER, FlatPunch(radius=4e-3), 4e-3)
    assert system.mdr_profile(4e-3) == 0.0
    assert system.force(4e-3, 1e-4) == pytest.approx(float(system.contact_stiffness(4e-3)) * 1e-4, rel=1e-12, abs=0.0)


def test_units_do_not_matter():
    millimetres = Layer(thickness=2.0, youngs_modulus=1.0, poissons_ratio=0.5)  # mm, MPa: forces in N
    a, b = (
        system_of(LAYER, TruncatedCone(flat_radius=1e-3, slope=0.1)),
        equivalent_system(millimetres, TruncatedCone(flat_radius=1.0, slope=0.1), 7.0, IntegralEquation()),
    )
    assert a.mdr_profile(5e-3) == pytest.approx(1e-3 * float(b.mdr_profile(5.0)), rel=1e-13, abs=0.0)
    assert a.elastic_force(5e-3) == pytest.approx(float(b.elastic_force(5.0)), rel=1e-13, abs=0.0)


def test_a_profile_that_falls_again_is_refused_with_the_radius():
    bump = Tabulated(radii=[0.0, 1e-3, 2e-3, 3e-3, 4e-3, 5e-3], heights=[0.0, 1e-4, 2e-4, 1.9e-4, 0.5e-4, 0.2e-4])
    with pytest.raises(UnsupportedSceneError, match=r"contact radius of 0\.00\d+ m"):
        system_of(LAYER, bump, 5e-3)


def test_beyond_the_range_is_refused_with_the_value():
    system = system_of(LAYER, Cone(slope=0.1))
    with pytest.raises(InvalidInput, match=r"radius = 0\.008 m"):
        system.mdr_profile(8e-3)
    with pytest.raises(InvalidInput, match="indentation_depth"):
        system.excess_at_depth(1.0)
    with pytest.raises(InvalidInput, match="normal_force"):
        system.excess_at_force(-1.0)
