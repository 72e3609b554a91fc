"""Abel density of the pressure under one contact, from the factor of the layer's equation.

With lengths in units of the thickness, the pressure under a contact of radius a and density phi on [0, a] is

    p(r) = (E*/pi) [phi(a)/sqrt(a^2 - r^2) - int_r^a phi'(t)/sqrt(t^2 - r^2) dt].

The density is ``phi = W + psi``: the half-space's answer W (known, possibly with kinks) and the layer's share psi,
which is even and analytic because it is ``int K phi dt``. Only psi is represented here.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bem.layer_equation.fredholm_kernel import FredholmKernel
from bem.layer_equation.one_factorisation import STRIP, VolterraFactor
from bem.polynomials.abel_integral import even_abel_integral
from bem.polynomials.even_slopes import EvenSlopes
from bem.polynomials.gauss_panels import chebyshev_from_nodes, gauss_nodes, lagrange_matrix
from bem.polynomials.mapped import MappedFunction, MappedGrid
from bem.polynomials.truncation import orders_beyond, rate_of_decay
from contact.records.validation import FloatArray

EPS = float(np.finfo(float).eps)


@dataclass(frozen=True)
class ContactDensity:
    """Layer's share psi of the density under one contact of radius a.

    Attributes:
        kernel: Kernel of the layer.
        load: Averages of W over the panels' Lagrange basis, shape (q, m).
        psi: On the panels that cover [0, a], equally wide but for the last.
        last: psi at the nodes of the factor's panel that the last one is cut from, shape (m,).
        last_width: Width of that panel.
    """

    kernel: FredholmKernel
    load: FloatArray
    psi: MappedFunction
    last: FloatArray
    last_width: float

    @classmethod
    def of_load(cls, kernel: FredholmKernel, factor: VolterraFactor, ratio: float, load: FloatArray) -> ContactDensity:
        """Solve for the density under a contact of radius `ratio`.

        Args:
            kernel: Kernel that was factorised.
            factor: Its factor.
            ratio: a, in units of the thickness.
            load: Averages of W on the panels that cover [0, a], shape (q, m); the last panel ends at a.
        """
        panels = MappedGrid.between(np.append(factor.starts(len(load)), ratio), factor.count)
        phi, last = _solve(factor, panels.width[-1], load)
        width = float(factor.widths(len(load))[-1])
        return cls(kernel, load, MappedFunction(panels, phi - load, 0.0), last, width)

    @property
    def ratio(self) -> float:
        """a, in units of the thickness."""
        return self.psi.grid.end

    @property
    def edge_value(self) -> float:
        """psi(a)."""
        # Every Chebyshev polynomial is 1 at the right end.
        return float(self.psi.coefficients[-1].sum())

    @property
    def falls(self) -> bool:
        """phi at the nodes; on a panel it is a polynomial to rounding, but for the load's own kinks."""
        phi = (self.load + self.psi.node_values).ravel()
        return bool(np.all(np.diff(phi) <= EPS * phi[0]) and phi[-1] >= 0.0)

    @property
    def first_shell(self) -> float:
        """The kernel is analytic within two thicknesses of the real axis."""
        return 1.0

    def abel_integral(self, radius: FloatArray) -> FloatArray:
        """int_r^a psi'(t)/sqrt(t^2 - r^2) dt for radii in [0, a], shape (n,)."""
        return even_abel_integral(self.slope_over_position, self.psi.grid, radius)

    def abel_left_out(self) -> float:
        """What polynomials leave of `abel_integral`, in the norm with the weight r (a^2 - r^2).

        In t^2 that integral is half a derivative, so that an order m of size A on a panel becomes about sqrt(m) A: with
        the wave number pi m/(2 t H) in t^2 its square adds pi m/4 A^2 (a^2 - t^2). Between nodes the kernel is
        interpolated on the whole of the panel that the last one is cut from.
        """
        grid, count = self.psi.grid, self.psi.grid.count
        orders = orders_beyond(self.psi.coefficients)
        whole = chebyshev_from_nodes(count) @ self.last
        orders[-1] = max(orders[-1], float(orders_beyond(whole, rate_of_decay(2 * STRIP / self.last_width))))
        middle = grid.left + grid.width / 2
        return float(np.sqrt(np.pi / 4 * count * np.sum(orders**2 * (self.ratio - middle) * (self.ratio + middle))))

    @cached_property
    def slope_over_position(self) -> EvenSlopes:
        """psi'(t)/t at points of (0, a]."""
        return EvenSlopes.of(self.psi, STRIP)

    def outside(self, distance: FloatArray) -> FloatArray:
        """-int_0^a K(s, t) phi(t) dt at s = a + distance: the displacement's own Abel density outside the contact."""
        grid = self.psi.grid
        t, mass = grid.nodes.ravel(), ((self.load + self.psi.node_values) * grid.weights).ravel()
        rates = self.kernel.rates[:, None]
        moments = (np.exp(-rates * (self.ratio - t)) + np.exp(-rates * (self.ratio + t))) @ mass
        decay = np.exp(-np.multiply.outer(distance, self.kernel.rates))
        values: FloatArray = -(decay @ (self.kernel.weights * moments)).real / np.pi
        return values

    def outside_quickly(self, distance: FloatArray) -> FloatArray:
        """As `outside` but for roundings, with the exponentials of one panel shared by all as wide as it.

        Those of the factor's panels serve other contacts, too; only the last panel is cut at the edge.
        Gauss nodes are symmetric, so that they serve t from the panel's start and its end alike.
        """
        grid, rates = self.psi.grid, self.kernel.rates
        mass = (self.load + self.psi.node_values) * grid.weights
        after, before = (self.kernel.decay(x) for x in (self.ratio - grid.ends[1:], self.ratio + grid.left))
        moments = np.zeros_like(rates)
        for width in np.unique(grid.width):
            own = grid.width == width
            shared = self.kernel.decay_within(float(width), grid.count, keep=width in grid.width[:-1])
            moments += np.sum(after[own] * (mass[own, ::-1] @ shared) + before[own] * (mass[own] @ shared), axis=0)
        return -np.asarray((self.kernel.decay_again(distance) @ (self.kernel.weights * moments)).real) / np.pi


def _solve(factor: VolterraFactor, last_width: float, load: FloatArray) -> tuple[FloatArray, FloatArray]:
    """phi on whole panels and the last, shorter one: that from its Schur system, the others by back-substitution.

    And psi on the whole of the panel that the last one is cut from.
    """
    m, before = factor.count, (len(load) - 1) * factor.count
    tau, omega = gauss_nodes(m)
    E = lagrange_matrix(m, last_width / factor.widths(len(load))[-1] * tau)
    z, inherited = factor.eliminate(load)
    own = factor.schur[len(load) - 1]
    schur = E @ own @ E.T
    last = np.linalg.solve(np.eye(m) - schur * (last_width * omega), load[-1] + E @ inherited[-1])
    root = np.broadcast_to(factor.root_weights(len(load)), load.shape)
    mass = E.T @ (last_width * omega * last)
    returned = factor.lower.row(before, before + m).T @ (mass / root[-1])
    earlier = factor.lower.solve(z[:before] - returned, transposed=True)
    return np.vstack([earlier.reshape(-1, m) / root[:-1], last]), inherited[-1] + own @ mass
