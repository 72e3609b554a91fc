"""Eqs. (11) and (12) with tabulated flat punches, against the direct route through the integral equation's factor.

The table here is made from the integral equation itself, so that what is tested is the transform alone.
"""

from dataclasses import dataclass

import numpy as np
import pytest
from bem.tables.table import FlatPunchTable

from bem.flat_punch import IntegralEquation
from contact import (
    Cone,
    ContactRadii,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    Layer,
    Paraboloid,
    Scene,
    TruncatedCone,
)
from mdr import Mdr

LAYER = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.5)
TABLE_ERROR = 2e-6  # six times the measured error 3.3e-7 of the splines of q over 120 ratios and 100 radii


@dataclass(frozen=True)
class GivenTable:
    """A source that always answers with one table."""

    table: FlatPunchTable

    def solution(self, layer, max_ratio):
        return self.table

    def refined(self):
        return self


@pytest.fixture(scope="module")
def tabulated():
    exact = IntegralEquation().solution(LAYER, 5.0)
    ratios = np.geomspace(1e-3, 5.0, 120)
    rho = np.sin((np.arange(100) + 0.5) * np.pi / 200)
    pressure = np.array([exact.smooth_pressure(rho, a) for a in ratios]) / np.sqrt(1 - rho**2)
    stiffness = exact.normalized_contact_stiffness(ratios)
    error = np.full((120, 100), TABLE_ERROR)
    return GivenTable(FlatPunchTable("bonded", 0.5, ratios, rho, stiffness, pressure, error[:, 0], error[:, 0], error))


@pytest.mark.parametrize(
    "indenter", [Paraboloid(radius_of_curvature=1.0), Cone(slope=0.3), TruncatedCone(flat_radius=0.45, slope=0.3)]
)
def test_published_route_agrees_with_the_factor_within_the_table_error(indenter, tabulated):
    scene = Scene(layer=LAYER, indenter=indenter, loading=ContactRadii([0.5, 1.0, 2.0, 4.9]))
    direct, published = Mdr().solve(scene), Mdr(flat_punch=tabulated).solve(scene)
    for name in ("indentation_depth", "normal_force", "contact_stiffness"):
        error = np.abs(getattr(published, name) / getattr(direct, name) - 1)
        assert np.all(error <= published.error_estimate[name]), name
    r = np.array([0.01, 0.2, 0.44, 0.46, 1.0, 1.9])
    scale = float(direct.pressure([0.2], step=2)[0])
    np.testing.assert_allclose(published.pressure(r, 2), direct.pressure(r, 2), atol=20 * TABLE_ERROR * scale)


def test_flat_punch_pressure_from_the_table(tabulated):
    scene = Scene(layer=LAYER, indenter=FlatPunch(radius=1.7), loading=IndentationDepths([0.1]))
    direct, published = Mdr().solve(scene), Mdr(flat_punch=tabulated).solve(scene)
    r = np.array([0.0, 0.8, 1.69])
    np.testing.assert_allclose(published.pressure(r), direct.pressure(r), rtol=20 * TABLE_ERROR)
    assert published.normal_force[0] == pytest.approx(direct.normal_force[0], rel=TABLE_ERROR, abs=0.0)


def test_a_table_gives_no_displacement_outside(tabulated):
    scene = Scene(layer=LAYER, indenter=Cone(slope=0.3), loading=ContactRadii([1.0]))
    path = Mdr(flat_punch=tabulated).solve(scene)
    assert path.surface_displacement([0.5])[0] == pytest.approx(path.indentation_depth[0] - 0.15, rel=1e-12, abs=0.0)
    with pytest.raises(InvalidInput, match="no displacement outside"):
        path.surface_displacement([1.5])


def test_a_truncated_cone_pressed_in_by_nothing_but_rounding_is_a_punch(tabulated):
    """Contact radius and flat end are equal in floating point: the quotient of heights once was 0/0."""
    indenter = TruncatedCone(flat_radius=0.45, slope=0.3)
    scene = Scene(layer=LAYER, indenter=indenter, loading=IndentationDepths([2e-10]))
    punch = Scene(layer=LAYER, indenter=FlatPunch(radius=0.45), loading=IndentationDepths([2e-10]))
    answer, wanted = Mdr(flat_punch=tabulated).solve(scene), Mdr().solve(punch)
    assert abs(answer.normal_force[0] / wanted.normal_force[0] - 1) <= answer.error_estimate["normal_force"][0]
