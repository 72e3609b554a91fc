"""Compiled files without the packages around them: a first answer need not wait for what it never asks.

LAPACK and FFTW are loaded so.  `import scipy.linalg` takes 0.15 s of processor time, the compiled file behind
`scipy.linalg.lapack` alone 0.003 s.
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
    return compiled(_NAME, "scipy.linalg.lapack")


@cache
def compiled(name: str, otherwise: str) -> Any:
    """A compiled file alone; where it is loaded already, or arranged in another way, what its package offers.

    Args:
        name: Name of the compiled file, as "scipy.linalg._flapack".
        otherwise: The public module with the same functions, as "scipy.linalg.lapack".
    """
    return _alone(name) or importlib.import_module(otherwise)


def _alone(name: str) -> ModuleType | None:
    """The compiled file; None where it is loaded already, or where the package is arranged in another way."""
    first, *folders, _ = name.split(".")
    package = importlib.util.find_spec(first)
    if name in sys.modules or package is None or not package.submodule_search_locations:
        return None
    folder = Path(package.submodule_search_locations[0]).joinpath(*folders)
    spec = importlib.machinery.PathFinder.find_spec(name, [str(folder)])
    if spec is None or spec.loader is None:
        return None
    try:
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
    except ImportError:
        # Some systems find the libraries behind it only after the package's own set-up.
        return None
    return sys.modules.setdefault(name, module)
