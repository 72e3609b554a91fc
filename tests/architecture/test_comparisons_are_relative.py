"""pytest.approx grants 1e-12 beside a relative tolerance unless told not to, and a depth of 5e-9 m is free to err."""

from __future__ import annotations

import ast
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]


def with_hidden_tolerance(source):
    """Lines that call pytest.approx without an absolute tolerance of their own."""
    calls = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Call)]
    approximate = [call for call in calls if ast.unparse(call.func).split(".")[-1] == "approx"]
    return [call.lineno for call in approximate if "abs" not in [word.arg for word in call.keywords]]


def test_every_comparison_states_its_absolute_tolerance():
    found = {path.name: with_hidden_tolerance(path.read_text()) for path in TESTS.rglob("*.py")}
    assert {name: lines for name, lines in found.items() if lines} == {}


def test_a_hidden_tolerance_is_seen():
    assert with_hidden_tolerance("x == pytest.approx(5e-9, rel=1e-9)") == [1]
    assert with_hidden_tolerance("x == pytest.approx(5e-9, rel=1e-9, abs=0.0)") == []
