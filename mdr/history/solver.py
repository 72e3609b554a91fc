"""Incompressible viscoelastic layers under a prescribed depth or force history, Eqs. (47), (51) and (52).

Loading, unloading with a receding front, and reloading over a surface that has not yet recovered: one bed of springs.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from bem.kernels.moduli import contact_modulus, relaxation_of
from bem.layer_equation.protocol import FlatPunchSource
from contact import (
    DepthHistory,
    FlatPunch,
    ForceHistory,
    HistoryPath,
    InvalidInput,
    NotConvergedError,
    Scene,
    StageLog,
    UnsupportedSceneError,
)
from contact.answer.solution import Setting
from contact.records.validation import FloatArray
from contact.scene.extent import radius_of_depth, radius_of_load
from mdr.history.beside_front import carried_since
from mdr.history.contact_edge import SpringBed, carried, with_bend
from mdr.history.followed import FollowedHistory, states_at
from mdr.history.growing import FollowedLater, growing_history, searched, with_closed_form, without_steps
from mdr.history.own_springs import Turn
from mdr.history.springs_in_time import BedState, SpringLaw
from mdr.springs.assembly import equivalent_system
from mdr.springs.beside_contact import refuse_touching_at
from mdr.springs.error_model import (
    DEFAULT_ACCURACY,
    EPS,
    EXCESS_ERRORS,
    HISTORY_SAFETY,
    LARGEST_HISTORY_ERROR,
    SPRING_SHARES,
    SPRINGS_TO_MOTION,
)
from mdr.springs.pulling import refuse_pulling_at
from mdr.springs.shared_tables import growing_radii, own_table
from mdr.springs.table import MOMENT, PROFILE, STIFFENING, STIFFNESS, SpringTable

# Distances between springs within the largest front at the default accuracy, for which the next number stands too; one
# digit more doubles both. An error of fourth order where spring forces are smooth.
_GAPS = 640
# Substeps of a whole force history, at least four in each interval.
_FINENESS = 400
# The same history with these multiples of the fewest substeps, whose differences tell the error of time integration.
_LEVELS = (8, 4, 2, 1)
# What remains by changes that shrink by r is taken so many times, with r at least the second. With the first as one
# depths were covered in 20 of 23 histories of first order, r = 2 (plan "growing" of suite nightly, 2026-11-23).
_MARGIN_OF_ORDER, _LEAST_SHRINKING = 1.5, 1.2
# Orders between which the errors of the springs' number fall; kinks of old fronts and edges that springs do not resolve
# take up to one order.
_ORDERS = np.array([1.0, 1.5, 1.75, 2.0])
# A history that its springs do not resolve is followed again on so many times as many before it is refused: a layer
# that flows carries its force near the front only, whose place they know to first order. All six histories that 641
# springs had to refuse are then answered, with errors of 1e-4 to 1e-3 stated (`contact-verify campaign reloading
# --count 700 --seed 77`, 2026-11-22).
_TIMES_SPRINGS = (1, 4)
# Bounds of the doublings of springs and substeps that an accuracy may ask for.
_FEWEST, _MOST = -2, 2
# Least number of distances between springs in a section between breakpoints; chosen.
_FEWEST_GAPS = 16
# Points of each section among which the largest front is looked for; chosen.
_SEARCHED = 64
# Multiplies the way to the largest front, so that a few springs stay outside the contact; chosen.
_MARGIN = 1.01
# Speeds that differ by less than this share are one: a few roundings of instants.
_SAME_SPEED = 1e-12
# Relative rounding of a sum over as many springs.
_ROUNDING = _GAPS * float(np.finfo(float).eps)
# Share of the largest force below which what is held is no contact; chosen, far above the rounding of the sum.
_HELD = 1e-12
# Share of the largest spring force by which spring forces must rise outwards for the answer to carry a note; chosen.
_BEND = 1e-6


@dataclass(frozen=True)
class _Track:
    """One pass over the history.

    Attributes:
        depth: delta [m] at the given instants, shape (n,).
        force: F_N [N], shape (n,).
        y: Front coordinate, negative where there is no contact, shape (n,).
        bent: Whether the spring forces ever rose outwards.
        doubt: Share of the largest force that lies between bends of the spring forces where no spring stands.
        hidden: How far beyond y the front may stand, for the same reason, shape (n,).
    """

    depth: FloatArray
    force: FloatArray
    y: FloatArray
    bent: bool
    doubt: float
    hidden: FloatArray


def solve_history(scene: Scene, flat_punch: FlatPunchSource, settings: Mapping[str, Setting]) -> HistoryPath:
    """Force under a prescribed depth, or depth under a prescribed force.

    Raises:
        InvalidInput: If a force is negative or nothing is ever pressed.
        UnsupportedSceneError: If the contact would leave a gap inside itself, or touch beside itself.
        NotConvergedError: If four times as many springs still do not resolve the history.
    """
    loading, law = scene.loading, SpringLaw.of(relaxation_of(scene))
    if not isinstance(loading, DepthHistory | ForceHistory):
        raise UnsupportedSceneError(f"loading = {type(loading).__name__}: a history needs DepthHistory or ForceHistory")
    _refuse_idle(loading)
    follow = partial(followed_history, scene, loading, law, flat_punch, settings)
    if isinstance(loading, DepthHistory):
        return follow()
    known = without_steps(law, scene)
    if not known.any():
        return follow()
    exact = growing_history(scene, law, flat_punch, settings, FollowedLater(follow))
    return exact if known.all() else with_closed_form(follow(), exact, known)


def followed_history(
    scene: Scene,
    loading: DepthHistory | ForceHistory,
    law: SpringLaw,
    flat_punch: FlatPunchSource,
    settings: Mapping[str, Setting],
) -> HistoryPath:
    """The same spring by spring, whatever happens."""
    log, doublings = StageLog(), _doublings(settings)
    gaps, fineness = int(_GAPS * 2.0**doublings), int(_FINENESS * 2.0**doublings)
    for times in _TIMES_SPRINGS:
        with log.stage("equivalent_system"):
            table, beds, springs = _beds(scene, loading, law, flat_punch, times * gaps)
        with log.stage("history"):
            substeps = _substeps(loading, fineness)
            found = _followed(law, beds, loading, substeps)
        if found.error <= LARGEST_HISTORY_ERROR:
            break
    with log.stage("history"):
        radius = _radius(scene, table, found.track.y)
        refuse_touching_at(scene, flat_punch, float(radius.max()))
        refuse_pulling_at(scene, flat_punch, float(radius.max()))
    log.count("springs", beds[0].y.size)
    log.count("instants", loading.time.size)
    return HistoryPath(
        scene=scene,
        method="mdr",
        settings=settings,
        error_estimate=_errors(scene, table, found, springs),
        cost=log.cost(unknowns=beds[0].y.size),
        stages=log.records,
        notes=(_BENT,) if found.track.bent else (),
        time=loading.time,
        indentation_depth=found.track.depth,
        normal_force=found.track.force,
        contact_radius=radius,
        fields=FollowedHistory(scene, flat_punch, law, beds, _finest(loading, law, substeps), found.in_time + springs),
    )


def _errors(scene: Scene, table: SpringTable | None, found: _FoundHistory, springs: float) -> dict[str, FloatArray]:
    """Relative to the largest values, the same at all instants.

    Args:
        scene: The scene.
        table: Its springs; None under a flat punch.
        found: The history.
        springs: Relative error of the springs.
    """
    by_springs, by_steps = (
        [_moved(scene, table, *pair) for pair in pairs] for pairs in (found.by_springs, found.by_steps)
    )
    known = SPRINGS_TO_MOTION * springs + _ROUNDING
    track = found.track
    largest = float(_radius(scene, table, track.y).max())
    hidden = HISTORY_SAFETY * float(_hidden(scene, table, track).max()) / largest
    moved = _on_all_springs(by_springs) + found.left * sum(by_steps) + hidden + known
    if found.error > LARGEST_HISTORY_ERROR:
        raise NotConvergedError("the springs do not resolve this history", {"change with fewer": found.error})
    error = np.full(found.track.y.size, found.error + known)
    return {"indentation_depth": error, "normal_force": error, "contact_radius": np.full(error.size, moved)}


_BENT = (
    "Reloading has left spring forces that rise outwards somewhere; that the pressure is positive everywhere then "
    "follows no longer from the springs alone."
)


def _doublings(settings: Mapping[str, Setting]) -> int:
    """How much finer than usual the springs and substeps are for the method's accuracy."""
    accuracy = settings.get("accuracy") or DEFAULT_ACCURACY
    return int(np.clip(round(np.log10(DEFAULT_ACCURACY / float(accuracy))), _FEWEST, _MOST))


