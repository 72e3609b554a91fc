"""Patch tests in (r, z): linear displacements with their constant stresses are reproduced to rounding."""

from __future__ import annotations

import numpy as np
import pytest

from fem_reference.discrete_layer.elements import PAIRS
from fem_reference.discrete_layer.fields import point_fields
from fem_reference.discrete_layer.grading import Grading
from fem_reference.discrete_layer.mesh import layer_mesh
from fem_reference.discrete_layer.problem import LayerProblem, facet_nodes
from fem_reference.discrete_layer.trace import TraceSpace
from fem_reference.elastic.patch_test import patch_defect

MESH = layer_mesh(1.0, 2.0, Grading(points=((1.0, 0.02),), growth=0.5, max_cell=0.4))
STABLE = [pair for pair in PAIRS.values() if pair.inf_sup_stable]
STRETCH = 0.1


def exact_state(problem):
    """u_r = s r, u_z = c z with a volume strain of size 1 - 2 nu, so that stresses stay finite; and the pressure."""
    compression = (1 - 2 * problem.poissons_ratio) - 2 * STRETCH
    r, z = problem.positions
    # p = -K div u with K = 2 mu (1 + nu) / (3 (1 - 2 nu))
    pressure = -2 * problem.moduli.shear * (1 + problem.poissons_ratio) / 3
    return np.column_stack([STRETCH * r, compression * z]).ravel(), compression, pressure


@pytest.mark.parametrize("pair", STABLE, ids=lambda pair: pair.name)
@pytest.mark.parametrize("nu", [0.0, 0.3, 0.45, 0.4999999, 0.5])
def test_linear_displacement(pair, nu):
    if nu > 0.45 and not pair.is_mixed:
        pytest.skip("a displacement formulation is ill-conditioned near nu = 1/2")
    problem = LayerProblem(MESH, pair, nu, "bonded")
    exact, compression, pressure = exact_state(problem)
    stress_zz = 2 * problem.moduli.shear * (compression - (1 - 2 * nu) / 3) - pressure
    boundary = facet_nodes(problem.space, MESH.mesh.boundary_facets())
    pressed = problem.top_nodes(1.0)  # moved by forces there, and held in place elsewhere on the boundary
    held = np.setdiff1d(np.concatenate([2 * boundary, 2 * boundary + 1]), 2 * pressed[:-1] + 1)
    solver = problem.solver(held)
    # a uniform pressure -sigma_zz on the free part of the top, by superposition
    loads = np.zeros((problem.space.size, 1))
    loads[2 * pressed[:-1] + 1, 0] = uniform_pressure_loads(problem, pressed)[:-1] * -stress_zz
    solution = solver.solve_displaced(exact[held][:, None]) + solver.solve_loaded(loads)
    assert np.abs(solution[: len(exact), 0] - exact).max() < 1e-12
    if pair.is_mixed:
        assert np.abs(solution[len(exact) :, 0] - pressure).max() < 1e-11
    fields = point_fields(problem.space, problem.moduli, solution, np.arange(MESH.mesh.t.shape[1]))
    radial = 2 * problem.moduli.shear * (STRETCH - (1 - 2 * nu) / 3) - pressure
    assert np.abs(fields.stress - [radial, stress_zz, radial, 0.0]).max() < 2e-11


def uniform_pressure_loads(problem, nodes):
    """int v 2 pi r dr on the contact, by the trace polynomials."""
    trace = TraceSpace(problem.positions[0, nodes], problem.pair.degree)
    points = problem.pair.degree + 2
    return trace.moments(np.ones_like(trace.gauss(points)[0]), points)


def test_a_wrong_hoop_strain_fails_the_patch_test():
    problem = LayerProblem(MESH, PAIRS["P2"], 0.3, "bonded")
    problem.space.__dict__["strains"] = problem.space.strains * np.array([1, 1, 1.001, 1])[:, None]
    exact, _, _ = exact_state(problem)
    boundary = facet_nodes(problem.space, MESH.mesh.boundary_facets())
    held = np.concatenate([2 * boundary, 2 * boundary + 1])
    solution = problem.solver(held).solve_displaced(exact[held][:, None])
    assert np.abs(solution[:, 0] - exact).max() > 1e-6


@pytest.mark.parametrize("support", ["bonded", "unbonded"])
@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
def test_the_patch_defect_of_a_mesh_is_rounding(nu, support):
    for pair in STABLE:
        if nu < 0.5 or pair.is_mixed:
            assert patch_defect(LayerProblem(MESH, pair, nu, support)) < 1e-13


def test_a_wrong_hoop_strain_is_a_patch_defect():
    problem = LayerProblem(MESH, PAIRS["P3P2"], 0.3, "bonded")
    problem.space.__dict__["strains"] = problem.space.strains * np.array([1, 1, 1 + 1e-9, 1])[:, None]
    assert patch_defect(problem) > 1e-11
