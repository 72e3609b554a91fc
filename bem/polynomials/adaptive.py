"""Several smooth functions on an interval, sampled together on panels that are halved until all are resolved."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bem.polynomials import chebyshev
from contact.records.errors import NotConvergedError
from contact.records.validation import FloatArray

# Samples on each panel.
NODES = 16
# A panel is fine enough when the last coefficients of each function are below this, relative to its largest value.
_RESOLVED = 1e-12
# Functions that halving panels does not resolve to this are refused.
_USABLE = 1e-7
# Panels at most; beyond them `_USABLE` has to do.
_MOST_PANELS = 200
# Least panel over the interval: panels shrink towards a tip whose power is not smooth.
_SMALLEST = 2.0**-40


@dataclass(frozen=True)
class SampledPanel:
    """Samples at the Chebyshev nodes of one panel.

    Attributes:
        low: Left end.
        high: Right end.
        values: Shape (functions, nodes).
        tails: Size of each function's last Chebyshev coefficients, shape (functions,).
    """

    low: float
    high: float
    values: FloatArray
    tails: FloatArray

    @property
    def half(self) -> float:
        """Half width."""
        return 0.5 * (self.high - self.low)

    @property
    def nodes(self) -> FloatArray:
        """Where the samples are."""
        return np.asarray(0.5 * (self.low + self.high) + self.half * chebyshev.nodes(NODES))


def resolved_panels(
    sample: Callable[[FloatArray], FloatArray],
    low: float,
    high: float,
    error: float = 0.0,
    seams: ArrayLike = (),
) -> list[SampledPanel]:
    """Halve four panels until every function's last Chebyshev coefficients are small, or until halving helps no more.

    A panel with seams is cut at the one closest to its middle: no polynomial resolves a jump.

    Args:
        sample: From points, shape (n,), to values of all functions, shape (functions, n).
        low: Left end of the interval.
        high: Right end.
        error: Relative, of the functions themselves; they need not be resolved any finer.
        seams: Where the functions pass from one polynomial to another, which may jump by that error.

    Raises:
        NotConvergedError: If a function is too rough.
    """
    waiting = list(pairwise(np.linspace(low, high, 5)))
    done: list[SampledPanel] = []
    sizes: FloatArray | None = None
    while waiting and len(waiting) + len(done) < _MOST_PANELS:
        values = _values(sample, waiting)
        sizes = np.abs(values).max(axis=(0, 2)) if sizes is None else sizes
        tails = _tails(values)
        unresolved = (tails / np.where(sizes > 0.0, sizes, 1.0)).max(axis=1)
        panels = [SampledPanel(*ends, own, tail) for ends, own, tail in zip(waiting, values, tails, strict=True)]
        room = len(done) + 2 * len(waiting) < _MOST_PANELS
        halvable = min(right - left for left, right in waiting) > _SMALLEST * (high - low)
        fine = unresolved <= (_RESOLVED if room and halvable else max(_USABLE, error))
        done += [panel for panel, enough in zip(panels, fine, strict=True) if enough]
        rough = [panel for panel, enough in zip(panels, fine, strict=True) if not enough]
        waiting = [half for panel in rough for half in _halves(panel, np.asarray(seams, dtype=float))]
    if waiting:
        raise NotConvergedError(
            "the equivalent springs are too rough for a table", {"unresolved part": float(unresolved.max())}
        )
    return sorted(done, key=lambda panel: panel.low)


def _halves(panel: SampledPanel, seams: FloatArray) -> list[tuple[float, float]]:
    middle, nodes = 0.5 * (panel.low + panel.high), panel.nodes
    # Samples that all lie on one side of a seam do not see it.
    inside = seams[(seams > nodes.min()) & (seams < nodes.max())]
    if inside.size:
        middle = float(inside[np.abs(inside - middle).argmin()])
    return [(panel.low, middle), (middle, panel.high)]


def _values(sample: Callable[[FloatArray], FloatArray], waiting: list[tuple[float, float]]) -> FloatArray:
    """One call for all panels that wait, shape (panels, functions, nodes)."""
    low, high = np.array(waiting).T
    points = 0.5 * (low + high)[:, None] + 0.5 * (high - low)[:, None] * chebyshev.nodes(NODES)
    return np.swapaxes(sample(points.ravel()).reshape(-1, *points.shape), 0, 1)


def _tails(values: FloatArray) -> FloatArray:
    """Sum of the last three coefficients' sizes, as they meet at a panel's end; shape (panels, functions)."""
    return np.asarray(np.abs(values @ chebyshev.analysis(NODES)[-3:].T).sum(axis=2))


@dataclass(frozen=True)
class Piecewise:
    """Polynomials on consecutive panels.

    Attributes:
        edges: SampledPanel ends, shape (panels + 1,).
        centres: SampledPanel middles, shape (panels,).
        scales: Two over the panels' widths, shape (panels,).
        powers: Powers of each panel's z in [-1, 1], shape (count, functions, panels).
    """

    edges: FloatArray
    centres: FloatArray
    scales: FloatArray
    powers: FloatArray

    @classmethod
    def of(cls, panels: list[SampledPanel], coefficients: FloatArray) -> Piecewise:
        """From Chebyshev coefficients, shape (count, functions, panels)."""
        edges = np.array([panels[0].low, *(panel.high for panel in panels)])
        powers = np.tensordot(chebyshev.to_powers(coefficients.shape[0]), coefficients, 1)
        return cls(edges, 0.5 * (edges[1:] + edges[:-1]), 2.0 / np.diff(edges), powers)

    def __call__(self, y: FloatArray, rows: slice) -> FloatArray:
        """Some of the functions at y of any shape."""
        return self.within(rows)(y)

    def within(self, rows: slice, first: int = 0, last: int | None = None) -> Callable[[FloatArray], FloatArray]:
        """Some of the functions, by the panels from `first` to before `last` only; no y lies outside."""
        own = slice(first, self.centres.size if last is None else last)
        edges, centres, scales = self.edges[own][1:], self.centres[own], self.scales[own]
        powers = np.ascontiguousarray(self.powers[:, rows, own])

        def functions(y: FloatArray) -> FloatArray:
            """Values at y, shape (rows, n) for y of shape (n,)."""
            panel = edges.searchsorted(y, side="right")
            z = (y - centres.take(panel)) * scales.take(panel)
            ladder = chebyshev.powers(z, powers.shape[0])
            return np.asarray(np.einsum("kr...,k...->r...", powers.take(panel, axis=2), ladder))

        return functions

    def panel(self, y: FloatArray) -> NDArray[np.intp]:
        """The panel of each y, found by the edges between panels: none lies outside."""
        return np.asarray(self.edges[1:-1].searchsorted(y, side="right"))
