"""Graded triangle meshes of a layer's cross-section in (r, z), made by gmsh in memory.

The section is 0 <= r <= outer radius, 0 <= z <= thickness with z into the layer.  Its boundaries have names:
``axis`` (r = 0), ``top`` (z = 0), ``base`` (z = thickness), ``outer`` (r = outer radius).
gmsh appears in this module only.
"""

from __future__ import annotations

import hashlib
import signal
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from itertools import pairwise
from threading import current_thread, main_thread
from typing import Any

import numpy as np
from skfem import MeshTri

from contact.records.errors import NotConvergedError
from contact.records.validation import FloatArray, IntArray
from fem_reference.discrete_layer.assembly import Space
from fem_reference.discrete_layer.elements import ElementPair, element_pair
from fem_reference.discrete_layer.grading import Grading
from fem_reference.discrete_layer.solving.ordering import Elimination, elimination

MISSING_LIBRARIES = (
    "gmsh could not be loaded ({reason}). On Debian or Ubuntu install its system libraries: "
    "apt-get install libglu1-mesa libxcursor1 libxft2 libxinerama1"
)


# Longest line over its smallest cell; gmsh takes minutes for longer ones.
LONGEST_LINE = 1e10
# Share of a cell to which gmsh integrates cell sizes along lines.  At its own 1e-9 a mesh takes 24, 19 and 26 ms
# at growths 2, 0.7 and 0.4, at this 7, 12 and 17.  At 1e-7 and 1e-6 the slope of the load in rings of 1e-9 radii beside
# a flat end errs by 6 to 7 per cent, where its test allows 5 (2026-11-23).
LINE_PRECISION = 1e-8


@dataclass(frozen=True)
class LayerMesh:
    """A triangle mesh of the section; ``fingerprint`` identifies its points and triangles."""

    mesh: MeshTri
    thickness: float
    outer_radius: float
    fingerprint: str

    @property
    def surface_thickness(self) -> float:
        """Thickness of the part that touches the indenter."""
        return self.thickness

    def space(self, pair: ElementPair) -> Space:
        """Unknowns and basis of an element pair on it."""
        return Space(self.mesh, pair)

    @cached_property
    def elimination(self) -> Elimination:
        """In which order its nodes are eliminated, whatever the pair."""
        return elimination(self.space(element_pair("P3P2")))


@cache
def _gmsh() -> Any:
    """The gmsh module, initialised once per process."""
    try:
        import gmsh  # noqa: PLC0415 - a missing system library shall give one clear message, at first use
    except OSError as reason:
        raise ImportError(MISSING_LIBRARIES.format(reason=reason)) from reason
    # gmsh lets a broken pipe end the process: a pool would die with any of its workers.  Only the main thread may set
    # signals, and Windows has no such signal.
    pipe = getattr(signal, "SIGPIPE", None) if current_thread() is main_thread() else None
    handler = pipe and signal.getsignal(pipe)
    gmsh.initialize([], interruptible=False)
    if pipe:
        signal.signal(pipe, handler)
    for option, value in {
        "General.Terminal": 0,
        "General.NumThreads": 1,
        "Mesh.Algorithm": 6,
        "Mesh.RandomSeed": 1,
        "Mesh.MeshSizeExtendFromBoundary": 0,
        "Mesh.MeshSizeFromPoints": 0,
        "Mesh.MeshSizeFromCurvature": 0,
        "Mesh.MeshSizeMin": 0,
    }.items():
        gmsh.option.setNumber(option, value)
    return gmsh


def layer_mesh(thickness: float, outer_radius: float, grading: Grading) -> LayerMesh:
    """Mesh the section of a layer, with vertices at the graded points of the top.

    Args:
        thickness: layer thickness, any unit of length.
        outer_radius: radius of the section, same unit; beyond every graded point.
        grading: cell sizes.

    Returns:
        The mesh with named boundaries.
    """

    def draw(geo: Any) -> list[int]:
        """The section as gmsh's only surface."""
        return [_draw_section(geo, thickness, outer_radius, grading)]

    points, (triangles,) = _triangulated(draw, grading.size_expression())
    points[0] += grading.origin
    return named_layer_mesh(points, triangles)


def triangles_between(lines: Sequence[FloatArray], size_expression: str) -> tuple[FloatArray, list[IntArray]]:
    """Triangles of the regions between lines.

    Args:
        lines: polylines (2, n) from the first to the last x, one below the other, none touching.
        size_expression: cell size as a function of gmsh's x and y.

    Returns:
        Points (2, n), and the triangles (3, m) of each region; neighbours share the points on their line.
    """

    def draw(geo: Any) -> list[int]:
        """One surface between two lines each."""
        curves = [_draw_line(geo, line) for line in lines]
        return [_draw_region(geo, above, below) for above, below in pairwise(curves)]

    return _triangulated(draw, size_expression)


