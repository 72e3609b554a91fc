"""Foreign libraries stop at their border, and importing one method loads no other."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("contact", "bem", "mdr", "fem_reference", "cases", "reports")
BORDERS = {
    "gmsh": "fem_reference/mesh.py",
    "h5py": "contact/files/storage.py",
    "pyfftw": "bem/grid/transforms.py",
    "skfem": "fem_reference/",
    "meshio": "fem_reference/",
    "matplotlib": "reports/",
    "jinja2": "reports/",
    "rich": "reports/",
}


def imported_names(file):
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name.split(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            yield (node.module or "").split(".")[0]


def test_foreign_libraries_stay_behind_their_border():
    trespassers = [
        f"{file.relative_to(ROOT)}: {name}"
        for package in PACKAGES
        for file in (ROOT / package).rglob("*.py")
        for name in imported_names(file)
        if name in BORDERS and not file.relative_to(ROOT).as_posix().startswith(BORDERS[name])
        # An answer imports matplotlib when it is asked for its picture.
        if (file.name, name) != ("solution.py", "matplotlib")
    ]
    assert trespassers == []


FORBIDDEN = {
    "contact": {"scipy", "h5py", "bem", "mdr", "fem_reference", "cases", "reports", *BORDERS},
    "bem": {"mdr", "fem_reference", "cases", "reports", "pyfftw", "skfem", "gmsh", "matplotlib"},
    "mdr": {"fem_reference", "cases", "reports", "pyfftw", "skfem", "gmsh", "matplotlib"},
    "fem_reference": {"bem", "mdr", "cases", "reports", "pyfftw", "matplotlib"},
    "cases": {"reports", "pyfftw", "skfem", "gmsh", "matplotlib"},
}


@pytest.mark.first(2)
@pytest.mark.parametrize("package", FORBIDDEN)
def test_importing_a_package_loads_only_what_it_needs(package):
    code = f"import sys, {package}; print(' '.join(sorted({{m.split('.')[0] for m in sys.modules}})))"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert set(done.stdout.split()) & FORBIDDEN[package] == set()
