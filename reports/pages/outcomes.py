"""What each check ended with, in words: the rows that page, summary, JUnit file and terminal share, worst first."""

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from cases.results.records.claim import Claim, Kind, Verdict
from cases.results.records.run import CaseResult, RunResult
from cases.results.records.scene_run import SceneRun
from cases.results.status import Status
from reports.words import NOT_FINITE, measured, small

# The order of reading; skips stand before passes because someone has to look at their reasons.
WORST_FIRST = (
    Status.INVALID,
    Status.FAIL,
    Status.TIMEOUT,
    Status.INCOMPARABLE,
    Status.XPASS,
    Status.DIFF,
    Status.PERF,
    Status.INCONCLUSIVE,
    Status.SKIP,
    Status.XFAIL,
    Status.PASS,
)

# What stands in place of a kind of claim where a row is the solution of a scene.
SOLUTION = "solution"

EXPLANATIONS: Mapping[Status, str] = {
    Status.PASS: "within tolerance",
    Status.FAIL: "outside its tolerance",
    Status.DIFF: "differs from the accepted baseline",
    Status.PERF: "slower than the accepted baseline",
    Status.INVALID: "a number that is not finite, or a solver that broke down",
    Status.INCOMPARABLE: "shape, unit or specification differ",
    Status.INCONCLUSIVE: "the numerical uncertainty does not allow a verdict",
    Status.TIMEOUT: "stopped at its time limit",
    Status.SKIP: "a method does not model some scenes; one for each reason",
    Status.XFAIL: "fails, as declared with a reason",
    Status.XPASS: "declared to fail, yet it passes: the declaration is out of date",
}


@dataclass(frozen=True, kw_only=True)
class CheckOutcome:
    """One check in words: a claim, or the solution of one scene by one method.

    `fraction` is error over tolerance, -1 where nothing could be compared. `tone` is the class of colour:
    "bad", "warn", "skip" or "good"; `identity` says why a comparison holds by construction.
    """

    case: str
    scene: str
    name: str
    methods: tuple[str, ...]
    what: str
    status: Status
    word: str
    message: str
    fraction: float = -1.0
    observed: str = ""
    tolerance: str = ""
    origin: str = ""
    because: str = ""
    seconds: float = 0.0
    identity: str = ""

    @property
    def is_counted(self) -> bool:
        """Whether this is a comparison that could fail; a solution counts only where it broke down."""
        return self.tone == "bad" or (self.what != SOLUTION and not self.identity)

    @property
    def tone(self) -> str:
        """Class of colour."""
        return tone_of(self.status)

    @property
    def fraction_text(self) -> str:
        """Fraction of the tolerance that is used up, empty where nothing was compared."""
        return "" if self.fraction < 0.0 else small(self.fraction)

    @property
    def place(self) -> str:
        """Name and scene of the check: "force agrees [bonded nu=0.3]"."""
        return self.name if self.scene in self.name else f"{self.name} [{self.scene}]"

    @property
    def who(self) -> str:
        """The methods that took part: "mdr against fem"."""
        return " against ".join(self.methods)


def tone_of(status: Status) -> str:
    """Colour class of a status."""
    if status.is_failure:
        return "bad"
    return {Status.INCONCLUSIVE: "warn", Status.SKIP: "skip", Status.XFAIL: "warn"}.get(status, "good")


def outcomes(run: RunResult) -> tuple[CheckOutcome, ...]:
    """Every check of the run, worst first; skips for one and the same reason are one row."""
    rows = [row for case in run.cases for row in case_outcomes(case)]
    skips: dict[str, list[CheckOutcome]] = {}
    for row in rows:
        if row.status is Status.SKIP:
            skips.setdefault(_reason(row), []).append(row)
    others = [row for row in rows if row.status is not Status.SKIP]
    return tuple(sorted([*others, *(_joined(same) for same in skips.values())], key=severity))


def _reason(row: CheckOutcome) -> str:
    """Why a check was skipped, without the method's name before it."""
    return next(
        (row.message.removeprefix(f"{m}: ") for m in row.methods if row.message.startswith(f"{m}: ")), row.message
    )


def _joined(same: Sequence[CheckOutcome]) -> CheckOutcome:
    """One row for skips of one reason: how many, and where."""
    first = same[0]
    if len(same) == 1:
        return first
    cases = list(dict.fromkeys(row.case for row in same))
    skippers = [row.methods for row in same if row.what == SOLUTION] or [first.methods]
    return replace(
        first,
        case=cases[0] if len(cases) == 1 else f"{len(cases)} cases",
        scene=f"{len({(row.case, row.scene) for row in same})} scenes",
        name=f"{len(same)} skips",
        methods=tuple(dict.fromkeys(method for methods in skippers for method in methods)),
        message=_reason(first),
    )


def case_outcomes(case: CaseResult) -> tuple[CheckOutcome, ...]:
    """Every check of a case, in the order of the case."""
    claims = (claim_outcome(case.name, claim) for claim in case.claims)
    return (*claims, *(_solved(case.name, run) for run in case.runs))


