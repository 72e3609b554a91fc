"""The Abel density of one contact by a dense solve: the second boundary route, which shares only chi with the first.

With lengths in units of the layer thickness and W = delta - g_hs, the density phi on [0, a] solves

    phi(x) - (2/pi) int_0^a L(x, t) phi(t) dt = W(x),    L(x, t) = int_0^inf (1 - chi(k)) cos(kx) cos(kt) dk.

What the layer adds, psi = phi - W, is smooth whatever the profile, so it is what is solved for, on equal pieces; of W
only integrals are needed. L is formed as it stands: Gauss nodes in k on the real axis, fine enough for cos(ka), and one
matrix product. So psi is a sum of cosines, which is differentiated term by term for the pressure. On the half-space
there are no wavenumbers and psi = 0.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from scipy.special import j0

from bem.kernels.of_layer import surface_kernel
from bem.layer_equation.inside.density import Density, Piece, pieces_of
from bem.layer_equation.profiles.half_space_slope import profile_slope, room_to_pole
from bem.layer_equation.triangular import solve_positive
from bem.polynomials.abel_integral import (
    AbelNodes,
    Stretch,
    abel_integral,
    arc_integral,
    even_abel_integral,
    graded_ends,
)
from bem.polynomials.gauss_panels import gauss_nodes
from bem.polynomials.mapped import MappedFunction, MappedGrid
from bem.polynomials.stretch_slopes import StretchSlopes
from contact import ElasticLayer, NotConvergedError, Profile, Sphere
from contact.records.validation import FloatArray

# Wavenumber times thickness beyond which 1 - chi is below 1e-17 and left out.
LARGEST_WAVENUMBER = 24.0
# On a stack the first panel of wavenumbers is halved so many times more than the longest length asks for; chosen.
LONG_HALVINGS = 4
# Gauss nodes of a panel of wavenumbers, and the largest phase of a cosine on it: a rule of n nodes integrates cosines
# over a phase below n to rounding, and 1 - chi is analytic within 2.5 of the real axis (panels are at most 2 wide).
WAVE_NODES, PANEL_PHASE = 40, 48.0
# Gauss nodes of a stretch on which the profile is analytic: exact for the cubics of tables, whose f' is a trigonometric
# polynomial of theta.
SMOOTH_NODES = 24
# Panels of the rule for g_hs towards either end of a stretch: the last is 5e-10 of it.
CROWDING = 15
# Gauss nodes on each of these panels. Close to a sphere's equator f' is singular as near as the panel begins, where the
# error of n nodes is 3.0^(-2n): 4e-12 for 12, 5e-16 for 16.
CROWDED_NODES = 16
# Slopes of a profile without a closed form are sampled at so many times the nodes of a panel on each of its stretches.
SLOPE_SHARE = 2
# Ratio of neighbouring pieces that approach a point where g_hs is not smooth.
GRADING = 0.25
# Pieces towards a root, at the rim of a flat end: the last is 1e-12 of the first, and what its nodes miss of the root's
# integral is 1e-18.
LEVELS = 20
# Pieces towards a power 3/2, at a bend: the last is 2e-5 of the first, and its nodes miss 1e-12 of the 1e-6 there.
SMOOTHER_LEVELS = 8
# Pieces towards the tip, where a profile may rise like any power of r above one.
TIP_LEVELS = 6


@dataclass(frozen=True, eq=False)
class DirectDensity:
    """Densities under a flat punch pressed in by one unit and for the profile's g_hs, for one contact radius.

    Columns of arrays with two columns stand for W = 1 and W = g_hs, in this order.

    Attributes:
        layer: The layer.
        indenter: The profile.
        unit: Length unit [m] of all that follows: the thickness, or the contact radius on the half-space.
        reach: a - b [m] over the radius b of the flat end, with all its digits.
        load: g_hs over offsets from b, up to the excess.
        load_at_edge: g_hs(a).
        grid: Pieces of [0, a] where psi is known.
        psi: At their nodes, shape (n, 2).
        wavenumbers: k, shape (m,).
        amplitudes: Of psi = sum A cos(kx), shape (m, 2).
    """

    layer: ElasticLayer
    indenter: Profile
    unit: float
    reach: float
    load: MappedFunction
    load_at_edge: float
    grid: MappedGrid
    psi: FloatArray
    wavenumbers: FloatArray
    amplitudes: FloatArray

    @classmethod
    def solve(cls, layer: ElasticLayer, indenter: Profile, excess: float, width: float, nodes: int) -> DirectDensity:
        """Assemble and solve for one excess a - b [m], on pieces of at most `width` thicknesses with `nodes` nodes.

        Raises:
            NotConvergedError: If the matrix is not positive definite in double precision.
        """
        flat = indenter.flat_radius
        a = flat + excess
        unit = a if layer.is_half_space else layer.surface.thickness
        pieces = graded_pieces(indenter, excess, unit, width, nodes)
        load = load_on(indenter, excess, pieces, unit)
        grid = MappedGrid.equal(a / unit, int(np.ceil(a / unit / width)), nodes)
        k, weight = layer_waves(layer, 2 * a / unit)
        moments = _moments(load, flat / unit, a / unit, k)
        psi = _solve(grid, k, weight, moments)
        amplitudes = 2 / np.pi * weight[:, None] * (moments + _transform(grid, psi, k))
        at_edge = float(half_space_load(indenter, np.full(1, excess))[0]) / unit
        return cls(layer, indenter, unit, excess, load, at_edge, grid, psi, k, amplitudes)

    @property
    def kernel_error(self) -> float:
        """Error of chi beyond a rounding."""
        return 0.0

    @property
    def flat(self) -> float:
        """b, in length units."""
        return self.indenter.flat_radius / self.unit

    @property
    def excess(self) -> float:
        """a - b, in length units."""
        return self.reach / self.unit

    @property
    def contact_radius(self) -> float:
        """a, in length units."""
        return self.flat + self.excess

    @cached_property
    def edge_values(self) -> FloatArray:
        """phi(a), shape (2,): the equation itself at x = a."""
        at_edge: FloatArray = np.array([1.0, self.load_at_edge]) + self.amplitudes.T @ np.cos(
            self.wavenumbers * self.contact_radius
        )
        return at_edge

    @cached_property
    def integrals(self) -> FloatArray:
        """int phi dt, shape (2,)."""
        loads = np.array([self.contact_radius, float(np.sum(self.load.grid.weights * self.load.node_values))])
        total: FloatArray = loads + self.grid.weights.ravel() @ self.psi
        return total

    @property
    def depth(self) -> float:
        """delta, in length units, that makes phi(a) = 0: no singular pressure at the edge."""
        return float(self.edge_values[1] / self.edge_values[0])

    def force(self, depth: float) -> float:
        """F_N/(E* unit^2) = 2 int phi dt under a depth in length units."""
        return 2 * float(self.integrals @ under(depth))

    @property
    def stiffness(self) -> float:
        """k_N/(E* unit)."""
        return 2 * float(self.integrals[0])

    def pressure(self, offset: FloatArray, depth: float, *, singular_edge: bool) -> FloatArray:
        """p/E* at offsets r - b in length units, shape (n,), of radii 0 <= r < a."""
        radius = self.flat + offset
        total = -self._smooth_integral(radius, depth)
        for stretch in self._stretches:
            total += abel_integral(self._profile_slope, stretch, radius, offset)
        if singular_edge:
            edge = self.edge_values @ under(depth)
            total += edge / np.sqrt((self.excess - offset) * (self.contact_radius + radius))
        return total / np.pi

    @cached_property
    def stretch_ends(self) -> FloatArray:
        """Offsets of the axis, of the breakpoints within the contact, and of its edge."""
        breaks = (np.array(self.indenter.breakpoints) - self.indenter.flat_radius) / self.unit
        return np.unique([-self.flat, *breaks[breaks < self.excess], self.excess])

    @cached_property
    def _stretches(self) -> list[Stretch]:
        """Where the profile has risen; it has its pole, if any, where it ends."""
        ends = self.stretch_ends[self.stretch_ends >= 0].tolist()
        graded = graded_ends(ends, min((self._room_at(end) for end in ends[1:]), default=np.inf))
        rooms = [self._room_at(end) for end in graded[1:]]
        starts = zip(graded[:-1], graded[1:], rooms, strict=True)
        return [Stretch(self.flat, float(start), float(stop), float(room)) for start, stop, room in starts]

    def _room_at(self, offset: float) -> float:
        room = _room(self.indenter, self.reach)
        return room_to_pole(self.indenter, self.unit * (self.flat + offset), room) / self.unit

    def _profile_slope(self, nodes: AbelNodes) -> FloatArray:
        return self._slope_at(nodes.offset, nodes.room)

    def _slope_at(self, offset: FloatArray, room: FloatArray) -> FloatArray:
        """g_hs' at offsets with what is left to the pole."""
        closed = profile_slope(self.indenter, self.unit * offset, self.unit * room)
        return self._sampled_slope(offset) if closed is None else closed

    @cached_property
    def _sampled_slope(self) -> StretchSlopes:
        ends = np.array([stretch.start for stretch in self._stretches] + [self.excess])
        unit, count = self.unit, SLOPE_SHARE * self.grid.count
        return StretchSlopes.of(lambda d: half_space_load(self.indenter, unit * d) / unit, self.flat, ends, count)

    def _smooth_integral(self, radius: FloatArray, depth: float) -> FloatArray:
        """int_r^a psi'(t)/sqrt(t^2 - r^2) dt, psi'/t by its polynomials on the pieces."""
        slopes = MappedFunction(self.grid, (self._smooth_slopes @ under(depth)).reshape(self.grid.nodes.shape), 0.0)
        return even_abel_integral(slopes, self.grid, radius)

    def inside(self, depth: float, *, singular_edge: bool) -> Density:
        """phi under a depth, as the fields inside ask for it."""
        smooth = MappedFunction(self.grid, (self._smooth_slopes @ under(depth)).reshape(self.grid.nodes.shape), 0.0)

        def slope(piece: Piece, offset: FloatArray) -> FloatArray:
            """phi' = psi' - g_hs'."""
            t = np.minimum(piece.start + offset, self.contact_radius)
            return np.asarray(t * smooth(t) + self.slope_of_load(piece, offset))

        edge = float(self.edge_values @ under(depth)) if singular_edge else 0.0
        return Density(self.contact_radius, edge, pieces_of(self.indenter, self.unit, self._stretches), slope, 1.0)

    def slope_of_load(self, piece: Piece, offset: FloatArray) -> FloatArray:
        """-g_hs' at offsets from where a piece begins."""
        if piece.start < self.flat or not self._stretches:
            return np.zeros_like(offset)
        before = piece.start - self.flat
        return -self._slope_at(before + offset, self._stretches[-1].room + ((self.excess - before) - offset))

    @cached_property
    def _smooth_slopes(self) -> FloatArray:
        """psi'(t)/t = -sum A k sin(kt)/t at the nodes, shape (n, 2)."""
        k = self.wavenumbers
        waves = k**2 * np.sinc(np.multiply.outer(self.grid.nodes.ravel(), k) / np.pi)
        slopes: FloatArray = -waves @ self.amplitudes
        return slopes

    def displacement_outside(self, radius: FloatArray, depth: float) -> FloatArray:
        """w at radii r > a in length units: (2/pi) [int phi/sqrt(r^2 - t^2) dt - int (1 - chi) phi^ J0(kr) dk]."""
        if not radius.size:
            return np.zeros(0)
        outside = self.beside_height(radius, depth)
        if self._stretches:
            outside = outside - 2 / np.pi * arc_integral(radius, self._finer_load, self.flat, 2 * self.load.grid.count)
        return outside

    def beside_height(self, radius: FloatArray, depth: float) -> FloatArray:
        """The same without the integral of g_hs, which does not depend on what was solved."""
        k, weight = layer_waves(self.layer, self.contact_radius + float(radius.max()))
        transform = _moments(self.load, self.flat, self.contact_radius, k) + _transform(self.grid, self.psi, k)
        layer = j0(np.multiply.outer(radius, k)) @ (weight * (transform @ under(depth)))
        grid = _doubled(self.grid)
        psi = np.cos(np.multiply.outer(grid.nodes, self.wavenumbers)) @ (self.amplitudes @ under(depth))
        share = arc_integral(radius, MappedFunction(grid, psi, 0.0), 0.0, grid.count)
        return np.asarray(2 / np.pi * (depth * np.arcsin(self.contact_radius / radius) + share - layer))

    @cached_property
    def _finer_load(self) -> MappedFunction:
        """g_hs on twice as many nodes."""
        return load_on(self.indenter, self.reach, _doubled(self.load.grid), self.unit)


