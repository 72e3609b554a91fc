from __future__ import annotations

import numpy as np
import pytest
from scipy import sparse

from contact import (
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    Layer,
    NotConvergedError,
    Scene,
    UnsupportedSceneError,
)
from fem_reference import Fem
from fem_reference import solver as linear_solver
from fem_reference.assembly import PAIRS, Space, taylor_hood
from fem_reference.layer import DiscreteLayer
from fem_reference.materials import uniform
from fem_reference.mesh import section_mesh
from fem_reference.solver import CheckedSolver, minimum_degree

SECTION = section_mesh(uniform(0.5), 6.0, ((1.0, 1e-5),), 0.5)


def discrete(pair, nu, backend="superlu", *, bonded=True):
    return DiscreteLayer(SECTION, pair, uniform(nu, bonded=bonded), backend=backend)


def restricted(degree, nu, backend="superlu"):
    """The factorised layer, pressed on a disc."""
    problem = discrete(taylor_hood(degree), nu, backend)
    return problem.solver(np.concatenate([problem.supported_unknowns, 2 * problem.top_nodes(1.0) + 1]))


@pytest.mark.parametrize("degree", [2, 3, 4])
def test_order_is_a_permutation(degree):
    space = Space(SECTION.mesh, taylor_hood(degree))
    assert np.array_equal(np.sort(minimum_degree(space)), np.arange(space.size))


@pytest.mark.parametrize("nu", [0.3, 0.5])
def test_fill_is_small_at_every_poissons_ratio(nu):
    """1.24e6 at both; halving the mesh by bounding boxes leaves 1.93e6, COLAMD with pivots 4.4e6 at nu = 1/2."""
    factors = restricted(4, nu).checked._factors
    assert factors.L.nnz + factors.U.nnz < 1.3e6


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.4999999, 0.5])
@pytest.mark.parametrize("degree", [2, 3, 4])
def test_minimum_degree_needs_no_pivoting_and_agrees_with_partial_pivoting(degree, nu):
    solutions = []
    for backend in ("superlu", "superlu-pivoting"):
        problem = discrete(taylor_hood(degree), nu, backend)
        pressed = 2 * problem.top_nodes(1.0) + 1
        solver = problem.solver(np.concatenate([problem.supported_unknowns, pressed]))
        values = np.zeros((len(solver.held), 1))
        values[-len(pressed) :] = 1
        solution = solver.solve_displaced(values)
        assert solver.checked.factorisations == 1
        solutions.append(solver.reactions(solution, pressed).sum())
    assert solutions[0] == pytest.approx(solutions[1], rel=1e-11, abs=0.0)


@pytest.mark.parametrize(("degree", "nu"), [(2, 0.3), (3, 0.4999999), (4, 0.5)])
def test_mumps_agrees_with_superlu(degree, nu):
    pytest.importorskip("mumps", reason="the optional package python-mumps is not installed")
    solutions = []
    for backend in ("superlu", "mumps"):
        problem = discrete(taylor_hood(degree), nu, backend)
        pressed = 2 * problem.top_nodes(1.0) + 1
        solver = problem.solver(np.concatenate([problem.supported_unknowns, pressed]))
        values = np.zeros((len(solver.held), 2))
        values[-len(pressed) :] = [1, 2]
        solution = solver.solve_displaced(values)
        assert solver.checked.factorisations == 1  # MUMPS itself passed the check, nobody stepped in
        solutions.append(solver.reactions(solution, pressed).sum(axis=0))
    assert solutions[1] == pytest.approx(solutions[0], rel=1e-11, abs=0.0)


class Careless:
    """Factors that are wrong by one part in a thousand."""

    def __init__(self, matrix):
        self.factors = linear_solver.with_pivoting(matrix)

    def solve(self, rhs):
        return 1.5 * self.factors.solve(rhs)


