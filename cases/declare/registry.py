"""All cases of the library: one module each, found by walking the folder."""

import importlib
import pkgutil
from collections.abc import Iterable

from cases import library
from cases.case import SUITES, Case
from contact import InvalidInput


def load_cases() -> dict[str, Case]:
    """Return every case of the library by name, in alphabetic order, with the methods of this project.

    Raises:
        InvalidInput: If a module has no ``CASE``, or two cases have one name.
    """
    names = (info.name for info in pkgutil.walk_packages(library.__path__, f"{library.__name__}.") if not info.ispkg)
    modules = sorted((name for name in names if "._" not in name), key=_last)
    return by_name(_case_of(name) for name in modules)


def by_name(cases: Iterable[Case]) -> dict[str, Case]:
    """Return cases by name.

    Raises:
        InvalidInput: If two have one name.
    """
    named: dict[str, Case] = {}
    for case in cases:
        if case.name in named:
            raise InvalidInput(f"two cases are called {case.name!r}; rename one")
        named[case.name] = case
    return named


def select(cases: dict[str, Case], *, names: Iterable[str] = (), suite: str = "") -> tuple[Case, ...]:
    """Return the cases of a suite (all without one) as it runs them; of named cases those alone.

    Raises:
        InvalidInput: For an unknown name or suite.
    """
    if suite and suite not in SUITES:
        raise InvalidInput(f"no suite {suite!r}; there are {', '.join(SUITES)}")
    wanted = tuple(names) or tuple(cases)
    for name in wanted:
        if name not in cases:
            raise InvalidInput(f"no case {name!r}; there are {', '.join(cases)}")
    return tuple(cases[name].in_suite(suite) for name in wanted if not suite or suite in cases[name].suites)


def _last(module: str) -> str:
    return module.rpartition(".")[2]


def _case_of(module: str) -> Case:
    """The `CASE` of a module of the library."""
    case = getattr(importlib.import_module(module), "CASE", None)
    if not isinstance(case, Case):
        raise InvalidInput(f"{module.replace('.', '/')}.py defines no CASE; a module of the library is one case")
    return case
