"""Contact radii that end on a panel of the integral equation up to rounding: no digit is lost there.

Origin of the expected numbers: smoothness. Depth and force are analytic in a, so their values at a (1 + e) follow from
values at radii away from the panel's end.
"""

from __future__ import annotations

import numpy as np
import pytest

from bem.flat_punch import IntegralEquation
from contact import ContactRadii, IndentationDepths, Layer, NormalForces, Paraboloid, Scene, TruncatedCone
from mdr import Mdr
from tests.bed import bed_of

WINDOW = 1e-3


def state(layer, radius):
    indenter = Paraboloid(radius_of_curvature=1e3)
    path = Mdr().solve(Scene(layer=layer, indenter=indenter, loading=ContactRadii([radius])))
    return np.array([path.indentation_depth[0], path.normal_force[0], path.contact_stiffness[0]])


@pytest.mark.parametrize("support", ["bonded", "unbonded"])
@pytest.mark.parametrize("ratio", [2.0, 10.0])
def test_a_radius_close_to_a_panel_end_has_the_accuracy_of_any_other(support, ratio):
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.45, support=support)
    around = ratio + WINDOW * np.array([-1.0, -0.7, -0.4, -0.1, 0.1, 0.4, 0.7, 1.0])
    smooth = np.polynomial.Polynomial.fit
    curves = [smooth(around, values, 5) for values in np.array([state(layer, a) for a in around]).T]
    for shift in (-1e-9, -1e-11, -1e-13, -1e-15, 0.0, 1e-15, 1e-14, 1e-12, 1e-10):
        near = ratio * (1.0 + shift)
        expected = [curve(near) for curve in curves]
        np.testing.assert_allclose(state(layer, near), expected, rtol=3e-13)  # stated error of these answers: 2e-13


def edge_of_two_pieces():
    """A system whose profile leaps by 2e-9 at five thicknesses, where pieces behind a rim meet a panel."""
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.4999)
    cone = TruncatedCone(flat_radius=4.698177017865153, slope=0.0094)
    return layer, cone, bed_of(layer, cone, IntegralEquation(nodes=12))


def test_a_prescribed_force_is_answered_to_the_last_digit():
    """Between two pieces no radius has it, and the force of the nearest was given: 2.6e-9 off, no error stated."""
    layer, cone, coarse = edge_of_two_pieces()
    sides = 5.0 * (1.0 + np.array([-1e-13, 1e-13]))
    force = float(coarse.elastic_force(sides).mean())
    scene = Scene(layer=layer, indenter=cone, loading=NormalForces([0.3 * force, force]))
    path = Mdr(flat_punch=IntegralEquation(nodes=12)).solve(scene)
    np.testing.assert_array_equal(path.normal_force, scene.loading.values)


@pytest.mark.parametrize("ratio", [1.01, 1.5])
def test_a_depth_under_a_force_errs_like_the_force_under_that_depth(ratio):
    """dF = k_N d(delta), but the error of the depth at a fixed radius was stated, without that of the stiffness."""
    layer, solver = (
        Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3),
        Mdr(flat_punch=IntegralEquation(nodes=10)),
    )
    scene = Scene(layer=layer, indenter=TruncatedCone(flat_radius=1.3, slope=0.1), loading=ContactRadii([1.3 * ratio]))
    radius = solver.solve(scene)
    loads = IndentationDepths(radius.indentation_depth), NormalForces(radius.normal_force)
    depth, force = (solver.solve(scene.replace(loading=loading)) for loading in loads)
    of_force = depth.error_estimate["normal_force"] * depth.normal_force
    of_depth = force.error_estimate["indentation_depth"] * force.indentation_depth * force.contact_stiffness
    assert of_depth[0] >= 0.999 * of_force[0]
