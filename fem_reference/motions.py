r"""Motions of a rigid body on a (visco)elastic layer, the contact set solved in every step.

At the end of a step the displacement moments are u = A p + o (`memory`). With the moments f of the profile and w of the
constant one, contact at depth delta is the complementarity problem

    p >= 0,   g = A p - (delta w - f - o) >= 0,   p . g = 0.

Prescribed depths or forces are linear between the given instants. In an impact the body, of mass M, moves by the
trapezoidal rule, hence its kinetic energy changes exactly by the work of the force. The rule gives
``delta_1 = delta_0 + dt v_0 - dt^2 (F_0 + F_1) / (4 M)``, linear in F_1 = w . p_1. Inserted above, it eliminates the
depth: a step is one complementarity problem with the matrix

    A + kappa w w^T,      kappa = dt^2 / (4 M),

and ``delta_0 + dt v_0 - kappa F_0`` in place of delta.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.interpolate import make_interp_spline
from scipy.optimize import brentq

from contact import FlatPunch, InvalidInput, NotConvergedError, Scene, StageLog
from contact.records.validation import BoolArray, FloatArray
from fem_reference.contact_set import Complementary, edge_radius, solve_complementarity
from fem_reference.materials import Parts, relaxation_of
from fem_reference.memory import Modes, Top, compressible_modes, proportional_modes
from fem_reference.mesh import Section
from fem_reference.prescribed_contact import solve_contact
from fem_reference.profiles import ScaledIndenter, shape
from fem_reference.settings import Discretisation, contact_section
from fem_reference.surface import TraceSpace, condense, strip_section

# Steps of an impact after which the body is reported not to come off: five hundred times what an impact at the default
# settings takes.
MAX_STEPS = 200_000
# Duration of the step for a load that jumps at the first instant, over that of the next step.
INSTANT = 1e-7
# Fewest events (a vertex touches or leaves) in a segment whose dashpot force is smoothed.
FEWEST_TOUCHES = 4
# An event within this share of a step counts as at its start.
SLIGHTLY = 1e-6
# Octaves of steps in a segment, the fewest and the most, and the number that all segments of a history share. Steps
# double from octave to octave: after a kink of the load the layer relaxes on every time scale.
FEWEST, MOST, SHARED = 3, 12, 48
# Growth of cells away from a strip of 120 cells. With a growth of one the mesh outside changes peak depths by 5e-5.
OUTSIDE = 0.6
# Tolerance of the outer edge below which cells and steps err more.
TRUNCATION = 1e-7
# Cells of the strip of pilot simulations.
PILOT_CELLS = 30
# A strip fits if the largest contact fills between FITTING and FULL of its radius. The strip of the answer is SPARE
# times the largest contact.
FULL, FITTING, SPARE = 0.9, 0.3, 1.25


@dataclass(frozen=True)
class CondensedLayer:
    """A layer at rest and its indenter, condensed to the contact strip.

    Units: lengths by the strip's radius L, stresses by the instantaneous shear modulus G_0, times in seconds.

    Attributes:
        surface: the layer; it has a memory, so a condensed layer serves one history.
        radii: vertices of the pressures over L, shape (n,); one entry for a flat punch, unless a compressible layer
            relaxes.
        profile: moments ``int phi_i f 2 pi r dr`` of the indenter's profile, shape (n,).
        radius: L [m].
        unknowns: size of the linear system before condensation.
    """

    surface: Top
    radii: FloatArray
    profile: FloatArray
    radius: float
    unknowns: int

    def sample(
        self, time: float, depth: float, velocity: float, pressure: FloatArray, *, dashpot: float = 0.0
    ) -> Sample:
        """The sample at a time [s]: contact radius and force of the pressures (n,), and the layer's energies."""
        top, edge = self.surface, edge_radius(self.radii, pressure)
        force = float(top.resultants @ pressure)
        return Sample(time, depth, velocity, force, edge, top.stored_energy, top.dissipated_energy, dashpot)


