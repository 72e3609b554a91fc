"""Order, stability and locking of the finite element formulations, and closed-form elasticity."""

from __future__ import annotations

import numpy as np
import pytest
from skfem import ElementVector, FacetBasis, LinearForm, MeshTri

from contact import FlatPunch, IndentationDepths, Layer, NotConvergedError, Paraboloid, Scene, StageLog
from fem_reference import Fem
from fem_reference.assembly import PAIRS
from fem_reference.materials import uniform as uniform_parts
from fem_reference.mesh import section_mesh
from fem_reference.prescribed_contact import solve_prescribed_contact
from fem_reference.profiles import ScaledIndenter
from fem_reference.verification import inf_sup_constant, plain_section, uniform_layer, uniform_mesh
from tests.fem_reference.integral_equation import solve_contact

MIXED = [pair for pair in PAIRS.values() if pair.is_mixed and pair.inf_sup_stable]
DISPLACEMENT = [pair for pair in PAIRS.values() if not pair.is_mixed]


def uniform(cells, shift=0.0):
    return plain_section(MeshTri.init_tensor(np.linspace(0, 1, cells + 1) + shift, np.linspace(0, 1, cells + 1)))


@pytest.mark.parametrize("pair", [p for p in PAIRS.values() if p.is_mixed], ids=lambda pair: pair.name)
def test_inf_sup_constant_tells_stable_pairs_from_unstable_ones(pair):
    """From one mesh to the next a stable pair keeps most of about 0.6; that of an unstable pair halves or vanishes."""
    cells = (2, 4) if pair.degree > 2 else (2, 4, 8)
    constants = [inf_sup_constant(pair, uniform_mesh(n)) for n in cells]
    assert (constants[-1] > max(0.75 * constants[-2], 0.1)) == pair.inf_sup_stable
    if pair.inf_sup_stable:
        assert min(constants) > 0.45


LOCKING_MESH = section_mesh(uniform_parts(0.5), 11.0, ((1.0, 1e-5),), 0.5)


def stiffness_error(pair, nu):
    """Relative error of the flat-punch stiffness at a/h = 1, from the reactions."""
    problem = uniform_layer(LOCKING_MESH, pair, nu)
    pressed = 2 * problem.top_nodes(1.0) + 1
    solver = problem.solver(np.concatenate([problem.supported_unknowns, pressed]))
    values = np.zeros((len(solver.held), 1))
    values[-len(pressed) :] = 1.0
    stiffness = solver.reactions(solver.solve_displaced(values), pressed).sum()
    return abs(stiffness / solve_contact(1.0, "bonded", nu).stiffness - 1)


def test_a_displacement_formulation_too_ill_conditioned_to_trust_is_refused():
    problem = uniform_layer(LOCKING_MESH, PAIRS["P3"], 0.49999999)
    with pytest.raises(NotConvergedError, match="energy"):
        solve_prescribed_contact(problem, ScaledIndenter(FlatPunch(radius=1.0), 1.0), StageLog())


@pytest.mark.parametrize("name", ["P2P1", "P3P2"])
def test_mixed_pairs_do_not_lock(name):
    errors = [stiffness_error(PAIRS[name], nu) for nu in (0.3, 0.4999999, 0.5)]
    assert max(errors) < 3 * errors[0]


def test_displacement_elements_lock_and_are_seen_to():
    assert stiffness_error(PAIRS["P2"], 0.499) > 10 * stiffness_error(PAIRS["P2"], 0.3)


@pytest.mark.slow
def test_locking_table():
    # bounds: about twice the errors of a prototype on a similar mesh at nu = 0.3
    bound = {"P2P1": 2e-3, "P3P2": 1e-4, "P4P3": 5e-6}
    for name, size in bound.items():
        errors = [stiffness_error(PAIRS[name], nu) for nu in (0.3, 0.45, 0.49, 0.499, 0.4999999, 0.5)]
        assert max(errors) < size
    for name in ("P2", "P3"):
        errors = [stiffness_error(PAIRS[name], nu) for nu in (0.3, 0.45, 0.49, 0.499, 0.49999)]
        assert np.all(np.diff(errors) > 0)


