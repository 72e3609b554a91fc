"""Viscoelastic scenes: which surface, which strip, how many steps; and the answer in SI units with its error.

Every scene is solved three times: with half the cells and half the steps, with half the cells, and as asked.  The
differences are the error estimates, see `history_errors`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from contact import (
    DepthHistory,
    FlatPunch,
    ForceHistory,
    HistoryPath,
    Impact,
    ImpactHistory,
    InvalidInput,
    NotConvergedError,
    Relaxation,
    Scene,
    StageLog,
    Viscoelasticity,
)
from fem_reference.certified import HALF_SPACE_COEFFICIENT, CertifiedContact, solve_certified_contact
from fem_reference.discretisation import Discretisation, contact_mesh
from fem_reference.effects.field_memory import CompressibleSurface
from fem_reference.effects.history import simulate_depths, simulate_forces
from fem_reference.effects.history_errors import KnownErrors, with_errors
from fem_reference.effects.impact import Body, Record, simulate_impact
from fem_reference.effects.stage import Stage
from fem_reference.effects.surface_memory import ProportionalSurface
from fem_reference.geometry import LayerMesh
from fem_reference.indenter import ScaledIndenter
from fem_reference.surface_compliance import SurfaceCompliance, condense, strip_mesh
from fem_reference.trace import TraceSpace

Array = NDArray[np.float64]
Settings = Mapping[str, bool | int | float | str | None]

FITTINGS = 12
LEAST_TRUNCATION = 1e-7  # far below the errors of cells and steps, and half the mesh of 1e-12
TRUNCATION_SAFETY = 40.0  # on thin layers the force feels the outer edge so much more than the stiffness
EDGE_SCATTER = 0.1  # cells between the true edge of the contact and the one read from the pressures


@dataclass(frozen=True)
class Resolution:
    """How finely a history is resolved.

    Attributes:
        cells: cells of the strip.
        steps: time steps of the whole history or contact.
    """

    cells: int
    steps: int


def resolution_of(settings: Discretisation) -> Resolution:
    """Cells and steps shrink with the growth of the meshes."""
    return Resolution(cells=max(20, round(60 / settings.growth)), steps=max(40, round(200 / settings.growth)))


def relaxation_of(scene: Scene) -> Relaxation:
    """The scene's shear relaxation; an elastic layer does not relax."""
    model = scene.effect(Viscoelasticity)
    if model is not None:
        return model.relaxation
    nothing = np.empty(0)
    return Relaxation(long_term_modulus=scene.layer.shear_modulus, moduli=nothing, times=nothing, viscosity=0.0)


