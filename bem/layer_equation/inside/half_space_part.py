"""What a half-space of the surface material feels: closed forms in ``zeta = z + i t``, integrated over the density.

With ``R = sqrt(r^2 + zeta^2)`` the transforms ``int p^ k^m exp(-kz) J_n(kr) dk`` are ``(E*/pi) int phi Re K_mn dt``.
Each K_mn is ``i d/dt`` of the one before it, so that by parts

    int_0^a phi Re K_mn dt = int_0^a phi' Im K_(m-1)n dt - phi(a) Im K_(m-1)n(a),

the superposition of flat punches, which keeps its digits near the surface. The integrand is singular at t = r +- iz:
the substitution t = r + z sinh(s) moves that half a turn away, at every depth.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from bem.layer_equation.inside.density import Density, Piece
from bem.polynomials.gauss_panels import PANEL_NODES, gauss_nodes
from contact.records.validation import FloatArray

# Length of a panel of s: singularities lie pi/2 beside it, which leaves 1e-15.
_LENGTH = 1.5
# Share of its first panel that is taken alone at a tip, where slopes begin like any power: Gauss nodes on the rest, so
# far from the tip, leave 2.38^-40.
_AT_TIP = 0.2


class Integrals(NamedTuple):
    """int phi Re K_mn dt at each point; those of n = 1 are divided by r.

    The last is the sum of the squares of what a rounding does to the terms of i20 and of r i21, over a rounding.
    """

    i00: FloatArray
    i10: FloatArray
    i20: FloatArray
    i01: FloatArray
    i11: FloatArray
    i21: FloatArray
    squares: FloatArray


class Points(NamedTuple):
    """Points inside, their distances from where the density's pieces end known with all digits.

    Attributes:
        r: Radii, shape (n,).
        z: Depths, z > 0, shape (n,).
        ends: Ends of the pieces minus r, the first beginning first, shape (pieces + 1, n).
    """

    r: FloatArray
    z: FloatArray
    ends: FloatArray


def integrals(density: Density, points: Points) -> Integrals:
    """At points of shape (n,)."""
    r, z, ends = points
    total = np.zeros((7, r.size))
    if density.edge_value:
        total[:6] -= density.edge_value * at_edge(density, points)
    for piece, start, stop in zip(density.pieces, ends[:-1], ends[1:], strict=True):
        total += _over_piece(density, piece, Points(r, z, np.array([start, stop])))
    return Integrals(*total)


def at_edge(density: Density, points: Points) -> FloatArray:
    """What a unit edge value of the density adds to the first six integrals, with the opposite sign, shape (6, n)."""
    return _kernels(points.r, points.z, np.full(points.r.shape, density.radius), points.ends[-1])


def _over_piece(density: Density, piece: Piece, points: Points) -> FloatArray:
    """Over one piece; where it reaches far to both sides of the radius, over either side alone.

    Positions s are counted from where they are least, beside the radius: terms are largest there, and a position errs
    by a rounding of itself.
    """
    r, z, ends = points
    start, stop = ends / z
    first, last, width = np.arcsinh(start), np.arcsinh(stop), _width(start, stop, piece.length / z)
    both = (first < -_LENGTH) & (last > _LENGTH)
    before = _Spread(r, z, -ends[0], first, np.where(both, 0.0, last), np.where(both, -first, width))
    total = _over_part(density, piece, before)
    if both.any():
        beyond = _Spread(r, z, -ends[0], np.zeros_like(r), last, last)
        total[:, both] += _over_part(density, piece, _Spread(*(column[both] for column in beyond)), begins=False)
    return total


def _width(first: FloatArray, last: FloatArray, apart: FloatArray) -> FloatArray:
    """Difference of the arsinh of two numbers that lie `apart`, which says more than their own difference."""
    one, other = np.abs(first), np.abs(last)
    of_one_sign = apart * (one + other) / (one * np.hypot(1.0, last) + other * np.hypot(1.0, first))
    width = np.where(first * last >= 0.0, np.arcsinh(of_one_sign), np.arcsinh(last) - np.arcsinh(first))
    return np.asarray(width)


class _Spread(NamedTuple):
    """A part of a piece as points see it, each of shape (n,).

    Attributes:
        r: Radii.
        z: Depths.
        behind: How far the piece's beginning lies behind the radius.
        first: First s.
        last: Last s.
        width: How far they are apart.
    """

    r: FloatArray
    z: FloatArray
    behind: FloatArray
    first: FloatArray
    last: FloatArray
    width: FloatArray


def _over_part(density: Density, piece: Piece, points: _Spread, *, begins: bool = True) -> FloatArray:
    total = np.zeros((7, points.r.size))
    panels = np.ceil(points.width / _LENGTH).astype(int)
    # Points that need the same number of panels are taken together.
    for count in np.unique(panels):
        some = panels == count
        spread = _Spread(*(column[some] for column in points))
        total[:, some] = _by_panels(density, piece, spread, int(count), begins=begins)
    return total


def _by_panels(density: Density, piece: Piece, points: _Spread, count: int, *, begins: bool) -> FloatArray:
    r, z, behind, first, last, whole = (column[:, None] for column in points)
    share, weight = _panels(count, piece, begins=begins)
    width = whole / count
    step = width * share.ravel()
    s = np.where(np.abs(first) <= np.abs(last), first + step, last - width * (count - share.ravel()))
    beyond = z * np.sinh(s)
    offset = behind + beyond
    if begins:
        # Close to the beginning a difference would lose its digits.
        near = step[:, :PANEL_NODES] / 2.0
        offset[:, :PANEL_NODES] = 2.0 * z * np.cosh(first + near) * np.sinh(near)
    offset = np.minimum(offset, piece.length)
    slope = density.slope(piece, offset) * width * weight.ravel() * z * np.cosh(s)
    kernels = _kernels(r, z, r + beyond, beyond)
    # A position s is rounded by a share of itself, and the term with it.
    terms = kernels[[2, 5]] * (slope * (1.0 + np.abs(s)))
    squares = np.sum(terms[0] ** 2, axis=1) + r[:, 0] ** 2 * np.sum(terms[1] ** 2, axis=1)
    return np.vstack([np.einsum("cpn,pn->cp", kernels, slope), squares])


def _panels(count: int, piece: Piece, *, begins: bool) -> tuple[FloatArray, FloatArray]:
    """Nodes and weights of panels of unit length; where the piece begins, the first crowds its nodes there."""
    u, w = gauss_nodes(PANEL_NODES)
    ends, power = np.arange(count + 1.0), piece.power if begins else 1.0
    if power > 1.0 and piece.start == 0.0:
        # Twice the power, which would be too much for a whole panel, makes all powers above one smooth.
        ends, power = np.insert(ends, 1, _AT_TIP), 2.0 * power
    widths = np.diff(ends)[:, None]
    share, weight = ends[:-1, None] + widths * u, widths * w
    share[0], weight[0] = ends[1] * u**power, ends[1] * w * power * u ** (power - 1.0)
    return share, weight


def _kernels(r: FloatArray, z: FloatArray, t: FloatArray, beyond: FloatArray) -> FloatArray:
    """Im of K_(m-1)n for (m, n) = (0,0), (1,0), (2,0), (0,1), (1,1), (2,1), the last three over r; beyond = t - r."""
    zeta = z + 1j * t
    R = np.sqrt(z * z - beyond * (t + r) + 2j * z * t)
    near = 1.0 / (R * (R + zeta))
    cube = 1.0 / R**3
    forms = (-np.log(R + zeta), 1.0 / R, zeta * cube, 1.0 / (R + zeta), near, cube)
    return np.stack([form.imag for form in forms])


def fields(total: Integrals, r: FloatArray, z: FloatArray, poissons_ratio: float) -> dict[str, FloatArray]:
    """2 G u, stresses and the hydrostatic pressure with its gradient, in units of E*/pi over length."""
    nu = poissons_ratio
    strain = -(1 - 2 * nu) * total.i01 + z * total.i11
    s1, s2 = -total.i10 + z * total.i20, -2 * nu * total.i10
    share = 2.0 / 3.0 * (1 + nu)
    return {
        "hoop_strain": strain,
        "axial": 2 * (1 - nu) * total.i00 + z * total.i10,
        "axial_stress": -total.i10 - z * total.i20,
        "shear_stress": -z * r * total.i21,
        "s1": s1,
        "s2": s2,
        "hydrostatic_pressure": share * total.i10,
        "pressure_gradient_radial": -share * r * total.i21,
        "pressure_gradient_axial": -share * total.i20,
        "gradient_terms": share * np.sqrt(total.squares),
    }
