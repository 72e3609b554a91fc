"""The theatre of a viscoelastic scene: which surface, which strip, how many cells and steps, which errors are known."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from contact import (
    DepthHistory,
    FlatPunch,
    ForceHistory,
    InvalidInput,
    NotConvergedError,
    Relaxation,
    Scene,
    StageLog,
    Viscoelasticity,
)
from contact.records.validation import FloatArray
from fem_reference.discrete_layer.indenter import ScaledIndenter
from fem_reference.discrete_layer.material import shear_modulus
from fem_reference.discrete_layer.mesh import LayerMesh
from fem_reference.discrete_layer.settings import Discretisation, contact_mesh
from fem_reference.discrete_layer.trace import TraceSpace
from fem_reference.elastic.error_estimate import HALF_SPACE_COEFFICIENT, CertifiedContact, solve_certified_contact
from fem_reference.elastic.surface_compliance import SurfaceCompliance, condense, strip_mesh
from fem_reference.in_time.condensed_layer import Stage
from fem_reference.in_time.errors import KnownErrors
from fem_reference.in_time.field_memory import CompressibleSurface
from fem_reference.in_time.impact import Record
from fem_reference.in_time.surface_memory import ProportionalSurface

FITTINGS = 12
LEAST_TRUNCATION = 1e-7  # far below the errors of cells and steps, and half the mesh of 1e-12
TRUNCATION_SAFETY = 40.0  # on thin layers the force feels the outer edge so much more than the stiffness
EDGE_SCATTER = 0.1  # cells between the true edge of the contact and the one read from the pressures
RIM_SCATTER = 1.0  # the same next to a kink, where pressures do not end like sqrt(a - r)
RIM_REACH = 2.0  # cells
KINKED = 2.0  # measured: errors of truncated profiles reach 1.3 times what half the cells change


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
    return Relaxation(long_term_modulus=shear_modulus(scene.layer), moduli=nothing, times=nothing, viscosity=0.0)


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
        cell = radius / self.resolution.cells
        at_rim = any(abs(peak_radius - kink) < RIM_REACH * cell for kink in self.scene.indenter.kinks)
        return KnownErrors(
            everywhere=thick + TRUNCATION_SAFETY * settings.truncation,
            radius=(RIM_SCATTER if at_rim else EDGE_SCATTER) * cell / peak_radius,
            exact=frozenset(name for name, is_exact in exact.items() if is_exact),
            space=KINKED if self.scene.indenter.kinks else 1.0,
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

    def _profile(self, radii: FloatArray, radius: float) -> FloatArray:
        """Moments of the profile by the strip's radius."""
        space = TraceSpace(radii, 1)
        quadrature, _ = space.gauss(4)
        inside = np.minimum(quadrature * radius, min(radius, self.scene.indenter.max_radius))
        return space.moments(self.scene.indenter.height(inside) / radius, 4)

    def fitted_radius(self, guess: float, simulate: Callable[[Stage], Record]) -> tuple[float, Record]:
        """A strip a quarter larger than the largest contact, and the record of the pilot simulation on it.

        Raises:
            InvalidInput: contact reaches the end of the profile.
            NotConvergedError: no strip fits, or no step presses.
        """
        indenter = self.scene.indenter
        if isinstance(indenter, FlatPunch):
            return indenter.radius, simulate(self.set(indenter.radius, 20))
        radius = min(guess, indenter.max_radius)
        for _ in range(FITTINGS):
            record = simulate(self.set(radius, 30))
            largest = max(record.radius)
            if largest == 0:
                raise NotConvergedError(
                    "the pilot simulation presses at no step: a strong dashpot stops the body, or nothing presses"
                )
            if largest > 0.9:
                if radius >= indenter.max_radius:
                    raise InvalidInput(f"contact reaches the end of the profile at {radius:g} m; load less")
                radius = min(1.6 * radius, indenter.max_radius)
            elif largest < 0.3:
                radius *= max(1.5 * largest, 0.1)
            else:
                return min(1.25 * largest * radius, indenter.max_radius), record
        raise NotConvergedError("no strip of the surface fits the contact", {"strip_radius": radius})
