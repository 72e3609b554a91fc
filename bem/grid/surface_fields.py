"""Pressure and displacement at any radius from the cells of a grid.

Under the indenter the pressure is `sqrt(a^2 - r^2)` times a smooth function (a smooth indenter) or that function over
the root (a flat punch), and only the smooth function is averaged over rings of cells and interpolated. Beyond the box
the displacement is the sum of what every cell causes there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final, Protocol

import numpy as np

from bem.grid.equilibrium import CircularContact
from bem.grid.error_model import DIRECT
from bem.grid.influence import REACH, correction_function
from bem.grid.other_layers import point_response
from bem.grid.quadrant import EDGE_CELLS, QuadrantGrid
from bem.kernels.moduli import contact_modulus
from bem.polynomials.cubics import PiecewiseCubic
from contact import Adhesion, ElasticLayer, FlatPunch, Layer, Profile, Scene
from contact.answer.inside import KnownContact
from contact.records.validation import FloatArray

if TYPE_CHECKING:
    from bem.layer_equation.inside.interior import ContactInterior
    from contact.answer.inside import InteriorFields

# Radii summed at a time beyond the box, which bounds the memory.
CHUNK: Final = 64
# Times the error of depth and force, which two grids share, beside their difference: so 98.9 % of errors on 128 cells
# and 98.6 % on 512 are covered, 17 and 11 times in the median (100 contacts at 8 points, `campaign inside`, seeds 79
# and 81, 2026-11-26). What is inside carries the force, so that its error reaches shapes but little.
SHARED: Final = 0.5


class AxisymmetricFields(Protocol):
    """Surface fields of one equilibrium."""

    def pressure(self, radius: FloatArray) -> FloatArray:
        """p(r) [Pa], shape of `radius`."""
        ...

    def surface_displacement(self, radius: FloatArray) -> FloatArray:
        """w(r) [m], shape of `radius`."""
        ...


@dataclass(frozen=True)
class FieldSequence:
    """Fields of every step of a path, as `contact.Fields` wants them.

    Attributes:
        steps: Of each step.
        scene: What was solved.
        depth: delta [m] of each step.
        force: F_N [N] of each step.
        coarser: The same contacts on half as many cells, where they tell the error inside.
        shared: Relative error of depth and force of each step, which the fields of both grids share.
    """

    steps: tuple[AxisymmetricFields, ...]
    scene: Scene
    depth: tuple[float, ...]
    force: tuple[float, ...]
    coarser: tuple[SmoothIndenterFields | None, ...] = ()
    shared: tuple[float, ...] = ()

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """p(r) [Pa] of one step."""
        return self.steps[step].pressure(radius)

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """w(r) [m] of one step."""
        return self.steps[step].surface_displacement(radius)

    def inside(self, step: int, known: KnownContact) -> InteriorFields:
        """The body under one step, from its pressure; errors by comparison with the coarser grid where there is one."""
        # Half of what an answer would import otherwise, for those who look inside.
        from bem.layer_equation.inside.compared import HalvedInterior  # noqa: PLC0415

        fields, pressed = self.steps[step], (self.depth[step], self.force[step])
        coarser = self.coarser[step] if self.coarser else None
        if coarser is None:
            own, other = self._body(fields, pressed, known), self._body(fields, pressed, known, halved=True)
            return HalvedInterior(own, other, DIRECT.kink_difference, DIRECT.inside_near)
        known = known._replace(density_error=SHARED * self.shared[step])
        of_coarser = known._replace(radius=coarser.state.contact_radius)
        less = coarser.state.indentation_depth, coarser.state.normal_force
        own, other = self._body(fields, pressed, known), self._body(coarser, less, of_coarser)
        # Edges are resolved like kinks.
        return HalvedInterior(own, other, DIRECT.kink_difference, DIRECT.inside_near)

    def _body(
        self, fields: AxisymmetricFields, pressed: tuple[float, float], known: KnownContact, *, halved: bool = False
    ) -> ContactInterior:
        """Under a depth [m] and force [N]."""
        from bem.layer_equation.inside.from_pressure import density_of_pressure  # noqa: PLC0415
        from bem.layer_equation.inside.interior import ContactInterior  # noqa: PLC0415

        adhesion, layer, edge = self.scene.effect(Adhesion), self.scene.layer, 0.0
        # The rim of a flat end holds the front: there the pressure tells what the edge bears.
        held = known.radius <= self.scene.indenter.flat_radius
        if adhesion is not None:
            # Griffith: the energy that the singular edge releases is the work of adhesion.
            edge = -math.sqrt(2.0 * math.pi * known.radius * adhesion.work_of_adhesion / contact_modulus(layer))
        density, unit = density_of_pressure(
            layer,
            self.scene.indenter,
            fields.pressure,
            contact_radius=known.radius,
            depth=pressed[0],
            force=pressed[1],
            edge_value=None if held or isinstance(self.scene.indenter, FlatPunch) else edge,
            halved=halved,
        )
        return ContactInterior(self.scene, density, unit, pressed[0] / unit, known)


@dataclass(frozen=True, eq=False)
class SmoothIndenterFields:
    """Fields under and around a smooth indenter."""

    layer: ElasticLayer
    indenter: Profile
    state: CircularContact

    def pressure(self, radius: FloatArray) -> FloatArray:
        """p(r) [Pa], zero outside the contact."""
        a = self.state.contact_radius
        root = np.sqrt(np.maximum(a**2 - radius**2, 0.0))
        return np.asarray(root * self._pressure_over_root(np.minimum(radius, a)))

    def surface_displacement(self, radius: FloatArray) -> FloatArray:
        """w(r) [m]: delta - f under the indenter, from the grid beside it, by direct summation beyond the box."""
        a, state = self.state.contact_radius, self.state
        under = state.indentation_depth - self.indenter.height(np.minimum(radius, a))
        w = np.where(radius <= a, under, self._beside(np.clip(radius, a, self.box)))
        far = radius > self.box
        w[far] = summed_displacement(self.layer, state.grid, state.equilibrium.pressure, radius[far])
        return w

    @property
    def box(self) -> float:
        """Largest radius [m] at which the grid holds displacements."""
        return float(self.state.grid.cell_size * (self.state.grid.cells / 2 - 1))

    @cached_property
    def _pressure_over_root(self) -> PiecewiseCubic:
        state = self.state
        a, s = state.contact_radius, state.grid.cell_size
        inside = state.grid.radius < max(a - EDGE_CELLS * s, 0.6 * a)
        r = state.grid.radius[inside]
        ratio = state.equilibrium.pressure[inside] / np.sqrt(a**2 - r**2)
        return ring_interpolator(r, ratio, s)

    @cached_property
    def _beside(self) -> PiecewiseCubic:
        state = self.state
        a, s = state.contact_radius, state.grid.cell_size
        ring = (state.grid.radius > a + s) & (state.grid.radius < self.box + s)
        mean = ring_interpolator(state.grid.radius[ring], state.equilibrium.displacement[ring], s)
        edge = state.indentation_depth - float(self.indenter.height(np.array([a]))[0])
        return PiecewiseCubic.monotone(np.concatenate([[a], mean.x]), np.concatenate([[edge], mean(mean.x)]))


@dataclass(frozen=True, eq=False)
class FlatPunchFields:
    """Fields under and around a flat punch: p = c q(r/a) / sqrt(1 - (r/a)^2)."""

    layer: ElasticLayer
    radius: float
    indentation_depth: float
    pressure_scale: float
    shape: FloatArray
    grid: QuadrantGrid
    cell_pressure: FloatArray

    def pressure(self, radius: FloatArray) -> FloatArray:
        """p(r) [Pa]; at the edge itself, where it is infinite, the value half a cell inside stands."""
        r = np.where(radius < self.radius, radius, self.radius - 0.5 * self.grid.cell_size)
        q = np.polynomial.chebyshev.chebval(2.0 * (r / self.radius) ** 2 - 1.0, self.shape)
        root = np.sqrt((self.radius - r) * (self.radius + r)) / self.radius
        return np.where(radius <= self.radius, self.pressure_scale * q / root, 0.0)

    def surface_displacement(self, radius: FloatArray) -> FloatArray:
        """w(r) [m]: the depth under the punch, direct summation outside."""
        outside = radius > self.radius
        w = np.full(radius.shape, self.indentation_depth)
        rim = Rim(self.layer, self.grid, self.cell_pressure, self.radius, self.indentation_depth)
        w[outside] = rim.displacement_outside(radius[outside])
        return w


@dataclass(frozen=True, eq=False)
class Rim:
    """The edge of a contact with a singular pressure, and what causes displacements beyond it."""

    layer: ElasticLayer
    grid: QuadrantGrid
    pressure: FloatArray
    radius: float
    displacement: float

    def displacement_outside(self, radius: FloatArray) -> FloatArray:
        """w(r) [m] at r > a; over the first cell it leaves the edge's value like the root of the distance."""
        first = self.radius + self.grid.cell_size
        w = summed_displacement(self.layer, self.grid, self.pressure, np.maximum(radius, first))
        near = radius < first
        share = np.sqrt((radius[near] - self.radius) / self.grid.cell_size)
        w[near] = (1.0 - share) * self.displacement + share * w[near]
        return w


