"""Nested dissection of a triangle mesh: an elimination order that needs no pivoting and little fill.

The triangles are halved again and again along the longer side of each part's bounding box.  An unknown shared by two
halves belongs to the separator between them and is eliminated after both.  Inside every part and separator the
displacements come before the pressures: by the inf-sup condition each pressure pivot is then the (negative) Schur
complement of displacements already eliminated, so the symmetric indefinite matrix factors without row exchanges.
"""

from __future__ import annotations

import numpy as np

from contact.records.validation import FloatArray, IntArray
from fem_reference.discrete_layer.assembly import Space


def nested_dissection(space: Space) -> IntArray:
    """All unknowns of the space in their order of elimination."""
    centres = space.mesh.p[:, space.mesh.t].mean(axis=1)
    halvings = max(1, int(np.ceil(np.log2(centres.shape[1]))))
    part = np.repeat(bisect(centres, halvings), space.element_unknowns.shape[1])
    lowest = np.full(space.size, np.iinfo(np.int64).max)
    highest = np.zeros(space.size, dtype=np.int64)
    np.minimum.at(lowest, space.element_unknowns.ravel(), part)
    np.maximum.at(highest, space.element_unknowns.ravel(), part)
    # The number of halvings that are undone until one part holds all triangles of an unknown.
    level = bit_length(lowest ^ highest)
    last_part = ((lowest >> level) + 1) << level
    is_pressure = np.arange(space.size) >= space.displacement_count
    return np.lexsort((is_pressure, level, last_part)).astype(np.int64)


def bisect(points: FloatArray, halvings: int) -> IntArray:
    """Binary code of the part in which each point (2, n) lies after so many halvings by count."""
    code = np.zeros(points.shape[1], dtype=np.int64)
    for halving in range(halvings):
        parts = 1 << halving
        low, high = np.full((2, parts), np.inf), np.full((2, parts), -np.inf)
        for axis in (0, 1):
            np.minimum.at(low[axis], code, points[axis])
            np.maximum.at(high[axis], code, points[axis])
        longer = np.argmax(high - low, axis=0)
        along = points[longer[code], np.arange(points.shape[1])]
        code = 2 * code + _upper_half(along, code, parts)
    return code


def _upper_half(along: FloatArray, code: IntArray, parts: int) -> IntArray:
    """1 for the points of each part beyond its median."""
    order = np.lexsort((along, code))
    count = np.bincount(code, minlength=parts)
    start = np.concatenate([[0], np.cumsum(count)[:-1]])
    rank = np.empty(len(code), dtype=np.int64)
    rank[order] = np.arange(len(code)) - start[code[order]]
    return (rank >= (count[code] + 1) // 2).astype(np.int64)


def bit_length(numbers: IntArray) -> IntArray:
    """Number of binary digits of each non-negative number."""
    # The conversion is exact below 2^53.
    _, exponent = np.frexp(numbers.astype(np.float64))
    return exponent.astype(np.int64)
