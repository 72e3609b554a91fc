"""Impacts, and prescribed depths or forces in time, in SI units, with errors from half the cells and half the steps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import Any, TypeVar

import numpy as np

from contact import (
    DepthHistory,
    FlatPunch,
    HistoryPath,
    Impact,
    ImpactHistory,
    InvalidInput,
    NotConvergedError,
    Scene,
    StageLog,
    UnsupportedSceneError,
)
from contact.answer.solution import Setting
from contact.records.validation import FloatArray
from contact.scene.extent import first_radius
from contact.stated import SAFETY
from fem_reference.contact_set import EDGE_ERROR
from fem_reference.equilibria import refuse_touching_at
from fem_reference.materials import contact_modulus, shear_modulus
from fem_reference.motions import (
    HistorySetup,
    Motion,
    Resolution,
    Strip,
    segments,
    simulate_impact,
    simulate_prescribed,
)
from fem_reference.profiles import height
from fem_reference.settings import Discretisation
from fem_reference.stated import FLOOR, exact_names

# A pilot is a first simulation on few cells. Its steps in the expected contact time of an impact (with fewer than half
# as many it is repeated with shorter steps), and its steps in each octave of a history.
PILOT_STEPS, PILOT_OCTAVE = 60, 4
# Largest change of velocity over the first velocity, in a step of the pilot, and in a step of 1/200 of the contact
# time: a strong dashpot stops a body in a small part of that time, and equal steps must resolve this.
LARGEST_CHANGE, WANTED_CHANGE = 0.2, 0.05
# Largest factor on the number of steps of an impact on an elastic layer.
MOST = 16
# Least coefficient of restitution. Below it contact ends only after its force has fallen below its roundings.
LEAST_RESTITUTION = 3e-8
# Share of the peak force below which a force may be rounding: the rest of the contact time is its stated error.
ROUNDING_FORCE = 1e-12
# A quantity above this share of its peak is near it: the largest change there is the stated error of the peak.
NEAR_PEAK = 0.9
# The time-dependent quantity of each peak.
PEAKS = {"peak_force": "normal_force", "peak_depth": "indentation_depth", "peak_contact_radius": "contact_radius"}
# The error at an instant is the largest change among so many instants of the companion to either side.
WINDOW = 6
# While the contact radius is below so many cells, the largest change of all such instants is stated.
NARROW = 8.0
# This share of the mean change of all instants is added to the change at each instant.
SHARE_OF_MEAN = 0.5

A = TypeVar("A", ImpactHistory, HistoryPath)


def impact(scene: Scene, settings: Discretisation, *, written: Mapping[str, Setting], log: StageLog) -> ImpactHistory:
    """Impact from first touch to the loss of contact, in SI units, with relative errors.

    Args:
        scene: scene with an `Impact`.
        settings: settings of the mesh; their growth determines the numbers of cells and steps, too.
        written: settings that the answer reports.
        log: record of time and memory per stage.
    """
    setups = HistorySetup.resolutions(scene, settings, log)
    radius, span = _pilot(setups[0][0])

    def answer_at(setup: HistorySetup, resolution: Resolution) -> ImpactHistory:
        """The impact at one resolution of cells and steps."""
        strip = setup.strip(radius, resolution.cells)
        return _impact_in_si(setup, strip, _impact_motion(setup, span / resolution.steps, strip), written)

    half_both, half_cells, answer = (answer_at(*each) for each in setups)
    # Half the cells and half the steps may cancel: both changes count.
    pairs = (answer, half_cells), (half_cells, half_both)
    refuse_touching_at(scene, answer.peak_contact_radius, log)
    errors = {
        name: np.full(len(answer), SAFETY * sum(_change(*pair, name).max() for pair in pairs) + FLOOR)
        for name in answer.ARRAYS
        if name != "time"
    }
    for name in (*answer.SCALARS, "coefficient_of_restitution", "contact_time"):
        errors[name] = np.array([SAFETY * sum(_scalar_change(*pair, name) for pair in pairs) + FLOOR])
    errors["contact_time"] += _end_by_roundings(answer)
    # At a kink the edge is known to a cell.
    cell, peak_radius = radius / setups[-1][1].cells, answer.peak_contact_radius
    at_kink = any(abs(peak_radius - kink) < 2 * cell for kink in scene.indenter.kinks)
    for name in ("contact_radius", "peak_contact_radius"):
        errors[name] = errors[name] + (1.0 if at_kink else EDGE_ERROR) * cell / peak_radius
    return _with_errors(answer, errors)


def history(scene: Scene, settings: Discretisation, *, written: Mapping[str, Setting], log: StageLog) -> HistoryPath:
    """Response to prescribed depths or forces in time, on one strip for the largest contact, with relative errors.

    Three solutions state the errors: with half the cells and half the steps, with half the cells, and the answer.

    Raises:
        InvalidInput: no depth or force is positive.
        UnsupportedSceneError: the force of a dashpot would be infinite.
    """
    setups, by_depth = HistorySetup.resolutions(scene, settings, log), isinstance(scene.loading, DepthHistory)
    values: FloatArray = scene.loading.depth if by_depth else scene.loading.force  # type: ignore[attr-defined]
    if by_depth and values[0] > 0 and setups[0][0].relaxation.viscosity > 0:
        raise UnsupportedSceneError(
            f"loading.depth begins at {values[0]:g} m: a dashpot answers this jump by an infinite force; begin at zero "
            "and give the ramp"
        )
    guess = _radius_of_load(scene, float(values.max()))
    radius, _ = setups[0][0].fitted_radius(1.6 * guess, partial(_prescribed_motion, setups[0][0], values, PILOT_OCTAVE))

    def answer_at(setup: HistorySetup, resolution: Resolution) -> HistoryPath:
        """The history at one resolution of cells and steps."""
        strip = setup.strip(radius, resolution.cells)
        channels = _channels(setup, strip, _prescribed_motion(setup, values, resolution.per_octave, strip), written)
        channels["contact_radius"] = np.where(channels["normal_force"] > 0, channels["contact_radius"], 0.0)
        return HistoryPath(**channels)

    half_both, half_cells, answer = (answer_at(*each) for each in setups)
    pairs = (answer, half_cells), (half_cells, half_both)
    largest, cell = float(answer.contact_radius.max()), radius / setups[-1][1].cells
    refuse_touching_at(scene, largest, log)
    errors = {
        name: SAFETY * np.sum([_change_near(*pair, name, answer, NARROW * cell) for pair in pairs], axis=0) + FLOOR
        for name in answer.ARRAYS
        if name != "time"
    }
    # Pressures of a layer that relaxes do not end like sqrt(a - r): their edge is known to a cell.
    errors["contact_radius"] = errors["contact_radius"] + (1.0 if scene.effects else EDGE_ERROR) * cell / largest
    return _with_errors(answer, errors)


def _pilot(setup: HistorySetup) -> tuple[float, float]:
    """Radius of the strip [m], and the time [s] that is divided into `Resolution.steps` steps.

    That is the contact time, divided by the factor on the number of steps that a strong dashpot needs.

    Raises:
        NotConvergedError: too many equal steps would resolve the stop, or the final velocity is near rounding.
    """
    guess, span = _scales(setup.scene)
    step = span / PILOT_STEPS
    while True:
        radius, motion = setup.fitted_radius(1.6 * guess, partial(_impact_motion, setup, step))
        velocity, contact = motion.velocity, float(motion.time[-1])
        change = float(np.abs(np.diff(velocity)).max() / velocity[0])
        step_factor = max(1.0, change * contact / (200 * step) / WANTED_CHANGE)
        is_fine = len(velocity) > PILOT_STEPS // 2 and change <= LARGEST_CHANGE
        if step_factor > MOST and (is_fine or step < span / PILOT_STEPS):
            raise NotConvergedError(
                "a strong dashpot stops the body far sooner than contact ends: equal steps that follow its stop are "
                f"{step_factor:.3g} times as many as an elastic layer needs, at most {MOST} times are allowed; "
                "the method mdr adapts its steps",
                {"steps_over_usual": step_factor},
            )
        if is_fine:
            break
        step /= 4
    restitution = abs(velocity[-1] / velocity[0])
    if restitution < LEAST_RESTITUTION:
        raise NotConvergedError(
            f"a strong dashpot leaves the body {restitution:.1g} of its velocity: below "
            f"{LEAST_RESTITUTION:g} the end of contact is lost in rounding; use the method mdr",
            {"restitution": restitution},
        )
    return radius, contact / step_factor


def _scales(scene: Scene) -> tuple[float, float]:
    """A contact radius r [m] with E* r f(r)^2 = kinetic energy, and an estimate of the contact time [s].

    The time is 3 f(r) / v_0: Hertz' is 2.94 peak depths over v_0 (Johnson, Contact Mechanics, section 11.4). A flat
    punch on a half-space, of stiffness 2 E* a, is in contact for half a period, ``pi sqrt(M / (2 E* a))``.
    """
    indenter, loading, modulus = scene.indenter, scene.loading, contact_modulus(scene.layer)
    assert isinstance(loading, Impact)
    if isinstance(indenter, FlatPunch):
        return indenter.radius, float(np.pi * np.sqrt(loading.mass / (2 * modulus * indenter.radius)))
    # Kinetic energy / E* [m^3].
    volume = loading.mass * loading.velocity**2 / 2 / modulus
    r = first_radius(indenter, lambda r: r * height(indenter, r) ** 2 >= volume)
    return r, 3 * height(indenter, r) / loading.velocity


def _radius_of_load(scene: Scene, largest: float) -> float:
    """First guess of the contact radius [m] at the largest depth or force: f(r) = delta, or 4 E* r f(r) = F."""
    indenter, load = scene.indenter, largest / (4 * contact_modulus(scene.layer))
    if isinstance(indenter, FlatPunch):
        return indenter.radius
    if largest <= 0:
        raise InvalidInput("the history never presses; give a positive depth or force somewhere")
    if isinstance(scene.loading, DepthHistory):
        return first_radius(indenter, lambda r: height(indenter, r) >= largest)
    return first_radius(indenter, lambda r: r * height(indenter, r) >= load)


def _impact_motion(setup: HistorySetup, duration: float, strip: Strip) -> Motion:
    """Motion of an impact in steps of a duration [s], in the units of the strip."""
    loading: Any = setup.scene.loading
    mass = loading.mass / (shear_modulus(setup.scene.layer) * strip.radius)
    with setup.log.stage("time_steps"):
        motion = simulate_impact(strip, mass, loading.velocity / strip.radius, duration)
    setup.log.count("steps", len(motion.time))
    return motion


def _prescribed_motion(setup: HistorySetup, values: FloatArray, per_octave: int, strip: Strip) -> Motion:
    """Motion under depths [m] or forces [N] at the instants of the loading, in the units of the strip."""
    loading: Any = setup.scene.loading
    by_depth = isinstance(loading, DepthHistory)
    unit = strip.radius * (1.0 if by_depth else shear_modulus(setup.scene.layer) * strip.radius)
    with setup.log.stage("time_steps"):
        steps = segments(loading.time, per_octave)
        motion = simulate_prescribed(strip, loading.time, values / unit, steps, by_depth=by_depth)
    setup.log.count("steps", len(motion.time))
    return motion


def _channels(setup: HistorySetup, strip: Strip, motion: Motion, written: Mapping[str, Setting]) -> dict[str, Any]:
    """Common arguments of `ImpactHistory` and `HistoryPath` in SI units; radii are at least that of a flat end."""
    return {
        "scene": setup.scene,
        "method": "fem",
        "settings": written,
        "error_estimate": {},
        "cost": setup.log.cost(unknowns=strip.modes.unknowns),
        "stages": setup.log.records,
        "time": motion.time,
        "indentation_depth": motion.depth * strip.radius,
        "normal_force": motion.force * shear_modulus(setup.scene.layer) * strip.radius**2,
        "contact_radius": np.maximum(motion.radius * strip.radius, setup.scene.indenter.flat_radius),
    }


def _impact_in_si(setup: HistorySetup, strip: Strip, motion: Motion, written: Mapping[str, Setting]) -> ImpactHistory:
    """The answer in SI units from a motion in the units of its strip, without stated errors."""
    loading: Any = setup.scene.loading
    channels = _channels(setup, strip, motion, written)
    peaks: dict[str, Any] = {name: peak(channels[channel]) for name, channel in PEAKS.items()}
    velocity, energy = motion.velocity * strip.radius, shear_modulus(setup.scene.layer) * strip.radius**3
    return ImpactHistory(
        **channels,
        velocity=velocity,
        kinetic_energy=loading.mass * velocity**2 / 2,
        stored_energy=motion.stored * energy,
        dissipated_energy=motion.dissipated * energy,
        **peaks,
    )


def _with_errors(answer: A, errors: Mapping[str, FloatArray]) -> A:
    """The answer with its stated errors, which are zero for prescribed quantities."""
    exact = exact_names(answer.scene)
    return replace(answer, error_estimate={n: 0.0 * error if n in exact else error for n, error in errors.items()})


def _change(answer: A, companion: A, name: str) -> FloatArray:
    """|answer - companion| of a quantity at the companion's instants, over its largest value, shape (m,)."""
    values, others = getattr(answer, name), getattr(companion, name)
    change = np.abs(np.interp(companion.time, answer.time, values) - others)
    return np.asarray(change / max(np.abs(values).max(), np.finfo(float).tiny))


