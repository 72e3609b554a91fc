"""Tables of a run: shortest times, speed-ups, stress tests, answers side by side."""

import dataclasses

from cases.answers import Table
from cases.runs import Run
from reports import tables
from reports.charts import of_case, relative_distance
from reports.style import figure_style
from tests.cases.example_run import FAILING, PASSING, example, only


def test_shortest_times_have_one_row_per_quantity_and_method_and_the_best_bound_where_none_is_good_enough():
    table = tables.shortest_times(example())
    assert table.heads[3:] == ("1 %", "1e-4", "1e-6", "1e-8", "MDR is faster")
    mdr, fem = table.rows
    assert mdr[2:5] == ("MDR", "1.00 ms (0 s)", "3.00 ms (0 s)")
    assert fem[2:5] == ("FEM", "50.0 ms (0 s)", "best 2.0e-3")
    assert (mdr[-1], fem[-1]) == ("", "50 x at 1 %")
    assert tables.shortest_times(only(FAILING)) is None


def test_every_setting_with_an_answer_is_listed_with_the_price_of_a_digit():
    (cost,) = example().judged.costs
    table = tables.settings(cost)
    assert [row[:2] for row in table.rows] == [("MDR", "8 nodes"), ("MDR", "16 nodes"), ("FEM", "edge 1e-2")]
    assert "MDR 1.17 x" in table.note


def test_a_stress_test_ends_completed_refused_or_failed():
    passing, refused = example().judged.stress_tests
    failed = dataclasses.replace(
        passing, steps=(*passing.steps[:3], dataclasses.replace(passing.steps[3], status="FAIL", reason="beyond"))
    )
    ends = [tables.end_of(test) for test in (passing, refused, failed)]
    assert ends == ["completed to 1.0e-7", "refused at 1.0e-7", "fails at 1.0e-4"]
    table = tables.stress_tests([passing, refused, failed])
    assert [row[table.heads.index("why it stopped")] for row in table.rows] == [
        "", "NotConvergedError: residual 1e-3", "beyond",
    ]  # fmt: skip


def test_answers_stand_side_by_side_with_the_error_they_state():
    table = tables.answers(example().answers.of_case(PASSING))
    assert table.heads == ("quantity", "MDR", "FEM")
    force = next(row for row in table.rows if row[0] == "normal force")
    assert force[1:] == ("1.5000000000000(15) N", "1.5000006(15) N")


def test_convergence_without_a_reference_shows_distances_to_the_finest_grid():
    study = example().judged.convergence[0]
    coarse = dataclasses.replace(study.grids[-1], error=None)
    assert relative_distance(study, study.grids[-1]) == study.grids[-1].error / study.scale
    assert relative_distance(study, coarse) == (coarse.value - study.grids[0].value) / study.scale


def test_a_case_has_a_picture_of_each_study_and_failed_settings_spoil_none():
    run = example()
    pictures = of_case(run, run.judged.cases[0])
    assert [picture.name.removeprefix("example_cone-").split("-")[0] for picture in pictures] == [
        "differences", "convergence", "convergence", "cost", "stress",
    ]  # fmt: skip
    with figure_style():
        drawings = [picture.draw() for picture in pictures]
    assert all(drawing.axes for drawing in drawings)


def test_answers_over_a_parameter_leave_out_what_a_logarithmic_axis_cannot_show():
    run = only(PASSING)
    (case,) = run.judged.cases
    scenes = {f"a/h={ratio}": {"a_over_h": ratio, "support": "bonded"} for ratio in (1.0, 2.0, 4.0, 5.0, "none")}
    first = next(answer for answer in run.answers if answer.method == "mdr")
    force = first.quantities["normal_force"]
    sizes = dict(zip(scenes, (1.5, 3.0, 6.0, 0.0, 1.0), strict=True))
    answers = [
        dataclasses.replace(first, scene=name, quantities={"normal_force": dataclasses.replace(force, values=(size,))})
        for name, size in sizes.items()
    ]
    case = dataclasses.replace(case, scenes=scenes)
    run = Run(judged=dataclasses.replace(run.judged, cases=(case,)), answers=Table(answers))
    picture = next(one for one in of_case(run, case) if one.name == "example_cone-answers")
    (axes,) = picture.draw().axes
    assert axes.lines[0].get_xydata().tolist() == [[1.0, 1.5], [2.0, 3.0], [4.0, 6.0]]
