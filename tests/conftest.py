"""What holds for every test: no width of a terminal, no random examples."""

from __future__ import annotations

import pytest
from hypothesis import settings

settings.register_profile("repeatable", derandomize=True, deadline=None)  # the same examples on every machine
settings.load_profile("repeatable")


@pytest.fixture(autouse=True)
def _no_terminal_width(monkeypatch):
    """Parallel test runners set COLUMNS; the tables of the command line must not depend on it."""
    monkeypatch.delenv("COLUMNS", raising=False)
