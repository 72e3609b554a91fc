"""Agreements of a method of an installed package with each method of a case: one a quantity and pair on every scene.

They come from the case's own agreements alone, so that two packages never meet in one claim.  Where several of those
apply to a pair on a scene, the tightest does: against MDR, what MDR itself has to meet against its best referee.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TypeAlias

from cases.declare.case import Case, CaseScene
from cases.judgement.claims.agreement import Agreement
from cases.judgement.claims.field_agreement import FieldAgreement

Comparison: TypeAlias = Agreement | FieldAgreement


@dataclass(frozen=True)
class _Compared:
    """What is compared with whom: the quantity (a field in its norm), and the label of the case's own method."""

    words: str
    other: str


def foreign_agreements(case: Case, name: str, accuracy: float) -> Iterator[Comparison]:
    """Yield the agreements of the method ``name`` with the methods of ``case``.

    Scenes of one pair stand in one claim unless their tolerances differ; no scene stands in two.

    Args:
        case: with its own claims only.
        name: label of the method.
        accuracy: relative, that the method claims for itself; zero if it claims none.
    """
    for compared, claims in _by_pair(case).items():
        groups = _by_tolerance(claims)
        for tolerance, (claim, scenes) in groups.items():
            words = f"{compared.words}: {name} and {compared.other}"
            yield replace(
                claim,
                name=words if len(groups) == 1 else f"{words}, others within {tolerance:g}",
                scenes=tuple(scenes),
                fast=name,
                reference=compared.other,
                tolerance=max(tolerance, accuracy),
                relaxed=relaxed(name, tolerance, accuracy),
                **_refined(claim, compared.other),
            )


def relaxed(name: str, asked: float, claimed: float) -> dict[str, str]:
    """What is said beside the verdict where a method's own claim widens the tolerance."""
    return {name: f"{name} claims {claimed:.2g}, others meet {asked:.2g}"} if claimed > asked else {}


def _by_pair(case: Case) -> dict[_Compared, dict[str, Comparison]]:
    """The tightest claim by quantity and method of the case, and by scene."""
    found: dict[_Compared, dict[str, Comparison]] = {}
    for claim, scene, other in _comparisons(case):
        claims = found.setdefault(_Compared(_words(claim), other), {})
        known = claims.get(scene.name)
        if known is None or claim.tolerance < known.tolerance:
            claims[scene.name] = claim
    return found


def _comparisons(case: Case) -> Iterator[tuple[Comparison, CaseScene, str]]:
    for claim in case.claims:
        if isinstance(claim, Agreement | FieldAgreement):
            for scene in claim.scenes_of(case):
                yield claim, scene, claim.fast
                yield claim, scene, claim.reference


def _words(claim: Comparison) -> str:
    quantity = claim.quantity.replace("_", " ")
    return f"{quantity}, {claim.norm}" if isinstance(claim, FieldAgreement) else quantity


def _by_tolerance(claims: dict[str, Comparison]) -> dict[float, tuple[Comparison, list[str]]]:
    """The first claim of each tolerance, with the scenes on which that tolerance applies."""
    groups: dict[float, tuple[Comparison, list[str]]] = {}
    for scene, claim in claims.items():
        groups.setdefault(claim.tolerance, (claim, []))[1].append(scene)
    return groups


def _refined(claim: Comparison, other: str) -> dict[str, tuple[str, ...]]:
    """Refinements that stand for a missing uncertainty are solved for the pair alone."""
    if isinstance(claim, Agreement):
        return {}
    return {"refined": tuple(label for label in claim.refined if label == other)}