def _substeps(loading: DepthHistory | ForceHistory, fineness: int) -> NDArray[np.intp]:
    """Fewest substeps of each interval: half of them by its duration, half to all alike: short ones may be steep."""
    durations = np.diff(loading.time)
    shares = (durations / durations.sum() + 1.0 / durations.size) / 2.0
    counts: NDArray[np.intp] = np.maximum(np.ceil(fineness / _LEVELS[0] * shares), 1.0).astype(np.intp)
    return counts


@dataclass(frozen=True)
class _FoundHistory:
    """A history and what tells its errors.

    Attributes:
        track: The history.
        by_springs: Pairs that differ in the number of springs only.
        by_steps: Pairs that differ in the number of substeps only.
        error: Of depth and force, relative to their largest values.
        left: What substeps leave over what the last doubling of them has changed.
    """

    track: _Track
    by_springs: list[tuple[_Track, _Track]]
    by_steps: list[tuple[_Track, _Track]]
    error: float
    left: float = 1.0

    @property
    def in_time(self) -> float:
        """The part of the depth's error that the steps in time make."""
        return self.left * max((_change(one.depth, other.depth) for one, other in self.by_steps), default=0.0)


def _finest(loading: DepthHistory | ForceHistory, law: SpringLaw, substeps: NDArray[np.intp]) -> NDArray[np.intp]:
    """The most substeps that a history is followed with."""
    return np.ones_like(substeps) if isinstance(loading, DepthHistory) or law.is_elastic else _LEVELS[0] * substeps


