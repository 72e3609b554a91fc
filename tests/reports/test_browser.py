"""The pages in a real browser: verdict first, a failure without scrolling, no clipped label, nothing too wide."""

import matplotlib.image
import pytest

from reports.page import CASES, write_report
from tests.cases.example_run import FAILING, PASSING, example, only
from tests.reports.browser import HEIGHT, PHONE, PRINTED_WIDTH, WIDTH, browser, measure, picture
from tests.reports.test_ci import many_failures

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not browser(), reason="no chromium or chrome on this machine; install one to look at pages"),
]


@pytest.fixture(scope="module")
def failed_page(tmp_path_factory):
    return write_report(example(), tmp_path_factory.mktemp("failed"))


@pytest.fixture(scope="module")
def measured(failed_page):
    return measure(failed_page)


def test_headline_and_first_failure_stand_on_the_first_screen(measured):
    assert measured["headline"][3] < HEIGHT / 4
    assert 0 < measured["worst"][3] < HEIGHT
    assert "INVALID" in measured["worst_text"]


def test_a_failure_stands_on_the_first_screen_of_a_long_report_too(tmp_path):
    page = write_report(many_failures(12), tmp_path)
    seen = measure(page)
    assert seen["worst"][3] < HEIGHT
    assert seen["page_width"] <= WIDTH


def test_no_label_of_a_figure_is_clipped(failed_page):
    pages = [measure(page) for page in (failed_page, *(failed_page.parent / CASES).glob("*.html"))]
    assert sum(seen["figures"] for seen in pages) >= 7
    assert [seen["clipped"] for seen in pages] == [[], [], []]


def test_the_clipping_check_sees_a_planted_label(failed_page, tmp_path):
    page = tmp_path / "planted.html"
    text = failed_page.read_text(encoding="utf-8")
    page.write_text(text.replace("</svg>", '<text x="-400" y="20">planted</text></svg>', 1), encoding="utf-8")
    assert measure(page)["clipped"] == ["planted"]


@pytest.mark.parametrize(("width", "printed"), [(WIDTH, False), (800, False), (PHONE, False), (PRINTED_WIDTH, True)])
def test_nothing_is_wider_than_its_window_or_its_sheet_of_paper(failed_page, width, printed):
    """On a phone wide tables scroll inside their own box; the page does not."""
    for page in (failed_page, *(failed_page.parent / CASES).glob("*.html")):
        seen = measure(page, width=width, printed=printed)
        assert seen["page_width"] <= width
        assert width == PHONE or seen["too_wide"] == []


def test_three_answers_stand_on_the_first_screen_of_a_run_that_passed(tmp_path):
    seen = measure(write_report(only(PASSING), tmp_path))
    assert len(seen["questions"]) == 3
    assert max(bottom for _, _, _, bottom in seen["questions"]) < HEIGHT / 2


def test_on_a_phone_the_three_answers_stand_before_their_pictures(tmp_path):
    seen = measure(write_report(only(PASSING), tmp_path), width=PHONE)
    assert len(seen["answers"]) >= 3
    assert max(bottom for _, _, _, bottom in seen["answers"]) < HEIGHT


def test_the_width_check_sees_a_planted_cell(failed_page, tmp_path):
    page = tmp_path / "wide.html"
    text = failed_page.read_text(encoding="utf-8")
    page.write_text(
        text.replace("<td", f'<td style="white-space: nowrap">{"wide " * 200}</td><td', 1), encoding="utf-8"
    )
    assert measure(page)["too_wide"]


@pytest.mark.parametrize(("case", "red"), [(FAILING, True), (PASSING, False)], ids=["failed", "passed"])
def test_the_picture_shows_the_verdict_in_its_colour(case, red, tmp_path):
    page = write_report(only(case), tmp_path)
    picture(page, tmp_path / "page.png")
    r, g, _ = matplotlib.image.imread(tmp_path / "page.png")[4, 4, :3]
    assert bool(r > 2 * g) is red
