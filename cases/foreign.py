"""Methods of installed packages take part in every case when they are chosen, with each claim that applies to them.

Such a method follows ``contact.Method``. Its tolerance is the widest one of each claim. A method may state its own
relative accuracy (``claimed_accuracy``, a class attribute, at most 10 %): its tolerance against closed forms and the
fast method is then at most ten times this.

Scenes that prescribe contact radii are restated by depth for methods that take no radii. MDR computes the depths, which
are prescribed to every method compared there, so that their error cancels. Compared are contact radius, force and
stiffness.
"""

import math
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import replace
from numbers import Real
from operator import attrgetter
from typing import Any, Final

from cases.case import Case, CaseScene
from cases.claims import Agree, Approach, Changed, Claim, Equal, Zero
from cases.declare.guarded_method import build_guarded
from cases.declare.methods import REFEREES, MethodUse, build, check_known, load, registered
from contact import ContactError, ContactPath, ContactRadii, IndentationDepths, InvalidInput, Scene
from contact.records.errors import shown

# Largest relative accuracy that a method may claim for itself; agreement within more than 10 % shows nothing.
LARGEST_CLAIM: Final = 0.1
# Tolerance over the accuracy that a method claims. Half of it fails methods slightly beyond their claim, twice of it
# accepts errors of more than one lost digit.
TOLERANCE_OVER_CLAIM: Final = 10.0
SUFFIX: Final = ", restated by depth"
# Quantity compared at a prescribed depth, by the quantity compared at a prescribed radius.
RESTATED: Final = {
    "indentation_depth": "contact_radius",
    "normal_force": "normal_force",
    "contact_stiffness": "contact_stiffness",
}


def with_registered(case: Case, chosen: Collection[str] | None = None) -> Case:
    """Return ``case`` with the registered methods of installed packages.

    Args:
        case: Case with its own methods.
        chosen: Names of methods; None for every registered one except the outside solvers.

    Raises:
        InvalidInput: If such a method cannot be imported, or claims an accuracy that is none.
    """
    labels = {use.label for use in case.methods}
    wanted = [name for name in registered() if name not in REFEREES] if chosen is None else chosen
    names = [name for name in registered() if name in wanted and name not in labels]
    return with_foreign_methods(case, {name: claimed_accuracy(name) for name in names})


def claimed_accuracy(name: str) -> float:
    """Return the relative accuracy that a registered method claims for itself, zero if it claims none.

    Raises:
        InvalidInput: If it is no number from zero to `LARGEST_CLAIM`.
    """
    claimed = getattr(load(name), "claimed_accuracy", 0.0)
    is_number = isinstance(claimed, Real) and not isinstance(claimed, bool)
    if not is_number or not 0 <= claimed <= LARGEST_CLAIM:
        raise InvalidInput(
            f"method {name!r}: claimed_accuracy = {shown(claimed)} is no relative accuracy from 0 to "
            f"{LARGEST_CLAIM:g}; correct it in that package, or uninstall it"
        )
    return float(claimed)


def with_foreign_methods(case: Case, accuracies: Mapping[str, float]) -> Case:
    """Return ``case`` with further methods and the claims that apply to them.

    Claims about single methods extend to them. Agreements compare each with the methods of the case, never with one
    another. Orders of convergence and published residuals belong to the methods of the case and do not extend.

    Args:
        case: Case with its own methods and claims.
        accuracies: Relative accuracies that the methods claim for themselves, by name; zero where one claims none.
    """
    if not accuracies:
        return case
    uses = tuple(MethodUse(label=name) for name in accuracies)
    restated = with_restated(case, accuracies)
    scenes = (replace(scene, methods=(*scene.methods, *uses)) if scene.methods else scene for scene in restated.scenes)
    # The first claims of the restated case are the case's own, on its own scenes.
    extended = (_extended(case, claim, accuracies) for claim in restated.claims[: len(case.claims)])
    others = dict.fromkeys(label for claim in restated.claims if isinstance(claim, Agree) for label in _pair(claim))
    new = (
        claim
        for name, accuracy in accuracies.items()
        for other in others
        for claim in agreements_between(restated, name, other, {name: accuracy}, everywhere=False)
    )
    return replace(case, methods=(*case.methods, *uses), scenes=tuple(scenes), claims=(*extended, *new))


