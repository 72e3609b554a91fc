import pytest

from reports.figures import figure_files
from tests.cases import conftest as cases_conftest
from tests.reports.drawn_once import write_figure_once

_fake_method = cases_conftest._fake_method


@pytest.fixture(autouse=True)
def _drawn_once(monkeypatch):
    """Pages take pictures of equal figures from earlier tests; `write_figure` itself draws each time."""
    monkeypatch.setattr(figure_files, "write_figure", write_figure_once)


@pytest.fixture
def library(monkeypatch):
    """A library of one fabricated case in place of the real one."""
    from reports.commands import runs
    from tests.cases.fake_case import fake_case

    case = fake_case()

    def set_library(*cases):
        monkeypatch.setattr(runs, "load_cases", lambda: {case.name: case for case in cases})

    set_library(case)
    return set_library
