r"""Motions of a rigid body on a (visco)elastic layer, the contact set solved in every step.

Prescribed depths or forces are linear between the given instants.  In an impact the trapezoidal rule for the body makes
kinetic energy and work balance exactly.  It gives
``delta_1 = delta_0 + dt v_0 - dt^2 (F_0 + F_1) / (4 M)``, linear in F_1 = w . p_1; inserted into the contact conditions
the depth disappears, and a step is one complementarity problem with the matrix

    A + kappa w w^T,      kappa = dt^2 / (4 M).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Self

import numpy as np

from contact import FlatPunch, InvalidInput, NotConvergedError, Scene, StageLog
from contact.records.validation import BoolArray, FloatArray
from fem_reference.contact_set import Complementary, edge_radius, solve_complementarity
from fem_reference.materials import Parts, relaxation_of
from fem_reference.memory import Modes, Top, compressible_modes, proportional_modes
from fem_reference.mesh import Section
from fem_reference.prescribed_contact import solve_contact
from fem_reference.profiles import ScaledIndenter, shape
from fem_reference.settings import Discretisation, contact_section
from fem_reference.surface import condense, strip_section
from fem_reference.trace import TraceSpace

# Steps after which a body counts as held by the layer: five hundred times what an impact at the default settings takes.
MAX_STEPS = 200_000
# The step in which a load that acts from the first instant is reached, over the step after it.
INSTANT = 1e-7
# Octaves of steps in a segment, the fewest and the most, and those that all segments share: every time scale after a
# bend has its own steps.
FEWEST, MOST, SHARED = 3, 12, 48
# Growth of cells away from a strip of 120 cells. With a growth of one the mesh outside changes peak depths by 5e-5.
OUTSIDE = 0.6
# Tolerance of the outer edge below which cells and steps err more.
TRUNCATION = 1e-7
# Cells of the strip of pilot simulations.
PILOT_CELLS = 30
# Share of a pilot's strip that a contact may fill, and from which on it fits; the strip of the answer is larger than
# the contact by the last factor.
FULL, FITTING, SPARE = 0.9, 0.3, 1.25


@dataclass(frozen=True)
class CondensedLayer:
    """A layer at rest and its indenter, condensed to the contact strip.

    Units: lengths by the strip's radius L, stresses by the instantaneous shear modulus G_0, times in seconds.

    Attributes:
        surface: the layer; it has a memory, so a condensed layer serves one history.
        radii: vertices of the pressures, shape (n,); one entry for a flat punch.
        profile: moments ``int phi_i f 2 pi r dr`` of the indenter's profile, shape (n,).
        radius: L [m].
        unknowns: size of the condensed system.
    """

    surface: Top
    radii: FloatArray
    profile: FloatArray
    radius: float
    unknowns: int


@dataclass(frozen=True, kw_only=True)
class FallingBody:
    """The impacting body in the units of its condensed layer.

    Attributes:
        mass: M / (G_0 L) [s^2].
        velocity: v_0 / L [1/s].
    """

    mass: float
    velocity: float


@dataclass
class Samples:
    """Samples of a motion, in the units of its condensed layer; the last two columns are energies."""

    condensed: CondensedLayer
    rows: list[tuple[float, ...]] = field(default_factory=list)

    def add(self, time: float, depth: float, velocity: float, pressure: FloatArray) -> None:
        """Append one sample."""
        surface = self.condensed.surface
        force, edge = float(surface.resultants @ pressure), edge_radius(self.condensed.radii, pressure)
        self.rows.append((time, depth, velocity, force, edge, surface.stored_energy, surface.dissipated_energy))

    def column(self, name: str) -> FloatArray:
        """One of time, depth, velocity, force, radius, stored, dissipated."""
        names = ("time", "depth", "velocity", "force", "radius", "stored", "dissipated")
        return np.array([row[names.index(name)] for row in self.rows])


def simulate_impact(condensed: CondensedLayer, body: FallingBody, duration: float) -> Samples:
    """Steps of ``duration`` [s] from first touch to the loss of contact.

    Raises:
        NotConvergedError: the body never comes off (a layer without long-term elasticity may hold it).
    """
    surface, record = condensed.surface, Samples(condensed)
    w, kappa = surface.resultants, duration**2 / (4 * body.mass)
    pressure = _touch(condensed, body, INSTANT * duration)
    depth, velocity, force, time = 0.0, body.velocity, float(w @ pressure), 0.0
    record.rows.append((0.0, 0.0, velocity, force, 0.0, 0.0, 0.0))
    active, overlaps = None, (0.0, 0.0, 0.0)
    for _ in range(MAX_STEPS):
        matrix, offset = surface.begin(duration)
        ballistic = depth + duration * velocity - kappa * force
        approach = ballistic * w - condensed.profile - offset
        state = solve_complementarity(matrix + kappa * np.outer(w, w), approach, active)
        surface.accept(state.pressure)
        following, overlaps = float(w @ state.pressure), (*overlaps[1:], float((approach / w).max()))
        mean, active = (force + following) / 2, state.active
        is_free = following == 0 and velocity - duration * mean / body.mass < 0
        part = duration * (_release_fraction(*overlaps) if is_free else 1.0)
        depth += part * velocity - part * duration * mean / (2 * body.mass)
        velocity -= part * mean / body.mass
        force, time = following, time + part
        record.add(time, depth, velocity, state.pressure)
        if is_free:
            return record
    raise NotConvergedError("the body does not come off", {"last_force": force, "last_velocity": velocity})


def _touch(condensed: CondensedLayer, body: FallingBody, instant: float) -> FloatArray:
    """Pressures at first touch: those of the dashpot under the part of the profile that is flat."""
    surface = condensed.surface
    if surface.viscosity == 0:
        return np.zeros_like(condensed.profile)
    matrix, offset = surface.begin(instant)
    approach = instant * body.velocity * surface.resultants - condensed.profile - offset
    pressure = solve_complementarity(matrix, approach).pressure
    surface.accept(pressure)
    return pressure


def _release_fraction(earlier: float, before: float, after: float) -> float:
    """Part of the last step after which contact is lost, from the overlap at its ends and one step earlier.

    The overlap of the indenter with the surface as it would be without pressure passes zero there, and smoothly, while
    the force of a round indenter vanishes like its power 3/2. The zero is that of the parabola through the three: a
    straight line would err by the second order of the step times a factor that moves with the place of the zero.
    """
    if not before > 0 > after:
        return 1.0
    slope, bend = (after - earlier) / 2, (after - 2 * before + earlier) / 2
    return float(2 * before / (-slope + np.sqrt(slope**2 - 4 * bend * before)))


def segments(time: FloatArray, per_octave: int) -> list[FloatArray]:
    """Ends of the steps of each segment between given instants [s].

    M equal steps are followed by M twice as long, and so on. With half of M they are every other one of these.

    Args:
        time: given instants [s].
        per_octave: M, even in an answer and half of that in its companion.
    """
    octaves = int(np.clip(SHARED // (len(time) - 1), FEWEST, MOST))
    steps = np.repeat(2.0 ** np.arange(octaves), per_octave)
    shares = np.cumsum(steps) / steps.sum()
    # The last instant is the given one, to the bit.
    shares[-1] = 1.0
    return [t0 * (1.0 - shares) + t1 * shares for t0, t1 in pairwise(time)]


def simulate_prescribed(
    condensed: CondensedLayer, time: FloatArray, values: FloatArray, steps: Sequence[FloatArray], *, by_depth: bool
) -> Samples:
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
    record, surface, depth = Samples(condensed), condensed.surface, 0.0
    active: BoolArray | None = None

    def advance(duration: float, load: float) -> FloatArray:
        """Pressures at the end of a step to this load; the memory and the depth move on."""
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
    record.add(float(time[0]), float(values[0]) if by_depth else depth, 0.0, pressure)
    for ends, (t0, t1), (v0, v1) in zip(steps, pairwise(time), pairwise(values), strict=True):
        if by_depth:
            surface.restart()
        active = None
        for before, now in pairwise([t0, *ends]):
            load = v1 if now == t1 else v0 + (v1 - v0) * (now - t0) / (t1 - t0)
            pressure = advance(float(now - before), float(load))
            record.add(float(now), depth, 0.0, pressure)
    return record


def _depth_of_force(
    matrix: FloatArray, w: FloatArray, gap: FloatArray, force: float, depth: float
) -> tuple[Complementary, float]:
    """Contact with a given resultant: Newton's method on the convex, piecewise linear F(delta)."""
    # The depth of first touch.
    least = float(np.min(gap / w))
    if force == 0:
        return solve_complementarity(matrix, np.minimum(least * w - gap, 0.0)), min(depth, least)
    depth, change = max(depth, least + 1e-9 * abs(least) + 1e-15), np.inf
    for _ in range(60):
        state = solve_complementarity(matrix, depth * w - gap)
        defect = force - float(w @ state.pressure)
        # A force far below the layer's own stresses is known to the rounding of its depth only.
        if abs(defect) <= 1e-10 * force or abs(change) <= 1e-14 * abs(depth):
            return state, depth
        act = state.active if state.active.any() else gap / w <= depth + 1e-12
        block = matrix[np.ix_(act, act)]
        change = defect / float(w[act] @ np.linalg.solve(block, w[act]))
        depth += change
    raise NotConvergedError("no depth carries the prescribed force", {"force_defect": defect})