def lame_error(nu, cells):
    """Largest relative error of the radial displacement of a thick-walled tube."""
    # plane strain, internal pressure p: u = (1+nu) p ri^2 / (E (ro^2 - ri^2)) [(1 - 2 nu) r + ro^2 / r]
    inner, outer, p = 1.0, 2.0, 0.01
    problem = uniform_layer(uniform(cells, shift=inner), PAIRS["P3P2"], nu)
    mesh = problem.section.mesh
    bore = np.flatnonzero((mesh.p[0, mesh.facets] == inner).all(axis=0))
    basis = FacetBasis(mesh, ElementVector(problem.pair.displacement), facets=bore)
    load = LinearForm(lambda v, w: p * v[0] * 2 * np.pi * w.x[0]).assemble(basis)
    loads = np.zeros((problem.space.size, 1))
    loads[: len(load), 0] = load
    ends = np.concatenate([problem.nodes_on("top"), problem.nodes_on("base")])
    solution = problem.solver(np.unique(2 * ends + 1)).solve_loaded(loads)
    r = problem.space.positions[0]
    E = 1 - nu**2
    exact = (1 + nu) * p * inner**2 / (E * (outer**2 - inner**2)) * ((1 - 2 * nu) * r + outer**2 / r)
    return np.abs(solution[: 2 * len(r) : 2, 0] / exact - 1).max()


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
def test_lame_cylinder(nu):
    coarse, fine = lame_error(nu, 4), lame_error(nu, 8)
    assert np.log2(coarse / fine) > 3.5  # formal order 4
    assert fine < 5e-6


@pytest.mark.parametrize("support", ["bonded", "unbonded"])
def test_base_carries_what_the_top_receives(support):
    problem = uniform_layer(LOCKING_MESH, PAIRS["P3P2"], 0.5, bonded=support == "bonded")
    pressed = 2 * problem.top_nodes(1.0) + 1
    solver = problem.solver(np.concatenate([problem.supported_unknowns, pressed]))
    values = np.zeros((len(solver.held), 1))
    values[-len(pressed) :] = 1.0
    solution = solver.solve_displaced(values)
    top = solver.reactions(solution, pressed).sum()
    base = solver.reactions(solution, 2 * problem.nodes_on("base") + 1).sum()
    assert base == pytest.approx(-top, rel=1e-11, abs=0.0)


@pytest.mark.parametrize("name", ["P2", "P3P2", "P4P3"])
def test_rigid_translation_costs_nothing(name):
    problem = uniform_layer(LOCKING_MESH, PAIRS[name], 0.3)
    shift = np.zeros(problem.space.size)
    shift[1 : problem.space.displacement_count : 2] = 1.0
    assert np.abs(problem.matrix @ shift).max() < 1e-12 * abs(problem.matrix).max()


def test_doubling_youngs_modulus_doubles_the_force():
    paths = [
        Fem(growth=1.0, edge_cell=1e-4).solve(
            Scene(
                layer=Layer(thickness=1.0, youngs_modulus=E, poissons_ratio=0.4),
                indenter=FlatPunch(radius=1.0),
                loading=IndentationDepths([0.1]),
            )
        )
        for E in (1.0, 2.0)
    ]
    assert paths[1].normal_force[0] == 2 * paths[0].normal_force[0]


def test_ssnv104_two_spheres():
    # code_aster V6.04.104: R = 50 mm, E = 20 000 MPa, nu = 0.3, approach 4 mm: p0 = 2798.3 MPa, a = 10 mm.
    # Two equal spheres are one paraboloid of radius R/2 on a half-space of modulus E/2.
    scene = Scene(
        layer=Layer.half_space(youngs_modulus=10e9, poissons_ratio=0.3),
        indenter=Paraboloid(radius_of_curvature=25e-3),
        loading=IndentationDepths([4e-3]),
    )
    path = Fem(growth=0.4).solve(scene)
    assert path.contact_radius[0] == pytest.approx(10e-3, rel=1e-5, abs=0.0)
    r = np.linspace(0, 9.5e-3, 20)
    exact = 2798.3e6 * np.sqrt(1 - (r / 10e-3) ** 2)
    assert path.pressure(r) == pytest.approx(
        exact, rel=1e-3, abs=0.0
    )  # five digits are printed, the axis is least accurate
