"""Pressure inside and displacement inside and outside one contact, Eqs. (9) and (13), from its Abel density.

    p(r) = (E*/pi) [phi(a)/sqrt(a^2 - r^2) - int_r^a phi'(t)/sqrt(t^2 - r^2) dt],    phi = delta - g_hs + psi

psi, the layer's share, is smooth (`bem.layer_equation.contact_density`). What a profile's kinks make of g_hs is
integrated here with

    t = hi + (hi - lo) sinh^2(eta),    dt / sqrt((t - hi)(t - lo)) = 2 d(eta),

hi and lo being the two neighbouring singularities: the radius r itself and the kink (or -r, where there is none). The
logarithm of the pressure at a kink is then the length of the range of eta, and no digit is lost on either side of it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from bem.layer_equation.contact_density import ContactDensity
from bem.layer_equation.protocol import FlatPunchSolution
from bem.polynomials.gauss_panels import gauss_nodes
from bem.polynomials.mapped import MappedFunction, MappedGrid
from contact import InvalidInput, Profile
from contact.records.validation import FloatArray

NODES = 24
NEAREST = 1e-20  # relative distance that stands for zero: the centre, where radius and mirror image coincide


@dataclass(frozen=True, eq=False)
class ContactFields:
    """Surface fields of one axisymmetric contact.

    Attributes:
        indenter: The profile.
        contact_modulus: E* [Pa].
        unit: Length unit [m] of all that follows.
        contact_radius: a.
        indentation_depth: delta.
        profile: g_hs over the excess x - b up to a; with a table, the layer's own MDR profile g.
        density: Layer's share psi of the density; None on the half-space and with a table.
        table: Tabulated flat punches, whose pressures are superposed in place of the half-space's.
        edge_density: phi(a), zero without adhesion unless the indenter is a flat punch.
    """

    indenter: Profile
    contact_modulus: float
    unit: float
    contact_radius: float
    indentation_depth: float
    profile: MappedFunction
    density: ContactDensity | None
    table: FlatPunchSolution | None
    edge_density: float

    def pressure(self, radius: FloatArray) -> FloatArray:
        """p(r) [Pa] at radii [m], shape (n,), zero outside the contact.

        Raises:
            InvalidInput: Where the pressure is infinite: at a sharp rim, at a cone's tip, at the edge of a flat punch.
        """
        r = radius / self.unit
        inside = r < self.contact_radius
        self._refuse_infinite(radius, inside | ((r == self.contact_radius) & (self.edge_density != 0)))
        pressure = np.zeros_like(r)
        pressure[inside] = self._pressure_inside(r[inside])
        return pressure

    def surface_displacement(self, radius: FloatArray) -> FloatArray:
        """w(r) [m] at radii [m], shape (n,): Eq. (1) inside, Eq. (13) outside."""
        r = radius / self.unit
        inside = r <= self.contact_radius
        w = np.empty_like(r)
        w[inside] = self.indentation_depth - self.indenter.height(radius[inside]) / self.unit  # Eq. (1)
        w[~inside] = self._displacement_outside(r[~inside])
        return self.unit * w

    @property
    def _flat(self) -> float:
        return self.indenter.flat_radius / self.unit

    def _pressure_inside(self, r: FloatArray) -> FloatArray:
        a = self.contact_radius
        bracket = self._profile_integral(r)
        if self.edge_density != 0:
            bracket += self._weight(r, a) * self.edge_density / np.sqrt((a - r) * (a + r))
        if self.density is not None:
            bracket -= self.density.abel_integral(r)
        return self.contact_modulus / np.pi * bracket  # Eq. (9)

    def _profile_integral(self, r: FloatArray) -> FloatArray:
        """int_r^a g_hs'(t)/sqrt(t^2 - r^2) dt, between one breakpoint of the profile and the next."""
        inner = [k / self.unit for k in self.indenter.breakpoints if self._flat < k / self.unit < self.contact_radius]
        starts = [self._flat, *inner]
        total = np.zeros_like(r)
        for start, stop in zip(starts, [*inner, self.contact_radius], strict=True):
            total += self._stretch(r, start, stop) if stop > start else 0.0
        return total

    def _stretch(self, r: FloatArray, start: float, stop: float) -> FloatArray:
        """The integral over one stretch [max(r, start), stop]; zero for radii beyond it."""
        nodes, weights = gauss_nodes(NODES)
        high = np.minimum(np.maximum(r, start), stop)
        low = np.minimum(r, start) if start > 0 else -r
        gap = np.maximum(high - low, NEAREST * stop)
        reach = np.arcsinh(np.sqrt((stop - high) / gap))
        panels = int(np.ceil(np.max(reach, initial=1.0)))
        eta = ((np.arange(panels)[:, None] + nodes) / panels).ravel() * reach[:, None]
        beyond = gap[:, None] * np.sinh(eta) ** 2  # t - hi
        t = high[:, None] + beyond
        piece, u = self.profile.grid.locate(np.minimum((high - self._flat)[:, None] + beyond, self._reach))
        from_start = (high - start)[:, None] + beyond  # not t - start, which would cancel beside a kink
        rest = np.sqrt(from_start / (t + r[:, None])) if start > 0 else 1.0
        values = 2 * self.profile.derivative_at(piece, u) * rest * self._weight(r[:, None], t)
        integral: FloatArray = reach / panels * (values @ np.tile(weights, panels))
        return np.where(r < stop, integral, 0.0)

    def _weight(self, r: FloatArray, x: FloatArray | float) -> FloatArray | float:
        """Pressure of a flat punch of radius x relative to the half-space's: 1, or 2 k_bar q of a table, Eq. (12)."""
        if self.table is None:
            return 1.0
        x = np.minimum(x, self.contact_radius)
        stiffness = self.table.normalized_contact_stiffness(x)
        return 2 * stiffness * self.table.smooth_pressure(np.minimum(r / x, 1.0), x)

    def _displacement_outside(self, r: FloatArray) -> FloatArray:
        """(2/pi) int_0^r Phi(s)/sqrt(r^2 - s^2) ds, Phi = W inside the contact and what K phi leaves outside."""
        if self.table is not None and r.size:
            raise InvalidInput("flat-punch tables hold no displacement outside the contact; use the integral equation")
        a, grid = self.contact_radius, self.profile.grid
        integral = self.indentation_depth * np.arctan2(a, np.sqrt((r - a) * (r + a)))
        pieces = np.broadcast_to(self._flat + np.append(grid.left, grid.end), (r.size, len(grid.left) + 1))
        integral -= _arc_integral(
            r, pieces, grid.power, lambda s: self.profile(np.clip(s - self._flat, 0, self._reach))
        )
        if self.density is not None and r.size:
            remainder = _remainder(self.density, float(r.max()) - a)
            shells = np.minimum(a + np.append(remainder.grid.left, remainder.grid.end), r[:, None])
            integral += _arc_integral(r, shells, remainder.grid.power, lambda s: remainder(np.maximum(s - a, 0)))
        return 2 / np.pi * integral

    @cached_property
    def _reach(self) -> float:
        """Largest excess."""
        return self.contact_radius - self._flat

    def _refuse_infinite(self, radius: FloatArray, asked: NDArray[np.bool_]) -> None:
        singular = [0.0] if float(self.indenter.slope_at(0.0)) > 0 else []
        singular += [k for k in self.indenter.kinks if k < self.contact_radius * self.unit]
        if self.edge_density != 0:
            singular.append(self.contact_radius * self.unit)
        infinite = radius[asked & np.isin(radius, singular)]
        if infinite.size:
            raise InvalidInput(f"radius = {infinite[0]:g} m: the pressure is infinite at this sharp rim; ask beside it")


