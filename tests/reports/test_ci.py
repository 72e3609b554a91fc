"""summary.md, junit.xml and annotations: failures first, never too long, and no text that breaks them."""

import dataclasses
import html
import re
import xml.etree.ElementTree as ET

import pytest

from cases.runs import Run
from contact.records.errors import printable
from reports.ci import LARGEST, MOST, annotation_lines, junit_text, summary_text
from reports.page import write_report
from tests.cases.example_run import FAILING, PASSING, example, only, verdict, with_verdicts


def many_failures(number) -> Run:
    names = [f"failing_{i}" for i in range(number)]
    run = only(FAILING)
    cases = tuple(dataclasses.replace(run.judged.cases[0], name=name) for name in names)
    verdicts = tuple(dataclasses.replace(v, case=name) for name in names for v in run.judged.verdicts)
    answers = [dataclasses.replace(answer, case=name) for name in names for answer in run.answers]
    judged = dataclasses.replace(run.judged, cases=cases, verdicts=verdicts)
    return Run(judged=judged, answers=type(run.answers)(answers))


def test_summary_puts_failures_first_and_says_what_was_left_out():
    text = summary_text(example())
    verdicts = [line.split("|")[1].strip() for line in text.partition("| verdict |")[2].splitlines()[2:]]
    assert verdicts[:4] == ["**INVALID**", "**INVALID**", "**FAIL**", "**DIFF**"]
    assert "\n# " not in text[1:]
    short = summary_text(many_failures(30), largest=8_000)
    assert len(short.encode()) <= 8_000
    assert "further rows" in short
    assert "**INVALID**" in short
    assert "PASS |" not in short.partition("| verdict |")[2]


def test_summary_of_a_hundred_thousand_rows_stays_short():
    longest = [dataclasses.replace(verdict(), claim=f"claim {i}", message="µ" * 5000) for i in range(300)]
    assert len(summary_text(with_verdicts(*longest)).encode()) <= LARGEST


def test_the_summary_shows_the_matrix_and_nothing_that_passed():
    matrix, _, rows = summary_text(example()).partition("| verdict |")
    assert "| example_cone |  | PASS 0.04 (1) |" in matrix
    assert "| PASS |" not in rows
    assert "Every check ran and passed." in summary_text(only(PASSING))


HOSTILE = (
    "<script>alert(1)</script>", "<img src=x onerror=alert(1)>", "a & b &lt;", "[click](javascript:alert(1))",
    "![](//host/x.png)", "https://host/x", "`code`", "*stars* __bold__ ~gone~", "a | b\nc", "@somebody", "\x1b[2J",
)  # fmt: skip


@pytest.mark.parametrize("text", HOSTILE)
@pytest.mark.parametrize("place", ["claim", "scene", "methods", "message"])
def test_summary_shows_text_as_it_stands_and_the_page_says_the_same(text, place, tmp_path):
    """What a reader of Markdown makes of a cell is the text itself: no tag, link, code, emphasis or person."""
    run = with_verdicts(
        dataclasses.replace(verdict(), **{place: (text,) if place == "methods" else text}), case=FAILING
    )
    markdown = summary_text(run)
    assert not re.search(r"<[a-z]|\]\(|://|`|@|~|\x1b|(?<!\*)\*(?!\*)|(?<!\w)_", markdown.split("|---|")[-1])
    cells = re.split(r"(?<!\\)\|", markdown.splitlines()[-1])[1:-1]
    assert len(cells) == 8
    shown = html.unescape(" ".join(cells)).replace("\\|", "|")
    assert printable(" ".join(text.split())) in shown
    if place == "message":  # a page escapes all texts alike, and takes long
        assert html.escape(text.split()[0]) in write_report(run, tmp_path).read_text(encoding="utf-8")


def test_junit_has_one_testcase_per_verdict_and_solution_and_agrees_with_the_statuses():
    run = example()
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
    spoiled = dataclasses.replace(verdict(), message="bell \x07 <&> \x1b[31m")
    assert "bell" in ET.tostring(ET.fromstring(junit_text(with_verdicts(spoiled, case=FAILING))), encoding="unicode")


@pytest.mark.parametrize("cases", [1, 2, 3, 30])
def test_there_are_never_more_than_nine_annotations_and_none_is_lost_silently(cases):
    lines = annotation_lines(many_failures(cases))
    # The accepted numbers of all cases are one finding, every other failure is one per case.
    failed = 3 * cases + 1
    assert len(lines) == min(failed, MOST)
    assert all(line.startswith("::error title=") and "\n" not in line for line in lines)
    if failed > MOST:
        assert f"{failed - MOST + 1} more failures" in lines[-1]


def test_annotation_escapes_what_a_workflow_command_would_read():
    run = with_verdicts(dataclasses.replace(verdict(), message="50 % off\nsecond line"), case=FAILING)
    (line,) = annotation_lines(run)
    assert line.endswith("::50 %25 off%0Asecond line")
    assert "FAIL example_failures%3A" in line