class Theatre:
    """Sets the stage for one scene, as often as histories are simulated on it."""

    def __init__(self, scene: Scene, settings: Discretisation, backend: str, log: StageLog) -> None:
        self.scene = scene
        self.relaxation = relaxation_of(scene)
        self.log = log
        self._settings = replace(settings, truncation=max(settings.truncation, LEAST_TRUNCATION))
        self.resolution = resolution_of(settings)
        self._backend = backend
        moduli = self.relaxation.moduli
        self._branches = int(np.count_nonzero(moduli))
        relaxes = self._branches > 0 or self.relaxation.viscosity > 0
        self._needs_field = relaxes and scene.layer.poissons_ratio < 0.5
        self._strips: dict[tuple[float, int], SurfaceCompliance] = {}

    def set(self, radius: float, cells: int) -> Stage:
        """The layer at rest with a strip of ``radius`` [m]."""
        if isinstance(self.scene.indenter, FlatPunch) and not self._needs_field:
            return self._punch_stage(self.scene.indenter, is_fine=cells >= self.resolution.cells)
        if self._needs_field:
            mesh = self._mesh(radius, cells)
            with self.log.stage("factor"):
                field = CompressibleSurface(self.scene.layer, mesh, self._branches, self._backend)
            return Stage(field, field.radii, self._profile(field.radii, radius), radius, field.unknowns)
        strip = self._strip(radius, cells)
        surface = ProportionalSurface(strip.matrix * self._per_shear, strip.resultants, self._branches)
        return Stage(surface, strip.radii, self._profile(strip.radii, radius), radius, strip.unknowns)

    def _strip(self, radius: float, cells: int) -> SurfaceCompliance:
        if (radius, cells) not in self._strips:
            mesh = self._mesh(radius, cells)
            self._strips[radius, cells] = condense(self.scene.layer, mesh, self._backend, self.log)
        return self._strips[radius, cells]

    def known_errors(self, radius: float, peak_radius: float) -> KnownErrors:
        """Errors that halving cells and steps does not show; strip and largest contact radius [m]."""
        layer, settings = self.scene.layer, self._settings
        thick = HALF_SPACE_COEFFICIENT / settings.half_space_thickness if layer.is_half_space else 0.0
        exact = {
            "indentation_depth": isinstance(self.scene.loading, DepthHistory),
            "normal_force": isinstance(self.scene.loading, ForceHistory),
            "contact_radius": isinstance(self.scene.indenter, FlatPunch),
            "peak_contact_radius": isinstance(self.scene.indenter, FlatPunch),
        }
        return KnownErrors(
            everywhere=thick + TRUNCATION_SAFETY * settings.truncation,
            radius=EDGE_SCATTER * radius / (self.resolution.cells * peak_radius),
            exact=frozenset(name for name, is_exact in exact.items() if is_exact),
        )

    @property
    def _per_shear(self) -> float:
        """Compliances are per contact modulus E* = 2 G / (1 - nu); this turns them to unit G."""
        return (1 - self.scene.layer.poissons_ratio) / 2

    def _punch_stage(self, punch: FlatPunch, *, is_fine: bool) -> Stage:
        """A flat punch moves as one: its force is the only unknown, 1 / k_N its compliance.

        In place of half the cells it takes a stiffness that is wrong by the stated error.
        """
        contact = self._punch_contact
        stiffness = contact.answer.stiffness * (1 if is_fine else 1 + contact.error["stiffness"])
        compliance = np.array([[self._per_shear / stiffness]])
        surface = ProportionalSurface(compliance, np.ones(1), self._branches)
        return Stage(surface, np.ones(1), np.zeros(1), punch.radius, contact.answer.unknowns)

    @cached_property
    def _punch_contact(self) -> CertifiedContact:
        indenter = ScaledIndenter(self.scene.indenter, self.scene.indenter.flat_radius)
        return solve_certified_contact(self.scene.layer, indenter, self._settings, self._backend, self.log)

    def _mesh(self, radius: float, cells: int) -> LayerMesh:
        layer, indenter = self.scene.layer, self.scene.indenter
        with self.log.stage("mesh"):
            if isinstance(indenter, FlatPunch):
                return contact_mesh(layer, ScaledIndenter(indenter, radius), replace(self._settings, edge_cell=1e-4))
            return strip_mesh(layer, radius, cells, indenter.kinks, self._settings)

    def _profile(self, radii: Array, radius: float) -> Array:
        """Moments of the profile by the strip's radius."""
        space = TraceSpace(radii, 1)
        quadrature, _ = space.gauss(4)
        inside = np.minimum(quadrature * radius, min(radius, self.scene.indenter.max_radius))
        return space.moments(self.scene.indenter.height(inside) / radius, 4)

    def fitted_radius(self, guess: float, simulate: Callable[[Stage], Record]) -> tuple[float, Record]:
        """A strip a quarter larger than the largest contact, and the record of the pilot simulation on it.

        Raises:
            InvalidInput: contact reaches the end of the profile.
            NotConvergedError: no strip fits.
        """
        indenter = self.scene.indenter
        if isinstance(indenter, FlatPunch):
            return indenter.radius, simulate(self.set(indenter.radius, 20))
        radius = min(guess, indenter.max_radius)
        for _ in range(FITTINGS):
            record = simulate(self.set(radius, 30))
            largest = max(record.radius)
            if largest > 0.9:
                if radius >= indenter.max_radius:
                    raise InvalidInput(f"contact reaches the end of the profile at {radius:g} m; load less")
                radius = min(1.6 * radius, indenter.max_radius)
            elif largest < 0.3:
                radius *= max(1.5 * largest, 0.1)
            else:
                return min(1.25 * largest * radius, indenter.max_radius), record
        raise NotConvergedError("no strip of the surface fits the contact", {"strip_radius": radius})


