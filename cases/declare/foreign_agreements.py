"""Agreements of one method with another that a case does not declare: one a quantity and pair on every scene.

They come from the case's own agreements alone, so that two packages never meet in one claim by chance.  The tightest
that applies to a pair on a scene decides: against MDR, what MDR itself has to meet against its best referee.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Final, TypeAlias

from cases.declare.case import Case
from cases.judgement.claims.agreement import Agreement
from cases.judgement.claims.field_agreement import FieldAgreement

Comparison: TypeAlias = Agreement | FieldAgreement

# A method is held to ten times the accuracy that it claims: with half of it errors of a few digits beyond would fail,
# with twice as much a claim would mean less.
HELD_TO: Final = 10.0


def foreign_agreements(case: Case, name: str, accuracy: float) -> Iterator[Comparison]:
    """Yield the agreements of the method ``name`` with the methods that ``case`` compares with one another.

    Args:
        case: with its own claims only.
        name: label of the method.
        accuracy: relative, that the method claims for itself; zero if it claims none.
    """
    compared = (claim for claim in case.claims if isinstance(claim, Agreement | FieldAgreement))
    for other in dict.fromkeys(label for claim in compared for label in (claim.fast, claim.reference)):
        yield from agreements_between(case, name, other, {name: accuracy}, everywhere=False)


def agreements_between(
    case: Case, first: str, second: str, accuracies: Mapping[str, float], *, everywhere: bool = True
) -> Iterator[Comparison]:
    """Yield the agreements of ``first`` with ``second`` in what ``case`` compares.

    Scenes stand in one claim unless their tolerances differ; no scene stands in two.

    Args:
        case: with its own claims only.
        first: label of the method under test.
        second: label of the method that it is compared with.
        accuracies: relative, that methods claim for themselves, by label.
        everywhere: on every scene where the case compares any methods; otherwise where it compares ``second``.
    """
    for words, by_scene in _by_quantity(case).items():
        groups = _by_tolerance(by_scene if everywhere else _naming(by_scene, second), first, second)
        for tolerance, (claim, scenes) in groups.items():
            name = f"{words}: {first} and {second}"
            new = replace(
                claim,
                name=name if len(groups) == 1 else f"{name}, others within {tolerance:g}",
                scenes=tuple(scenes),
                fast=first,
                reference=second,
                tolerance=min(tolerance, _held_to(claim, (first, second), accuracies)),
            )
            yield new if isinstance(new, Agreement) else _refining(new)


def _held_to(claim: Comparison, labels: tuple[str, str], accuracies: Mapping[str, float]) -> float:
    """Ten times the larger accuracy that the pair claims; infinite where one is not the fast method and claims none."""
    claimed = [accuracies.get(label, 0.0) for label in labels if label != claim.fast]
    return HELD_TO * max(claimed) if claimed and all(claimed) else math.inf


def _by_quantity(case: Case) -> dict[str, dict[str, list[Comparison]]]:
    """The case's own agreements by quantity (a field in its norm) and by scene."""
    found: dict[str, dict[str, list[Comparison]]] = {}
    for claim in case.claims:
        if isinstance(claim, Agreement | FieldAgreement):
            for scene in claim.scenes_of(case):
                found.setdefault(_words(claim), {}).setdefault(scene.name, []).append(claim)
    return found


def _words(claim: Comparison) -> str:
    quantity = claim.quantity.replace("_", " ")
    return f"{quantity}, {claim.norm}" if isinstance(claim, FieldAgreement) else quantity


def _by_tolerance(
    by_scene: Mapping[str, list[Comparison]], first: str, second: str
) -> dict[float, tuple[Comparison, list[str]]]:
    """The claim that decides for each tolerance, with the scenes on which that tolerance applies."""
    groups: dict[float, tuple[Comparison, list[str]]] = {}
    for scene, claims in by_scene.items():
        claim = _deciding(claims, first, second)
        groups.setdefault(claim.tolerance, (claim, []))[1].append(scene)
    return groups


def _naming(by_scene: Mapping[str, list[Comparison]], label: str) -> dict[str, list[Comparison]]:
    """The scenes with a claim about the method."""
    return {scene: claims for scene, claims in by_scene.items() if any(label in (c.fast, c.reference) for c in claims)}


def _deciding(claims: list[Comparison], first: str, second: str) -> Comparison:
    """The tightest claim about the pair; without one, the tightest of its less exact method, or of any pair."""
    about = {label: [claim for claim in claims if label in (claim.fast, claim.reference)] for label in (first, second)}
    pair = [claim for claim in about[first] if claim in about[second]]
    if pair:
        return min(pair, key=_tolerance)
    known = [min(found, key=_tolerance) for found in about.values() if found]
    return max(known, key=_tolerance) if known else min(claims, key=_tolerance)


def _tolerance(claim: Comparison) -> float:
    return claim.tolerance


def _refining(claim: FieldAgreement) -> FieldAgreement:
    """The claim that solves no refinement of other methods than its own."""
    own = tuple(label for label in claim.refined if label in (claim.fast, claim.reference))
    return replace(claim, refined=own)