class Sample(NamedTuple):
    """One instant of a motion, in the units of its condensed layer.

    Attributes:
        time: t [s].
        depth: delta / L.
        velocity: v / L [1/s], of the body of an impact; zero in a prescribed history.
        force: F / (G_0 L^2).
        radius: a / L.
        stored: energy of the layer over G_0 L^3.
        dissipated: energy lost so far over G_0 L^3.
        dashpot: share of the dashpot in the force, see `Top.dashpot_force`.
    """

    time: float
    depth: float
    velocity: float
    force: float
    radius: float = 0.0
    stored: float = 0.0
    dissipated: float = 0.0
    dashpot: float = 0.0


def columns(samples: Sequence[Sample]) -> dict[str, FloatArray]:
    """Samples as one array per quantity."""
    return dict(zip(Sample._fields, np.array(samples).T, strict=True))


def simulate_impact(condensed: CondensedLayer, mass: float, velocity: float, duration: float) -> list[Sample]:
    """Samples of an impact in equal steps, from first touch to the loss of contact.

    Args:
        condensed: the layer at rest and its indenter.
        mass: M / (G_0 L) [s^2].
        velocity: v_0 / L [1/s].
        duration: of a step [s].

    Raises:
        NotConvergedError: the body never comes off (a layer without long-term elasticity may hold it).
    """
    surface = condensed.surface
    w, kappa = surface.resultants, duration**2 / (4 * mass)
    depth, force, time = 0.0, float(w @ _touch(condensed, velocity, INSTANT * duration)), 0.0
    samples, active, overlaps = [Sample(0.0, 0.0, velocity, force)], None, (0.0, 0.0, 0.0)
    for _ in range(MAX_STEPS):
        matrix, offset = surface.begin(duration)
        ballistic = depth + duration * velocity - kappa * force
        approach = ballistic * w - condensed.profile - offset
        state = solve_complementarity(matrix + kappa * np.outer(w, w), approach, active)
        surface.accept(state.pressure)
        following, overlaps = float(w @ state.pressure), (*overlaps[1:], float((approach / w).max()))
        mean, active = (force + following) / 2, state.active
        is_free = following == 0 and velocity - duration * mean / mass < 0
        # In the last step depth and velocity are interpolated to the instant of release.
        part = duration * (_release_fraction(*overlaps) if is_free else 1.0)
        depth += part * velocity - part * duration * mean / (2 * mass)
        velocity -= part * mean / mass
        force, time = following, time + part
        samples.append(condensed.sample(time, depth, velocity, state.pressure))
        if is_free:
            return samples
    raise NotConvergedError("the body does not come off", {"last_force": force, "last_velocity": velocity})


def _touch(condensed: CondensedLayer, velocity: float, instant: float) -> FloatArray:
    """Pressures (n,) at first touch: a dashpot reacts to the first velocity under the flat part of the profile.

    Without a dashpot there is no force at depth zero. With one it is proportional to the velocity.
    """
    surface = condensed.surface
    if surface.viscosity == 0:
        return np.zeros_like(condensed.profile)
    matrix, offset = surface.begin(instant)
    approach = instant * velocity * surface.resultants - condensed.profile - offset
    pressure = solve_complementarity(matrix, approach).pressure
    surface.accept(pressure)
    return pressure