def _doubled(grid: MappedGrid) -> MappedGrid:
    """The pieces with twice as many nodes, whose polynomials miss as little as Gauss's rule of the given ones."""
    return replace(grid, count=2 * grid.count)


def under(depth: float) -> FloatArray:
    """W = delta - g_hs in terms of the two loads."""
    return np.array([depth, -1.0])


def _room(indenter: Profile, excess: float) -> float:
    """Distance [m] from the contact's edge to the end of a profile that is upright there; infinite for others."""
    is_upright = indenter.max_radius not in indenter.breakpoints
    return indenter.max_radius - indenter.flat_radius - excess if is_upright else np.inf


def graded_pieces(indenter: Profile, excess: float, unit: float, widest: float, count: int) -> MappedGrid:
    """Pieces of the offsets from 0 to a - b, graded where g_hs begins like a root, a power 3/2 or that of a tip.

    Args:
        indenter: The profile.
        excess: a - b [m].
        unit: Length unit [m] of the pieces.
        widest: Largest piece.
        count: Nodes on each.
    """
    end, room = excess / unit, _room(indenter, excess) / unit
    bends = (np.array(indenter.breakpoints) - indenter.flat_radius) / unit
    points = np.unique(np.concatenate([[0.0], bends[(bends > 0) & (bends < end)], [end]]))
    ends = [points[:1], _towards_pole(end, room)]
    for start, stop in pairwise(points):
        pole = room_to_pole(indenter, indenter.flat_radius + unit * float(start), np.inf) / unit
        ends.append(_towards_pole(start, pole))
        levels = SMOOTHER_LEVELS if start > 0 else LEVELS if indenter.flat_radius > 0 else TIP_LEVELS
        levels += (
            max(int(np.ceil(np.log((stop - start) / pole) / -np.log(GRADING))), 0)
            if start > 0 and 0 < pole < np.inf
            else 0
        )
        ends.append(start + (stop - start) * GRADING ** np.arange(levels, -1, -1.0))
    # Beside a distant point the smallest pieces round to nothing.
    coarse = np.unique(np.concatenate(ends))
    parts = np.maximum(np.ceil(np.diff(coarse) / widest), 1).astype(int)
    fine = [np.linspace(a, b, n + 1)[1:] for a, b, n in zip(coarse[:-1], coarse[1:], parts, strict=True)]
    return MappedGrid.between(np.concatenate([coarse[:1], *fine]), count)


