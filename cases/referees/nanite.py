"""The half-space formulas of nanite, a program that fits force curves: paraboloid and cone, force at depth only."""

import math
from dataclasses import dataclass, replace
from typing import ClassVar, Self

from cases.referees.process import ask, insist, lacks, support, version
from contact import (
    Cone,
    ContactPath,
    ForcePath,
    IndentationDepths,
    NormalForces,
    Paraboloid,
    Scene,
    StageLog,
    Supported,
    Unsupported,
    UnsupportedSceneError,
)
from contact.answer.from_depth import Response, answer_from_depths
from contact.records.validation import FloatArray

PACKAGE = "nanite"


@dataclass(frozen=True, kw_only=True)
class Nanite:
    """Hertz's paraboloid and the cone of Love and Sneddon as nanite has them."""

    name: ClassVar[str] = "nanite"
    shared_inputs: ClassVar[tuple[str, ...]] = ()

    def supports(self, scene: Scene) -> Supported | Unsupported:
        """Whether the package is installed and has a formula for the scene."""
        lacking = {
            "it models half-spaces": not scene.layer.is_half_space,
            "elastic contact only": bool(scene.effects),
            "it has formulas for paraboloids and cones": not isinstance(scene.indenter, Paraboloid | Cone),
            "it takes depths and forces": not isinstance(scene.loading, IndentationDepths | NormalForces),
        }
        reason = next((why for why, lacks_it in lacking.items() if lacks_it), "") or lacks(PACKAGE)
        return support(reason)

    def solve(self, scene: Scene) -> ContactPath | ForcePath:
        """The equilibria; a formula states no errors."""
        insist(self, scene)
        log, shape = StageLog(), _shape(scene)

        def respond(depths: FloatArray) -> Response:
            """What the formula answers at depths."""
            with log.stage("formula"):
                return Response(**ask("nanite_formulas", {**shape, "depths": depths.tolist()}))

        return answer_from_depths(
            scene, respond, log, method=self.name, settings={"package": f"{PACKAGE} {version(PACKAGE)}"}
        )

    def refined(self) -> Self:
        """A copy: a formula has no cells."""
        return replace(self)


def _shape(scene: Scene) -> dict[str, float | str]:
    """The formula by nanite's name, and its parameters; a cone has its half angle in degrees."""
    common: dict[str, float | str] = {"E": scene.layer.youngs_modulus, "nu": scene.layer.poissons_ratio}
    if isinstance(scene.indenter, Paraboloid):
        return {**common, "formula": "hertz_paraboloidal", "R": scene.indenter.radius_of_curvature}
    if isinstance(scene.indenter, Cone):
        return {**common, "formula": "conical_indenter", "alpha": 90.0 - math.degrees(math.atan(scene.indenter.slope))}
    raise UnsupportedSceneError(f"nanite has no formula for a {type(scene.indenter).__name__}")
