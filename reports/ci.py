"""Results of a run for continuous integration: summary.md, junit.xml, and `::error` lines that GitHub shows."""

import html
import re
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterable, Mapping

from cases.answers import Answer
from cases.runs import Run
from cases.verdicts import Status, Verdict
from contact.records.errors import printable
from reports.findings import (
    Finding,
    baseline_sentence,
    causes,
    counts,
    findings,
    headline,
    in_words,
    observed_text,
    who,
    word_of,
)
from reports.tables import matrix_table
from reports.words import duration, markdown_table, small

# Most bytes of a summary that a reader still scrolls through. GitHub refuses a job summary above 1 MiB.
LARGEST = 64_000
# GitHub shows ten annotations of a step and hides the rest: nine leave room for its own.
MOST = 9
# Characters that Markdown reads as the end of a cell, code, a link, an address, a person, or emphasis.
MARKDOWN = re.compile(r"[`*~\\@]|\](?=[(\[:])|:(?=//)|(?<![^\W_])_|_(?![^\W_])")
# Statuses that JUnit calls an error (no answer) and not a failure (a wrong answer).
BROKEN = (Status.INVALID, Status.TIMEOUT, Status.INCOMPARABLE)
# Statuses that neither pass nor fail.
OPEN = (Status.SKIP, Status.XFAIL, Status.INCONCLUSIVE)

# Text of a finding in each column of the summary, by its head.
COLUMNS: Mapping[str, Callable[[Finding], str]] = {
    "verdict": lambda finding: finding.word,
    "case": lambda finding: finding.case,
    "claim": lambda finding: finding.claim,
    "method": lambda finding: who(finding.methods, " against "),
    "scenes": lambda finding: finding.where,
    "relative error": lambda finding: finding.measured,
    "error / tolerance": lambda finding: small(finding.fraction) if finding.fraction else "",
    "what was seen": lambda finding: finding.message,
}


def summary_text(run: Run, *, largest: int = LARGEST) -> str:
    """The summary in Markdown, never above `largest` bytes: failures first, and how many rows did not fit."""
    judged = run.judged
    tally = ", ".join(f"{number} {status}" for status, number in counts(run))
    suite = f"Suite {judged.suite}" if judged.suite else "Chosen cases"
    facts = f"{suite}, revision {judged.stamp.revision[:12]}, {duration(judged.stamp.wall_seconds)}."
    text = f"# {_escaped(headline(run)[0])}\n\n{tally}. {_escaped(facts)} {_escaped(baseline_sentence(run))}\n\n"
    text += "".join(f"{_escaped(sentence)}\n\n" for sentence in causes(run))
    table = matrix_table(run)
    matrix = markdown_table(table.heads, (map(_escaped, row) for row in table.rows)) if run.statuses else ""
    text += f"{matrix}\n" * (0 < 2 * len(matrix.encode()) <= largest)
    rows = findings(run)
    if not rows:
        return text + "Every check ran and passed.\n"
    text += markdown_table(COLUMNS, ())
    for number, row in enumerate(map(_row, rows)):
        if len((text + row).encode()) > largest - 200:
            return text + f"\n{len(rows) - number} further rows are on the page of the report.\n"
        text += row
    return text


def _row(finding: Finding) -> str:
    """Row of a finding in Markdown."""
    word, *others = (_escaped(text(finding)) for text in COLUMNS.values())
    return f"| {f'**{word}**' if finding.tone == 'bad' else word} | {' | '.join(others)} |\n"


def _escaped(text: str) -> str:
    """Text that shows as it stands: it ends no table cell and is neither HTML nor Markdown."""
    plain = html.escape(printable(" ".join(text.split())), quote=False)
    return MARKDOWN.sub(lambda match: f"&#{ord(match[0])};", plain).replace("|", "\\|")


def annotation_lines(run: Run) -> list[str]:
    """The worst findings, one line each; when there are more than nine, the ninth line counts the others."""
    failed = [finding for finding in findings(run) if finding.tone == "bad"]
    shown = failed if len(failed) <= MOST else failed[: MOST - 1]
    lines = [_annotation(f"{finding.word} {finding.sentence}", finding.message) for finding in shown]
    rest = len(failed) - len(shown)
    return [*lines, _annotation("more failures", f"{rest} more failures: see summary.md")] if rest else lines


def _annotation(title: str, message: str) -> str:
    """A workflow command is one line; percent signs and line ends are written as their codes."""
    title, message = (text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A") for text in (title, message))
    return f"::error title={title.replace(':', '%3A').replace(',', '%2C')}::{message}"


def junit_text(run: Run) -> str:
    """The run as JUnit XML: a suite per case, a test per verdict and per solved scene, class names CASE.METHOD."""
    root = ET.Element("testsuites", name=f"contact verification, suite {run.judged.suite}")
    for case in run.judged.cases:
        suite = ET.SubElement(root, "testsuite", name=case.name, timestamp=run.judged.stamp.started)
        suite.extend(_of_verdict(v) for v in run.judged.verdicts if v.case == case.name)
        suite.extend(_of_answer(answer) for answer in run.answers.of_case(case.name))
        ends = [element.tag for test in suite for element in test]
        numbers = {"tests": len(suite), "failures": ends.count("failure"), "errors": ends.count("error")}
        suite.attrib |= {name: str(n) for name, n in (numbers | {"skipped": ends.count("skipped")}).items()}
        suite.set("time", f"{sum(float(test.get('time', 0)) for test in suite):.3f}")
    ET.indent(root)
    return ET.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def _of_verdict(verdict: Verdict) -> ET.Element:
    """Test case of a verdict in JUnit XML, with the facts of a failure."""
    name = verdict.claim if verdict.scene in verdict.claim else f"{verdict.claim} [{verdict.scene}]"
    test = _test(verdict.case, verdict.methods, name)
    _end(test, verdict.status, f"{word_of(verdict)}: {verdict.message}")
    for end in test.findall("*[@type]"):
        facts = {
            "measured": observed_text(verdict),
            "tolerance": small(verdict.tolerance),
            "error / tolerance": "" if verdict.fraction is None else small(verdict.fraction),
            "expected because": verdict.why.because,
            "origin": f"{verdict.why.origin}: {verdict.why.source}",
        }
        end.text = _xml("\n".join(f"{name}: {fact}" for name, fact in facts.items() if fact))
    return test


def _of_answer(answer: Answer) -> ET.Element:
    test = _test(answer.case, (answer.method,), f"solves {answer.scene}", answer.wall_seconds)
    _end(test, answer.status, answer.reason)
    return test


def _test(case: str, methods: Iterable[str], name: str, seconds: float = 0.0) -> ET.Element:
    return ET.Element("testcase", classname=f"{case}.{'+'.join(methods)}", name=_xml(name), time=f"{seconds:.3f}")


def _end(test: ET.Element, status: Status, message: str) -> None:
    """Add how the test ended, unless it passed."""
    if status.is_failure:
        end = "error" if status in BROKEN else "failure"
        ET.SubElement(test, end, type=status.value, message=_xml(in_words(message)))
    elif status in OPEN:
        ET.SubElement(test, "skipped", message=_xml(in_words(message)))


def _xml(text: str) -> str:
    """XML 1.0 has no place for most control characters."""
    return "".join(letter for letter in text if letter >= " " or letter in "\n\t")
