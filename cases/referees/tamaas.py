"""Tamaas, a grid code with fast transforms: elastic half-spaces, by its operator of a grid that is not repeated."""

from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np

from cases.referees.from_depth import inverted
from cases.referees.grid import box, deepest, refusal, surface
from cases.referees.process import ask, insist, lacks, support, version
from contact import (
    ContactPath,
    IndentationDepths,
    NormalForces,
    Scene,
    StageLog,
    Supported,
    Unsupported,
    UnsupportedSceneError,
)
from contact.answer.solution import Setting
from contact.records.validation import FloatArray

PACKAGE = "tamaas"
# Forces of the difference quotient of the stiffness, relative; of second order, 2e-5 of it for a power law.
STEP = 1e-2


@dataclass(frozen=True, kw_only=True)
class Tamaas:
    """The algorithm of Polonsky and Keer on a square grid.

    Attributes:
        points: of the grid, each way.
        tolerance: of the residual.
    """

    name: ClassVar[str] = "tamaas"
    shared_inputs: ClassVar[tuple[str, ...]] = ()

    points: int = 64
    tolerance: float = 1e-9

    def supports(self, scene: Scene) -> Supported | Unsupported:
        """Whether the package is installed and models the scene."""
        reason = refusal(scene, PACKAGE, (IndentationDepths, NormalForces))
        reason = reason or ("" if scene.layer.is_half_space else "it models half-spaces") or lacks(PACKAGE)
        return support(reason)

    def solve(self, scene: Scene) -> ContactPath:
        """The equilibria; it states no errors."""
        insist(self, scene)
        log = StageLog()
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
        """A copy with half the distance of points."""
        return replace(self, points=2 * self.points)

    def _settings(self) -> dict[str, Setting]:
        return {"points": self.points, "tolerance": self.tolerance, "package": f"{PACKAGE} {version(PACKAGE)}"}

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
