"""The Abel density of one contact by a dense solve: the second boundary route, which shares only chi with the first.

With lengths in units of the layer thickness and W = delta - g_hs, the density phi on [0, a] solves

    phi(x) - (2/pi) int_0^a L(x, t) phi(t) dt = W(x),    L(x, t) = int_0^inf (1 - chi(k)) cos(kx) cos(kt) dk.

L is formed as it stands: Gauss nodes in k on the real axis, fine enough for cos(ka), and one matrix product. On the
half-space L = 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.special import j0

from bem.kernels.layer import one_minus_kernel
from bem.polynomials.gauss_panels import gauss_nodes
from bem.polynomials.graded_panels import GradedPanels
from contact import Layer, NotConvergedError, Profile
from contact.records.validation import FloatArray

LARGEST_WAVENUMBER = 24.0  # 1 - chi is below 1e-17 beyond
PANEL_PHASE = 6.0  # largest phase of a cosine on a panel of 16 wavenumbers: sixteen nodes for one period
SLOPE_NODES = 48
SMOOTH_NODES = 24  # exact for the cubics of tables: f' is a trigonometric polynomial of theta
CROWDING = 15  # panels of the rule for g_hs shrink to 5e-10 of a stretch towards its ends


@dataclass(frozen=True, eq=False)
class DirectDensity:
    """Densities under a flat punch pressed in by one unit and for the profile's g_hs, for one contact radius.

    Attributes:
        layer: The layer.
        indenter: The profile.
        unit: Length unit [m] of all that follows: the thickness, or the contact radius on the half-space.
        panels: Where the densities are known.
        flat: phi for W = 1, at the nodes and, last, at a; shape (n + 1,).
        risen: phi for W = g_hs, likewise.
        load: g_hs, likewise.
    """

    layer: Layer
    indenter: Profile
    unit: float
    panels: GradedPanels
    flat: FloatArray
    risen: FloatArray
    load: FloatArray

    @classmethod
    def solve(cls, layer: Layer, indenter: Profile, contact_radius: float, width: float, nodes: int) -> DirectDensity:
        """Assemble and solve for one contact radius [m], on panels of `width` thicknesses with `nodes` nodes.

        Raises:
            NotConvergedError: If the matrix is not positive definite in double precision.
        """
        unit = contact_radius if layer.is_half_space else layer.thickness
        a = contact_radius / unit
        sharp = np.array([0.0, indenter.flat_radius, *indenter.kinks]) / unit
        panels = GradedPanels.between(sharp, np.array(indenter.breakpoints) / unit, a, width, nodes)
        x = np.append(panels.nodes, a)
        g_hs = half_space_load(indenter, unit * x) / unit
        flat, risen = _solve(layer, panels, np.column_stack([np.ones_like(x), g_hs])).T
        return cls(layer, indenter, unit, panels, flat, risen, g_hs)

    @property
    def contact_radius(self) -> float:
        """a, in length units."""
        return float(self.panels.ends[-1])

    @property
    def depth(self) -> float:
        """delta, in length units, that makes phi(a) = 0: no singular pressure at the edge."""
        return float(self.risen[-1] / self.flat[-1])

    def force(self, depth: float) -> float:
        """F_N/(E* unit^2) = 2 int phi dt under a depth in length units."""
        return 2 * float(self.panels.weights @ self._density(depth)[:-1])

    @property
    def stiffness(self) -> float:
        """k_N/(E* unit)."""
        return 2 * float(self.panels.weights @ self.flat[:-1])

    def pressure(self, radius: FloatArray, depth: float, *, singular_edge: bool) -> FloatArray:
        """p/E* at radii 0 < r < a in length units: Abel integral of phi', panel by panel, with t^2 = r^2 + s^2."""
        density, a = self._density(depth), self.contact_radius
        nodes, weights = gauss_nodes(SLOPE_NODES)
        total = np.zeros_like(radius)
        if singular_edge:
            total += density[-1] / np.sqrt((a - radius) * (a + radius))
        for start, stop in pairwise(self.panels.ends):
            low, high = (np.sqrt(np.maximum(e**2 - radius**2, 0.0))[:, None] for e in (start, stop))
            t = np.clip(np.hypot(radius[:, None], low + (high - low) * nodes), start, stop)
            total -= (high - low)[:, 0] * ((self.panels.derivative(density[:-1], t) / t) @ weights)
        return total / np.pi

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
        theta = np.arcsin(np.minimum(self.panels.ends / radius[:, None], 1.0))
        width = np.diff(theta, axis=1)[..., None]
        t = np.minimum(radius[:, None, None] * np.sin(theta[:, :-1, None] + width * nodes), self.contact_radius)
        total: FloatArray = np.sum(width * self.panels.interpolant(density, t) * weights, axis=(1, 2))
        return total

    def _density(self, depth: float) -> FloatArray:
        density: FloatArray = depth * self.flat - self.risen
        return density


