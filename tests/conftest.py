"""What holds for every test: no width of a terminal, no random examples, no limit of the depth in tests of numbers, and
the marker `first(n)`."""

from __future__ import annotations

import math
from collections import Counter
from pathlib import Path

import pytest
from hypothesis import settings

from contact.answer import small_strains

# Tests of numbers solve the linear equations at any depth, as if each of their scenes said `beyond_small_strains`.
ANY_DEPTH = {"bem", "mdr", "fem_reference", "conformance", "verification", "planted", "benchmarks", "cases"}

settings.register_profile("repeatable", derandomize=True, deadline=None)  # the same examples on every machine
settings.load_profile("repeatable")


@pytest.fixture(autouse=True)
def _no_terminal_width(monkeypatch):
    """Parallel test runners set COLUMNS; the tables of the command line must not depend on it."""
    monkeypatch.delenv("COLUMNS", raising=False)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """Marks the parameters of a test `first(n)` after the first n as slow."""
    seen: Counter[str] = Counter()
    for item in items:
        first = item.get_closest_marker("first")
        if first and not item.get_closest_marker("slow"):
            test = item.nodeid.partition("[")[0]
            seen[test] += 1
            if seen[test] > first.args[0]:
                item.add_marker("slow")


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item):
    """Lifts the limit of the depth for tests of numbers, their fixtures included."""
    limit = small_strains.REFUSED_SHARE
    if item.path.relative_to(Path(__file__).parent).parts[0] in ANY_DEPTH:
        small_strains.REFUSED_SHARE = math.inf
    result = yield
    small_strains.REFUSED_SHARE = limit
    return result