def _followed(
    law: SpringLaw, beds: list[SpringBed], loading: DepthHistory | ForceHistory, substeps: NDArray[np.intp]
) -> _FoundHistory:
    """The history on the first bed, and how much it changes on the others and with fewer substeps.

    Between two instants a prescribed depth needs no substeps, nor does an elastic layer. Under a force their errors
    go with the second and fourth powers of their number, so three numbers of them have a limit (Romberg). Releases
    leave other powers, and a layer that relaxes within a step the first; the limit of another three tells the error.
    """
    if isinstance(loading, DepthHistory) or law.is_elastic:
        fine, *others = (_follow(law, bed, loading, _finest(loading, law, substeps)) for bed in beds)
        pairs = [(fine, other) for other in others]
        return _FoundHistory(fine, pairs, [], _error_of_springs(pairs) + fine.doubt)
    tracks = [_follow(law, beds[0], loading, level * substeps) for level in _LEVELS]
    pairs = [(tracks[-1], _follow(law, bed, loading, substeps)) for bed in beds[1:]]
    depth, before = (_limit(*(track.depth for track in three)) for three in (tracks[:3], tracks[1:]))
    left = _left(*(_change(one.depth, other.depth) for one, other in pairwise(tracks[:3])))
    error = left * _change(depth, before) + _error_of_springs(pairs)
    return _FoundHistory(replace(tracks[0], depth=depth), pairs, [(tracks[0], tracks[1])], error, left)


def _left(change: float, before: float) -> float:
    """What remains over the last change, at least all of it: 1/(r - 1) with changes that shrink by r, and a margin.

    Both a result with an error c h^p and Romberg's limit of such results leave that, with r = 2^p.
    """
    shrinks = before / change if change > 0.0 else np.inf
    return max(1.0, _MARGIN_OF_ORDER / (max(shrinks, _LEAST_SHRINKING) - 1.0))


def _error_of_springs(pairs: list[tuple[_Track, _Track]]) -> float:
    """Of force or depth, whichever is not prescribed."""
    return HISTORY_SAFETY * _on_all_springs(
        [max(_change(one.force, other.force), _change(one.depth, other.depth)) for one, other in pairs]
    )


def _on_all_springs(changes: list[float]) -> float:
    """The error on all springs, from what changes with each of the smaller numbers of them.

    Errors of second order change with half of the springs 2.9 times as much as with seven tenths of them; where less
    is seen, the order lies between that and 3/2, and more of the error is left.
    """
    bounds = [change / more for change, more in zip(changes, EXCESS_ERRORS, strict=False)]
    if len(changes) == len(EXCESS_ERRORS):
        few, fewer = ((1.0 / share) ** _ORDERS - 1.0 for share in SPRING_SHARES[1:])
        seen = changes[1] / changes[0] if changes[0] > 0.0 else np.inf
        bounds.append(changes[1] / float(np.interp(seen, fewer / few, fewer)))
    return max(bounds)