def half_space_load(indenter: Profile, x: FloatArray) -> FloatArray:
    """g_hs = x int_0^(pi/2) f'(x sin(theta)) dtheta [m] at x >= 0 [m], between the profile's breakpoints.

    The nodes crowd towards both ends of a stretch that starts at the tip or a kink, or is the last: f' may begin there
    with any power of r, or grow steep towards x. On the others it is analytic from end to end.
    """
    ends = [0.0, *(k for k in indenter.breakpoints if k < np.max(x)), np.inf]
    total = np.zeros_like(x)
    for start, stop in pairwise(ends):
        is_smooth = start not in (0.0, *indenter.kinks) and stop < np.inf
        beyond = x > start
        total[beyond] += _over_stretch(indenter, x[beyond], (start, stop), is_smooth=is_smooth)
    return x * total


def _over_stretch(indenter: Profile, x: FloatArray, stretch: tuple[float, float], *, is_smooth: bool) -> FloatArray:
    """The part of the integral of f' over theta where r = x sin(theta) lies on a stretch [m] that starts before x."""
    start, stop = stretch
    s, weights = gauss_nodes(SMOOTH_NODES) if is_smooth else _crowded_rule()
    low, high = np.arcsin(start / x), np.arcsin(np.minimum(stop / x, 1.0))
    theta = low[:, None] + (high - low)[:, None] * s
    inside = indenter.slope_at(np.clip(x[:, None] * np.sin(theta), start, np.minimum(x, stop)[:, None]))
    part: FloatArray = (high - low) * (inside @ weights)
    return part


def _crowded_rule() -> tuple[FloatArray, FloatArray]:
    """Nodes and weights on [0, 1]: Gauss on panels that shrink by four towards either end."""
    steps = 0.5 * 0.25 ** np.arange(CROWDING, -1, -1.0)
    ends = np.concatenate([[0.0], steps, 1 - steps[-2::-1], [1.0]])
    nodes, weights = gauss_nodes(12)
    width = np.diff(ends)[:, None]
    return (ends[:-1, None] + width * nodes).ravel(), (width * weights).ravel()


def _solve(layer: Layer, panels: GradedPanels, loads: FloatArray) -> FloatArray:
    """phi at the nodes and at a for loads given there, shape (n + 1, loads)."""
    if layer.is_half_space:
        return loads
    root = np.sqrt(panels.weights)
    k, weight = _wavenumbers(layer, 2 * float(panels.ends[-1]))
    cosines = np.sqrt(2 / np.pi * weight) * np.cos(np.multiply.outer(np.append(panels.nodes, panels.ends[-1]), k))
    scaled = root[:, None] * cosines[:-1]
    try:
        inner = _resolved(scaled, root[:, None] * loads[:-1])
    except np.linalg.LinAlgError:
        message = f"the equation at a/h = {panels.ends[-1]:g} is singular to double precision; take a smaller a/h"
        raise NotConvergedError(message) from None
    edge = loads[-1] + cosines[-1] @ (scaled.T @ inner)  # the equation itself at x = a
    return np.vstack([inner / root[:, None], edge])


def _resolved(scaled: FloatArray, loads: FloatArray) -> FloatArray:
    """(I - S S^T)^-1 loads for S of nodes times wavenumbers; the smaller of S S^T and S^T S is factorised.

    (I - S S^T)^-1 = I + S (I - S^T S)^-1 S^T, and both have the same smallest eigenvalue.
    """
    nodes, waves = scaled.shape
    if waves < nodes:
        dual: FloatArray = loads + scaled @ _resolved(scaled.T, scaled.T @ loads)
        return dual
    factor = cho_factor(np.eye(nodes) - scaled @ scaled.T, lower=True, check_finite=False)
    solution: FloatArray = cho_solve(factor, loads, check_finite=False)
    return solution


def _wavenumbers(layer: Layer, distance: float) -> tuple[FloatArray, FloatArray]:
    """Gauss nodes k and weights times 1 - chi(k), fine enough for cos(k distance)."""
    nodes, weights = gauss_nodes(16)
    panels = int(np.ceil(LARGEST_WAVENUMBER * max(distance / PANEL_PHASE, 2.0)))
    width = LARGEST_WAVENUMBER / panels
    k = (width * (np.arange(panels)[:, None] + nodes)).ravel()
    return k, one_minus_kernel(k, layer.support, layer.poissons_ratio) * np.tile(width * weights, panels)
