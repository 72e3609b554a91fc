"""Lanes from their start to their first event, one after the other in plain loops that numba compiles.

This is `collocation` and `collocation_step` once more, with the equations of `equations` and `flat_punch_equations`;
what is tuned there comes as an argument.  numba stores compiled code beside this file and renews it when this file
changes, not when another does: nothing here may call a compiled function of another file or read another's constants.
Compiling takes a time that grows with the number of arrays a function takes, hence tables with named columns.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable
from importlib.util import find_spec
from typing import NamedTuple, TypeVar

import numpy as np

from contact.records.validation import FloatArray, IntArray

F = TypeVar("F", bound=Callable[..., object])

# Kinds of motion: pressing in, coming back, and a flat punch.
PRESSING, RECEDING, FLAT = range(3)
# How a lane ended: on its event; in a stiff stretch, out of bounds or nowhere; without room for another step.
ARRIVED, LEFT, FULL = range(3)
# Columns of `Equations.numbers`: G_inf / G_0, eta / G_0, kappa; units of y, g, dg/dy, k, dk/dy, P; and the numbers of
# `Memory.within`.
LONG_TERM, VISCOSITY, INERTIA, UNIT, MEMORY = 0, 1, 2, 3, 9
# Columns of `Walk.lengths`: of the next step; of the last one and where the next begins on it; error; tolerance.
NEXT, LAST, ORIGIN, ERROR, TOLERANCE = range(5)
# Columns of `Walk.counts`.
STEPS, SWEEPS, EVENT = range(3)
# First columns of the matrices in `Walk.rule`, from the ten slopes of a step: to states at its stages, to the change
# over it and the slope at its end, to powers of the change, to the last two Legendre coefficients, to powers of slopes
# for the step after it, and for its repetition; in the last column stand the Gauss points.
STAGES, ENDS, CHANGE, TAIL, ONWARD, WITHIN, POINTS = 0, 10, 12, 23, 25, 35, 45


def _plain(function: F) -> F:
    return function


def _compilers() -> tuple[Callable[[F], F], Callable[[F], F]]:
    """numba's, of inner loops and of what Python calls; the loops also run where it is not installed, slowly."""
    if find_spec("numba") is None:
        return _plain, _plain
    njit = importlib.import_module("numba").njit
    # Division by zero gives infinity, as it does in NumPy.
    inner: Callable[[F], F] = njit(error_model="numpy", no_cpython_wrapper=True, no_cfunc_wrapper=True)
    outer: Callable[[F], F] = njit(error_model="numpy", no_cfunc_wrapper=True, cache=True)
    return inner, outer


loops, called = _compilers()


class Equations(NamedTuple):
    """What the right-hand sides need.

    Attributes:
        kind: PRESSING, RECEDING or FLAT.
        numbers: Of each lane, shape (lanes, 13).
        branches: G_j / G_0, and the unit of time over tau_j, shape (lanes, 2, branches).
        memory: Powers of its argument, shape (lanes, rows, 16).
        panels: End, centre and scale of each panel of the table, shape (panels, 3).
        powers: Of z on each panel for g, dg/dy, k, dk/dy, P, shape (panels, 17, 5).
    """

    kind: int
    numbers: FloatArray
    branches: FloatArray
    memory: FloatArray
    panels: FloatArray
    powers: FloatArray


class Control(NamedTuple):
    """What steps are chosen by; the names are those of the constants in `collocation` and `collocation_step`."""

    sweep_tolerance: float
    sweeps: int
    patience: int
    slow: float
    aims: int
    nearest: float
    least: float
    most: float
    safety: float
    shrink: float
    grow: float
    power: float
    almost: float
    stiff: float
    trials: int


class Walk(NamedTuple):
    """All that a walk takes; what changes on the way is the lanes' own.

    Attributes:
        equations: The right-hand sides.
        rule: Matrices from slopes, shape (10, 46).
        control: What steps are chosen by.
        chain: Rows of a component, its speed, and that speed's clock or -1.
        events: Component and direction of each event, shape (events, 2).
        targets: Where the events are, shape (events, lanes).
        state: At the start, then at the end, shape (lanes, m).
        heading: Powers of the last step's slopes, shape (lanes, m, 10).
        lengths: Of steps, with errors, shape (lanes, 5).
        counts: Of steps and sweeps, and the event at the end, shape (lanes, 3).
        starts: As in `Trajectory`, shape (m, room, lanes).
        steps: As in `Trajectory`, shape (11, m, room, lanes).
    """

    equations: Equations
    rule: FloatArray
    control: Control
    chain: tuple[int, int, int]
    events: IntArray
    targets: FloatArray
    state: FloatArray
    heading: FloatArray
    lengths: FloatArray
    counts: IntArray
    starts: FloatArray
    steps: FloatArray