def _triangulated(draw: Callable[[Any], list[int]], size_expression: str) -> tuple[FloatArray, list[IntArray]]:
    """Points (2, n) and the triangles of each surface drawn."""
    gmsh = _gmsh()
    gmsh.option.setNumber("Mesh.LcIntegrationPrecision", LINE_PRECISION)
    gmsh.model.add("layer")
    try:
        surfaces = draw(gmsh.model.geo)
        gmsh.model.geo.synchronize()
        field = gmsh.model.mesh.field
        field.add("MathEval", 1)
        field.setString(1, "F", size_expression)
        field.setAsBackgroundMesh(1)
        gmsh.model.mesh.generate(2)
        return _mesh_arrays(gmsh.model.mesh, surfaces)
    finally:
        gmsh.model.remove()


def _draw_line(geo: Any, line: FloatArray) -> tuple[list[int], list[int]]:
    """Its points and its curves."""
    points = [geo.addPoint(x, y, 0.0) for x, y in line.T]
    return points, [geo.addLine(a, b) for a, b in pairwise(points)]


def _draw_region(geo: Any, above: tuple[list[int], list[int]], below: tuple[list[int], list[int]]) -> int:
    """The surface between two lines."""
    right, left = geo.addLine(above[0][-1], below[0][-1]), geo.addLine(below[0][0], above[0][0])
    loop = [*above[1], right, *(-curve for curve in reversed(below[1])), left]
    return int(geo.addPlaneSurface([geo.addCurveLoop(loop)]))


def _draw_section(geo: Any, thickness: float, outer_radius: float, grading: Grading) -> int:
    """One rectangle whose top carries the graded radii as vertices; long sides are split, for gmsh's line meshing."""
    last = max([*(r for r, _ in grading.points), 0.0])
    ends = (r - grading.origin for r in (0.0, *_far_stations(last, outer_radius), outer_radius))
    x = _split_where_fine(sorted({*ends, *(start for start, _ in grading.shifted)}), dict(grading.shifted))
    depths = sorted(_far_stations(last, thickness), reverse=True)
    corners = [geo.addPoint(each, 0.0, 0.0) for each in x]
    corners += [geo.addPoint(x[-1], thickness, 0.0), geo.addPoint(x[0], thickness, 0.0)]
    corners += [geo.addPoint(x[0], z, 0.0) for z in depths]
    edges = [geo.addLine(a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]
    return int(geo.addPlaneSurface([geo.addCurveLoop(edges)]))


def _far_stations(start: float, end: float) -> list[float]:
    """Every hundredfold of ``start`` well before ``end``."""
    stations = []
    while start > 0 and 100 * start < 0.1 * end:
        start *= 100
        stations.append(start)
    return stations


def _split_where_fine(x: list[float], cells: dict[float, float]) -> list[float]:
    """Lines more than 1e10 cells of one of their ends long are split: gmsh would take minutes for them."""
    stations = [*x]
    for left, right in pairwise(x):
        for end, away in ((left, right - left), (right, left - right)):
            if abs(away) > LONGEST_LINE * cells.get(end, np.inf):
                stations.append(end + np.copysign(np.sqrt(cells[end] * abs(away)), away))
    return sorted(stations)


def _mesh_arrays(gmsh_mesh: Any, surfaces: list[int]) -> tuple[FloatArray, list[IntArray]]:
    """Points (2, n), and triangles (3, m) of each surface."""
    tags, coordinates, _ = gmsh_mesh.getNodes()
    position = np.empty(int(tags.max()) + 1, dtype=np.int64)
    position[tags] = np.arange(len(tags))
    points = np.ascontiguousarray(coordinates.reshape(-1, 3)[:, :2].T)
    found = (gmsh_mesh.getElementsByType(2, surface)[1] for surface in surfaces)
    return points, [np.ascontiguousarray(position[nodes].reshape(-1, 3).T) for nodes in found]


def named_layer_mesh(points: FloatArray, triangles: IntArray) -> LayerMesh:
    """Name the four boundaries of a rectangular section given by points (2, n) and triangles (3, m).

    Raises:
        NotConvergedError: If a triangle has no area.
    """
    mesh = MeshTri(points, triangles)
    (r0, r1, r2), (z0, z1, z2) = mesh.p[:, mesh.t]
    if np.any((r1 - r0) * (z2 - z0) == (r2 - r0) * (z1 - z0)):
        raise NotConvergedError("a triangle has no area: a kink lies closer to the contact's edge than cells can tell")
    outer_radius, thickness = points.max(axis=1)
    r, z = mesh.p[:, mesh.facets]
    on_boundary = np.isin(np.arange(mesh.facets.shape[1]), mesh.boundary_facets())
    sides = {"axis": r == 0, "top": z == 0, "base": z == thickness, "outer": r == outer_radius}
    boundaries = {name: np.flatnonzero(side.all(axis=0) & on_boundary) for name, side in sides.items()}
    digest = hashlib.sha256(mesh.p.tobytes() + mesh.t.tobytes()).hexdigest()
    return LayerMesh(mesh.with_boundaries(boundaries), float(thickness), float(outer_radius), digest[:16])
