"""Methods of installed packages join every case: each claim that can be put to them is put to them.

Such a method follows ``contact.Method`` and may say how accurate it means to be (``claimed_accuracy``, relative, a
class attribute, at most 10 %); no claim then asks more of it, and every verdict that this relaxes says so.  Where it
says nothing, a claim asks what it asks of its least exact method.
"""

from collections.abc import Iterator
from dataclasses import replace
from numbers import Real
from typing import Any, Final

from cases.declare.case import Case, ClaimOfCase
from cases.declare.methods import MethodUse, load, registered
from cases.judgement.claims.agreement import Agreement
from cases.judgement.claims.declared import DeclaredClaim, PerMethod
from cases.judgement.claims.field_agreement import FieldAgreement
from cases.judgement.claims.residual import Residual
from contact import InvalidInput
from contact.records.record import shown

# Largest accuracy, relative, that a method may claim for itself: agreement within more than a tenth tells nothing.
LARGEST_CLAIM: Final = 0.1


def with_registered(case: Case) -> Case:
    """Return ``case`` with every registered method of an installed package.

    Raises:
        InvalidInput: if such a method cannot be imported, or claims an accuracy that is none.
    """
    for name in registered():
        case = with_foreign_method(case, name, claimed_accuracy=claimed_accuracy(name))
    return case


def claimed_accuracy(name: str) -> float:
    """The relative accuracy that a registered method claims for itself, zero if it claims none.

    Raises:
        InvalidInput: if it is no number from zero to `LARGEST_CLAIM`.
    """
    return check_claim(name, getattr(load(name), "claimed_accuracy", 0.0))


def check_claim(name: str, claimed: Any) -> float:
    """The accuracy that a method claims, as a number.

    Raises:
        InvalidInput: if it is no number from zero to `LARGEST_CLAIM`.
    """
    is_number = isinstance(claimed, Real) and not isinstance(claimed, bool)
    if not is_number or not 0 <= claimed <= LARGEST_CLAIM:
        raise InvalidInput(
            f"method {name!r}: claimed_accuracy = {shown(claimed)} is no relative accuracy from 0 to "
            f"{LARGEST_CLAIM:g}; correct it in that package, or uninstall it"
        )
    return float(claimed)


def with_foreign_method(case: Case, name: str, *, claimed_accuracy: float = 0.0) -> Case:
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
            asked = max([claim.tolerance, *claim.tolerances.values()])
            yield replace(
                claim,
                methods=(*claim.methods, name) if claim.methods else (),
                tolerances={**claim.tolerances, name: max(asked, accuracy)},
                relaxed={**claim.relaxed, **_relaxed(name, asked, accuracy)},
            )
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
            relaxed=_relaxed(name, claim.tolerance, accuracy),
        )


def _relaxed(name: str, asked: float, claimed: float) -> dict[str, str]:
    """What is said beside the verdict where a method's own claim widens the tolerance."""
    return {name: f"{name} claims {claimed:.2g}, others meet {asked:.2g}"} if claimed > asked else {}
