"""The method table: built-in methods by name, and those that installed packages register.

A package registers its method under the entry-point group ``contact_verification.methods``; the entry point is the
class (a frozen record of settings that follows ``contact.Method``).  Nothing is imported before it is used.
"""

import importlib
import re
import sys
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import Any, Final

from cases.declare.shared import used_by
from contact import InvalidInput, Method
from contact.records.errors import shown
from contact.records.extras import missing_extra

ENTRY_POINT_GROUP = "contact_verification.methods"
HOW_TO_ADD = f"a package adds one by an entry point of the group {ENTRY_POINT_GROUP} (examples/hertz_half_space)"

# Permitted names of methods, which occur in names of files, pages, tables and commands.
NAME: Final = re.compile(r"[A-Za-z][A-Za-z0-9_.-]{0,59}")


@dataclass(frozen=True, kw_only=True)
class MethodUse:
    """A method of the table with settings, under the label that claims and reports use."""

    label: str
    method: str = ""
    settings: Mapping[str, Any] = field(default_factory=dict)

    def build(self) -> Method:
        """Return the method, ready to solve."""
        return build(self.method or self.label, self.settings)


@dataclass(frozen=True, kw_only=True)
class TableEntry:
    """Module and name of a built-in method: of its class, or of a function that returns the method."""

    module: str
    attribute: str


BUILT_IN: Mapping[str, TableEntry] = {
    "mdr": TableEntry(module="cases.declare.mdr_by_equation", attribute="mdr"),
    "mdr_table": TableEntry(module="cases.declare.mdr_by_table", attribute="mdr_table"),
    "fem": TableEntry(module="fem_reference", attribute="Fem"),
    "bem": TableEntry(module="bem.method", attribute="Bem"),
    "integral_equation": TableEntry(module="bem.direct_method", attribute="IntegralEquationMethod"),
}


# Outside solvers with an adapter in `cases.referees`, as if their packages had registered them.
REFEREES: Mapping[str, EntryPoint] = {
    name: EntryPoint(name, f"cases.referees.{place}", ENTRY_POINT_GROUP)
    for name, place in {
        "calculix": "calculix:CalculiX",
        "contact_mechanics": "grids:ContactMechanics",
        "tamaas": "grids:Tamaas",
    }.items()
}


def registered() -> dict[str, EntryPoint]:
    """Return the methods of installed packages by name, the outside referees first.

    Raises:
        InvalidInput: If two packages, or a package and this project, use one name, or if a name could not name a file.
    """
    methods = dict(REFEREES)
    for entry in _entries(entry_points, tuple(sys.path)):
        check_name(entry.name, entry.value)
        if entry.name in BUILT_IN or entry.name in methods:
            raise InvalidInput(f"two methods are called {entry.name!r}; rename the entry point of {entry.value}")
        methods[entry.name] = entry
    return methods


@cache
def _entries(read: Callable[..., Iterable[EntryPoint]], _path: tuple[str, ...]) -> tuple[EntryPoint, ...]:
    """Entry points of installed packages, cached per search path: reading those of a hundred packages takes 4 ms."""
    return tuple(read(group=ENTRY_POINT_GROUP))


def check_name(name: str, place: str) -> None:
    """Refuse a name of a method that is not valid in file names and pages.

    Raises:
        InvalidInput: Naming the entry point's `place`.
    """
    if not NAME.fullmatch(name):
        raise InvalidInput(
            f"a package calls its method {shown(name)}: a name has at most 60 letters, digits, dots, dashes "
            f"and underscores, a letter first; rename the entry point of {shown(place)}"
        )


def check_known(name: str, labels: Iterable[str] = ()) -> None:
    """Refuse a name that no method has.

    Args:
        name: Name of a method.
        labels: Labels of methods in cases, besides the names of the table.

    Raises:
        InvalidInput: Listing the names that there are.
    """
    names = dict.fromkeys((*method_names(), *labels))
    if name not in names:
        raise InvalidInput(f"no method {name!r}; there are {', '.join(names)}; {HOW_TO_ADD}")


def method_names() -> tuple[str, ...]:
    """Return every name of the table, built-in first."""
    return (*BUILT_IN, *registered())


def build(name: str, settings: Mapping[str, Any]) -> Method:
    """Return the method called ``name`` with ``settings``.

    Raises:
        InvalidInput: If there is none, or if what is registered is no method.
    """
    method = load(name)(**settings)
    if not isinstance(method, Method):
        raise InvalidInput(f"{name!r} has no name, supports, solve and refined; follow contact.Method")
    return method


def shared_inputs(method: Method) -> tuple[str, ...]:
    """Return the names of code and data that a method shares with others, or its own ``shared_inputs``."""
    names = getattr(method, "shared_inputs", None)
    if names is not None:
        return tuple(names)
    on_table = type(getattr(method, "flat_punch", None)).__name__ == "FftTable"
    return used_by("mdr_table" if on_table else method.name)


def location(name: str) -> tuple[str, str]:
    """Return module and class of the method called ``name``.

    Raises:
        InvalidInput: If there is none.
    """
    if name in BUILT_IN:
        return BUILT_IN[name].module, BUILT_IN[name].attribute
    check_known(name)
    entry = registered()[name]
    return entry.module, entry.attr


# The class may be of another package, so that its type is open.
def load(name: str) -> Any:
    """Return the class of the method called ``name``.

    Raises:
        InvalidInput: If there is none, or if it cannot be imported.
    """
    module, attribute = location(name)
    try:
        return getattr(importlib.import_module(module), attribute)
    except Exception as error:
        # A package may raise anything when it is imported.
        if lacking := missing_extra(error):
            raise InvalidInput(f"method {name!r}: {lacking}") from None
        raise InvalidInput(f"method {name!r} cannot be imported from {module}: {error}; install it again") from error
