"""Results of a run in words: the verdict, failures grouped per claim, and their probable cause.

A finding is a claim with the same status on several scenes ("20 of 20 scenes, +1.0e-3 each"), or one reason why a
method gave no answer. Page, summary, JUnit file and terminal all show findings, worst first.
"""

import re
from collections import Counter
from collections.abc import Callable, Collection, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from statistics import median
from typing import Any, TypeVar

from cases.answers import Answer
from cases.runs import Run
from cases.verdicts import Kind, Status, Verdict
from reports.words import NOT_FINITE, display_name, quantity_words, short_exponents, signed, small

T = TypeVar("T")
K = TypeVar("K", bound=Hashable)

# Skips stand before passes: someone has to look at their reasons.
EXPLANATIONS: Mapping[Status, str] = {
    Status.INVALID: "a number that is not finite, or a solver that broke down",
    Status.FAIL: "outside its tolerance",
    Status.TIMEOUT: "stopped at its time limit",
    Status.INCOMPARABLE: "shape, unit or specification differ",
    Status.XPASS: "declared to fail, yet it passes: the declaration is out of date",
    Status.DIFF: "differs from the accepted baseline",
    Status.PERF: "slower than the accepted baseline",
    Status.INCONCLUSIVE: "the numerical uncertainty does not allow a verdict",
    Status.SKIP: "a method does not model some scenes; one for each reason",
    Status.XFAIL: "fails, as declared with a reason",
    Status.PASS: "within tolerance",
}
WORST_FIRST = tuple(EXPLANATIONS)
# Relative errors within this share of their median count as equal; half of it splits rounded factors.
ALIKE = 0.05
# A relative tolerance beyond this is shown with the verdict, since AGREE within 5 % is a weak statement.
WIDE = 1e-2
# Place of a mistake if the first quantity of a method is wrong while the second one is right.
PLACES = (
    ("contact_stiffness", "", "k_N, Eq. (10), and the kernel of the layer"),
    ("indentation_depth", "contact_stiffness", "g, Eq. (8)"),
    ("normal_force", "indentation_depth", "E*, or the integral of the springs' forces, Eq. (4)"),
    ("normal_force", "contact_stiffness", "g, Eq. (8), or the integral of the springs' forces, Eq. (4)"),
    ("pressure", "normal_force", "the transform from springs to pressure, Eq. (9)"),
    ("displacement", "normal_force", "the transform from springs to displacement, Eq. (13)"),
)


def grouped(items: Iterable[T], key: Callable[[T], K]) -> dict[K, list[T]]:
    """The items by key, both in the order in which they come."""
    groups: dict[K, list[T]] = {}
    for item in items:
        groups.setdefault(key(item), []).append(item)
    return groups


def tone_of(status: Status) -> str:
    """Class of colour of a status."""
    if status.is_failure:
        return "bad"
    return {Status.INCONCLUSIVE: "warn", Status.SKIP: "skip", Status.XFAIL: "warn"}.get(status, "good")


def word_of(verdict: Verdict) -> str:
    """AGREE, IDENTITY, or the status."""
    return "IDENTITY" if verdict.identity and verdict.status is Status.PASS else verdict.word


def severity(verdict: Verdict) -> tuple[int, float]:
    """Sorting key: the worst status first, within it the largest fraction of the tolerance."""
    return WORST_FIRST.index(verdict.status), -(verdict.fraction or 0.0)


def who(methods: Iterable[str], between: str = " – ") -> str:
    """Methods by their display names."""
    return between.join(map(display_name, methods))


def in_words(message: str) -> str:
    """A message with short powers of ten, and with non-finite numbers in words."""
    names = {"nan": "not-a-number", "inf": "infinity"}
    return re.sub(r"(?<![\w-])([-+]?)(nan|inf)\b", lambda match: match[1] + names[match[2]], short_exponents(message))


