"""Functions on the top, and the layer condensed to it: contact problems of a few hundred unknowns.

Tractions are continuous and piecewise linear on a strip of equal cells, with hat functions phi_i; displacements are of
fourth degree, so that the mesh errs less than the contact set, which is exact to a cell. For nodal pressures p
(positive into the layer) and tangential tractions q (positive outward) the moments ``int phi_i (u_z, u_r) 2 pi r dr``
are

    C (p, q),    C = [[Z_p, Z_q], [Z_q^T, R_q]],

symmetric by Betti's reciprocity. Since the same phi_i weight displacements and expand tractions, C is the discrete
compliance of `contact_set`, positive definite. Units: lengths by the strip's radius, stresses by E*.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from scipy import sparse
from scipy.linalg import solveh_banded

from contact import ElasticLayer, NotConvergedError, StageLog
from contact.records.validation import FloatArray, IntArray
from fem_reference.assembly import taylor_hood
from fem_reference.layer import DiscreteLayer
from fem_reference.materials import Parts, parts_of
from fem_reference.mesh import Section, section_mesh
from fem_reference.settings import Discretisation

# Degree of the displacements on a strip.
STRIP_ORDER = 4
# Displacement nodes per cell of the pressures, without and with tangential tractions. With friction each cell of the
# tractions is one of the mesh: kinks inside a cell make forces err like 1 / cells.
STRIDE, RUBBED_STRIDE = 2, 4
# Number of cells of a strip at which the growth outside it is the given one: with more cells it is lower.
STRIP_CELLS = 120
# Radius of the largest contact over that of its strip: a few nodes beyond the contact are needed to solve its growth.
FILLED = 0.9
# Cells from the axis below which a kink gets no vertex: narrow cells next to the axis make pressures there oscillate.
NEAREST_KINK = 0.5


@cache
def _gauss_rule(points: int) -> tuple[FloatArray, FloatArray]:
    """Gauss nodes and weights on [-1, 1]."""
    return np.polynomial.legendre.leggauss(points)


@dataclass(frozen=True)
class TraceSpace:
    """Continuous piecewise polynomials of ``degree`` along the top, with nodal bases as on the triangles' sides.

    scikit-fem's line elements above degree 2 are hierarchical: their unknowns are no nodal values.

    Attributes:
        radii: radii of all nodes, increasing; each cell has ``degree + 1`` equispaced nodes and shares its end nodes.
        degree: polynomial degree.
    """

    radii: FloatArray
    degree: int

    @property
    def vertices(self) -> FloatArray:
        """Radii of the cell ends."""
        return self.radii[:: self.degree]

    def basis(self, t: FloatArray) -> FloatArray:
        """The degree + 1 basis functions at local coordinates t in [0, 1], shape (..., node)."""
        # Products of differences: each value has the same bits for any set of arguments.
        nodes = np.arange(self.degree + 1) / self.degree
        others = [[m for m in range(self.degree + 1) if m != n] for n in range(self.degree + 1)]
        functions = [
            np.prod((t[..., None] - nodes[other]) / (nodes[n] - nodes[other]), axis=-1)
            for n, other in enumerate(others)
        ]
        return np.stack(functions, axis=-1)

    def _values(self, cell: IntArray, t: FloatArray) -> sparse.csr_array:
        """Values of all functions at local coordinates t of cells, shape (n, node)."""
        # Every row has the degree + 1 functions of one cell.
        nodes, ends = cell[:, None] * self.degree + np.arange(self.degree + 1), np.arange(len(t) + 1)
        entries = self.basis(t).ravel(), nodes.ravel(), (self.degree + 1) * ends
        return sparse.csr_array(entries, shape=(len(t), len(self.radii)))

    def evaluate(self, values: FloatArray, radius: FloatArray) -> FloatArray:
        """Function with nodal ``values``, at radii (n,); zero beyond the trace."""
        vertices = self.vertices
        cell = np.clip(np.searchsorted(vertices, radius, side="right") - 1, 0, len(vertices) - 2)
        t = (radius - vertices[cell]) / (vertices[cell + 1] - vertices[cell])
        return np.where((radius >= vertices[0]) & (radius <= vertices[-1]), self._values(cell, t) @ values, 0.0)

    def gauss(self, points: int) -> tuple[FloatArray, FloatArray]:
        """Radii and weights ``2 pi r dr`` of a Gauss rule on every cell, both of shape (cell, point)."""
        x, w = _gauss_rule(points)
        length = np.diff(self.vertices)[:, None]
        radius = self.vertices[:-1, None] + length * (x + 1) / 2
        return radius, 2 * np.pi * radius * length * w / 2

    def at_gauss(self, points: int, parts: int = 1) -> sparse.csr_array:
        """Values of all functions at a Gauss rule on each of ``parts`` equal parts of every cell, shape (n, node)."""
        part = np.repeat(np.arange(parts * (len(self.vertices) - 1)), points)
        x = np.resize((_gauss_rule(points)[0] + 1) / 2, len(part))
        return self._values(part // parts, (part % parts + x) / parts)

    def moments(self, function_values: FloatArray, points: int) -> FloatArray:
        """``int f v 2 pi r dr`` for every basis function v, shape (node,), f given at ``gauss(points)``."""
        return np.asarray(self.at_gauss(points).T @ (self.gauss(points)[1] * function_values).ravel())

    def hat_moments(self, stride: int) -> FloatArray:
        """``int v hat 2 pi r dr`` for every basis function v and the hat functions on every ``stride``-th node.

        Shape (node, hat); ``stride`` divides the degree, so that hats bend at nodes only.
        """
        hats, points = TraceSpace(self.radii[::stride], 1), self.degree + 1
        weighted = hats.at_gauss(points).multiply(hats.gauss(points)[1].reshape(-1, 1))
        return np.asarray((self.at_gauss(points, self.degree // stride).T @ weighted).toarray())

    def mass_bands(self) -> FloatArray:
        """Mass matrix ``int u v 2 pi r dr``: the main diagonal and those below it, shape (degree + 1, node).

        That is the lower form of `scipy.linalg.solveh_banded`. The Gauss rule is exact.
        """
        values, weights = self.at_gauss(self.degree + 2), self.gauss(self.degree + 2)[1].reshape(-1, 1)
        mass = values.T @ values.multiply(weights)
        return np.array([np.append(mass.diagonal(-k), np.zeros(k)) for k in range(self.degree + 1)])

    def recover(self, nodal_forces: FloatArray) -> FloatArray:
        """Nodal values of the pressure p with ``int p v 2 pi r dr = force(v)`` for every v: the consistent recovery.

        Raises:
            NotConvergedError: two nodes coincide.
        """
        if not np.all(np.diff(self.radii) > 0):
            raise NotConvergedError(
                "two nodes of the contact coincide: its cells are smaller than roundings of the radius"
            )
        return np.asarray(solveh_banded(self.mass_bands(), nodal_forces, lower=True, check_finite=False))


@dataclass(frozen=True)
class Surface:
    """Compliance of the top within radius one.

    Attributes:
        tractions: piecewise linear functions; their nodes are the candidates for contact.
        compliance: C, moments of u_z and u_r under each pressure and each tangential traction, shape (2 n, 2 n);
            only Z_p, shape (n, n), without tangential tractions.
        resultants: ``w_i = int phi_i 2 pi r dr``, shape (n,).
        base_forces: force on the base under each traction, shape (n,) or (2 n,).
        top: polynomials on the whole top of the mesh.
        top_displacements: u_z at the nodes of ``top`` under each traction, shape (t, n) or (t, 2 n).
        unknowns: size of the linear system.
        fingerprint: hash of the mesh.
        poissons_ratio: nu at the surface.
    """

    tractions: TraceSpace
    compliance: FloatArray
    resultants: FloatArray
    base_forces: FloatArray
    top: TraceSpace
    top_displacements: FloatArray
    unknowns: int
    fingerprint: str
    poissons_ratio: float

    @property
    def radii(self) -> FloatArray:
        """Radii of the candidates for contact, shape (n,)."""
        return self.tractions.radii

    def moments(self, values: FloatArray) -> FloatArray:
        """``int phi_i f 2 pi r dr`` for f given at ``tractions.gauss(4)``."""
        return self.tractions.moments(values, 4)


def strip_section(
    layer: ElasticLayer,
    radius: float,
    cells: int,
    kinks: tuple[float, ...],
    settings: Discretisation,
    *,
    outside: float = 1.0,
    stride: int = STRIDE,
) -> tuple[Parts, Section]:
    """Section with ``cells`` equal traction cells on the strip, lengths in units of its radius.

    Away from the strip the mesh errs like growth^7, the contact set like 1 / cells^2. With growth proportional to
    cells^(-1/3) both fall alike.

    Args:
        layer: layer of the scene.
        radius: radius of the strip [m].
        cells: number of traction cells; a mesh cell covers ``STRIP_ORDER / stride`` of them.
        kinks: radii [m] that become vertices.
        settings: numerical settings; their growth is replaced.
        outside: growth for `STRIP_CELLS` cells.
        stride: displacement nodes from one traction vertex to the next.
    """
    cell = STRIP_ORDER / stride / cells
    points = (*((r / radius, cell) for r in kinks if NEAREST_KINK * cell * radius <= r < radius), (1.0, cell))
    growth = outside * (STRIP_CELLS / cells) ** (1 / 3)
    parts = parts_of(layer, radius, settings.half_space_thickness)
    return parts, section_mesh(parts, replace(settings, growth=growth).outer_radius(parts), points, growth, strip=1.0)


def strip_loads(layer: DiscreteLayer, stride: int, *, tangential: bool = False) -> tuple[FloatArray, TraceSpace]:
    """Nodal forces of each hat function, as pressure and then as tangential traction, and the space of the hats.

    The forces have shape (size, n), or (size, 2 n) with tangential tractions.
    """
    nodes = layer.top_nodes(1.0)
    radii = layer.space.positions[0, nodes]
    moments = TraceSpace(radii, layer.pair.degree).hat_moments(stride)
    n = moments.shape[1]
    loads = np.zeros((layer.space.size, n * (1 + tangential)))
    loads[2 * nodes + 1, :n] = moments
    if tangential:
        loads[2 * nodes, n:] = moments
    return loads, TraceSpace(radii[::stride], 1)


def condense(
    parts: Parts,
    section: Section,
    log: StageLog,
    *,
    stride: int = STRIDE,
    tangential: bool = False,
) -> Surface:
    """Compliance of the strip of radius one: one factorisation, one solution per hat function."""
    layer = DiscreteLayer(section, taylor_hood(STRIP_ORDER), parts)
    with log.stage("assemble"):
        log.hold(layer.elements.nbytes)
    with log.stage("factor"):
        solver = layer.solver(layer.supported_unknowns)
    log.count("factorisations", solver.factorisations)
    with log.stage("condense"):
        loads, tractions = strip_loads(layer, stride, tangential=tangential)
        solution = solver.solve_loaded(loads, inside=False)
        compliance = loads.T @ solution
        compliance = (compliance + compliance.T) / 2
        log.hold(solution.nbytes + compliance.nbytes)
    n, top = len(tractions.radii), layer.top_nodes(np.inf)
    return Surface(
        tractions=tractions,
        compliance=compliance,
        resultants=loads.sum(axis=0)[:n],
        base_forces=-solver.reactions(solution, 2 * layer.nodes_on("base") + 1).sum(axis=0),
        top=TraceSpace(layer.space.positions[0, top], STRIP_ORDER),
        top_displacements=solution[2 * top + 1],
        unknowns=layer.space.size,
        fingerprint=section.fingerprint,
        poissons_ratio=parts.poissons_ratio,
    )
