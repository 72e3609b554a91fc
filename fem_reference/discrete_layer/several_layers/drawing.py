"""The section as gmsh is given it: parts that are thin for their distance from the contact's edge are drawn thicker.

Cells grow with the distance from the edge, and gmsh makes triangles as high as they are wide; in a thin part they would
be as many as the part is long.  Fields far from the edge change slowly along the part, so triangles may be long there.
Each part is drawn with the thickness ``max(h, slope * distance)``, meshed, and its points are moved back.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from contact.records.validation import FloatArray
from fem_reference.discrete_layer.grading import distance, distance_beyond, grown, reaches_of
from fem_reference.discrete_layer.several_layers.parts import LayerParts

# Thickness drawn over distance from the edge and growth of cells.  Measured on three stacks (soft on stiff, a top of
# 0.01, slipping; paraboloid at a/h = 1 against MDR, 2026-11-22): 0.25 errs by up to 2.6e-7, with a tenth to a quarter
# fewer unknowns than 0.5, and 1 by up to 9e-7.
SLOPE_PER_GROWTH = 0.25
# Two changes of the drawn thickness closer than this factor of their distance from the edge are drawn as one. Chosen.
LEAST_STEP = 1.5
# Beyond a thickness from the edge, cells grow with this share of the growth, since waves of the layers go on there.
# On two random stacks 0.5 errs by 1.7e-7 and 3.7e-7, 1 by 8.7e-7 and 4.8e-7; 0.25 doubles the unknowns for nothing.
FAR_GROWTH = 0.5


@dataclass(frozen=True)
class Drawing:
    """The drawn section; lengths by the contact radius.

    Attributes:
        body: the parts.
        outer_radius: end of the section.
        points: (radius, cell size) on the top, increasing.
        growth: of cells per distance.
        strip: radius within which no part is drawn thicker, zero for contacts of known radius.
    """

    body: LayerParts
    outer_radius: float
    points: tuple[tuple[float, float], ...]
    growth: float
    strip: float = 0.0

    @cached_property
    def origin(self) -> float:
        """Radius of the last graded point, where gmsh's digits are needed most."""
        return self.points[-1][0]

    @cached_property
    def stations(self) -> FloatArray:
        """Radii at which lines may bend."""
        fine = np.array([r for r, _ in self.points])
        middles = (fine[:-1] + fine[1:]) / 2
        bends = self._bends
        beside = np.concatenate([fine + side * bend for bend in bends for side in (-1.0, 1.0)] or [np.empty(0)])
        own = np.min(np.abs(beside[:, None] - fine), axis=1) >= 0.999 * np.repeat(bends, 2 * len(fine))
        hundreds = 1.0 + max([1.0, *bends]) * 100.0 ** np.arange(1, 8)
        every = np.concatenate([fine, middles, beside[own], hundreds])
        every = every[(every > 0) & (every < 0.3 * self.outer_radius)]
        return self._without_crowds(np.unique(every), fine)

    @property
    def _bends(self) -> list[float]:
        """Distances from a graded point where parts begin to be drawn thicker."""
        kept: list[float] = []
        for bend in np.sort(self._finite) / (SLOPE_PER_GROWTH * self.growth):
            if not kept or bend > LEAST_STEP * kept[-1]:
                kept.append(float(bend))
        return kept

    def _without_crowds(self, radii: FloatArray, fine: FloatArray) -> FloatArray:
        """Stations that are no graded points keep off their neighbours."""
        kept = [0.0]
        for radius in (*radii, self.outer_radius):
            gap = 0.2 * float(self.distance(np.array([radius]))[0])
            if radius in fine or radius == self.outer_radius or radius - kept[-1] > gap:
                kept.append(float(radius))
        return np.array(kept)

    @property
    def _finite(self) -> FloatArray:
        """Thicknesses of the parts above an elastic base."""
        return self.body.thicknesses[: -1 if self.body.base_modulus else None]

    def distance(self, radius: FloatArray) -> FloatArray:
        """From the next graded point, or from the strip."""
        if self.strip:
            return np.asarray(np.maximum(radius - self.strip, 0.0))
        return np.asarray(np.min(np.abs(radius[:, None] - np.array([r for r, _ in self.points])), axis=1))

    @cached_property
    def drawn(self) -> FloatArray:
        """Drawn thickness of each part at the stations, shape (part, station).

        The end of an elastic base is straight: bends of the faces far above it are much smaller than its cells, and a
        triangle over one of them has no area once it is moved back.
        """
        wedge = SLOPE_PER_GROWTH * self.growth * self.distance(self.stations)
        drawn = np.maximum(self._finite[:, None], wedge)
        if not self.body.base_modulus:
            return drawn
        top = drawn.sum(axis=0)
        end = np.interp(self.stations, self.stations[[0, -1]], top[[0, -1]] + self.body.thicknesses[-1])
        return np.vstack([drawn, end - top])

    @cached_property
    def levels(self) -> FloatArray:
        """Drawn depth of each mesh line at the stations, shape (line, station)."""
        return np.vstack([np.zeros_like(self.stations), np.cumsum(self.drawn, axis=0)])

    @property
    def lines(self) -> list[FloatArray]:
        """Mesh lines as gmsh gets them, x counted from the origin, each (2, station); the end of a base by its ends."""
        lines = [np.vstack([self.stations - self.origin, level]) for level in self.levels]
        return [*lines[:-1], lines[-1][:, [0, -1]]] if self.body.base_modulus else lines

    @property
    def size_expression(self) -> str:
        """Cell size in gmsh's x and y."""
        distances = [distance(r - self.origin) for r, _ in self.points]
        reaches = reaches_of(self.points, self.body.parts[0].thickness)
        cells = [cell for _, cell in self.points]
        if self.strip:
            distances.append(distance_beyond(self.strip - self.origin))
            reaches, cells = [*reaches, 0.0], [*cells, cells[-1]]
        each = zip(cells, distances, reaches, strict=True)
        sizes = [f"{cell:.17g}+{grown(away, self.growth, reach)}" for cell, away, reach in each]
        widest = self.growth * self.body.layer_thickness
        sizes.append(f"Max({widest:.17g},{FAR_GROWTH * self.growth:.17g}*{distances[-1]})")
        expression = sizes[-1]
        for size in reversed(sizes[:-1]):
            expression = f"Min({size},{expression})"
        return expression

    def moved_back(self, points: FloatArray, part: int) -> FloatArray:
        """(r, z) of points (2, n) of one part as drawn; those on its faces to rounding."""
        x = self.stations - self.origin
        share = (points[1] - np.interp(points[0], x, self.levels[part])) / np.interp(points[0], x, self.drawn[part])
        top, bottom = self.body.depths[part : part + 2]
        return np.vstack([points[0] + self.origin, np.clip(top + share * (bottom - top), top, bottom)])
