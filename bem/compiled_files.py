"""Import of compiled files without their packages, for LAPACK, FFTW and special functions.

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
    """The functions of `scipy.linalg.lapack`, as dpotrf and dpotrs, with results identical to SciPy's."""
    return compiled(_NAME, "scipy.linalg.lapack")


@cache
def compiled(name: str, otherwise: str) -> Any:
    """The module of a compiled file alone, or the public module if that fails or is imported already.

    Args:
        name: Name of the compiled file, as "scipy.linalg._flapack".
        otherwise: The public module with the same functions, as "scipy.linalg.lapack".
    """
    return _alone(name) or importlib.import_module(otherwise)


def _alone(name: str) -> ModuleType | None:
    """The module of the compiled file; None if it is imported already or the package has another layout."""
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
        # On some systems its libraries are found only after the set-up of the whole package.
        return None
    return sys.modules.setdefault(name, module)