def summed_displacement(
    layer: ElasticLayer, grid: QuadrantGrid, pressure: FloatArray, radius: FloatArray
) -> FloatArray:
    """w(r) [m] outside the contact: each cell acts as a point force at its centre, mirrored into four quadrants.

    Args:
        layer: The layer.
        grid: The quadrant.
        pressure: p [Pa] on it.
        radius: r [m], shape (n,), at least a cell outside the contact.

    Returns:
        w, shape (n,).
    """
    i, j = np.nonzero(pressure)
    x, y = grid.cell_size * (i + 0.5), grid.cell_size * (j + 0.5)
    force = grid.cell_size**2 * pressure[i, j] / (np.pi * contact_modulus(layer))
    w = np.empty(radius.shape)
    for start in range(0, radius.size, CHUNK):
        r = radius[start : start + CHUNK, None]
        w[start : start + CHUNK] = sum(
            2.0 * _point_response(layer, np.hypot(r + side * x, y)) @ force for side in (-1, 1)
        )
    return w


def _point_response(layer: ElasticLayer, distance: FloatArray) -> FloatArray:
    """1/r + V(r/h)/h [1/m]."""
    if layer.is_half_space:
        return 1.0 / distance
    if not isinstance(layer, Layer):
        return point_response(layer, distance)
    rho = distance / layer.thickness
    smooth = correction_function(layer.support, layer.poissons_ratio)
    return np.where(rho < REACH, 1.0 / distance + smooth(np.minimum(rho, REACH)) / layer.thickness, 0.0)


def ring_interpolator(radius: FloatArray, values: FloatArray, cell_size: float) -> PiecewiseCubic:
    """Means over rings as wide as a cell, interpolated in r and continued as they end."""
    ring = np.floor(radius / cell_size).astype(np.intp)
    count = np.bincount(ring)
    kept = count > 0
    mean_radius = np.bincount(ring, radius)[kept] / count[kept]
    mean_value = np.bincount(ring, values)[kept] / count[kept]
    return PiecewiseCubic.monotone(mean_radius, mean_value)