def _towards_pole(end: float, room: float) -> FloatArray:
    """Ends of pieces that double with their distance from a pole at end + room, down to the middle of [0, end]."""
    doublings = max(np.ceil(np.log2((end + room) / (2 * room))), 0.0) if 0 < room < end else 0.0
    return np.asarray(end - room * (2.0 ** np.arange(1.0, doublings) - 1))


def load_on(indenter: Profile, excess: float, pieces: MappedGrid, unit: float) -> MappedFunction:
    """g_hs in units of `unit` on pieces up to the excess a - b [m]."""
    rooms = _room(indenter, excess) + unit * pieces.to_end
    return MappedFunction(pieces, half_space_load(indenter, unit * pieces.nodes, rooms) / unit, 0.0)


def half_space_load(indenter: Profile, excess: FloatArray, room: FloatArray | None = None) -> FloatArray:
    """g_hs = x int_0^(pi/2) f'(x sin(theta)) dtheta [m] at x = b + excess, between the profile's breakpoints.

    The nodes crowd towards both ends of a stretch that starts at the tip or a kink, or is the last: f' may begin there
    with any power of r, or grow steep towards x. On the others it is analytic from end to end.

    Args:
        indenter: Profile of revolution.
        excess: x - b [m].
        room: What is left [m] from x to the end of a profile that is upright there, if it is known with more digits.
    """
    flat = indenter.flat_radius
    room = indenter.max_radius - flat - excess if room is None else room
    starts = [0.0, *(k - flat for k in indenter.breakpoints if 0 < k - flat < np.max(excess)), np.inf]
    total = np.zeros_like(excess)
    for start, stop in pairwise(starts):
        is_smooth = start != 0.0 and start + flat not in indenter.kinks and stop < np.inf
        beyond = excess > start
        total[beyond] += _over_stretch(indenter, excess[beyond], room[beyond], (start, stop), is_smooth=is_smooth)
    return (flat + excess) * total


