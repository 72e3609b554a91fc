"""Methods of installed packages join every case when they are chosen: each claim that can be put to them is.

Such a method follows ``contact.Method``.  A claim asks of it what it asks of its least exact method.  A method may say
how accurate it is (``claimed_accuracy``, relative, a class attribute, at most 10 %): closed forms and the fast method
are then compared within ten times this where the claim asks less.
"""

from collections.abc import Collection, Mapping
from dataclasses import replace
from numbers import Real
from typing import Any, Final

from cases.declare.case import Case, ClaimOfCase
from cases.declare.foreign.restated import with_restated
from cases.declare.foreign_agreements import HELD_TO, foreign_agreements
from cases.declare.methods import REFEREES, MethodUse, load, registered
from cases.judgement.claims.declared import PerMethod
from cases.judgement.claims.exact import Exact
from cases.judgement.claims.own_laws import Residual
from contact import InvalidInput
from contact.records.errors import shown

# Largest accuracy, relative, that a method may claim for itself: agreement within more than a tenth tells nothing.
LARGEST_CLAIM: Final = 0.1


def with_registered(case: Case, chosen: Collection[str] | None = None) -> Case:
    """Return ``case`` with the registered methods of installed packages.

    Args:
        case: with its own methods.
        chosen: names of methods; None for every registered one but the outside referees, which are asked by name.

    Raises:
        InvalidInput: if such a method cannot be imported, or claims an accuracy that is none.
    """
    own = {use.label for use in case.methods}
    asked = [name for name in registered() if name not in REFEREES] if chosen is None else chosen
    names = [name for name in registered() if name in asked and name not in own]
    return with_foreign_methods(case, {name: claimed_accuracy(name) for name in names})


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


def with_foreign_methods(case: Case, accuracies: Mapping[str, float]) -> Case:
    """Return ``case`` solved by more methods and with the claims that can be put to them.

    Claims about single methods extend to them; agreements compare each with the methods of the case, never with one
    another.  Orders of convergence belong to a mesh family, and residuals to the method that publishes them: they stay
    as they are.

    Args:
        case: with its own methods.
        accuracies: that the methods claim for themselves, relative, by name; zero where one claims none.
    """
    if not accuracies:
        return case
    uses = tuple(MethodUse(label=name) for name in accuracies)
    asked = with_restated(case, accuracies)
    scenes = (replace(scene, methods=(*scene.methods, *uses)) if scene.methods else scene for scene in asked.scenes)
    # The first claims of what is asked are the case's own, of its own scenes.
    own = (_extended(case, claim, accuracies) for claim in asked.claims[: len(case.claims)])
    agreements = (new for name, accuracy in accuracies.items() for new in foreign_agreements(asked, name, accuracy))
    return replace(case, methods=(*case.methods, *uses), scenes=tuple(scenes), claims=(*own, *agreements))


def _extended(case: Case, claim: ClaimOfCase, accuracies: Mapping[str, float]) -> ClaimOfCase:
    """The claim about single methods with more of them; any other claim as it is."""
    if isinstance(claim, Residual):
        return replace(claim, methods=claim.methods or tuple(use.label for use in case.methods))
    if not isinstance(claim, PerMethod):
        return claim
    methods = (*claim.methods, *accuracies) if claim.methods else ()
    asked = max([claim.tolerance, *claim.tolerances.values()])
    held = {name: HELD_TO * own if own and isinstance(claim, Exact) else asked for name, own in accuracies.items()}
    return replace(
        claim,
        methods=methods,
        tolerances={**claim.tolerances, **{name: min(asked, own) for name, own in held.items()}},
    )
