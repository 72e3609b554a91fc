"""Impacts in SI units: a coarse pilot finds strip and steps, then each resolution makes equal steps."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from contact import FlatPunch, Impact, ImpactHistory, KelvinVoigt, NotConvergedError, Scene, StageLog, Viscoelasticity
from contact.answer.solution import Setting
from contact.records.validation import FloatArray
from contact.scene.extent import first_radius
from contact.stated import SAFETY
from fem_reference.equilibria import refuse_touching_at
from fem_reference.materials import contact_modulus, shear_modulus
from fem_reference.motions import CondensedLayer, FallingBody, HistorySetup, Resolution, Samples, simulate_impact
from fem_reference.profiles import height
from fem_reference.settings import Discretisation
from fem_reference.stated import FLOOR, exact_names, relative_change

# Steps of a pilot in the time that contact is expected to take; fewer than half as many are repeated.
PILOT_STEPS = 60
# Largest change of velocity in a step of the pilot and in one of two hundred steps, over the first velocity: a strong
# dashpot stops a body far sooner than the layer throws it back.
LARGEST_CHANGE, WANTED_CHANGE = 0.2, 0.05
# Most steps over those of an impact on an elastic layer.
MOST = 16
# Least restitution. Below, contact ends after its force has fallen under its roundings.
LEAST_LEFT = 3e-8
# Share of the peak below which a force may be roundings: the time that contact still lasts is stated of its end.
ROUNDING_FORCE = 1e-12
# A channel counts as near its peak from this share of it on: the largest change there is stated of the peak.
NEAR_PEAK = 0.9
# The channel of each peak.
PEAKS = {"peak_force": "normal_force", "peak_depth": "indentation_depth", "peak_contact_radius": "contact_radius"}
# Share of a cell by which the edge is read from pressures on cells; at a kink it is one cell.
EDGE_READING = 0.1


class ImpactSolver:
    """One impact at any resolution."""

    def __init__(self, scene: Scene, loading: Impact, settings: dict[str, Setting], log: StageLog) -> None:
        self._scene, self._loading, self._settings, self._log = scene, loading, settings, log
        self._planned: tuple[float, float] | None = None

    def attempt(self, settings: Discretisation) -> ImpactHistory:
        """The answer with its stated errors."""
        setups = HistorySetup.resolutions(self._scene, settings, str(self._settings["solver"]), self._log)
        half_both, half_cells, fine = (self.answer(*each) for each in setups)
        return self.with_errors(fine, half_cells, half_both, setups[-1][0])

    def answer(self, setup: HistorySetup, resolution: Resolution) -> ImpactHistory:
        """From first touch to the loss of contact; it states no errors yet."""
        if self._planned is None:
            self._planned = self._pilot(setup)
        radius, span = self._planned
        condensed = setup.condensed(radius, resolution.cells)
        return self._in_si(setup, condensed, self._simulated(setup, span / resolution.steps, condensed))

    def _simulated(self, setup: HistorySetup, duration: float, condensed: CondensedLayer) -> Samples:
        """The motion with time steps of this duration [s]."""
        modulus, loading = shear_modulus(setup.scene.layer), self._loading
        mass = loading.mass / (modulus * condensed.radius)
        with setup.log.stage("time_steps"):
            body = FallingBody(mass=mass, velocity=loading.velocity / condensed.radius)
            record = simulate_impact(condensed, body, duration)
        setup.log.count("steps", len(record.rows))
        return record

    def _pilot(self, setup: HistorySetup) -> tuple[float, float]:
        """Radius of the strip [m], and the time in which the answer makes as many steps as its resolution says [s].

        Raises:
            NotConvergedError: equal steps that follow the stop are too many, or hardly any velocity is left.
        """
        guess, span = self._scales(setup)
        step = span / PILOT_STEPS
        while True:
            radius, record = setup.fitted_radius(1.6 * guess, partial(self._simulated, setup, step))
            velocity, contact = record.column("velocity"), record.rows[-1][0]
            change = float(np.abs(np.diff(velocity)).max() / velocity[0])
            finer = max(1.0, change * contact / (200 * step) / WANTED_CHANGE)
            is_fine = len(record.rows) > PILOT_STEPS // 2 and change <= LARGEST_CHANGE
            if finer > MOST and (is_fine or step < span / PILOT_STEPS):
                raise NotConvergedError(
                    "a strong dashpot stops the body far sooner than contact ends: equal steps that follow its stop "
                    f"are {finer:.3g} times as many as an elastic layer needs, {MOST} times at most are made; the "
                    "method mdr adapts its steps",
                    {"steps_over_usual": finer},
                )
            if is_fine:
                break
            step /= 4
        left = abs(velocity[-1] / velocity[0])
        if left < LEAST_LEFT:
            raise NotConvergedError(
                f"a strong dashpot leaves the body {left:.1g} of its velocity: below {LEAST_LEFT:g} roundings decide "
                "when contact ends; the method mdr goes further",
                {"restitution": left},
            )
        return radius, contact / finer

    def _scales(self, setup: HistorySetup) -> tuple[float, float]:
        """A contact radius [m] with E* r f(r)^2 = kinetic energy, and the time [s] to reach the depth f(r)."""
        indenter, loading, modulus = setup.scene.indenter, self._loading, contact_modulus(setup.scene.layer)
        if isinstance(indenter, FlatPunch):
            return indenter.radius, float(np.pi * np.sqrt(loading.mass / (2 * modulus * indenter.radius)))
        volume = loading.mass * loading.velocity**2 / 2 / modulus
        r = first_radius(indenter, lambda r: r * height(indenter, r) ** 2 >= volume)
        return r, 3 * height(indenter, r) / loading.velocity

    def _in_si(self, setup: HistorySetup, condensed: CondensedLayer, record: Samples) -> ImpactHistory:
        scene, length, modulus = setup.scene, condensed.radius, shear_modulus(setup.scene.layer)
        force, depth = record.column("force") * modulus * length**2, record.column("depth") * length
        velocity = record.column("velocity") * length
        radius = np.maximum(record.column("radius") * length, scene.indenter.flat_radius)
        energy = modulus * length**3
        return ImpactHistory(
            scene=scene,
            method="fem",
            settings=self._settings,
            error_estimate={},
            cost=setup.log.cost(unknowns=condensed.unknowns),
            stages=setup.log.records,
            time=record.column("time"),
            indentation_depth=depth,
            velocity=velocity,
            normal_force=force,
            contact_radius=radius,
            kinetic_energy=self._loading.mass * velocity**2 / 2,
            stored_energy=record.column("stored") * energy,
            dissipated_energy=record.column("dissipated") * energy,
            peak_force=peak(force),
            peak_depth=peak(depth),
            peak_contact_radius=peak(radius),
        )

    def with_errors(
        self, answer: ImpactHistory, half_cells: ImpactHistory, half_both: ImpactHistory, setup: HistorySetup
    ) -> ImpactHistory:
        """The answer with its stated errors: what half the cells change, and what half the steps change with them.

        Both at once may cancel.
        """
        pairs = (answer, half_cells), (half_cells, half_both)
        refuse_touching_at(setup.scene, answer.peak_contact_radius, setup.log)
        exact = exact_names(answer.scene)
        channels = [name for name in answer.ARRAYS if name != "time"]
        errors = {
            name: np.full(len(answer), SAFETY * sum(channel_change(*pair, name).max() for pair in pairs) + FLOOR)
            for name in channels
        }
        for name in (*answer.SCALARS, "coefficient_of_restitution", "contact_time"):
            errors[name] = np.array([SAFETY * sum(_scalar_change(*pair, name) for pair in pairs) + FLOOR])
        errors["coefficient_of_restitution"] += _energy_lost(answer)
        errors["contact_time"] += _end_by_roundings(answer)
        reading = self._reading(answer, setup)
        for name in ("contact_radius", "peak_contact_radius"):
            errors[name] = errors[name] + reading
        return replace(answer, error_estimate={name: 0.0 * e if name in exact else e for name, e in errors.items()})

    def _reading(self, answer: ImpactHistory, setup: HistorySetup) -> float:
        """Error of reading the contact's edge, over the largest radius."""
        cell = self._planned[0] / setup.resolution.cells if self._planned else 0.0
        peak_radius = answer.peak_contact_radius
        at_kink = any(abs(peak_radius - kink) < 2 * cell for kink in answer.scene.indenter.kinks)
        return (1.0 if at_kink else EDGE_READING) * cell / peak_radius