def impact_history(theatre: Theatre, loading: Impact, shown: Settings) -> ImpactHistory:
    """An impact from first touch to the loss of contact."""
    scene, log = theatre.scene, theatre.log
    modulus = scene.layer.shear_modulus

    def simulate(stage: Stage, duration: float) -> Record:
        body = Body(mass=loading.mass / (modulus * stage.radius), velocity=loading.velocity / stage.radius)
        with log.stage("time_steps"):
            record = simulate_impact(stage, body, theatre.relaxation, duration)
        log.count("steps", len(record.time))
        return record

    guess, span = _impact_scales(scene, loading)
    radius, pilot = theatre.fitted_radius(1.6 * guess, lambda stage: simulate(stage, span / 60))
    duration = pilot.time[-1] / theatre.resolution.steps
    histories = []
    for cells, steps in ((2, 2), (2, 1), (1, 1)):
        stage = theatre.set(radius, theatre.resolution.cells // cells)
        record = simulate(stage, steps * duration)
        histories.append(_impact_in_si(theatre, loading, stage, record, shown))
    coarse, wider, fine = histories
    return with_errors(fine, wider, coarse, theatre.known_errors(radius, fine.peak_contact_radius))


def _impact_scales(scene: Scene, loading: Impact) -> tuple[float, float]:
    """A contact radius [m] with E* r f(r)^2 = kinetic energy, and the time [s] to reach the depth f(r)."""
    if isinstance(scene.indenter, FlatPunch):
        a = scene.indenter.radius
        return a, float(np.pi * np.sqrt(loading.mass / (2 * scene.layer.contact_modulus * a)))
    height, modulus = scene.indenter.height, scene.layer.contact_modulus
    energy = loading.mass * loading.velocity**2 / 2
    r = _radius_where(lambda r: modulus * r * float(height(r)) ** 2 / energy)
    r = min(r, scene.indenter.max_radius)
    return r, 3 * float(height(r)) / loading.velocity


def _impact_in_si(theatre: Theatre, loading: Impact, stage: Stage, record: Record, shown: Settings) -> ImpactHistory:
    scene, log = theatre.scene, theatre.log
    length, modulus = stage.radius, scene.layer.shear_modulus
    energy = modulus * length**3
    force, depth = np.array(record.force), np.array(record.depth)
    velocity = np.array(record.velocity) * length
    radius = np.maximum(np.array(record.radius) * length, scene.indenter.flat_radius)
    return ImpactHistory(
        scene=scene,
        method="fem",
        settings=shown,
        error_estimate={},
        cost=log.cost(unknowns=stage.unknowns),
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


def peak(values: Array) -> float:
    """Largest value of a smooth sampled function: the vertex of the parabola through the three highest samples."""
    i = int(np.argmax(values))
    if i in (0, len(values) - 1):
        return float(values[i])
    left, top, right = values[i - 1 : i + 2]
    curvature = left - 2 * top + right
    return float(top - (right - left) ** 2 / (8 * curvature)) if curvature < 0 else float(top)


def prescribed_history(theatre: Theatre, loading: DepthHistory | ForceHistory, shown: Settings) -> HistoryPath:
    """Response to a prescribed history of depth or force."""
    scene, log = theatre.scene, theatre.log
    modulus = scene.layer.shear_modulus

    def simulate(stage: Stage, steps: int) -> Record:
        with log.stage("time_steps"):
            if isinstance(loading, DepthHistory):
                depth = loading.depth / stage.radius
                record = simulate_depths(stage, theatre.relaxation, loading.time, depth, steps)
            else:
                force = loading.force / (modulus * stage.radius**2)
                record = simulate_forces(stage, theatre.relaxation, loading.time, force, steps)
        log.count("steps", len(record.time))
        return record

    radius, _ = theatre.fitted_radius(1.6 * _history_radius(scene, loading), lambda stage: simulate(stage, 40))
    histories = []
    for cells, steps in ((2, 2), (2, 1), (1, 1)):
        stage = theatre.set(radius, theatre.resolution.cells // cells)
        record = simulate(stage, theatre.resolution.steps // steps)
        histories.append(_history_in_si(theatre, stage, record, shown))
    coarse, wider, fine = histories
    return with_errors(fine, wider, coarse, theatre.known_errors(radius, fine.contact_radius.max()))


def _history_in_si(theatre: Theatre, stage: Stage, record: Record, shown: Settings) -> HistoryPath:
    scene, log, length = theatre.scene, theatre.log, stage.radius
    force, radius = np.array(record.force), np.array(record.radius) * length
    return HistoryPath(
        scene=scene,
        method="fem",
        settings=shown,
        error_estimate={},
        cost=log.cost(unknowns=stage.unknowns),
        stages=log.records,
        time=np.array(record.time),
        indentation_depth=np.array(record.depth) * length,
        normal_force=force * scene.layer.shear_modulus * length**2,
        contact_radius=np.where(force > 0, np.maximum(radius, scene.indenter.flat_radius), 0.0),
    )


def _history_radius(scene: Scene, loading: DepthHistory | ForceHistory) -> float:
    """A contact radius [m] for the largest load: f(r) = delta, or 4 E* r f(r) = F."""
    if isinstance(scene.indenter, FlatPunch):
        return scene.indenter.radius
    height = scene.indenter.height
    if isinstance(loading, DepthHistory):
        largest = float(loading.depth.max())
        radius = _radius_where(lambda r: float(height(r)) / largest) if largest > 0 else 0.0
    else:
        largest = float(loading.force.max())
        stiffness = 4 * scene.layer.contact_modulus
        radius = _radius_where(lambda r: stiffness * r * float(height(r)) / largest) if largest > 0 else 0.0
    if largest <= 0:
        raise InvalidInput("the history never presses; give a positive depth or force somewhere")
    return min(radius, scene.indenter.max_radius)


def _radius_where(ratio: Callable[[float], float]) -> float:
    """Where a growing ratio reaches one."""
    low, high = 1e-15, 1e15
    for _ in range(120):
        middle = float(np.sqrt(low * high))
        low, high = (middle, high) if ratio(middle) < 1 else (low, middle)
    return high