class _Landing(NamedTuple):
    """The event that a step must end on or -1, its component, and how far that must go."""

    due: int
    component: int
    span: float


class _Trial(NamedTuple):
    """The length that a step began with, its last one, and its error over the precision, infinite if it failed."""

    aim: float
    size: float
    error: float


@called
def walked(walk: Walk) -> IntArray:
    """Advance every lane to its first event; how each of them ended."""
    lanes, count, stages = walk.heading.shape
    ended = np.empty(lanes, dtype=np.intp)
    bench = np.empty((3, count, stages))
    for lane in range(lanes):
        ended[lane] = _lane(walk, bench, lane)
    return ended


@loops
def _lane(walk: Walk, bench: FloatArray, lane: int) -> int:
    """One lane to its event."""
    lengths, counts, due = walk.lengths[lane], walk.counts[lane], -1
    for _ in range(walk.control.trials):
        if not _completed(walk, bench, lane):
            return LEFT
        landing = _landing(walk, lane, due)
        trial = _swept(walk, bench, landing, lane)
        if not np.isfinite(trial.error) and trial.aim < walk.control.stiff:
            return LEFT
        due, kept = -1, trial.error <= 1.0
        if kept:
            end = _end(walk, bench[1], landing, trial.size, lane)
            due = _first_event(walk, lane, end, landing.due)
            kept = due < 0
            if kept and counts[STEPS] == walk.starts.shape[1]:
                return FULL
            if kept:
                _keep(walk, bench[1], trial.size, end, lane)
                lengths[ERROR] += lengths[TOLERANCE] * (trial.error + walk.control.sweep_tolerance)
        _follow(walk.rule, bench[1], walk.heading[lane], trial, kept)
        landed = kept and landing.due >= 0
        lengths[NEXT] = _next_size(walk.control, lengths[NEXT], trial, due, landed)
        lengths[LAST], lengths[ORIGIN] = trial.size, 1.0 if kept else -1.0
        if landed:
            counts[EVENT] = landing.due
            return ARRIVED
    return LEFT


@loops
def _completed(walk: Walk, bench: FloatArray, lane: int) -> bool:
    """Constant slopes where there was no earlier step; whether all are finite."""
    heading = walk.heading[lane]
    if np.isnan(heading[0, 0]):
        for c in range(heading.shape[0]):
            for i in range(heading.shape[1]):
                bench[0, c, i], heading[c, i] = walk.state[lane, c], 0.0
        _slopes(walk.equations, lane, bench[0], bench[1])
        for c in range(heading.shape[0]):
            heading[c, 0] = bench[1, c, 0]
        walk.lengths[lane, ORIGIN] = -1.0
    for c in range(heading.shape[0]):
        for k in range(heading.shape[1]):
            if not np.isfinite(heading[c, k]):
                return False
    return True


@loops
def _landing(walk: Walk, lane: int, due: int) -> _Landing:
    """The event that is due, or the one that the next step nearly reaches if the course holds."""
    if due < 0:
        due = _first_event(walk, lane, _ahead(walk, lane), -1)
    if due < 0:
        return _Landing(-1, 0, 0.0)
    component = walk.events[due, 0]
    return _Landing(due, component, walk.targets[due, lane] - walk.state[lane, component])


@loops
def _ahead(walk: Walk, lane: int) -> FloatArray:
    """The state a little more than a step ahead if the course holds."""
    end: FloatArray = walk.state[lane].copy()
    heading, lengths = walk.heading[lane], walk.lengths[lane]
    far = lengths[ORIGIN] + 2.0 * lengths[NEXT] / lengths[LAST]
    for c in range(end.size):
        way, ahead, behind = 0.0, far, lengths[ORIGIN]
        for k in range(heading.shape[1]):
            way += heading[c, k] * (ahead - behind) / (k + 1.0)
            ahead *= far
            behind *= lengths[ORIGIN]
        end[c] += walk.control.almost * 0.5 * lengths[LAST] * way
    return end


@loops
def _first_event(walk: Walk, lane: int, end: FloatArray, but: int) -> int:
    """The event that is met first, judged by linear interpolation; -1 for none."""
    first, nearest, start = -1, np.inf, walk.state[lane]
    for number in range(walk.events.shape[0]):
        component, direction = walk.events[number, 0], walk.events[number, 1]
        gap = direction * (walk.targets[number, lane] - start[component])
        travel = direction * (end[component] - start[component])
        if number != but and travel >= gap and travel > 0.0 and gap / travel < nearest:
            first, nearest = number, gap / travel
    return first


