"""Numerical settings of one solve, and the mesh they make around a contact of radius one."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from contact import ElasticLayer, InvalidInput, Layer, Profile
from fem_reference.discrete_layer.elements import ElementPair, taylor_hood
from fem_reference.discrete_layer.grading import Grading
from fem_reference.discrete_layer.indenter import ScaledIndenter
from fem_reference.discrete_layer.mesh import LayerMesh, layer_mesh
from fem_reference.discrete_layer.outer_edge import outer_distance

# The ring between a flat end and the contact's edge that is narrower than this times contact radius and thickness
# needs cells that grow by at most `NARROW_GROWTH`.  At a growth of one its cells were so uneven that k_N' erred by
# a fifth and the depth by a factor of up to four where 0.2 to 0.7 were stated (a/b - 1 = 1e-10 to 1e-5, h/b = 0.1 and
# 2, nu = 0.3, 2026-11-22); at 0.9 they err by at most 1e-3, at 0.7 by 1e-5.
NARROW = 0.1
NARROW_GROWTH = 0.7
# Growth of the companion over that of the answer: errors fall like its seventh power, so that the companion errs 17
# times as much. With 1.25 the two agree by accident on coarse meshes, and stated errors are three times too small;
# with 2 the seventh power makes them a hundred times too large.
COARSER = 1.5
# The same of the edge cell, whose errors are proportional to it.
COARSER_EDGE = 10.0
# No ring is meshed that is narrower than this times flat radius and thickness; the law of `narrowed` stands for it.
# Smallest cells are 1e-13 radii: depths err by 2e-7 in a ring of 1e-7, by 2e-6 in one of 1e-8 (same contacts).
NARROWEST = 1e-7
# No cell is smaller than a thousand roundings of its radius: nodes nearer than these coincide.
SMALLEST = 1e-13
# An upright end makes the edge cell no smaller than this times the radius: with cells of 1e-13 one mesh in six was so
# uneven that depths were 1e-4 to 2e-3 off, with 1e-11 one in twenty (nu = 0 to 1/2, h/a = 0.2 to 2, spheres 1e-5 to
# 1e-9 before their equator, growths 0.35 to 0.55, 2026-11-26).
SMALLEST_BEFORE_END = 1e-11
# Before an upright end that is nearer than `NARROW` cells grow by at most this: at growths of 0.7 and one, seven of 40
# depths were more than a tenth off, at 1/2 one in twenty is more than 1e-3 off (the same, 1e-10 before it, too).
GROWTH_BEFORE_END = 0.5


@dataclass(frozen=True, kw_only=True)
class Discretisation:
    """Everything that decides the mesh and its elements.

    Attributes:
        order: polynomial degree k of the displacement, 2, 3 or 4; the pressure has degree k - 1.
        edge_cell: cell size at the contact edge, relative to the smallest of contact radius, thickness and the
            distances from the edge to the next kink and to an upright end.
        growth: increase of cell size per distance from a graded point; also the largest cell per thickness.
        truncation: relative change of the stiffness allowed to the outer edge.
        half_space_thickness: thickness, in contact radii, of the layer that stands for a half-space.
        outer_distance: from contact edge to outer edge, in thicknesses; None for what ``truncation`` asks at this nu.
        coarsening: how many times coarser cells are than was asked for; one, but in the companion that tells errors.
    """

    order: int = 4
    edge_cell: float = 1e-7
    growth: float = 0.5
    truncation: float = 1e-8
    half_space_thickness: float = 1e8
    outer_distance: float | None = None
    coarsening: float = 1.0

    def __post_init__(self) -> None:
        """Refuse settings outside their ranges."""
        if self.order not in (2, 3, 4):
            raise InvalidInput(f"order must be 2, 3 or 4, got {self.order}")
        bounds = {
            "edge_cell": (1e-12, 0.2),
            "growth": (0.02, 2.0),
            "truncation": (1e-14, 0.1),
            "half_space_thickness": (10.0, 1e12),
        }
        for name, (low, high) in bounds.items() if self.coarsening == 1.0 else ():
            if not low <= getattr(self, name) <= high:
                raise InvalidInput(f"{name} must lie in [{low:g}, {high:g}], got {getattr(self, name)}")
        if self.outer_distance is not None and not 1.0 <= self.outer_distance * self.coarsening <= 100.0:
            raise InvalidInput(f"outer_distance must lie in [1, 100] thicknesses, got {self.outer_distance}")

    @property
    def pair(self) -> ElementPair:
        """The element pair of the answer."""
        return taylor_hood(self.order)

    def refined(self) -> Self:
        """Cells half as large; the edge cell shrinks as the error of the others does, by 2^(2k)."""
        return replace(
            self,
            growth=max(self.growth / 2, 0.02),
            edge_cell=max(self.edge_cell / 4**self.order, 1e-12),
            truncation=max(self.truncation / 4**self.order, 1e-14),
            half_space_thickness=min(self.half_space_thickness * 4**self.order, 1e12),
        )

    def coarser(self) -> Self:
        """The companion that tells errors: every length and tolerance is coarser, so that each of them shows."""
        return replace(
            self,
            coarsening=COARSER * self.coarsening,
            growth=COARSER * self.growth,
            edge_cell=min(COARSER_EDGE * self.edge_cell, 0.3),
            truncation=min(10 * self.truncation, 0.3),
            half_space_thickness=max(self.half_space_thickness / 10, 3.0),
            outer_distance=self.outer_distance and self.outer_distance / COARSER,
        )

    def beside_kinks(self, layer: ElasticLayer, indenter: ScaledIndenter) -> Self:
        """Settings whose cells grow slowly enough where a kink or an upright end lies close to the contact's edge."""
        near = NARROW * min(1.0, self.thickness(layer, indenter.contact_radius))
        limits = {
            NARROW_GROWTH: 1.0 - max(indenter.kinks, default=0.0),
            GROWTH_BEFORE_END: indenter.left_to_upright_end,
        }
        growths = (growth * self.coarsening for growth, distance in limits.items() if distance < near)
        return replace(self, growth=min(self.growth, *growths, np.inf))

    def thickness(self, layer: ElasticLayer, contact_radius: float) -> float:
        """h / a of what touches the indenter, or its stand-in for a half-space."""
        return self.half_space_thickness if layer.is_half_space else layer.surface.thickness / contact_radius

    def distance(self, layer: Layer) -> float:
        """From contact edge to outer edge, in thicknesses."""
        nu, support, least = layer.poissons_ratio, layer.support, 3.0 / self.coarsening
        return self.outer_distance or outer_distance(nu, support, self.truncation, least)