def _scalar_change(answer: ImpactHistory, companion: ImpactHistory, name: str) -> float:
    """Relative change of a number; of a peak it is at least the largest change of its quantity near the peak.

    The peaks of two resolutions may agree by accident.
    """
    change = abs(float(getattr(companion, name)) / float(getattr(answer, name)) - 1.0)
    if name not in PEAKS:
        return change
    values = getattr(companion, PEAKS[name])
    return max(change, float(_change(answer, companion, PEAKS[name])[values >= NEAR_PEAK * values.max()].max()))


def _change_near(
    answer: HistoryPath, companion: HistoryPath, name: str, final: HistoryPath, narrow: float
) -> FloatArray:
    """Largest `_change` within `WINDOW` instants of each of n instants, plus `SHARE_OF_MEAN` of its mean, shape (n,).

    Args:
        answer: the finer answer.
        companion: the coarser answer, at whose m instants both are compared.
        name: name of the quantity.
        final: the answer of n instants.
        narrow: contact radius [m] below which the change is the largest of all such narrow contacts.
    """
    change, place = _change(answer, companion, name), np.searchsorted(companion.time, final.time)
    near: FloatArray = np.max([change[np.clip(place + k, 0, len(change) - 1)] for k in range(-WINDOW, WINDOW)], axis=0)
    at_narrow = change[companion.contact_radius < narrow].max(initial=0.0)
    return np.asarray(np.maximum(near, at_narrow * (final.contact_radius < narrow)) + SHARE_OF_MEAN * change.mean())


def _end_by_roundings(answer: ImpactHistory) -> float:
    """Last share of the contact time, in which the force is rounding: with a strong dashpot it decays exponentially."""
    pressed = np.flatnonzero(answer.normal_force > ROUNDING_FORCE * answer.peak_force)
    return float(1.0 - answer.time[min(pressed[-1] + 1, len(answer) - 1)] / answer.time[-1])


def peak(values: FloatArray) -> float:
    """Largest value of a smooth sampled function: the vertex of the parabola through the three highest samples."""
    i = int(np.argmax(values))
    if i in (0, len(values) - 1):
        return float(values[i])
    left, top, right = values[i - 1 : i + 2]
    curvature = left - 2 * top + right
    return float(top - (right - left) ** 2 / (8 * curvature)) if curvature < 0 else float(top)