@loops
def _aimed(walk: Walk, landing: _Landing, lane: int) -> float:
    """The length that lands where it should if the course holds; the next one where it need not."""
    at: float = walk.lengths[lane, NEXT]
    length, origin = walk.lengths[lane, LAST], walk.lengths[lane, ORIGIN]
    if landing.due < 0:
        return at
    heading, z = walk.heading[lane, landing.component], origin + 2.0 * at / length
    for attempt in range(walk.control.aims + 1):
        way, slope, ahead, behind = 0.0, 0.0, 1.0, 1.0
        for k in range(heading.size):
            slope += heading[k] * ahead
            ahead *= z
            behind *= origin
            way += heading[k] * (ahead - behind) / (k + 1.0)
        way *= 0.5 * length
        at = 0.5 * length * (z - origin)
        if attempt == 0:
            share = landing.span / way
            at *= min(max(share if share > 0.0 else 1.0, walk.control.nearest), 1.0)
        else:
            at = _lengthened(walk.control, at, (landing.span - way) / slope)
        z = origin + 2.0 * at / length
    return at


@loops
def _lengthened(control: Control, size: float, miss: float) -> float:
    """A length after a correction that must not be wild."""
    if not np.isfinite(miss):
        return size
    return min(max(size + miss, control.least * size), control.most * size)


@loops
def _swept(walk: Walk, bench: FloatArray, landing: _Landing, lane: int) -> _Trial:
    """Sweep until no stage moves; the error is infinite where that fails."""
    control, before, slopes = walk.control, np.inf, bench[1]
    aim = size = _aimed(walk, landing, lane)
    _guess(walk, slopes, size, lane)
    precision = walk.state[lane].copy()
    for c in range(precision.size):
        precision[c] = walk.lengths[lane, TOLERANCE] * max(1.0, abs(precision[c]))
    for sweep in range(1, control.sweeps + 1):
        walk.counts[lane, SWEEPS] += 1
        _states(walk, bench, size, lane)
        _slopes(walk.equations, lane, bench[0], bench[2])
        change = aim * _largest_change(slopes, bench[2], precision)
        if landing.due >= 0:
            miss, weight = _miss(walk.rule, slopes, precision, landing, size)
            size = _lengthened(control, size, miss)
            change = _larger(change, weight * abs(miss))
        if change <= control.sweep_tolerance:
            return _Trial(aim, size, _error(walk.rule, slopes, precision, size))
        if sweep > control.patience and not change < control.slow * before:
            break
        before = change
    return _Trial(aim, size, np.inf)


@loops
def _guess(walk: Walk, slopes: FloatArray, size: float, lane: int) -> None:
    """Slopes at the stages of a step of this length if the course holds."""
    heading, share = walk.heading[lane], size / walk.lengths[lane, LAST]
    for i in range(slopes.shape[1]):
        z = walk.lengths[lane, ORIGIN] + share * (1.0 + walk.rule[i, POINTS])
        for c in range(slopes.shape[0]):
            value = 0.0
            for k in range(heading.shape[1] - 1, -1, -1):
                value = value * z + heading[c, k]
            slopes[c, i] = value


@loops
def _states(walk: Walk, bench: FloatArray, size: float, lane: int) -> None:
    """At the stages; a chained component from the newest of its speed."""
    start, states, slopes, rate = walk.state[lane], bench[0], bench[1], bench[2, 0]
    row, speed, clock = walk.chain
    for c in range(start.size):
        _spread(walk.rule, STAGES, slopes[c], states[c])
        for i in range(rate.size):
            states[c, i] = start[c] + size * states[c, i]
    for i in range(rate.size):
        rate[i] = states[speed, i] if clock < 0 else states[speed, i] * slopes[clock, i]
    _spread(walk.rule, STAGES, rate, states[row])
    for i in range(rate.size):
        states[row, i] = start[row] + size * states[row, i]


@loops
def _spread(rule: FloatArray, first: int, values: FloatArray, found: FloatArray) -> None:
    """A product with one of the rule's matrices, by its first column."""
    for i in range(found.size):
        found[i] = 0.0
    for j in range(values.size):
        for i in range(found.size):
            found[i] += rule[j, first + i] * values[j]