def _release_fraction(earlier: float, before: float, after: float) -> float:
    """Part of the last step after which contact is lost.

    The overlap is the largest of ``(delta w - f - o) / w``, of the indenter with the surface as it would be without
    pressure. It passes zero smoothly at release, while the force of a round indenter vanishes like its power 3/2. The
    zero of the parabola through three overlaps is taken: the error of a straight line, of second order in the step,
    would depend on where in the step the zero lies, and disturb the comparison of two step sizes.

    Args:
        earlier: overlap one step before the last step.
        before: overlap at its start.
        after: overlap at its end.
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
        An array of instants [s] for each segment, without its start and with its end.
    """
    octaves = int(np.clip(SHARED // (len(time) - 1), FEWEST, MOST))
    steps = np.repeat(2.0 ** np.arange(octaves), per_octave)
    shares = np.cumsum(steps) / steps.sum()
    # The last instant is the given one, to the bit.
    shares[-1] = 1.0
    return [t0 * (1.0 - shares) + t1 * shares for t0, t1 in pairwise(time)]


def simulate_prescribed(
    condensed: CondensedLayer, time: FloatArray, values: FloatArray, steps: Sequence[FloatArray], *, by_depth: bool
) -> list[Sample]:
    """Response to depths or forces that are linear between the given instants; a first load above zero acts at once.

    Args:
        condensed: the layer at rest and its indenter.
        time: instants [s].
        values: depths or forces at these instants, in the units of the condensed layer.
        steps: ends of the steps of each segment [s].
        by_depth: whether ``values`` are depths.

    Raises:
        NotConvergedError: no depth carries the force.
    """
    samples: list[Sample] = []
    surface, depth = condensed.surface, 0.0
    active: BoolArray | None = None

    def advance(duration: float, load: float) -> FloatArray:
        """Pressures (n,) at the end of a step [s] to this load; memory, depth and active set are updated."""
        nonlocal depth, active
        matrix, offset = surface.begin(duration)
        gap = condensed.profile + offset
        if by_depth:
            state, depth = solve_complementarity(matrix, load * surface.resultants - gap, active), load
        else:
            state, depth = _depth_of_force(matrix, surface.resultants, gap, load, depth)
        surface.accept(state.pressure)
        active = state.active
        return state.pressure

    pressure = np.zeros_like(condensed.profile)
    if values[0] > 0:
        pressure = advance(INSTANT * float(steps[0][0] - time[0]), float(values[0]))
    samples.append(condensed.sample(float(time[0]), float(values[0]) if by_depth else depth, 0.0, pressure))
    for ends, (t0, t1), (v0, v1) in zip(steps, pairwise(time), pairwise(values), strict=True):
        if by_depth:
            surface.restart()
        marks: list[tuple[float, float]] = []
        active, first = None, len(samples)
        for before, now in pairwise([t0, *ends]):
            load = v1 if now == t1 else v0 + (v1 - v0) * (now - t0) / (t1 - t0)
            if by_depth and surface.viscosity and v1 > v0 and active is not None:
                rate = (v1 - v0) / (t1 - t0)
                pressure, active, found = touch_to_touch(condensed, depth, rate, active, float(now - before))
                marks += [(before + after, force) for after, force in found]
                depth = float(load)
            else:
                pressure = advance(float(now - before), float(load))
            samples.append(condensed.sample(float(now), depth, 0.0, pressure, dashpot=surface.dashpot_force))
        samples[first:] = smooth_dashpot(samples[first:], marks)
    return samples


def smooth_dashpot(samples: list[Sample], marks: Sequence[tuple[float, float]]) -> list[Sample]:
    """Samples of a segment, the dashpot's share of the force made piecewise linear in time.

    Between two events (a vertex touches or leaves) the computed share is constant and correct in the middle of the
    interval. These values are interpolated, and replace the computed ones.

    Args:
        samples: of the segment.
        marks: the instant [s] of each event in the segment, and the dashpot's force in the interval before it.
    """
    if len(marks) < FEWEST_TOUCHES:
        return samples
    ends, forces = np.array(marks).T
    middles, time = (ends[1:] + ends[:-1]) / 2, columns(samples)["time"]
    smooth = make_interp_spline(middles, forces[1:], k=1)(time)
    return [
        each if each.time < middles[0] else each._replace(force=max(0.0, each.force + float(force) - each.dashpot))
        for each, force in zip(samples, smooth, strict=True)
    ]


def touch_to_touch(
    condensed: CondensedLayer, depth: float, rate: float, active: BoolArray, duration: float
) -> tuple[FloatArray, BoolArray, list[tuple[float, float]]]:
    """A step under a growing depth in parts that end where a vertex touches or leaves, for a layer with a dashpot.

    While the set of pressed vertices is fixed, pressures and displacements are linear in the depth, as in a flat punch.
    The force of a dashpot is proportional to the rate of the depth and to the stiffness dF/d(delta), which on cells is
    a staircase: it jumps where a vertex touches. Steps across a jump would give the force an error of the order of the
    cell.

    Args:
        condensed: the layer, whose memory moves on, and its indenter.
        depth: at the start.
        rate: of the depth.
        active: pressed vertices at the start.
        duration: of the step [s].

    Returns:
        Pressures (n,) and pressed vertices (n,) at the end, and for each event the time since the start of the step [s]
        and the dashpot's force before it.
    """
    touches: list[tuple[float, float]] = []
    surface, elapsed, active = condensed.surface, 0.0, active.copy()

    def problem(part: float) -> tuple[FloatArray, FloatArray]:
        """Compliance A and approach delta w - f - o after a part [s], one Euler step of the dashpot."""
        surface.restart()
        matrix, offset = surface.begin(part)
        return matrix, (depth + rate * (elapsed + part)) * surface.resultants - condensed.profile - offset

    def held(part: float) -> tuple[FloatArray, FloatArray]:
        """Pressures with the active set fixed after a part [s], and slacks (n,), negative where the set is wrong.

        The slack is p_i A_ii at a pressed vertex and the gap g_i at a free one; a margin for roundings is added.
        """
        matrix, approach = problem(part)
        pressure = np.zeros_like(approach)
        if active.any():
            pressure[active] = np.linalg.solve(matrix[np.ix_(active, active)], approach[active])
        slack = np.where(active, matrix.diagonal() * pressure, matrix @ pressure - approach)
        return pressure, slack + 1e-11 * np.abs(approach).max()

    def least(part: float) -> float:
        """Smallest slack: its zero is the next event."""
        return float(held(part)[1].min())

    for _ in range(2 * len(active)):
        left = duration - elapsed
        pressure, slack = held(left)
        if slack.min() >= 0.0:
            surface.accept(pressure)
            return np.maximum(pressure, 0.0), active, touches
        # A part of zero where a vertex touches or leaves at the start.
        first = SLIGHTLY * left
        part = 0.0 if least(first) < 0.0 else float(brentq(least, first, left, xtol=0.1 * first, rtol=1e-7))
        wrong = held(min(left, part + first))[1] < 0.0
        if part:
            surface.accept(held(part)[0])
            elapsed += part
            touches.append((elapsed, surface.dashpot_force))
        active ^= wrong
    # Too many events: the rest of the step is one complementarity problem.
    state = solve_complementarity(*problem(duration - elapsed), active)
    surface.accept(state.pressure)
    return state.pressure, state.active, touches


def _depth_of_force(
    matrix: FloatArray, w: FloatArray, gap: FloatArray, force: float, depth: float
) -> tuple[Complementary, float]:
    """Contact under a given force F, and its depth: Newton's method on the convex, piecewise linear F(delta).

    On the active vertices A p = delta w - gap, hence dF/d(delta) = w . A^-1 w. Without force the indenter stays at its
    last depth, unless the recovering surface lifts it.

    Args:
        matrix: A, shape (n, n).
        w: moments of one, shape (n,).
        gap: f + o, moments of the profile and of the surface without pressure, shape (n,).
        force: F.
        depth: first guess.

    Raises:
        NotConvergedError: no depth carries the force.
    """
    # The depth of first touch.
    least = float(np.min(gap / w))
    if force == 0:
        return solve_complementarity(matrix, np.minimum(least * w - gap, 0.0)), min(depth, least)
    depth, change = max(depth, least + 1e-9 * abs(least) + 1e-15), np.inf
    for _ in range(60):
        state = solve_complementarity(matrix, depth * w - gap)
        defect = force - float(w @ state.pressure)
        # A small force cannot be met better than its depth is rounded, where o is large.
        if abs(defect) <= 1e-10 * force or abs(change) <= 1e-14 * abs(depth):
            return state, depth
        act = state.active if state.active.any() else gap / w <= depth + 1e-12
        block = matrix[np.ix_(act, act)]
        change = defect / float(w[act] @ np.linalg.solve(block, w[act]))
        depth += change
    raise NotConvergedError("no depth carries the prescribed force", {"force_defect": defect})


class Resolution(NamedTuple):
    """How finely a motion is resolved.

    Attributes:
        cells: cells of the strip.
        steps: equal time steps of an impact.
        per_octave: steps of each octave of a segment of a history.
    """

    cells: int
    steps: int
    per_octave: int


class HistorySetup:
    """Condensed layers of one scene at one resolution, a fresh one for every motion that is simulated."""

    def __init__(self, scene: Scene, settings: Discretisation, log: StageLog) -> None:
        self.scene, self.log, self.relaxation = scene, log, relaxation_of(scene)
        self._settings = replace(settings, truncation=max(settings.truncation, TRUNCATION * settings.coarsening**6))
        self._modes: dict[tuple[float, int], Modes] = {}
        relaxes = bool(np.any(self.relaxation.moduli)) or self.relaxation.viscosity > 0
        self._needs_field = relaxes and scene.layer.poissons_ratio < 0.5

    @classmethod
    def resolutions(
        cls, scene: Scene, settings: Discretisation, log: StageLog
    ) -> list[tuple[HistorySetup, Resolution]]:
        """Setups with resolutions of half the cells and half the steps, of half the cells only, and of the answer.

        In a history half the steps end at every other instant of the full ones, see `segments`. The two differences
        measure the errors of the cells and of the steps apart from each other.
        """
        coarser, setup = (cls(scene, each, log) for each in (settings.coarser(), settings))
        cells, steps, octave = (max(a, round(b / settings.growth)) for a, b in ((10, 30), (20, 100), (2, 4)))
        half_both, half_cells = Resolution(cells, steps, octave), Resolution(cells, 2 * steps, 2 * octave)
        return [(coarser, half_both), (coarser, half_cells), (setup, Resolution(2 * cells, 2 * steps, 2 * octave))]

    def condensed(self, radius: float, cells: int) -> CondensedLayer:
        """The layer at rest with a strip of ``radius`` [m]."""
        if (radius, cells) not in self._modes:
            self._modes[radius, cells] = self._condensed_modes(radius, cells)
        modes = self._modes[radius, cells]
        space, indenter = TraceSpace(modes.radii, 1), self.scene.indenter
        profile = np.zeros(1)
        if len(modes.radii) > 1:
            inside = np.minimum(space.gauss(4)[0] * radius, min(radius, indenter.max_radius))
            profile = space.moments(shape(indenter, inside).height / radius, 4)
        return CondensedLayer(Top(modes, self.relaxation), modes.radii, profile, radius, modes.unknowns)

    def _condensed_modes(self, radius: float, cells: int) -> Modes:
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
        return proportional_modes(strip.pressed * per_shear, strip.resultants, strip.radii, strip.unknowns)

    def _mesh(self, radius: float, cells: int) -> tuple[Parts, Section]:
        layer, indenter = self.scene.layer, self.scene.indenter
        with self.log.stage("mesh"):
            if isinstance(indenter, FlatPunch):
                settings = replace(self._settings, edge_cell=1e-4 * self._settings.coarsening**6)
                return contact_section(layer, ScaledIndenter(indenter, radius), settings)
            return strip_section(layer, radius, cells, indenter.kinks, self._settings, outside=OUTSIDE)

    def fitted_radius(
        self, guess: float, simulate: Callable[[CondensedLayer], list[Sample]]
    ) -> tuple[float, list[Sample]]:
        """Radius [m] of a strip a quarter larger than the largest contact, and the samples of the last pilot.

        Args:
            guess: first radius of a strip [m].
            simulate: samples of the motion on a condensed layer.

        Raises:
            InvalidInput: contact reaches the end of the profile.
            NotConvergedError: no strip fits, or no step presses.
        """
        indenter = self.scene.indenter
        if isinstance(indenter, FlatPunch):
            return indenter.radius, simulate(self.condensed(indenter.radius, PILOT_CELLS))
        radius = min(guess, indenter.max_radius)
        for _ in range(12):
            record = simulate(self.condensed(radius, PILOT_CELLS))
            largest = max(sample.radius for sample in record)
            if largest == 0:
                raise NotConvergedError(
                    "the pilot simulation presses at no step: a strong dashpot stops the body, or nothing presses"
                )
            if largest > FULL and radius >= indenter.max_radius:
                raise InvalidInput(f"contact reaches the end of the profile at {radius:g} m; load less")
            if FITTING <= largest <= FULL:
                return min(SPARE * largest * radius, indenter.max_radius), record
            radius = min(1.6 * radius, indenter.max_radius) if largest > FULL else radius * max(1.5 * largest, 0.1)
        raise NotConvergedError("no strip of the surface fits the contact", {"strip_radius": radius})
