"""Numerical settings of one solve, and the mesh that they define around a contact of radius one.

The companion of an answer is a second solution on coarser cells. The difference of the two gives the stated error
(`stated`). A graded point is a vertex on the top with a prescribed cell size (`mesh`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np

from contact import ElasticLayer, InvalidInput, Profile
from fem_reference.assembly import ElementPair, taylor_hood
from fem_reference.materials import Parts, parts_of
from fem_reference.mesh import Graded, Section, section_mesh
from fem_reference.profiles import ScaledIndenter

# Growth of the companion over that of the answer: errors fall like its seventh power. With 1.25 two meshes agree by
# accident, with 2 stated errors are a hundred times too large.
COARSER = 1.5
# Edge cell of the companion over that of the answer: its errors are proportional to it.
COARSER_EDGE = 10.0
# Narrowest meshed ring over flat radius and thickness; `PrescribedContact.narrowed` replaces narrower ones. In rings of
# 1e-8 depths err by 2e-6, in those of 1e-7 by 2e-7.
NARROWEST = 1e-7
# Smallest cell over the contact radius, about 500 roundings. With much less the nodes inside a cell coincide.
SMALLEST = 1e-13


@dataclass(frozen=True, kw_only=True)
class Discretisation:
    """Numerical settings that determine the mesh and its elements.

    Attributes:
        order: polynomial degree k of the displacement, 2, 3 or 4; the pressure has degree k - 1.
        edge_cell: cell size at the contact edge, relative to the smallest of contact radius, thickness and the
            distances from the edge to the next kink and to an upright end.
        growth: increase of cell size per distance from a graded point; also cell size over thickness about a
            thickness away from the edge.
        truncation: relative change of the stiffness that the finite outer radius may cause.
        half_space_thickness: thickness, in contact radii, of the layer that represents a half-space.
        outer_distance: distance of the outer edge from the contact edge, in thicknesses; None to use ``truncation``.
        coarsening: growth over that of the answer: one in the answer, `COARSER` in its `Companion`.
    """

    coarsening: ClassVar[float] = 1.0

    order: int = 4
    edge_cell: float = 1e-7
    growth: float = 0.5
    truncation: float = 1e-8
    half_space_thickness: float = 1e8
    outer_distance: float | None = None

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
        for name, (low, high) in bounds.items():
            if not low <= getattr(self, name) <= high:
                raise InvalidInput(f"{name} must lie in [{low:g}, {high:g}], got {getattr(self, name)}")
        if self.outer_distance is not None and not 1.0 <= self.outer_distance <= 100.0:
            raise InvalidInput(f"outer_distance must lie in [1, 100] thicknesses, got {self.outer_distance}")

    @property
    def pair(self) -> ElementPair:
        """Element pair P_k-P_(k-1) of this order."""
        return taylor_hood(self.order)

    def refined(self) -> Self:
        """Cells half as large, whose energy errs 2^(2k) times less; the other lengths change by this factor."""
        return replace(
            self,
            growth=max(self.growth / 2, 0.02),
            edge_cell=max(self.edge_cell / 4**self.order, 1e-12),
            truncation=max(self.truncation / 4**self.order, 1e-14),
            half_space_thickness=min(self.half_space_thickness * 4**self.order, 1e12),
        )

    def coarser(self) -> Companion:
        """Settings of the companion: all are coarser, so that each of them contributes to the stated error."""
        return Companion(
            order=self.order,
            growth=COARSER * self.growth,
            edge_cell=min(COARSER_EDGE * self.edge_cell, 0.3),
            truncation=min(10 * self.truncation, 0.3),
            half_space_thickness=max(self.half_space_thickness / 10, 3.0),
            outer_distance=self.outer_distance and self.outer_distance / COARSER,
        )

    def outer_radius(self, parts: Parts) -> float:
        """Outer radius of a section over the contact radius.

        In a layer of thickness h disturbances decay like ``exp(-d / (h sqrt(c)))`` with the distance d from the
        contact, c the ratio of the largest modulus to the smallest: a stiff sheet on a soft one spreads them. The
        section ends where this equals ``truncation``. The section of a half-space is as wide as it is thick.
        """
        if parts.has_base:
            return float(parts.thicknesses[-1])
        distance = self.outer_distance or -np.log(self.truncation) * np.sqrt(parts.contrast)
        return float(1 + parts.depths[-1] * distance)


@dataclass(frozen=True, kw_only=True)
class Companion(Discretisation):
    """Settings of the coarser companion of an answer, whose ranges are not restricted."""

    coarsening = COARSER

    def __post_init__(self) -> None:
        """Accept all settings."""


def contact_section(
    layer: ElasticLayer, indenter: ScaledIndenter, settings: Discretisation, sections: list[Section] | None = None
) -> tuple[Parts, Section]:
    """The graded section of a contact of known radius, with vertices at the edge and at every kink and breakpoint.

    Args:
        layer: layer of the scene.
        indenter: profile in units of the contact radius.
        settings: numerical settings.
        sections: sections of other contact radii. A similar one is stretched, else a new one is appended.
    """
    parts = parts_of(layer, indenter.contact_radius, settings.half_space_thickness)
    points, outer_radius = graded_points(parts.parts[0].thickness, indenter, settings), settings.outer_radius(parts)
    graded = np.array([r for r, _ in points])
    for section in sections or ():
        if stretched := section.stretched(graded, parts.depths, outer_radius):
            return parts, stretched
    end = 1.0 + indenter.distance_to_upright_end
    section = section_mesh(parts, outer_radius, points, settings.growth, end=end)
    if sections is not None:
        sections.append(section)
    return parts, section


def graded_points(thickness: float, indenter: ScaledIndenter, settings: Discretisation) -> Graded:
    """(radius, cell size) of the graded points: contact edge, kinks, sharp tip, and the other breakpoints.

    With the size c of the last cell the energy error falls like c at the edge, where the stress of a flat punch goes
    like d^(-1/2) with the distance d. At a kink the stress goes like log d: the energy error falls like c^2, but the
    L2 error of the pressure like c^(1/2). Other breakpoints need no small cells.
    """
    nearest = min(1.0, thickness, 1.0 - indenter.last_kink, indenter.distance_to_upright_end)
    edge_cell = max(settings.edge_cell * nearest, SMALLEST)
    cells = {r: 0.5 * settings.growth * min(1.0, thickness) for r in indenter.breakpoints}
    ends = (0.0, *sorted(indenter.kinks), 1.0)
    for left, r, right in zip(ends, ends[1:], ends[2:], strict=False):
        cells[r] = max(0.5 * settings.edge_cell * min(r - left, right - r, thickness), SMALLEST * r)
    if indenter.has_sharp_tip:
        cells[0.0] = edge_cell
    return tuple(sorted((cells | {1.0: edge_cell}).items()))


def narrowest_radius(layer: ElasticLayer, profile: Profile, coarsening: float = 1.0) -> float:
    """The smallest contact radius [m] beyond a flat end whose ring is meshed; zero for profiles without a flat end."""
    ring = NARROWEST * coarsening**6  # eleven times wider in a companion
    return profile.flat_radius + ring * min(profile.flat_radius, layer.surface.thickness)
