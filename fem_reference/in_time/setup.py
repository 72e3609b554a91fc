"""Condensed layers of a scene in time: the strip that its contact needs, cells and steps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from contact import FlatPunch, InvalidInput, NotConvergedError, Scene, StageLog
from contact.records.validation import FloatArray
from fem_reference.discrete_layer.indenter import ScaledIndenter, shape
from fem_reference.discrete_layer.mesh import LayerMesh
from fem_reference.discrete_layer.settings import Discretisation, contact_mesh
from fem_reference.discrete_layer.trace import TraceSpace
from fem_reference.elastic.prescribed_radius import solve_contact
from fem_reference.elastic.surface_compliance import condense, strip_mesh
from fem_reference.in_time.motions import CondensedLayer, Samples
from fem_reference.in_time.relaxation import relaxation_of
from fem_reference.in_time.top import Modes, Top, compressible_modes, proportional_modes

# Growth of cells away from a strip of 120 cells.  With a growth of one the mesh outside moves peak depths by 5e-5.
# Not measured: half of it.
OUTSIDE = 0.6
# Tolerance of the outer edge below which cells and steps err more: not measured: half and twice.
TRUNCATION = 1e-7
# Cells of the strip of pilot simulations.
PILOT_CELLS = 30


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

    def condensed(self, radius: float, cells: int) -> CondensedLayer:
        """The layer at rest with a strip of ``radius`` [m]."""
        if (radius, cells) not in self._modes:
            self._modes[radius, cells] = self._condense(radius, cells)
        modes = self._modes[radius, cells]
        is_punch = len(modes.radii) == 1
        profile = np.zeros(1) if is_punch else self._profile(modes.radii, radius)
        return CondensedLayer(Top(modes, self.relaxation), modes.radii, profile, radius, modes.unknowns)

    def _condense(self, radius: float, cells: int) -> Modes:
        layer, per_shear = self.scene.layer, (1 - self.scene.layer.poissons_ratio) / 2  # E* = 2 G / (1 - nu)
        if self._needs_field:
            mesh = self._mesh(radius, cells)
            with self.log.stage("factor"):
                return compressible_modes(layer, mesh, self._backend)
        if isinstance(self.scene.indenter, FlatPunch):
            # It moves as one: its force is the only unknown, 1 / k_N its compliance.
            contact = solve_contact(self.scene, radius, self._settings, self.log, backend=self._backend)
            compliance = np.array([[per_shear / contact.stiffness]])
            return proportional_modes(compliance, np.ones(1), np.ones(1), contact.unknowns)
        strip = condense(layer, self._mesh(radius, cells), self._backend, self.log)
        return proportional_modes(strip.matrix * per_shear, strip.resultants, strip.radii, strip.unknowns)

    def _mesh(self, radius: float, cells: int) -> LayerMesh:
        layer, indenter = self.scene.layer, self.scene.indenter
        with self.log.stage("mesh"):
            if isinstance(indenter, FlatPunch):
                settings = replace(self._settings, edge_cell=1e-4 * self._settings.coarsening**6)
                return contact_mesh(layer, ScaledIndenter(indenter, radius), settings)
            return strip_mesh(layer, radius, cells, indenter.kinks, self._settings, outside=OUTSIDE)

    def _profile(self, radii: FloatArray, radius: float) -> FloatArray:
        """Moments of the profile by the strip's radius."""
        space = TraceSpace(radii, 1)
        quadrature, _ = space.gauss(4)
        inside = np.minimum(quadrature * radius, min(radius, self.scene.indenter.max_radius))
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
            if largest > 0.9:
                if radius >= indenter.max_radius:
                    raise InvalidInput(f"contact reaches the end of the profile at {radius:g} m; load less")
                radius = min(1.6 * radius, indenter.max_radius)
            elif largest < 0.3:
                radius *= max(1.5 * largest, 0.1)
            else:
                return min(1.25 * largest * radius, indenter.max_radius), record
        raise NotConvergedError("no strip of the surface fits the contact", {"strip_radius": radius})
