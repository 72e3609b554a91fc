"""The page: complete, self-contained, the same on every run, and a failure cannot be overlooked in it."""

import csv
import dataclasses
import re
import warnings

import pytest

from cases.answers import Table
from cases.runs import Run
from reports.charts import front, of_case
from reports.page import CASES, FIGURES, unbroken, write_report
from reports.style import figure_style, svg_text
from tests.cases.example_run import FAILING, PASSING, example, only, verdict, with_verdicts

LARGEST_PAGE = 500_000  # bytes


@pytest.fixture(scope="module")
def directory(tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    write_report(example(), folder, single_file=True)
    return folder


@pytest.fixture(scope="module")
def page(directory):
    return (directory / "report.html").read_text(encoding="utf-8")


def text_of(run, folder):
    return write_report(run, folder).read_text(encoding="utf-8")


def words_of(page):
    return re.sub(r"\s+", " ", re.sub(r"<style.*?</style>|<[^>]*>", " ", page, flags=re.DOTALL))


def not_a_number(text):
    return re.findall(r"\b(nan|inf|None)\b", text.replace("fill: none", "").replace("stroke: none", ""))


@pytest.mark.slow
def test_nothing_on_the_page_or_in_the_data_reads_nan_or_none(page, directory):
    assert not not_a_number(page)
    assert not not_a_number((directory / "answers.csv").read_text(encoding="utf-8"))


def test_the_nan_check_sees_a_planted_one(tmp_path):
    case = dataclasses.replace(only(FAILING).judged.cases[0], text="a planted nan")
    assert not_a_number(text_of(only(FAILING, cases=(case,)), tmp_path))


def test_a_reason_that_speaks_of_nan_says_it_in_words(tmp_path):
    claim = dataclasses.replace(verdict(), message="force is nan, error inf, -inf; finance")
    page = text_of(with_verdicts(claim, case=FAILING), tmp_path)
    assert "force is not-a-number, error infinity, -infinity; finance" in page
    assert not not_a_number(page)


def test_verdict_and_failures_come_before_anything_else(page):
    words = words_of(page)
    assert words.index("FAILED: 4 of 8 checks") < words.index("half-space force") < words.index("Cases and claims")
    places = [page.index(f'id="{anchor}"') for anchor in ("worst", "matrix", "example_cone", "failures", "stamp")]
    assert places == sorted(places)


@pytest.mark.slow
def test_measurements_without_checks_show_no_empty_matrix(tmp_path):
    run = only(PASSING, verdicts=())
    page = text_of(Run(judged=run.judged, answers=type(run.answers)()), tmp_path)
    assert "Cases and claims" not in words_of(page)
    assert "#matrix" not in page


def test_a_passing_run_has_no_word_of_failure(tmp_path):
    words = words_of(text_of(with_verdicts(*only(PASSING).judged.verdicts), tmp_path))
    assert "PASSED: all 3 checks" in words
    assert not re.search(r"\b(FAIL|FAILED|INVALID|DIFF)\b", words)


@pytest.mark.slow
def test_an_interrupted_run_says_so(tmp_path):
    assert "INCOMPLETE" in words_of(text_of(only(PASSING, complete=False), tmp_path))


def test_a_method_to_blame_is_named_above_the_failures(tmp_path):
    wrong = [dataclasses.replace(verdict(), scene=f"scene {i}", error=1e-3) for i in range(20)]
    words = words_of(text_of(with_verdicts(*wrong, case=FAILING), tmp_path))
    cause = "MDR: normal force is off against closed form, +1.0e-3 each in 20 comparisons"
    assert words.index(cause) < words.index("20 of 20 scenes")


def test_claims_of_one_reason_are_folded_together_and_open_where_one_failed(tmp_path):
    passed = only(PASSING).judged.verdicts[0]
    twin = dataclasses.replace(passed, claim="another")
    failed = dataclasses.replace(verdict(), case=PASSING, why=dataclasses.replace(passed.why, because="something else"))
    page = text_of(with_verdicts(passed, twin, failed), tmp_path).partition("Claims by reason")[2]
    folded, opened = re.findall(r"<details( open)?>\s*<summary><span class=\"(\w+) tag\">", page)[:2]
    assert {folded, opened} == {("", "good"), (" open", "bad")}
    assert page.count("2 checks") == 1


def test_a_wide_tolerance_stands_beside_the_verdict_and_is_counted_above(tmp_path):
    passed = next(v for v in only(PASSING).judged.verdicts if v.kind == "agreement")
    for tolerance, shown in ((1e-5, False), (0.05, True)):
        page = text_of(with_verdicts(dataclasses.replace(passed, tolerance=tolerance)), tmp_path)
        assert ("within 5 %" in page) is shown
        assert ("have a tolerance wider than 1 %" in page.partition('id="matrix"')[0]) is shown


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
    return write_report(example(), folder), sorted((folder / CASES).glob("*.html"))


def test_the_front_page_answers_three_questions_before_the_matrix(levels):
    front = words_of(levels[0].read_text(encoding="utf-8"))
    questions = ("Do the methods agree?", "What does accuracy cost?", "Where does it break?", "Cases and claims")
    places = [front.index(question) for question in questions]
    assert places == sorted(places)
    assert "2 comparisons" in front
    assert "1 remain open" in front


def test_every_case_has_a_page_of_its_own_that_needs_no_other_file(levels):
    front, pages = levels
    assert [page.stem for page in pages] == sorted(case.name for case in example().judged.cases)
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


@pytest.mark.slow
def test_pages_of_cases_that_are_gone_are_removed(tmp_path):
    (tmp_path / CASES).mkdir()
    (tmp_path / CASES / "gone.html").write_text("earlier", encoding="utf-8")
    write_report(only(PASSING), tmp_path)
    assert not list((tmp_path / CASES).glob("*.html"))


def test_cells_without_a_number_are_empty(page):
    """Style sheets hide empty cells on a telephone. A line end after a cell was part of it."""
    assert "<td class=n><td>" in page
    assert not re.search(r"<t[dh][^>]*>\s+<t", page)


def test_page_is_far_below_its_size_limit(page):
    assert len(page.encode()) < LARGEST_PAGE


def test_the_first_thing_of_a_case_page_is_its_verdict_and_then_a_picture(levels):
    for page in levels[1]:
        text = page.read_text(encoding="utf-8")
        assert text.index("<h1>") < text.index("<svg") < text.index("Claims by reason")


def test_every_picture_is_written_and_named_below_it(directory, page):
    written = {path.name for path in (directory / FIGURES).iterdir()}
    assert {f"{name}.svg" for name in re.findall(r"<code>figures/([^<]*)\.svg</code>", page)} == written


@pytest.mark.first(1)
@pytest.mark.parametrize("name", [FAILING, PASSING, ""])
def test_pictures_are_byte_identical_on_a_second_run(name):
    run = example()
    case = next((case for case in run.judged.cases if case.name == name), None)
    for picture in of_case(run, case) if case else [one for drawn in front(run) for one in drawn]:
        with figure_style():
            first, second = (svg_text(picture.draw(), key=picture.name) for _ in range(2))
        assert first == second
        assert not re.search(r"\d{4}-\d\d-\d\d|nan", first)


@pytest.mark.slow
def test_panels_without_a_refused_step_fill_their_picture():
    """The layout of all panels failed, with a warning, where every step of a stress test was completed."""
    run = only(PASSING)
    completed = next(test for test in run.judged.stress_tests if all(step.digits for step in test.steps))
    run = only(PASSING, stress_tests=tuple(dataclasses.replace(completed, name=name) for name in "abc"))
    drawn = next(one for one in of_case(run, run.judged.cases[0]) if "stress-tests" in one.name)
    with figure_style(), warnings.catch_warnings(action="error"):
        assert svg_text(drawn.draw(), key=drawn.name).startswith("<svg")


def test_a_single_timed_setting_is_a_number_of_the_table_and_no_picture():
    cost = only(PASSING).judged.costs[0]
    for points, drawn in ((cost.points[:1], False), (cost.points[:2], True)):
        run = only(PASSING, costs=(dataclasses.replace(cost, points=points),))
        assert any("-cost-" in one.name for one in of_case(run, run.judged.cases[0])) is drawn


def test_a_line_joins_scenes_that_differ_in_its_parameter_alone():
    """Scenes of two profiles with equal parameters were joined by one zigzag line."""
    places = [(profile, thin) for profile in ("cone", "sphere") for thin in (1.0, 2.0, 4.0)]
    scenes = {f"bonded a/h={thin:g}, {profile}": {"a_over_h": thin} for profile, thin in places}
    run = only(PASSING)
    case = dataclasses.replace(run.judged.cases[0], scenes=scenes)
    template = next(answer for answer in run.answers if answer.method == "mdr")
    run = Run(judged=run.judged, answers=Table(dataclasses.replace(template, scene=scene) for scene in scenes))
    drawn = next(one for one in of_case(run, case) if one.name.endswith("answers"))
    with figure_style():
        (axes,) = drawn.draw().axes
    assert [list(line.get_xdata()) for line in axes.lines] == [[1.0, 2.0, 4.0]] * 2
    assert [text.get_text() for text in axes.texts] == ["bonded cone", "bonded sphere"]


def test_numbers_stay_on_one_line_and_with_their_units():
    assert unbroken("took 3 min 27 s, of 1.6e-07 a < b") == (
        "took <span class=nb>3\u00a0min</span> <span class=nb>27\u00a0s,</span> of <span class=nb>1.6e-07</span> "
        "a &lt; b"
    )


def test_the_numbers_of_a_run_stand_in_one_table_with_all_their_digits(directory):
    rows = list(csv.DictReader((directory / "answers.csv").read_text(encoding="utf-8").splitlines()))
    force = [answer.quantities["normal_force"] for answer in example().answers if answer.solved]
    found = [row for row in rows if row["quantity"] == "normal_force"]
    assert [float(row["value"]) for row in found] == [q.values[0] for q in force]
    assert [float(row["error"]) for row in found] == [q.error[0] for q in force]


@pytest.mark.slow
def test_a_text_with_angle_brackets_stays_a_text(tmp_path):
    (case,) = only(PASSING).judged.cases
    case = dataclasses.replace(case, question="Is a < b & <script>alert(1)</script>?")
    assert "<script>" not in text_of(only(PASSING, cases=(case,)), tmp_path)
