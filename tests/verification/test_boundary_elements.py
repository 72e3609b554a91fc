"""Boundary elements against the integral equation, an independent method, and against printed values."""

import numpy as np
import pytest

from bem.flat_punch import IntegralEquation
from bem.layer_equation.contact_density import ContactDensity
from bem.method import Bem
from bem.polynomials.mapped import MappedFunction, MappedGrid
from bem.tables.from_grid import FftTable
from contact import ContactRadii, IndentationDepths, Layer, NormalForces, Paraboloid, Scene, TruncatedCone
from mdr import Mdr

KERNELS = [("bonded", 0.3), ("bonded", 0.5), ("unbonded", 0.3)]
# normalised flat-punch stiffness k_bar at a/h = 0.2 and 1: the integral equation solved to 1e-12
PRINTED = {
    ("bonded", 0.3): (1.20655824090, 2.48352462914),
    ("bonded", 0.5): (1.28063660581, 3.61873584896),
    ("unbonded", 0.3): (1.17102775645, 2.19862136617),
}
PARABOLOID, CONE = Paraboloid(radius_of_curvature=0.1), TruncatedCone(flat_radius=0.5e-3, slope=0.1)


def layer(support, nu, thickness=1e-3):
    return Layer(thickness=thickness, youngs_modulus=1e6, poissons_ratio=nu, support=support)


def exact_stiffness(support, nu, ratio):
    return float(IntegralEquation().solution(layer(support, nu), ratio).normalized_contact_stiffness(ratio))


@pytest.mark.slow
@pytest.mark.parametrize(("support", "nu"), [*KERNELS, ("bonded", 0.45), ("bonded", 0.49)])
def test_table_error_covers_the_true_error_on_all_of_its_grid(support, nu):
    table = FftTable(cells=128).solution(layer(support, nu), 1000.0)
    exact = IntegralEquation().solution(layer(support, nu), 1000.0)
    xi = table.ratios
    assert (len(xi), xi[0], xi[-1]) == (
        400,
        pytest.approx(1e-3, rel=1e-12, abs=0.0),
        pytest.approx(1e3, rel=1e-12, abs=0.0),
    )
    for name in ("normalized_contact_stiffness", "normalized_spring_stiffness"):
        error = np.abs(getattr(table, name)(xi) / getattr(exact, name)(xi) - 1.0)
        assert np.all(error <= table.relative_error(xi)), name
    for ratio in xi[xi < 160.0][::6]:
        assert_pressure_is_covered(table, ratio, exact.smooth_pressure(table.radii, ratio))
    for ratio in exact.densities:
        assert_pressure_is_covered(table, ratio, wide_pressure(exact, ratio, table.radii))


def assert_pressure_is_covered(table, ratio, expected):
    """The largest error of q over all tabulated radii, and the error of its mean over arcsin(rho)."""
    difference = table.smooth_pressure(table.radii, ratio) - expected
    assert np.max(np.abs(difference)) / np.max(expected) <= table.smooth_pressure_error(ratio)
    assert abs(np.sum(difference)) / np.sum(expected) <= table.moment_error(ratio)


def wide_pressure(exact, ratio, rho):
    """q from the density on panels eight thicknesses wide, where the integral equation stores no pressure."""
    density = exact.densities[ratio]
    width = np.full(len(density), ratio / len(density))
    panels = MappedGrid.between(np.append(0.0, np.cumsum(width)), density.shape[1])
    known = ContactDensity(None, np.ones_like(density), MappedFunction(panels, density - 1.0, 0.0), np.zeros(1), 1.0)
    edge = ratio * np.sqrt(1.0 - rho**2)
    return (1.0 + known.edge_value - edge * known.abel_integral(ratio * rho)) / (
        2.0 * exact.normalized_contact_stiffness(ratio)
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("support", "nu", "limit"), [("bonded", 0.3, 1.0), ("bonded", 0.5, 3.0), ("unbonded", 0.3, 1.0)]
)
def test_full_table_reaches_the_thin_layer(support, nu, limit):
    # approached like 1 + c h/a; the table states its error at a/h = 1000 as well
    table = FftTable(cells=128).solution(layer(support, nu), 1000.0)
    assert len(table.ratios) == 400
    xi = 1000.0
    thin = (
        {0.3: np.pi / 2 * 0.49 / 0.4 * xi, 0.5: 3 * np.pi / 64 * xi**3}[nu] if support == "bonded" else np.pi / 2 * xi
    )
    assert table.stiffness[-1] == pytest.approx(thin, rel=table.error[-1] + 0.01, abs=0.0)
    slope = np.polyfit(np.log(table.ratios[-20:]), np.log(table.stiffness[-20:]), 1)[0]
    assert slope == pytest.approx(limit, abs=0.05)


