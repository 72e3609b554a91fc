"""Graded triangle meshes of a layer's cross-section in (r, z), made by gmsh in memory.

The section is 0 <= r <= outer radius, 0 <= z <= thickness with z into the layer. Its boundaries have names: ``axis``
(r = 0), ``top`` (z = 0), ``base`` (z = thickness), ``outer`` (r = outer radius). A mesh line runs along every face
between two parts (`materials`). Each part has separate vertices there, so that layers may slide.

Graded points are vertices on the top with a small cell size: the contact edge, kinks, a sharp tip. Cells grow with the
distance d from them. A strip, for contacts of unknown radius (`surface`), has equal cells on all of the top up to its
end.

gmsh makes triangles as high as they are wide. Far from the edge the cell size along a thin part of thickness h could be
much larger than h, since fields change slowly along it, but triangles would still be limited to h. Therefore each part
is drawn with the thickness ``max(h, s d)``, s = SLOPE_PER_GROWTH x growth, meshed, and z is scaled back.
"""

from __future__ import annotations

import hashlib
import signal
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property
from itertools import pairwise
from threading import current_thread, main_thread
from typing import Any

import numpy as np
from skfem import MeshTri

from contact.records.errors import NotConvergedError
from contact.records.validation import FloatArray, IntArray
from fem_reference.assembly import Face
from fem_reference.materials import Parts

MISSING_LIBRARIES = (
    "gmsh could not be loaded ({reason}). On Debian or Ubuntu install its system libraries: "
    "apt-get install libglu1-mesa libxcursor1 libxft2 libxinerama1"
)
# Length of a line that gmsh divides, over its smallest cell. gmsh takes minutes for longer ones: they are split.
LONGEST_LINE = 1e10
# Accuracy, in cells, to which gmsh integrates 1 / (cell size) along lines. The default 1e-9 takes three times as long.
# With 1e-7 cells in narrow rings are so uneven that slopes of delta_0 err by 7 %.
LINE_PRECISION = 1e-8
# gmsh's number of its Delaunay algorithm. The default, frontal Delaunay, makes 15 % fewer triangles, but one mesh in
# ten with cells of 1e-10 radii lacks them near the edge: depths then err by 1e-3 to 0.2.
DELAUNAY = 5
# Smallest cell over its distance from gmsh's origin: gmsh squares coordinates, and cells below 1.5e-8 degenerate.
RESOLVED = 3e-8
# Within the reach s of a graded point the cell size at distance d grows by growth (s/d)^NEARBY_POWER d, at most by
# NEARBY_GROWTH growth^(1/2) d, since the energy within d of the edge falls like d. Without NEARBY_POWER there are 1.4
# times as many triangles. With a limit independent of the growth a mesh and its companion are equal at the edge, and
# two stiffnesses agree by accident.
NEARBY_POWER, NEARBY_GROWTH = 0.06, 1.1
# Growth in gmsh's size function over the wanted growth, since Delaunay triangles exceed the given size. With one,
# displacements outside contacts err three times as much, and cells that grow by 1.5 form fans without inner vertices.
PLAIN_SHARE = 0.9
# Drawn thickness of a thin part over (growth x distance from the edge). With twice of it there are a tenth more
# unknowns, with four times of it errors are three times as large.
SLOPE_PER_GROWTH = 0.25
# Distances h / s, at which drawn thicknesses begin to grow, that differ by less than this factor are drawn as one.
LEAST_STEP = 1.5
# Cells stop growing at growth x thickness. Where FAR_GROWTH x growth x distance exceeds this they grow again, with this
# share of the growth, since oscillations of the layers continue there. With twice of it errors are four times as large
# on some stacks, with half of it there are twice as many unknowns.
FAR_GROWTH = 0.5
# Distance from the base, over the last part's thickness, within which a vertex is put on it: above gmsh's roundings.
ON_BASE = 1e-9

# Largest factor on a thickness by which a section is stretched. With its square one mesh serves a whole branch and errs
# several times as much at its ends, with its root twice as many meshes are made.
MOST_STRETCHED = 2.0
# Largest relative difference of thicknesses that is rounding.
SAME = 1e-12

