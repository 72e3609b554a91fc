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
    inner: Callable[[F], F] = njit(
        error_model="numpy",
        fastmath={"contract"},
        forceinline=True,
        _nrt=False,
        no_cpython_wrapper=True,
        no_cfunc_wrapper=True,
    )
    outer: Callable[[F], F] = njit(
        error_model="numpy", fastmath={"contract"}, _nrt=False, no_cfunc_wrapper=True, cache=True
    )
    return inner, outer


loops, called = _compilers()


class Equations(NamedTuple):
    """What the right-hand sides need.

    Attributes:
        kind: PRESSING, RECEDING or FLAT.
        numbers: Of each lane, shape (lanes, 13).
        branches: G_j / G_0, and the unit of time over tau_j, shape (lanes, 2, branches).
        memory: Powers of its argument, the highest first, shape (lanes, rows, 16).
        panels: End, centre and scale of each panel of the table, shape (panels, 3).
        powers: Of z on each panel, the highest first, for g, dg/dy, k, dk/dy, P, shape (panels, 17, 5).
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
        ended: How each lane ended, shape (lanes,).
        bench: To work on: states, slopes and new slopes at the stages, shape (3, m, 10).
        rows: To work on: a state at the end, and the precision, shape (2, m).
        powers: To work on, shape (11,).
        springs: To work on: rows of the table at the stages, shape (5, 10).
        recalled: To work on: rows of the memory at the stages, shape (rows, 10).
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
    ended: IntArray
    bench: FloatArray
    rows: FloatArray
    powers: FloatArray
    springs: FloatArray
    recalled: FloatArray


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
def walked(walk: Walk) -> None:
    """Advance every lane to its first event."""
    for lane in range(walk.ended.size):
        walk.ended[lane] = _lane(walk, lane)


@loops
def _lane(walk: Walk, lane: int) -> int:
    """One lane to its event."""
    lengths, counts, slopes, end, due = walk.lengths[lane], walk.counts[lane], walk.bench[1], walk.rows[0], -1
    for _ in range(walk.control.trials):
        if not _completed(walk, lane):
            return LEFT
        landing = _landing(walk, lane, due)
        trial = _swept(walk, landing, lane)
        if not np.isfinite(trial.error) and trial.aim < walk.control.stiff:
            return LEFT
        due, kept = -1, trial.error <= 1.0
        if kept:
            _end(walk, landing, trial.size, lane)
            due = _first_event(walk, lane, end, landing.due)
            kept = due < 0
            if kept and counts[STEPS] == walk.starts.shape[1]:
                return FULL
            if kept:
                _keep(walk, trial.size, lane)
                lengths[ERROR] += lengths[TOLERANCE] * (trial.error + walk.control.sweep_tolerance)
        _follow(walk.rule, slopes, walk.heading[lane], trial, kept)
        landed = kept and landing.due >= 0
        lengths[NEXT] = _next_size(walk.control, lengths[NEXT], trial, due, landed)
        lengths[LAST], lengths[ORIGIN] = trial.size, 1.0 if kept else -1.0
        if landed:
            counts[EVENT] = landing.due
            return ARRIVED
    return LEFT


@loops
def _completed(walk: Walk, lane: int) -> bool:
    """Constant slopes where there was no earlier step; whether all are finite."""
    heading, states, new = walk.heading[lane], walk.bench[0], walk.bench[2]
    if np.isnan(heading[0, 0]):
        for c in range(heading.shape[0]):
            for i in range(heading.shape[1]):
                states[c, i], heading[c, i] = walk.state[lane, c], 0.0
        _slopes(walk, lane, new)
        for c in range(heading.shape[0]):
            heading[c, 0] = new[c, 0]
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
        _ahead(walk, lane, walk.rows[0])
        due = _first_event(walk, lane, walk.rows[0], -1)
    if due < 0:
        return _Landing(-1, 0, 0.0)
    component = walk.events[due, 0]
    return _Landing(due, component, walk.targets[due, lane] - walk.state[lane, component])


@loops
def _ahead(walk: Walk, lane: int, end: FloatArray) -> None:
    """The state a little more than a step ahead if the course holds."""
    heading, lengths = walk.heading[lane], walk.lengths[lane]
    far = lengths[ORIGIN] + 2.0 * lengths[NEXT] / lengths[LAST]
    for c in range(end.size):
        way, ahead, behind = 0.0, far, lengths[ORIGIN]
        for k in range(heading.shape[1]):
            way += heading[c, k] * (ahead - behind) / (k + 1.0)
            ahead *= far
            behind *= lengths[ORIGIN]
        end[c] = walk.state[lane, c] + walk.control.almost * 0.5 * lengths[LAST] * way


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
def _swept(walk: Walk, landing: _Landing, lane: int) -> _Trial:
    """Sweep until no stage moves; the error is infinite where that fails."""
    control, before = walk.control, np.inf
    slopes, new, precision = walk.bench[1], walk.bench[2], walk.rows[1]
    aim = size = _aimed(walk, landing, lane)
    _guess(walk, slopes, size, lane)
    for c in range(precision.size):
        precision[c] = walk.lengths[lane, TOLERANCE] * max(1.0, abs(walk.state[lane, c]))
    for sweep in range(1, control.sweeps + 1):
        walk.counts[lane, SWEEPS] += 1
        _states(walk, size, lane)
        _slopes(walk, lane, new)
        change = aim * _largest_change(slopes, new, precision)
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
            for k in range(heading.shape[1]):
                value = value * z + heading[c, heading.shape[1] - 1 - k]
            slopes[c, i] = value


@loops
def _states(walk: Walk, size: float, lane: int) -> None:
    """At the stages; a chained component from the newest of its speed."""
    start, states, slopes, rate = walk.state[lane], walk.bench[0], walk.bench[1], walk.bench[2, 0]
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
def _end(walk: Walk, landing: _Landing, size: float, lane: int) -> None:
    """State at the end of a step, exactly on its event where there is one."""
    end, slopes = walk.rows[0], walk.bench[1]
    for c in range(end.size):
        end[c] = walk.state[lane, c] + size * _term(walk.rule, ENDS, slopes[c])
    if landing.due >= 0:
        end[landing.component] = walk.state[lane, landing.component] + landing.span


@loops
def _keep(walk: Walk, size: float, lane: int) -> None:
    """Record a step and go to its end."""
    start, step, powers, slopes = walk.state[lane], walk.counts[lane, STEPS], walk.powers, walk.bench[1]
    for c in range(start.size):
        _spread(walk.rule, CHANGE, slopes[c], powers)
        walk.starts[c, step, lane] = start[c]
        for k in range(powers.size):
            walk.steps[k, c, step, lane] = size * powers[k]
        start[c] = walk.rows[0, c]
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
def _slopes(walk: Walk, lane: int, new: FloatArray) -> None:
    """The right-hand side at all stages."""
    own, states = walk.equations, walk.bench[0]
    if own.kind == FLAT:
        _flat(own.numbers[lane], own.branches[lane], states, new)
        return
    _springs(own, own.numbers[lane], states[0], walk.springs)
    if own.kind == PRESSING:
        _pressing(walk.springs, own.numbers[lane], own.branches[lane], states, new)
    else:
        if own.branches.shape[2]:
            _recall(own.memory[lane], own.numbers[lane], states[0], walk.recalled)
        _receding(walk, own.numbers[lane], own.branches[lane], new)


@loops
def _pressing(
    springs: FloatArray, numbers: FloatArray, branches: FloatArray, states: FloatArray, slopes: FloatArray
) -> None:
    """d(state)/d(sigma) on the way in, `equations.Pressing`."""
    count = branches.shape[1]
    for i in range(states.shape[1]):
        g, g_y, k, k_y, moment = springs[0, i], springs[1, i], springs[2, i], springs[3, i], springs[4, i]
        v, gaps = states[2, i], 0.0
        for j in range(count):
            weight, relaxation = branches[0, j], branches[1, j] * g_y
            relaxed, faded = states[3 + j, i], states[3 + count + j, i]
            gaps += k * relaxed - faded
            slopes[3 + j, i] = relaxation * (weight * g - relaxed)
            slopes[3 + count + j, i] = k_y * v * relaxed + relaxation * (weight * moment - faded)
        slopes[0, i], slopes[1, i] = v, g_y * (1.0 - v)
        slopes[2, i] = (k * (g + numbers[VISCOSITY] * v) - (moment + gaps)) * (g_y * -numbers[INERTIA])


@loops
def _receding(walk: Walk, numbers: FloatArray, branches: FloatArray, slopes: FloatArray) -> None:
    """d(state)/d(sigma) on the way back, `equations.Receding`."""
    states, springs, past, count = walk.bench[0], walk.springs, walk.recalled, branches.shape[1]
    long_term, viscosity = numbers[LONG_TERM], numbers[VISCOSITY]
    for i in range(states.shape[1]):
        g, g_y, k, moment = springs[0, i], springs[1, i], springs[2, i], springs[4, i]
        t, delta, v = states[1, i], states[2, i], states[3, i]
        taken, tip, held = 0.0, 0.0, long_term
        for j in range(count):
            weight, rate, relaxed = branches[0, j], branches[1, j], states[4 + j, i]
            history, fading = weight * delta - relaxed, np.exp((past[0, i] + g - t) * rate)
            front = history - fading * (weight * g - past[1 + j, i])
            taken += k * relaxed + fading * (weight * moment - past[1 + count + j, i])
            tip += weight * v - rate * front
            held += weight * fading
            slopes[4 + j, i] = rate * history * g_y
        slowed = -numbers[INERTIA] * (k * (delta + viscosity * v) - (long_term * moment + taken))
        slopes[0, i] = (long_term * v + viscosity * slowed + tip) / held
        slopes[1, i], slopes[2, i], slopes[3, i] = g_y, v * g_y, slowed * g_y


@loops
def _flat(numbers: FloatArray, branches: FloatArray, states: FloatArray, slopes: FloatArray) -> None:
    """d(state)/dt of a flat punch, `flat_punch_equations`."""
    count, long_term, viscosity = branches.shape[1], numbers[LONG_TERM], numbers[VISCOSITY]
    for i in range(states.shape[1]):
        v, slowed = states[3, i], -numbers[INERTIA] * states[0, i]
        rise, lost = long_term * v + viscosity * slowed, viscosity * v**2
        for j in range(count):
            weight, rate, branch = branches[0, j], branches[1, j], states[4 + j, i]
            slopes[4 + j, i] = weight * v - rate * branch
            rise += slopes[4 + j, i]
            lost += rate / weight * branch**2
        slopes[0, i], slopes[1, i], slopes[2, i], slopes[3, i] = rise, 1.0, v, slowed
        slopes[4 + count, i] = numbers[INERTIA] * lost


@loops
def _springs(own: Equations, numbers: FloatArray, y: FloatArray, found: FloatArray) -> None:
    """g, dg/dy, k, dk/dy, P in the lane's units at all stages."""
    panels, powers = own.panels, own.powers
    for i in range(y.size):
        at, panel = y[i] * numbers[UNIT], 0
        while panel < panels.shape[0] - 1 and panels[panel, 0] <= at:
            panel += 1
        z = (at - panels[panel, 1]) * panels[panel, 2]
        g, g_y, k, k_y, moment = 0.0, 0.0, 0.0, 0.0, 0.0
        for n in range(powers.shape[1]):
            g = g * z + powers[panel, n, 0]
            g_y = g_y * z + powers[panel, n, 1]
            k = k * z + powers[panel, n, 2]
            k_y = k_y * z + powers[panel, n, 3]
            moment = moment * z + powers[panel, n, 4]
        found[0, i], found[1, i] = g / numbers[UNIT + 1], g_y / numbers[UNIT + 2]
        found[2, i], found[3, i] = k / numbers[UNIT + 3], k_y / numbers[UNIT + 4]
        found[4, i] = moment / numbers[UNIT + 5]


@loops
def _recall(powers: FloatArray, numbers: FloatArray, y: FloatArray, found: FloatArray) -> None:
    """What the front met on its way in at all stages, `Memory.recall`."""
    for i in range(y.size):
        left = np.sqrt(max(numbers[MEMORY] - y[i] / numbers[MEMORY + 1], 0.0))
        z = numbers[MEMORY + 3] - numbers[MEMORY + 2] * left
        for row in range(powers.shape[0]):
            value = 0.0
            for n in range(powers.shape[1]):
                value = value * z + powers[row, n]
            found[row, i] = value
