"""Methods that could not be asked, since a package or a program is missing: told once, and nothing of them compared."""

from collections.abc import Iterable, Iterator, Mapping

from cases.gate.baseline import Baseline
from cases.gate.checks.check import BaselineCheck
from cases.judgement.rules.judgement import nothing_compared
from cases.results.records.claim import Claim
from cases.results.records.run import CaseResult
from cases.results.status import Status
from contact.records.extras import NOT_INSTALLED

FROM_ABSENCE = "solvers of others are optional: what is not installed is not compared"


def not_installed(case: CaseResult) -> dict[str, str]:
    """Return the methods skipped on every scene, once at least since they are not installed, and that reason."""
    found = {row.method: row.reason for row in case.runs if NOT_INSTALLED in row.reason}
    asked = {row.method for row in case.runs if row.status is not Status.SKIP}
    return {method: reason for method, reason in found.items() if method not in asked}


def absent_claims(case: str, baselines: Iterable[Baseline], absent: Mapping[str, str]) -> Iterator[Claim]:
    """Yield one claim for each accepted method that is absent: it is skipped, and says of how many numbers."""
    for baseline in baselines:
        if baseline.method not in absent:
            continue
        message = f"{absent[baseline.method]}; {len(baseline.records)} accepted numbers are not compared"
        check = BaselineCheck(
            scene="",
            what="numbers",
            unit="1",
            judgement=nothing_compared(Status.SKIP, message),
            derived_from=FROM_ABSENCE,
        )
        yield check.claim(case, baseline.method)