# (radius, cell size) on the top, increasing.
Graded = tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class Section:
    """A triangle mesh of the parts of a layer, lengths by the contact radius; vertices on a face exist twice.

    Attributes:
        mesh: points and triangles, with named boundaries.
        part: index of the part of each triangle, shape (triangle,).
        faces: facets where two parts meet, from the surface down.
        graded: radii of the graded points on the top, increasing.
        depths: depths of the mesh lines, the surface and the base included, increasing.
    """

    mesh: MeshTri
    part: IntArray
    faces: tuple[Face, ...]
    graded: FloatArray
    depths: FloatArray

    @property
    def thickness(self) -> float:
        """Depth of the base."""
        return float(self.depths[-1])

    @property
    def outer_radius(self) -> float:
        """Radius of the outer boundary."""
        return float(self.mesh.p[0].max())

    @cached_property
    def fingerprint(self) -> str:
        """Hash of points and triangles."""
        return hashlib.sha256(self.mesh.p.tobytes() + self.mesh.t.tobytes()).hexdigest()[:16]

    def stretched(self, graded: FloatArray, depths: FloatArray, outer_radius: float) -> Section | None:
        """Section of the same triangles with mesh lines at other depths and another outer radius.

        Radii within the contact do not change, and within a contact radius of the edge or half a thickness triangles
        keep their shape as far as possible. Errors of stretched meshes are smooth functions of the contact radius, but
        each new mesh has errors of its own. The result is None where graded points differ or a thickness changes by
        more than `MOST_STRETCHED`, and the section itself where no thickness changes.
        """
        if not np.array_equal(graded, self.graded) or depths.shape != self.depths.shape:
            return None
        most = float(np.exp(np.abs(np.log(np.diff(depths) / np.diff(self.depths))).max()))
        if most > MOST_STRETCHED:
            return None
        if most < 1 + SAME:
            return self
        near, other = (min(1.0, lines[1] / 2) for lines in (self.depths, depths))
        r = np.interp(self.mesh.p[0], [0, 1, 1 + near, self.outer_radius], [0, 1, 1 + other, outer_radius])
        z = np.interp(self.mesh.p[1], np.insert(self.depths, 1, near), np.insert(depths, 1, other))
        return replace(self, mesh=replace(self.mesh, doflocs=np.array([r, z])), depths=depths)


def section_mesh(
    parts: Parts, outer_radius: float, points: Graded, growth: float, *, strip: float = 0.0, end: float = np.inf
) -> Section:
    """Mesh of a layer's section, with vertices at the graded points of the top; lengths by the contact radius.

    Args:
        parts: thicknesses of the layer.
        outer_radius: end of the section, beyond every graded point.
        points: radii on the top that become vertices, with the cell size there.
        growth: increase of the cell size per distance.
        strip: radius within which the top has cells of the last point's size; zero without a strip.
        end: radius where the profile ends upright, infinite without such an end; it limits the reach of the edge.

    Raises:
        NotConvergedError: a triangle turned over when drawn thicknesses were scaled back, or has no area.
    """
    drawing = Drawing(parts, outer_radius, points, growth, strip, end)
    drawn, regions = _triangulated(drawing)
    # Vertices of each part, numbered part by part: those on a face then exist twice.
    vertices_of = [np.unique(region) for region in regions]
    positions = np.hstack([_placed(drawing, drawn, vertices_of, index) for index in range(len(vertices_of))])
    starts = np.cumsum([0, *(len(vertices) for vertices in vertices_of)])
    each = zip(starts, vertices_of, regions, strict=False)
    corners = np.hstack([start + np.searchsorted(vertices, region) for start, vertices, region in each])
    if np.any(doubled_area(positions, corners) * np.sign(doubled_area(drawn, np.hstack(regions))) <= 0):
        raise NotConvergedError("a triangle of a thin part turned over or has no area; choose smaller cells")
    owner = np.repeat(np.arange(len(regions)), [region.shape[1] for region in regions])
    return named_section(positions, corners, owner, parts, [r for r, _ in points])