def _over_stretch(
    indenter: Profile, excess: FloatArray, room: FloatArray, stretch: tuple[float, float], *, is_smooth: bool
) -> FloatArray:
    """The part of the integral of f' over theta where r = x sin(theta) lies on a stretch that starts before x.

    Args:
        indenter: Profile of revolution.
        excess: x - b [m].
        room: From x to the profile's end [m].
        stretch: Its ends as offsets from b [m].
        is_smooth: Whether f' is analytic from end to end.
    """
    flat, (start, stop) = indenter.flat_radius, stretch
    x = flat + excess
    s, weights = gauss_nodes(SMOOTH_NODES) if is_smooth else _crowded_rule()
    widest, narrowest = _angle(x, excess - start), _angle(x, np.maximum(excess - stop, 0.0))
    # This is pi/2 - theta; both rules are symmetric, and 1 - s has its digits at the other end.
    angle = np.multiply.outer(widest, s[::-1]) + np.multiply.outer(narrowest, s)
    last = np.minimum(x, flat + stop)[:, None]
    radius = np.clip(x[:, None] * np.cos(angle), np.minimum(flat + start, last), last)
    inside = _slope(indenter, radius, room[:, None] + x[:, None] * (2 * np.sin(angle / 2) ** 2))
    part: FloatArray = (widest - narrowest) * (inside @ weights)
    return part


