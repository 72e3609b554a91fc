"""Where points lie in a mesh: their triangles, and their coordinates in these."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from contact.records.validation import FloatArray, IntArray

# Triangles with the nearest centres that are tried before all are.
_NEAREST = 12
# A barycentric coordinate above this is not outside its triangle, to rounding.
_ROUNDING = -1e-10


class Places(NamedTuple):
    """Triangles of n points, and their coordinates in the reference triangle, shape (2, n)."""

    triangles: IntArray
    local: FloatArray


def places_of(vertices: FloatArray, triangles: IntArray, points: FloatArray) -> Places:
    """Where points (2, n) of a meshed section lie: in the triangle in which their least barycentric is largest.

    The triangles with the nearest centres are tried first; a point that none of them holds is sought in all.
    """
    from scipy.spatial import cKDTree  # noqa: PLC0415 - only interior fields need it

    corners = vertices[:, triangles]
    near = cKDTree(corners.mean(axis=1).T).query(points.T, min(_NEAREST, triangles.shape[1]))[1]
    near = near.reshape(points.shape[1], -1)
    least, local = _coordinates(corners[:, :, near], points[:, :, None])
    best = np.argmax(least, axis=1)
    rows = np.arange(points.shape[1])
    found, inside = near[rows, best], local[:, rows, best]
    for n in np.flatnonzero(least[rows, best] < _ROUNDING):
        least, local = _coordinates(corners, points[:, n, None])
        found[n] = np.argmax(least)
        inside[:, n] = local[:, found[n]]
    return Places(found, inside)


def _coordinates(corners: FloatArray, point: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Smallest barycentric coordinate, and the second and third, of points in triangles with corners (2, 3, ...)."""
    (ax, bx, cx), (ay, by, cy) = corners
    area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
    second = ((point[0] - ax) * (cy - ay) - (cx - ax) * (point[1] - ay)) / area
    third = ((bx - ax) * (point[1] - ay) - (point[0] - ax) * (by - ay)) / area
    return np.minimum(np.minimum(second, third), 1 - second - third), np.array([second, third])
