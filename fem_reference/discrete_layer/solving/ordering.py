"""Minimum degree on the nodes of a mesh: an elimination order that needs no pivoting and little fill.

Unknowns that belong to the same triangles (of one vertex, one edge or one interior) are one node, and the node with
the fewest neighbours left is eliminated next (George and Liu, SIAM Review 31 (1989) 1-19), after all interiors, which
have none: they are condensed.  Inside every node the
displacements come before the pressures: by the inf-sup condition each pressure pivot is then the (negative) Schur
complement of displacements already eliminated, so the symmetric indefinite matrix factors without row exchanges.
A minimum degree on single unknowns takes pressures before their displacements at nu = 1/2 and needs pivots.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from contact.records.validation import FloatArray, IntArray
from fem_reference.discrete_layer.assembly import Space


@dataclass(frozen=True)
class Elimination:
    """The order of the nodes of a mesh, the same for every element pair.

    Attributes:
        tags: a number for each node, increasing.
        rank: its place in the order.
    """

    tags: FloatArray
    rank: FloatArray


def elimination(space: Space) -> Elimination:
    """The order of the nodes that unknowns of this space have; those of a P3P2 pair are all there are."""
    tags, node = np.unique(_tags(space), return_inverse=True)
    return Elimination(tags, _elimination_rank(_neighbours(space, node)))


def minimum_degree(space: Space, known: Elimination | None = None) -> IntArray:
    """All unknowns of the space in their order of elimination, which may be known from another pair on its mesh."""
    known = known or elimination(space)
    rank = known.rank[np.searchsorted(known.tags, _tags(space))]
    is_pressure = np.arange(space.size) >= space.displacement_count
    return np.lexsort((is_pressure, rank)).astype(np.int64)


def nodes(space: Space) -> IntArray:
    """Number of the node of each unknown: equal where unknowns belong to the same triangles."""
    return np.unique(_tags(space), return_inverse=True)[1].astype(np.int64)


def _tags(space: Space) -> FloatArray:
    """A number for each unknown: the sum of random numbers of its triangles, added in the order of the triangles."""
    triangles, unknowns = space.element_unknowns.shape
    numbers = np.random.default_rng(0).random(triangles)
    weights = np.repeat(numbers, unknowns)
    return np.asarray(np.bincount(space.element_unknowns.ravel(), weights, space.size), dtype=np.float64)


def _neighbours(space: Space, node: IntArray) -> sparse.csc_array:
    """How many triangles each two nodes share."""
    unknowns = space.element_unknowns
    # One unknown stands for each node, none for interiors.
    stands = np.zeros(space.size, dtype=bool)
    stands[np.unique(node, return_index=True)[1]] = True
    unknowns = unknowns[:, : unknowns.shape[1] - space.inner_count]
    triangle, place = np.nonzero(stands[unknowns])
    shape = (len(unknowns), int(node.max()) + 1)
    belongs = sparse.coo_array((np.ones(len(place)), (triangle, node[unknowns[triangle, place]])), shape=shape).tocsr()
    return (belongs.T @ belongs).tocsc()


def _elimination_rank(neighbours: sparse.csc_array) -> FloatArray:
    """Place of each node in a minimum degree order, read from a factorisation of the nodes' small graph by SuperLU."""
    # Any matrix of that pattern whose diagonal outweighs its rows factors without row exchanges.  Unknowns that others
    # stand for have no triangle, hence the one.
    heavy = neighbours + sparse.diags_array(1.0 + neighbours.sum(axis=0)).tocsc()
    options = {"SymmetricMode": True, "Equil": False}
    return np.asarray(splu(heavy, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options).perm_c)