def _slope(indenter: Profile, radius: FloatArray, room: FloatArray) -> FloatArray:
    """f'(r) at r [m], which a sphere tells by what is left [m] to its equator."""
    if isinstance(indenter, Sphere):
        return np.asarray(radius / np.sqrt(room * (indenter.radius + radius)))
    return indenter.slope_at(radius)


def _angle(x: FloatArray, short: FloatArray) -> FloatArray:
    """arccos((x - short)/x), with all digits for small `short`."""
    return np.arctan2(np.sqrt(short * (2 * x - short)), x - short)


def _crowded_rule() -> tuple[FloatArray, FloatArray]:
    """Nodes and weights on [0, 1]: Gauss on panels that shrink by four towards either end."""
    steps = 0.5 * 0.25 ** np.arange(CROWDING, -1, -1.0)
    ends = np.concatenate([[0.0], steps, 1 - steps[-2::-1], [1.0]])
    nodes, weights = gauss_nodes(CROWDED_NODES)
    width = np.diff(ends)[:, None]
    return (ends[:-1, None] + width * nodes).ravel(), (width * weights).ravel()


def _moments(load: MappedFunction, flat: float, a: float, k: FloatArray) -> FloatArray:
    """int_0^a cos(kt) W dt of both loads, shape (m, 2); the flat punch's in closed form."""
    grid = load.grid
    risen = np.cos(np.multiply.outer(k, flat + grid.nodes.ravel())) @ (grid.weights * load.node_values).ravel()
    return np.column_stack([a * np.sinc(a * k / np.pi), risen])