@dataclass(frozen=True)
class Drawing:
    """The section as gmsh draws it, with thickened parts; the attributes are arguments of `section_mesh`."""

    parts: Parts
    outer_radius: float
    points: Graded
    growth: float
    strip: float
    end: float

    @cached_property
    def origin(self) -> float:
        """Radius of gmsh's x = 0: the last graded point, where cells are smallest over their distance from r = 0."""
        return self.points[-1][0]

    @cached_property
    def radii(self) -> FloatArray:
        """Radii of the graded points."""
        return np.array([r for r, _ in self.points])

    @cached_property
    def cells(self) -> FloatArray:
        """Cell sizes at the graded points, enlarged where gmsh would not resolve them so far from its origin."""
        return np.maximum([cell for _, cell in self.points], RESOLVED * np.abs(self.radii - self.origin))

    @cached_property
    def stations(self) -> FloatArray:
        """Radii at which the drawn mesh lines have points, increasing; between two they are straight.

        ``max(h, s d)`` has kinks at the distances d = h / s from graded points and halfway between two of them. Far
        away further points split the lines at every factor of a hundred. Points that are too close together for their
        distance from the edge are omitted.
        """
        kink_distances: list[float] = []
        for distance in np.sort(self.parts.finite) / (SLOPE_PER_GROWTH * self.growth):
            if not kink_distances or distance > LEAST_STEP * kink_distances[-1]:
                kink_distances.append(float(distance))
        graded = self.radii
        middles = (graded[:-1] + graded[1:])[np.diff(graded) / 2 > min(kink_distances, default=np.inf)] / 2
        kink_radii = np.concatenate(
            [graded + side * distance for distance in kink_distances for side in (-1.0, 1.0)] or [np.empty(0)]
        )
        # Another graded point may be nearer than h / s: the thickness has no kink there.
        is_nearest = np.min(np.abs(kink_radii[:, None] - graded), axis=1) >= 0.999 * np.repeat(
            kink_distances, 2 * len(graded)
        )
        far = 1.0 + max([1.0, *kink_distances]) * 100.0 ** np.arange(1, 8)
        candidates = np.concatenate([graded, middles, kink_radii[is_nearest], far])
        candidates = np.unique(candidates[(candidates > 0) & (candidates < 0.3 * self.outer_radius)])
        kept = [0.0]
        for radius in (*candidates, self.outer_radius):
            is_crowded = radius - kept[-1] <= 0.2 * float(self.distance(np.array([radius]))[0])
            if radius in graded or radius == self.outer_radius or not is_crowded:
                kept.append(float(radius))
        return np.unique(kept + self._splits(kept))

    def _splits(self, stations: list[float]) -> list[float]:
        """Radii that split lines longer than `LONGEST_LINE` cells of either end, at the mean of ln(distance)."""
        cells, splits = dict(zip(self.radii, self.cells, strict=True)), []
        for left, right in pairwise(stations):
            for end, length in ((left, right - left), (right, left - right)):
                if abs(length) > LONGEST_LINE * cells.get(end, np.inf):
                    splits.append(float(end + np.copysign(np.sqrt(cells[end] * abs(length)), length)))
        return splits

    def distance(self, radius: FloatArray) -> FloatArray:
        """Distance along the top of radii (n,) from the nearest graded point, or from the end of the strip."""
        if self.strip:
            return np.asarray(np.maximum(radius - self.strip, 0.0))
        return np.asarray(np.min(np.abs(radius[:, None] - self.radii), axis=1))

    @cached_property
    def drawn(self) -> FloatArray:
        """Drawn thickness ``max(h, s d)`` of each part at the stations, shape (part, station).

        The bottom of an elastic base or half-space is straight: faces far above it bend by much less than its cells.
        """
        wedge = SLOPE_PER_GROWTH * self.growth * self.distance(self.stations)
        drawn = np.maximum(self.parts.finite[:, None], wedge)
        if not self.parts.has_base:
            return drawn
        top = drawn.sum(axis=0)
        end = np.interp(self.stations, self.stations[[0, -1]], top[[0, -1]] + self.parts.thicknesses[-1])
        return np.vstack([drawn, end - top])

    @cached_property
    def levels(self) -> FloatArray:
        """Drawn depth of each mesh line at the stations, shape (line, station)."""
        return np.vstack([np.zeros_like(self.stations), np.cumsum(self.drawn, axis=0)])

    @property
    def size_expression(self) -> str:
        """Cell size as a function of gmsh's x = r - origin and y = z.

        It is the smallest of the sizes that the graded points, the strip and, by `FAR_GROWTH`, the thickness allow.
        """
        x = [f"(x{self.origin - r:+.17g})" for r in self.radii]
        distances = [f"Sqrt({each}*{each}+y*y)" for each in x]
        gaps = np.diff([0.0 if self.radii[0] else -np.inf, *self.radii, self.end])
        reaches = [min(left, right, self.parts.parts[0].thickness) for left, right in pairwise(gaps)]
        each = zip(self.cells, distances, reaches, strict=True)
        sizes = [f"{cell:.17g}+{self._grown(distance, reach)}" for cell, distance, reach in each]
        if self.strip:
            beyond = f"(x{self.origin - self.strip:+.17g})"
            distances.append(f"Sqrt(0.5*{beyond}*({beyond}+Abs{beyond})+y*y)")
            sizes.append(f"{self.cells[-1]:.17g}+{self.growth:.17g}*{distances[-1]}")
        if len(self.parts.finite):
            widest = max(self.growth * float(self.parts.finite.sum()), self.cells[-1] if self.strip else 0.0)
            sizes.append(f"Max({widest:.17g},{FAR_GROWTH * self.growth:.17g}*{distances[-1]})")
        expression = sizes[-1]
        for size in reversed(sizes[:-1]):
            expression = f"Min({size},{expression})"
        return expression

    def _grown(self, distance: str, reach: float) -> str:
        """Increase of the cell size over that at a graded point, as a gmsh expression of the distance d from the point.

        ``max(PLAIN_SHARE g d, min(NEARBY_GROWTH g^(1/2) d, g (s/d)^NEARBY_POWER d))`` with the growth g.

        Args:
            distance: gmsh expression of d.
            reach: s, distance to the next graded point, at most the thickness of the first part.
        """
        plain, most = PLAIN_SHARE * self.growth, NEARBY_GROWTH * self.growth**0.5
        nearby = f"{self.growth * reach**NEARBY_POWER:.17g}*{distance}^{1 - NEARBY_POWER:.17g}"
        return f"Max({plain:.17g}*{distance},Min({most:.17g}*{distance},{nearby}))"

    def layer_positions(self, points: FloatArray, part: int) -> FloatArray:
        """(r, z) in the layer of drawn points (2, n) of one part, at the same relative depth within the part."""
        x = self.stations - self.origin
        share = (points[1] - np.interp(points[0], x, self.levels[part])) / np.interp(points[0], x, self.drawn[part])
        top, bottom = self.parts.depths[part : part + 2]
        return np.vstack([points[0] + self.origin, np.clip(top + share * (bottom - top), top, bottom)])


