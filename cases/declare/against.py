"""A case as a comparison of chosen methods with others: on all its scenes, or with one referee where they solve it."""

from collections.abc import Collection, Iterator
from dataclasses import replace

from cases.declare.case import Case, CaseScene, ClaimOfCase
from cases.declare.foreign.restated import with_restated
from cases.declare.foreign_agreements import agreements_between
from cases.declare.foreign_methods import claimed_accuracy
from cases.declare.guarded_method import BrokenMethodError, build_guarded
from cases.declare.methods import MethodUse, check_known, registered
from cases.declare.selection import only
from cases.judgement.claims.agreement import Agreement
from cases.judgement.claims.declared import PerMethod
from cases.judgement.claims.field_agreement import FieldAgreement
from contact import InvalidInput


def against(cases: Collection[Case], methods: Collection[str], others: Collection[str]) -> tuple[Case, ...]:
    """Return the cases that compare methods at all, each of ``methods`` compared with each of ``others``.

    Raises:
        InvalidInput: if a method is unknown or compared with itself, or if no case compares methods.
    """
    for label in (*methods, *others):
        check_known(label, (use.label for case in cases for use in case.methods))
    pairs = [(one, other) for other in others for one in methods if one != other]
    if not pairs:
        raise InvalidInput(f"--against {' '.join(others)}: name with --method what is compared with it")
    accuracies = {label: claimed_accuracy(label) for label in registered() if label in (*methods, *others)}
    asked = [with_restated(case, accuracies) for case in cases]
    found = [(case, tuple(_agreements(case, pairs, accuracies))) for case in asked]
    compared = tuple(_compared(case, pairs, claims) for case, claims in found if claims)
    if not compared:
        raise InvalidInput(f"{', '.join(case.name for case in cases)}: methods are not compared there; run it without")
    return compared


def beside(case: Case, methods: Collection[str], referee: str) -> Case:
    """Return the case with what is claimed of ``methods``, and ``referee`` on the scenes that one of them supports.

    Nothing is claimed of the referee alone.  Where no method supports any scene, all are compared: skipped by reason.

    Args:
        case: with all these methods.
        methods: labels of those under test.
        referee: label of the method that they are compared with.
    """
    supported = {scene.name for scene in case.scenes if any(_supports(scene, label) for label in methods)}
    compared = supported or {scene.name for scene in case.scenes}
    left = only(case, lambda scene, use: use.label in methods or (use.label == referee and scene.name in compared))
    claims = tuple(own for claim in left.claims for own in _about(claim, methods))
    uses = tuple(use for use in case.methods if use.label in (*methods, referee))
    return replace(left, methods=uses, claims=claims, work=(), ablations=(), figures=())


def _supports(scene: CaseScene, label: str) -> bool:
    """Whether the method supports the scene; one that breaks down when it is asked tells so when it solves."""
    try:
        return bool(build_guarded(label, {}).supports(scene.scene))
    except BrokenMethodError:
        return True


def _about(claim: ClaimOfCase, methods: Collection[str]) -> Iterator[ClaimOfCase]:
    """The claim as far as it is about one of the methods."""
    if isinstance(claim, PerMethod):
        named = tuple(label for label in methods if not claim.methods or label in claim.methods)
        yield from (replace(claim, methods=named),) if named else ()
    elif isinstance(claim, Agreement | FieldAgreement) and claim.fast in methods:
        yield claim


def _agreements(case: Case, pairs: list[tuple[str, str]], accuracies: dict[str, float]) -> Iterator[ClaimOfCase]:
    for one, other in pairs:
        yield from agreements_between(case, one, other, accuracies)


def _compared(case: Case, pairs: list[tuple[str, str]], claims: tuple[ClaimOfCase, ...]) -> Case:
    """The case with these claims alone, each of its methods on every scene that a claim is about."""
    labels = tuple(dict.fromkeys(label for pair in pairs for label in pair))
    about = {scene.name for claim in claims for scene in claim.scenes_of(case)}
    scenes = tuple(
        replace(scene, methods=tuple(_use(case, scene, label) for label in labels), nightly=())
        for scene in case.scenes
        if scene.name in about
    )
    uses = tuple(_use(case, case.scenes[0], label) for label in labels)
    return replace(case, scenes=scenes, methods=uses, claims=claims, work=(), ablations=(), figures=())


def _use(case: Case, scene: CaseScene, label: str) -> MethodUse:
    """The method as the scene, or else the case, has it; or with the settings it comes with."""
    known = {use.label: use for use in (*case.methods, *case.methods_of(scene))}
    return known.get(label, MethodUse(label=label))
