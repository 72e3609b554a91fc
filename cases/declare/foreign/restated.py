"""Scenes that prescribe contact radii, asked by depth of methods that take no radii.

The depths are those that MDR finds for the radii. They are prescribed to every method that is compared there, so that
none of their error enters: compared are the contact radius, which must come back, force and stiffness. A radius is
asked for as exactly as the depth was: a depth grows at least like the radius, so its relative error is no smaller.
"""

from collections.abc import Iterable, Iterator
from dataclasses import replace

from cases.declare.case import Case, CaseScene, ClaimOfCase
from cases.declare.guarded_method import build_guarded
from cases.declare.methods import build
from cases.judgement.claims.agreement import Agreement
from contact import ContactError, ContactPath, ContactRadii, IndentationDepths, Scene

SUFFIX = ", restated by depth"
# What is compared where a depth is prescribed, by what is compared where a radius is.
COMPARED = {
    "indentation_depth": "contact_radius",
    "normal_force": "normal_force",
    "contact_stiffness": "contact_stiffness",
}


def with_restated(case: Case, names: Iterable[str]) -> Case:
    """Return the case with such twins of its scenes as one of the methods needs, and its own agreements on them last.

    Args:
        case: with its own methods and claims.
        names: of methods, as the table knows them.
    """
    needed = {scene.name: twin for scene in case.scenes if (twin := _twin(scene, tuple(names))) is not None}
    if not needed:
        return case
    own = (_of_its_scenes(case, claim) for claim in case.claims)
    new = (twin for claim in case.claims for twin in _on_twins(case, claim, needed))
    return replace(case, scenes=(*case.scenes, *needed.values()), claims=(*own, *new))


def _twin(scene: CaseScene, names: tuple[str, ...]) -> CaseScene | None:
    """The scene by depth, where a method takes it only so."""
    problem = scene.scene
    if not isinstance(problem.loading, ContactRadii) or problem.effects:
        return None
    if not any(_only_by_depth(name, problem) for name in names):
        return None
    try:
        found = build("mdr", {}).solve(problem)
    except ContactError:
        return None
    if not isinstance(found, ContactPath):
        return None
    return replace(
        scene,
        name=f"{scene.name}{SUFFIX}",
        parameters={**scene.parameters, "restated": "depths that MDR finds for the prescribed radii"},
        scene=problem.replace(loading=IndentationDepths(values=found.indentation_depth)),
    )


def _only_by_depth(name: str, problem: Scene) -> bool:
    """Whether a method refuses the radii of a scene and takes depths; any depths of their number will do to ask."""
    by_depth = problem.replace(loading=IndentationDepths(values=problem.loading.values))  # type: ignore[attr-defined]  # radii
    try:
        method = build_guarded(name, {})
        return not method.supports(problem) and bool(method.supports(by_depth))
    except ContactError:
        # What breaks here tells so where it solves.
        return False


def _of_its_scenes(case: Case, claim: ClaimOfCase) -> ClaimOfCase:
    """The claim by the names of its scenes: one about all of them says nothing of their twins."""
    return replace(claim, scenes=tuple(scene.name for scene in claim.scenes_of(case)))  # type: ignore[type-var]  # a claim is a record


def _on_twins(case: Case, claim: ClaimOfCase, twins: dict[str, CaseScene]) -> Iterator[ClaimOfCase]:
    """An agreement of quantities on the twins of its scenes; whatever else is claimed speaks of the radii alone."""
    if isinstance(claim, Agreement) and claim.quantity in COMPARED:
        names = tuple(twins[scene.name].name for scene in claim.scenes_of(case) if scene.name in twins)
        if names:
            yield replace(claim, name=f"{claim.name}{SUFFIX}", quantity=COMPARED[claim.quantity], scenes=names)