def _limit(fine: FloatArray, middle: FloatArray, coarse: FloatArray) -> FloatArray:
    """Without the errors of second and fourth order."""
    first, second = fine + (fine - middle) / 3.0, middle + (middle - coarse) / 3.0
    return first + (first - second) / 15.0


def _moved(scene: Scene, table: SpringTable | None, fine: _Track, coarse: _Track) -> float:
    """Largest difference of contact radii against the largest, beyond what either history says it does not know."""
    one, other = (_radius(scene, table, track.y) for track in (fine, coarse))
    unknown = _hidden(scene, table, fine) + _hidden(scene, table, coarse)
    return float(np.maximum(np.abs(one - other) - unknown, 0.0).max() / one.max())


def _hidden(scene: Scene, table: SpringTable | None, track: _Track) -> FloatArray:
    """How far beyond its contact radius [m] a front may stand."""
    return np.abs(_radius(scene, table, track.y + track.hidden) - _radius(scene, table, track.y))


def _change(fine: FloatArray, coarse: FloatArray) -> float:
    """Largest difference against the largest value."""
    return float(np.abs(fine - coarse).max() / max(float(np.abs(fine).max()), np.finfo(float).tiny))


def _radius(scene: Scene, table: SpringTable | None, y: FloatArray) -> FloatArray:
    """a [m], zero without contact."""
    radius = np.full(y.shape, scene.indenter.max_radius) if table is None else table.radius(np.maximum(y, 0.0))
    return np.where(y >= 0.0, radius, 0.0)


def _beds(
    scene: Scene, loading: DepthHistory | ForceHistory, law: SpringLaw, flat_punch: FlatPunchSource, gaps: int
) -> tuple[SpringTable | None, list[SpringBed], float]:
    """Springs out to the largest radius that the history can reach, by `SPRING_SHARES`, and their own error."""
    if isinstance(scene.indenter, FlatPunch):
        end = scene.indenter.max_radius
        system = equivalent_system(scene.layer, scene.indenter, end, flat_punch)
        core = float(system.contact_stiffness(end))
        bed = SpringBed(np.array([0.0, 1.0]), np.full(2, end), np.array([0.0, np.inf]), np.zeros(2), core)
        return None, [bed, bed], system.relative_error["contact_stiffness"]
    largest = _largest(loading, law)
    for radius in growing_radii(scene.indenter, _first_radius(scene, loading, largest)):
        table = own_table(scene.layer, scene.indenter, radius, flat_punch)
        y = np.concatenate([np.linspace(*ends, _SEARCHED) for ends in pairwise(table.section_ends)])
        rows = table.evaluate(y)
        by_depth = isinstance(loading, DepthHistory)
        reached = rows[PROFILE] if by_depth else rows[STIFFNESS] * rows[PROFILE] - rows[MOMENT]
        if np.interp(_farther(table, float(y[-1]), 1.0 / _MARGIN), y, reached) >= largest:
            break
    if reached[-1] < largest:
        raise InvalidInput(f"loading: {largest:g} presses the indenter in beyond its rim at {radius:g} m")
    end = _farther(table, float(np.interp(largest, reached, y)), _MARGIN)
    pointed = scene.indenter.flat_radius == 0.0
    beds = [_bed_up_to(table, end, share * gaps, round(share * _FEWEST_GAPS), pointed) for share in SPRING_SHARES]
    return table, beds, table.error


def _farther(table: SpringTable, y: float, times: float) -> float:
    """A front so many times as far along the sections, each as long as the root of the radii it spans; in the table."""
    # y begins as a radius.
    lengths = np.concatenate([[0.0], np.cumsum(np.sqrt(np.diff(table.section_radii)))])
    return float(np.interp(times * np.interp(y, table.section_ends, lengths), lengths, table.section_ends))


def _bed_up_to(table: SpringTable, end: float, gaps: float, fewest: int, pointed: bool) -> SpringBed:
    """Springs up to y = end, each section between breakpoints with its share of the gaps."""
    ends = np.append(table.section_ends[table.section_ends < end], end)
    # Before the first breakpoint y itself is a radius.
    lengths = np.sqrt(np.diff(table.radius(ends)))
    shares = [max(round(gaps * part), fewest) for part in lengths / lengths.sum()]
    places = [np.linspace(low, high, share + 1) for (low, high), share in zip(pairwise(ends), shares, strict=True)]
    rows = np.concatenate([table.evaluate(y, section=i) for i, y in enumerate(places)], axis=1)
    radius = np.concatenate([table.radius_within(y, i) for i, y in enumerate(places)])
    return SpringBed(
        y=np.concatenate(places),
        radius=radius,
        profile=np.maximum(rows[PROFILE], 0.0),
        density=rows[STIFFENING],
        core=0.0 if pointed else float(rows[STIFFNESS, 0]),
        starts=(0, *np.cumsum([y.size for y in places])[:-1].tolist()),
        table=table,
    )


