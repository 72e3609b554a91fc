"""The discrete layer: its matrix, its supports, and the unknowns on its top."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Literal

import numpy as np
from scipy import sparse
from skfem import ElementVector, FacetBasis

from contact import ElasticLayer, Layer
from contact.records.validation import FloatArray, IntArray
from fem_reference.discrete_layer import weak_forms
from fem_reference.discrete_layer.assembly import Space, node_positions, scatter, stiffness_elements
from fem_reference.discrete_layer.elements import ElementPair
from fem_reference.discrete_layer.material import ElasticConstants, Moduli, moduli
from fem_reference.discrete_layer.mesh import LayerMesh
from fem_reference.discrete_layer.solving.ordering import minimum_degree
from fem_reference.discrete_layer.solving.restricted import RestrictedSolver, System

Support = Literal["bonded", "unbonded"]


@dataclass(frozen=True)
class LayerProblem:
    """An elastic layer discretised on one mesh, in units of its contact modulus.

    Attributes:
        layer_mesh: the section.
        pair: element pair.
        poissons_ratio: nu.
        support: "bonded" or "unbonded" base.
        backend: linear solver, a key of `solving.linear_solver.BACKENDS`.
    """

    # Each row of the linear system is judged by its own terms.
    least_share: ClassVar[float] = 0.0

    layer_mesh: LayerMesh
    pair: ElementPair
    poissons_ratio: float
    support: Support
    backend: str = "superlu"

    @cached_property
    def moduli(self) -> Moduli:
        """Shear modulus and compressibility at E* = 1."""
        return moduli(self.poissons_ratio)

    @property
    def constants(self) -> ElasticConstants:
        """Moduli at the points of the mesh."""
        return self.moduli

    @cached_property
    def space(self) -> Space:
        """Unknowns and basis."""
        return self.layer_mesh.space(self.pair)

    @cached_property
    def elements(self) -> FloatArray:
        """Stiffness of each triangle, in the order of `Space.element_unknowns`."""
        return stiffness_elements(self.space, self.moduli)

    @property
    def uniform_elements(self) -> FloatArray:
        """Those of the surface's material everywhere, for the patch test."""
        return self.elements

    @cached_property
    def matrix(self) -> sparse.csc_array:
        """Stiffness matrix of all unknowns, the outer edge of an unbonded layer included."""
        matrix = scatter(self.elements, self.space.element_unknowns, self.space.size)
        return matrix if self.springs is None else matrix + self.springs

    @property
    def springs(self) -> sparse.csc_array | None:
        """What carries on the layer beyond the mesh, in the numbering of all unknowns."""
        return self.outer_edge_matrix if self.has_elastic_edge else None

    @property
    def has_elastic_edge(self) -> bool:
        """Whether a spring on the outer edge carries on the membrane mode of an unbonded layer."""
        return self.support == "unbonded"

    @cached_property
    def outer_edge_matrix(self) -> sparse.csc_array:
        """The elastic edge that replaces the unbonded layer beyond the mesh."""
        return outer_edge_matrix(self.space, self.moduli.shear)

    @cached_property
    def positions(self) -> FloatArray:
        """(r, z) of the scalar displacement unknowns, shape (2, n)."""
        return node_positions(self.space)

    def nodes_on(self, boundary: str) -> IntArray:
        """Scalar displacement unknowns on a named boundary."""
        return facet_nodes(self.space, self.layer_mesh.mesh.boundaries[boundary])

    @cached_property
    def supported_unknowns(self) -> IntArray:
        """Displacements that the axis and the base hold at zero."""
        base = self.nodes_on("base")
        held = [2 * self.nodes_on("axis"), 2 * base + 1]
        if self.support == "bonded":
            held.append(2 * base)
        return np.unique(np.concatenate(held))

    def top_nodes(self, radius: float) -> IntArray:
        """Scalar displacement unknowns of the top cells within ``radius``, in the order of increasing r."""
        mesh = self.layer_mesh.mesh
        facets = mesh.boundaries["top"]
        inside = mesh.p[0, mesh.facets[:, facets]].max(axis=0) <= radius * (1 + 1e-14)
        nodes = facet_nodes(self.space, facets[inside])
        return nodes[np.argsort(self.positions[0, nodes])]

    def solver(self, held: IntArray) -> RestrictedSolver:
        """Factorise once with these unknowns prescribed."""
        order = minimum_degree(self.space, self.layer_mesh.elimination)
        system = System(self.space, self.elements, self.springs, order)
        return RestrictedSolver(system, held, self.backend, self.least_share)


def problem_of(
    layer: ElasticLayer,
    mesh: LayerMesh,
    pair: ElementPair,
    backend: str = "superlu",
    kind: type[LayerProblem] | None = None,
) -> LayerProblem:
    """The discrete layer; ``kind`` may hold a uniform one in more ways."""
    if isinstance(layer, Layer):
        return (kind or LayerProblem)(mesh, pair, layer.poissons_ratio, layer.support, backend)
    from fem_reference.discrete_layer.several_layers.problem import several_layers  # noqa: PLC0415 - only they load it

    return several_layers(layer, mesh, pair, backend)


def facet_nodes(space: Space, facets: IntArray) -> IntArray:
    """Scalar displacement unknowns on facets."""
    dofs = space.displacement_dofs
    between = dofs.facet_dofs[:, facets].ravel() if len(dofs.facet_dofs) else []
    ends = dofs.nodal_dofs[:, space.mesh.facets[:, facets]].ravel()
    return np.unique(np.concatenate([ends, between])).astype(np.int64)


def outer_edge_matrix(space: Space, shear_modulus: float) -> sparse.csc_array:
    """``weak_forms.outer_edge_spring``, in the numbering of all unknowns."""
    edge = FacetBasis(space.mesh, ElementVector(space.pair.displacement), facets="outer")
    spring = weak_forms.outer_edge_spring.assemble(edge, mu=shear_modulus).tocoo()
    return sparse.coo_array((spring.data, (spring.row, spring.col)), shape=(space.size, space.size)).tocsc()
