"""Pressure and surface displacement of one contact, from the pressures on its disc of cells."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import pi
from typing import Final

import numpy as np
from scipy.interpolate import PchipInterpolator

from bem.grid.discs import EDGE_CELLS, Punch, Unresolved
from bem.grid.influence import REACH, point_response
from bem.grid.pressed import PressedState, Pressing
from bem.kernels.moduli import contact_modulus
from bem.kernels.of_layer import surface_kernel
from contact.answer.one_circle import no_single_circle
from contact.records.validation import FloatArray

# Number of radii summed at a time, which bounds the memory: with four times as many 2048 points take 0.4 GB.
CHUNK: Final = 4
# Least tension over the largest quotient of pressures that counts; noise of rings is a tenth of it.
PULLED: Final = 1e-3
# Distance, in cells of the coarser grid, within which the coarser grid has to show tension too.
NEARBY: Final = 1.5
# Distance from edges and kinks, in cells, within which the sign of the pressure is not resolved; half of it refuses
# worn cones.
BESIDE_KINKS: Final = 8.0
# Radii r/a at which fields of two grids are compared.
INSIDE: Final = np.sqrt((np.arange(64) + 0.5) / 64)
OUTSIDE: Final = np.array([1.01, 1.02, 1.05, 1.1, 1.2, 1.35, 1.6, 2.0, 2.5])


@dataclass(frozen=True, eq=False)
class ContactFields:
    """Surface fields of one contact; zero without contact.

    Attributes:
        pressing: Layer, indenter and discs.
        state: Depth, force and stiffness at the contact radius a.
        solved: Depth, force and stiffness at the radius of the solved disc, which differs slightly from a.
        edge: phi(a) [m], zero without adhesion; None for a flat punch without adhesion, where it is not used.
    """

    pressing: Pressing
    state: PressedState
    solved: PressedState
    edge: float | None

    @property
    def radius(self) -> float:
        """Contact radius a [m]."""
        return self.state.radius

    @property
    def punch(self) -> Punch:
        """The flat punch on the disc."""
        return self.pressing.punch(self.solved.radius)

    def pressure(self, radius: FloatArray) -> FloatArray:
        """p(r) [Pa]; at a singular edge the value half a cell inside."""
        if self.radius == 0.0:
            return np.zeros_like(radius)
        last = 1.0 - 0.5 / self.punch.disc.radius
        share = np.minimum(radius / self.radius, 1.0 if self.edge == 0.0 else last)
        root = np.sqrt(np.maximum((1.0 - share) * (1.0 + share), np.finfo(float).tiny))
        quotient = self._quotient(share**2) if self.edge is not None else self.state.depth * self.punch.quotient(share)
        p = contact_modulus(self.pressing.layer) / (pi * self.radius) * quotient / root
        return np.where((radius <= self.radius) & (share < 1.0), p, 0.0)

    def surface_displacement(self, radius: FloatArray) -> FloatArray:
        """w(r) [m]: delta - f(r) inside the contact, sums over all cells from one cell size outside the edge on.

        In between the gap grows like the root of the distance, or without adhesion like its power 3/2.
        """
        if self.radius == 0.0:
            return np.zeros_like(radius)
        a, s, indenter = self.radius, self.radius / self.punch.disc.radius, self.pressing.indenter
        slope, power = (float(indenter.slope_at(a)), 1.5) if self.edge == 0.0 else (0.0, 0.5)
        beyond = np.maximum(radius - a, 0.0)
        w = np.asarray(self.state.depth - indenter.height(np.minimum(radius, a)), dtype=np.float64)
        w -= slope * np.minimum(beyond, s)
        outside = beyond > 0.0
        near = np.minimum(beyond[outside] / s, 1.0)
        # w by the tangent at the edge, one cell further out; its error there is distributed by the power.
        end = self.state.depth - float(indenter.height(a)) - slope * s
        summed = self._summed(np.maximum(radius[outside], a + s))
        w[outside] += near**power * (summed - end)
        return w

    def refuse_pulling(self, coarser: ContactFields) -> None:
        """Refuse a contact without adhesion with tension at the same radius on this grid and on a coarser one.

        Raises:
            UnsupportedSceneError: With the radius.
            Unresolved: With the radius, if tension occurs near edges or kinks only.
        """
        rings, quotient = self._rings
        other_rings, other = coarser._rings
        marks = [self.radius, *(k for k in self.pressing.indenter.kinks if k < self.radius)]
        distance = np.min([np.abs(rings - mark / self.radius) for mark in marks], axis=0) * self.punch.disc.radius
        near = np.abs(rings[:, None] - other_rings) * coarser.punch.disc.radius < NEARBY
        on_both = (near & (other < -PULLED * other.max())).any(axis=1) & (quotient < -PULLED * quotient.max())
        for place in self.radius * rings[on_both & (distance > BESIDE_KINKS)]:
            raise no_single_circle(self.radius, f"would be pulled at r = {place:g} m")
        for place in self.radius * rings[on_both]:
            raise Unresolved(
                f"a contact of radius {self.radius:g} m would be pulled at r = {place:g} m, less than "
                f"{BESIDE_KINKS:g} cells from an edge or a kink, where cells are too large to tell; take more points"
            )

    @cached_property
    def cells(self) -> FloatArray:
        """p/E* on the cells of a quadrant, at the radius of the solved disc, shape (m, m).

        p = (delta/s) p_1 - c p_f superposes a flat punch (p_1 at a depth of one cell size s) and the profile f (p_f at
        the displacement f). The factor c = M / sum(s^2 p_f/E*), over the whole disc, makes the force of the second term
        agree with F/E* = k delta - M. Without it few cells between a flat radius and the edge resolve f badly.
        """
        punch, depth, moment = self.punch, self.solved.depth, self.solved.moment
        risen = punch.risen(self.pressing.indenter) if moment > 0.0 else np.zeros_like(punch.pressure)
        total = 4.0 * punch.cell_size**2 * float(risen.sum())
        return np.asarray(depth / punch.cell_size * punch.pressure - (moment / total if total > 0.0 else 0.0) * risen)

    @cached_property
    def _scale(self) -> float:
        """Factor of pressures from the solved disc to the contact: the ratio of F/a^2."""
        load = self.solved.load
        return self.state.load / load * (self.solved.radius / self.radius) ** 2 if self.edge == 0.0 < load else 1.0

    @cached_property
    def _rings(self) -> tuple[FloatArray, FloatArray]:
        """r/a and mean quotient [m] of rings of cells, one cell wide, without those near the edge."""
        disc = self.punch.disc
        share = disc.centres[disc.contact]
        ring = (share * disc.radius).astype(np.intp)
        inner = np.arange(max(1, int(disc.radius - EDGE_CELLS)))
        count = np.bincount(ring)[inner]
        means = [np.bincount(ring, of)[inner] / count for of in (share**2, disc.quotient(self.cells))]
        unit = self.radius / disc.radius * self._scale
        return np.sqrt(means[0]), unit * means[1]

    @cached_property
    def _quotient(self) -> PchipInterpolator:
        """Pressure over that of the half-space under a unit depth [m], as a function of r^2/a^2."""
        share, values = self._rings
        return PchipInterpolator(np.append(share**2, 1.0), np.append(values, self.edge or 0.0), extrapolate=True)

    def _summed(self, radius: FloatArray) -> FloatArray:
        """w [m] at r > a + s, with the pressure of cells as point forces at their centres."""
        s = self.radius / self.punch.disc.radius
        i, j = np.nonzero(self.cells)
        x, y, force = s * (i + 0.5), s * (j + 0.5), s**2 * self._scale * self.cells[i, j] / pi
        w = np.empty(radius.shape)
        for start in range(0, radius.size, CHUNK):
            r = radius[start : start + CHUNK, None]
            w[start : start + CHUNK] = sum(2.0 * self._response(np.hypot(r + side * x, y)) @ force for side in (-1, 1))
        return w

    def _response(self, distance: FloatArray) -> FloatArray:
        """pi E* w per point force at a distance r [m]: 1/r + V(r/h)/h [1/m]."""
        layer = self.pressing.layer
        if layer.is_half_space:
            return 1.0 / distance
        h = layer.surface.thickness
        answer = 1.0 / distance + point_response(surface_kernel(layer))(distance / h) / h
        return answer if layer.has_elastic_base else np.where(distance < REACH * h, answer, 0.0)


def field_changes(fine: ContactFields, coarse: ContactFields) -> tuple[float, float]:
    """Relative changes of pressure and displacement between two grids; 1 if only one of them is in contact.

    Pressures are compared at equal r/a in the norm weighted with r (a^2 - r^2). For displacements it is the largest
    change outside the contact over the depth or the height at the edge.
    """
    if fine.radius == 0.0 or coarse.radius == 0.0:
        return (0.0, 0.0) if fine.radius == coarse.radius else (1.0, 1.0)
    p, q = (np.sqrt(1.0 - INSIDE**2) * of.pressure(INSIDE * of.radius) for of in (fine, coarse))
    r = OUTSIDE * max(fine.radius, coarse.radius)
    change = fine.surface_displacement(r) - coarse.surface_displacement(r)
    scale = max(abs(fine.state.depth), float(fine.pressing.indenter.height(fine.radius)))
    return float(np.linalg.norm(p - q) / np.linalg.norm(p)), float(np.abs(change).max() / scale)
