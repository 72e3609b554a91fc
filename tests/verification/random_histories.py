"""Random histories of depth or force on relaxing incompressible layers, and their solution by reduction to springs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contact import DepthHistory, ForceHistory, HistoryPath
from mdr import Mdr

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Coverage:
    """True and stated errors of the response of one history, over the largest response, shape (n,)."""

    error: FloatArray
    stated: FloatArray

    @property
    def ratio(self) -> FloatArray:
        """True over stated error; zero where the true one is within rounding."""
        return np.where(self.error > 1e-12, self.error / np.maximum(self.stated, 1e-300), 0.0)

    @property
    def worst(self) -> float:
        """Largest true over stated error."""
        return float(self.ratio.max())


def coverage(answer: HistoryPath, *, most: int | None = None) -> Coverage:
    """Compare the response with springs at the answer's instants, or at ``most`` of them and all given ones."""
    loading = answer.scene.loading
    assert isinstance(loading, DepthHistory | ForceHistory)
    chosen = np.arange(len(answer.time))
    if most is not None:
        spread = np.linspace(0, len(answer.time) - 1, most).astype(int)
        chosen = np.unique([*spread, *np.searchsorted(answer.time, loading.time)])
    time = answer.time[chosen]
    if isinstance(loading, DepthHistory):
        name, sampled = "normal_force", DepthHistory(time=time, depth=np.interp(time, loading.time, loading.depth))
    else:
        name, sampled = "indentation_depth", ForceHistory(time=time, force=np.interp(time, loading.time, loading.force))
    exact = Mdr().solve(answer.scene.replace(loading=sampled))
    error = np.maximum(np.abs(getattr(answer, name)[chosen] - getattr(exact, name)) - exact.uncertainty(name), 0.0)
    scale = np.abs(getattr(answer, name)).max()
    return Coverage(error / scale, answer.uncertainty(name)[chosen] / scale)
