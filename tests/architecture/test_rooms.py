"""No import circle, and a docstring in every module."""

from __future__ import annotations

import ast
import graphlib
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("contact", "bem", "mdr", "fem_reference", "cases", "reports")
FILES = {
    ".".join(file.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"): file
    for package in PACKAGES
    for file in (ROOT / package).rglob("*.py")
}


@cache
def read(module):
    """What a module says of itself and what it imports, read once and without keeping its syntax."""
    tree = ast.parse(FILES[module].read_text(encoding="utf-8"))
    return ast.get_docstring(tree), set(imports_of(tree)) - {module}


def loaded(node):
    """Statements that run when a source is loaded: none of a function's."""
    for inner in ast.iter_child_nodes(node):
        if not isinstance(inner, ast.FunctionDef | ast.expr):
            yield inner
            yield from loaded(inner)


def imports_of(tree, known=FILES):
    """Modules of ours that a source imports when it is loaded, those for type checkers included."""
    for node in loaded(tree):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            inner = [f"{node.module}.{alias.name}" for alias in node.names]
            names = [name for name in inner if name in known] or [node.module or ""]
        else:
            continue
        yield from (name for name in names if name in known)


def imports():
    """What each module imports, drawn up when a test asks: every process of the test runner loads this file."""
    return {name: read(name)[1] for name in FILES}


def test_no_import_circle():
    assert list(graphlib.TopologicalSorter(imports()).static_order())


def test_a_circle_and_a_type_checkers_import_are_seen():
    source = "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from mdr.method import Mdr\n"
    assert set(imports_of(ast.parse(source))) == {"mdr.method"}
    with pytest.raises(graphlib.CycleError):
        list(graphlib.TopologicalSorter({**imports(), "contact.scene.layer": {"mdr.method"}}).static_order())