def severity(row: CheckOutcome) -> tuple[int, float]:
    """Sorting key: the worst status first, within it the largest fraction of the tolerance."""
    return WORST_FIRST.index(row.status), -row.fraction


def counts(rows: Iterable[CheckOutcome]) -> tuple[tuple[Status, int], ...]:
    """How many comparisons ended with which status, worst first; solutions made and identities are not counted."""
    tally = Counter(row.status for row in rows if row.is_counted or row.status is Status.SKIP)
    return tuple((status, tally[status]) for status in WORST_FIRST if tally[status])


def headline(run: RunResult, rows: Iterable[CheckOutcome]) -> tuple[str, str]:
    """The verdict in a few words, and its tone."""
    tally = Counter(row.tone for row in rows if row.is_counted)
    checks = sum(tally.values()) - tally["skip"]
    if checks == 0:
        found = _measured(run)
        measured = f"MEASURED: {found} case{'s'[: found != 1]}, no claims"
        return (measured, "good") if found else ("; ".join(["Nothing ran", *_unjudged(run)]), "bad")
    if tally["bad"]:
        return f"FAILED: {tally['bad']} of {checks} checks", "bad"
    if not run.complete:
        return f"INCOMPLETE: {checks} checks so far, none failed", "warn"
    if run.unjudged:
        return "; ".join([*_unjudged(run), f"{checks} checks of other methods hold"]), "bad"
    words = f"{checks} checks, {tally['warn']} to look at" if tally["warn"] else f"all {checks} checks"
    return f"PASSED: {words}", "warn" if tally["warn"] else "good"


def _unjudged(run: RunResult) -> list[str]:
    """A sentence for each chosen method about which no claim was judged, with the reason of its first skip."""
    rows = [row for case in run.cases for row in case.runs if row.status is Status.SKIP]
    reasons = {method: next((row.reason for row in rows if row.method == method), "") for method in run.unjudged}
    return [f"no claim about {method} was judged{': ' if why else ''}{worded(why)}" for method, why in reasons.items()]


def nothing_ran(run: RunResult) -> bool:
    """Whether a run has neither a check that was carried out nor a measurement."""
    return all(row.tone == "skip" for row in outcomes(run)) and not _measured(run)


def _measured(run: RunResult) -> int:
    return sum(bool(case.work_precision) for case in run.cases)


def claim_outcome(case: str, claim: Claim) -> CheckOutcome:
    """A claim in words."""
    return CheckOutcome(
        case=case,
        scene=claim.scene,
        name=claim.name,
        methods=claim.methods,
        what=f"{claim.kind}: {claim.quantity}",
        status=claim.status,
        word=_word(claim),
        fraction=-1.0 if claim.fraction is None else claim.fraction,
        observed=observed_text(claim),
        tolerance=f"{small(claim.tolerance)}{_unit(claim.unit)}",
        origin=f"{claim.origin}: {claim.source}",
        message=worded("; ".join(part for part in (claim.message, claim.identity) if part)),
        because=claim.because,
        identity=claim.identity,
    )


def _word(claim: Claim) -> str:
    if claim.identity and claim.status is Status.PASS:
        return "IDENTITY"
    return str(claim.status if claim.verdict is Verdict.NONE or claim.status.is_failure else claim.verdict)


def _solved(case: str, run: SceneRun) -> CheckOutcome:
    return CheckOutcome(
        case=case,
        scene=run.scene,
        name=f"solves {run.scene}",
        methods=(run.method,),
        what=SOLUTION,
        status=run.status,
        word=str(run.status),
        message=worded(run.reason),
        seconds=run.cost.wall_seconds if run.cost else 0.0,
    )


def worded(message: str) -> str:
    """A message with its non-finite numbers in words, so that pages can be searched for stray ones."""
    return re.sub(r"(?<![\w-])([-+]?)(nan|inf)\b", lambda found: found[1] + NON_FINITE[found[2]], message)


NON_FINITE = {"nan": "not-a-number", "inf": "infinity"}


def observed_text(claim: Claim) -> str:
    """What was measured, with the uncertainty of each method; errors and residuals have two digits."""
    if claim.observed is None:
        return NOT_FINITE if claim.status is Status.INVALID else "not compared"
    unit = _unit(claim.unit)
    if claim.kind is Kind.ORDER and claim.expected is not None:
        return f"{claim.observed:.2f}{unit}, formal {claim.expected:g}"
    if claim.kind is Kind.REGRESSION and claim.expected is not None:
        new, accepted = (measured(value, claim.tolerance) for value in (claim.observed, claim.expected))
        return f"{new}{unit}, accepted {accepted}{unit}"
    uncertain = ", ".join(f"{method} {small(u)}" for method, u in claim.uncertainty.items())
    return f"{small(claim.observed)}{unit}" + (f" (uncertainty {uncertain})" if uncertain else "")


def _unit(unit: str) -> str:
    return "" if unit == "1" else f" {unit}"
