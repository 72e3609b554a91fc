"""Methods of installed packages join every case: each claim that can be put to them is put to them.

A newcomer follows ``contact.Method`` and may say how accurate it means to be (``claimed_accuracy``, relative, a class
attribute); no claim then asks more of it.  Where it says nothing, a claim asks what it asks of its least exact method.
"""

from collections.abc import Iterator
from dataclasses import replace

from cases.declare.case import Case, ClaimOfCase
from cases.declare.methods import MethodUse, load, registered
from cases.judgement.claims.agreement import Agreement
from cases.judgement.claims.declared import DeclaredClaim, PerMethod
from cases.judgement.claims.field_agreement import FieldAgreement
from cases.judgement.claims.residual import Residual


def with_registered(case: Case) -> Case:
    """Return ``case`` with every registered method of an installed package.

    Raises:
        InvalidInput: if such a method cannot be imported.
    """
    for name in registered():
        case = with_newcomer(case, name, claimed_accuracy=getattr(load(name), "claimed_accuracy", 0.0))
    return case


def with_newcomer(case: Case, name: str, *, claimed_accuracy: float = 0.0) -> Case:
    """Return ``case`` solved by one more method and with the claims that can be put to it.

    Claims about single methods extend to it; agreements compare it with both methods of the case.  Orders of
    convergence belong to a mesh family, and residuals to the method that publishes them: they stay as they are.
    """
    claims = (new for claim in case.claims for new in _extended(case, claim, name, claimed_accuracy))
    use = MethodUse(label=name)
    scenes = (replace(scene, methods=(*scene.methods, use)) if scene.methods else scene for scene in case.scenes)
    return replace(case, methods=(*case.methods, use), scenes=tuple(scenes), claims=tuple(claims))


def _extended(case: Case, claim: ClaimOfCase, name: str, accuracy: float) -> Iterator[ClaimOfCase]:
    match claim:
        case Residual():
            yield replace(claim, methods=claim.methods or tuple(use.label for use in case.methods))
        case PerMethod():
            granted = max(claim.tolerance, accuracy, *claim.tolerances.values())
            methods = (*claim.methods, name) if claim.methods else ()
            yield replace(claim, methods=methods, tolerances={**claim.tolerances, name: granted})
        case Agreement() | FieldAgreement():
            yield claim
            yield from _against_both(claim, name, accuracy)
        case _:
            yield claim


def _against_both(claim: Agreement | FieldAgreement, name: str, accuracy: float) -> Iterator[DeclaredClaim]:
    for other in (claim.fast, claim.reference):
        yield replace(
            claim,
            name=f"{claim.name}: {name} and {other}",
            fast=name,
            reference=other,
            tolerance=max(claim.tolerance, accuracy),
        )
