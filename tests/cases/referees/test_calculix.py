"""The deck, the meshes and the extrapolation of CalculiX; and, where it is installed, its answers."""

import numpy as np
import pytest

from cases.referees.calculix import (
    CalculiX,
    _place,
    at_zero,
    deck,
    extrapolated,
    mesh,
    observed_order,
    program,
    read_reactions,
)
from contact import (
    ContactRadii,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    Layer,
    NotConvergedError,
    Paraboloid,
    Scene,
    TruncatedCone,
)
from mdr import Mdr

LAYER = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.3)
QUANTITIES = ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness")
installed = pytest.mark.skipif(not program(), reason="CalculiX is not installed")


def test_odd_numbers_of_cells_are_refused():
    with pytest.raises(InvalidInput, match="cells = 5: give an even number"):
        CalculiX(cells=5)


@pytest.mark.parametrize("support", ["bonded", "unbonded"])
@pytest.mark.parametrize("kinks", [(), (0.5,)])
def test_meshes_are_nested(kinks, support):
    coarse, fine = (mesh(0.7, cells, kinks, support) for cells in (6, 12))
    for few, many in ((coarse.radius[::2], fine.radius[::2]), (coarse.height[::2], fine.height[::2])):
        assert np.max(np.min(np.abs(few[:, None] - many[None, :]), axis=1)) < 1e-14
    for radius in (*kinks, 1.0):
        assert np.min(np.abs(coarse.radius[::2] - radius)) < 1e-14


def test_numbers_of_the_deck_are_not_cut():
    section = mesh(1.0, 4)
    lines = deck(section, LAYER.replace(youngs_modulus=1.0), section.radius**2).splitlines()
    assert max(len(word) for line in lines if "*" not in line for word in line.split(",")) <= 20
    assert sum("CAX8" in line for line in lines) == 1


@pytest.mark.parametrize("order", [1.0, 2.0, 4.0])
def test_extrapolation_finds_the_limit_of_any_order(order):
    values = [3.0 + 0.1 * 2.0 ** (-order * level) for level in range(3)]
    value, error = extrapolated(*values)
    assert value == pytest.approx(3.0, rel=1e-12, abs=0.0)
    assert error >= values[2] - 3.0
    assert observed_order(*values) == pytest.approx(order, rel=1e-9, abs=0.0)


def test_changes_that_do_not_shrink_are_not_extrapolated():
    value, error = extrapolated(1.0, 1.1, 1.05)
    assert (value, error) == (1.05, pytest.approx(0.15, rel=1e-4, abs=0.0))


def test_a_polynomial_at_its_zero_covers_what_it_lacks():
    places = np.array([0.08, 0.04, 0.02, 0.01, 0.005])
    values = np.column_stack([1.0 + places + places**4, np.exp(3.0 * places)])
    found, errors = at_zero(places, values, np.full(values.shape, 1e-12))
    assert found == pytest.approx([1.0, 1.0], rel=2e-8, abs=0.0)
    assert np.all(errors >= np.abs(found - 1.0))
    assert np.all(errors < 1e-5)


def test_elements_that_do_not_lock_where_nu_is_large():
    section = mesh(1.0, 2)
    kinds = [deck(section, LAYER.replace(poissons_ratio=nu), section.radius) for nu in (0.3, 0.49)]
    assert ["TYPE=CAX8," in kinds[0], "TYPE=CAX8R," in kinds[1]] == [True, True]


def test_a_base_that_does_not_carry_the_load_is_refused():
    line = "  1.000000E-09 {} 0.000000E+00\n"
    printed = "".join(line.format(force) for force in ("-1.0E+00", "9.0E-01", "-1.0E-03") * 2)
    with pytest.raises(NotConvergedError, match="they must be equal"):
        read_reactions(printed.replace("1.0E", "1.000000E").replace("9.0E", "9.000000E"))


def scene(indenter, loading, support="bonded", poissons_ratio=0.3):
    layer = LAYER.replace(support=support, poissons_ratio=poissons_ratio)
    return Scene(layer=layer, indenter=indenter, loading=loading)


SCENES = {
    "punch": scene(FlatPunch(radius=1e-3), IndentationDepths(values=np.array([1e-5]))),
    "paraboloid": scene(Paraboloid(radius_of_curvature=1e-2), ContactRadii(values=np.array([1e-3]))),
    "unbonded": scene(Paraboloid(radius_of_curvature=1e-2), ContactRadii(values=np.array([1e-3])), "unbonded"),
    "cone": scene(TruncatedCone(flat_radius=5e-4, slope=0.1), ContactRadii(values=np.array([1e-3]))),
    "at depth, nu = 1/2": scene(
        Paraboloid(radius_of_curvature=1e-2), IndentationDepths(values=np.array([6e-5])), poissons_ratio=0.5
    ),
    "at depth": scene(Paraboloid(radius_of_curvature=1e-2), IndentationDepths(values=np.array([6e-5]))),
}


def compared(name, cells):
    answer, right = CalculiX(cells=cells).solve(SCENES[name]), Mdr().solve(SCENES[name])
    for quantity in QUANTITIES:
        error = abs(getattr(answer, quantity)[0] / getattr(right, quantity)[0] - 1)
        yield error, answer.error_estimate[quantity][0]


@installed
@pytest.mark.parametrize(("name", "cells"), [("paraboloid", 4), ("unbonded", 6)])
def test_coarse_meshes_cover_what_they_miss(name, cells):
    """An unbonded layer with a free edge eight thicknesses away missed its stated error a hundred times."""
    for error, stated in compared(name, cells):
        assert error <= stated + 1e-12
        assert error < 1e-2


@installed
def test_exponents_of_depth_and_stiffness_are_those_of_the_contact():
    """The stiffness was said to grow like the fourth power of the radius, which made its bar wider than it need be."""
    radius, exponents = _place(SCENES["at depth"], 6e-5, 6)
    near = scene(Paraboloid(radius_of_curvature=1e-2), ContactRadii(values=radius * np.array([0.99, 1.01])))
    right = Mdr().solve(near)
    for name in ("depth", "stiffness"):
        values = right.indentation_depth if name == "depth" else right.contact_stiffness
        expected = np.log(values[1] / values[0]) / np.log(1.01 / 0.99)
        assert getattr(exponents, name) == pytest.approx(expected, rel=2e-2, abs=0.0)


@installed
@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_its_own_error_covers_and_is_five_digits(name):
    for error, stated in compared(name, 16):
        assert error <= stated + 1e-12
        assert error < (2e-5 if "1/2" in name else 5e-6)
