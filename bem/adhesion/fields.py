"""Pressure and displacement of one adhering contact, computed when they are first asked for."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from bem.adhesion.disc import AdheringDisc
from bem.grid.quadrant import EDGE_CELLS
from bem.grid.surface_fields import Rim, ring_interpolator
from bem.polynomials.cubics import PiecewiseCubic
from contact import Scene
from contact.records.validation import FloatArray

# Rings of equal area in which two pressures are compared.
RINGS: Final = 64


@dataclass(frozen=True, eq=False)
class AdheringFields:
    """Fields of an adhering contact of radius a (zero: none) under a depth, solved when they are first asked for."""

    scene: Scene
    contact_radius: float
    indentation_depth: float
    cells: int
    threads: int

    def pressure(self, radius: FloatArray) -> FloatArray:
        """p(r) [Pa]; at the edge itself, where it is infinite, the value half a cell inside stands."""
        a = self.contact_radius
        if a == 0.0:
            return np.zeros(radius.shape)
        last = a - 0.5 * self._disc.grid.cell_size
        r = np.where(radius < a, radius, last)
        density = self.scene.layer.contact_modulus / np.pi * self._density(np.minimum(r, last))
        return np.where(radius <= a, density / np.sqrt((a - r) * (a + r)), 0.0)

    def surface_displacement(self, radius: FloatArray) -> FloatArray:
        """w(r) [m]: delta - f under the indenter, direct summation outside; without contact none."""
        if self.contact_radius == 0.0:
            return np.zeros(radius.shape)
        a, layer, outside = self.contact_radius, self.scene.layer, radius > self.contact_radius
        w = np.asarray(self.indentation_depth - self.scene.indenter.height(np.minimum(radius, a)))
        edge = self.indentation_depth - float(self.scene.indenter.height(a))
        rim = Rim(layer, self._disc.grid, layer.contact_modulus * self._pressure, a, edge)
        w[outside] = rim.displacement_outside(radius[outside])
        return w

    @cached_property
    def _disc(self) -> AdheringDisc:
        return AdheringDisc.solved(self.scene.layer, self.scene.indenter, self.contact_radius, self.cells, self.threads)

    @property
    def _pressure(self) -> FloatArray:
        """p/E* on the quadrant."""
        return np.asarray(self.indentation_depth * self._disc.flat - self._disc.risen)

    @cached_property
    def _density(self) -> PiecewiseCubic:
        """p over that of the half-space under a unit depth [m]: smooth up to the edge."""
        disc = self._disc
        r, quotient = disc.grid.radius[disc.disc.contact], disc.quotient(self._pressure)
        inside = r < self.contact_radius - EDGE_CELLS * disc.grid.cell_size
        return ring_interpolator(r[inside], quotient[inside], disc.grid.cell_size)


def pressure_change(fine: AdheringFields, coarse: AdheringFields) -> float:
    """Distance of two grids' pressures at the same shares of their contact radii, relative to the fine one's.

    In the norm weighted with r (a^2 - r^2), in which the edge's singularity counts as much as the middle.
    """
    if fine.contact_radius == 0.0 or coarse.contact_radius == 0.0:
        return float(fine.contact_radius != coarse.contact_radius)
    share = np.sqrt((np.arange(RINGS) + 0.5) / RINGS)
    p, q = (np.sqrt(1.0 - share**2) * field.pressure(share * field.contact_radius) for field in (fine, coarse))
    return float(np.linalg.norm(p - q) / np.linalg.norm(p))
