"""Patch tests in (r, z): linear displacements with their constant stresses are reproduced to rounding."""

from __future__ import annotations

import numpy as np
import pytest

from fem_reference import assembly
from fem_reference.assembly import PAIRS
from fem_reference.materials import uniform
from fem_reference.mesh import section_mesh
from fem_reference.surface import TraceSpace
from fem_reference.verification import uniform_layer

MESH = section_mesh(uniform(0.5), 2.0, ((1.0, 0.02),), 0.5)
STABLE = [pair for pair in PAIRS.values() if pair.inf_sup_stable]
STRETCH = 0.1


def exact_state(problem):
    """u_r = s r, u_z = c z with a volume strain of size 1 - 2 nu, so that stresses stay finite; and the pressure."""
    compression = (1 - 2 * problem.parts.poissons_ratio) - 2 * STRETCH
    r, z = problem.space.positions
    # p = -K div u with K = 2 mu (1 + nu) / (3 (1 - 2 nu))
    pressure = -2 * problem.moduli.shear[0, 0] * (1 + problem.parts.poissons_ratio) / 3
    return np.column_stack([STRETCH * r, compression * z]).ravel(), compression, pressure


@pytest.mark.parametrize("pair", STABLE, ids=lambda pair: pair.name)
@pytest.mark.parametrize("nu", [0.0, 0.3, 0.45, 0.4999999, 0.5])
def test_linear_displacement(pair, nu):
    if nu > 0.45 and not pair.is_mixed:
        pytest.skip("a displacement formulation is ill-conditioned near nu = 1/2")
    problem = uniform_layer(MESH, pair, nu)
    exact, compression, pressure = exact_state(problem)
    stress_zz = 2 * problem.moduli.shear[0, 0] * (compression - (1 - 2 * nu) / 3) - pressure
    boundary = problem.space.nodes_on(MESH.mesh.boundary_facets())
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


def uniform_pressure_loads(problem, nodes):
    """int v 2 pi r dr on the contact, by the trace polynomials."""
    trace = TraceSpace(problem.space.positions[0, nodes], problem.pair.degree)
    points = problem.pair.degree + 2
    return trace.moments(np.ones_like(trace.gauss(points)[0]), points)


def spoil_hoop_strain(monkeypatch, factor):
    right = assembly.strains
    spoiled = np.array([1, 1, factor, 1])[:, None, None]
    monkeypatch.setattr(assembly, "strains", lambda jacobian: right(jacobian) * spoiled)


def test_a_wrong_hoop_strain_fails_the_patch_test(monkeypatch):
    spoil_hoop_strain(monkeypatch, 1.001)
    problem = uniform_layer(MESH, PAIRS["P2"], 0.3)
    exact, _, _ = exact_state(problem)
    boundary = problem.space.nodes_on(MESH.mesh.boundary_facets())
    held = np.concatenate([2 * boundary, 2 * boundary + 1])
    solution = problem.solver(held).solve_displaced(exact[held][:, None])
    assert np.abs(solution[:, 0] - exact).max() > 1e-6


@pytest.mark.parametrize("support", ["bonded", "unbonded"])
@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
def test_the_patch_defect_of_a_mesh_is_rounding(nu, support):
    for pair in STABLE:
        if nu < 0.5 or pair.is_mixed:
            assert uniform_layer(MESH, pair, nu, bonded=support == "bonded").patch_defect < 1e-13


def test_a_wrong_hoop_strain_is_a_patch_defect(monkeypatch):
    spoil_hoop_strain(monkeypatch, 1 + 1e-9)
    assert uniform_layer(MESH, PAIRS["P3P2"], 0.3).patch_defect > 1e-11