def _extended(case: Case, claim: Any, accuracies: Mapping[str, float]) -> Any:
    """The claim about single methods with more of them; any other claim as it is."""
    if isinstance(claim, Zero) and claim.derive is None:
        return replace(claim, methods=claim.methods or tuple(use.label for use in case.methods))
    if not isinstance(claim, Equal | Changed | Approach | Zero):
        return claim
    widest = max([claim.tolerance, *claim.tolerances.values()])
    limits = {
        name: min(widest, TOLERANCE_OVER_CLAIM * accuracy) if accuracy and isinstance(claim, Equal) else widest
        for name, accuracy in accuracies.items()
    }
    methods = (*claim.methods, *accuracies) if claim.methods else ()
    return replace(claim, methods=methods, tolerances={**claim.tolerances, **limits})


def agreements_between(
    case: Case, first: str, second: str, accuracies: Mapping[str, float], *, everywhere: bool = True
) -> Iterator[Agree]:
    """Yield the agreements of ``first`` with ``second`` in the quantities that ``case`` compares.

    They derive from the case's own agreements, of which the tightest about the pair on a scene sets the tolerance.
    Scenes of equal tolerance share a claim, and no scene is in two.

    Args:
        case: Case with its own claims only.
        first: Label of the method under test.
        second: Label of the method that it is compared with.
        accuracies: Relative accuracies that methods claim for themselves, by label.
        everywhere: Whether all scenes count on which the case compares methods; False: those compared with ``second``.
    """
    compared: dict[str, dict[str, list[Agree]]] = {}
    for claim in case.claims:
        if isinstance(claim, Agree):
            words = claim.quantity.replace("_", " ") + (f", {claim.norm}" if claim.norm else "")
            for scene in claim.scenes_of(case):
                compared.setdefault(words, {}).setdefault(scene.name, []).append(claim)
    for words, by_scene in compared.items():
        groups: dict[float, tuple[Agree, list[str]]] = {}
        for name, claims in by_scene.items():
            if everywhere or any(second in _pair(claim) for claim in claims):
                claim = _deciding(claims, first, second)
                groups.setdefault(claim.tolerance, (claim, []))[1].append(name)
        for tolerance, (claim, scenes) in groups.items():
            name = f"{words}: {first} and {second}"
            yield replace(
                claim,
                name=name if len(groups) == 1 else f"{name}, others within {tolerance:g}",
                scenes=tuple(scenes),
                fast=first,
                reference=second,
                tolerance=min(tolerance, _claimed_tolerance(claim, (first, second), accuracies)),
                # Only these two methods are refined.
                refined=tuple(label for label in claim.refined if label in (first, second)),
            )


def _pair(claim: Agree) -> tuple[str, str]:
    return claim.fast, claim.reference


def _claimed_tolerance(claim: Agree, labels: tuple[str, str], accuracies: Mapping[str, float]) -> float:
    """Ten times the larger accuracy that the pair claims; infinite if a method other than the fast one claims none."""
    claimed = [accuracies.get(label, 0.0) for label in labels if label != claim.fast]
    return TOLERANCE_OVER_CLAIM * max(claimed) if claimed and all(claimed) else math.inf


def _deciding(claims: list[Agree], first: str, second: str) -> Agree:
    """The tightest claim about the pair; without one, the tightest of its less exact method, or of any pair."""
    about = {label: [claim for claim in claims if label in _pair(claim)] for label in (first, second)}
    pair = [claim for claim in about[first] if claim in about[second]]
    if pair:
        return min(pair, key=attrgetter("tolerance"))
    tightest = [min(of_label, key=attrgetter("tolerance")) for of_label in about.values() if of_label]
    return max(tightest, key=attrgetter("tolerance")) if tightest else min(claims, key=attrgetter("tolerance"))


def with_restated(case: Case, names: Iterable[str]) -> Case:
    """Return the case with scenes restated by depth where a method needs them, and its agreements on these last.

    Args:
        case: Case with its own methods and claims.
        names: Names of methods in the table.
    """
    by_depth = {s.name: restated for s in case.scenes if (restated := _restated(s, tuple(names))) is not None}
    if not by_depth:
        return case
    # A claim about all scenes does not extend to the restated ones.
    restricted = tuple(
        replace(claim, scenes=tuple(scene.name for scene in claim.scenes_of(case)))
        if isinstance(claim, Claim)
        else claim
        for claim in case.claims
    )
    new = tuple(agreement for claim in case.claims for agreement in _agreements_by_depth(case, claim, by_depth))
    compared = {name for claim in new for name in claim.scenes}
    restated_scenes = (scene for scene in by_depth.values() if scene.name in compared)
    return replace(case, scenes=(*case.scenes, *restated_scenes), claims=(*restricted, *new))


