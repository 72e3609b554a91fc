"""Every output sees the same rows, worst first, and a failure can hide in none of them."""

import dataclasses
import html
import re
import xml.etree.ElementTree as ET

import pytest

from cases.results.records.run import RunResult
from cases.results.status import Status
from contact.records.errors import printable
from reports.pages.annotations import MOST, annotation_lines
from reports.pages.junit import junit_text
from reports.pages.outcomes import WORST_FIRST, counts, headline, outcomes
from reports.pages.report import write_report
from reports.pages.summary import summary_text
from tests.cases.example_run import example_run, failing_case, passing_case


def only(*cases, complete=True) -> RunResult:
    return dataclasses.replace(example_run(), cases=cases, complete=complete)


def renamed(case, number):
    return dataclasses.replace(case, name=f"{case.name}_{number}")


def many_failures(number) -> RunResult:
    return only(*(renamed(failing_case(), i) for i in range(number)))


def test_reading_order_names_every_status_once():
    assert sorted(WORST_FIRST) == sorted(Status)


def test_failures_come_first_and_every_claim_and_solution_has_a_row():
    run = example_run()
    rows = outcomes(run)
    skips = run.statuses.count(Status.SKIP)
    assert len(rows) == len(run.statuses) - skips + 1
    claims = [claim.status for case in run.cases for claim in case.claims]
    broken = [one.status for case in run.cases for one in case.runs if one.status.is_failure]
    expected = {status: [*claims, *broken].count(status) for status in {*claims, *broken}} | {Status.SKIP: 1}
    assert dict(counts(rows)) == expected
    tones = [row.tone for row in rows]
    assert tones[: tones.count("bad")] == ["bad"] * tones.count("bad")
    assert rows[-1].status is Status.PASS


@pytest.mark.parametrize(
    ("run", "words"),
    [
        (example_run(), "FAILED: 4 of 8 checks"),
        (only(passing_case()), "PASSED: all 3 checks"),
        (only(passing_case(), complete=False), "INCOMPLETE: 3 checks so far, none failed"),
        (only(), "Nothing ran"),
        (only(failing_case(), complete=False), "FAILED: 4 of 5 checks"),
    ],
)
def test_headline(run, words):
    assert headline(run, outcomes(run))[0] == words


def test_an_identity_is_shown_and_not_counted():
    case = passing_case()
    first, *others = case.claims
    case = dataclasses.replace(case, claims=(dataclasses.replace(first, identity="the kernel has no nu"), *others))
    rows = outcomes(only(case))
    assert headline(only(case), rows)[0] == "PASSED: all 2 checks"
    (row,) = [row for row in rows if row.identity]
    assert (row.word, row.status) == ("IDENTITY", Status.PASS)
    assert "the kernel has no nu" in row.message


def test_skips_of_one_reason_are_one_row():
    case = failing_case()
    (skip,) = [one for one in case.runs if one.status is Status.SKIP]
    again = [dataclasses.replace(skip, scene=f"scene {i}") for i in range(3)]
    other = dataclasses.replace(skip, reason="models no punches")
    rows = outcomes(only(dataclasses.replace(case, runs=(skip, *again, other))))
    words = {row.message: (row.name, row.scene) for row in rows if row.status is Status.SKIP}
    assert set(words) == {skip.reason, "models no punches"}
    assert words[skip.reason][0].endswith(" skips")


def test_summary_puts_failures_first_and_says_what_was_left_out():
    text = summary_text(example_run())
    verdicts = [line.split("|")[1].strip() for line in text.partition("| verdict |")[2].splitlines()[2:]]
    assert verdicts[:4] == ["**INVALID**", "**INVALID**", "**FAIL**", "**DIFF**"]
    assert "\n# " not in text[1:]
    short = summary_text(many_failures(30), largest=8_000)
    assert len(short.encode()) <= 8_000
    assert "further rows" in short
    assert "**INVALID**" in short
    assert "PASS |" not in short


def test_summary_of_a_hundred_thousand_rows_stays_short():
    long_message = dataclasses.replace(failing_case().claims[0], message="µ" * 5000)
    case = dataclasses.replace(failing_case(), claims=(long_message,) * 300)
    assert len(summary_text(only(case)).encode()) <= 64_000