@cache
def _gmsh() -> Any:
    """The gmsh module, initialised once per process."""
    try:
        import gmsh  # noqa: PLC0415 - a missing system library gives one clear message, at first use
    except OSError as reason:
        raise ImportError(MISSING_LIBRARIES.format(reason=reason)) from reason
    # gmsh resets SIGPIPE, so that a broken pipe would end the process and its pool: the handler is restored. Only the
    # main thread may set signals, and Windows has no such signal.
    pipe = getattr(signal, "SIGPIPE", None) if current_thread() is main_thread() else None
    handler = pipe and signal.getsignal(pipe)
    gmsh.initialize([], interruptible=False)
    if pipe:
        signal.signal(pipe, handler)
    for option, value in {
        "General.Terminal": 0,
        "General.NumThreads": 1,
        "Mesh.Algorithm": DELAUNAY,
        "Mesh.RandomSeed": 1,
        "Mesh.MeshSizeExtendFromBoundary": 0,
        "Mesh.MeshSizeFromPoints": 0,
        "Mesh.MeshSizeFromCurvature": 0,
        "Mesh.MeshSizeMin": 0,
        "Mesh.LcIntegrationPrecision": LINE_PRECISION,
    }.items():
        gmsh.option.setNumber(option, value)
    return gmsh


def _triangulated(drawing: Drawing) -> tuple[FloatArray, list[IntArray]]:
    """Points (2, n) as drawn, and the triangles (3, m) of each part, as indices of points."""
    gmsh = _gmsh()
    gmsh.model.add("layer")
    try:
        surfaces = _draw(gmsh.model.geo, drawing)
        gmsh.model.geo.synchronize()
        field, mesh = gmsh.model.mesh.field, gmsh.model.mesh
        field.add("MathEval", 1)
        field.setString(1, "F", drawing.size_expression)
        field.setAsBackgroundMesh(1)
        mesh.generate(2)
        tags, coordinates, _ = mesh.getNodes()
        position = np.empty(int(tags.max()) + 1, dtype=np.int64)
        position[tags] = np.arange(len(tags))
        points = np.ascontiguousarray(coordinates.reshape(-1, 3)[:, :2].T)
        connectivity = (mesh.getElementsByType(2, surface)[1] for surface in surfaces)
        return points, [np.ascontiguousarray(position[nodes].reshape(-1, 3).T) for nodes in connectivity]
    finally:
        gmsh.model.remove()


