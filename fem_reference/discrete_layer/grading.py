"""Cell sizes of a section that is meshed, as gmsh reads them."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

# Smallest cell over its distance from gmsh's origin: gmsh squares coordinates, so cells below the root of a rounding,
# 1.5e-8, degenerate; this is twice that.
RESOLVED = 3e-8
# Cells within the reach s of a graded point grow faster the nearer they are to it: per distance d by (s/d)^NEARBY_POWER
# times the growth, at most by NEARBY_GROWTH.  There the energy falls like d, and with it what cells of a given shape
# lose: errors of degree four, which fall like growth^8, are spread over the fewest cells with a power of 0.1.  With a
# power of 0.06 they keep pace with the errors of lower degrees that tell them.  Measured on twelve contacts against MDR
# (paraboloid, cones, nu = 0.3 to 1/2, h/a = 0.5 to 3, edge cell 1e-8, 2026-11-23): at growths 1/2, 0.35 and 1/4 there
# are 809, 1,300 and 2,278 triangles for 1,253, 2,132 and 3,989, and stiffnesses err 1.5, 1.3 and 1.1 times as much.
# With cells that grow by 1.0 those of a growth of 0.7 err 2.6 times as much, with 0.8 1.3 times.
NEARBY_POWER, NEARBY_GROWTH = 0.06, 0.8


@dataclass(frozen=True, kw_only=True)
class Grading:
    """Cell sizes: ``min(max_cell, cell_i + growth * distance_i)`` over the graded points (or the graded strip) i.

    Near a graded point cells grow faster, see `NEARBY_GROWTH`.

    Attributes:
        points: radii on the top that become mesh vertices, with the cell size wished there.
        strip: (radius, cell): the top from the axis to ``radius`` is meshed with cells of that one size.
        growth: increase of the cell size per distance.
        max_cell: largest cell size.
    """

    points: tuple[tuple[float, float], ...] = ()
    strip: tuple[float, float] | None = None
    growth: float = 0.25
    max_cell: float = np.inf

    @property
    def origin(self) -> float:
        """Radius that becomes gmsh's x = 0: the last graded point where its cells are fine, else the axis.

        gmsh squares coordinates: cells below 1e-8 of their distance from its origin degenerate.
        """
        r, cell = self.points[-1] if self.points else (0.0, 0.0)
        return r if cell < RESOLVED * r else 0.0

    @property
    def shifted(self) -> tuple[tuple[float, float], ...]:
        """(x, cell) of the graded points, with the cells that gmsh resolves so far from its origin."""
        places = [(r - self.origin, cell) for r, cell in self.points]
        return tuple((x, max(cell, RESOLVED * abs(x)) if self.origin else cell) for x, cell in places)

    def size_expression(self) -> str:
        """Cell size as a function of gmsh's x = r - origin, y = z."""
        reaches = reaches_of(self.points, self.max_cell / self.growth)
        sizes = [
            f"{cell:.17g}+{grown(distance(start), self.growth, reach)}"
            for (start, cell), reach in zip(self.shifted, reaches, strict=True)
        ]
        if self.strip is not None:
            radius, cell = self.strip[0] - self.origin, self.strip[1]
            sizes.append(f"{cell:.17g}+{self.growth:.17g}*{distance_beyond(radius)}")
        bounds = sizes if np.isinf(self.max_cell) else [f"{self.max_cell:.17g}", *sizes]
        expression = bounds[-1]
        for bound in reversed(bounds[:-1]):
            expression = f"Min({bound},{expression})"
        return expression


def distance(start: float) -> str:
    """Distance from (start, 0), gmsh's expression; products, because gmsh's squares are powers that cost more."""
    x = f"(x{-start:+.17g})"
    return f"Sqrt({x}*{x}+y*y)"


def distance_beyond(start: float) -> str:
    """Distance from the top up to ``start``, likewise."""
    x = f"(x{-start:+.17g})"
    return f"Sqrt(0.5*{x}*({x}+Abs{x})+y*y)"


def reaches_of(points: tuple[tuple[float, float], ...], thickness: float) -> list[float]:
    """Distance from each graded point to the next, to the axis and to the base, whichever is least."""
    radii = [r for r, _ in points]
    gaps = np.diff([0.0 if radii and radii[0] else -np.inf, *radii, np.inf])
    return [float(min(left, right, thickness)) for left, right in pairwise(gaps)]


def grown(away: str, growth: float, reach: float) -> str:
    """What cells grow by at a distance from a graded point of this reach, gmsh's expression of an expression."""
    plain = f"{growth:.17g}*{away}"
    if growth >= NEARBY_GROWTH:
        return plain
    nearby = f"{growth * reach**NEARBY_POWER:.17g}*{away}^{1 - NEARBY_POWER:.17g}"
    return f"Max({plain},Min({NEARBY_GROWTH:.17g}*{away},{nearby}))"
