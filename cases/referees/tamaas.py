"""Tamaas, a grid code with fast transforms: half-spaces, through its operator of a grid that is not repeated.

Adhesion it has on repeated grids only, as a potential of the gap with a range of its own, and driven by forces.  Its
solver of Maxwell's solids is asked without dimensions (`workers.tamaas_creep` says why), under forces that rise.
"""

from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np

from cases.referees import creep, detachment
from cases.referees.grid import box, deepest, refusal, surface
from cases.referees.process import ask, insist, lacks, support, version
from contact import (
    Adhesion,
    ContactPath,
    Detachment,
    DetachmentPath,
    ForceHistory,
    HistoryPath,
    IndentationDepths,
    NormalForces,
    Scene,
    StageLog,
    Supported,
    Unsupported,
    UnsupportedSceneError,
)
from contact.answer.from_depth import inverted
from contact.answer.solution import Setting
from contact.records.validation import FloatArray
from contact.scene.effects import Viscoelasticity

PACKAGE = "tamaas"
# Forces of the difference quotient of the stiffness, relative; of second order, 2e-5 of it for a power law.
STEP = 1e-2
# Range of adhesion in distances of points: the shortest that a grid resolves to one per cent. Pull-off forces of one
# range on 32 and 64 points differ by 0.2 % at a third of the finer distance, 0.6 % at a sixth, 1.8 % at a twelfth
# (R = 10 mm, E* = 1.33 MPa, 0.05 J/m^2; 2026-11-22).
RANGE = 1 / 6


@dataclass(frozen=True, kw_only=True)
class Tamaas:
    """The algorithm of Polonsky and Keer on a square grid.

    Attributes:
        points: of the grid, each way.
        tolerance: of the residual.
        steps: in time, of a whole history.
    """

    name: ClassVar[str] = "tamaas"
    shared_inputs: ClassVar[tuple[str, ...]] = ()

    points: int = 64
    tolerance: float = 1e-9
    steps: int = 20

    def supports(self, scene: Scene) -> Supported | Unsupported:
        """Whether the package is installed and models the scene."""
        if scene.effect(Adhesion):
            by_depth = isinstance(scene.loading, Detachment) and scene.loading.control != "force"
            reason = detachment.refused(scene) or ("with adhesion it is driven by forces" if by_depth else "")
            reason = reason or lacks(PACKAGE)
            return support(reason)
        if scene.effect(Viscoelasticity):
            return support(creep.refused(scene) or lacks(PACKAGE))
        reason = refusal(scene, PACKAGE, (IndentationDepths, NormalForces))
        reason = reason or ("" if scene.layer.is_half_space else "it models half-spaces") or lacks(PACKAGE)
        return support(reason)

    def solve(self, scene: Scene) -> ContactPath | DetachmentPath | HistoryPath:
        """The equilibria; it states no errors."""
        insist(self, scene)
        log = StageLog()
        if scene.effect(Adhesion):
            return self._pulled_off(scene, log)
        if isinstance(scene.loading, ForceHistory):
            return self._crept(scene, scene.loading, log)
        with log.stage("grid"):
            forces = self._forces(scene)
            answer = self._asked(scene, np.multiply.outer(forces, 1.0 + STEP * np.array([-1.0, 0.0, 1.0])).ravel())
        depth, radius = answer["indentation_depth"].reshape(-1, 3), answer["contact_radius"].reshape(-1, 3)
        return ContactPath(
            scene=scene,
            method=self.name,
            settings=self._settings(),
            contact_radius=radius[:, 1],
            indentation_depth=depth[:, 1],
            normal_force=forces,
            contact_stiffness=2.0 * STEP * forces / (depth[:, 2] - depth[:, 0]),
            error_estimate={},
            cost=log.cost(unknowns=self.points**2),
            stages=log.records,
        )

    def refined(self) -> Self:
        """A copy with half the distance of points, and half the steps of time."""
        return replace(self, points=2 * self.points, steps=2 * self.steps)

    def _settings(self) -> dict[str, Setting]:
        return {"points": self.points, "tolerance": self.tolerance, "package": f"{PACKAGE} {version(PACKAGE)}"}

    def _pulled_off(self, scene: Scene, log: StageLog) -> DetachmentPath:
        """Adhesion over a range that shrinks with the distance of points, so that refinement leads to JKR."""
        asked = detachment.numbers(scene)
        with log.stage("grid"):
            found = ask("tamaas_adhesion", {**asked, "points": self.points, "range_in_cells": RANGE})
        note = f"adhesion of a range of {RANGE:.3g} cells, which is finite: JKR is its limit under refinement"
        unknowns = self.points**2
        return detachment.answered(
            scene, found, log, method=self.name, settings=self._settings(), unknowns=unknowns, notes=(note,)
        )

    def _crept(self, scene: Scene, history: ForceHistory, log: StageLog) -> HistoryPath:
        """The states at the instants of the history."""
        asked, size = creep.question(scene, self.points, self.steps)
        with log.stage("grid"):
            found = ask("tamaas_creep", {**asked, "tolerance": self.tolerance})
        depth, radius = (size * found[name] for name in ("indentation_depth", "contact_radius"))
        return HistoryPath(
            scene=scene,
            method=self.name,
            settings={**self._settings(), "steps": self.steps},
            time=history.time,
            indentation_depth=np.insert(depth, 0, 0.0),
            normal_force=history.force,
            contact_radius=np.insert(radius, 0, 0.0),
            error_estimate={},
            cost=log.cost(unknowns=self.points**2),
            stages=log.records,
        )

    def _forces(self, scene: Scene) -> FloatArray:
        """The forces [N] prescribed, or those at which the prescribed depths are reached: it is driven by forces."""
        if isinstance(scene.loading, NormalForces):
            return scene.loading.values
        if not isinstance(scene.loading, IndentationDepths):
            raise UnsupportedSceneError("Tamaas takes depths and forces")
        depths = scene.loading.values
        reach = scene.indenter.flat_radius + depths
        first = scene.layer.contact_modulus * reach * depths
        return inverted(lambda forces: self._asked(scene, forces)["indentation_depth"], depths, first)

    def _asked(self, scene: Scene, forces: FloatArray) -> dict[str, FloatArray]:
        """Depths and radii at each force."""
        layer = scene.layer
        if isinstance(scene.loading, IndentationDepths):
            depth = float(scene.loading.values.max())
        else:
            depth = deepest(scene, float(forces.max()), layer.contact_modulus)
        size = box(scene, depth)
        return ask(
            "tamaas_grid",
            {
                "heights": surface(scene, self.points, size),
                "size": size,
                "young": layer.youngs_modulus,
                "poisson": layer.poissons_ratio,
                "tolerance": self.tolerance,
                "forces": forces.tolist(),
            },
        )
