"""Cell sizes of a section that is meshed, as gmsh reads them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from contact.records.validation import FloatArray

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
# Cells along lines grow by at most the second of these per distance, sqrt(1.8) - 1, which is gmsh's own limit for lines
# that it cuts itself, and between two graded points by the first.  There gmsh's lines are much finer than the triangles
# asked for beside them, which then are many, and slow to make.  Measured on the cartilage example and three cones (nu =
# 0.3 to 1/2, h/a = 0.4 to 3, 2026-11-26): with the first everywhere, growths of 1/2 and 0.7 make 10 to 31 per cent
# fewer triangles in half the time, with the same errors of numbers; but a growth of one errs up to 13 times as much,
# displacements beside the contact three times and more, and fields on the axis one and a half times.
BETWEEN_FINE, ALONG_LINE = 0.7, 1.8**0.5 - 1.0
# Places where cell sizes along a line are summed: they begin at this share of a cell beside a graded point, and their
# distances from it grow by the second number.  With the second limit cells then end within 0.01 of one of where gmsh
# ends them (cartilage example, 2026-11-26).
FIRST_SAMPLE, SAMPLES_GROW = 1e-3, 1.05


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
            f"{cell:.17g}+{grown(f'Sqrt((x{-start:+.17g})^2+y^2)', self.growth, reach)}"
            for (start, cell), reach in zip(self.shifted, reaches, strict=True)
        ]
        if self.strip is not None:
            radius, cell = self.strip[0] - self.origin, self.strip[1]
            beyond = f"(0.5*(x{-radius:+.17g}+Abs(x{-radius:+.17g})))"
            sizes.append(f"{cell:.17g}+{self.growth:.17g}*Sqrt({beyond}^2+y^2)")
        bounds = sizes if np.isinf(self.max_cell) else [f"{self.max_cell:.17g}", *sizes]
        expression = bounds[-1]
        for bound in reversed(bounds[:-1]):
            expression = f"Min({bound},{expression})"
        return expression

    @property
    def cuts_lines(self) -> bool:
        """Whether the section is given to gmsh by its `outline`."""
        return self.strip is None and len(self.points) > 1 and self.growth <= NEARBY_GROWTH

    def size(self, x: FloatArray, y: FloatArray | float) -> FloatArray:
        """What `size_expression` says at places where the grading `cuts_lines`."""
        sizes = [np.full(np.shape(x + y), self.max_cell)]
        for (start, cell), reach in zip(
            self.shifted, reaches_of(self.points, self.max_cell / self.growth), strict=True
        ):
            distance = np.hypot(x - start, y)
            nearby = self.growth * reach**NEARBY_POWER * distance ** (1 - NEARBY_POWER)
            sizes.append(cell + np.clip(nearby, self.growth * distance, NEARBY_GROWTH * distance))
        return np.asarray(np.min(sizes, axis=0))

    def outline(self, thickness: float, outer_radius: float) -> FloatArray:
        """Ends of the cells around a section in gmsh's x and y, shape (2, n): top, outer edge, base and axis."""
        fine, (axis, outer) = [x for x, _ in self.shifted], np.array([0.0, outer_radius]) - self.origin
        sides = []
        for left, right in pairwise(sorted({axis, outer, *fine})):
            limit = BETWEEN_FINE if {left, right} <= {*fine} else ALONG_LINE
            top = cell_ends(left, right, fine, lambda x: self.size(x, 0.0), limit)
            sides.append([top, np.zeros_like(top)])
        down = cell_ends(0.0, thickness, (), lambda y: self.size(outer, y))
        base = cell_ends(axis, outer, fine, lambda x: self.size(x, thickness))[::-1]
        up = cell_ends(0.0, thickness, (), lambda y: self.size(axis, y))[::-1]
        sides += [
            [np.full_like(down, outer), down],
            [base, np.full_like(base, thickness)],
            [np.full_like(up, axis), up],
        ]
        # Each side begins where the one before it ends.
        return np.hstack([np.array(side)[:, :-1] for side in sides])


def cell_ends(
    low: float,
    high: float,
    fine: Iterable[float],
    size: Callable[[FloatArray], FloatArray],
    limit: float = ALONG_LINE,
) -> FloatArray:
    """Ends of the cells of a line.

    Args:
        low: coordinate of one end of the line.
        high: that of the other.
        fine: coordinates near which the cell size changes fast, besides both ends.
        size: cell size at coordinates; cells are a little smaller, so that a whole number of them fits.
        limit: largest increase of cells per distance.
    """
    places = _samples(low, high, fine, size)
    rise = limit * places
    cells = np.minimum.accumulate(size(places) - rise) + rise
    cells = np.minimum.accumulate((cells + rise)[::-1])[::-1] - rise
    passed = np.append(0.0, np.cumsum(np.diff(places) * (1 / cells[1:] + 1 / cells[:-1]) / 2))
    # A hundredth of a cell too few is none.
    count = max(int(np.ceil(passed[-1] - 0.01)), 1)
    return np.interp(np.linspace(0.0, passed[-1], count + 1), passed, places)


def _samples(low: float, high: float, fine: Iterable[float], size: Callable[[FloatArray], FloatArray]) -> FloatArray:
    """Where the cell sizes of a line are summed, for arguments of `cell_ends`."""
    samples: list[FloatArray] = []
    for centre in {low, high, *(each for each in fine if low < each < high)}:
        nearest = FIRST_SAMPLE * min(float(size(np.array(centre))), high - low)
        count = int(np.log((high - low) / nearest) / np.log(SAMPLES_GROW)) + 2
        distances = np.geomspace(nearest, high - low, count)
        samples += [centre - distances, np.array([centre]), centre + distances]
    places: FloatArray = np.unique(np.concatenate(samples))
    return places[(places >= low) & (places <= high)]


def reaches_of(points: tuple[tuple[float, float], ...], thickness: float) -> list[float]:
    """Distance from each graded point to the next, to the axis and to the base, whichever is least."""
    radii = [r for r, _ in points]
    gaps = np.diff([0.0 if radii and radii[0] else -np.inf, *radii, np.inf])
    return [float(min(left, right, thickness)) for left, right in pairwise(gaps)]


def grown(distance: str, growth: float, reach: float) -> str:
    """What cells grow by at a distance from a graded point of this reach, gmsh's expression of an expression."""
    plain = f"{growth:.17g}*{distance}"
    if growth >= NEARBY_GROWTH:
        return plain
    nearby = f"{growth * reach**NEARBY_POWER:.17g}*{distance}^{1 - NEARBY_POWER:.17g}"
    return f"Max({plain},Min({NEARBY_GROWTH:.17g}*{distance},{nearby}))"
