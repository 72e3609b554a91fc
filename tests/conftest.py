"""What holds for every test: a terminal width of the environment changes nothing."""

from __future__ import annotations

import pytest


@pytest.fixture(autouse=True)
def _no_terminal_width(monkeypatch):
    """Parallel test runners set COLUMNS; the tables of the command line must not depend on it."""
    monkeypatch.delenv("COLUMNS", raising=False)
