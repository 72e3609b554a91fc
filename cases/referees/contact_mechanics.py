"""ContactMechanics, a grid code with fast transforms: half-spaces, and bonded layers of nu < 1/2, which it repeats.

Its layer takes Young's modulus and its half-space takes E*; `workers.contact_mechanics_grid` gives it what it wants.
"""

from dataclasses import dataclass, replace
from typing import ClassVar, Self

from cases.referees.from_depth import Response, answer_from_depths
from cases.referees.grid import box, refusal, surface
from cases.referees.process import ask, insist, lacks, support, version
from contact import (
    ContactPath,
    ForcePath,
    IndentationDepths,
    NormalForces,
    Scene,
    StageLog,
    Supported,
    Unsupported,
)
from contact.answer.solution import Setting
from contact.records.validation import FloatArray

PACKAGE = "ContactMechanics"


@dataclass(frozen=True, kw_only=True)
class ContactMechanics:
    """Constrained conjugate gradients on a square grid.

    Attributes:
        points: of the grid, each way.
        tolerance: of penetration, relative to the depth.
    """

    name: ClassVar[str] = "contact_mechanics"
    shared_inputs: ClassVar[tuple[str, ...]] = ()

    points: int = 64
    tolerance: float = 1e-9

    def supports(self, scene: Scene) -> Supported | Unsupported:
        """Whether the package is installed and models the scene."""
        reason = refusal(scene, PACKAGE, (IndentationDepths, NormalForces))
        layer = scene.layer
        if not reason and not layer.is_half_space and (layer.support != "bonded" or layer.is_incompressible):
            reason = "it models half-spaces, and bonded layers of nu < 1/2"
        reason = reason or lacks(PACKAGE)
        return support(reason)

    def solve(self, scene: Scene) -> ContactPath | ForcePath:
        """The equilibria; it states no errors."""
        insist(self, scene)
        log, layer = StageLog(), scene.layer

        def respond(depths: FloatArray) -> Response:
            """Force, radius and stiffness of the grid at depths [m], shape (n,)."""
            size = box(scene, float(depths.max()))
            with log.stage("grid"):
                answer = ask(
                    "contact_mechanics_grid",
                    {
                        "heights": surface(scene, self.points, size),
                        "size": size,
                        "young": layer.youngs_modulus,
                        "poisson": layer.poissons_ratio,
                        "thickness": None if layer.is_half_space else layer.thickness,
                        "tolerance": self.tolerance,
                        "depths": depths.tolist(),
                    },
                )
            return Response(**answer)

        settings: dict[str, Setting] = {
            "points": self.points,
            "tolerance": self.tolerance,
            "package": f"{PACKAGE} {version(PACKAGE)}",
        }
        return answer_from_depths(scene, respond, log, method=self.name, settings=settings, unknowns=self.points**2)

    def refined(self) -> Self:
        """A copy with half the distance of points."""
        return replace(self, points=2 * self.points)