def contact_mesh(layer: ElasticLayer, indenter: ScaledIndenter, settings: Discretisation) -> LayerMesh:
    """The graded section, lengths by the contact radius, with vertices at the edge and at every kink and breakpoint."""
    if not isinstance(layer, Layer):
        from fem_reference.discrete_layer.several_layers.mesh import contact_parts_mesh  # noqa: PLC0415 - only they load it

        return contact_parts_mesh(layer, indenter, settings)
    thickness = settings.thickness(layer, indenter.contact_radius)
    grading = Grading(
        points=graded_points(thickness, indenter, settings),
        growth=settings.growth,
        max_cell=settings.growth * thickness,
    )
    return layer_mesh(thickness, 1 + thickness * settings.distance(layer), grading)


def graded_points(
    thickness: float, indenter: ScaledIndenter, settings: Discretisation
) -> tuple[tuple[float, float], ...]:
    """(radius, cell size) at the edge, the kinks, a sharp tip, and plain vertices at the other breakpoints.

    At the edge the energy error of the last cell falls like its size; at a kink, where the stress is merely
    logarithmic, like its square, but the L2 error of the pressure like its root.
    """
    last_kink, coarser = max(indenter.kinks, default=0.0), settings.coarsening**6
    before_end = max(settings.edge_cell * indenter.left_to_upright_end, SMALLEST_BEFORE_END * coarser)
    edge_cell = max(min(settings.edge_cell * min(1.0, thickness, 1.0 - last_kink), before_end), SMALLEST)
    cells = {r: 0.5 * settings.growth * min(1.0, thickness) for r in indenter.breakpoints}
    ends = (0.0, *sorted(indenter.kinks), 1.0)
    cells |= {
        r: max(0.5 * settings.edge_cell * min(r - left, right - r, thickness), SMALLEST * r)
        for left, r, right in zip(ends, ends[1:], ends[2:], strict=False)
    }
    if indenter.has_sharp_tip:
        cells[0.0] = edge_cell
    return tuple(sorted((cells | {1.0: edge_cell}).items()))


def narrowest_radius(layer: ElasticLayer, profile: Profile, coarsening: float = 1.0) -> float:
    """The smallest contact radius [m] beyond a flat end whose ring is meshed; zero for profiles without a flat end."""
    ring = NARROWEST * coarsening**6  # ten times wider in a companion
    return profile.flat_radius + ring * min(profile.flat_radius, layer.surface.thickness)
