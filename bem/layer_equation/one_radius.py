"""The Abel density of one contact by a dense solve: the second boundary route, which shares only chi with the first.

With lengths in units of the layer thickness and W = delta - g_hs, the density phi on [0, a] solves

    phi(x) - (2/pi) int_0^a L(x, t) phi(t) dt = W(x),    L(x, t) = int_0^inf (1 - chi(k)) cos(kx) cos(kt) dk.

L is formed as it stands: Gauss nodes in k on the real axis, fine enough for cos(ka), and one matrix product. On the
half-space L = 0. For the pressure phi is split into W, whose slope is known, and psi = (2/pi) int L phi dt, which is
differentiated under the integral sign: no interpolant of phi is.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.special import j0

from bem.kernels.of_layer import surface_kernel
from bem.kernels.profile_slope import profile_slope
from bem.polynomials.abel_integral import AbelNodes, Stretch, abel_integral
from bem.polynomials.equal_panels import EqualPanels
from bem.polynomials.gauss_panels import gauss_nodes
from bem.polynomials.graded_panels import GradedPanels
from bem.polynomials.stretch_slopes import StretchSlopes
from contact import ElasticLayer, NotConvergedError, Profile
from contact.records.validation import FloatArray

# Wavenumber times thickness beyond which 1 - chi is below 1e-17 and left out.
LARGEST_WAVENUMBER = 24.0
# On a stack the first panel of wavenumbers is halved so many times more than the longest length asks for; chosen.
LONG_HALVINGS = 4
# Largest phase of a cosine on a panel of 16 wavenumbers: sixteen nodes for one period.
PANEL_PHASE = 6.0
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


@dataclass(frozen=True, eq=False)
class DirectDensity:
    """Densities under a flat punch pressed in by one unit and for the profile's g_hs, for one contact radius.

    Attributes:
        layer: The layer.
        indenter: The profile.
        unit: Length unit [m] of all that follows: the thickness, or the contact radius on the half-space.
        excess: a - b over the radius b of the flat end, with all its digits.
        width: Widest panel.
        panels: Where the densities are known.
        flat: phi for W = 1, at the nodes and, last, at a; shape (n + 1,).
        risen: phi for W = g_hs, likewise.
        load: g_hs, likewise.
    """

    layer: ElasticLayer
    indenter: Profile
    unit: float
    excess: float
    width: float
    panels: GradedPanels
    flat: FloatArray
    risen: FloatArray
    load: FloatArray

    @classmethod
    def solve(cls, layer: ElasticLayer, indenter: Profile, excess: float, width: float, nodes: int) -> DirectDensity:
        """Assemble and solve for one excess a - b [m], on panels of `width` thicknesses with `nodes` nodes.

        Raises:
            NotConvergedError: If the matrix is not positive definite in double precision.
        """
        flat = indenter.flat_radius
        unit = flat + excess if layer.is_half_space else layer.surface.thickness
        smoother = (np.array(indenter.breakpoints) - flat) / unit
        end = excess / unit, _room(indenter, excess) / unit
        panels = GradedPanels.between(flat / unit, smoother, end, width, nodes)
        g_hs = half_space_load(indenter, unit * np.append(panels.offsets, excess / unit)) / unit
        punch, risen = _solve(layer, panels, np.column_stack([np.ones_like(g_hs), g_hs])).T
        return cls(layer, indenter, unit, excess / unit, width, panels, punch, risen, g_hs)

    @property
    def contact_radius(self) -> float:
        """a, in length units."""
        return self.panels.origin + self.excess

    @property
    def depth(self) -> float:
        """delta, in length units, that makes phi(a) = 0: no singular pressure at the edge."""
        return float(self.risen[-1] / self.flat[-1])

    @property
    def condition(self) -> float:
        """d(ln g_hs)/d(ln(a - b)), by which rounded positions move the depth: unbounded at a sphere's equator."""
        if not self._stretches:
            return 0.0
        edge, room = np.full(1, self.unit * self.excess), np.full(1, _room(self.indenter, self.unit * self.excess))
        closed = profile_slope(self.indenter, edge, room)
        slope = self._sampled_slope(edge / self.unit) if closed is None else closed
        return float(self.excess * slope[0] / self.load[-1])

    def force(self, depth: float) -> float:
        """F_N/(E* unit^2) = 2 int phi dt under a depth in length units."""
        return 2 * float(self.panels.weights @ self._density(depth)[:-1])

    @property
    def stiffness(self) -> float:
        """k_N/(E* unit)."""
        return 2 * float(self.panels.weights @ self.flat[:-1])

    def pressure(self, offset: FloatArray, depth: float, *, singular_edge: bool) -> FloatArray:
        """p/E* at offsets r - b in length units, shape (n,), of radii 0 <= r < a."""
        radius = self.panels.origin + offset
        total = -self._smooth_integral(radius, depth)
        for stretch in self._stretches:
            total += abel_integral(self._profile_slope, stretch, radius, offset)
        if singular_edge:
            total += self._density(depth)[-1] / np.sqrt((self.excess - offset) * (self.contact_radius + radius))
        return total / np.pi

    @cached_property
    def stretch_ends(self) -> FloatArray:
        """Offsets of the axis, of the breakpoints within the contact, and of its edge."""
        breaks = (np.array(self.indenter.breakpoints) - self.indenter.flat_radius) / self.unit
        return np.unique([-self.panels.origin, *breaks[breaks < self.excess], self.excess])

    @cached_property
    def _stretches(self) -> list[Stretch]:
        """Where the profile has risen; it has its pole, if any, where it ends."""
        ends = self.stretch_ends[self.stretch_ends >= 0]
        rooms = np.full(len(ends) - 1, np.inf)
        rooms[-1:] = _room(self.indenter, self.unit * self.excess) / self.unit
        starts = zip(ends[:-1], ends[1:], rooms, strict=True)
        return [Stretch(self.panels.origin, float(start), float(stop), float(room)) for start, stop, room in starts]

    def _profile_slope(self, nodes: AbelNodes) -> FloatArray:
        closed = profile_slope(self.indenter, self.unit * nodes.offset, self.unit * nodes.room)
        return self._sampled_slope(nodes.offset) if closed is None else closed

    @cached_property
    def _sampled_slope(self) -> StretchSlopes:
        ends = self.stretch_ends[self.stretch_ends >= 0]
        count = SLOPE_SHARE * self.panels.count
        origin, unit = self.panels.origin, self.unit
        return StretchSlopes.of(lambda d: half_space_load(self.indenter, unit * d) / unit, origin, ends, count)

    def _smooth_integral(self, radius: FloatArray, depth: float) -> FloatArray:
        """int_r^a psi'(t)/sqrt(t^2 - r^2) dt with t^2 = r^2 + s^2, where psi'/t is an even analytic function of t."""
        if self.layer.is_half_space:
            return np.zeros_like(radius)
        punch, risen = self._smooth_slopes
        slopes = EqualPanels(punch.panel_width, depth * punch.coefficients - risen.coefficients)
        nodes, weights = gauss_nodes(self.panels.count)
        count = len(slopes.coefficients) + 1
        s = ((np.arange(count)[:, None] + nodes) / count).ravel()
        reach = np.sqrt((self.contact_radius - radius) * (self.contact_radius + radius))[:, None]
        t = np.minimum(np.hypot(radius[:, None], reach * s), self.contact_radius)
        integral: FloatArray = reach[:, 0] / count * np.sum(slopes(t) * np.tile(weights, count), axis=1)
        return integral

    @cached_property
    def _smooth_slopes(self) -> tuple[EqualPanels, EqualPanels]:
        """psi'(t)/t = -(2/pi) int (1 - chi) k sin(kt)/t int phi cos(ks) ds dk, of the punch and of the profile."""
        a, panels = self.contact_radius, self.panels
        k, weight = _wavenumbers(self.layer, 2 * a)
        densities = np.column_stack([self.flat, self.risen])[:-1]
        moments = np.cos(np.multiply.outer(k, panels.nodes)) @ (panels.weights[:, None] * densities)
        count = int(np.ceil(a / self.width))
        t = a / count * (np.arange(count)[:, None] + gauss_nodes(panels.count)[0]).ravel()
        waves = k**2 * np.sinc(np.multiply.outer(t, k) / np.pi)
        values = -2 / np.pi * (waves @ (weight[:, None] * moments)).T.reshape(2, count, -1)
        return EqualPanels.from_nodes(a / count, values[0]), EqualPanels.from_nodes(a / count, values[1])

    def displacement_outside(self, radius: FloatArray, depth: float) -> FloatArray:
        """w at radii r > a in length units: (2/pi) [int phi/sqrt(r^2 - t^2) dt - int (1 - chi) phi^ J0(kr) dk]."""
        density = self._density(depth)[:-1]
        half_space = self._half_space_displacement(radius, density)
        if self.layer.is_half_space or not radius.size:
            return 2 / np.pi * half_space
        k, weight = _wavenumbers(self.layer, self.contact_radius + float(radius.max()))
        transform = np.cos(np.multiply.outer(k, self.panels.nodes)) @ (self.panels.weights * density)
        outside: FloatArray = 2 / np.pi * (half_space - j0(np.multiply.outer(radius, k)) @ (weight * transform))
        return outside

    def _half_space_displacement(self, radius: FloatArray, density: FloatArray) -> FloatArray:
        """int_0^a phi/sqrt(r^2 - t^2) dt with t = r sin(theta), panel by panel."""
        nodes, weights = gauss_nodes(self.panels.count)
        ends = self.panels.origin + self.panels.ends
        theta = np.arcsin(np.minimum(ends / radius[:, None], 1.0))
        width = np.diff(theta, axis=1)[..., None]
        t = np.minimum(radius[:, None, None] * np.sin(theta[:, :-1, None] + width * nodes), self.contact_radius)
        total: FloatArray = np.sum(width * self.panels.interpolant(density, t) * weights, axis=(1, 2))
        return total

    def _density(self, depth: float) -> FloatArray:
        density: FloatArray = depth * self.flat - self.risen
        return density


