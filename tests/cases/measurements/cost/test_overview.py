"""Shortest times of many cases side by side, never interpolated."""

from cases.measurements.cost.overview import first_speed_up, methods, shortest, speed_up
from tests.cases.example_run import work_precision

WORK = work_precision()


def test_the_ratio_is_that_of_shortest_times():
    fast, slow = (shortest(WORK, method, 1e-2) for method in ("mdr", "fem"))
    assert speed_up(WORK, "mdr", "fem", 1e-2) == slow.seconds / fast.seconds


def test_no_ratio_where_one_method_did_not_get_there():
    assert speed_up(WORK, "mdr", "fem", 1e-10) is None
    assert speed_up(WORK, "mdr", "nobody", 1e-2) is None


def test_no_ratio_of_first_solutions_that_were_not_measured():
    assert first_speed_up(WORK, "mdr", "fem", 1e-2) is None


def test_methods_without_an_answer_are_not_listed():
    assert set(methods(WORK)) <= {point.method for point in WORK.points if point.bound is not None}