def _arc_integral(
    r: FloatArray, ends: FloatArray, power: FloatArray, function: Callable[[FloatArray], FloatArray]
) -> FloatArray:
    """int f(s)/sqrt(r^2 - s^2) ds with s = r sin(theta), piece by piece.

    Args:
        r: Radii, shape (n,).
        ends: Increasing ends of the pieces in s, up to r, shape (n, q + 1).
        power: How each piece's nodes crowd towards its left end, shape (q,).
        function: f.
    """
    v, omega = gauss_nodes(NODES)
    theta = np.arctan2(ends, np.sqrt(np.maximum((r[:, None] - ends) * (r[:, None] + ends), 0.0)))
    width = np.diff(theta, axis=1)[..., None]
    s = r[:, None, None] * np.sin(theta[:, :-1, None] + width * v ** power[:, None])
    weights = width * power[:, None] * v ** (power[:, None] - 1) * omega
    values: FloatArray = np.sum(function(s) * weights, axis=(1, 2))
    return values


def _remainder(density: ContactDensity, reach: float) -> MappedFunction:
    """Phi(a + d) on shells of width 1, 1, 2, 4, ... up to d = reach."""
    shells = int(np.ceil(np.log2(max(reach, 1.0)))) + 1
    ends = np.concatenate([[0.0], 2.0 ** np.arange(shells)])
    grid = MappedGrid(ends[:-1], np.diff(ends), np.ones(shells), NODES)
    return MappedFunction(grid, density.outside(grid.nodes), 0.0)