def _room(indenter: Profile, excess: float) -> float:
    """Distance [m] from the contact's edge to the end of a profile that is upright there; infinite for others."""
    is_upright = indenter.max_radius not in indenter.breakpoints
    return indenter.max_radius - indenter.flat_radius - excess if is_upright else np.inf


def half_space_load(indenter: Profile, excess: FloatArray) -> FloatArray:
    """g_hs = x int_0^(pi/2) f'(x sin(theta)) dtheta [m] at x = b + excess, between the profile's breakpoints.

    The nodes crowd towards both ends of a stretch that starts at the tip or a kink, or is the last: f' may begin there
    with any power of r, or grow steep towards x. On the others it is analytic from end to end.
    """
    flat = indenter.flat_radius
    starts = [0.0, *(k - flat for k in indenter.breakpoints if 0 < k - flat < np.max(excess)), np.inf]
    total = np.zeros_like(excess)
    for start, stop in pairwise(starts):
        is_smooth = start != 0.0 and start + flat not in indenter.kinks and stop < np.inf
        beyond = excess > start
        total[beyond] += _over_stretch(indenter, excess[beyond], (start, stop), is_smooth=is_smooth)
    return (flat + excess) * total


def _over_stretch(
    indenter: Profile, excess: FloatArray, stretch: tuple[float, float], *, is_smooth: bool
) -> FloatArray:
    """The part of the integral of f' over theta where r = x sin(theta) lies on a stretch that starts before x.

    Args:
        indenter: Profile of revolution.
        excess: x - b [m].
        stretch: Its ends as offsets from b [m].
        is_smooth: Whether f' is analytic from end to end.
    """
    flat, (start, stop) = indenter.flat_radius, stretch
    x = flat + excess
    s, weights = gauss_nodes(SMOOTH_NODES) if is_smooth else _crowded_rule()
    widest, narrowest = _angle(x, excess - start), _angle(x, np.maximum(excess - stop, 0.0))
    theta = np.pi / 2 - widest[:, None] + (widest - narrowest)[:, None] * s
    last = np.minimum(x, flat + stop)[:, None]
    inside = indenter.slope_at(np.clip(x[:, None] * np.sin(theta), np.minimum(flat + start, last), last))
    part: FloatArray = (widest - narrowest) * (inside @ weights)
    return part


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


