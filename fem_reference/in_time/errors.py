"""Error bars of histories: what half the cells change, what half the steps change, and what neither shows.

The trajectory is simulated three times.  Contact sets are found to a cell, so differences scatter, and one number may
change little by accident: the changes by space of restitution, peaks and range therefore stand in for each other, and
what a channel changes beside its peak stands in for the change of the peak.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from contact import HistoryPath, ImpactHistory

H = TypeVar("H", bound=HistoryPath | ImpactHistory)

DERIVED = ("coefficient_of_restitution", "contact_time")
PEAKS = {"peak_force": "normal_force", "peak_depth": "indentation_depth", "peak_contact_radius": "contact_radius"}
BESIDE = 0.9  # of the peak: the samples there see the edge pass several cells
FINER = 1 / 3  # error of second order over the largest change by half the cells: a third to a fifth of it
TYPICAL = 0.8  # of the mean change by space: the least that is believed of one number


@dataclass(frozen=True, kw_only=True)
class KnownErrors:
    """Relative errors that halving shows not, or that are not there.

    Attributes:
        everywhere: of every quantity, from the outer edge and the thickness that stands for a half-space.
        radius: of contact radii, which are read from pressures on cells.
        exact: quantities that are input.
        space: error of the contact set over what half the cells change: less than one for smooth profiles, whose errors
            fall like the cells' square; next to a kink they fall like the cells, not evenly.
    """

    everywhere: float
    radius: float
    exact: frozenset[str]
    space: float


def with_errors(fine: H, wider: H, coarse: H, known: KnownErrors) -> H:
    """The finest history with its error estimates.

    Args:
        fine: history as asked.
        wider: on half the cells.
        coarse: on half the cells with half the steps.
        known: what these do not show.
    """
    channels = [name for name in fine.ARRAYS if name != "time"]
    scalars = [*fine.SCALARS, *(name for name in DERIVED if hasattr(fine, name))]
    space = {name: known.space * _channel_change(fine, wider, name) for name in channels}
    space |= {name: known.space * _scalar_change(fine, wider, name) for name in scalars}
    space |= {name: max(space[name], FINER * _change_beside_peak(fine, wider, PEAKS[name])) for name in fine.SCALARS}
    time = {name: _channel_change(wider, coarse, name) for name in channels}
    time |= {name: _scalar_change(wider, coarse, name) for name in scalars}
    judged = [name for name in ("indentation_depth", "normal_force", *scalars) if "radius" not in name]
    typical = TYPICAL * float(np.mean([space[name] for name in judged if name not in known.exact]))
    error = {}
    for name in (*channels, *scalars):
        size = (
            max(space[name], typical * _share(fine, name))
            + time[name]
            + known.everywhere
            + known.radius * ("radius" in name)
        )
        error[name] = np.full(len(fine) if name in channels else 1, 0.0 if name in known.exact else size)
    if isinstance(fine, ImpactHistory) and "contact_radius" not in known.exact:
        error["contact_radius"] += _steep_end(fine, error["contact_time"][0])
    return replace(fine, error_estimate=error)


def _change_beside_peak(fine: H, wider: H, name: str) -> float:
    """Largest change of a channel while it is near its peak, relative to the peak.

    The force errs now more, now less as the edge passes a cell, so two grids may agree at the peak itself by accident.
    """
    values, others = getattr(fine, name), getattr(wider, name)
    change = np.abs(np.interp(wider.time, fine.time, values) - others)
    return float(change[others >= BESIDE * others.max()].max() / max(values.max(), np.finfo(float).tiny))


def _share(history: HistoryPath | ImpactHistory, name: str) -> float:
    """The restitution errs with the energy W lost: d(eps)/eps = -(1/eps^2 - 1)/2 dW/W, nothing on an elastic layer."""
    if name != "coefficient_of_restitution" or not isinstance(history, ImpactHistory):
        return 1.0
    return float(np.clip((history.coefficient_of_restitution**-2 - 1) / 2, 0.0, 1.0))


def _steep_end(history: ImpactHistory, time_error: float) -> float:
    """What an error of the contact time means for the radius, which vanishes like the root of the time that is left."""
    drop = history.contact_radius[-2] - history.contact_radius[-1]
    shift = time_error * history.contact_time / (history.time[-1] - history.time[-2])
    return float(drop * np.sqrt(min(1.0, shift)) / history.contact_radius.max())


def _scalar_change(fine: H, coarse: H, name: str) -> float:
    return float(abs(getattr(coarse, name) / getattr(fine, name) - 1))


def _channel_change(fine: H, coarse: H, name: str) -> float:
    """Largest change at the instants of the coarser history, relative to the largest value."""
    values, others = getattr(fine, name), getattr(coarse, name)
    change = np.interp(coarse.time, fine.time, values) - others
    return float(np.abs(change).max() / max(np.abs(values).max(), np.finfo(float).tiny))
