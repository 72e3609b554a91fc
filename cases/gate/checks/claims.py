"""Claims that were accepted with a case: none may vanish, and none may speak of fewer scenes than it did."""

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import replace

from cases.gate.baseline import AcceptedClaim, Baseline
from cases.gate.checks.check import BaselineCheck
from cases.judgement.rules.judgement import nothing_compared
from cases.results.records.claim import Claim, Kind
from cases.results.records.run import CaseResult
from cases.results.status import Status

FROM_ACCEPTANCE = "a claim is judged on as many scenes as when the case was accepted"


def claims_of(case: CaseResult, method: str) -> tuple[AcceptedClaim, ...]:
    """Return the claims about a method that a run judged; regression, which the gate itself adds, is none of them."""
    return tuple(
        AcceptedClaim(name=name, kind=kind, quantity=quantity, methods=methods, judged=count)
        for (name, kind, quantity, methods), count in sorted(_counts(case.claims).items())
        if method in methods
    )


def missing_claims(case: CaseResult, baselines: Iterable[Baseline]) -> Iterator[Claim]:
    """Yield a failure, under the claim's own name, for each accepted claim that the run does not judge as often."""
    found = _counts(case.claims)
    accepted = {claim: None for baseline in baselines for claim in baseline.claims or ()}
    for claim in accepted:
        if (count := found[claim.identity]) < claim.judged:
            yield _missing(case, claim, count)


def _counts(claims: Iterable[Claim]) -> Counter[tuple[str, Kind, str, tuple[str, ...]]]:
    own = (claim for claim in claims if claim.kind is not Kind.REGRESSION)
    return Counter((claim.name, claim.kind, claim.quantity, claim.methods) for claim in own)


def _missing(case: CaseResult, claim: AcceptedClaim, count: int) -> Claim:
    who = " and ".join(claim.methods)
    message = (
        f"missing: the {claim.kind} claim {claim.name!r} about {claim.quantity} of {who} was accepted on "
        f"{claim.judged} scenes, this run judges it on {count}; restore it, or accept the case with --loosen"
    )
    check = BaselineCheck(
        scene="",
        what=f"claim {claim.name!r}",
        unit="1",
        judgement=nothing_compared(Status.INCOMPARABLE, message),
        derived_from=FROM_ACCEPTANCE,
    )
    return replace(check.claim(case.name, claim.methods[0]), methods=claim.methods, quantity=claim.quantity)