def _solve(layer: ElasticLayer, panels: GradedPanels, loads: FloatArray) -> FloatArray:
    """phi at the nodes and at a for loads given there, shape (n + 1, loads)."""
    if layer.is_half_space:
        return loads
    root = np.sqrt(panels.weights)
    a = panels.origin + float(panels.ends[-1])
    k, weight = _wavenumbers(layer, 2 * a)
    # On a stack chi may exceed 1.
    sign = np.sign(weight)
    cosines = np.sqrt(2 / np.pi * np.abs(weight)) * np.cos(np.multiply.outer(np.append(panels.nodes, a), k))
    scaled = root[:, None] * cosines[:-1]
    try:
        inner = _resolved(scaled, sign, root[:, None] * loads[:-1])
    except np.linalg.LinAlgError:
        message = f"the equation at a/h = {a:g} is singular to double precision; take a smaller a/h"
        raise NotConvergedError(message) from None
    # This is the equation itself at x = a.
    edge = loads[-1] + (cosines[-1] * sign) @ (scaled.T @ inner)
    return np.vstack([inner / root[:, None], edge])


def _resolved(scaled: FloatArray, sign: FloatArray, loads: FloatArray) -> FloatArray:
    """(I - S D S^T)^-1 loads for S of nodes times wavenumbers, D their signs.

    Where all are positive the smaller of S S^T and S^T S is factorised: (I - S S^T)^-1 = I + S (I - S^T S)^-1 S^T, and
    both have the same smallest eigenvalue.
    """
    nodes, waves = scaled.shape
    if waves < nodes and np.all(sign > 0):
        dual: FloatArray = loads + scaled @ _resolved(scaled.T, np.ones(nodes), scaled.T @ loads)
        return dual
    square = scaled @ scaled.T if np.all(sign > 0) else (scaled * sign) @ scaled.T
    factor = cho_factor(np.eye(nodes) - square, lower=True, check_finite=False)
    solution: FloatArray = cho_solve(factor, loads, check_finite=False)
    return solution


def _wavenumbers(layer: ElasticLayer, distance: float) -> tuple[FloatArray, FloatArray]:
    """Gauss nodes k and weights times 1 - chi(k), fine enough for cos(k distance)."""
    nodes, weights = gauss_nodes(16)
    panels = int(np.ceil(LARGEST_WAVENUMBER * max(distance / PANEL_PHASE, 2.0)))
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
