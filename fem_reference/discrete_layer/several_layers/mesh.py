"""Meshes of stacks and graded layers: lines at every face, each part with vertices of its own."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contact import ElasticLayer, NotConvergedError
from contact.records.validation import FloatArray, IntArray
from fem_reference.discrete_layer.elements import ElementPair
from fem_reference.discrete_layer.indenter import ScaledIndenter
from fem_reference.discrete_layer.mesh import LayerMesh, named_layer_mesh, triangles_between
from fem_reference.discrete_layer.settings import Discretisation, graded_points
from fem_reference.discrete_layer.several_layers.drawing import Drawing
from fem_reference.discrete_layer.several_layers.joined_space import Face, JoinedSpace
from fem_reference.discrete_layer.several_layers.parts import LayerParts, parts_of

# Distance from the base, over the last part's thickness, within which a vertex lies on it: far above gmsh's roundings,
# and far below cells there.
ON_BASE = 1e-9


@dataclass(frozen=True)
class PartsMesh(LayerMesh):
    """A mesh of several parts; vertices on the face of two parts are there twice.

    Attributes:
        body: the parts.
        part: index of the part of each triangle.
        faces: where parts meet.
    """

    body: LayerParts
    part: IntArray
    faces: tuple[Face, ...]

    @property
    def surface_thickness(self) -> float:
        """Thickness of the part that touches the indenter."""
        return self.body.parts[0].thickness

    def space(self, pair: ElementPair) -> JoinedSpace:
        """Unknowns and basis of an element pair on it."""
        return JoinedSpace(self.mesh, pair, self.faces)


def contact_parts_mesh(layer: ElasticLayer, indenter: ScaledIndenter, settings: Discretisation) -> PartsMesh:
    """The graded section of a contact of known radius."""
    body = parts_of(layer, indenter.contact_radius, base_reach(layer, settings))
    points = graded_points(body.parts[0].thickness, indenter, settings)
    return _mesh_of(Drawing(body, outer_radius(body, settings), points, settings.growth))


def parts_mesh(
    layer: ElasticLayer,
    radius: float,
    points: tuple[tuple[float, float], ...],
    settings: Discretisation,
    strip: float = 0.0,
) -> PartsMesh:
    """A section with cells of one size on a strip of a radius [m]; lengths by that radius."""
    body = parts_of(layer, radius, base_reach(layer, settings))
    return _mesh_of(Drawing(body, outer_radius(body, settings), points, settings.growth, strip))


def base_reach(layer: ElasticLayer, settings: Discretisation) -> float:
    """How far an elastic base is meshed: what is left out falls with the square, and a stiff film spreads the load."""
    contrast = parts_of(layer, 1.0, 1.0).contrast
    return float(np.sqrt(settings.half_space_thickness) * contrast**0.25)


def outer_radius(body: LayerParts, settings: Discretisation) -> float:
    """Where the section ends, by the contact radius.

    Stiff parts on soft ones carry disturbances on for the root of their ratio.  Between bonded parts on a rigid base
    they die out exponentially, with a sliding face like 1/r, and their energy beyond the end like its inverse square.
    """
    if body.base_modulus:
        return float(body.thicknesses[-1])
    length = body.layer_thickness * np.sqrt(body.contrast)
    decay = settings.truncation**-0.5 if body.slides else -np.log(settings.truncation)
    return float(1 + length * decay)


def _mesh_of(drawing: Drawing) -> PartsMesh:
    """Drawn, meshed, moved back, and cut at the faces.

    Raises:
        NotConvergedError: a triangle turned over when it was moved back.
    """
    drawn, regions = triangles_between(drawing.lines, drawing.size_expression)
    owned = [np.unique(region) for region in regions]
    points = [_placed(drawing, drawn, owned, part) for part in range(len(owned))]
    starts = np.cumsum([0, *(len(vertices) for vertices in owned)])
    triangles = [
        start + np.searchsorted(own, region) for start, own, region in zip(starts, owned, regions, strict=False)
    ]
    where, corners = np.hstack(points), np.hstack(triangles)
    if np.any(_doubled_area(where, corners) * np.sign(_doubled_area(drawn, np.hstack(regions))) <= 0):
        raise NotConvergedError("a triangle of a thin part turned over; ask for smaller cells")
    named = named_layer_mesh(where, corners)
    part = np.repeat(np.arange(len(regions)), [region.shape[1] for region in regions])
    return PartsMesh(
        named.mesh,
        named.thickness,
        named.outer_radius,
        named.fingerprint,
        drawing.body,
        part,
        tuple(_face(named, part, upper, drawing.body) for upper in range(len(regions) - 1)),
    )


def _placed(drawing: Drawing, drawn: FloatArray, owned: list[IntArray], part: int) -> FloatArray:
    """(r, z) of the vertices of a part; those that it shares with a neighbour, or of an end, exactly on the face."""
    vertices, (top, bottom) = owned[part], drawing.body.depths[part : part + 2]
    points = drawing.moved_back(drawn[:, vertices], part)
    on_top = np.isin(vertices, owned[part - 1]) if part else drawn[1, vertices] == 0
    is_last = part == len(owned) - 1
    on_bottom = points[1] >= bottom - ON_BASE * (bottom - top) if is_last else np.isin(vertices, owned[part + 1])
    points[1, on_top], points[1, on_bottom] = top, bottom
    return points


def _doubled_area(points: FloatArray, triangles: IntArray) -> FloatArray:
    (r0, r1, r2), (z0, z1, z2) = points[:, triangles]
    return np.asarray((r1 - r0) * (z2 - z0) - (r2 - r0) * (z1 - z0))


def _face(named: LayerMesh, part: IntArray, upper: int, body: LayerParts) -> Face:
    """Facets of two neighbouring parts on their common face."""
    mesh = named.mesh
    facets = mesh.boundary_facets()
    owner = part[mesh.f2t[0, facets]]
    on_line = np.all(mesh.p[1, mesh.facets[:, facets]] == body.depths[upper + 1], axis=0)
    above, below = (facets[on_line & (owner == side)] for side in (upper, upper + 1))
    return Face(above, below, body.parts[upper].slips)
