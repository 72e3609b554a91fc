"""The page: complete, self-contained, the same on every run, and a failure cannot be overlooked in it."""

import csv
import dataclasses
import io
import re

import pytest

from reports.charts import agreement, convergence, ladder, work_precision
from reports.figures import figure_files as folder_module
from reports.figures.figure import write_figure
from reports.figures.figure_files import FOLDER, ROOM, FigureFolder
from reports.figures.renderer import report_figure
from reports.pages.report import CASES, write_report
from tests.cases.example_run import example_run, failing_case, passing_case

LARGEST_PAGE = 5_000_000  # bytes


@pytest.fixture(scope="module")
def directory(tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    write_report(example_run(), folder, single_file=True)
    return folder


@pytest.fixture(scope="module")
def page(directory):
    return (directory / "report.html").read_text(encoding="utf-8")


def words_of(page):
    return re.sub(r"<style.*?</style>|<[^>]*>", " ", page, flags=re.DOTALL)


def figures_of(case):
    figures = [report_figure(figure, case.name) for figure in case.figures]
    charts = (agreement, convergence, ladder, work_precision)
    return figures + [drawing for chart in charts for drawing in chart.figures(case)]


def table_of(drawing):
    return list(csv.DictReader(io.StringIO(drawing.csv_text())))


def not_a_number(text):
    return re.findall(r"\b(nan|inf|None)\b", text.replace("fill: none", "").replace("stroke: none", ""))


def test_nothing_on_the_page_or_in_the_data_reads_nan_or_none(page, directory):
    assert not not_a_number(page)
    for data in (directory / FOLDER).glob("*.csv"):
        assert not not_a_number(data.read_text(encoding="utf-8")), data.name


def test_the_nan_check_sees_a_planted_one(tmp_path):
    case = dataclasses.replace(failing_case(), text="a planted nan")
    write_report(dataclasses.replace(example_run(), cases=(case,)), tmp_path)
    assert not_a_number((tmp_path / "report.html").read_text(encoding="utf-8"))


def test_a_reason_that_speaks_of_nan_says_it_in_words(tmp_path):
    claim = dataclasses.replace(failing_case().claims[0], message="force is nan, error inf, -inf; finance")
    case = dataclasses.replace(failing_case(), claims=(claim,))
    write_report(dataclasses.replace(example_run(), cases=(case,)), tmp_path)
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "force is not-a-number, error infinity, -infinity; finance" in page
    assert not not_a_number(page)


def test_verdict_and_failures_come_before_anything_else(page):
    words = words_of(page)
    assert words.index("FAILED: 4 of 8 checks") < words.index("half-space force") < words.index("Cases and claims")
    assert page.index('id="worst"') < page.index('id="matrix"')


def test_all_parts_are_there_in_order(page):
    places = [page.index(f'id="{anchor}"') for anchor in ("matrix", "example_cone", "failures", "stamp")]
    assert places == sorted(places)


def test_measurements_without_checks_show_no_empty_matrix(tmp_path):
    case = dataclasses.replace(passing_case(), claims=(), runs=())
    page = write_report(dataclasses.replace(example_run(), cases=(case,)), tmp_path).read_text(encoding="utf-8")
    assert "Cases and claims" not in words_of(page)
    assert "#matrix" not in page


def test_a_passing_run_has_no_word_of_failure(tmp_path):
    write_report(dataclasses.replace(example_run(), cases=(passing_case(),)), tmp_path)
    words = words_of((tmp_path / "report.html").read_text(encoding="utf-8"))
    assert "PASSED: all 3 checks" in words
    assert not re.search(r"\b(FAIL|FAILED|INVALID|DIFF)\b", words)


def test_an_interrupted_run_says_so(tmp_path):
    write_report(dataclasses.replace(example_run(), cases=(passing_case(),), complete=False), tmp_path)
    assert "INCOMPLETE" in words_of((tmp_path / "report.html").read_text(encoding="utf-8"))


def test_page_loads_nothing_from_elsewhere_and_runs_no_script(page):
    without_names = page.replace('xmlns="http://www.w3.org/2000/svg"', "").replace(
        'xmlns:xlink="http://www.w3.org/1999/xlink"', ""
    )
    assert not re.search(r"https?://|//cdn|@import|<script|<link|<iframe|\bsrc=|javascript:", without_names)
    assert all(link.startswith("#") for link in re.findall(r'href="([^"]*)"', without_names))


def test_every_link_on_the_page_has_its_target_and_no_id_occurs_twice(page):
    ids = re.findall(r'\bid="([^"]*)"', page)
    assert len(ids) == len(set(ids))
    targets = re.findall(r'href="#([^"]*)"', page) + re.findall(r"url\(#([^)]*)\)", page)
    assert set(targets) <= set(ids)


@pytest.fixture(scope="module")
def levels(tmp_path_factory):
    """The front page of a run of two cases, and the pages of the cases."""
    folder = tmp_path_factory.mktemp("levels")
    return write_report(example_run(), folder), sorted((folder / CASES).glob("*.html"))


def test_the_front_page_answers_three_questions_before_the_matrix(levels):
    front = words_of(levels[0].read_text(encoding="utf-8"))
    questions = ("Do the methods agree?", "What does accuracy cost?", "Where does it break?", "Cases and claims")
    places = [front.index(question) for question in questions]
    assert places == sorted(places)
    assert "2 comparisons" in front
    assert "1 remain open" in front


def test_every_case_has_a_page_of_its_own_that_needs_no_other_file(levels):
    front, pages = levels
    assert [page.stem for page in pages] == sorted(case.name for case in example_run().cases)
    for page in pages:
        text = page.read_text(encoding="utf-8")
        assert "<svg" in text
        assert not re.search(r"<script|<link|<iframe|\bsrc=", text)
        assert 'id="example_cone"' not in front.read_text(encoding="utf-8")


def test_every_link_between_the_pages_has_its_target(levels):
    front, pages = levels
    for page in (front, *pages):
        text = page.read_text(encoding="utf-8")
        ids = set(re.findall(r'\bid="([^"]*)"', text))
        for link in re.findall(r'href="([^"]*)"', re.sub(r"<svg.*?</svg>", "", text, flags=re.DOTALL)):
            file, _, anchor = link.partition("#")
            assert (page.parent / file).is_file() if file else anchor in ids, link


def test_pages_of_cases_that_are_gone_are_removed(tmp_path):
    write_report(example_run(), tmp_path)
    assert list((tmp_path / CASES).glob("*.html"))
    write_report(example_run(), tmp_path, single_file=True)
    assert not list((tmp_path / CASES).glob("*.html"))


def test_page_is_far_below_its_size_limit(page):
    assert len(page.encode()) < LARGEST_PAGE / 10


def test_pictures_leave_room_for_tables_below_five_megabytes():
    assert ROOM <= 0.6 * LARGEST_PAGE


def test_a_picture_without_room_is_named_with_its_file(tmp_path):
    two = figures_of(passing_case())[:2]
    room = len(write_figure(two[0], tmp_path))
    folder = FigureFolder(tmp_path, room=room)
    first, second = folder.place(two, "again")
    folder.draw()
    assert first.svg
    assert not second.svg
    assert (tmp_path / FOLDER / f"{second.figure.name}.svg").exists()


def test_processes_draw_the_same_pictures_in_the_same_order(tmp_path, monkeypatch):
    monkeypatch.setattr(folder_module, "FEW", 1)
    drawings = figures_of(passing_case())[:2] + figures_of(failing_case())[:2]
    drawn = []
    for jobs in (1, 2):
        folder = FigureFolder(tmp_path / str(jobs))
        placed = folder.place(drawings, "again")
        folder.draw(jobs)
        drawn.append([place.svg for place in placed])
    assert drawn[0] == drawn[1]
    assert all(f'id="{drawing.name}-' in svg for drawing, svg in zip(drawings, drawn[1], strict=True))


def test_two_figures_of_one_name_are_refused(tmp_path):
    drawing = figures_of(failing_case())[0]
    with pytest.raises(ValueError, match="two figures are called 'example_failures-agreement-1'"):
        FigureFolder(tmp_path).place([drawing, drawing], "again")


DRAWINGS = figures_of(passing_case()) + figures_of(failing_case())


@pytest.mark.parametrize("drawing", DRAWINGS, ids=lambda drawing: drawing.name)
def test_svg_and_png_are_byte_identical_on_a_second_run(drawing, tmp_path):
    first = write_figure(drawing, tmp_path)
    picture = (tmp_path / f"{drawing.name}.png").read_bytes()
    assert write_figure(drawing, tmp_path) == first
    assert (tmp_path / f"{drawing.name}.png").read_bytes() == picture
    assert not re.search(r"\d{4}-\d\d-\d\d|nan", first)


def test_figure_data_equal_the_records_digit_for_digit():
    (figure,) = passing_case().figures
    rows = table_of(report_figure(figure, "case"))
    expected = [(x, y) for panel in figure.panels for s in panel.series for x, y in zip(s.x, s.y, strict=True)]
    assert [(float(row["x"]), float(row["y"])) for row in rows] == expected


def test_convergence_data_equal_the_records_digit_for_digit():
    (drawing,) = convergence.figures(passing_case())
    expected = [(grid.length, grid.value, grid.error) for study in passing_case().convergence for grid in study.grids]
    assert [(float(row["length"]), float(row["value"]), float(row["error"])) for row in table_of(drawing)] == expected


def test_convergence_without_a_reference_shows_distances_to_the_extrapolated_value():
    study = passing_case().convergence[0]
    grids = tuple(dataclasses.replace(grid, error=None) for grid in study.grids)
    without = dataclasses.replace(study, grids=grids, reference=None)
    # the fabricated study extrapolates to its reference
    for shown, expected in zip(convergence.distances(without), convergence.distances(study), strict=True):
        assert shown == pytest.approx(expected, rel=1e-12, abs=0.0)
    finest = convergence.distances(dataclasses.replace(without, extrapolated=None))
    assert len(finest) == len(grids) - 1  # the finest is what the others are compared with


def test_work_precision_data_equal_the_records_and_failures_keep_their_reason():
    (drawing,) = work_precision.figures(passing_case())
    points = passing_case().work_precision[0].points
    rows = table_of(drawing)
    assert [float(row["seconds"]) for row in rows] == [point.seconds for point in points]
    assert [row["bound"] for row in rows] == ["" if point.bound is None else repr(point.bound) for point in points]
    assert rows[-1]["reason"] == "NotConvergedError: locking"


def test_ladder_data_equal_the_records_and_a_refused_rung_has_no_digits():
    (drawing,) = ladder.figures(passing_case())
    rungs = [rung for climbed in passing_case().ladders for rung in climbed.rungs]
    rows = table_of(drawing)
    assert [row["digits"] for row in rows] == ["" if rung.digits is None else repr(rung.digits) for rung in rungs]
    assert rows[-1]["reason"] == "NotConvergedError: residual 1e-3"


def test_agreement_data_equal_the_claims_worst_first():
    case = dataclasses.replace(passing_case(), claims=passing_case().claims + failing_case().claims)
    (drawing,) = agreement.figures(case)
    rows = table_of(drawing)
    assert [row["status"] for row in rows] == ["INCONCLUSIVE", "PASS"]
    assert [float(row["observed"]) for row in rows] == [2e-6, 4e-7]


def test_a_text_with_angle_brackets_stays_a_text(tmp_path):
    case = dataclasses.replace(passing_case(), question="Is a < b & <script>alert(1)</script>?")
    write_report(dataclasses.replace(example_run(), cases=(case,)), tmp_path)
    assert "<script>" not in (tmp_path / "report.html").read_text(encoding="utf-8")
