"""Smooth functions with known algebraic singularities, by Chebyshev polynomials in a mapped variable.

On a piece [l, l + w] the variable is ``u = ((d - l)/w)^(1/power)``: power 2 makes a square-root behaviour at the left
end smooth. In the first piece a factor ``u^lead`` is split off, so that a function that vanishes at the start keeps its
relative accuracy there.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache, cached_property

import numpy as np
from numpy.typing import NDArray

from bem.polynomials.chebyshev import BLOCK, differentiation, piecewise_sum
from bem.polynomials.gauss_panels import chebyshev_from_nodes, gauss_nodes, partial_panel_interpolation
from bem.polynomials.truncation import between_nodes, orders_beyond
from contact.records.validation import FloatArray

# Pieces are split until a function's last Chebyshev coefficients are below this share of the largest; chosen.
RESOLVED = 1e-13
# Times that pieces may be split, more than halving a piece down to rounding takes.
MAX_SPLITS = 60
EPS, TINY = float(np.finfo(float).eps), float(np.finfo(float).tiny)
# Where a piece is cut, as shares of its width: beside a mapped singularity, and elsewhere. Chosen.
_DOUBLING, _HALVING = (0.0, 0.125, 0.25, 0.5, 1.0), (0.0, 0.5, 1.0)
# Two points closer than this, relative to their distance from the start, are one: rounding set them apart.
GAP = 1e-12
# Roundings of the largest coefficient that a sum of polynomials adds up to.
ROUNDINGS = 4.0


@dataclass(frozen=True)
class MappedGrid:
    """Pieces of the line d >= 0.

    Attributes:
        left: l, shape (q,), the first is zero.
        width: w, shape (q,).
        power: Shape (q,).
        count: Nodes on each piece, m.
    """

    left: FloatArray
    width: FloatArray
    power: FloatArray
    count: int

    @classmethod
    def between(cls, ends: FloatArray, count: int) -> MappedGrid:
        """Unmapped pieces between neighbouring ends, of which the first is zero."""
        return cls(ends[:-1], np.diff(ends), np.ones(len(ends) - 1), count)

    @classmethod
    def equal(cls, end: float, pieces: int, count: int) -> MappedGrid:
        """Unmapped pieces of equal width on [0, end]."""
        return cls.between(np.linspace(0.0, end, pieces + 1), count)

    @property
    def ends(self) -> FloatArray:
        """Left ends of all pieces and the right end of the last, shape (q + 1,)."""
        return np.append(self.left, self.end)

    @cached_property
    def nodes(self) -> FloatArray:
        """Node positions d, shape (q, m)."""
        return self.left[:, None] + self.width[:, None] * gauss_nodes(self.count)[0] ** self.power[:, None]

    @property
    def to_end(self) -> FloatArray:
        """What is left from the nodes to the end, with all its digits, shape (q, m)."""
        right = self.left + self.width
        return (self.end - right)[:, None] + self.width[:, None] * (
            1 - gauss_nodes(self.count)[0] ** self.power[:, None]
        )

    @property
    def weights(self) -> FloatArray:
        """Weights of integrals over d, shape (q, m)."""
        u, omega = gauss_nodes(self.count)
        return self.width[:, None] * self.power[:, None] * u ** (self.power[:, None] - 1) * omega

    @property
    def end(self) -> float:
        """Right end of the last piece; zero without pieces."""
        return float(self.left[-1] + self.width[-1]) if self.left.size else 0.0

    def locate(self, d: FloatArray) -> tuple[NDArray[np.intp], FloatArray]:
        """Number of the piece of each point, and u in it; a point between two pieces belongs to the left one."""
        piece = np.maximum(self.left.searchsorted(d) - 1, 0)
        s = np.minimum(np.maximum((d - self.left[piece]) / self.width[piece], 0.0), 1.0)
        return piece, s if self._plain else s ** (1 / self.power[piece])

    @cached_property
    def _plain(self) -> bool:
        return bool(np.all(self.power == 1.0))

    def split(self, pieces: NDArray[np.bool_]) -> MappedGrid:
        """A copy with some pieces cut: in the middle, or, where a singularity is mapped, doubling away from it.

        Values fall towards it by powers, and errors at the far end of a piece would count against them.
        """
        shares = [np.array(_DOUBLING if own > 1 else _HALVING) for own in self.power]
        shares = [share if cut else share[[0, -1]] for share, cut in zip(shares, pieces, strict=True)]
        of_pieces = list(zip(shares, self.left, self.width, self.power, strict=True))
        left = np.concatenate([start + width * share[:-1] for share, start, width, _ in of_pieces])
        power = np.concatenate([np.append(own, np.ones(share.size - 2)) for share, *_, own in of_pieces])
        return MappedGrid(left, np.diff(left, append=self.end), power, self.count)


@dataclass(frozen=True)
class MappedFunction:
    """A function on a `MappedGrid`.

    Attributes:
        grid: The pieces.
        node_values: At the grid's nodes, shape (q, m).
        lead: Exponent of u split off in the first piece.
    """

    grid: MappedGrid
    node_values: FloatArray
    lead: float
    _last: dict[str, tuple[tuple[tuple[int, ...], bytes], FloatArray]] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )

    def __call__(self, d: FloatArray) -> FloatArray:
        """Values at points of any shape."""
        return self._again("values", d, lambda: self.at(*self.grid.locate(d)))

    def _again(self, name: str, d: FloatArray, compute: Callable[[], FloatArray]) -> FloatArray:
        """Values at no more than a block of points, remembered until others are asked for: errors need them again."""
        if d.size > BLOCK:
            return compute()
        asked, last = (d.shape, d.tobytes()), self._last.get(name)
        if last is None or last[0] != asked:
            found = compute()
            found.setflags(write=False)
            last = self._last[name] = asked, found
        return last[1]

    def derivative(self, d: FloatArray) -> FloatArray:
        """First derivative with respect to d."""
        return self.derivative_at(*self.grid.locate(d))

    def at(self, piece: NDArray[np.intp], u: FloatArray) -> FloatArray:
        """Values at mapped positions."""
        return piecewise_sum(self.coefficients, piece, 2 * u - 1) * self._factor(piece, u)

    def up_to(self, end: float, function: Callable[[FloatArray, FloatArray], FloatArray]) -> MappedFunction:
        """The same function on [0, end], end > 0: whole pieces as they are, and the last one anew where it is cut.

        Its function tells values at positions, which are also given as what is left from them to the end.
        """
        grid = self.grid
        pieces = max(int(grid.left.searchsorted(end * (1 - GAP))), 1)
        if pieces == grid.left.size and end == grid.end:
            return self
        width = np.append(grid.width[: pieces - 1], end - grid.left[pieces - 1])
        kept = MappedGrid(grid.left[:pieces], width, grid.power[:pieces], grid.count)
        last = function(kept.nodes[-1], kept.to_end[-1])
        return MappedFunction(kept, np.vstack([self.node_values[: pieces - 1], last]), self.lead)

    def slope_at(self, piece: NDArray[np.intp], u: FloatArray) -> FloatArray:
        """Derivative with respect to u at mapped positions."""
        return self.with_slope_at(piece, u)[1]

    def with_slope_at(self, piece: NDArray[np.intp], u: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Values and derivatives with respect to u at mapped positions."""
        regular = piecewise_sum(self.coefficients, piece, 2 * u - 1)
        slope = piecewise_sum(self._slope_coefficients, piece, 2 * u - 1)
        factor = self._factor(piece, u)
        full = factor * slope
        if np.any(first := piece == 0):
            full = full + np.where(first, self.lead * u ** max(self.lead - 1.0, 0.0), 0.0) * regular
        return regular * factor, np.asarray(full)

    def derivative_at(self, piece: NDArray[np.intp], u: FloatArray) -> FloatArray:
        """Derivative with respect to d at mapped positions, infinite where it is."""
        power, width = self.grid.power[piece], self.grid.width[piece]
        # At a square root's start 1/0 is the infinite slope that is meant.
        with np.errstate(divide="ignore"):
            stretch = u ** (1 - power)
        derivative: FloatArray = self.slope_at(piece, u) * stretch / (power * width)
        return derivative

    @cached_property
    def node_slopes(self) -> FloatArray:
        """Derivative with respect to u at the nodes, shape (q, m)."""
        u = gauss_nodes(self.grid.count)[0]
        slopes = self._regular @ _slopes_from_nodes(self.grid.count).T
        slopes[0] = u**self.lead * slopes[0] + self.lead * u ** max(self.lead - 1.0, 0.0) * self._regular[0]
        return np.asarray(slopes)

    def integral(self) -> MappedFunction:
        """int_0^d of the function: whole pieces before each node, and its own piece by Gauss nodes scaled into it."""
        grid = self.grid
        u, omega = gauss_nodes(grid.count)
        full = np.concatenate([[0.0], np.cumsum(np.sum(self.node_values * grid.weights, axis=1))[:-1]])
        lead = np.where(np.arange(len(grid.left)) == 0, self.lead, 0.0)[:, None, None]
        inner = np.multiply.outer(u, u)
        regular = (self.node_values / u ** lead[:, 0])[:, None, :, None]
        inside = (partial_panel_interpolation(grid.count) @ regular)[..., 0]
        exponent = lead + grid.power[:, None, None] - 1
        stretch = (grid.width * grid.power)[:, None]
        partial = stretch * np.sum(inside * inner**exponent * np.multiply.outer(u, omega), axis=2)
        return MappedFunction(grid, full[:, None] + partial, self.lead + float(grid.power[0]))

    def within_nodes(self, pieces: NDArray[np.intp] | None = None) -> FloatArray:
        """Values at u = tau_i tau_j on all or some pieces, shape (q, m, m), by their polynomials."""
        u, own = gauss_nodes(self.grid.count)[0], np.arange(len(self.grid.left)) if pieces is None else pieces
        inside = (partial_panel_interpolation(self.grid.count) @ self._regular[own, None, :, None])[..., 0]
        inside[own == 0] *= np.multiply.outer(u, u) ** self.lead
        return np.asarray(inside)

    def left_out(self, d: FloatArray) -> FloatArray:
        """Size of what the polynomials leave out at points d, as the decay of all their coefficients tells."""
        return self._again("left out", d, lambda: self._on_both_sides(self._left_out, d))

    def _left_out(self, d: FloatArray) -> FloatArray:
        piece, u = self.grid.locate(d)
        beyond = self._all_beyond[piece] * between_nodes(self.grid.count, 2 * u - 1)
        return np.asarray(beyond * self._factor(piece, u))

    def truncation(self) -> FloatArray:
        """Size of the last coefficients of each piece relative to its largest, shape (q,)."""
        size = np.abs(self.coefficients)
        tail: FloatArray = size[:, -2:].max(axis=1) / np.maximum(size.max(axis=1), TINY)
        return tail

    def relative_error(self, d: FloatArray) -> FloatArray:
        """What the orders left out and rounding make of the values at points d, relative to them.

        Values at the nodes are taken as right: what a load's polynomials leave out is orthogonal to the kernel's.
        """
        return self._on_both_sides(self._relative_error, d)

    def _on_both_sides(self, error: Callable[[FloatArray], FloatArray], d: FloatArray) -> FloatArray:
        """An error at points d; where two pieces meet that of both, since rounding decides which of them answers."""
        found, left = error(d), self.grid.left
        low, high = d * (1.0 - GAP), d * (1.0 + GAP)
        between = left.searchsorted(low) != left.searchsorted(high)
        if not np.any(between):
            return found
        return np.where(between, np.maximum(error(low), error(high)), found)

    def _relative_error(self, d: FloatArray) -> FloatArray:
        piece, u = self.grid.locate(d)
        values = np.abs(self.at(piece, u))
        own = self._beyond[piece] * between_nodes(self.grid.count, 2 * u - 1) + self._rounding[piece]
        relative: FloatArray = np.divide(
            own * self._factor(piece, u), values, out=np.zeros_like(values), where=values > 0
        )
        return relative

    @cached_property
    def _all_beyond(self) -> FloatArray:
        """Coefficients left out, as all those that are known tell."""
        return orders_beyond(self.coefficients)

    @cached_property
    def _beyond(self) -> FloatArray:
        """Coefficients left out; the rate is that of the upper half, since kinks beside a piece slow it down late.

        Of at least six: the decay over four is less than two orders' and told no rate at all on eight nodes.
        """
        half = max(0, min(self.grid.count // 2, self.grid.count - 6))
        return orders_beyond(self.coefficients[:, half:])

    @cached_property
    def _rounding(self) -> FloatArray:
        return np.asarray(ROUNDINGS * EPS * np.abs(self.coefficients).max(axis=1))

    def _factor(self, piece: NDArray[np.intp], u: FloatArray) -> FloatArray:
        first = piece == 0
        return np.where(first, u**self.lead, 1.0) if np.any(first) else np.ones(())

    @cached_property
    def coefficients(self) -> FloatArray:
        """Chebyshev coefficients in u, shape (q, m), in the first piece after division by u^lead."""
        return np.asarray(self._regular @ chebyshev_from_nodes(self.grid.count).T)

    @cached_property
    def _regular(self) -> FloatArray:
        """Values at the nodes, in the first piece after division by u^lead."""
        regular = self.node_values.copy()
        regular[0] /= gauss_nodes(self.grid.count)[0] ** self.lead
        return regular

    @cached_property
    def _slope_coefficients(self) -> FloatArray:
        return np.asarray(self.coefficients @ (2 * differentiation(self.grid.count)).T)


@cache
def _slopes_from_nodes(count: int) -> FloatArray:
    """Matrix from values at the Gauss nodes of [0, 1] to derivatives there."""
    at_nodes = np.polynomial.chebyshev.chebvander(2 * gauss_nodes(count)[0] - 1, count - 1)
    return np.asarray(at_nodes @ (2 * differentiation(count)) @ chebyshev_from_nodes(count))


def apart(points: FloatArray, others: FloatArray) -> FloatArray:
    """Points that do not coincide with others."""
    if not others.size:
        return points
    distance = np.min(np.abs(points[:, None] - others), axis=1, initial=np.inf)
    distinct: FloatArray = points[distance > GAP * np.abs(points)]
    return distinct


def resolve(
    function: Callable[[FloatArray, FloatArray], FloatArray],
    grid: MappedGrid,
    lead: float,
    *,
    tolerance: Callable[[], float],
    scale: float,
    far: float,
) -> MappedFunction:
    """Split pieces until the function's last coefficients fall below `RESOLVED` or the tolerance, whichever is more.

    Towards a mapped singularity pieces may become as small as they need; elsewhere a piece below a thousandth of its
    distance from the start shows noise, not structure, and the tail that is left goes into the error estimate.
    Towards a pole at `far` (a sphere's equator) pieces shrink with the distance to it. The function is asked at nodes,
    and told what is left from them to the grid's end too: beside a pole positions have fewer digits.
    A mapped piece spends its polynomial degree in steps of its power: it is kept short against the given length scale,
    on which other functions of the same grid vary.
    """
    for _ in range(MAX_SPLITS):
        resolved = MappedFunction(grid, function(grid.nodes, grid.to_end), lead)
        right = grid.left + grid.width
        beside_pole = np.where(right < far, 0.1 * (far - right), np.inf) if right[-1] > far else 0.1 * (far - right)
        smallest = np.minimum(np.where(grid.power > 1, 1e-13, 1e-3) * right, beside_pole)
        coarse = (resolved.truncation() > RESOLVED) & (grid.width > smallest)
        if coarse.any():
            coarse &= resolved.truncation() > tolerance()
        coarse |= (grid.power > 1) & (grid.width > scale * 4.0 ** (1 - grid.power))
        if not coarse.any():
            break
        grid = grid.split(coarse)
    return resolved
