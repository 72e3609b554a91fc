r"""Motions of a rigid body on a (visco)elastic layer, the contact set solved in every step.

At the end of a step the displacement moments are u = A p + o (`memory`). With the moments f of the profile and w of the
constant one, contact at depth delta is the complementarity problem

    p >= 0,   g = A p - (delta w - f - o) >= 0,   p . g = 0.

Prescribed depths or forces are linear between the given instants. In an impact the body, of mass M, moves by the
trapezoidal rule, hence its kinetic energy changes exactly by the work of the force. The rule gives
``delta_1 = delta_0 + dt v_0 - dt^2 (F_0 + F_1) / (4 M)``, linear in F_1 = w . p_1. Depth and force of a step then obey

    delta + kappa F = reach,      kappa = dt^2 / (4 M),      reach = delta_0 + dt v_0 - kappa F_0,

as if the layer were pressed through a spring of compliance kappa. Prescribed depths, prescribed forces and impacts
differ in this load line alone (`contact_set.LoadLine`), which determines the depth on every set of pressed vertices.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple, Self

import numpy as np

from contact import FlatPunch, InvalidInput, NotConvergedError, Scene, StageLog
from contact.records.validation import BoolArray, FloatArray
from fem_reference.contact_set import LoadLine, edge_radius, pressure_on, solve_complementarity, solve_on_line
from fem_reference.materials import Parts, ShearRelaxation, relaxation_of
from fem_reference.memory import Modes, Top, compressible_modes, proportional_modes
from fem_reference.mesh import Section
from fem_reference.prescribed_contact import solve_contact
from fem_reference.profiles import ScaledIndenter
from fem_reference.settings import Discretisation, contact_section
from fem_reference.surface import FILLED, TraceSpace, condense, strip_section

# Largest number of steps of an impact; then the body counts as not coming off. It is five hundred times the number at
# the default settings.
MAX_STEPS = 200_000
# Duration of the step for a load that jumps at the first instant, over that of the next step.
INSTANT = 1e-7
# Fewest events (a vertex touches or leaves) in a segment whose dashpot force is smoothed.
FEWEST_EVENTS = 4
# Events closer than this share of a step are one event. With a hundredth of it roundings split events, and forces on a
# dashpot err ten times as much. With a hundred times as much they are the same.
SLIGHTLY = 1e-6
# Largest number of secants to the next event: one or two are needed where moduli relax in proportion, else up to four.
MOST_SECANTS = 20
# Octaves of steps in a segment, the fewest and the most, and the number that all segments of a history share. Steps
# double from octave to octave: after a kink of the load the layer relaxes on every time scale.
FEWEST, MOST, SHARED = 3, 12, 48
# Growth of cells away from a strip of 120 cells. With a growth of one the mesh outside changes peak depths by 5e-5.
OUTSIDE = 0.6
# Tolerance of the outer edge below which cells and steps err more.
TRUNCATION = 1e-7
# Cells of the strip of pilot simulations.
PILOT_CELLS = 30
# A strip fits if the largest contact fills between FITTING and `FILLED` of its radius. The strip of the answer is SPARE
# times the largest contact.
FITTING, SPARE = 0.3, 1.25


@dataclass(frozen=True)
class Strip:
    """A layer at rest and its indenter, condensed to the contact strip.

    Units: lengths by the strip's radius L, stresses by the instantaneous shear modulus G_0, times in seconds.

    Attributes:
        modes: modes of the layer; a flat punch has one vertex, unless a compressible layer relaxes.
        relaxation: shear relaxation of the layer.
        profile: moments ``int phi_i f 2 pi r dr`` of the indenter's profile, shape (n,).
        radius: radius L of the strip [m].
    """

    modes: Modes
    relaxation: ShearRelaxation
    profile: FloatArray
    radius: float


class Motion(NamedTuple):
    """Quantities at the instants of a motion, each of shape (instant,), in the units of its `Strip`.

    Attributes:
        time: instants t [s].
        depth: indentation depth delta / L.
        velocity: velocity v / L [1/s] of the body in an impact; zero in a prescribed history.
        force: normal force F / (G_0 L^2).
        radius: contact radius a / L.
        stored: stored energy of the layer over G_0 L^3.
        dissipated: energy dissipated since the start over G_0 L^3.
        dashpot: share of the dashpot in the force, see `Top.dashpot_force`.
    """

    time: FloatArray
    depth: FloatArray
    velocity: FloatArray
    force: FloatArray
    radius: FloatArray
    stored: FloatArray
    dissipated: FloatArray
    dashpot: FloatArray


class Record:
    """A motion during its simulation: the layer with its memory, and one row of `Motion` per instant."""

    def __init__(self, strip: Strip) -> None:
        self.strip, self.top, self.rows = strip, Top(strip.modes, strip.relaxation), list[tuple[float, ...]]()

    def add(self, time: float, depth: float, velocity: float, pressure: FloatArray) -> None:
        """Add a row after a step of the layer whose pressures at the end are ``pressure`` (n,)."""
        top, edge = self.top, edge_radius(self.strip.modes.radii, pressure)
        force = float(top.resultants @ pressure)
        energies = top.stored_energy, top.dissipated_energy
        self.rows.append((time, depth, velocity, force, edge, *energies, top.dashpot_force))

    @property
    def motion(self) -> Motion:
        """The motion from the rows added so far."""
        return Motion(*np.array(self.rows).T)


def simulate_impact(strip: Strip, mass: float, velocity: float, duration: float) -> Motion:
    """Motion of an impact in equal steps, from first touch to the loss of contact.

    The last step ends where contact is lost, after a part of ``duration``. There the pressure is zero. The rules of
    the step are the same: the work of the force still equals the change of the kinetic energy, and the energies of the
    layer are those at the loss of contact.

    Args:
        strip: the layer at rest and its indenter.
        mass: M / (G_0 L) [s^2].
        velocity: v_0 / L [1/s].
        duration: length of a step [s].

    Raises:
        NotConvergedError: the body never comes off, as on some layers without long-term elasticity.
    """
    record, active, overlaps = Record(strip), None, (0.0, 0.0, 0.0)
    top, depth, time, kappa = record.top, 0.0, 0.0, duration**2 / (4 * mass)
    w = top.resultants
    record.add(time, depth, velocity, _first_pressure(record, velocity, INSTANT * duration))
    for _ in range(MAX_STEPS):
        force = record.rows[-1][3]
        matrix, offset = top.begin(duration)
        # Depths are counted from that at the start of the step: sums with the memory of a dashpot would cancel.
        reach, gap = duration * velocity - kappa * force, strip.profile + offset - depth * w
        overlap = reach - gap / w
        start = overlap > 0 if active is None else active
        (pressure, active), _ = solve_on_line(matrix, gap, w, LoadLine(1.0, kappa, reach), start)
        mean, overlaps = (force + float(w @ pressure)) / 2, (*overlaps[1:], float(overlap.max()))
        is_free, part = not pressure.any() and velocity < duration * mean / mass, duration
        if is_free:
            part *= _release_fraction(*overlaps)
            top.begin(part)
        top.accept(pressure)
        depth += part * velocity - part**2 * mean / (2 * mass)
        velocity, time = velocity - part * mean / mass, time + part
        record.add(time, depth, velocity, pressure)
        if is_free:
            return record.motion
    raise NotConvergedError("the body does not come off", {"last_force": force, "last_velocity": velocity})


def _first_pressure(record: Record, velocity: float, instant: float) -> FloatArray:
    """Pressures (n,) at first touch: a dashpot reacts to the first velocity under the flat part of the profile.

    Without a dashpot there is no force at depth zero. With one it is proportional to the velocity.
    """
    top, profile = record.top, record.strip.profile
    if top.viscosity == 0:
        return np.zeros_like(profile)
    matrix, offset = top.begin(instant)
    pressure = solve_complementarity(matrix, instant * velocity * top.resultants - profile - offset).pressure
    top.accept(pressure)
    return pressure


def _release_fraction(earlier: float, before: float, after: float) -> float:
    """Part of the last step after which contact is lost.

    The overlap is the largest of ``(delta w - f - o) / w``, of the indenter with the surface without pressure. It
    passes zero smoothly at release, while the force of a round indenter vanishes like its power 3/2. The result is the
    zero of the parabola through three overlaps. The error of a straight line, of second order in the step, would depend
    on where in the step the zero lies, and disturb the comparison of two step sizes.

    Args:
        earlier: overlap one step before the last step.
        before: overlap at the start of the last step.
        after: overlap at the end of the last step.
    """
    if not before > 0 > after:
        return 1.0
    slope, bend = (after - earlier) / 2, (after - 2 * before + earlier) / 2
    return float(2 * before / (-slope + np.sqrt(slope**2 - 4 * bend * before)))


def segments(time: FloatArray, per_octave: int) -> list[FloatArray]:
    """Ends of the steps of each segment between given instants [s].

    M equal steps are followed by M twice as long, and so on. With M/2 the ends are every other one of these, so that a
    companion with half the steps is compared at common instants.

    Args:
        time: given instants [s].
        per_octave: M, even in an answer, and M/2 in its companion.

    Returns:
        An array of instants [s] per segment, without its start and with its end.
    """
    octaves = int(np.clip(SHARED // (len(time) - 1), FEWEST, MOST))
    steps = np.repeat(2.0 ** np.arange(octaves), per_octave)
    shares = np.cumsum(steps) / steps.sum()
    # The last instant equals the given one exactly.
    shares[-1] = 1.0
    return [t0 * (1.0 - shares) + t1 * shares for t0, t1 in pairwise(time)]


def simulate_prescribed(
    strip: Strip, time: FloatArray, values: FloatArray, steps: Sequence[FloatArray], *, by_depth: bool
) -> Motion:
    """Response to depths or forces that are linear between the given instants; a first load above zero acts at once.

    Args:
        strip: the layer at rest and its indenter.
        time: instants [s].
        values: depths or forces at these instants, in the units of the strip.
        steps: ends of the steps of each segment [s].
        by_depth: whether ``values`` are depths.

    Raises:
        NotConvergedError: no depth has the prescribed force.
    """
    record, depth = Record(strip), float(values[0]) if by_depth else 0.0
    top, pressure = record.top, np.zeros_like(strip.profile)
    active = np.zeros(len(pressure), dtype=bool)

    def advance(duration: float, load: float) -> None:
        """Step of a duration [s] to a depth or force at its end."""
        nonlocal depth, pressure, active
        matrix, offset = top.begin(duration)
        w = top.resultants
        gap = strip.profile + offset - depth * w
        distances = gap / w
        if by_depth or load > 0:
            line = LoadLine(1.0, 0.0, load - depth) if by_depth else LoadLine(0.0, 1.0, load)
            start = active if active.any() else distances == distances.min()
            (pressure, active), change = solve_on_line(matrix, gap, w, line, start)
        else:
            # Without a force the indenter stays at its last depth, unless the recovering surface pushes it up.
            pressure, change = np.zeros_like(gap), min(0.0, float(distances.min()))
        depth = load if by_depth else depth + change
        top.accept(pressure)

    if values[0] > 0:
        advance(INSTANT * float(steps[0][0] - time[0]), float(values[0]))
    record.add(float(time[0]), depth, 0.0, pressure)
    for ends, (t0, t1), (v0, v1) in zip(steps, pairwise(time), pairwise(values), strict=True):
        if by_depth:
            top.restart()
        rate, events, first = (v1 - v0) / (t1 - t0), list[tuple[float, float]](), len(record.rows)
        for before, now in pairwise([t0, *ends]):
            load = float(v1 if now == t1 else v0 + rate * (now - t0))
            if by_depth and top.viscosity and rate > 0 and now > ends[0]:
                pressure, active, new_events = from_event_to_event(record, depth, rate, active, float(now - before))
                events += [(before + after, force) for after, force in new_events]
                depth = load
            else:
                advance(float(now - before), load)
            record.add(float(now), depth, 0.0, pressure)
        record.rows[first:] = smooth_dashpot(record.rows[first:], events)
    return record.motion


def smooth_dashpot(rows: list[tuple[float, ...]], events: Sequence[tuple[float, float]]) -> list[tuple[float, ...]]:
    """Rows of a segment with the dashpot's share of the force as a piecewise linear function of time.

    Between two events the computed share is constant and correct in the middle of the interval. These values are
    interpolated, and replace the computed ones.

    Args:
        rows: rows of `Motion`.
        events: instant [s] of each event in the segment, and the dashpot's force in the interval before it.
    """
    if len(events) < FEWEST_EVENTS:
        return rows
    from scipy.interpolate import make_interp_spline  # noqa: PLC0415 - takes 0.1 s to import

    ends, forces = np.array(events).T
    middles, motion = (ends[1:] + ends[:-1]) / 2, Motion(*np.array(rows).T)
    smooth = make_interp_spline(middles, forces[1:], k=1)(motion.time)
    force = np.maximum(0.0, motion.force + smooth - motion.dashpot)
    smoothed = motion._replace(force=np.where(motion.time < middles[0], motion.force, force))
    return list(zip(*smoothed, strict=True))


def from_event_to_event(
    record: Record, depth: float, rate: float, active: BoolArray, duration: float
) -> tuple[FloatArray, BoolArray, list[tuple[float, float]]]:
    """A step under a growing depth in parts that end where a vertex touches or leaves, for a layer with a dashpot.

    While the set of pressed vertices is fixed, pressures and displacements are linear in the depth, as in a flat punch.
    The force of a dashpot is proportional to the rate of the depth and to the stiffness dF/d(delta), which on cells is
    a staircase: it jumps where a vertex touches. Steps across a jump would give the force an error of the order of the
    cell.

    The slack of a vertex is p_i A_ii where it is pressed and the gap g_i where it is free. It is negative where the set
    is wrong. The next event is the first zero of a slack. The secant through two instants gives it exactly where
    moduli relax in proportion, else after a few repetitions (regula falsi).

    Args:
        record: the motion so far; the memory of its layer advances.
        depth: depth at the start, over L.
        rate: rate of the depth [1/s].
        active: pressed vertices at the start, shape (n,).
        duration: length of the step [s].

    Returns:
        Pressures (n,) and pressed vertices (n,) at the end, and for each event the time since the start of the step [s]
        and the dashpot's force before it.
    """
    events: list[tuple[float, float]] = []
    top, elapsed, active = record.top, 0.0, active.copy()

    def problem(part: float) -> tuple[FloatArray, FloatArray]:
        """Compliance A and approach delta w - f - o after a part [s] of the step, by one Euler step of the dashpot."""
        top.restart()
        matrix, offset = top.begin(part)
        return matrix, (depth + rate * (elapsed + part)) * top.resultants - record.strip.profile - offset

    def fixed(part: float) -> tuple[FloatArray, FloatArray]:
        """Pressures and slacks (n,) after a part [s] with a fixed active set; slacks have a margin for rounding."""
        matrix, approach = problem(part)
        pressure = pressure_on(matrix, approach, active)
        slack = np.where(active, matrix.diagonal() * pressure, matrix @ pressure - approach)
        return pressure, slack + 1e-11 * np.abs(approach).max()

    for _ in range(2 * len(active)):
        remaining = duration - elapsed
        pressure, late_slack = fixed(remaining)
        if late_slack.min() >= 0.0:
            top.accept(pressure)
            return np.maximum(pressure, 0.0), active, events
        part, tiny = 0.0, SLIGHTLY * remaining
        early_slack = fixed(tiny)[1]
        wrong = early_slack < 0.0
        # If a slack is negative at the start, the set changes there.
        if not wrong.any():
            part, wrong, pressure = _first_zero(fixed, (tiny, early_slack), (remaining, late_slack), tiny)
            top.accept(pressure)
            elapsed += part
            events.append((elapsed, top.dashpot_force))
        active ^= wrong
    # Too many events: the rest of the step is one complementarity problem.
    state = solve_complementarity(*problem(duration - elapsed), active)
    top.accept(state.pressure)
    return state.pressure, state.active, events


def _first_zero(
    fixed: Callable[[float], tuple[FloatArray, FloatArray]],
    low: tuple[float, FloatArray],
    high: tuple[float, FloatArray],
    tiny: float,
) -> tuple[float, BoolArray, FloatArray]:
    """Instant of the first zero of the slacks, the vertices (n,) that reach it, and the pressures (n,) there.

    Args:
        fixed: function that returns pressures and slacks at an instant [s].
        low: instant at which no slack is negative, and the slacks there.
        high: later instant at which a slack is negative, and the slacks there.
        tiny: accuracy of the instant [s].
    """
    (t0, early_slack), (t1, late_slack), instant = low, high, low[0]
    pressure = fixed(t0)[0]
    for _ in range(MOST_SECANTS):
        zeros = np.full(len(late_slack), np.inf)
        falls = late_slack < 0.0
        zeros[falls] = t0 + (t1 - t0) * early_slack[falls] / (early_slack - late_slack)[falls]
        if abs(zeros.min() - instant) <= tiny:
            break
        instant = float(zeros.min())
        pressure, slack = fixed(instant)
        if slack.min() < 0.0:
            t1, late_slack = instant, slack
        else:
            t0, early_slack = instant, slack
    return instant, zeros <= instant + 2 * tiny, pressure


class Resolution(NamedTuple):
    """Numbers of cells and steps of a motion.

    Attributes:
        cells: cells of the strip.
        steps: equal time steps of an impact.
        per_octave: steps of each octave of a segment of a history.
    """

    cells: int
    steps: int
    per_octave: int


class HistorySetup:
    """Strips of one scene at one resolution, cached."""

    def __init__(self, scene: Scene, settings: Discretisation, log: StageLog) -> None:
        self.scene, self.log, self.relaxation = scene, log, relaxation_of(scene)
        self._settings = replace(settings, truncation=max(settings.truncation, TRUNCATION * settings.coarsening**6))
        self._strips: dict[tuple[float, int], Strip] = {}
        relaxes = bool(np.any(self.relaxation.moduli)) or self.relaxation.viscosity > 0
        self._needs_field = relaxes and scene.layer.poissons_ratio < 0.5

    @classmethod
    def resolutions(cls, scene: Scene, settings: Discretisation, log: StageLog) -> list[tuple[Self, Resolution]]:
        """Setups with resolutions of half the cells and half the steps, of half the cells only, and of the answer.

        In a history half the steps end at every other instant of the full ones, see `segments`. The two differences
        measure the errors of the cells and of the steps apart from each other.
        """
        coarser, setup = (cls(scene, each, log) for each in (settings.coarser(), settings))
        cells, steps, octave = (max(a, round(b / settings.growth)) for a, b in ((10, 30), (20, 100), (2, 4)))
        half_both, half_cells = Resolution(cells, steps, octave), Resolution(cells, 2 * steps, 2 * octave)
        return [(coarser, half_both), (coarser, half_cells), (setup, Resolution(2 * cells, 2 * steps, 2 * octave))]

    def strip(self, radius: float, cells: int) -> Strip:
        """The layer at rest and the indenter on a strip of ``radius`` [m] with ``cells`` cells."""
        if (radius, cells) not in self._strips:
            modes, indenter, profile = self._modes(radius, cells), self.scene.indenter, np.zeros(1)
            if len(modes.radii) > 1:
                space = TraceSpace(modes.radii, 1)
                profile = space.moments(ScaledIndenter(indenter, radius).height(space.gauss(4)[0]), 4)
            self._strips[radius, cells] = Strip(modes, self.relaxation, profile, radius)
        return self._strips[radius, cells]

    def _modes(self, radius: float, cells: int) -> Modes:
        """Modes of a strip of ``radius`` [m]; a factor G/E* turns compliances at E* = 1 into those at G = 1."""
        per_shear = (1 - self.scene.layer.poissons_ratio) / 2  # E* = 2 G / (1 - nu)
        if self._needs_field:
            with self.log.stage("factor"):
                return compressible_modes(*self._mesh(radius, cells))
        if isinstance(self.scene.indenter, FlatPunch):
            # All points have the same depth: F is the only unknown, and 1 / k_N its compliance.
            contact = solve_contact(self.scene, radius, self._settings, self.log)
            compliance = np.array([[per_shear / contact.stiffness]])
            return proportional_modes(compliance, np.ones(1), np.ones(1), contact.unknowns)
        strip = condense(*self._mesh(radius, cells), self.log)
        return proportional_modes(strip.compliance * per_shear, strip.resultants, strip.radii, strip.unknowns)

    def _mesh(self, radius: float, cells: int) -> tuple[Parts, Section]:
        """Material and mesh of a strip of ``radius`` [m], in units of it; graded at the edge of a flat punch."""
        layer, indenter = self.scene.layer, self.scene.indenter
        with self.log.stage("mesh"):
            if isinstance(indenter, FlatPunch):
                settings = replace(self._settings, edge_cell=1e-4 * self._settings.coarsening**6)
                return contact_section(layer, ScaledIndenter(indenter, radius), settings)
            return strip_section(layer, radius, cells, indenter.kinks, self._settings, outside=OUTSIDE)

    def fitted_radius(self, guess: float, simulate: Callable[[Strip], Motion]) -> tuple[float, Motion]:
        """Radius [m] of a strip a quarter larger than the largest contact, and the motion on the last pilot strip.

        Args:
            guess: first radius of a strip [m].
            simulate: function that returns the motion on a strip.

        Raises:
            InvalidInput: contact reaches the end of the profile.
            NotConvergedError: no strip fits, or the pilot has no step with contact.
        """
        indenter = self.scene.indenter
        if isinstance(indenter, FlatPunch):
            return indenter.radius, simulate(self.strip(indenter.radius, PILOT_CELLS))
        radius = min(guess, indenter.max_radius)
        for _ in range(12):
            motion = simulate(self.strip(radius, PILOT_CELLS))
            largest = float(motion.radius.max())
            if largest == 0:
                raise NotConvergedError(
                    "the pilot simulation has no step with contact: a strong dashpot stops the body, or no load presses"
                )
            if largest > FILLED and radius >= indenter.max_radius:
                raise InvalidInput(f"contact reaches the end of the profile at {radius:g} m; load less")
            if FITTING <= largest <= FILLED:
                return min(SPARE * largest * radius, indenter.max_radius), motion
            radius = min(1.6 * radius, indenter.max_radius) if largest > FILLED else radius * max(1.5 * largest, 0.1)
        raise NotConvergedError("no strip of the surface fits the contact", {"strip_radius": radius})
