"""The layer's equation on [0, x] for one x at a time, with rules that suit a logarithmic kernel.

On the nodes of `relative_panels` the equation is ``phi = W + M phi``, and its value at the edge
``y = W(x) + kappa phi``. So ``y = W(x) + row W`` with ``row = kappa (I - M)^-1``, which serves every load of that x.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

import numpy as np

from bem.layer_equation.any_layer.point_kernel import PointKernel
from bem.layer_equation.any_layer.relative_panels import RelativePanels, relative_panels
from bem.polynomials.mapped import MappedFunction
from contact.records.validation import FloatArray

# Widest panel, in thicknesses; densities vary over one.
WIDEST = 1.0
# Widest of the relative panels before they are cut.
MIDDLE = 0.375
# The rule on the logistic variable leaves out exp(-EXPONENT) beyond its reach and by its step. In exact numbers these
# are roundings, and 5e-12 of the kernel's largest value is left at most (four layers, x = 0.1 to 16, against steps a
# tenth as long, 2026-11-23).
EXPONENT: Final = 36.0


@dataclass(frozen=True, eq=False)
class EdgeState:
    """What one edge says of all loads.

    Attributes:
        row: Shape (n,).
        edge_density: y1, of a unit punch.
        stiffness: int phi1 over x, k_bar.
    """

    row: FloatArray
    edge_density: float
    stiffness: float


@dataclass(frozen=True, eq=False)
class EdgeSystems:
    """Solutions for one edge after the other, remembered.

    Attributes:
        kernel: N.
        count: Nodes of each panel.
    """

    kernel: PointKernel
    count: int
    known: dict[float, EdgeState] = field(default_factory=dict)

    def panels(self, x: float, count: int | None = None) -> RelativePanels:
        """The panels for an edge, with the nodes of its own systems or more.

        They are the same from one power of two to the next, where pieces in ln x begin: polynomials there would run
        across a jump of what nodes leave.
        """
        last = 2.0 ** np.ceil(np.log2(x))
        return relative_panels(count or self.count, max(1, int(np.ceil(MIDDLE * last / WIDEST))))

    def matrix(self, x: float, panels: RelativePanels) -> FloatArray:
        """M, and kappa as its last row, shape (n + 1, n)."""
        nodes, targets = panels.nodes, panels.targets
        distance = self.kernel(x * np.abs(targets[:, None] - nodes))
        difference = panels.matrix(distance, self.kernel(x * panels.near[0]))
        total = self.kernel(x * (targets[:, None] + nodes)) * panels.weights
        return np.asarray(x / np.pi * (difference + total))

    def at(self, x: float) -> EdgeState:
        """The state of one edge."""
        if x not in self.known:
            panels = self.panels(x)
            M = self.matrix(x, panels)
            system = np.eye(len(panels.nodes)) - M[:-1]
            row = np.linalg.solve(system.T, M[-1])
            phi = np.linalg.solve(system, np.ones(len(panels.nodes)))
            self.known[x] = EdgeState(row, 1 + float(row.sum()), float(panels.weights @ phi))
        return self.known[x]

    def edge_value(self, load: MappedFunction, x: float) -> float:
        """g = yg/y1 of a load g_hs that begins at the axis."""
        state, nodes = self.at(x), self.panels(x).nodes
        return float(load(np.array(x)) + state.row @ load(x * nodes)) / state.edge_density

    def density(self, x: float, panels: RelativePanels, load: FloatArray) -> tuple[FloatArray, FloatArray]:
        """phi at the nodes, and the layer's share M phi at nodes and edge, of a load at the nodes."""
        M = self.matrix(x, panels)
        phi = np.asarray(np.linalg.solve(np.eye(len(load)) - M[:-1], load), dtype=np.float64)
        return phi, np.asarray(M @ phi)

    def rest_of_resolvent(self, x: float, panels: RelativePanels) -> FloatArray:
        """rho = R(x, .) - K(x, .) at the nodes: rho = K rho + int K(t, s) K(s, x) ds, shape (n,)."""
        M = self.matrix(x, panels)[:-1]
        return np.asarray(np.linalg.solve(np.eye(len(M)) - M, self._iterated(x, x * panels.nodes)))

    def _iterated(self, x: float, t: FloatArray) -> FloatArray:
        """int_0^x K(t, s) K(s, x) ds: logarithms at s = t and x, which s = (length)/(1 + exp(-v)) moves to infinity.

        The layer's images, two thicknesses from the real axis, come as near as Im v = pi/2 + atan(2/x), so that the
        trapezoidal rule leaves exp(-2 pi Im v/step).
        """
        step = 2 * np.pi * (np.pi / 2 + np.arctan2(2.0, x)) / EXPONENT
        v = step * np.arange(-np.ceil(EXPONENT / step), np.ceil(EXPONENT / step) + 1)
        low, high = 1 / (1 + np.exp(-v)), 1 / (1 + np.exp(v))
        weight = step * low * high
        N, t = self.kernel, t[:, None]
        before = (N(t * high) + N(t * (1 + low))) * (N((x - t) + t * high) + N(x + t * low))
        beyond = (N((x - t) * low) + N(2 * t + (x - t) * low)) * (N((x - t) * high) + N(x + t + (x - t) * low))
        values: FloatArray = (t * before + (x - t) * beyond) @ weight / np.pi**2
        return values
