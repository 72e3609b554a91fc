import pytest

from tests.cases import conftest as cases_conftest

_fake_method = cases_conftest._fake_method


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
