from __future__ import annotations

import numpy as np
import pytest

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
from fem_reference.solver import minimum_degree

SECTION = section_mesh(uniform(0.5), 6.0, ((1.0, 1e-5),), 0.5)


def discrete(pair, nu, *, bonded=True):
    return DiscreteLayer(SECTION, pair, uniform(nu, bonded=bonded))


def pressed(degree, nu):
    """The factorised layer, the force on a disc of unit depth, and how many factorisations that took."""
    problem = discrete(taylor_hood(degree), nu)
    disc = 2 * problem.top_nodes(1.0) + 1
    solver = problem.solver(np.concatenate([problem.supported_unknowns, disc]))
    values = np.zeros((len(solver.prescribed), 1))
    values[-len(disc) :] = 1
    force = solver.reactions(solver.solve_displaced(values), disc).sum()
    return solver, force, solver.factorisations


def with_factors(monkeypatch, wrong):
    """Replace the factors of diagonal pivoting, or of all factorisations, by wrong ones."""
    right = linear_solver.splu

    def factorised(matrix, permc_spec="COLAMD", **options):
        factors = right(matrix, permc_spec=permc_spec, **options)
        return wrong(factors) if permc_spec in wrong.orders else factors

    monkeypatch.setattr(linear_solver, "splu", factorised)


@pytest.mark.parametrize("degree", [2, 3, 4])
def test_order_is_a_permutation(degree):
    space = Space(SECTION.mesh, taylor_hood(degree))
    assert np.array_equal(np.sort(minimum_degree(space)), np.arange(space.size))


class Careless:
    """Factors whose solutions are half as large again."""

    orders = ("NATURAL",)

    def __init__(self, factors):
        self.factors = factors

    def solve(self, rhs):
        return 1.5 * self.factors.solve(rhs)


class AlwaysCareless(Careless):
    orders = ("NATURAL", "COLAMD")


@pytest.mark.first(5)
@pytest.mark.parametrize("nu", [0.0, 0.3, 0.4999999, 0.5])
@pytest.mark.parametrize("degree", [2, 3, 4])
def test_minimum_degree_needs_no_pivoting_and_agrees_with_partial_pivoting(degree, nu, monkeypatch):
    _, force, factorisations = pressed(degree, nu)
    with_factors(monkeypatch, Careless)
    _, other, more = pressed(degree, nu)
    assert (factorisations, more) == (1, 2)
    assert force == pytest.approx(other, rel=1e-11, abs=0.0)


def test_inaccurate_factors_are_refused(monkeypatch):
    with_factors(monkeypatch, AlwaysCareless)
    with pytest.raises(NotConvergedError, match="backward_error"):
        pressed(2, 0.3)


def zero_pivot(*_arguments, **_options):
    raise RuntimeError


def test_a_singular_matrix_is_refused(monkeypatch):
    problem = discrete(taylor_hood(2), 0.3)
    monkeypatch.setattr(linear_solver, "minimum_degree", lambda space: np.arange(space.size))
    monkeypatch.setattr(linear_solver, "splu", zero_pivot)
    with pytest.raises(NotConvergedError, match="singular"):
        problem.solver(problem.supported_unknowns)


def test_nan_is_refused():
    problem = discrete(taylor_hood(2), 0.3)
    loads = np.full((problem.space.size, 1), np.nan)
    with pytest.raises(NotConvergedError):
        problem.solver(problem.supported_unknowns).solve_loaded(loads)


def test_displacement_formulation_refuses_incompressibility():
    with pytest.raises(InvalidInput, match="mixed"):
        discrete(PAIRS["P2"], 0.5).matrix  # noqa: B018


def out_of_memory(*_arguments, **_options):
    raise MemoryError


@pytest.mark.parametrize(("name", "value"), [("splu", out_of_memory), ("physical_memory", lambda: 1e3)])
def test_a_mesh_that_does_not_fit_is_refused_in_words(monkeypatch, name, value):
    """SuperLU raises a MemoryError without a word; where memory is overcommitted, the process ends."""
    problem = discrete(taylor_hood(2), 0.3)
    monkeypatch.setattr(linear_solver, "minimum_degree", lambda space: np.arange(space.size))
    monkeypatch.setattr(linear_solver, name, value)
    with pytest.raises(UnsupportedSceneError, match=r"unknowns needs about .* less strict accuracy"):
        problem.solver(problem.supported_unknowns)


def test_no_memory_error_leaves_the_method(monkeypatch):
    """Assembling a mesh that is too fine takes memory before it is factorised."""
    monkeypatch.setattr(Fem, "_attempt", lambda *_: out_of_memory)
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
