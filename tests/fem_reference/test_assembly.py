"""The batched assembly equals the weak forms as scikit-fem assembles them."""

from __future__ import annotations

import numpy as np
import pytest
from skfem import Basis, ElementVector, FacetBasis

from fem_reference import assembly, weak_forms
from fem_reference.assembly import PAIRS, Space, scatter
from fem_reference.layer import DiscreteLayer
from fem_reference.materials import uniform
from fem_reference.mesh import section_mesh

SECTION = section_mesh(uniform(0.3), 3.0, ((1.0, 0.05),), 0.5)
MESH = SECTION.mesh
NU = 0.3
MU, BULK = (1 - NU) / 2, (1 - NU) * (1 + NU) / (3 * (1 - 2 * NU))


@pytest.fixture(params=PAIRS.values(), ids=PAIRS)
def pair(request):
    return request.param


def relative_difference(fast, slow):
    return abs(fast - slow).max() / abs(slow).max()


def matrix_of(pair, *, bonded=True):
    return DiscreteLayer(SECTION, pair, uniform(NU, bonded=bonded)).matrix


def weak_matrices(pair):
    """The forms of displacements, of the constraint, and of the pressures."""
    basis = Basis(MESH, ElementVector(pair.displacement))
    shear = weak_forms.shear.assemble(basis, mu=MU)
    if not pair.is_mixed:
        return shear + weak_forms.volume.assemble(basis, bulk=BULK), None, None
    pressures = basis.with_element(pair.pressure)
    mass = weak_forms.pressure_mass.assemble(pressures)
    return shear, weak_forms.constraint.assemble(basis, pressures), -mass / BULK


def test_element_matrices_sum_to_the_weak_forms(pair):
    matrix = matrix_of(pair)
    shear, constraint, compressibility = weak_matrices(pair)
    n = shear.shape[0]
    assert relative_difference(matrix[:n, :n], shear) < 1e-13
    if pair.is_mixed:
        assert relative_difference(matrix[n:, :n], constraint) < 1e-13
        assert relative_difference(matrix[n:, n:], compressibility) < 1e-13
    assert abs(matrix - matrix.T).max() < 1e-14 * abs(matrix).max()


def test_membrane_beyond_the_outer_edge(pair):
    edge = FacetBasis(MESH, ElementVector(pair.displacement), facets="outer")
    n = Space(MESH, pair).displacement_count
    direct = weak_forms.membrane.assemble(edge, mu=MU)
    assert relative_difference((matrix_of(pair, bonded=False) - matrix_of(pair))[:n, :n], direct) < 1e-12


def test_node_positions(pair):
    basis = Basis(MESH, pair.displacement)
    assert np.abs(Space(MESH, pair).positions - basis.doflocs).max() < 1e-14


def test_a_planted_error_in_the_hoop_strain_differs_from_the_weak_form(monkeypatch):
    right = assembly.strains
    monkeypatch.setattr(assembly, "strains", lambda *of: right(*of) * np.array([1, 1, 1.001, 1])[:, None, None])
    assert relative_difference(matrix_of(PAIRS["P2"]), weak_matrices(PAIRS["P2"])[0]) > 1e-5


def test_the_derivative_by_the_radius_is_that_of_the_matrix():
    """Central differences of ``u . K u`` over meshes whose vertices are moved."""
    layer = DiscreteLayer(SECTION, PAIRS["P3P2"], uniform(NU))
    rng, eta = np.random.default_rng(3), np.exp(-np.hypot(MESH.p[0] - 1, MESH.p[1]))
    state = rng.normal(size=(layer.space.size, 2))

    def energies(step):
        corners = layer.corners.copy()
        corners[:, :, 0] += step * eta[MESH.t].T
        elements = assembly.element_matrices(layer.pair, corners, layer.moduli)
        return state.T @ (scatter(elements, layer.space.element_unknowns, layer.space.size) @ state)

    difference = (energies(1e-5) - energies(-1e-5)) / 2e-5
    np.testing.assert_allclose(layer.derivative_by_radius(state, eta), difference, rtol=1e-6)
