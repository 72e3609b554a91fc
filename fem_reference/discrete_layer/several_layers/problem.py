"""Stacks and graded layers as a discrete layer: moduli at quadrature points, parts joined at their faces."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
from scipy import sparse

from contact import ElasticLayer, InvalidInput
from contact.records.validation import FloatArray, IntArray
from fem_reference.discrete_layer.assembly import (
    Space,
    constraint_elements,
    saddle_elements,
    shear_elements,
    stiffness_elements,
)
from fem_reference.discrete_layer.elements import ElementPair
from fem_reference.discrete_layer.material import PointModuli
from fem_reference.discrete_layer.mesh import LayerMesh
from fem_reference.discrete_layer.problem import LayerProblem
from fem_reference.discrete_layer.several_layers.far_base import far_spring
from fem_reference.discrete_layer.several_layers.joined_space import JoinedSpace
from fem_reference.discrete_layer.several_layers.mesh import PartsMesh


@dataclass(frozen=True)
class PartsModuli:
    """Moduli of the parts at points of their triangles.

    Attributes:
        layer_mesh: the mesh.
        quadrature: depths of the quadrature points, shape (triangle, point).
    """

    layer_mesh: PartsMesh
    quadrature: FloatArray

    def on(self, triangles: IntArray) -> PointModuli:
        """At the quadrature points of triangles, shape (triangle, point)."""
        return self.at(triangles, self.quadrature[triangles])

    def at(self, triangles: IntArray, depth: FloatArray) -> PointModuli:
        """At depths (n, ...) in n triangles."""
        part = self.layer_mesh.part[triangles]
        shear, compressibility = np.empty(depth.shape), np.empty(depth.shape)
        for index, each in enumerate(self.layer_mesh.body.parts):
            inside = part == index
            found = each.moduli(depth[inside])
            shear[inside], compressibility[inside] = found.shear, found.compressibility
        return PointModuli(shear, compressibility)


@dataclass(frozen=True)
class SeveralLayersProblem(LayerProblem):
    """A stack or graded layer; ``poissons_ratio`` is that of the surface."""

    # Where the section is long, displacements far away fall below the rounding of those under the contact, and no row
    # there can be as accurate as its own terms are small.  With the root of a rounding, a residual that passes is below
    # 2e-19 of the largest terms.
    least_share: ClassVar[float] = float(np.sqrt(np.finfo(float).eps))

    @property
    def parts_mesh(self) -> PartsMesh:
        """The mesh with its parts.

        Raises:
            InvalidInput: a mesh of one uniform layer.
        """
        if not isinstance(self.layer_mesh, PartsMesh):
            raise InvalidInput("a stack needs a mesh with parts")
        return self.layer_mesh

    @cached_property
    def constants(self) -> PartsModuli:
        """Moduli at the points of the mesh."""
        return PartsModuli(self.parts_mesh, _depth(self.space))

    @cached_property
    def elements(self) -> FloatArray:
        """Stiffness of each triangle."""
        return parts_elements(self.space, self.constants.on(np.arange(len(self.parts_mesh.part))))

    @cached_property
    def joined(self) -> JoinedSpace:
        """Unknowns and basis."""
        return self.parts_mesh.space(self.pair)

    @cached_property
    def outer_edge_matrix(self) -> sparse.csc_array:
        """The elastic base beyond the mesh."""
        mesh, parts = self.parts_mesh.mesh, self.parts_mesh.body.parts
        in_base = self.parts_mesh.part[mesh.f2t[0]] == len(parts) - 1
        sides = {side: mesh.boundaries[side][in_base[mesh.boundaries[side]]] for side in ("outer", "base")}
        return far_spring(self.joined, parts[-1], sides)

    @property
    def uniform_elements(self) -> FloatArray:
        """Those of the surface's material everywhere, for the patch test: it passes through the joined faces."""
        return stiffness_elements(self.space, self.moduli)

    @cached_property
    def supported_unknowns(self) -> IntArray:
        """Displacements that the axis and the base hold at zero, and those that others stand for."""
        held = 2 * self.nodes_on("axis") if self.has_elastic_edge else super().supported_unknowns
        return np.union1d(held, self.joined.unused)

    @property
    def has_elastic_edge(self) -> bool:
        """Whether an elastic base goes on beyond the mesh."""
        return self.parts_mesh.body.base_modulus > 0


def several_layers(layer: ElasticLayer, mesh: LayerMesh, pair: ElementPair, backend: str) -> SeveralLayersProblem:
    """The discrete layer."""
    slides = getattr(layer, "support", "bonded") == "unbonded"
    nu = layer.surface.poissons_ratio
    return SeveralLayersProblem(mesh, pair, nu, "unbonded" if slides else "bonded", backend)


def parts_elements(space: Space, moduli: PointModuli) -> FloatArray:
    """Element matrices of the mixed formulation with moduli at quadrature points."""
    weight = (moduli.compressibility * space.measure)[:, None, :]
    compliance = (space.pressure_values * weight) @ space.pressure_values.T
    return saddle_elements(space, shear_elements(space, moduli.shear), constraint_elements(space), compliance)


def _depth(space: Space) -> FloatArray:
    """z at the quadrature points, shape (triangle, point)."""
    points, _ = space.quadrature
    return np.asarray(space.mesh.p[1, space.mesh.t].T @ np.array([1 - points.sum(axis=0), *points]))
