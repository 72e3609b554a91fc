"""Piecewise Chebyshev series of several functions, on panels that are halved until all functions are resolved."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.polynomial import chebyshev

from contact.records.errors import NotConvergedError
from contact.records.validation import FloatArray

# Coefficients per panel: with half as many there are four times the panels; of twice as many the last are rounding.
NODES: Final = 16
# Tolerance of each function over its largest value; a tenth of it is rounding.
RESOLVED: Final = 1e-12
# Tolerance on the last panels, when the limits below end the halving; rougher functions raise an error.
USABLE: Final = 1e-7
# Largest number of panels, and least width of a panel over the interval, which end the halving at tips like r^1.1.
MOST_PANELS: Final = 200
SMALLEST: Final = 2.0**-40

_PLACES = chebyshev.chebpts1(NODES)
_TO_SERIES = np.linalg.inv(chebyshev.chebvander(_PLACES, NODES - 1))


@dataclass(frozen=True, eq=False)
class Piecewise:
    """Several functions of y on consecutive panels.

    Attributes:
        edges: Ends of the panels, shape (panels + 1,).
        series: Chebyshev coefficients, shape (NODES, functions, panels).
    """

    edges: FloatArray
    series: FloatArray

    @classmethod
    def resolved(
        cls, sample: Callable[[FloatArray], FloatArray], low: float, high: float, error: float = 0.0, parts: int = 4
    ) -> Piecewise:
        """Series of sampled functions, on panels that are halved until the last coefficients are small.

        Args:
            sample: Values of all functions, shape (functions, n), at y of shape (n,).
            low: Left end of the interval.
            high: Right end of the interval.
            error: Relative error of the samples, the tolerance on the last panels if it exceeds `USABLE`.
            parts: Number of panels at the start.

        Raises:
            NotConvergedError: If a function is too rough.
        """
        waiting, size = np.array(list(pairwise(np.linspace(low, high, parts + 1)))), None
        done: list[tuple[float, float, FloatArray]] = []
        while waiting.size:
            middle, half = waiting.mean(axis=1), np.diff(waiting)[:, 0] / 2
            values = sample((middle[:, None] + half[:, None] * _PLACES).ravel()).reshape(-1, middle.size, NODES)
            size = np.abs(values).max(axis=(1, 2)) if size is None else size
            series = values @ _TO_SERIES.T
            rest = (np.abs(series[..., -3:]).sum(axis=2) / np.where(size > 0.0, size, 1.0)[:, None]).max(axis=0)
            is_last = len(done) + 2 * middle.size >= MOST_PANELS or 2 * half.min() <= SMALLEST * (high - low)
            fine = rest <= (max(USABLE, error) if is_last else RESOLVED)
            if is_last and not fine.all():
                raise NotConvergedError(
                    "the functions are too rough for panels", {"unresolved part": float(rest.max())}
                )
            done += [(*waiting[i].tolist(), series[:, i]) for i in np.flatnonzero(fine)]
            rough = ~fine
            waiting = np.concatenate(
                [np.stack([waiting[rough, 0], middle[rough]], 1), np.stack([middle[rough], waiting[rough, 1]], 1)]
            )
        done.sort(key=lambda panel: panel[0])
        return cls(
            np.array([low, *(piece[1] for piece in done)]),
            np.stack([piece[2] for piece in done], axis=2).swapaxes(0, 1),
        )

    def followed_by(self, other: Piecewise) -> Piecewise:
        """These panels and those of the interval that begins at their end."""
        return Piecewise(np.append(self.edges, other.edges[1:]), np.append(self.series, other.series, axis=2))

    def __call__(self, y: FloatArray) -> FloatArray:
        """Values at y of shape (n,), shape (functions, n); an edge belongs to the panel before it."""
        panel = self.edges[1:-1].searchsorted(y)
        low, high = self.edges[panel], self.edges[panel + 1]
        z = np.minimum(np.maximum((y - 0.5 * (low + high)) * (2.0 / (high - low)), -1.0), 1.0)
        # Sums of T_k(z) = cos(k arccos z) cost a tenth of Clenshaw's recurrence at a few points.
        terms = np.cos(np.multiply.outer(np.arange(self.series.shape[0]), np.arccos(z)))
        return np.asarray(np.einsum("kfn,kn->fn", self.series[..., panel], terms))

    @cached_property
    def slope(self) -> Piecewise:
        """Derivatives of the functions by y."""
        return Piecewise(self.edges, chebyshev.chebder(self.series, axis=0) * (2.0 / np.diff(self.edges)))
