"""Growing contact under full stick: the depth delta(a) at which the contact has grown to the radius a.

Points that come into contact stay where they touched. The contact is a sequence of adhered punches, each pressed in by
delta'(a) da, and follows the indenter if

    g_hs(x) = int_0^x M(x; a) delta'(a) da,        F(a) = int_0^a k_stick delta' da.

M is smooth but for ``((x+a)/(x-a))^(i eps)`` at a = x, which the tanh-sinh rule takes. On each stretch of the profile
delta' is a polynomial in a variable in which it is smooth, found by least squares over places, stretch after stretch.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.polynomial import chebyshev

from bem.layer_equation.stick.adhered_fields import tanh_sinh
from bem.layer_equation.stick.growth import GrowthTable
from contact import PowerLaw, Profile
from contact.records.validation import FloatArray
from mdr.springs.half_space_profile import half_space_profile

# Places at which the indenter is followed, over unknowns. With as many as unknowns, those of a film over a base a
# hundred times as soft answered roundings so much that 60 and 66 of them differed by 2e-9 to 6e-9, by the processor;
# least squares over a quarter more leave 4e-10 to 2e-9 (cone, a/h = 1.6, nu = 0, four kernels of BLAS, 2026-11-26).
_PLACES = 1.25


@dataclass(frozen=True)
class GrowthStretch:
    """delta on one stretch of the profile: ``a = start + length u^power``, ``d delta/du = u^(lead - 1) poly(u)``.

    Attributes:
        start: First radius.
        length: Of the stretch.
        power: 2 beyond an edge, where delta begins like a root; 1 elsewhere.
        lead: delta begins like u^lead.
    """

    start: float
    length: float
    power: int
    lead: float

    def radius(self, u: FloatArray) -> FloatArray:
        """a at u."""
        return self.start + self.length * u**self.power

    def place(self, a: FloatArray) -> FloatArray:
        """u at a."""
        return np.asarray(np.clip((a - self.start) / self.length, 0.0, 1.0) ** (1.0 / self.power))

    @property
    def end(self) -> float:
        """Last radius."""
        return self.start + self.length

    def increments(
        self, low: float, high: float, v: FloatArray, weights: FloatArray, unknowns: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Radii, their distance from `low`, and depths of the part between `low` and `high`."""
        first, last = self.place(np.array([low, high]))
        u = first + (last - first) * v
        grown = self.length * (last - first) * v * (1.0 if self.power == 1 else u + first)
        depth = (last - first) * weights * (self.slopes(u, unknowns.size) @ unknowns)
        return self.radius(u), max(0.0, self.start - low) + grown, depth

    def slopes(self, u: FloatArray, count: int) -> FloatArray:
        """d delta/du of each unknown at u, shape (*u.shape, count)."""
        return np.asarray(u[..., None] ** (self.lead - 1.0) * chebyshev.chebvander(2.0 * u - 1.0, count - 1))


@dataclass(frozen=True)
class Increments:
    """Quadrature over adhered punches.

    Attributes:
        radius: a, shape (n,).
        gap: a - low with all its digits, shape (n,).
        depth: delta'(a) da times the weight, shape (n,).
    """

    radius: FloatArray
    gap: FloatArray
    depth: FloatArray


@dataclass(frozen=True)
class Growth:
    """Depth and force as the contact grows; lengths in the layer's thickness.

    Attributes:
        table: Adhered punches.
        stretches: Of the profile, in order.
        unknowns: Coefficients of each stretch, shape (stretches, count).
    """

    table: GrowthTable
    stretches: tuple[GrowthStretch, ...]
    unknowns: FloatArray

    def increments(self, low: float, high: float) -> Increments:
        """The punches added while the contact grows from one radius to another, 0 <= low <= high."""
        v, _, weights = tanh_sinh()
        parts = [
            stretch.increments(low, high, v, weights, unknowns)
            for stretch, unknowns in zip(self.stretches, self.unknowns, strict=True)
            if stretch.start < high and low < stretch.end
        ]
        if not parts or low >= high:
            return Increments(np.array([high]), np.zeros(1), np.zeros(1))
        radius, gap, depth = (np.concatenate(column) for column in zip(*parts, strict=True))
        return Increments(radius, gap, depth)

    def depth_and_force(self, radius: FloatArray) -> tuple[FloatArray, FloatArray]:
        """delta/h and F/(E* h^2) at a/h, each of shape (n,)."""
        grown = [self.increments(0.0, float(a)) for a in radius]
        depth = [g.depth.sum() for g in grown]
        force = [g.depth @ self.table.contact_stiffness(g.radius) for g in grown]
        return np.array(depth), np.array(force)


def growth(indenter: Profile, thickness: float, reach: float, table: GrowthTable, count: int) -> Growth:
    """Solve for delta(a) up to a = reach.

    Args:
        indenter: Profile of revolution, no flat punch.
        thickness: h [m].
        reach: Largest a/h.
        table: Adhered punches that reach as far.
        count: Unknowns of a stretch.
    """
    stretches = _stretches(indenter, thickness, reach)
    u = (1.0 + chebyshev.chebpts1(math.ceil(_PLACES * count))) / 2.0
    unknowns = np.empty((len(stretches), count))
    for p, stretch in enumerate(stretches):
        x = stretch.radius(u)
        excess = stretch.length * u**stretch.power + (stretch.start - indenter.flat_radius / thickness)
        right = half_space_profile(indenter, thickness * excess) / thickness
        for earlier, known in zip(stretches[:p], unknowns, strict=False):
            right = right - _followed(earlier, x, np.ones_like(x), table, count) @ known
        matrix = _followed(stretch, x, u, table, count)
        # Both sides begin like u^lead.
        row = u**-stretch.lead
        unknowns[p] = np.linalg.lstsq(row[:, None] * matrix, row * right, rcond=None)[0]
    return Growth(table, stretches, unknowns)


def _stretches(indenter: Profile, thickness: float, reach: float) -> tuple[GrowthStretch, ...]:
    flat = indenter.flat_radius / thickness
    inner = [k / thickness for k in indenter.breakpoints if flat < k / thickness < reach]
    ends = [flat, *inner, reach]
    lead = float(indenter.exponent) if isinstance(indenter, PowerLaw) else 1.0
    first = GrowthStretch(ends[0], ends[1] - ends[0], 2 if flat else 1, 1.0 if flat else lead)
    rest = (GrowthStretch(start, end - start, 2, 1.0) for start, end in pairwise(ends[1:]))
    return (first, *rest)


def _followed(stretch: GrowthStretch, x: FloatArray, end: FloatArray, table: GrowthTable, count: int) -> FloatArray:
    """int M(x; a) d delta/du du of each unknown over u < end, shape (x, count)."""
    v, rest, weights = tanh_sinh()
    rows = np.empty((x.size, count))
    for i, (place, to) in enumerate(zip(x, end, strict=True)):
        u = to * v
        a = stretch.radius(u)
        # x - a as a product, whose digits the end of the rule asks for; x may lie beyond the stretch.
        beyond = max(0.0, place - stretch.start - stretch.length)
        gap = beyond + stretch.length * to**stretch.power * rest * (1.0 if stretch.power == 1 else 1.0 + v)
        turned = np.exp(1j * table.material.charge * np.log((place + a) / gap))
        rows[i] = (to * weights * (turned * table.beside(float(place), a)).real) @ stretch.slopes(u, count)
    return rows
