"""Piecewise polynomials on the top surface: their mass matrix, values, and the pressure whose loads they carry."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.linalg import solveh_banded

from contact import NotConvergedError
from contact.records.validation import FloatArray, IntArray


@cache
def _gauss_rule(points: int) -> tuple[FloatArray, FloatArray]:
    """Gauss nodes and weights on [-1, 1]."""
    return np.polynomial.legendre.leggauss(points)


@dataclass(frozen=True)
class TraceSpace:
    """Continuous piecewise polynomials of ``degree`` along the top.

    Attributes:
        radii: r of all nodes, increasing; each cell has ``degree + 1`` equispaced nodes and shares its end nodes.
        degree: polynomial degree.
    """

    radii: FloatArray
    degree: int

    @property
    def vertices(self) -> FloatArray:
        """Cell ends."""
        return self.radii[:: self.degree]

    def basis(self, t: FloatArray) -> FloatArray:
        """The degree + 1 basis functions at local coordinates t in [0, 1], shape (..., node)."""
        # Products of differences: each value is the same bits whatever else is asked for.
        nodes = np.arange(self.degree + 1) / self.degree
        others = [[m for m in range(self.degree + 1) if m != n] for n in range(self.degree + 1)]
        ways = [np.prod((t[..., None] - nodes[own]) / (nodes[n] - nodes[own]), axis=-1) for n, own in enumerate(others)]
        return np.stack(ways, axis=-1)

    def evaluate(self, values: FloatArray, radius: FloatArray) -> FloatArray:
        """Function with nodal ``values`` at radii within the trace; zero beyond it."""
        vertices = self.vertices
        cell = np.clip(np.searchsorted(vertices, radius, side="right") - 1, 0, len(vertices) - 2)
        t = (radius - vertices[cell]) / (vertices[cell + 1] - vertices[cell])
        nodes = cell[:, None] * self.degree + np.arange(self.degree + 1)
        inside = (radius >= vertices[0]) & (radius <= vertices[-1])
        return np.where(inside, np.sum(self.basis(t) * values[nodes], axis=1), 0.0)

    def gauss(self, points: int) -> tuple[FloatArray, FloatArray]:
        """Radii (cell, point) and weights ``2 pi r dr`` of a Gauss rule on every cell."""
        x, w = _gauss_rule(points)
        length = np.diff(self.vertices)[:, None]
        radius = self.vertices[:-1, None] + length * (x + 1) / 2
        return radius, 2 * np.pi * radius * length * w / 2

    def moments(self, function_values: FloatArray, points: int) -> FloatArray:
        """``int f v 2 pi r dr`` for every basis function v, f given at ``gauss(points)``."""
        _, weights = self.gauss(points)
        x, _ = _gauss_rule(points)
        local = (weights * function_values) @ self.basis((x + 1) / 2)
        loads = np.bincount(self._cell_nodes.ravel(), local.ravel(), minlength=len(self.radii))
        return np.asarray(loads, dtype=np.float64)

    def hat_moments(self, stride: int) -> FloatArray:
        """``int v hat 2 pi r dr`` for every basis function v and the hat functions on every ``stride``-th node.

        Shape (node, hat); ``stride`` divides the degree, so that hats bend at nodes only.
        """
        hats, parts, points = TraceSpace(self.radii[::stride], 1), self.degree // stride, self.degree + 1
        weights = hats.gauss(points)[1]
        x = (_gauss_rule(points)[0] + 1) / 2
        piece = np.arange(len(weights))
        basis = self.basis((piece[:, None] % parts + x) / parts)
        local = np.einsum("cq,cqi,qj->cij", weights, basis, hats.basis(x))
        moments = np.zeros((len(self.radii), len(hats.radii)))
        rows = (piece // parts)[:, None] * self.degree + np.arange(self.degree + 1)
        np.add.at(moments, (rows[:, :, None], (piece[:, None] + np.arange(2))[:, None, :]), local)
        return moments

    @property
    def _cell_nodes(self) -> IntArray:
        return np.arange(0, len(self.radii) - 1, self.degree)[:, None] + np.arange(self.degree + 1)

    def mass_bands(self) -> FloatArray:
        """``int u v 2 pi r dr``, its diagonals from the first one down, shape (degree + 1, node)."""
        points = self.degree + 2
        x, _ = _gauss_rule(points)
        basis = self.basis((x + 1) / 2)
        local = np.einsum("cq,qi,qj->cij", self.gauss(points)[1], basis, basis)
        bands = np.zeros((self.degree + 1, len(self.radii)))
        for j in range(self.degree + 1):
            for i in range(j, self.degree + 1):
                bands[i - j, j :: self.degree][: len(local)] += local[:, i, j]
        return bands

    def recover(self, nodal_forces: FloatArray) -> FloatArray:
        """Nodal values of the pressure p with ``int p v 2 pi r dr = force(v)`` for every v: the consistent recovery.

        Raises:
            NotConvergedError: two nodes coincide.
        """
        if not np.all(np.diff(self.radii) > 0):
            raise NotConvergedError(
                "two nodes of the contact coincide: its cells are smaller than roundings of the radius"
            )
        return np.asarray(solveh_banded(self.mass_bands(), nodal_forces, lower=True, check_finite=False))
