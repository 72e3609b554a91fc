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
<<<<<<< HEAD
        lacking = {
            "it models half-spaces": not scene.layer.is_half_space,
            "adhesion alone, no other effect": len(scene.effects) != 1 or scene.effect(Adhesion) is None,
            "it has closed forms for paraboloids": not isinstance(scene.indenter, Paraboloid),
            "it takes a detachment by a rigid machine or a force": not _is_plain(scene),
        }
        reason = next((why for why, lacks_it in lacking.items() if lacks_it), "") or lacks(PACKAGE)
        return Unsupported(reason) if reason else Supported()
=======
        reason = detachment.refused(scene) or lacks(PACKAGE)
        return support(reason)
>>>>>>> b17

    def solve(self, scene: Scene) -> DetachmentPath:
        """The branch down to the loss of contact; closed forms state no errors."""
        insist(self, scene)
        log = StageLog()
        by_force = isinstance(scene.loading, Detachment) and scene.loading.control == "force"
        with log.stage("closed forms"):
<<<<<<< HEAD
            found = ask("adhesion_jkr", {**_numbers(scene, adhesion), "by_force": by_force, "states": self.states})
        radius, lost = found["contact_radius"], found["force_control"][0]
        return DetachmentPath(
            scene=scene,
            method=self.name,
            settings={"states": self.states, "package": f"{PACKAGE} {version(PACKAGE)}"},
            contact_radius=radius,
            indentation_depth=found["indentation_depth"],
            normal_force=found["normal_force"],
            stable_displacement_control=np.ones(radius.size, dtype=bool),
            stable_force_control=radius >= lost,
            pull_off_force=float(found["normal_force"].min() if not by_force else found["normal_force"][-1]),
            pull_off_depth=float(found["indentation_depth"][-1]),
            pull_off_contact_radius=float(radius[-1]),
            force_at_loss=float(found["normal_force"][-1]),
            error_estimate={},
            cost=log.cost(unknowns=1),
            stages=log.records,
        )
=======
            found = ask("adhesion_jkr", {**detachment.numbers(scene), "by_force": by_force, "states": self.states})
        settings: dict[str, Setting] = {"states": self.states, "package": f"{PACKAGE} {version(PACKAGE)}"}
        return detachment.answered(scene, found, log, method=self.name, settings=settings)
>>>>>>> b17

    def refined(self) -> Self:
        """A copy with twice the states."""
        return replace(self, states=2 * self.states)
<<<<<<< HEAD


def _is_plain(scene: Scene) -> bool:
    return isinstance(scene.loading, Detachment) and scene.loading.controlled != "machine"


def _numbers(scene: Scene, adhesion: Adhesion) -> dict[str, float]:
    """What the closed forms need."""
    if not isinstance(scene.indenter, Paraboloid):
        raise UnsupportedSceneError("closed forms for paraboloids only")
    return {
        "radius": scene.indenter.radius_of_curvature,
        "contact_modulus": scene.layer.youngs_modulus / (1.0 - scene.layer.poissons_ratio**2),
        "work_of_adhesion": adhesion.work_of_adhesion,
    }
=======
>>>>>>> b17