def _transform(grid: MappedGrid, psi: FloatArray, k: FloatArray) -> FloatArray:
    """int_0^a cos(kt) psi dt, shape (m, 2)."""
    transform: FloatArray = np.cos(np.multiply.outer(k, grid.nodes.ravel())) @ (grid.weights.ravel()[:, None] * psi)
    return transform


def _solve(grid: MappedGrid, k: FloatArray, weight: FloatArray, moments: FloatArray) -> FloatArray:
    """psi at the nodes, from psi - L psi = L W, shape (n, 2)."""
    root = np.sqrt(grid.weights.ravel())[:, None]
    cosines = root * np.cos(np.multiply.outer(grid.nodes.ravel(), k))
    strength = 2 / np.pi * weight
    try:
        psi: FloatArray = (
            _resolved(cosines * np.sqrt(np.abs(strength)), np.sign(strength), cosines @ (strength[:, None] * moments))
            / root
        )
    except np.linalg.LinAlgError:
        message = f"the equation at a/h = {grid.end:g} is singular to double precision; take a smaller a/h"
        raise NotConvergedError(message) from None
    return psi


def _resolved(scaled: FloatArray, sign: FloatArray, loads: FloatArray) -> FloatArray:
    """(I - S D S^T)^-1 loads for S of nodes times wavenumbers, D their signs.

    Where all are positive the smaller of S S^T and S^T S is factorised: (I - S S^T)^-1 = I + S (I - S^T S)^-1 S^T, and
    both have the same smallest eigenvalue.
    """
    nodes, waves = scaled.shape
    if waves < nodes and np.all(sign > 0):
        dual: FloatArray = loads + scaled @ _resolved(scaled.T, np.ones(nodes), scaled.T @ loads) if waves else loads
        return dual
    square = scaled @ scaled.T if np.all(sign > 0) else (scaled * sign) @ scaled.T
    return solve_positive(np.eye(nodes) - square, loads)


def layer_waves(layer: ElasticLayer, distance: float) -> tuple[FloatArray, FloatArray]:
    """Gauss nodes k and weights times 1 - chi(k), fine enough for cos(k distance); none on the half-space."""
    if layer.is_half_space:
        return np.zeros(0), np.zeros(0)
    nodes, weights = gauss_nodes(WAVE_NODES)
    panels = int(np.ceil(LARGEST_WAVENUMBER * max(distance / PANEL_PHASE, 0.5)))
    width = LARGEST_WAVENUMBER / panels
    kernel = surface_kernel(layer)
    k = (width * (np.arange(panels)[:, None] + nodes)).ravel()
    weight = np.tile(width * weights, panels)
    if not layer.is_uniform:
        # The first panel is halved until it is short against every length on which the kernel varies.
        ends = width * np.append(0.0, 2.0 ** np.arange(-int(np.ceil(np.log2(kernel.longest))) - LONG_HALVINGS, 1))
        first = (ends[:-1, None] + np.diff(ends)[:, None] * nodes).ravel()
        k = np.append(first, k[nodes.size :])
        weight = np.append(np.multiply.outer(np.diff(ends), weights).ravel(), weight[nodes.size :])
    return k, kernel.one_minus_chi(k) * weight
