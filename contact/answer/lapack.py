"""LAPACK as SciPy compiled it, without the rest of SciPy: a first answer need not wait for packages that it never asks.

`import scipy.linalg` takes 0.15 s of processor time, the compiled file behind `scipy.linalg.lapack` alone 0.003 s.
"""

from __future__ import annotations

import importlib
import importlib.machinery
import importlib.util
import sys
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

_NAME = "scipy.linalg._flapack"


@cache
def lapack() -> Any:
    """The functions of `scipy.linalg.lapack`, as dpotrf and dtrtrs; the same code as SciPy's own, digit for digit."""
    return _alone() or importlib.import_module("scipy.linalg.lapack")


def is_loaded() -> bool:
    """Whether SciPy's LAPACK, and so its BLAS, is in this process."""
    return _NAME in sys.modules


def _alone() -> ModuleType | None:
    """SciPy's compiled file; None where SciPy is loaded already, or where it is arranged in another way."""
    package = importlib.util.find_spec("scipy")
    if is_loaded() or package is None or not package.submodule_search_locations:
        return None
    folder = Path(package.submodule_search_locations[0]) / "linalg"
    found = importlib.machinery.PathFinder.find_spec(_NAME, [str(folder)])
    if found is None or found.loader is None:
        return None
    try:
        module = importlib.util.module_from_spec(found)
        found.loader.exec_module(module)
    except ImportError:
        # Some systems find the libraries behind it only after SciPy's own set-up.
        return None
    return sys.modules.setdefault(_NAME, module)
