"""Pressure inside and displacement inside and outside one contact, Eqs. (9) and (13), from its Abel density.

    p(r) = (E*/pi) [phi(a)/sqrt(a^2 - r^2) - int_r^a phi'(t)/sqrt(t^2 - r^2) dt],    phi = delta - g_hs + psi

psi, the layer's share, is smooth (`bem.layer_equation.contact_density`). g_hs' has a closed form for most profiles
(`bem.layer_equation.profiles.half_space_slope`), and what kinks and a sphere's equator make of it is integrated by
`bem.polynomials.abel_integral`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from bem.layer_equation.profiles.half_space_slope import profile_slope, room_to_pole
from bem.layer_equation.protocol import FlatPunchSolution, LayerShare
from bem.polynomials.abel_integral import AbelNodes, Stretch, abel_integral, arc_integral, graded_ends
from bem.polynomials.mapped import MappedFunction, MappedGrid
from bem.polynomials.stretch_slopes import StretchSlopes
from contact.records.errors import InvalidInput
from contact.records.validation import FloatArray
from contact.scene.profiles import Profile
from mdr.springs.half_space_profile import half_space_profile

# Gauss nodes on each piece of the integrals over displacements; as many as the layer's panels have by default.
NODES = 24
# Samples of g_hs on each stretch of a profile without a closed form; neighbouring breakpoints lie outside the stretch
# by its own length or so, where the error of n samples is below 2.6^-n.
SAMPLES = 32


@dataclass(frozen=True, eq=False)
class ContactFields:
    """Surface fields of one axisymmetric contact.

    Attributes:
        indenter: The profile.
        contact_modulus: E* [Pa].
        unit: Length unit [m] of all that follows.
        contact_radius: a.
        excess: a - b over the radius b of the flat end, with all its digits.
        room: What is left from a to the end of the profile, with all its digits.
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
    excess: float
    room: float
    indentation_depth: float
    profile: MappedFunction
    density: LayerShare | None
    table: FlatPunchSolution | None
    edge_density: float

    def pressure(self, radius: FloatArray) -> FloatArray:
        """p(r) [Pa] at radii [m], shape (n,), zero outside the contact.

        Raises:
            InvalidInput: Where the pressure is infinite: at a sharp rim, at a cone's tip, at the edge of a flat punch.
        """
        offset = (radius - self.indenter.flat_radius) / self.unit
        inside = offset < self.excess
        self._refuse_infinite(radius, inside | ((offset == self.excess) & (self.edge_density != 0)))
        pressure = np.zeros_like(radius)
        pressure[inside] = self._pressure_inside(radius[inside] / self.unit, offset[inside])
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

    def _pressure_inside(self, r: FloatArray, offset: FloatArray) -> FloatArray:
        """p(r) at radii given with their offsets r - b."""
        bracket = self._profile_integral(r, offset)
        if self.edge_density != 0:
            to_edge = (self.excess - offset) * (self.contact_radius + r)
            bracket += self._weight(r, self.contact_radius) * self.edge_density / np.sqrt(to_edge)
        if self.density is not None:
            bracket -= self.density.abel_integral(r)
        return self.contact_modulus / np.pi * bracket  # Eq. (9)

    def _profile_integral(self, r: FloatArray, offset: FloatArray) -> FloatArray:
        """int_r^a g_hs'(t)/sqrt(t^2 - r^2) dt, between one breakpoint of the profile and the next."""
        total = np.zeros_like(r)
        for stretch in self.stretches:
            total += abel_integral(self._slope, stretch, r, offset)
        return total

    @cached_property
    def stretches(self) -> list[Stretch]:
        """Between the breakpoints of the profile, whose slope has a pole where it ends upright."""
        indenter, unit = self.indenter, self.unit
        breaks = [(k - indenter.flat_radius) / unit for k in indenter.breakpoints]
        inner = [k for k in breaks if 0 < k < self.excess]
        ends = graded_ends([0.0, *inner, self.excess], min(self._room_at(k) for k in [*inner, self.excess]))
        rooms = [self._room_at(end) for end in ends[1:]]
        stretches = zip(ends[:-1], ends[1:], rooms, strict=True)
        return [Stretch(self._flat, start, stop, room) for start, stop, room in stretches if stop > start]

    def _room_at(self, offset: float) -> float:
        radius = self.indenter.flat_radius + self.unit * offset
        return room_to_pole(self.indenter, radius, self.unit * self.room) / self.unit

    def _slope(self, nodes: AbelNodes) -> FloatArray:
        """g_hs', or with a table g' and the pressure of the punch whose edge is at t."""
        if self.table is not None:
            slope = self.profile.derivative(np.minimum(nodes.offset, self._reach))
            return slope * self._weight(nodes.radius, nodes.position)
        closed = profile_slope(self.indenter, self.unit * nodes.offset, self.unit * nodes.room)
        return self._sampled_slope(nodes.offset) if closed is None else closed

    def slope_at(self, offset: FloatArray, left: FloatArray) -> FloatArray:
        """g_hs' at offsets from the rim of the flat end with what is left to the edge, any shape; not with a table."""
        room = self.room + left
        closed = profile_slope(self.indenter, self.unit * offset, self.unit * room)
        return self._sampled_slope(offset) if closed is None else closed

    @cached_property
    def _sampled_slope(self) -> StretchSlopes:
        """g_hs' of a profile without a closed form."""
        ends = np.array([stretch.start for stretch in self.stretches] + [self.excess])
        unit = self.unit
        return StretchSlopes.of(lambda d: half_space_profile(self.indenter, unit * d) / unit, self._flat, ends, SAMPLES)

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
        a = self.contact_radius
        integral = self.indentation_depth * np.arctan2(a, np.sqrt((r - a) * (r + a)))
        integral -= arc_integral(r, self.profile, self._flat, NODES)
        if self.density is not None and r.size:
            integral += arc_integral(r, _remainder(self.density, float(r.max()) - a), a, NODES)
        return 2 / np.pi * integral

    @cached_property
    def _reach(self) -> float:
        """Largest excess that the profile knows."""
        return self.profile.grid.end

    def _refuse_infinite(self, radius: FloatArray, asked: NDArray[np.bool_]) -> None:
        singular = [0.0] if float(self.indenter.slope_at(0.0)) > 0 else []
        singular += [k for k in self.indenter.kinks if k < self.contact_radius * self.unit]
        if self.edge_density != 0:
            singular.append(self.contact_radius * self.unit)
        infinite = radius[asked & np.isin(radius, singular)]
        if infinite.size:
            raise InvalidInput(f"radius = {infinite[0]:g} m: the pressure is infinite at this sharp rim; ask beside it")


def _remainder(density: LayerShare, reach: float) -> MappedFunction:
    """Phi(a + d) on shells that double from the first on, past d = reach.

    A last shell that ended a rounding before r would leave out sqrt(eps) of the integral, which is singular at r.
    """
    first = density.first_shell
    shells = int(np.floor(np.log2(max(reach / first, 1.0)))) + 2
    grid = MappedGrid.between(first * np.concatenate([[0.0], 2.0 ** np.arange(shells)]), NODES)
    return MappedFunction(grid, density.outside(grid.nodes), 0.0)
