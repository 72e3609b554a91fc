"""The closed forms of Johnson, Kendall and Roberts as the package Adhesion has them: a paraboloid off a half-space."""

from dataclasses import dataclass, replace
from typing import ClassVar, Self

from cases.referees import detachment
from cases.referees.process import ask, insist, lacks, support, version
from contact import Detachment, DetachmentPath, Scene, StageLog, Supported, Unsupported
from contact.answer.solution import Setting

PACKAGE = "Adhesion"


@dataclass(frozen=True, kw_only=True)
class Jkr:
    """Force and depth at contact radii, and the radius at which contact is lost by minimising either.

    Attributes:
        states: of the branch.
    """

    name: ClassVar[str] = "adhesion_jkr"
    shared_inputs: ClassVar[tuple[str, ...]] = ()

    states: int = 50

    def supports(self, scene: Scene) -> Supported | Unsupported:
        """Whether the package is installed and has closed forms for the scene."""
        reason = detachment.refused(scene) or lacks(PACKAGE)
        return support(reason)

    def solve(self, scene: Scene) -> DetachmentPath:
        """The branch down to the loss of contact; closed forms state no errors."""
        insist(self, scene)
        log = StageLog()
        by_force = isinstance(scene.loading, Detachment) and scene.loading.control == "force"
        with log.stage("closed forms"):
            found = ask("adhesion_jkr", {**detachment.numbers(scene), "by_force": by_force, "states": self.states})
        settings: dict[str, Setting] = {"states": self.states, "package": f"{PACKAGE} {version(PACKAGE)}"}
        return detachment.answered(scene, found, log, method=self.name, settings=settings)

    def refined(self) -> Self:
        """A copy with twice the states, and half the steps of the differences that find where contact is lost."""
        return replace(self, states=2 * self.states)
