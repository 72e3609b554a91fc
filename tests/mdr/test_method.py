"""The method record: prescribed radii, depths and forces; fields; error estimates; cost; refusals."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.special import beta

from bem.flat_punch import IntegralEquation
from contact import (
    Cone,
    ContactRadii,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    Layer,
    Method,
    NormalForces,
    Paraboloid,
    PowerLaw,
    Scene,
    Sphere,
    Tabulated,
    TruncatedCone,
    TruncatedParaboloid,
)
from mdr import Mdr

LAYERS = {
    "incompressible": Layer(thickness=1e-3, youngs_modulus=2e6, poissons_ratio=0.5),
    "bonded": Layer(thickness=1e-3, youngs_modulus=2e6, poissons_ratio=0.3),
    "unbonded": Layer(thickness=1e-3, youngs_modulus=2e6, poissons_ratio=0.3, support="unbonded"),
    "half-space": Layer.half_space(youngs_modulus=2e6, poissons_ratio=0.45),
}
INDENTERS = [
    Paraboloid(radius_of_curvature=0.02),
    Sphere(radius=0.02),
    Cone(slope=0.2),
    TruncatedCone(flat_radius=0.4e-3, slope=0.2),
    TruncatedParaboloid(flat_radius=0.4e-3, radius_of_curvature=0.02),
    PowerLaw(exponent=3.3, reference_radius=1e-3, reference_height=1e-4),
    Tabulated(radii=np.linspace(0, 6e-3, 13), heights=20 * np.linspace(0, 6e-3, 13) ** 2),
]
RADII = [0.5e-3, 1e-3, 3.7e-3]
# Every indenter once, on one layer after the other.
EACH_INDENTER = pytest.mark.parametrize(
    ("layer", "indenter"),
    list(zip([*LAYERS] * 2, INDENTERS, strict=False)),
    ids=lambda value: value if isinstance(value, str) else type(value).__name__,
)


def solve(layer, indenter, loading, method=None):
    return (method or Mdr()).solve(Scene(layer=layer, indenter=indenter, loading=loading))


def smooth_rule(start, stop, count=200):
    """Nodes and weights that crowd towards both ends, where pressures have roots and logarithms."""
    x, w = np.polynomial.legendre.leggauss(count)
    x, w = (1 + x) / 2, w / 2
    return start + (stop - start) * x**3 * (10 - 15 * x + 6 * x**2), (stop - start) * 30 * x**2 * (1 - x) ** 2 * w


def test_it_is_a_method():
    assert isinstance(Mdr(), Method)
    assert Mdr().refined().flat_punch == IntegralEquation(nodes=28, panel_width=0.5)


@EACH_INDENTER
def test_radii_depths_and_forces_describe_the_same_path(layer, indenter):
    path = solve(LAYERS[layer], indenter, ContactRadii(RADII))
    by_depth = solve(LAYERS[layer], indenter, IndentationDepths(path.indentation_depth))
    by_force = solve(LAYERS[layer], indenter, NormalForces(path.normal_force))
    for other in (by_depth, by_force):
        for name in ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness"):
            np.testing.assert_allclose(getattr(other, name), getattr(path, name), rtol=3e-12, err_msg=name)


@pytest.mark.first(1)
@EACH_INDENTER
def test_the_pressure_carries_the_force(layer, indenter):
    """2 pi int p r dr = F by quadrature between the singular radii; F comes from the springs, Eq. (4)."""
    path = solve(LAYERS[layer], indenter, ContactRadii(RADII))
    ends = [0.0, *(k for k in indenter.breakpoints if k < RADII[-1]), RADII[-1]]
    force = 0.0
    for start, stop in pairwise(ends):
        r, w = smooth_rule(start, stop)
        force += 2 * np.pi * np.sum(path.pressure(r, step=-1) * r * w)
    assert force == pytest.approx(path.normal_force[-1], rel=1e-9, abs=0.0)


@EACH_INDENTER
def test_the_displacement_leaves_the_contact_continuously_and_without_a_corner(layer, indenter):
    """Inside it is delta - f(r); without adhesion the surface leaves it tangentially, with a power 3/2."""
    path = solve(LAYERS[layer], indenter, ContactRadii(RADII))
    a, gaps = RADII[-1], np.array([1e-4, 1e-5])
    outside = path.surface_displacement(a * (1 + gaps), step=-1)
    gap = outside - (path.indentation_depth[-1] - indenter.height(a * (1 + gaps)))
    assert path.surface_displacement([a], step=-1)[0] == pytest.approx(
        path.indentation_depth[-1] - float(indenter.height(a)), rel=1e-12, abs=0.0
    )
    assert np.all(gap > 0)  # the gap opens: the surface lies deeper than the indenter
    assert np.log10(gap[0] / gap[1]) == pytest.approx(1.5, abs=0.02)


def test_hertz():
    """Closed forms of Hertz: F = 4/3 E* sqrt(R) delta^(3/2), p = (2 E*/(pi R)) sqrt(a^2 - r^2), and w outside."""
    layer, R, a = LAYERS["half-space"], 0.02, 1.3e-3
    E = layer.contact_modulus
    path = solve(layer, Paraboloid(radius_of_curvature=R), ContactRadii([a]))
    assert path.indentation_depth[0] == pytest.approx(a**2 / R, rel=1e-14, abs=0.0)
    assert path.normal_force[0] == pytest.approx(4 / 3 * E * np.sqrt(R) * (a**2 / R) ** 1.5, rel=1e-14, abs=0.0)
    r = np.array([0.0, 0.3e-3, 1.29e-3])
    np.testing.assert_allclose(path.pressure(r), 2 * E / (np.pi * R) * np.sqrt((a - r) * (a + r)), rtol=1e-12)
    r = np.array([1.31e-3, 2e-3, 1e-2])
    outside = ((2 * a**2 - r**2) * np.arcsin(a / r) + a * np.sqrt(r**2 - a**2)) / (np.pi * R)
    np.testing.assert_allclose(path.surface_displacement(r), outside, rtol=1e-11)


@pytest.mark.parametrize("indenter", [i for i in INDENTERS if i.flat_radius], ids=lambda i: type(i).__name__)
@pytest.mark.parametrize("force", [1e-9, 1e-12, 1e-30])
def test_a_flat_end_pressed_by_almost_nothing_is_a_punch(indenter, force):
    """Closed form F = 2 E* b delta: the contact outgrows b by less than a floating-point number tells."""
    layer, b = LAYERS["half-space"], indenter.flat_radius
    path = solve(layer, indenter, NormalForces([force]))
    assert path.normal_force[0] == pytest.approx(force, rel=1e-14, abs=0.0)
    assert path.indentation_depth[0] == pytest.approx(force / (2 * layer.contact_modulus * b), rel=1e-9, abs=0.0)
    again = solve(layer, indenter, IndentationDepths(path.indentation_depth))
    assert again.normal_force[0] == pytest.approx(force, rel=1e-14, abs=0.0)


def test_out_of_reach_is_refused_with_the_value():
    short = Tabulated(radii=[0.0, 1e-3, 2e-3], heights=[0.0, 1e-5, 4e-5])
    with pytest.raises(InvalidInput, match="the indenter ends"):
        solve(LAYERS["bonded"], short, IndentationDepths([1e-3]))
    with pytest.raises(InvalidInput, match="a/h = 10000"):
        solve(LAYERS["bonded"], Cone(slope=0.1), ContactRadii([10.0]))
    with pytest.raises(InvalidInput, match="the sphere has sunk to its equator"):
        solve(LAYERS["bonded"], Sphere(radius=1e-3), ContactRadii([1e-3]))


def test_infinite_pressure_is_refused_not_returned():
    cone = solve(LAYERS["bonded"], TruncatedCone(flat_radius=0.5e-3, slope=0.1), ContactRadii([1e-3]))
    with pytest.raises(InvalidInput, match=r"radius = 0\.0005 m"):
        cone.pressure([0.5e-3])
    punch = solve(LAYERS["bonded"], FlatPunch(radius=1e-3), NormalForces([1.0]))
    with pytest.raises(InvalidInput, match="infinite"):
        punch.pressure([1e-3])


@pytest.mark.parametrize("exponent", [25.3, 70.0, 150.0])
def test_profiles_that_are_flat_at_their_tip_are_answered(exponent):
    """g_hs = H n/2 B(n/2, 1/2) (x/R)^n, and F = 2 E* g n/(n + 1) a on the half-space."""
    indenter = PowerLaw(exponent=exponent, reference_radius=1.0, reference_height=0.1)
    scene = Scene(
        layer=Layer.half_space(youngs_modulus=3.0, poissons_ratio=0.5), indenter=indenter, loading=ContactRadii([1.0])
    )
    path, depth = Mdr().solve(scene), 0.1 * exponent / 2 * beta(exponent / 2, 0.5)
    assert path.indentation_depth[0] == pytest.approx(depth, rel=1e-13, abs=0.0)
    force = 2 * 4.0 * depth * exponent / (exponent + 1)
    assert path.normal_force[0] == pytest.approx(force, rel=1e-13, abs=0.0)


def test_a_table_that_begins_flat_is_refused_by_name():
    table = Tabulated(radii=[0.0, 0.2, 0.4, 1.5], heights=[0.0, 0.0, 0.01, 0.4])
    scene = Scene(
        layer=Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3), indenter=table, loading=ContactRadii([1.0])
    )
    with pytest.raises(InvalidInput, match=r"does not rise within 0\.2 m of first touch"):
        Mdr().solve(scene)
