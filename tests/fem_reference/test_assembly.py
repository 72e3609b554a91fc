"""The batched assembly equals the weak forms as scikit-fem assembles them."""

from __future__ import annotations

import numpy as np
import pytest
from skfem import Basis, ElementVector, FacetBasis

from fem_reference.discrete_layer import assembly, weak_forms
from fem_reference.discrete_layer.assembly import Space, node_positions, scatter
from fem_reference.discrete_layer.elements import PAIRS
from fem_reference.discrete_layer.grading import Grading
from fem_reference.discrete_layer.mesh import layer_mesh
from fem_reference.discrete_layer.problem import outer_edge_matrix

MESH = layer_mesh(1.0, 3.0, Grading(points=((1.0, 0.05),), growth=0.5, max_cell=0.5)).mesh


@pytest.fixture(params=PAIRS.values(), ids=PAIRS)
def pair(request):
    return request.param


def relative_difference(fast, slow):
    return abs(fast - slow).max() / abs(slow).max()


def vector_basis(pair):
    return Basis(MESH, ElementVector(pair.displacement))


def test_shear_and_volume(pair):
    space, basis = Space(MESH, pair), vector_basis(pair)
    n = space.displacement_count
    shear = scatter(assembly.shear_elements(space, 0.3), space.element_displacements, n)
    volume = scatter(assembly.volume_elements(space, 2.0), space.element_displacements, n)
    assert relative_difference(shear, weak_forms.shear.assemble(basis, mu=0.3)) < 1e-13
    assert relative_difference(volume, weak_forms.volume.assemble(basis, bulk=2.0)) < 1e-13


def test_constraint_and_pressure_mass(pair):
    if not pair.is_mixed:
        pytest.skip("a displacement formulation has no pressure")
    space, basis = Space(MESH, pair), vector_basis(pair)
    moduli = assembly.Moduli(shear=0.3, compressibility=0.7)
    n = space.displacement_count
    matrix = scatter(assembly.stiffness_elements(space, moduli), space.element_unknowns, space.size)
    pressures = basis.with_element(pair.pressure)
    assert relative_difference(matrix[n:, :n], weak_forms.constraint.assemble(basis, pressures)) < 1e-13
    mass = weak_forms.pressure_mass.assemble(pressures)
    assert relative_difference(matrix[n:, n:], -0.7 * mass) < 1e-13
    assert abs(matrix - matrix.T).max() < 1e-14 * abs(matrix).max()


def test_outer_edge(pair):
    space = Space(MESH, pair)
    edge = FacetBasis(MESH, ElementVector(pair.displacement), facets="outer")
    n = space.displacement_count
    direct = weak_forms.outer_edge_spring.assemble(edge, mu=0.3)
    assert relative_difference(outer_edge_matrix(space, 0.3)[:n, :n], direct) < 1e-14


def test_node_positions(pair):
    basis = Basis(MESH, pair.displacement)
    assert np.abs(node_positions(Space(MESH, pair)) - basis.doflocs).max() < 1e-14


def test_measure_is_the_volume_of_revolution():
    assert Space(MESH, PAIRS["P2"]).measure.sum() == pytest.approx(np.pi * 3**2, rel=1e-13, abs=0.0)


def test_a_planted_error_in_the_hoop_strain_is_seen(monkeypatch):
    space = Space(MESH, PAIRS["P2"])
    reference = weak_forms.shear.assemble(vector_basis(PAIRS["P2"]), mu=0.3)
    wrong = space.strains.copy()
    wrong[:, 2] *= 1.001
    monkeypatch.setitem(space.__dict__, "strains", wrong)
    planted = scatter(assembly.shear_elements(space, 0.3), space.element_displacements, space.displacement_count)
    assert relative_difference(planted, reference) > 1e-5