def observed_text(verdict: Verdict) -> str:
    """Measured error or difference, with the error that each method states; errors and residuals have two digits."""
    unit = "" if verdict.unit == "1" else f" {verdict.unit}"
    if verdict.error is None:
        return NOT_FINITE if verdict.status is Status.INVALID else "not compared"
    if verdict.kind is Kind.ORDER and verdict.expected is not None:
        return f"{verdict.error:.2f}{unit}, formal {verdict.expected:g}"
    if verdict.kind is Kind.REGRESSION and (change := relative_error(verdict)) is not None:
        return f"changed by {signed(change)}"
    stated = ", ".join(f"{display_name(method)} {small(u)}" for method, u in verdict.uncertainty.items())
    return f"{small(verdict.error)}{unit}" + (f" (stated {stated})" if stated else "")


def relative_error(verdict: Verdict) -> float | None:
    """Signed relative error, of accepted numbers the relative change; None where nothing relative was measured."""
    if verdict.error is None or verdict.kind is Kind.ORDER:
        return None
    if verdict.kind is Kind.REGRESSION:
        return (verdict.error - verdict.expected) / abs(verdict.expected) if verdict.expected else None
    return verdict.error if verdict.unit == "1" else None


def is_wide(verdict: Verdict) -> bool:
    """Whether a claim passed within a relative tolerance that is shown with its verdict.

    Orders have another unit. Counts (of silent failures) are claimed to be zero. A limit of one or more is a factor.
    """
    counted = verdict.kind is Kind.INVARIANT and verdict.expected == 0.0
    relative = verdict.kind is not Kind.ORDER and verdict.unit == "1" and not counted
    return verdict.status is Status.PASS and relative and WIDE < verdict.tolerance < 1.0


@dataclass(frozen=True, kw_only=True)
class Finding:
    """A claim with the same status on several scenes, or one reason why a method gave no answers.

    Attributes:
        status: Status of the verdicts or answers.
        word: Word for the status that readers see.
        case: Name of the case, or the number of cases.
        claim: Name of the claim; "no answer" or "not modelled" for answers.
        methods: Methods that took part.
        scenes: Scenes with this status.
        total: Number of scenes that the claim speaks about.
        size: Relative errors in words, "+1.0e-3 each".
        fraction: Largest error over tolerance.
        worst: Worst verdict; None for answers.
        message: Observation at the worst scene, or the reason.
    """

    status: Status
    word: str
    case: str
    claim: str
    methods: tuple[str, ...]
    scenes: tuple[str, ...]
    total: int
    message: str
    size: str = ""
    fraction: float = 0.0
    worst: Verdict | None = None

    @property
    def tone(self) -> str:
        """Class of colour."""
        return tone_of(self.status)

    @property
    def where(self) -> str:
        """Name of the only scene, or "3 of 5 scenes"."""
        return self.scenes[0] if self.total == 1 else f"{len(self.scenes)} of {self.total} scenes"

    @property
    def measured(self) -> str:
        """Errors over all scenes in words, or the measured error of the only scene."""
        return self.size or (observed_text(self.worst) if self.worst else "")

    @property
    def sentence(self) -> str:
        """One line: claim, where, how large."""
        size = f", {self.size}" if self.size else ""
        return f"{self.case}: {self.claim} ({who(self.methods, ' against ')}), {self.where}{size}"


def findings(run: Run, verdicts: Collection[Verdict] | None = None) -> list[Finding]:
    """The findings that did not pass, worst first, of the whole run or of the given verdicts alone."""
    answers = _unanswered(run) if verdicts is None else []
    result = []
    for (status, reason, *_), unanswered in grouped(answers, _reason).items():
        claim = "not modelled" if status is Status.SKIP else "no answer"
        result.append(_finding(unanswered, claim, reason, [answer.method for answer in unanswered]))
    chosen = run.judged.verdicts if verdicts is None else verdicts
    for same in grouped((v for v in chosen if v.status is not Status.SKIP), _claim).values():
        for alike in grouped((v for v in same if v.status is not Status.PASS), lambda v: v.status).values():
            worst = min(alike, key=severity)
            errors = [error for v in alike if (error := relative_error(v)) is not None]
            sizes = {"size": size_text(errors) if len(alike) > 1 else "", "fraction": worst.fraction or 0.0}
            more = {"word": word_of(worst), "total": len(same), "worst": worst, **sizes}
            result.append(_finding(alike, worst.claim, worst.message, worst.methods, **more))
    # Each reason of a skip is shown once: scenes that a method does not model are not compared either.
    messages = {finding.message for finding in result}
    for reason, skipped in grouped((v for v in chosen if v.status is Status.SKIP), _skip_reason).items():
        if reason not in messages:
            result.append(_finding(skipped, "not compared", reason, [method for v in skipped for method in v.methods]))
    return sorted(result, key=lambda finding: (WORST_FIRST.index(finding.status), -finding.fraction))


