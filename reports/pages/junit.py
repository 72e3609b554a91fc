"""junit.xml: one testcase for each case, method and claim, as CI systems read it."""

import xml.etree.ElementTree as ET
from collections.abc import Sequence

from cases.results.records.run import CaseResult, RunResult
from cases.results.status import Status
from reports.pages.outcomes import CheckOutcome, case_outcomes

# Statuses that JUnit calls an error (no answer) and not a failure (a wrong answer).
BROKEN = (Status.INVALID, Status.TIMEOUT, Status.INCOMPARABLE)


def junit_text(run: RunResult) -> str:
    """The run as JUnit XML: a suite for each case, class names CASE.METHOD."""
    root = ET.Element("testsuites", name=f"contact verification, suite {run.suite}")
    for case in run.cases:
        root.append(_suite(case, run.stamp.started))
    ET.indent(root)
    return ET.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def _suite(case: CaseResult, started: str) -> ET.Element:
    rows = case_outcomes(case)
    suite = ET.Element("testsuite", {"name": case.name, "timestamp": started} | _totals(rows))
    suite.extend(_testcase(row) for row in rows)
    return suite


def _totals(rows: Sequence[CheckOutcome]) -> dict[str, str]:
    failed = sum(row.status.is_failure and row.status not in BROKEN for row in rows)
    broken = sum(row.status in BROKEN for row in rows)
    skipped = sum(_is_skipped(row) for row in rows)
    seconds = sum(row.seconds for row in rows)
    numbers = {"tests": len(rows), "failures": failed, "errors": broken, "skipped": skipped}
    return {name: str(number) for name, number in numbers.items()} | {"time": f"{seconds:.3f}"}


def _testcase(row: CheckOutcome) -> ET.Element:
    who = "+".join(row.methods)
    element = ET.Element("testcase", classname=f"{row.case}.{who}", name=row.place, time=f"{row.seconds:.3f}")
    if row.status.is_failure:
        kind = "error" if row.status in BROKEN else "failure"
        detail = ET.SubElement(element, kind, type=str(row.status), message=_printable(row.message))
        detail.text = _printable(_detail(row))
    elif _is_skipped(row):
        ET.SubElement(element, "skipped", message=_printable(f"{row.word}: {row.message}"))
    return element


def _is_skipped(row: CheckOutcome) -> bool:
    """Skipped checks, and those whose verdict stays open: neither passed nor failed."""
    return row.status in (Status.SKIP, Status.XFAIL, Status.INCONCLUSIVE)


def _detail(row: CheckOutcome) -> str:
    """All that helps to find the reason."""
    facts = {
        "measured": row.observed,
        "tolerance": row.tolerance,
        "error / tolerance": row.fraction_text,
        "expected because": row.because,
        "origin": row.origin,
    }
    return "\n".join(f"{name}: {fact}" for name, fact in facts.items() if fact)


def _printable(text: str) -> str:
    """XML 1.0 has no place for most control characters."""
    return "".join(letter for letter in text if letter >= " " or letter in "\n\t")
