"""First guesses of the contact radius: the equations they solve, the profile's ends, other units."""

import math

import pytest

from contact import Cone, FlatPunch, Paraboloid, Sphere, Tabulated, TruncatedCone
from contact.scene.extent import radius_of_depth, radius_of_elongation, radius_of_load

PROFILES = [
    Paraboloid(radius_of_curvature=2.0),
    Sphere(radius=1.5),
    Cone(slope=0.2),
    TruncatedCone(flat_radius=0.4, slope=0.2),
    Tabulated(radii=[0.0, 0.3, 0.5, 0.9, 1.4], heights=[0.0, 0.05, 0.11, 0.4, 0.8]),
]


@pytest.mark.parametrize("indenter", PROFILES, ids=lambda i: type(i).__name__)
def test_each_guess_solves_its_equation(indenter):
    f = indenter.height
    r = radius_of_depth(indenter, 0.03)
    assert f(r) == pytest.approx(0.03, rel=1e-12, abs=0.0)
    r = radius_of_load(indenter, 0.03)
    assert r * f(r) == pytest.approx(0.03, rel=1e-12, abs=0.0)
    r = radius_of_elongation(indenter, 1e-3)
    assert f(r) ** 2 == pytest.approx(2 * math.pi * 1e-3 * r, rel=1e-12, abs=0.0)


def test_what_is_never_reached_ends_at_the_profiles_end():
    assert radius_of_depth(Sphere(radius=1.5), 2.0) == 1.5
    assert radius_of_depth(FlatPunch(radius=0.3), 1.0) == 0.3


def test_beside_a_flat_end_some_digits_of_the_excess_are_left():
    """Searches double the excess: it must not be zero."""
    assert radius_of_depth(TruncatedCone(flat_radius=0.4, slope=0.2), 1e-30) - 0.4 >= 0.9 * 0.4e-12


@pytest.mark.parametrize("unit", [1e-6, 1e3])
def test_units_of_length_do_not_count(unit):
    here, there = (radius_of_load(Paraboloid(radius_of_curvature=2.0 * u), 0.03 * u**2) for u in (1.0, unit))
    assert there == pytest.approx(unit * here, rel=1e-14, abs=0.0)