def _finding(
    same: Sequence[Verdict | Answer], claim: str, message: str, methods: Iterable[str], **more: Any
) -> Finding:
    """The finding of verdicts or answers with the same status."""
    cases = list(dict.fromkeys(record.case for record in same))
    return Finding(
        status=same[0].status,
        case=cases[0] if len(cases) == 1 else f"{len(cases)} cases",
        claim=claim,
        methods=tuple(dict.fromkeys(methods)),
        scenes=tuple(record.scene for record in same),
        message=in_words(message),
        **{"word": same[0].status.value, "total": len(same)} | more,
    )


def _claim(verdict: Verdict) -> tuple[str, ...]:
    """Key that verdicts of one finding share; an accepted number is compared in many cases."""
    claim = ("",) if verdict.kind is Kind.REGRESSION else (verdict.case, verdict.claim)
    return *claim, verdict.quantity, *verdict.methods


def _reason(answer: Answer) -> tuple[Status, str, str, str]:
    """Key that answers of one finding share: status and reason; broken ones also case and method."""
    is_skip = answer.status is Status.SKIP
    return answer.status, answer.reason, "" if is_skip else answer.case, "" if is_skip else answer.method


def _skip_reason(verdict: Verdict) -> str:
    """Why a verdict was skipped, without the method's name before it."""
    method, _, reason = verdict.message.partition(": ")
    return reason if method in verdict.methods else verdict.message


def _unanswered(run: Run) -> list[Answer]:
    return [answer for answer in run.answers if not answer.variant and answer.status is not Status.PASS]


def size_text(errors: Sequence[float]) -> str:
    """Relative errors in words: one number where they are alike, else their range."""
    if not errors:
        return ""
    if max(errors) - min(errors) <= 2 * ALIKE * abs(median(errors)):
        return f"{signed(median(errors))} each"
    return f"{signed(min(errors))} to {signed(max(errors))}"


def counts(run: Run) -> tuple[tuple[Status, int], ...]:
    """Number of checks with each status, worst first; answers count where they broke down, skips per reason."""
    tally: Counter[Status] = Counter()
    tally.update(v.status for v in run.judged.verdicts if v.status is not Status.SKIP and not v.identity)
    tally.update(answer.status for answer in _unanswered(run) if answer.status is not Status.SKIP)
    tally[Status.SKIP] = sum(finding.status is Status.SKIP for finding in findings(run))
    return tuple((status, tally[status]) for status in WORST_FIRST if tally[status])


def headline(run: Run) -> tuple[str, str]:
    """The verdict in a few words, and its tone."""
    tally = {status: number for status, number in counts(run) if status is not Status.SKIP}
    checks = sum(tally.values())
    bad = sum(number for status, number in tally.items() if status.is_failure)
    if checks == 0:
        timed = len({cost.case for cost in run.judged.costs})
        words = f"MEASURED: {timed} case{'s'[: timed != 1]}, no claims"
        return (words, "good") if timed else ("; ".join(["Nothing ran", *_unjudged(run)]), "bad")
    if bad:
        return f"FAILED: {bad} of {checks} checks", "bad"
    if not run.judged.complete:
        return f"INCOMPLETE: {checks} checks so far, none failed", "warn"
    if run.unjudged:
        return "; ".join([*_unjudged(run), f"{checks} checks of other methods hold"]), "bad"
    still_open = sum(number for status, number in tally.items() if tone_of(status) == "warn")
    words = f"{checks} checks, {still_open} to look at" if still_open else f"all {checks} checks"
    return f"PASSED: {words}", "warn" if still_open else "good"