def _refuse_idle(loading: DepthHistory | ForceHistory) -> None:
    prescribed = loading.depth if isinstance(loading, DepthHistory) else loading.force
    if isinstance(loading, ForceHistory) and prescribed.min() < 0.0:
        worst = int(prescribed.argmin())
        raise InvalidInput(
            f"loading.force = {prescribed[worst]:g} (entry {worst}): without adhesion nothing pulls; stay above zero"
        )
    if prescribed.max() <= 0.0:
        raise InvalidInput(f"loading: its largest value is {prescribed.max():g}; the indenter never presses")


def _largest(loading: DepthHistory | ForceHistory, law: SpringLaw) -> float:
    """The largest depth [m], or force [N], that an elastic layer has to bear to be in contact as far.

    Displacements of all springs, each times its stiffness, add up to F_e = J * dF (`growing`), and none stands above
    the indenter.
    """
    if isinstance(loading, DepthHistory):
        return float(loading.depth.max())
    return float(searched(law, loading)[1].max())


def _first_radius(scene: Scene, loading: DepthHistory | ForceHistory, largest: float) -> float:
    """A radius [m] to start from: where the half-space, roughly, has the largest depth or force."""
    if isinstance(loading, DepthHistory):
        return radius_of_depth(scene.indenter, largest)
    return radius_of_load(scene.indenter, largest / contact_modulus(scene.layer))


def _follow(law: SpringLaw, bed: SpringBed, loading: DepthHistory | ForceHistory, substeps: NDArray[np.intp]) -> _Track:
    """March through the history and record depth, force and front at the given instants."""
    records: list[tuple[float, ...]] = []
    bent, turns, bends, past = False, _turns(loading), np.empty(0), list[Turn]()
    for i, (state, speed) in enumerate(states_at(law, bed, loading, substeps)):
        time = float(loading.time[i])
        bent |= _check_circle(law, state, speed, time)
        held = carried_since(past, law, bed, (time, state), bends) if past else carried(law, bed, state, speed, bends)
        records.append((state.depth, *held))
        if turns[i]:
            past.append(Turn(time, state, records[-1][2]))
            bends = with_bend(bends, past[-1].front)
    depth, force, y, doubt, hidden = np.array(records).T
    # What is held by a rounding error is no contact and carries nothing; a prescribed force stays as it was given.
    own = force if isinstance(loading, DepthHistory) else loading.force
    held = own > _HELD * own.max()
    force, y = np.where(held, own, 0.0) if own is force else own, np.where(held, y, -1.0)
    return _Track(depth, force, y, bent, float(doubt.max() / max(force.max(), np.finfo(float).tiny)), hidden)


def _turns(loading: DepthHistory | ForceHistory) -> NDArray[np.bool_]:
    """At which instants the speed of a prescribed depth changes, shape (n,); under a force it is not prescribed."""
    if isinstance(loading, ForceHistory):
        return np.full(loading.time.size, False)
    steps = np.diff(loading.time)
    speeds = np.diff(loading.depth) / steps
    # Given depths and instants are rounded, and so are their differences.
    rounded = 2.0 * EPS * (np.abs(loading.depth).max() + np.abs(speeds) * np.abs(loading.time).max()) / steps
    same = np.abs(np.diff(speeds)) <= _SAME_SPEED * np.abs(speeds[1:]) + rounded[1:] + rounded[:-1]
    return np.concatenate([[True], ~same, [True]])


def _check_circle(law: SpringLaw, state: BedState, speed: float, time: float) -> bool:
    """Refuse a contact with a gap inside; say whether spring forces rise outwards."""
    touching = np.flatnonzero(state.touching)
    if not touching.size:
        return False
    if touching[-1] > touching.size:
        raise UnsupportedSceneError(
            f"at t = {time:g} s the contact opens inside while it holds outside: the method needs one circle; "
            "end the history earlier, or let the layer recover before reloading"
        )
    forces = law.force(state.surface, state.strains, speed)[touching]
    return bool(np.any(np.diff(forces) > _BEND * np.abs(forces).max()))
