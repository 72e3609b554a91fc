"""The cost page shows measured times only: reached, not reached, and how much faster."""

import dataclasses

from reports.charts.work_precision import draw
from reports.tables.case_tables import cheapest, digit_prices
from reports.tables.cost_tables import settings, shortest_times, speed_ups
from reports.words import duration
from tests.cases.example_run import example_run, work_precision

WORK = work_precision()


def test_one_row_a_quantity_and_method():
    table = shortest_times(example_run())
    methods = {row[2] for row in table.rows}
    assert {"MDR", "FEM"} <= methods
    assert table.heads[3:] == ("1 %", "1e-4", "1e-6", "1e-8")


def test_an_accuracy_that_was_not_reached_shows_the_best_bound():
    cells = [cell for row in shortest_times(example_run()).rows for cell in row[3:]]
    assert any(cell.startswith("best ") for cell in cells)
    reached = next(row for row in WORK.cheapest if row.reached and row.tolerance == 1e-2)
    assert any(cell.startswith(duration(reached.seconds)) for cell in cells)


def test_speed_ups_name_the_slower_method():
    table = speed_ups(example_run())
    assert table.title == "How much faster MDR is"
    assert {row[2] for row in table.rows} >= {"FEM"}


def test_a_run_without_timings_has_no_cost_page():
    bare = dataclasses.replace(example_run(), cases=())
    assert shortest_times(bare) is None
    assert speed_ups(bare) is None


def test_every_setting_with_an_answer_has_its_degrees():
    table = settings(WORK)
    assert len(table.rows) == sum(1 for point in WORK.points if point.bound)
    assert all(len(row) == len(table.heads) for row in table.rows)


def test_methods_stand_side_by_side_and_an_accuracy_nobody_reached_is_empty():
    table = cheapest(WORK)
    assert table.heads[0] == "τ"
    assert len(table.rows) == len({entry.tolerance for entry in WORK.cheapest})
    for entry in WORK.cheapest:
        row = next(row for row in table.rows if float(row[0]) == entry.tolerance)
        cell = row[table.heads.index({"mdr": "MDR", "fem": "FEM"}[entry.method])]
        assert cell == (duration(entry.seconds) if entry.reached else "")


def test_a_digit_that_costs_almost_everything_does_not_fill_the_page():
    price = dataclasses.replace(WORK.prices[0], decades_per_digit=200.0)
    (row,) = digit_prices(dataclasses.replace(WORK, prices=(price,))).rows
    assert row[-1] == "over 1000 x"


def test_settings_that_failed_have_no_time_and_spoil_no_figure():
    failed = dataclasses.replace(WORK.points[0], bound=None, error=None, seconds=0.0, on_front=False)
    drawing = draw(dataclasses.replace(WORK, points=(*WORK.points, failed)))
    drawing.draw_without_rendering()  # a picture that collapsed warns, and a warning is an error
    (axes,) = drawing.axes
    assert axes.get_window_extent().width > drawing.bbox.width / 2


def test_a_chart_holds_the_mark_of_where_one_method_is_faster():
    """One that lay outside took the room of the axes."""
    alone = tuple(point for point in WORK.points if point.bound)[:1]
    drawing = draw(dataclasses.replace(WORK, points=alone, crossover=1e3 * alone[0].bound))
    low, high = drawing.axes[0].get_ylim()
    assert low < alone[0].bound < 1e3 * alone[0].bound < high
    drawing.get_layout_engine().execute(drawing)
    assert min(drawing.axes[0].get_position().size) > 0.5
