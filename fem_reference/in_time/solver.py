"""Viscoelastic scenes: impacts and prescribed histories, their answers in SI units with error bars.

Every scene is solved three times: with half the cells and half the steps, with half the cells, and as asked.  The
differences are the error estimates, see `errors`.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from contact import (
    DepthHistory,
    FlatPunch,
    ForceHistory,
    HistoryPath,
    Impact,
    ImpactHistory,
    InvalidInput,
    Scene,
    UnsupportedSceneError,
)
from contact.records.validation import FloatArray
from contact.scene.extent import first_radius
from fem_reference.discrete_layer.indenter import height
from fem_reference.discrete_layer.material import contact_modulus, shear_modulus
from fem_reference.elastic.beside_contact import refuse_touching_at
from fem_reference.in_time.condensed_layer import CondensedLayer
from fem_reference.in_time.errors import path_with_errors, with_errors
from fem_reference.in_time.impact import FallingBody, HistorySamples, simulate_impact
from fem_reference.in_time.pilot import pilot
from fem_reference.in_time.prescribed import segment_steps, simulate_prescribed
from fem_reference.in_time.setup import HistorySetup

Settings = Mapping[str, bool | int | float | str | None]


def impact_history(setup: HistorySetup, loading: Impact, shown: Settings) -> ImpactHistory:
    """An impact from first touch to the loss of contact."""
    scene, log = setup.scene, setup.log
    modulus = shear_modulus(scene.layer)

    def simulate(condensed: CondensedLayer, duration: float) -> HistorySamples:
        """The motion on this mesh of the strip with time steps of this duration [s]."""
        body = FallingBody(
            mass=loading.mass / (modulus * condensed.radius), velocity=loading.velocity / condensed.radius
        )
        with log.stage("time_steps"):
            record = simulate_impact(condensed, body, setup.relaxation, duration)
        log.count("steps", len(record.time))
        return record

    guess, span = _impact_scales(scene, loading)
    radius, span = pilot(setup, 1.6 * guess, span, simulate)
    duration = span / setup.resolution.steps
    histories = []
    for cells, steps in ((2, 2), (2, 1), (1, 1)):
        condensed = setup.condensed(radius, setup.resolution.cells // cells)
        record = simulate(condensed, steps * duration)
        histories.append(_impact_in_si(setup, loading, condensed, record, shown))
    half_both, half_cells, fine = histories
    refuse_touching_at(scene, fine.peak_contact_radius, log)
    return with_errors(fine, half_cells, half_both, setup.known_errors(radius, fine.peak_contact_radius))


def _impact_scales(scene: Scene, loading: Impact) -> tuple[float, float]:
    """A contact radius [m] with E* r f(r)^2 = kinetic energy, and the time [s] to reach the depth f(r)."""
    if isinstance(scene.indenter, FlatPunch):
        a = scene.indenter.radius
        return a, float(np.pi * np.sqrt(loading.mass / (2 * contact_modulus(scene.layer) * a)))
    energy = loading.mass * loading.velocity**2 / 2
    volume, indenter = energy / contact_modulus(scene.layer), scene.indenter
    r = first_radius(indenter, lambda r: r * height(indenter, r) ** 2 >= volume)
    return r, 3 * height(scene.indenter, r) / loading.velocity


def _impact_in_si(
    setup: HistorySetup, loading: Impact, condensed: CondensedLayer, record: HistorySamples, shown: Settings
) -> ImpactHistory:
    scene, log = setup.scene, setup.log
    length, modulus = condensed.radius, shear_modulus(scene.layer)
    energy = modulus * length**3
    force, depth = np.array(record.force), np.array(record.depth)
    velocity = np.array(record.velocity) * length
    radius = np.maximum(np.array(record.radius) * length, scene.indenter.flat_radius)
    return ImpactHistory(
        scene=scene,
        method="fem",
        settings=shown,
        error_estimate={},
        cost=log.cost(unknowns=condensed.unknowns),
        stages=log.records,
        time=np.array(record.time),
        indentation_depth=depth * length,
        velocity=velocity,
        normal_force=force * modulus * length**2,
        contact_radius=radius,
        kinetic_energy=loading.mass * velocity**2 / 2,
        stored_energy=np.array(record.stored) * energy,
        dissipated_energy=np.array(record.dissipated) * energy,
        peak_force=peak(force) * modulus * length**2,
        peak_depth=peak(depth) * length,
        peak_contact_radius=peak(radius),
    )


def peak(values: FloatArray) -> float:
    """Largest value of a smooth sampled function: the vertex of the parabola through the three highest samples."""
    i = int(np.argmax(values))
    if i in (0, len(values) - 1):
        return float(values[i])
    left, top, right = values[i - 1 : i + 2]
    curvature = left - 2 * top + right
    return float(top - (right - left) ** 2 / (8 * curvature)) if curvature < 0 else float(top)


def prescribed_history(setup: HistorySetup, loading: DepthHistory | ForceHistory, shown: Settings) -> HistoryPath:
    """Response to a prescribed history of depth or force."""
    scene, log = setup.scene, setup.log
    modulus = shear_modulus(scene.layer)

    by_depth = isinstance(loading, DepthHistory)
    prescribed = _prescribed(loading)
    if by_depth and prescribed[0] > 0 and setup.relaxation.viscosity > 0:
        raise UnsupportedSceneError(
            f"loading.depth begins at {prescribed[0]:g} m: a dashpot answers this jump by an infinite force; "
            "begin at zero and give the ramp"
        )

    def simulate(condensed: CondensedLayer, steps: int, coarser: int = 1) -> HistorySamples:
        """The prescribed history on this mesh of the strip with about so many time steps, or half of them."""
        values = prescribed / condensed.radius * (1.0 if by_depth else 1.0 / (modulus * condensed.radius))
        counts = segment_steps(loading.time, steps, coarser)
        with log.stage("time_steps"):
            record = simulate_prescribed(condensed, setup.relaxation, loading.time, values, counts, by_depth=by_depth)
        log.count("steps", len(record.time))
        return record

    radius, _ = setup.fitted_radius(1.6 * _history_radius(scene, loading), lambda condensed: simulate(condensed, 40))
    histories = []
    for cells, coarser in ((2, 2), (2, 1), (1, 1)):
        condensed = setup.condensed(radius, setup.resolution.cells // cells)
        record = simulate(condensed, setup.resolution.steps, coarser)
        histories.append(_history_in_si(setup, condensed, record, shown))
    half_both, half_cells, fine = histories
    refuse_touching_at(scene, float(fine.contact_radius.max()), log)
    return path_with_errors(fine, half_cells, half_both, setup.known_errors(radius, fine.contact_radius.max()))


def _prescribed(loading: DepthHistory | ForceHistory) -> FloatArray:
    """Depths [m] or forces [N]."""
    return loading.depth if isinstance(loading, DepthHistory) else loading.force


def _history_in_si(
    setup: HistorySetup, condensed: CondensedLayer, record: HistorySamples, shown: Settings
) -> HistoryPath:
    scene, log, length = setup.scene, setup.log, condensed.radius
    force, radius = np.array(record.force), np.array(record.radius) * length
    return HistoryPath(
        scene=scene,
        method="fem",
        settings=shown,
        error_estimate={},
        cost=log.cost(unknowns=condensed.unknowns),
        stages=log.records,
        time=np.array(record.time),
        indentation_depth=np.array(record.depth) * length,
        normal_force=force * shear_modulus(scene.layer) * length**2,
        contact_radius=np.where(force > 0, np.maximum(radius, scene.indenter.flat_radius), 0.0),
    )


def _history_radius(scene: Scene, loading: DepthHistory | ForceHistory) -> float:
    """A contact radius [m] for the largest load: f(r) = delta, or 4 E* r f(r) = F."""
    if isinstance(scene.indenter, FlatPunch):
        return scene.indenter.radius
    largest = float(_prescribed(loading).max())
    if largest <= 0:
        raise InvalidInput("the history never presses; give a positive depth or force somewhere")
    if isinstance(loading, DepthHistory):
        return first_radius(scene.indenter, lambda r: height(scene.indenter, r) >= largest)
    load = largest / (4 * contact_modulus(scene.layer))
    return first_radius(scene.indenter, lambda r: r * height(scene.indenter, r) >= load)