@dataclass(frozen=True)
class Resolution:
    """How finely a motion is resolved.

    Attributes:
        cells: cells of the strip.
        steps: equal time steps of an impact.
        per_octave: steps of each octave of a segment of a history.
    """

    cells: int
    steps: int
    per_octave: int

    @classmethod
    def of(cls, settings: Discretisation) -> Resolution:
        """Cells and steps shrink with the growth of the meshes; a companion has half of the cells."""
        growth, halves = settings.growth / settings.coarsening, 1 if settings.coarsening == 1.0 else 2
        cells = 2 * max(10, round(30 / growth)) // halves
        return cls(cells, 2 * max(20, round(100 / growth)), 2 * max(2, round(4 / growth)))

    def half_the_steps(self) -> Self:
        """The same cells with half the steps, whose instants are every other one of a history's."""
        return replace(self, steps=self.steps // 2, per_octave=self.per_octave // 2)


class HistorySetup:
    """Condensed layers of one scene at one resolution, a fresh one for every motion that is simulated."""

    def __init__(self, scene: Scene, settings: Discretisation, backend: str, log: StageLog) -> None:
        self.scene, self.log, self.relaxation = scene, log, relaxation_of(scene)
        self.resolution = Resolution.of(settings)
        self._settings = replace(settings, truncation=max(settings.truncation, TRUNCATION * settings.coarsening**6))
        self._backend = backend
        relaxes = bool(np.any(self.relaxation.moduli)) or self.relaxation.viscosity > 0
        self._modes: dict[tuple[float, int], Modes] = {}
        self._needs_field = relaxes and scene.layer.poissons_ratio < 0.5

    @classmethod
    def resolutions(
        cls, scene: Scene, settings: Discretisation, backend: str, log: StageLog
    ) -> list[tuple[HistorySetup, Resolution]]:
        """Setups and resolutions with half the cells and steps, with half the cells, and of the answer."""
        coarser, setup = (cls(scene, each, backend, log) for each in (settings.coarser(), settings))
        cells = coarser.resolution
        return [(coarser, cells.half_the_steps()), (coarser, cells), (setup, setup.resolution)]

    def condensed(self, radius: float, cells: int) -> CondensedLayer:
        """The layer at rest with a strip of ``radius`` [m]."""
        if (radius, cells) not in self._modes:
            self._modes[radius, cells] = self._condensed_modes(radius, cells)
        modes = self._modes[radius, cells]
        profile = self._profile(modes.radii, radius) if len(modes.radii) > 1 else np.zeros(1)
        return CondensedLayer(Top(modes, self.relaxation), modes.radii, profile, radius, modes.unknowns)

    def _condensed_modes(self, radius: float, cells: int) -> Modes:
        per_shear = (1 - self.scene.layer.poissons_ratio) / 2  # E* = 2 G / (1 - nu)
        if self._needs_field:
            with self.log.stage("factor"):
                return compressible_modes(*self._mesh(radius, cells), self._backend)
        if isinstance(self.scene.indenter, FlatPunch):
            # It moves as one: its force is the only unknown, 1 / k_N its compliance.
            contact = solve_contact(self.scene, radius, self._settings, self.log, backend=self._backend)
            compliance = np.array([[per_shear / contact.stiffness]])
            return proportional_modes(compliance, np.ones(1), np.ones(1), contact.unknowns)
        strip = condense(*self._mesh(radius, cells), self._backend, self.log)
        return proportional_modes(strip.pressed * per_shear, strip.resultants, strip.radii, strip.unknowns)

    def _mesh(self, radius: float, cells: int) -> tuple[Parts, Section]:
        layer, indenter = self.scene.layer, self.scene.indenter
        with self.log.stage("mesh"):
            if isinstance(indenter, FlatPunch):
                settings = replace(self._settings, edge_cell=1e-4 * self._settings.coarsening**6)
                return contact_section(layer, ScaledIndenter(indenter, radius), settings)
            return strip_section(layer, radius, cells, indenter.kinks, self._settings, outside=OUTSIDE)

    def _profile(self, radii: FloatArray, radius: float) -> FloatArray:
        """Moments of the profile by the strip's radius."""
        space = TraceSpace(radii, 1)
        inside = np.minimum(space.gauss(4)[0] * radius, min(radius, self.scene.indenter.max_radius))
        return space.moments(shape(self.scene.indenter, inside).height / radius, 4)

    def fitted_radius(self, guess: float, simulate: Callable[[CondensedLayer], Samples]) -> tuple[float, Samples]:
        """A strip a quarter larger than the largest contact, and the record of the pilot simulation on it.

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
            largest = float(record.column("radius").max())
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
