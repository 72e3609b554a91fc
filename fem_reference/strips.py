"""Condensed layers of a scene in time: the strip of the surface that its contact needs, its cells, and time steps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from contact import FlatPunch, InvalidInput, NotConvergedError, Scene, StageLog
from contact.records.validation import FloatArray
from fem_reference.materials import Parts, relaxation_of
from fem_reference.memory import Modes, Top, compressible_modes, proportional_modes
from fem_reference.mesh import Section
from fem_reference.motions import CondensedLayer, Samples
from fem_reference.prescribed_contact import solve_contact
from fem_reference.profiles import ScaledIndenter, shape
from fem_reference.settings import Discretisation, contact_section
from fem_reference.surface import condense, strip_section
from fem_reference.trace import TraceSpace

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
