import pytest

from reports.commands import baselines, runs
from tests.cases.fake_case import fake_case


@pytest.fixture
def library(monkeypatch):
    """A library of one fabricated case in place of the real one, for all commands, and not on GitHub."""
    monkeypatch.delenv("GITHUB_ACTIONS", raising=False)

    def set_library(*cases):
        for module in (runs, baselines):
            monkeypatch.setattr(module, "load_cases", lambda: {case.name: case for case in cases})

    set_library(fake_case())
    return set_library


@pytest.fixture
def without_pages(monkeypatch):
    """Runs write no pages: other tests look at them, and they take most of the time."""
    monkeypatch.setattr(runs, "write_pages", lambda *_, **__: None)
