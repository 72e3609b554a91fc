import pytest

from cases.declare import methods
from cases.declare.methods import TableEntry


@pytest.fixture(autouse=True)
def _fake_method(monkeypatch):
    """The fabricated method under the name "fake"."""
    entry = TableEntry(module="tests.cases.fake_method", attribute="FakeHertz")
    monkeypatch.setitem(methods.BUILT_IN, "fake", entry)