def _restated(scene: CaseScene, names: tuple[str, ...]) -> CaseScene | None:
    """The scene restated by depth if one of the methods supports it in this form alone; None otherwise."""
    problem = scene.scene
    if not isinstance(problem.loading, ContactRadii) or problem.effects:
        return None
    by_depth = problem.replace(loading=IndentationDepths(values=problem.loading.values))
    if not any(_supports(name, by_depth) and not _supports(name, problem) for name in names):
        return None
    try:
        path = build("mdr", {}).solve(problem)
    except ContactError:
        return None
    if not isinstance(path, ContactPath):
        return None
    return replace(
        scene,
        name=f"{scene.name}{SUFFIX}",
        parameters={**scene.parameters, "restated": "depths that MDR finds for the prescribed radii"},
        scene=problem.replace(loading=IndentationDepths(values=path.indentation_depth)),
    )


def _supports(name: str, problem: Scene, *, broken: bool = False) -> bool:
    """Whether a method supports a scene, or `broken` where `supports` itself fails: `solve` reports that error."""
    try:
        return bool(build_guarded(name, {}).supports(problem))
    except ContactError:
        return broken


def _agreements_by_depth(case: Case, claim: Any, by_depth: Mapping[str, CaseScene]) -> Iterator[Agree]:
    """Yield the agreement of a quantity on the restated scenes; other claims are about prescribed radii alone."""
    if isinstance(claim, Agree) and not claim.norm and claim.quantity in RESTATED:
        names = tuple(by_depth[scene.name].name for scene in claim.scenes_of(case) if scene.name in by_depth)
        if names:
            yield replace(claim, name=f"{claim.name}{SUFFIX}", quantity=RESTATED[claim.quantity], scenes=names)


def against(cases: Collection[Case], methods: Collection[str], others: Collection[str]) -> tuple[Case, ...]:
    """Return the cases that compare methods at all, each of ``methods`` compared with each of ``others``.

    Raises:
        InvalidInput: If a method is unknown or compared with itself, or if no case compares methods.
    """
    for label in (*methods, *others):
        check_known(label, (use.label for case in cases for use in case.methods))
    pairs = [(method, other) for other in others for method in methods if method != other]
    if not pairs:
        raise InvalidInput(f"--against {' '.join(others)}: name with --method what is compared with it")
    accuracies = {label: claimed_accuracy(label) for label in registered() if label in (*methods, *others)}
    compared = []
    for case in (with_restated(case, accuracies) for case in cases):
        claims = tuple(claim for pair in pairs for claim in agreements_between(case, *pair, accuracies))
        compared += [_compared(case, pairs, claims)] if claims else []
    if not compared:
        raise InvalidInput(f"{', '.join(case.name for case in cases)}: methods are not compared there; run it without")
    return tuple(compared)


def _compared(case: Case, pairs: list[tuple[str, str]], claims: tuple[Agree, ...]) -> Case:
    """The case with these claims alone, each of its methods on every scene that a claim is about."""
    labels = tuple(dict.fromkeys(label for pair in pairs for label in pair))
    about = {scene.name for claim in claims for scene in claim.scenes_of(case)}
    scenes = tuple(
        replace(scene, methods=tuple(_use(case, scene, label) for label in labels), nightly=())
        for scene in case.scenes
        if scene.name in about
    )
    uses = tuple(_use(case, case.scenes[0], label) for label in labels)
    return replace(case, scenes=scenes, methods=uses, claims=claims)


def _use(case: Case, scene: CaseScene, label: str) -> MethodUse:
    """The method with the settings of the scene, else of the case, else its defaults."""
    uses = {use.label: use for use in (*case.methods, *case.methods_of(scene))}
    return uses.get(label, MethodUse(label=label))


def beside(case: Case, methods: Collection[str], reference: str) -> Case:
    """Return the case with the claims about ``methods``, and ``reference`` on the scenes that any of them supports.

    No claim is about the reference alone. A scene that no method supports is skipped with their reason.

    Args:
        case: Case with all these methods.
        methods: Labels of the methods under test.
        reference: Label of the method that they are compared with.
    """
    supported = {
        scene.name for scene in case.scenes if any(_supports(label, scene.scene, broken=True) for label in methods)
    }
    restricted = case.only(
        lambda scene, use: use.label in methods or (use.label == reference and scene.name in supported)
    )
    uses = tuple(use for use in case.methods if use.label in (*methods, reference))
    claims = tuple(kept_claim for claim in case.claims for kept_claim in _about(claim, methods))
    return replace(restricted, methods=uses, claims=claims)


def _about(claim: Any, methods: Collection[str]) -> Iterator[Claim]:
    """Yield the claim, restricted to the methods, if it is about any of them."""
    if isinstance(claim, Equal | Changed | Zero | Approach):
        named = tuple(label for label in methods if not claim.methods or label in claim.methods)
        yield from (replace(claim, methods=named),) if named else ()
    elif isinstance(claim, Agree) and claim.fast in methods:
        yield claim