def test_the_summary_shows_the_matrix_and_nothing_that_passed():
    text = summary_text(example_run())
    matrix, _, rows = text.partition("| verdict |")
    assert "| example_cone |  | PASS 0.04 (1) |" in matrix
    assert "| PASS |" not in rows
    assert "Every check ran and passed." in summary_text(only(passing_case()))


def test_summary_cells_cannot_break_the_table():
    claim = dataclasses.replace(failing_case().claims[0], message="a | b\nc")
    text = summary_text(only(dataclasses.replace(failing_case(), claims=(claim,), runs=())))
    assert "a \\| b c" in text


HOSTILE = (
    "<script>alert(1)</script>", "<img src=x onerror=alert(1)>", "a & b &lt;", "[click](javascript:alert(1))",
    "![](//host/x.png)", "https://host/x", "`code`", "*stars* __bold__ ~gone~", "a | b\nc", "@somebody", "\x1b[2J",
)  # fmt: skip


@pytest.mark.parametrize("text", HOSTILE)
@pytest.mark.parametrize("place", ["name", "scene", "methods", "message"])
def test_summary_shows_text_as_it_stands_and_the_page_says_the_same(text, place, tmp_path):
    """What a reader of Markdown makes of a cell is the text itself: no tag, link, code, emphasis or person."""
    claim = dataclasses.replace(failing_case().claims[0], **{place: (text,) if place == "methods" else text})
    run = only(dataclasses.replace(failing_case(), claims=(claim,), runs=()))
    markdown = summary_text(run)
    assert not re.search(r"<[a-z]|\]\(|://|`|@|~|\x1b|(?<!\*)\*(?!\*)|(?<!\w)_", markdown.split("|---|")[-1])
    cells = re.split(r"(?<!\\)\|", markdown.splitlines()[-1])[1:-1]
    assert len(cells) == 8
    shown = html.unescape(" ".join(cells)).replace("\\|", "|")
    assert printable(" ".join(text.split())) in shown
    if place != "methods":  # the page has names of its own for methods
        assert html.escape(text.split()[0]) in write_report(run, tmp_path).read_text(encoding="utf-8")


def test_junit_has_one_testcase_per_claim_and_solution_and_agrees_with_the_statuses():
    run = example_run()
    root = ET.fromstring(junit_text(run))
    assert len(root.findall(".//testcase")) == len(run.statuses)
    assert len(root.findall(".//failure")) + len(root.findall(".//error")) == sum(s.is_failure for s in run.statuses)
    suite = root.find("testsuite[@name='example_failures']")
    assert suite.attrib | {"timestamp": "", "time": ""} == {
        "name": "example_failures", "timestamp": "", "time": "",
        "tests": "8", "failures": "2", "errors": "2", "skipped": "3",
    }  # fmt: skip
    names = [(element.get("classname"), element.get("name")) for element in root.findall(".//testcase")]
    assert len(set(names)) == len(names)


def test_junit_survives_letters_that_xml_forbids():
    claim = dataclasses.replace(failing_case().claims[0], message="bell \x07 <&> \x1b[31m")
    ET.fromstring(junit_text(only(dataclasses.replace(failing_case(), claims=(claim,)))))


@pytest.mark.parametrize("cases", [1, 2, 3, 30])
def test_there_are_never_more_than_nine_annotations_and_none_is_lost_silently(cases):
    run = many_failures(cases)
    failed = sum(status.is_failure for status in run.statuses)
    lines = annotation_lines(run)
    assert len(lines) == min(failed, MOST)
    assert all(line.startswith("::error title=") and "\n" not in line for line in lines)
    if failed > MOST:
        assert f"{failed - MOST + 1} more failures" in lines[-1]


def test_annotation_escapes_what_a_workflow_command_would_read():
    claim = dataclasses.replace(failing_case().claims[0], message="50 % off\nsecond line")
    (line,) = annotation_lines(only(dataclasses.replace(failing_case(), claims=(claim,), runs=())))
    assert line.endswith("::50 %25 off%0Asecond line; measured 0.25, tolerance 1.0e-10")
    assert "FAIL example_failures%3A" in line


def test_a_run_that_only_measures_times_did_run():
    case = dataclasses.replace(passing_case(), claims=(), runs=())
    assert headline(only(case), ()) == ("MEASURED: 1 case, no claims", "good")
    assert headline(only(dataclasses.replace(case, work_precision=())), ())[0] == "Nothing ran"