def _unjudged(run: Run) -> list[str]:
    """A sentence for each chosen method about which no claim was judged, with the reasons of its skipped scenes."""
    skipped = [answer for answer in run.answers if answer.status is Status.SKIP]
    reasons = {
        method: dict.fromkeys(answer.reason for answer in skipped if answer.method == method) for method in run.unjudged
    }
    return [
        f"no claim about {method} was judged{': ' if why else ''}{'; '.join(map(in_words, why))}"
        for method, why in reasons.items()
    ]


def baseline_sentence(run: Run) -> str:
    """Sentence with the number of accepted numbers that changed."""
    compared = [v for v in run.judged.verdicts if v.kind is Kind.REGRESSION]
    changed = sum(v.status is not Status.PASS for v in compared)
    return (
        f"Since the baseline: {changed} of {len(compared)} numbers changed."
        if compared
        else "Not compared with a baseline."
    )


def causes(run: Run) -> list[str]:
    """One sentence per method that narrows the cause of its failures; nothing where no method stands out.

    A method has a quantity wrong if every comparison partner (other methods, closed forms, literature) contradicts it
    somewhere. Among two methods that contradict each other alone, neither is named.
    """
    judged = [v for v in run.judged.verdicts if v.kind in (Kind.EXACT, Kind.AGREEMENT) and v.error is not None]
    sentences = []
    for method in dict.fromkeys(label for v in judged for label in v.methods):
        by_quantity = grouped((v for v in judged if method in v.methods), lambda v: v.quantity)
        right = [name for name, verdicts in by_quantity.items() if all(v.status is Status.PASS for v in verdicts)]
        for name, verdicts in by_quantity.items():
            partners = grouped(verdicts, partial(_partner, method))
            errors = {partner: _failing_errors(method, same) for partner, same in partners.items()}
            if all(errors.values()) and (len(errors) > 1 or any(v.kind is Kind.EXACT for v in verdicts)):
                sentences.append(_cause(method, name, errors, right))
    return sentences


def _failing_errors(method: str, verdicts: Sequence[Verdict]) -> list[float]:
    """Signed relative errors of the method where it fails; of a difference the sign is that of the other method."""
    failed = [v for v in verdicts if v.status is Status.FAIL and relative_error(v) is not None]
    signs = (-1.0 if v.kind is Kind.AGREEMENT and v.methods[0] != method else 1.0 for v in failed)
    return [sign * (relative_error(v) or 0.0) for sign, v in zip(signs, failed, strict=True)]


def _partner(method: str, verdict: Verdict) -> str:
    """Other method or kind of reference that the method is compared with."""
    if verdict.kind is Kind.EXACT:
        return verdict.why.origin.value
    return next((display_name(other) for other in verdict.methods if other != method), "itself")


def _cause(method: str, quantity: str, errors: Mapping[str, Sequence[float]], right: Sequence[str]) -> str:
    """Sentence about a wrong quantity of a method: partners, errors, a common factor, and where to look."""
    all_errors = [error for same in errors.values() for error in same]
    *others, last = errors
    against = f"{', '.join(others)} and {last} alike" if others else last
    words = f"{display_name(method)}: {quantity_words(quantity)} is off against {against}"
    words += f", {size_text(all_errors)} in {len(all_errors)} comparison{'s' * (len(all_errors) > 1)}"
    if len(all_errors) > 1 and size_text(all_errors).endswith("each"):
        words += f", as by one factor {1 + median(all_errors):.5g} (a modulus, a unit)"
    passing = f", while {' and '.join(map(quantity_words, right))} pass{'es'[: 2 * (len(right) == 1)]}" if right else ""
    place = next((hint for wrong, passed, hint in PLACES if wrong == quantity and (not passed or passed in right)), "")
    return f"{words}{passing}{': look at ' if place else ''}{place}."
