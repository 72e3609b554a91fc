"""What is left of a case when some methods do not solve some of its scenes: one suite of it, or chosen methods only."""

from collections.abc import Callable, Collection
from dataclasses import replace

from cases.declare.case import Case, CaseScene
from cases.declare.methods import MethodUse
from contact import InvalidInput

Keep = Callable[[CaseScene, MethodUse], bool]


def in_suite(case: Case, suite: str) -> Case:
    """Return the case as ``suite`` runs it: nightly everything, ci without what takes long.

    Without a suite each scene keeps its ``nightly`` methods; studies of cost and effects are those of ci.
    """
    left = _in_ci(case) if suite == "ci" else case
    return replace(
        left,
        work=tuple(study.in_suite(suite) for study in case.work),
        ablations=tuple(study.in_suite(suite) for study in left.ablations),
    )


def _in_ci(case: Case) -> Case:
    """Return the case without its nightly claims and methods."""
    quick = replace(case, claims=tuple(claim for claim in case.claims if not claim.nightly))
    return only(quick, lambda scene, use: use.label not in scene.nightly)


def only_methods(case: Case, wanted: Collection[str]) -> Case:
    """Return the case with the methods asked for (all if none is), without timings and figures of others.

    Raises:
        InvalidInput: if the case has none of the methods.
    """
    if not wanted:
        return case
    methods = tuple(use for use in case.methods if use.label in wanted)
    if not methods:
        known = ", ".join(use.label for use in case.methods)
        raise InvalidInput(f"case {case.name} has no method {' or '.join(wanted)}; it has {known}")
    return replace(only(case, lambda _, use: use.label in wanted), methods=methods, work=(), figures=())


def nightly_only(case: Case) -> frozenset[tuple[str, str]]:
    """Return the scenes and methods that only the nightly suite solves."""
    return frozenset((scene.name, label) for scene in case.scenes for label in scene.nightly)


def only(case: Case, keep: Keep) -> Case:
    """Return the case with the methods that ``keep`` keeps on each scene, and what these can answer."""
    uses = {scene.name: tuple(use for use in case.methods_of(scene) if keep(scene, use)) for scene in case.scenes}
    solvers = {name: {use.label for use in kept} for name, kept in uses.items()}
    scenes = tuple(replace(scene, methods=left, nightly=()) for scene in case.scenes if (left := uses[scene.name]))
    claims = tuple(left for claim in case.claims for left in claim.left(case, solvers))
    ablations = tuple(study.left(solvers) for study in case.ablations)
    return replace(case, scenes=scenes, claims=claims, ablations=ablations, restricted=True)


def only_scenes(case: Case, scenes: Collection[str], methods: Collection[str]) -> Case:
    """Return the case with some of its scenes and methods, and the claims that these can answer."""
    return only(case, lambda scene, use: scene.name in scenes and use.label in methods)