def test_an_inaccurate_backend_is_replaced_or_refused(monkeypatch):
    matrix = sparse.csc_array(sparse.diags_array([2.0, 3.0, 4.0]))
    monkeypatch.setitem(linear_solver.BACKENDS, "careless", (Careless,))
    monkeypatch.setitem(linear_solver.BACKENDS, "rescued", (Careless, linear_solver.with_pivoting))
    with pytest.raises(NotConvergedError, match="backward_error"):
        CheckedSolver(matrix, "careless").solve(np.ones((3, 1)))
    rescued = CheckedSolver(matrix, "rescued")
    assert rescued.solve(np.ones((3, 1)))[:, 0] == pytest.approx([1 / 2, 1 / 3, 1 / 4], rel=1e-15, abs=0.0)
    assert rescued.factorisations == 2


def test_a_singular_matrix_is_refused():
    with pytest.raises(NotConvergedError, match="singular"):
        CheckedSolver(sparse.csc_array(np.array([[1.0, 1.0], [1.0, 1.0]])), "superlu-pivoting")


def test_nan_is_refused():
    solver = CheckedSolver(sparse.csc_array(sparse.eye_array(2)))
    with pytest.raises(NotConvergedError):
        solver.solve(np.array([[np.nan], [1.0]]))


def test_unknown_or_missing_backends_are_named(monkeypatch):
    matrix = sparse.csc_array(sparse.eye_array(2))
    with pytest.raises(InvalidInput, match="'cholmod'"):
        CheckedSolver(matrix, "cholmod")
    monkeypatch.setattr(linear_solver, "find_spec", lambda name: None)
    with pytest.raises(InvalidInput, match="python-mumps"):
        CheckedSolver(matrix, "mumps")


def test_displacement_formulation_refuses_incompressibility():
    with pytest.raises(InvalidInput, match="mixed"):
        discrete(PAIRS["P2"], 0.5).matrix  # noqa: B018


def out_of_memory(*_arguments):
    raise MemoryError


@pytest.mark.parametrize(
    ("name", "value"), [("BACKENDS", {"superlu": (out_of_memory,)}), ("physical_memory", lambda: 1e3)]
)
def test_a_mesh_that_does_not_fit_is_refused_in_words(monkeypatch, name, value):
    """SuperLU raises a MemoryError without a word; where memory is overcommitted, the process ends."""
    monkeypatch.setattr(linear_solver, name, value)
    with pytest.raises(UnsupportedSceneError, match=r"10 unknowns needs about .* less strict accuracy"):
        CheckedSolver(sparse.csc_array(sparse.eye_array(10)), "superlu")


def test_no_memory_error_leaves_the_method(monkeypatch):
    """Assembling a mesh that is too fine takes memory before it is factorised."""
    monkeypatch.setattr(Fem, "_solve", out_of_memory)
    scene = Scene(
        layer=Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3),
        indenter=FlatPunch(radius=1.0),
        loading=IndentationDepths(values=[0.1]),
    )
    with pytest.raises(UnsupportedSceneError, match="does not fit into memory"):
        Fem().solve(scene)


@pytest.mark.parametrize("nu", [0.3, 0.5])
@pytest.mark.parametrize("name", ["P2P1", "P3P2", "P4P3"])
def test_condensed_triangles_solve_the_whole_system(name, nu):
    """Random loads, inside triangles as well, and random prescribed values: every equation of the full matrix holds."""
    problem = discrete(PAIRS[name], nu, bonded=False)
    held, rng = problem.supported_unknowns, np.random.default_rng(1)
    solver, loads = problem.solver(held), rng.normal(size=(problem.space.size, 2))
    values = rng.normal(size=(len(held), 2))
    for found, asked, right in (
        (solver.solve_loaded(loads), 0.0, loads),
        (solver.solve_displaced(values), values, np.zeros_like(loads)),
    ):
        left = np.delete(problem.matrix @ found - right, held, axis=0)
        size = np.delete(abs(problem.matrix) @ np.abs(found) + np.abs(right), held, axis=0)
        assert np.abs(left / size).max() < 1e-11
        assert np.array_equal(found[held], asked + np.zeros_like(values))


def test_linear_elements_have_nodes_at_vertices_only():
    problem = discrete(PAIRS["P1P1"], 0.3)
    ends = np.unique(SECTION.mesh.facets[:, SECTION.mesh.boundaries["base"]])
    assert len(problem.nodes_on("base")) == len(ends)