def _energy_lost(answer: ImpactHistory) -> float:
    """Relative error of the restitution by the energy that motion, layer and dissipation lack in the end together."""
    if isinstance(answer.scene.effect(Viscoelasticity), KelvinVoigt):
        return 0.0  # a dashpot's dissipation is summed to first order in the steps
    total = answer.kinetic_energy + answer.stored_energy + answer.dissipated_energy
    return float(abs(total[-1] - total[0]) / (2.0 * answer.kinetic_energy[-1]))


def _end_by_roundings(answer: ImpactHistory) -> float:
    """Share of the contact time in which the force is roundings: a strong dashpot lets it fade like e^-st."""
    presses = np.flatnonzero(answer.normal_force > ROUNDING_FORCE * answer.peak_force)
    following = answer.time[min(presses[-1] + 1, len(answer) - 1)]
    return float(1.0 - following / answer.time[-1])


def _scalar_change(answer: ImpactHistory, companion: ImpactHistory, name: str) -> float:
    """Relative change of a number; of a peak the largest one of its channel near the peak, where two may agree."""
    change = float(relative_change(answer, companion, name).max())
    if name not in PEAKS:
        return change
    values = getattr(companion, PEAKS[name])
    return max(change, float(channel_change(answer, companion, PEAKS[name])[values >= NEAR_PEAK * values.max()].max()))


def channel_change(answer: ImpactHistory, companion: ImpactHistory, name: str) -> FloatArray:
    """|answer - companion| at the companion's instants, over the largest value."""
    values, others = getattr(answer, name), getattr(companion, name)
    change = np.abs(np.interp(companion.time, answer.time, values) - others)
    return np.asarray(change / max(np.abs(values).max(), np.finfo(float).tiny))


def peak(values: FloatArray) -> float:
    """Largest value of a smooth sampled function: the vertex of the parabola through the three highest samples."""
    i = int(np.argmax(values))
    if i in (0, len(values) - 1):
        return float(values[i])
    left, top, right = values[i - 1 : i + 2]
    curvature = left - 2 * top + right
    return float(top - (right - left) ** 2 / (8 * curvature)) if curvature < 0 else float(top)
