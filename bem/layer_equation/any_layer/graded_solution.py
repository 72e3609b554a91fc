"""Flat punch on a graded layer: solutions at chosen edges, interpolated in the logarithm of the edge.

The kernel of a graded layer is like ln s for small distances, so y1 = 1 + x (A ln x + B) + ... near the axis. Edge
values, less what the half-space gives and over x, are smooth functions of ln x.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bem.layer_equation.any_layer.edge_systems import WIDEST, EdgeSystems
from bem.layer_equation.any_layer.graded_density import GradedDensity
from bem.layer_equation.any_layer.graded_edge_values import ResolventTable
from bem.layer_equation.any_layer.point_kernel import PointKernel
from bem.layer_equation.any_layer.relative_panels import RelativePanels, panels_with_bends
from bem.layer_equation.protocol import FlatPunchSolution
from bem.polynomials.chebyshev import piecewise_sum
from bem.polynomials.gauss_panels import chebyshev_from_nodes, gauss_nodes, lagrange_matrix
from bem.polynomials.mapped import MappedFunction
from bem.polynomials.truncation import between_nodes, orders_beyond
from contact import InvalidInput, Profile
from contact.records.validation import FloatArray

# Ends of the pieces in ln x below one thickness; from there on they double. Below the first, values continue linearly.
SMALL_ENDS: Final = (2.0**-18, 2.0**-9, 2.0**-5, 2.0**-4, 2.0**-3, 0.25, 0.5, 1.0)
# A profile's pieces begin at this power of two: the moment of a cone, whose density is x ln x there, keeps 1e-12.
FINEST_PIECE: Final = -12
# Pieces beyond rims and bends grow by this factor, so that a root at their start leaves 9.9^-12, from this share of the
# thickness on, which leaves itself times 1e-5 of a depth.
GROWTH: Final = 1.5
FIRST_STEP: Final = 6e-8
# Edges on each piece, and nodes on each of a profile's, beyond the nodes of a panel: without them 5e-12 of k_bar is
# left at the end of an octave.
MORE_ON_PIECE: Final = 4
# Nodes by which the coarser panels fall short with which the edges of `CHECKED` are compared.
FEWER: Final = 3
# Further nodes of a panel where a density's slope is asked for, as pressures do: with 12 in all pressures are up to
# 1.5e-8 off, with 16 3e-10.
MORE_FOR_DENSITY: Final = 4
# Edges that are solved with more nodes besides the last: errors grow by powers up to a/h = 2, beyond which panels in
# the middle are split, fall there, and grow again.
COMPARED: Final = (0.2, 0.5, 1.0, 2.0, 2.0 + 2e-9)
# Shares of the largest edge that are compared.
CHECKED: Final = (0.02, 0.2, 0.6, 1.0)
# Times the difference from more nodes: an error between the edges where both are solved. With it and what the resolvent
# leaves out, stated errors of depth and force covered 100 % each and were 6 and 7.5 times the true in the median (six
# layers, three flat ends, a table of points, a cone and a paraboloid, 216 radii, a/h = 0.05 to 3.7, seed 11, against
# the direct equation on 18 nodes, 2026-11-23).
MARGIN: Final = 2.0
# Added to it, of 1 + k_bar: all nodes share one kernel. Wrong by dK it moves k_bar by <phi, dK phi>/<1, phi> of itself,
# and |phi|^2/<1, phi> grows like k_bar. By what `graded.TOLERANCE` leaves, k_bar and y1 move by 6.5e-15 k_bar at most
# (21 layers, a/h = 0.5 to 16, k_bar = 0.3 to 26 000, against a tolerance of 3e-14, 2026-11-23).
KERNEL_ERROR: Final = 1e-14
# Share of that difference that is stated. Three nodes fewer on panels graded by a quarter err at least 27 times as much
# where a density is interpolated.
# Against another grading with 14 nodes, k_bar, depth and force erred by up to 0.15 of it (three layers, a/h = 0.05 to
# 1.9, 2026-11-22).
SHARE: Final = 0.3
# Times the discretisation error, and gives that of a pressure: it comes from the slope of interpolated densities, which
# magnifies what is left in them by the square of the nodes, and more beside the edge. Against 17 nodes a panel the
# largest error anywhere was 300 to 1200 times the discretisation error (paraboloid and flat punch on four layers,
# 2026-11-22).
SLOPE: Final = 2.5e3


@dataclass(frozen=True, eq=False)
class LogPieces:
    """A function of x by polynomials in ln x on pieces.

    Attributes:
        ends: Shape (P + 1,), in ln x.
        coefficients: Shape (P, m).
    """

    ends: FloatArray
    coefficients: FloatArray

    def __call__(self, x: FloatArray) -> FloatArray:
        """Values at x > 0; below the first end they continue linearly."""
        piece, s = self._locate(x)
        first = np.polynomial.chebyshev.chebder(self.coefficients[0]) * 2 / (self.ends[1] - self.ends[0])
        slope = float(np.polynomial.chebyshev.chebval(-1.0, first))
        below = np.minimum(_logarithm(x) - self.ends[0], 0.0)
        return np.asarray(piecewise_sum(self.coefficients, piece, s) + slope * below)

    def error(self, x: FloatArray) -> FloatArray:
        """What the polynomials leave out at x."""
        piece, s = self._locate(x)
        return np.asarray(orders_beyond(self.coefficients)[piece] * between_nodes(self.coefficients.shape[1], s))

    def _locate(self, x: FloatArray) -> tuple[NDArray[np.intp], FloatArray]:
        """Number of the piece, and the position in [-1, 1] there."""
        inside = np.clip(_logarithm(x), self.ends[0], self.ends[-1])
        piece = np.clip(np.searchsorted(self.ends, inside) - 1, 0, len(self.coefficients) - 1)
        return piece, 2 * (inside - self.ends[piece]) / np.diff(self.ends)[piece] - 1


def _logarithm(x: FloatArray) -> FloatArray:
    return np.asarray(np.log(np.maximum(x, 1e-300)))


@dataclass(frozen=True)
class ResolvedProfile(MappedFunction):
    """A profile whose edge values come from the tabulated resolvent.

    Attributes:
        unresolved: What that leaves out of them at the grid's nodes, relative to them, shape (q, m).
    """

    unresolved: FloatArray

    def resolvent_error(self, d: FloatArray) -> FloatArray:
        """The same at points d: errors at nodes differ in sign, and at the end of a piece polynomials magnify them."""
        piece, u = self.grid.locate(d)
        terms = lagrange_matrix(self.grid.count, u) * self.unresolved[piece]
        return np.asarray(np.sqrt(np.sum(terms**2, axis=-1)))


@dataclass(frozen=True)
class SmoothProfile(MappedFunction):
    """A profile without rims and bends, whose edge values are interpolated as those of punches are.

    Attributes:
        share: Of its edge values yg, (yg/g_hs - 1)/x.
        node_errors: Some edges, and the relative error of g = yg/y1 that the nodes of panels leave there.
    """

    share: LogPieces
    node_errors: tuple[FloatArray, FloatArray]

    def error(self, x: FloatArray) -> FloatArray:
        """Relative error of g at x, but for what polynomials leave of y1."""
        between = x * self.share.error(x) / np.abs(1 + x * self.share(x))
        return np.asarray(_by_powers(x, *self.node_errors) + between)


@dataclass(frozen=True, eq=False)
class GradedSolution(FlatPunchSolution):
    """The flat punch on one graded layer up to `max_ratio`.

    Attributes:
        kernel: N.
        reach: Largest a/h, a power of two.
        count: Nodes of a panel.
    """

    kernel: PointKernel
    reach: float
    count: int
    displacement_known: ClassVar[bool] = True

    @property
    def max_ratio(self) -> float:
        """Largest a/h that is covered."""
        return self.reach

    @property
    def nodes(self) -> int:
        """Nodes on each piece of a profile's grid."""
        return self.count + MORE_ON_PIECE

    @property
    def unknowns(self) -> int:
        """Of the largest system."""
        return len(self._edges.panels(self.max_ratio).nodes)

    def normalized_contact_stiffness(self, ratio: ArrayLike) -> FloatArray:
        """k_bar."""
        x = self._covered(ratio)
        return 1 + x * self._tables[1](x)

    def normalized_spring_stiffness(self, ratio: ArrayLike) -> FloatArray:
        """c_bar = y1^2."""
        x = self._covered(ratio)
        return np.asarray((1 + x * self._tables[0](x)) ** 2)

    def smooth_pressure(self, rho: ArrayLike, ratio: ArrayLike) -> FloatArray:
        """q = p_bar sqrt(1 - rho^2) from the density, one solution for each different ratio."""
        rho, ratio = np.broadcast_arrays(np.asarray(rho, dtype=float), self._covered(ratio))
        q = np.empty(rho.shape)
        for a in np.unique(ratio):
            own = ratio == a
            panels = self._panels_under(None, 0.0, float(a))
            density = self._density(float(a), panels, np.ones(len(panels.nodes)))
            edge = np.sqrt((1 - rho[own]) * (1 + rho[own])) * a
            inner = 1 + density.edge_value - edge * density.abel_integral(a * rho[own])
            q[own] = inner / (2 * self.normalized_contact_stiffness(a))
        return q

    def relative_error(self, ratio: ArrayLike) -> FloatArray:
        """Bound of the relative error of k_bar."""
        x = self._covered(ratio)
        return self._error_of_nodes(x) + x * self._tables[1].error(x) / self.normalized_contact_stiffness(x)

    def spring_error(self, ratio: ArrayLike) -> FloatArray:
        """Bound of the relative error of c_bar."""
        x = self._covered(ratio)
        return np.asarray(2 * (self._error_of_nodes(x) + self._error_between_edges(x)))

    def profile_error(self, ratio: ArrayLike, start: ArrayLike = 0.0) -> FloatArray:
        """As that of the springs, since profiles are interpolated likewise."""
        return self.spring_error(ratio)

    def error_of_profile(self, ratio: FloatArray, profile: MappedFunction, flat_radius: float) -> FloatArray:
        """Beyond flat ends and bends only y1 of g = yg/y1 is interpolated, and yg has what the resolvent leaves out.

        Elsewhere most of what nodes leave cancels between yg and y1, and g itself is compared with more of them.
        """
        x = self._covered(ratio)
        if isinstance(profile, SmoothProfile):
            return profile.error(x) + self._error_between_edges(x)
        if not isinstance(profile, ResolvedProfile):
            return super().error_of_profile(ratio, profile, flat_radius)
        own = 2 * self._error_of_nodes(x) + self._error_between_edges(x)
        return np.asarray(own + profile.resolvent_error(x - flat_radius))

    def error_in_force(
        self,
        ratio: FloatArray,
        profile: MappedFunction,
        flat_radius: float,
        *,
        stiffness: FloatArray,
        spread: FloatArray,
    ) -> FloatArray:
        """Each edge has its own panels, so that k_N errs otherwise than int c_N dx, and F = k_N g - 2 int c_N g dx.

        Behind a split panel the errors that c_N has before it are the larger ones.
        """
        x = np.maximum(ratio[..., None] * np.linspace(0.0, 1.0, 17), flat_radius)
        g = profile(x - flat_radius)
        gained = np.diff(g, axis=-1) * (x * self.normalized_contact_stiffness(x))[..., 1:]
        share = np.divide(gained, gained.sum(axis=-1, keepdims=True), out=np.zeros_like(gained), where=gained > 0.0)
        errors = self._error_of_nodes(x[..., 1:])
        return np.asarray(spread * np.maximum(stiffness, np.sum(share * errors, axis=-1)))

    def panel_ends(self, ratio: float) -> FloatArray:
        """A profile and its moment have the logarithm's kink at the axis: pieces double from close to it."""
        ends = np.append(2.0 ** np.arange(FINEST_PIECE, -5.0), self._ends[2:])
        return np.asarray(ends[ends < ratio])

    @property
    def bend_steps(self) -> FloatArray:
        """Growing with the distance d, since beyond a bend edge values are like d ln d."""
        return np.asarray(FIRST_STEP * GROWTH ** np.arange(np.log(self.max_ratio / FIRST_STEP) / np.log(GROWTH)))

    def profile_of(
        self, indenter: Profile, unit: float, load: MappedFunction, springs: FloatArray
    ) -> tuple[MappedFunction, float]:
        """g = yg/y1 from edges in ln x.

        One with a flat end or bends is taken edge by edge.
        """
        bends = tuple(k for k in indenter.breakpoints if k > 0)
        if indenter.flat_radius or bends:
            flat = indenter.flat_radius / unit
            found = np.array([self._resolvent.layer_share(load, flat, float(d)) for d in load.grid.nodes.ravel()])
            share, left_out = (column.reshape(load.node_values.shape) for column in found.T)
            edge = load.node_values + share
            return ResolvedProfile(load.grid, edge / np.sqrt(springs), load.lead, left_out / edge), 0.0
        share = self._smooth_share(load)
        values = load.node_values * (1 + load.grid.nodes * share(load.grid.nodes)) / np.sqrt(springs)
        return SmoothProfile(load.grid, values, load.lead, share, self._profile_errors(load)), 0.0

    def contact_density(
        self, load: MappedFunction | None, flat_radius: float, ratio: float, depth: float
    ) -> GradedDensity:
        """Solved for under W = delta - g_hs."""
        panels = self._panels_under(load, flat_radius, ratio)
        W = np.full(len(panels.nodes), depth)
        if load is not None:
            risen = ratio * panels.nodes - flat_radius
            W -= np.where(risen > 0, load(np.clip(risen, 0.0, load.grid.end)), 0.0)
        return self._density(ratio, panels, W)

    def _panels_under(self, load: MappedFunction | None, flat_radius: float, ratio: float) -> RelativePanels:
        """Panels that shrink towards the load's rim and bends too, where it begins like a root."""
        marks = np.empty(0) if load is None else flat_radius + load.grid.left[load.grid.power > 1]
        marks = marks[marks > 0]
        if not marks.size:
            return self._edges.panels(ratio, self.count + MORE_FOR_DENSITY)
        return panels_with_bends(tuple((marks / ratio).tolist()), WIDEST / ratio, self.count + MORE_FOR_DENSITY)

    def contact_pressure_error(self, ratio: FloatArray, depth_error: FloatArray) -> FloatArray:
        """What the slopes of interpolated densities lose."""
        return np.asarray(depth_error + SLOPE * self.discretisation_error)

    @cached_property
    def discretisation_error(self) -> float:
        """Relative error of edge values, from fewer nodes on a panel."""
        coarse = EdgeSystems(self.kernel, max(self.count - FEWER, 1))
        edges = [share * self.max_ratio for share in CHECKED]
        changes = [abs(coarse.at(x).edge_density / self._edges.at(x).edge_density - 1) for x in edges]
        return SHARE * max(changes) + 1e-14

    def _error_between_edges(self, ratio: FloatArray) -> FloatArray:
        """Relative error of y1 that polynomials in ln x leave."""
        return np.asarray(ratio * self._tables[0].error(ratio) / np.sqrt(self.normalized_spring_stiffness(ratio)))

    def _error_of_nodes(self, ratio: FloatArray) -> FloatArray:
        """Relative error of edge values and of k_bar that the nodes of panels leave, by powers between known edges."""
        return _by_powers(ratio, *self._node_errors)

    @cached_property
    def _node_errors(self) -> tuple[FloatArray, FloatArray]:
        """At some edges, from more nodes on a panel."""
        edges, errors = _compared_edges(self.max_ratio), []
        for x in edges.tolist():
            ours, other = self._edges.at(x), self._finer_edges.at(x)
            changes = ours.edge_density / other.edge_density - 1, ours.stiffness / other.stiffness - 1
            errors.append(MARGIN * max(np.abs(changes)) + KERNEL_ERROR * (1 + ours.stiffness))
        return edges, np.array(errors)

    def _profile_errors(self, load: MappedFunction) -> tuple[FloatArray, FloatArray]:
        """The same of g = yg/y1 under one profile."""
        edges = _compared_edges(load.grid.end)
        found = [[systems.edge_value(load, x) for systems in (self._edges, self._finer_edges)] for x in edges.tolist()]
        ours, other = np.array(found).T
        kernel = KERNEL_ERROR * (1 + self.normalized_contact_stiffness(edges))
        return edges, MARGIN * np.abs(ours / other - 1) + kernel

    def _density(self, ratio: float, panels: RelativePanels, load: FloatArray) -> GradedDensity:
        phi, psi = self._edges.density(ratio, panels, load)
        return GradedDensity(self.kernel, panels, ratio, phi, psi)

    @cached_property
    def _resolvent(self) -> ResolventTable:
        ends = np.log(self._ends)
        return ResolventTable.of_edges(self._finer_edges, ends, _piece_nodes(ends, self.nodes))

    @cached_property
    def _finer_edges(self) -> EdgeSystems:
        return EdgeSystems(self.kernel, self.count + MORE_FOR_DENSITY)

    @cached_property
    def _edges(self) -> EdgeSystems:
        return EdgeSystems(self.kernel, self.count)

    @property
    def _ends(self) -> tuple[float, ...]:
        doublings = max(int(np.ceil(np.log2(self.max_ratio))), 0)
        return (*SMALL_ENDS, *(2.0**n for n in range(1, doublings + 1)))

    @cached_property
    def _tables(self) -> tuple[LogPieces, LogPieces]:
        """(y1 - 1)/x and (k_bar - 1)/x."""
        u = np.log(self._ends)
        states = [[self._edges.at(float(x)) for x in row] for row in _piece_nodes(u, self.nodes)]
        x = _piece_nodes(u, self.nodes)
        springs = (np.array([[state.edge_density for state in row] for row in states]) - 1) / x
        stiffness = (np.array([[state.stiffness for state in row] for row in states]) - 1) / x
        return _pieces(u, springs), _pieces(u, stiffness)

    def _smooth_share(self, load: MappedFunction) -> LogPieces:
        """(yg/g_hs - 1)/x of a profile without breakpoints."""
        end = load.grid.end
        u = np.log(np.array([*(e for e in self._ends if e < end * (1 - 1e-9)), end]))
        if u.size == 1:
            u = np.append(u[0] - 1.0, u)
        x = _piece_nodes(u, self.nodes)
        share = np.empty_like(x)
        for place, edge in np.ndenumerate(x):
            state, panels = self._edges.at(float(edge)), self._edges.panels(float(edge))
            share[place] = (state.row @ load(edge * panels.nodes)) / float(load(np.array(edge))) / edge
        return _pieces(u, share)

    def _covered(self, ratio: ArrayLike) -> FloatArray:
        x = np.asarray(ratio, dtype=float)
        if not np.all((x >= 0) & (x <= self.max_ratio * (1 + 1e-12))):
            raise InvalidInput(f"a/h = {x.max():g}: this flat-punch solution covers [0, {self.max_ratio:g}]")
        return np.asarray(np.minimum(x, self.max_ratio))


def _compared_edges(end: float) -> FloatArray:
    """Edges up to the end at which systems of more nodes are solved."""
    return np.append([edge for edge in COMPARED if edge < end], end)


def _by_powers(x: FloatArray, edges: FloatArray, errors: FloatArray) -> FloatArray:
    """Errors known at some edges, at x between them."""
    position = np.log(np.maximum(x, edges[0]))
    return np.asarray(np.exp(np.interp(position, np.log(edges), np.log(errors))))


def _piece_nodes(u: FloatArray, count: int) -> FloatArray:
    """x at the nodes of all pieces, shape (P, m)."""
    return np.asarray(np.exp(u[:-1, None] + np.diff(u)[:, None] * gauss_nodes(count)[0]))


def _pieces(u: FloatArray, values: FloatArray) -> LogPieces:
    return LogPieces(u, values @ chebyshev_from_nodes(values.shape[1]).T)
