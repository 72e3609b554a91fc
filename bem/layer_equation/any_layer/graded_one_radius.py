"""The Abel density of one contact on a graded layer: the logarithm of the kernel by exact rules, the rest by nodes.

The layer's share psi of the density has (x - t) ln|x - t| where the contact ends, and higher powers where the load has
a root. So its panels shrink towards all these points, where `one_radius` takes equal ones.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Self

import numpy as np

from bem.kernels.graded import TOLERANCE, GradedKernel
from bem.kernels.of_layer import surface_kernel
from bem.layer_equation.any_layer.graded_density import PanelSlopes
from bem.layer_equation.any_layer.logarithmic_rule import logarithmic_weights
from bem.layer_equation.any_layer.relative_panels import EDGE_LEVELS, RATIO, RelativePanels, panels_with_bends
from bem.layer_equation.any_layer.split_kernel import SplitKernel, split_kernel
from bem.layer_equation.inside.density import Density, Piece, cut_at, pieces_of
from bem.layer_equation.one_radius import DirectDensity, graded_pieces, half_space_load, load_on, under
from bem.polynomials.mapped import MappedGrid
from contact import ElasticLayer, NotConvergedError, Profile, UnsupportedSceneError
from contact.records.validation import FloatArray

# B, in thicknesses; the answer does not depend on it.
SPLIT_LENGTH: Final = 1.0


@dataclass(frozen=True, eq=False)
class GradedDirectDensity(DirectDensity):
    """As `DirectDensity`, with psi on panels that shrink towards its kinks.

    Attributes:
        split: N(s).
        panels: On [0, 1].
        at_edge: psi at the edge, shape (2,).
    """

    split: SplitKernel
    panels: RelativePanels
    at_edge: FloatArray

    @classmethod
    def solve(cls, layer: ElasticLayer, indenter: Profile, excess: float, width: float, nodes: int) -> Self:
        """Assemble and solve for one excess a - b [m], on panels of at most `width` thicknesses with `nodes` nodes.

        Raises:
            NotConvergedError: If the matrix is singular to double precision.
        """
        surface = surface_kernel(layer)
        if not isinstance(surface, GradedKernel):
            raise UnsupportedSceneError(f"a {type(layer).__name__} has no logarithmic kernel")
        unit, flat = layer.surface.thickness, indenter.flat_radius
        a = (flat + excess) / unit
        pieces = graded_pieces(indenter, excess, unit, width, nodes)
        load = load_on(indenter, excess, pieces, unit)
        marks = tuple(mark / (a * unit) for mark in (flat, *indenter.breakpoints))
        panels = panels_with_bends(marks, width / a, nodes)
        kernel = split_kernel(surface, SPLIT_LENGTH)
        M = _matrix(kernel, panels, a)
        W = np.column_stack([np.ones(len(panels.nodes)), _loads(indenter, panels.nodes * a * unit - flat) / unit])
        try:
            phi = np.linalg.solve(np.eye(len(W)) - M[:-1], W)
        except np.linalg.LinAlgError:
            message = f"the equation at a/h = {a:g} is singular to double precision; take a smaller a/h"
            raise NotConvergedError(message) from None
        psi = M @ phi
        edge = float(half_space_load(indenter, np.full(1, excess))[0]) / unit
        grid, none = MappedGrid.between(a * panels.ends, nodes), np.zeros(0)
        return cls(
            layer, indenter, unit, excess, load, edge, grid, psi[:-1], none, np.zeros((0, 2)), kernel, panels,
            psi[-1],
        )  # fmt: skip

    @property
    def kernel_error(self) -> float:
        """The tolerance to which the kernel was integrated over the depth."""
        return TOLERANCE

    @property
    def edge_values(self) -> FloatArray:
        """phi(a), shape (2,)."""
        return np.asarray(np.array([1.0, self.load_at_edge]) + self.at_edge)

    def _smooth_integral(self, radius: FloatArray, depth: float) -> FloatArray:
        """int_r^a psi'(t)/sqrt(t^2 - r^2) dt, panel by panel."""
        return PanelSlopes(self.panels, self.contact_radius, self.psi @ under(depth)).abel_integral(radius)

    def inside(self, depth: float, *, singular_edge: bool) -> Density:
        """phi under a depth, as the fields inside ask for it."""
        a, smooth = self.contact_radius, PanelSlopes(self.panels, self.contact_radius, self.psi @ under(depth))

        def slope(piece: Piece, offset: FloatArray) -> FloatArray:
            """phi' = psi' - g_hs'."""
            total = smooth.slope(np.minimum(piece.start + offset, a))
            return total + self.slope_of_load(piece, offset)

        edge = float(self.edge_values @ under(depth)) if singular_edge else 0.0
        pieces = pieces_of(self.indenter, self.unit, self._stretches)
        return Density(a, edge, cut_at(pieces, a * self.panels.ends), slope, 1.0)

    def beside_height(self, radius: FloatArray, depth: float) -> FloatArray:
        """(2/pi) int W/sqrt(r^2 - s^2) ds of W = delta - g_hs, continued beyond a by the equation, without g_hs."""
        inside = depth * np.arcsin(self.contact_radius / radius)
        mass = (self.grid.weights.ravel()[:, None] * (self._load_values() + self.psi)) @ under(depth)
        a, t = self.contact_radius, self.grid.nodes.ravel()
        beyond = np.empty_like(radius)
        for i, r in enumerate(radius):
            last = np.sqrt(r**2 - a**2)
            # The kernel varies over a thickness, and s beyond a radius.
            inner = np.concatenate([[0.0, 0.125, 0.5], RATIO ** np.arange(EDGE_LEVELS + 1.0)])
            ends = np.unique(np.append(np.arange(1.0, last), last * inner))
            grid = MappedGrid.between(ends, self.panels.count)
            # s^2 = a^2 + v^2 and v = v_max sin(beta) make both ends regular.
            v = ends[-1] * np.sin(np.pi / 2 * grid.nodes / ends[-1]).ravel()
            s = np.hypot(a, v)[:, None]
            gap = (v / (s[:, 0] + a) * v)[:, None] + (a - t)
            answer = -(self.split(gap) + self.split(s + t)) @ mass / np.pi
            beyond[i] = np.pi / 2 / ends[-1] * grid.weights.ravel() @ (answer * v / s[:, 0])
        return np.asarray(2 / np.pi * (inside + beyond))

    def _load_values(self) -> FloatArray:
        """W at the nodes, shape (n, 2)."""
        offsets = self.grid.nodes.ravel() * self.unit - self.indenter.flat_radius
        return np.column_stack([np.ones(len(self.psi)), _loads(self.indenter, offsets) / self.unit])


def _loads(indenter: Profile, offset: FloatArray) -> FloatArray:
    """g_hs [m] at offsets from the rim of the flat end, zero inside it."""
    load = np.zeros_like(offset)
    risen = offset > 0
    if risen.any():
        load[risen] = half_space_load(indenter, offset[risen])
    return load


def _matrix(kernel: SplitKernel, panels: RelativePanels, a: float) -> FloatArray:
    """int K(x, t) u(t) dt from values u at the nodes, at nodes and edge x, shape (n + 1, n)."""
    nodes, targets = panels.nodes, panels.targets
    rest = panels.matrix(kernel.regular(a * np.abs(targets[:, None] - nodes)), kernel.regular(a * panels.near[0]))
    rest += kernel.regular(a * (targets[:, None] + nodes)) * panels.weights
    logarithm = sum(logarithmic_weights(panels.ends, panels.count, sign * targets) for sign in (1, -1))
    return np.asarray(a / np.pi * (rest + kernel.slope * (logarithm + 2 * np.log(a) * panels.weights)))
