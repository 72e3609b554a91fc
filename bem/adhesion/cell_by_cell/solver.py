"""Adhesive scenes whose cells let go one by one: equilibria at given depths, and detachment, each on two grids."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bem.adhesion.beside_contact import refuse_touching_beside
from bem.adhesion.cell_by_cell.path import (
    CellHistory,
    branch_errors,
    detachment_branch,
    stable_under_force,
    start_radius,
)
from bem.grid.flat_punch import contact_stiffness
from bem.grid.quadrant import COARSE_CELLS
from contact import ContactPath, DetachmentPath, IndentationDepths, Scene, StageLog, UnsupportedSceneError
from contact.answer.solution import Setting
from contact.records.validation import FloatArray
from contact.scene.loading import Controlled


@dataclass(frozen=True)
class AdheringCells:
    """What is solved on which grids.

    Attributes:
        scene: An adhesive scene.
        points: Cells of the fine grid; the coarse one has half as many.
        threads: Of the transforms.
        settings: Of the method, for the answer.
        log: Stage log.
    """

    scene: Scene
    points: int
    threads: int
    settings: dict[str, Setting]
    log: StageLog

    def equilibria(self) -> ContactPath:
        """At given depths in their order, from out of contact.

        Raises:
            UnsupportedSceneError: If anything but depths is prescribed.
        """
        loading = self.scene.loading
        if not isinstance(loading, IndentationDepths):
            raise UnsupportedSceneError(f"single cells are not followed under {type(loading).__name__}; give depths")
        with self.log.stage("history"):
            fine, coarse = (
                CellHistory.of_depths(self.scene, loading.values, cells, self.threads, self.log)
                for cells in (self.points, self.points // 2)
            )
        self._refuse_touching(fine.contact_radius, loading.values)
        layer, radii = self.scene.layer, fine.contact_radius.tolist()
        return ContactPath(
            scene=self.scene,
            method="bem",
            settings=self.settings,
            cost=self.log.cost(unknowns=self.points**2 // 4),
            stages=self.log.records,
            notes=("depths are followed in their order, from out of contact",),
            error_estimate=fine.errors(coarse),
            contact_radius=fine.contact_radius,
            indentation_depth=loading.values,
            normal_force=fine.normal_force,
            contact_stiffness=np.array([contact_stiffness(layer, a, COARSE_CELLS) if a > 0.0 else 0.0 for a in radii]),
        )

    def detachment(self, control: Controlled) -> DetachmentPath:
        """The branch that is stable under displacement control, from a contact radius to pull-off."""
        with self.log.stage("first_guess"):
            start = start_radius(self.scene, self.threads)
        with self.log.stage("detachment"):
            fine, coarse = (
                detachment_branch(self.scene, start, cells, self.threads, self.log, to_least_force=control == "force")
                for cells in (self.points, self.points // 2)
            )
        self._refuse_touching(fine.contact_radius, fine.indentation_depth)
        end = fine.pull_off(control)
        errors = branch_errors(fine, coarse, control)
        return DetachmentPath(
            scene=self.scene,
            method="bem",
            settings=self.settings,
            cost=self.log.cost(unknowns=self.points**2 // 4),
            stages=self.log.records,
            notes=("only the branch that is stable under displacement control is followed",),
            error_estimate={name: np.atleast_1d(error) for name, error in errors.items()},
            contact_radius=fine.contact_radius,
            indentation_depth=fine.indentation_depth,
            normal_force=fine.normal_force,
            stable_displacement_control=np.ones(len(fine.normal_force), dtype=np.bool_),
            stable_force_control=stable_under_force(fine),
            pull_off_force=float(fine.normal_force[fine.least_force]),
            pull_off_depth=float(fine.indentation_depth[end]),
            pull_off_contact_radius=float(fine.contact_radius[end]),
            force_at_loss=float(fine.normal_force[end]),
            critical_points=fine.critical_points(),
        )

    def _refuse_touching(self, radius: FloatArray, depth: FloatArray) -> None:
        refuse_touching_beside(self.scene, radius, depth, self.points, self.threads)
