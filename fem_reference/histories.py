"""Prescribed depths or forces in time, in SI units."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from contact import (
    DepthHistory,
    FlatPunch,
    ForceHistory,
    HistoryPath,
    InvalidInput,
    Scene,
    StageLog,
    UnsupportedSceneError,
)
from contact.answer.solution import Setting
from contact.records.validation import FloatArray
from contact.scene.extent import first_radius
from contact.stated import SAFETY
from fem_reference.equilibria import refuse_touching_at
from fem_reference.materials import contact_modulus, shear_modulus
from fem_reference.motions import CondensedLayer, HistorySetup, Resolution, Samples, segments, simulate_prescribed
from fem_reference.profiles import height
from fem_reference.settings import Discretisation
from fem_reference.stated import FLOOR, exact_names

# Instants of the companion to either side, among which the largest change is stated. Not measured: half and twice.
WINDOW = 6
# Contact narrower than so many cells states the largest change while it is; the first cells err in every way.
NARROW = 8.0
# Least stated change over the mean of all instants.
SHARE_OF_MEAN = 0.5
# Steps of each octave of a pilot.
PILOT_STEPS = 4


class HistorySolver:
    """One prescribed history at any resolution."""

    def __init__(
        self, scene: Scene, loading: DepthHistory | ForceHistory, settings: dict[str, Setting], log: StageLog
    ) -> None:
        self._scene, self._loading, self._settings, self._log = scene, loading, settings, log
        self._by_depth = isinstance(loading, DepthHistory)
        self._values: FloatArray = loading.depth if isinstance(loading, DepthHistory) else loading.force
        self._radius: float | None = None

    def attempt(self, settings: Discretisation) -> HistoryPath:
        """The answer with its stated errors."""
        setups = HistorySetup.resolutions(self._scene, settings, str(self._settings["solver"]), self._log)
        half_both, half_cells, path = (self.answer(*each) for each in setups)
        return self.with_errors(path, half_cells, half_both, setups[-1][0])

    def answer(self, setup: HistorySetup, resolution: Resolution) -> HistoryPath:
        """The response at the steps of this resolution; it states no errors yet.

        Raises:
            UnsupportedSceneError: a dashpot would take an infinite force.
        """
        if self._by_depth and self._values[0] > 0 and setup.relaxation.viscosity > 0:
            raise UnsupportedSceneError(
                f"loading.depth begins at {self._values[0]:g} m: a dashpot answers this jump by an infinite force; "
                "begin at zero and give the ramp"
            )
        if self._radius is None:
            guess = 1.6 * self._first_radius()
            self._radius, _ = setup.fitted_radius(guess, lambda layer: self._simulated(setup, layer, PILOT_STEPS))
        condensed = setup.condensed(self._radius, resolution.cells)
        return self._in_si(setup, condensed, self._simulated(setup, condensed, resolution.per_octave))

    def _simulated(self, setup: HistorySetup, condensed: CondensedLayer, per_octave: int) -> Samples:
        unit = condensed.radius
        if not self._by_depth:
            unit *= shear_modulus(setup.scene.layer) * condensed.radius
        time, steps = self._loading.time, segments(self._loading.time, per_octave)
        with setup.log.stage("time_steps"):
            record = simulate_prescribed(condensed, time, self._values / unit, steps, by_depth=self._by_depth)
        setup.log.count("steps", len(record.rows))
        return record

    def _first_radius(self) -> float:
        """A contact radius [m] for the largest load: f(r) = delta, or 4 E* r f(r) = F."""
        indenter, largest = self._scene.indenter, float(self._values.max())
        if isinstance(indenter, FlatPunch):
            return indenter.radius
        if largest <= 0:
            raise InvalidInput("the history never presses; give a positive depth or force somewhere")
        if self._by_depth:
            return first_radius(indenter, lambda r: height(indenter, r) >= largest)
        load = largest / (4 * contact_modulus(self._scene.layer))
        return first_radius(indenter, lambda r: r * height(indenter, r) >= load)

    def _in_si(self, setup: HistorySetup, condensed: CondensedLayer, record: Samples) -> HistoryPath:
        length, force = condensed.radius, record.column("force")
        radius = np.maximum(record.column("radius") * length, self._scene.indenter.flat_radius)
        return HistoryPath(
            scene=self._scene,
            method="fem",
            settings=self._settings,
            error_estimate={},
            cost=setup.log.cost(unknowns=condensed.unknowns),
            stages=setup.log.records,
            time=record.column("time"),
            indentation_depth=record.column("depth") * length,
            normal_force=force * shear_modulus(self._scene.layer) * length**2,
            contact_radius=np.where(force > 0, radius, 0.0),
        )

    def with_errors(
        self, answer: HistoryPath, half_cells: HistoryPath, half_both: HistoryPath, setup: HistorySetup
    ) -> HistoryPath:
        """The answer with stated errors for every instant, shape (n,): what half the cells change, and half the steps.

        Both at once may cancel.
        """
        largest = float(answer.contact_radius.max())
        refuse_touching_at(self._scene, largest, setup.log)
        cell = self._radius / setup.resolution.cells if self._radius else 0.0
        exact, errors = exact_names(answer.scene), {}
        for name in (name for name in answer.ARRAYS if name != "time"):
            values = getattr(answer, name)
            near = np.zeros(len(answer))
            for fine, coarse in ((answer, half_cells), (half_cells, half_both)):
                change = np.abs(np.interp(coarse.time, fine.time, getattr(fine, name)) - getattr(coarse, name))
                near += _largest_near(change, coarse, answer, NARROW * cell) + SHARE_OF_MEAN * change.mean()
            error = SAFETY * near / max(np.abs(values).max(), np.finfo(float).tiny) + FLOOR
            if name == "contact_radius":
                # Pressures of a layer that relaxes do not end like sqrt(a - r): radii are known to a cell.
                error = error + (1.0 if answer.scene.effects else 0.1) * cell / largest
            errors[name] = 0.0 * error if name in exact else error
        return replace(answer, error_estimate=errors)


def _largest_near(change: FloatArray, companion: HistoryPath, answer: HistoryPath, narrow: float) -> FloatArray:
    """Largest change at some instants to either side, and of all while contact is narrower than some cells."""
    place = np.searchsorted(companion.time, answer.time)
    shifts = range(-WINDOW, WINDOW)
    near: FloatArray = np.max([change[np.clip(place + k, 0, len(change) - 1)] for k in shifts], axis=0)
    at_narrow = change[companion.contact_radius < narrow]
    return np.asarray(np.where(answer.contact_radius < narrow, np.maximum(near, at_narrow.max(initial=0.0)), near))
