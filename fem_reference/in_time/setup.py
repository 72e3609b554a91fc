"""Sets up the condensed layer of a scene in time: its strip, its cells and steps, and the errors known beforehand."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from contact import (
    DepthHistory,
    FlatPunch,
    ForceHistory,
    InvalidInput,
    NotConvergedError,
    Scene,
    StageLog,
)
from contact.records.validation import FloatArray
from fem_reference.discrete_layer.indenter import ScaledIndenter, height, shape
from fem_reference.discrete_layer.mesh import LayerMesh
from fem_reference.discrete_layer.settings import Discretisation, contact_mesh
from fem_reference.discrete_layer.trace import TraceSpace
from fem_reference.elastic.error_estimate import ContactWithErrors, solve_contact_with_errors
from fem_reference.elastic.surface_compliance import SurfaceCompliance, condense, strip_mesh
from fem_reference.error_model import FIXED_RADIUS, IN_TIME
from fem_reference.in_time.condensed_layer import CondensedLayer
from fem_reference.in_time.errors import KnownErrors
from fem_reference.in_time.impact import HistorySamples
from fem_reference.in_time.relaxation import relaxation_of
from fem_reference.in_time.top import compressible_top, proportional_top

# Growth of cells away from a strip of 120 cells.  The energy of a contact errs like 1 / cells^3, and so does the peak
# depth, which follows from it; the mesh outside must not add more.  Measured on a relaxing layer (a/h = 0.8,
# 400 steps, 2026-11-22): from 20 to 40, 80, 160 and 240 cells the peak depth changed by 5e-5, 7e-6, 6e-6 and 2e-6
# with a growth of one, like 1 / cells, and by 9e-6, 1.3e-6, 2e-7 and 4e-7 with this one.
OUTSIDE = 0.6


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


class HistorySetup:
    """Condensed layers of one scene, a fresh one for every history that is simulated."""

    def __init__(self, scene: Scene, settings: Discretisation, backend: str, log: StageLog) -> None:
        self.scene = scene
        self.relaxation = relaxation_of(scene)
        self.log = log
        # Below 1e-7 the outer edge adds nothing to the errors of cells and steps; 1e-12 would double the mesh.
        self._settings = replace(settings, truncation=max(settings.truncation, 1e-7))
        self.resolution = resolution_of(settings)
        self._backend = backend
        moduli = self.relaxation.moduli
        self._branches = int(np.count_nonzero(moduli))
        relaxes = self._branches > 0 or self.relaxation.viscosity > 0
        self._needs_field = relaxes and scene.layer.poissons_ratio < 0.5
        self._strips: dict[tuple[float, int], SurfaceCompliance] = {}

    def condensed(self, radius: float, cells: int) -> CondensedLayer:
        """The layer at rest with a strip of ``radius`` [m]."""
        if isinstance(self.scene.indenter, FlatPunch) and not self._needs_field:
            return self._condensed_punch(self.scene.indenter, is_fine=cells >= self.resolution.cells)
        if self._needs_field:
            mesh = self._mesh(radius, cells)
            with self.log.stage("factor"):
                top, radii, unknowns = compressible_top(self.scene.layer, mesh, self._branches, self._backend)
            return CondensedLayer(top, radii, self._profile(radii, radius), radius, unknowns)
        strip = self._strip(radius, cells)
        surface = proportional_top(strip.matrix * self._per_shear, strip.resultants, self._branches)
        return CondensedLayer(surface, strip.radii, self._profile(strip.radii, radius), radius, strip.unknowns)

    def _strip(self, radius: float, cells: int) -> SurfaceCompliance:
        if (radius, cells) not in self._strips:
            mesh = self._mesh(radius, cells)
            self._strips[radius, cells] = condense(self.scene.layer, mesh, self._backend, self.log)
        return self._strips[radius, cells]

    def known_errors(self, radius: float, peak_radius: float) -> KnownErrors:
        """Errors that halving cells and steps does not show; strip and largest contact radius [m]."""
        layer, settings = self.scene.layer, self._settings
        thick = FIXED_RADIUS.half_space / settings.half_space_thickness if layer.is_half_space else 0.0
        exact = {
            "indentation_depth": isinstance(self.scene.loading, DepthHistory),
            "normal_force": isinstance(self.scene.loading, ForceHistory),
            "contact_radius": isinstance(self.scene.indenter, FlatPunch),
            "peak_contact_radius": isinstance(self.scene.indenter, FlatPunch),
        }
        cell = radius / self.resolution.cells
        kinks = self._seen(self.scene.indenter.kinks, cell)
        at_rim = any(abs(peak_radius - kink) < IN_TIME.kink_reach * cell for kink in kinks)
        return KnownErrors(
            everywhere=thick + IN_TIME.outer_edge_safety * settings.truncation,
            radius=(IN_TIME.edge_reading_at_kink if at_rim else IN_TIME.edge_reading) * cell / peak_radius,
            exact=frozenset(name for name, is_exact in exact.items() if is_exact),
            cell=cell,
            space=IN_TIME.kinked_profile if kinks else 1.0,
            heights=self._heights(cell),
        )

    def _heights(self, cell: float) -> float:
        """Height at a cell [m] over that at half a cell; zero where contact does not end like that of a power."""
        indenter = self.scene.indenter
        damped = self._branches > 0 or self.relaxation.viscosity > 0
        if damped or self._seen(indenter.breakpoints, cell) or isinstance(indenter, FlatPunch):
            return 0.0
        return height(indenter, cell) / height(indenter, cell / 2)

    @staticmethod
    def _seen(kinks: Sequence[float], cell: float) -> list[float]:
        """Kinks [m] that cells [m] see: contact ends before it is as narrow as a flat end far inside the first."""
        return [kink for kink in kinks if kink > IN_TIME.unseen_kink * cell]

    @property
    def _per_shear(self) -> float:
        """Compliances are per contact modulus E* = 2 G / (1 - nu); this turns them to unit G."""
        return (1 - self.scene.layer.poissons_ratio) / 2

    def _condensed_punch(self, punch: FlatPunch, *, is_fine: bool) -> CondensedLayer:
        """A flat punch moves as one: its force is the only unknown, 1 / k_N its compliance.

        In place of half the cells it takes a stiffness that is wrong by the stated error.
        """
        contact = self._punch_contact
        stiffness = contact.answer.stiffness * (1 if is_fine else 1 + contact.error["stiffness"])
        compliance = np.array([[self._per_shear / stiffness]])
        surface = proportional_top(compliance, np.ones(1), self._branches)
        return CondensedLayer(surface, np.ones(1), np.zeros(1), punch.radius, contact.answer.unknowns)

    @cached_property
    def _punch_contact(self) -> ContactWithErrors:
        indenter = ScaledIndenter(self.scene.indenter, self.scene.indenter.flat_radius)
        return solve_contact_with_errors(self.scene.layer, indenter, self._settings, self._backend, self.log)

    def _mesh(self, radius: float, cells: int) -> LayerMesh:
        layer, indenter = self.scene.layer, self.scene.indenter
        with self.log.stage("mesh"):
            if isinstance(indenter, FlatPunch):
                return contact_mesh(layer, ScaledIndenter(indenter, radius), replace(self._settings, edge_cell=1e-4))
            return strip_mesh(layer, radius, cells, indenter.kinks, self._settings, outside=OUTSIDE)

    def _profile(self, radii: FloatArray, radius: float) -> FloatArray:
        """Moments of the profile by the strip's radius."""
        space = TraceSpace(radii, 1)
        quadrature, _ = space.gauss(4)
        inside = np.minimum(quadrature * radius, min(radius, self.scene.indenter.max_radius))
        return space.moments(shape(self.scene.indenter, inside).height / radius, 4)

    def fitted_radius(
        self, guess: float, simulate: Callable[[CondensedLayer], HistorySamples]
    ) -> tuple[float, HistorySamples]:
        """A strip a quarter larger than the largest contact, and the record of the pilot simulation on it.

        Raises:
            InvalidInput: contact reaches the end of the profile.
            NotConvergedError: no strip fits, or no step presses.
        """
        indenter = self.scene.indenter
        if isinstance(indenter, FlatPunch):
            return indenter.radius, simulate(self.condensed(indenter.radius, 20))
        radius = min(guess, indenter.max_radius)
        for _ in range(12):
            record = simulate(self.condensed(radius, 30))
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