@loops
def _term(rule: FloatArray, column: int, values: FloatArray) -> float:
    """A product with one column of the rule."""
    total: float = 0.0
    for j in range(values.size):
        total += rule[j, column] * values[j]
    return total


@loops
def _largest_change(slopes: FloatArray, new: FloatArray, precision: FloatArray) -> float:
    """Largest change of a slope over the precision of its component; the new slopes replace the old ones."""
    largest = 0.0
    for c in range(precision.size):
        own = 0.0
        for i in range(slopes.shape[1]):
            own = _larger(own, abs(new[c, i] - slopes[c, i]))
            slopes[c, i] = new[c, i]
        largest = _larger(largest, own / precision[c])
    return largest


@loops
def _larger(one: float, other: float) -> float:
    """The larger of two numbers, or the one that is none."""
    return one if one >= other or np.isnan(one) else other


@loops
def _miss(
    rule: FloatArray, slopes: FloatArray, precision: FloatArray, landing: _Landing, size: float
) -> tuple[float, float]:
    """How far in length a step ends before its event, and how much that counts in units of the precision."""
    weight, own = 0.0, slopes[landing.component]
    for c in range(precision.size):
        weight = _larger(weight, abs(_term(rule, ENDS + 1, slopes[c])) / precision[c])
    return (landing.span - size * _term(rule, ENDS, own)) / _term(rule, ENDS + 1, own), weight


@loops
def _error(rule: FloatArray, slopes: FloatArray, precision: FloatArray, size: float) -> float:
    """The part that the last two Legendre polynomials have."""
    largest = 0.0
    for c in range(precision.size):
        for column in (TAIL, TAIL + 1):
            largest = _larger(largest, abs(_term(rule, column, slopes[c])) * size / precision[c])
    return largest / float(2 * slopes.shape[1])


@loops
def _end(walk: Walk, slopes: FloatArray, landing: _Landing, size: float, lane: int) -> FloatArray:
    """State at the end of a step, exactly on its event where there is one."""
    end: FloatArray = walk.state[lane].copy()
    for c in range(end.size):
        end[c] += size * _term(walk.rule, ENDS, slopes[c])
    if landing.due >= 0:
        end[landing.component] = walk.state[lane, landing.component] + landing.span
    return end


@loops
def _keep(walk: Walk, slopes: FloatArray, size: float, end: FloatArray, lane: int) -> None:
    """Record a step and go to its end."""
    start, step, powers = walk.state[lane], walk.counts[lane, STEPS], np.empty(walk.steps.shape[0])
    for c in range(start.size):
        _spread(walk.rule, CHANGE, slopes[c], powers)
        walk.starts[c, step, lane] = start[c]
        for k in range(powers.size):
            walk.steps[k, c, step, lane] = size * powers[k]
        start[c] = end[c]
    walk.counts[lane, STEPS] = step + 1


@loops
def _follow(rule: FloatArray, slopes: FloatArray, heading: FloatArray, trial: _Trial, kept: bool) -> None:
    """Remember a step that ended or is to be repeated; one that came to nothing says nothing."""
    for c in range(heading.shape[0]):
        if np.isfinite(trial.error):
            _spread(rule, ONWARD if kept else WITHIN, slopes[c], heading[c])
        else:
            heading[c, 0] = np.nan


@loops
def _next_size(control: Control, wanted: float, trial: _Trial, passed: int, landed: bool) -> float:
    """Length of the next trial; after a failure it is shorter than this one was anywhere."""
    factor: float = control.safety * max(trial.error, 1e-9) ** control.power
    factor = min(max(factor, control.shrink), control.grow)
    if not trial.error <= 1.0:
        return min(factor, 1.0) * min(trial.aim, trial.size)
    further = (factor if passed < 0 else 1.0) * trial.size
    return max(further, wanted) if landed else further


@loops
def _slopes(equations: Equations, lane: int, states: FloatArray, slopes: FloatArray) -> None:
    """The right-hand side at all stages."""
    for stage in range(states.shape[1]):
        if equations.kind == PRESSING:
            _pressing(equations, lane, states, slopes, stage)
        elif equations.kind == RECEDING:
            _receding(equations, lane, states, slopes, stage)
        else:
            _flat(equations, lane, states, slopes, stage)