def _draw(geo: Any, drawing: Drawing) -> list[int]:
    """Draw one surface per part, between its two mesh lines, and return gmsh's numbers of the surfaces.

    The bottom of an elastic base or half-space is one line. The axis of a thick part is split at every factor of a
    hundred in depth, as the mesh lines are.
    """
    x, lines = drawing.stations - drawing.origin, []
    for index, level in enumerate(drawing.levels):
        chosen = (
            slice(None, None, len(x) - 1)
            if drawing.parts.has_base and index == len(drawing.parts.parts)
            else slice(None)
        )
        points = [geo.addPoint(place, depth, 0.0) for place, depth in zip(x[chosen], level[chosen], strict=True)]
        lines.append((points, [geo.addLine(a, b) for a, b in pairwise(points)]))
    surfaces = []
    for (above, below), top, thickness in zip(pairwise(lines), drawing.levels[:, 0], drawing.drawn[:, 0], strict=False):
        far = max(1.0, top) * 100.0 ** np.arange(7, 0, -1)
        inner = [geo.addPoint(x[0], top + z, 0.0) for z in far[far < 0.1 * thickness]]
        axis = [geo.addLine(a, b) for a, b in pairwise([below[0][0], *inner, above[0][0]])]
        right = geo.addLine(above[0][-1], below[0][-1])
        loop = [*above[1], right, *(-curve for curve in reversed(below[1])), *axis]
        surfaces.append(int(geo.addPlaneSurface([geo.addCurveLoop(loop)])))
    return surfaces


def _placed(drawing: Drawing, drawn: FloatArray, vertices_of: list[IntArray], part: int) -> FloatArray:
    """(r, z) of the vertices of a part; z is exact on its faces, on the top and on the base."""
    vertices, (top, bottom) = vertices_of[part], drawing.parts.depths[part : part + 2]
    points = drawing.layer_positions(drawn[:, vertices], part)
    on_top = np.isin(vertices, vertices_of[part - 1]) if part else drawn[1, vertices] == 0
    is_last = part == len(vertices_of) - 1
    on_bottom = points[1] >= bottom - ON_BASE * (bottom - top) if is_last else np.isin(vertices, vertices_of[part + 1])
    points[1, on_top], points[1, on_bottom] = top, bottom
    return points


def doubled_area(points: FloatArray, triangles: IntArray) -> FloatArray:
    """Twice the signed area of triangles (3, m) of points (2, n), shape (m,)."""
    (r0, r1, r2), (z0, z1, z2) = points[:, triangles]
    return np.asarray((r1 - r0) * (z2 - z0) - (r2 - r0) * (z1 - z0))


def named_section(
    points: FloatArray, triangles: IntArray, part: IntArray, parts: Parts, graded: Sequence[float] = ()
) -> Section:
    """Section of points (2, n) and triangles (3, m) in the parts of indices (m,), with named boundaries and faces.

    ``graded`` are the radii of graded points, for `Section.stretched`.

    Raises:
        NotConvergedError: a triangle has no area.
    """
    mesh = MeshTri(points, triangles)
    if np.any(doubled_area(mesh.p, mesh.t) == 0):
        raise NotConvergedError("a triangle has no area: a kink lies closer to the contact's edge than cells resolve")
    outer_radius, thickness = points.max(axis=1)
    facets = mesh.boundary_facets()
    r, z = mesh.p[:, mesh.facets[:, facets]]
    sides = {"axis": r == 0, "top": z == 0, "base": z == thickness, "outer": r == outer_radius}
    boundaries = {name: facets[side.all(axis=0)] for name, side in sides.items()}
    owner, faces = part[mesh.f2t[0, facets]], []
    for upper, depth in enumerate(parts.depths[1:-1]):
        on_line = np.all(z == depth, axis=0)
        above, below = (facets[on_line & (owner == side)] for side in (upper, upper + 1))
        faces.append(Face(above, below, parts.parts[upper].slips))
    depths = np.array([*parts.depths[:-1], thickness])
    return Section(mesh.with_boundaries(boundaries), part, tuple(faces), np.array(graded), depths)