@pytest.mark.parametrize(("support", "nu"), KERNELS[:1])
def test_mdr_on_the_table_agrees_with_mdr_on_the_integral_equation(support, nu):
    assert_mdr_agrees(support, nu, [0.6e-3, 1e-3], cells=64)


@pytest.mark.parametrize(
    "loading", [IndentationDepths([3.4253e-7, 5.59415e-6, 1.819611e-5]), NormalForces([0.025, 0.37])]
)
def test_mdr_on_a_table_states_errors_of_all_quantities_under_any_loading(loading):
    scene = Scene(layer=layer("bonded", 0.5), indenter=PARABOLOID, loading=loading)
    path, exact = Mdr(flat_punch=FftTable(cells=128, ratios=60, radii=200)).solve(scene), Mdr().solve(scene)
    for name in path.ARRAYS:
        error = np.abs(getattr(path, name) / getattr(exact, name) - 1.0)
        assert np.all(error <= path.error_estimate[name] + 1e-12), name


@pytest.mark.slow
@pytest.mark.parametrize(("support", "nu"), KERNELS)
def test_mdr_on_a_fine_table_agrees_with_mdr_on_the_integral_equation(support, nu):
    assert_mdr_agrees(support, nu, [0.6e-3, 1e-3, 2e-3, 5e-3], cells=256)


def assert_mdr_agrees(support, nu, radii, cells):
    """delta and F of both profiles within the table's stated error of integrals of its pressure."""
    material = layer(support, nu)
    source = FftTable(cells=cells)
    stated = source.solution(material, radii[-1] / 1e-3).moment_error(np.array(radii) / 1e-3)
    for indenter in (PARABOLOID, CONE):
        scene = Scene(layer=material, indenter=indenter, loading=ContactRadii(radii))
        published, exact = Mdr(flat_punch=source).solve(scene), Mdr().solve(scene)
        for name in ("indentation_depth", "normal_force"):
            error = np.abs(getattr(published, name) / getattr(exact, name) - 1.0)
            assert np.all(error <= stated), (name, error, stated)
            assert np.all(error <= published.error_estimate[name] + 1e-12), name


def test_contacts_at_round_multiples_of_a_flat_radius():
    """Points that estimates choose may meet the kink, where the pressure is infinite."""
    radii = 0.5e-3 * np.unique([p / q for p in range(2, 6) for q in range(1, p)])
    scene = Scene(layer=layer("bonded", 0.3), indenter=CONE, loading=ContactRadii(radii))
    path, exact = Mdr(flat_punch=FftTable(cells=64)).solve(scene), Mdr().solve(scene)
    assert np.all(path.uncertainty("pressure") > 0.0)
    assert np.all(np.abs(path.normal_force - exact.normal_force) <= path.uncertainty("normal_force"))


@pytest.mark.parametrize("indenter", [PARABOLOID, CONE], ids=["paraboloid", "truncated cone"])
@pytest.mark.parametrize("ratio", [1.0, 2.0])
def test_direct_contact_at_512(indenter, ratio):
    scene = Scene(layer=layer("bonded", 0.5), indenter=indenter, loading=ContactRadii([ratio * 1e-3]))
    path, exact = Bem(points=512).solve(scene), Mdr().solve(scene)
    for name in ("indentation_depth", "normal_force"):
        assert getattr(path, name)[0] == pytest.approx(getattr(exact, name)[0], rel=5e-5, abs=0.0), name


def test_force_control_and_depth_control_are_inverse():
    scene = Scene(layer=layer("unbonded", 0.3), indenter=PARABOLOID, loading=IndentationDepths([6e-6]))
    force = Bem(points=128).solve(scene).normal_force
    exact = Mdr().solve(scene).normal_force
    np.testing.assert_allclose(force, exact, rtol=2e-4)
