"""What holds for every test: no width of a terminal, no random examples, no limit of the depth in tests of numbers, the
marker `first(n)`, and methods that installed packages bring.
"""

from __future__ import annotations

import math
from collections import Counter
from importlib.metadata import EntryPoint
from pathlib import Path

import pytest
from hypothesis import settings

from cases.declare import methods
from contact.answer import small_strains

# Tests of numbers solve the linear equations at any depth, as if each of their scenes said `beyond_small_strains`.
ANY_DEPTH = {"bem", "mdr", "fem_reference", "conformance", "verification", "planted", "benchmarks", "cases"}

# Tests in which the fabricated method is known under the name "fake".
WITH_FAKE_METHOD = {"cases", "reports", "planted", "benchmarks"}

settings.register_profile("repeatable", derandomize=True, deadline=None)  # the same examples on every machine
settings.load_profile("repeatable")


@pytest.fixture(autouse=True)
def _no_terminal_width(monkeypatch):
    """Parallel test runners set COLUMNS; the tables of the command line must not depend on it."""
    monkeypatch.delenv("COLUMNS", raising=False)


def _folder(path):
    """The folder of tests that a file is in."""
    return path.relative_to(Path(__file__).parent).parts[0]


@pytest.fixture(autouse=True)
def _fake_method(request, monkeypatch):
    """The fabricated method under the name "fake"."""
    if _folder(request.path) in WITH_FAKE_METHOD:
        entry = methods.TableEntry(module="tests.cases.fake_method", attribute="FakeHertz")
        monkeypatch.setitem(methods.BUILT_IN, "fake", entry)


@pytest.fixture
def install(monkeypatch):
    """Lets packages be installed that bring these methods and no others, each by a name as "module:Class"."""

    def install(found):
        entries = [EntryPoint(name=n, value=value, group=methods.ENTRY_POINT_GROUP) for n, value in found.items()]
        monkeypatch.setattr(methods, "entry_points", lambda group: entries)

    return install


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
    if _folder(item.path) in ANY_DEPTH:
        small_strains.REFUSED_SHARE = math.inf
    result = yield
    small_strains.REFUSED_SHARE = limit
    return result