@loops
def _pressing(own: Equations, lane: int, states: FloatArray, slopes: FloatArray, i: int) -> None:
    """d(state)/d(sigma) on the way in, `equations.Pressing`."""
    count, v, numbers = own.branches.shape[2], states[2, i], own.numbers[lane]
    g, g_y, k, k_y, moment = _springs(own, lane, states[0, i])
    gaps = 0.0
    for j in range(count):
        weight, relaxation = own.branches[lane, 0, j], own.branches[lane, 1, j] * g_y
        relaxed, faded = states[3 + j, i], states[3 + count + j, i]
        gaps += k * relaxed - faded
        slopes[3 + j, i] = relaxation * (weight * g - relaxed)
        slopes[3 + count + j, i] = k_y * v * relaxed + relaxation * (weight * moment - faded)
    slopes[0, i], slopes[1, i] = v, g_y
    slopes[2, i] = (k * (g + numbers[VISCOSITY] * v) - (moment + gaps)) * (g_y * -numbers[INERTIA])


@loops
def _receding(own: Equations, lane: int, states: FloatArray, slopes: FloatArray, i: int) -> None:
    """d(state)/d(sigma) on the way back, `equations.Receding`."""
    count, numbers, met, place = own.branches.shape[2], own.numbers[lane], 0.0, 0.0
    y, t, delta, v = states[0, i], states[1, i], states[2, i], states[3, i]
    g, g_y, k, _, moment = _springs(own, lane, y)
    if count:
        left = np.sqrt(max(numbers[MEMORY] - y / numbers[MEMORY + 1], 0.0))
        place = numbers[MEMORY + 3] - numbers[MEMORY + 2] * left
        met = _power_sum(own.memory[lane, 0], place)
    taken, tip, held = 0.0, 0.0, numbers[LONG_TERM]
    for j in range(count):
        weight, rate, relaxed = own.branches[lane, 0, j], own.branches[lane, 1, j], states[4 + j, i]
        history, fading = weight * delta - relaxed, np.exp((met - t) * rate)
        front = history - fading * (weight * g - _power_sum(own.memory[lane, 1 + j], place))
        taken += k * relaxed + fading * (weight * moment - _power_sum(own.memory[lane, 1 + count + j], place))
        tip += weight * v - rate * front
        held += weight * fading
        slopes[4 + j, i] = rate * history * g_y
    pressed = k * (delta + numbers[VISCOSITY] * v) - (numbers[LONG_TERM] * moment + taken)
    slowed = -numbers[INERTIA] * pressed
    slopes[0, i] = (numbers[LONG_TERM] * v + numbers[VISCOSITY] * slowed + tip) / held
    slopes[1, i], slopes[2, i], slopes[3, i] = g_y, v * g_y, slowed * g_y


@loops
def _flat(own: Equations, lane: int, states: FloatArray, slopes: FloatArray, i: int) -> None:
    """d(state)/dt of a flat punch, `flat_punch_equations`."""
    count, numbers, v = own.branches.shape[2], own.numbers[lane], states[3, i]
    slowed = -numbers[INERTIA] * states[0, i]
    rise, lost = numbers[LONG_TERM] * v + numbers[VISCOSITY] * slowed, numbers[VISCOSITY] * v**2
    for j in range(count):
        weight, rate, branch = own.branches[lane, 0, j], own.branches[lane, 1, j], states[4 + j, i]
        slopes[4 + j, i] = weight * v - rate * branch
        rise += slopes[4 + j, i]
        lost += rate / weight * branch**2
    slopes[0, i], slopes[1, i], slopes[2, i], slopes[3, i] = rise, 1.0, v, slowed
    slopes[4 + count, i] = numbers[INERTIA] * lost


@loops
def _springs(own: Equations, lane: int, y: float) -> tuple[float, float, float, float, float]:
    """g, dg/dy, k, dk/dy, P in the lane's units."""
    units, panel = own.numbers[lane, UNIT:MEMORY], 0
    at = y * units[0]
    while panel < own.panels.shape[0] - 1 and own.panels[panel, 0] <= at:
        panel += 1
    z, powers = (at - own.panels[panel, 1]) * own.panels[panel, 2], own.powers[panel]
    g, g_y, k, k_y, moment = 0.0, 0.0, 0.0, 0.0, 0.0
    for n in range(powers.shape[0] - 1, -1, -1):
        g = g * z + powers[n, 0]
        g_y = g_y * z + powers[n, 1]
        k = k * z + powers[n, 2]
        k_y = k_y * z + powers[n, 3]
        moment = moment * z + powers[n, 4]
    return g / units[1], g_y / units[2], k / units[3], k_y / units[4], moment / units[5]


@loops
def _power_sum(powers: FloatArray, z: float) -> float:
    """A polynomial in powers of z."""
    value: float = 0.0
    for n in range(powers.size - 1, -1, -1):
        value = value * z + powers[n]
    return value
