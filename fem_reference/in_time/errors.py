"""Error bars of impacts and of prescribed histories: changes by half the cells, by half the steps, and what both miss.

Every motion is simulated three times.  Prescribed histories state the changes near every instant.  Contact sets are
resolved to one cell, so two meshes may agree in one number by accident.  Hence no error of an impact by the cells is
stated below a share of the mean change of all numbers, and no peak's below a share of the largest change near it; a
flat punch has no contact set and needs neither.  The steps in which contact begins and ends do not keep the energy,
now more, now less: what is missing of it at the end is told beside the restitution.  The coefficients stand in
`error_model.IN_TIME`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from contact import HistoryPath, ImpactHistory
from contact.records.validation import FloatArray
from contact.scene.extent import radius_of_depth
from fem_reference.discrete_layer.indenter import height
from fem_reference.error_model import IN_TIME
from fem_reference.in_time.relaxation import relaxation_of

# Numbers of an impact that follow from its channels.
DERIVED = ("coefficient_of_restitution", "contact_time")
# The channel whose largest change tells how far such a number may be off where two meshes agree in it by accident.
CHANNELS = {
    "peak_depth": "indentation_depth",
    "contact_time": "indentation_depth",
    "coefficient_of_restitution": "velocity",
}
# What the edge alone tells: cells know it to a share of one, and the end of a slow rebound hardly at all. It says
# nothing of depth and force.
_OF_THE_EDGE = ("contact_time", "peak_contact_radius")
# The channel of each peak.
PEAKS = {"peak_force": "normal_force", "peak_depth": "indentation_depth", "peak_contact_radius": "contact_radius"}


@dataclass(frozen=True, kw_only=True)
class KnownErrors:
    """Relative errors that halving cells and steps does not show.

    Attributes:
        everywhere: of every quantity, from the outer edge and the thickness that stands for a half-space.
        radius: of contact radii, which are read from pressures on cells.
        exact: quantities that are input.
        cell: cell of the strip [m]; contact ends when it is half as wide.
        space: error of the contact set over what half the cells change: less than one for smooth profiles, whose errors
            fall like the cells' square; next to a kink they fall like the cells, not evenly.
        heights: the smooth profile's height at a cell over that at half a cell, 2^n for a power n; zero where it has
            kinks or breakpoints, or the layer dissipates: the end of contact is then known less well.
    """

    everywhere: float
    radius: float
    exact: frozenset[str]
    cell: float
    space: float
    heights: float = 0.0


def with_errors(
    fine: ImpactHistory, half_cells: ImpactHistory, half_both: ImpactHistory, known: KnownErrors
) -> ImpactHistory:
    """The finest simulation of an impact with its error estimates.

    Args:
        fine: history as asked.
        half_cells: on half the cells.
        half_both: on half the cells with half the steps.
        known: what these do not show.
    """
    channels = [name for name in fine.ARRAYS if name != "time"]
    scalars = [*fine.SCALARS, *DERIVED]
    space = {name: known.space * _channel_change(fine, half_cells, name) for name in channels}
    space |= {name: known.space * _scalar_change(fine, half_cells, name) for name in scalars}
    space |= {
        name: max(space[name], _share_beside_peak(name) * _change_beside_peak(fine, half_cells, PEAKS[name]))
        for name in fine.SCALARS
    }
    if "contact_radius" not in known.exact:
        last = _time_after_last_cell(fine, known.cell)
        space["contact_time"] = max(IN_TIME.first_order * space["contact_time"], last)
        space["coefficient_of_restitution"] *= IN_TIME.uneven_end
    time = {name: _channel_change(half_cells, half_both, name) for name in channels}
    time |= {name: _scalar_change(half_cells, half_both, name) for name in scalars}
    judged = [name for name in ("indentation_depth", "normal_force", *scalars) if name not in _OF_THE_EDGE]
    typical = IN_TIME.share_of_mean * float(np.mean([space[name] for name in judged if name not in known.exact]))
    time["contact_time"] += _time_in_rounding(fine)
    lost = _energy_lost(fine)
    error = {}
    for name in (*channels, *scalars):
        floor = IN_TIME.share_of_mean * space[CHANNELS[name]] if name in CHANNELS else typical
        floor *= 0.0 if "contact_radius" in known.exact else _share(fine, name)
        floor += lost if name == "coefficient_of_restitution" else 0.0
        reading = known.radius * ("radius" in name)
        size = max(space[name], floor, 0.0 if name in channels else reading) + time[name]
        # A channel is read at every instant, a peak only where readings of both meshes were compared around it.
        size += reading if name in channels else 0.0
        size += known.everywhere * _share(fine, name)
        error[name] = np.full(len(fine) if name in channels else 1, 0.0 if name in known.exact else size)
    if "contact_radius" not in known.exact:
        error["contact_radius"][-1] += _steep_end(fine, error["contact_time"][0])
    if known.heights > 0.0:
        times = [getattr(each, DERIVED[1]) for each in (fine, half_cells, half_both)]
        error["contact_time"] = np.array([_smooth_end(times, known.heights) + known.everywhere])
    return replace(fine, error_estimate=error)


def path_with_errors(
    fine: HistoryPath, half_cells: HistoryPath, half_both: HistoryPath, known: KnownErrors
) -> HistoryPath:
    """The finest simulation of a prescribed history with error estimates for every instant, shape (n,).

    Error = safety x (|fine - half the cells| + |half the cells - half of both|), each the largest change at the
    instants near by, plus a share of their means.  The instants of half the steps are every other one.
    """
    error = {}
    for name in (name for name in fine.ARRAYS if name != "time"):
        values, halves, both = (getattr(each, name) for each in (fine, half_cells, half_both))
        cells = known.space * np.abs(values - halves)
        steps = np.abs(np.interp(half_both.time, half_cells.time, halves) - both)
        size = _largest_near(cells, fine.time, fine, known.cell) + _largest_near(
            steps, half_both.time, fine, known.cell
        )
        size += IN_TIME.share_of_path_mean * float(cells.mean() + steps.mean())
        size = IN_TIME.path_safety * size / max(np.abs(values).max(), np.finfo(float).tiny) + known.everywhere
        if "radius" in name:
            # Pressures of a layer that relaxes do not end like sqrt(a - r): radii are known to a cell.
            size += known.radius + (known.cell / values.max() if fine.scene.effects else 0.0)
        error[name] = np.zeros(len(fine)) if name in known.exact else size
    return replace(fine, error_estimate=error)


def _largest_near(change: FloatArray, time: FloatArray, fine: HistoryPath, cell: float) -> FloatArray:
    """Largest change at six of the instants ``time`` to either side, and while contact is narrower than some cells."""
    place = np.searchsorted(time, fine.time)
    near: FloatArray = np.max([change[np.clip(place + k, 0, len(change) - 1)] for k in range(-6, 6)], axis=0)
    narrow = fine.contact_radius < IN_TIME.narrow_path * cell
    at_narrow = change[np.isin(time, fine.time[narrow])]
    return np.asarray(np.where(narrow, np.maximum(near, at_narrow.max(initial=0.0)), near))


def _share_beside_peak(name: str) -> float:
    return IN_TIME.radius_beside_peak if "radius" in name else IN_TIME.share_beside_peak


def _change_beside_peak(fine: ImpactHistory, half_cells: ImpactHistory, name: str) -> float:
    """Largest change of a channel while it is near its peak, relative to the peak.

    The force errs now more, now less as the edge passes a cell, so two grids may agree at the peak itself by accident.
    """
    values, others = getattr(fine, name), getattr(half_cells, name)
    change = np.abs(np.interp(half_cells.time, fine.time, values) - others)
    return float(change[others >= IN_TIME.beside_peak * others.max()].max() / max(values.max(), np.finfo(float).tiny))


def _share(history: ImpactHistory, name: str) -> float:
    """The restitution errs with the energy W lost: d(eps)/eps = -(1/eps^2 - 1)/2 dW/W, nothing on an elastic layer."""
    if name != "coefficient_of_restitution":
        return 1.0
    return float(np.clip((history.coefficient_of_restitution**-2 - 1) / 2, 0.0, 1.0))


def _energy_lost(history: ImpactHistory) -> float:
    """Relative error of the restitution by the energy that motion, layer and dissipation lack in the end together.

    A dashpot's dissipation is summed to first order in the steps, so that the sum tells nothing beside one.
    """
    if relaxation_of(history.scene).viscosity > 0.0:
        return 0.0
    total = history.kinetic_energy + history.stored_energy + history.dissipated_energy
    return float(abs(total[-1] - total[0]) / (2.0 * history.kinetic_energy[-1]))


def _time_after_last_cell(history: ImpactHistory, cell: float) -> float:
    """The time by which contact outlasts half a cell [m], over the contact time; zero where the end takes few steps.

    The times in which the radius halves are taken for a geometric series: a cone's halve from one to the next.
    """
    wide = [history.time[np.flatnonzero(history.contact_radius > size * cell)[-1]] for size in (2.0, 1.0)]
    before, last = wide[1] - wide[0], history.time[-1] - wide[1]
    if before < IN_TIME.steps_of_end * (history.time[1] - history.time[0]):
        return 0.0
    ratio = min(last / before, IN_TIME.slowest_end)
    return float(last * ratio / (1.0 - ratio) / history.contact_time)


def _smooth_end(times: Sequence[float], heights: float) -> float:
    """Relative error of the contact time of an elastic rebound, as asked, on half the cells, and with half the steps.

    Steps of the trapezoidal rule err by a third of what twice their length changes.  Contact ends when it is half a
    cell wide, too early by the height there over the velocity: halving the cells divides that by ``heights`` = 2^n.
    The two have signs and may cancel, and each is believed but for a share.  Beyond a square, n > 2, the end is lost in
    errors of second order whose sign is not known.
    """
    fine, half_cells, half_both = times
    steps = (half_both - half_cells) / 3.0 / fine
    cells = (half_cells - fine) / (min(heights, 4.0) - 1.0) / fine
    both = abs(steps) + abs(cells)
    doubt = (IN_TIME.first_order - 1.0) * both
    return doubt + (abs(steps + cells) if heights <= IN_TIME.squares else both)


def _time_in_rounding(history: ImpactHistory) -> float:
    """The time in which the force is as small as its roundings, over the contact time: contact may end anywhere there.

    A dashpot that stops the body takes the largest force over the first velocity; it turns a rounding of the depth
    within one step into a force.
    """
    per_velocity = history.peak_force / history.velocity[0]
    step = history.time[1] - history.time[0]
    rounding = np.finfo(float).eps * per_velocity * abs(history.indentation_depth[-1]) / step
    small = history.normal_force[1:] <= IN_TIME.roundings_of_end * rounding
    # The last step ends without a force on any layer.
    return float(np.diff(history.time)[:-1][small[:-1]].sum() / history.contact_time)


def _steep_end(history: ImpactHistory, time_error: float) -> float:
    """What an error of the contact time means for the last radius: indenter and surface part in proportion to the time.

    A profile r^10 is half as wide a thousandth of the last step before its end.
    """
    indenter, before, last = history.scene.indenter, *history.contact_radius[-2:]
    shift = time_error * history.contact_time / (history.time[-1] - history.time[-2])
    left = min(1.0, shift) * height(indenter, before)
    reached = radius_of_depth(indenter, left) if left > 0.0 else last
    return float(max(reached - last, 0.0) / history.contact_radius.max())


def _scalar_change(fine: ImpactHistory, coarse: ImpactHistory, name: str) -> float:
    return float(abs(getattr(coarse, name) / getattr(fine, name) - 1))


def _channel_change(fine: ImpactHistory, coarse: ImpactHistory, name: str) -> float:
    """Largest change at the instants of the coarser history, relative to the largest value."""
    values, others = getattr(fine, name), getattr(coarse, name)
    change = np.interp(coarse.time, fine.time, values) - others
    return float(np.abs(change).max() / max(np.abs(values).max(), np.finfo(float).tiny))
