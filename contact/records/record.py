"""`record`: a frozen, keyword-only, validated dataclass whose errors say value, place and remedy."""

from __future__ import annotations

import dataclasses
import functools
import inspect
from typing import Any, Self, TypeVar, dataclass_transform

import numpy as np
import pydantic
import pydantic.dataclasses
from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from contact.records.errors import InvalidInput, printable

# Validators are built when the first record of a class is made: scenes use few of the classes.
_CONFIG = pydantic.ConfigDict(arbitrary_types_allowed=True, extra="forbid", strict=True, defer_build=True)
# An error shows so many characters of an offending value: about one line of a terminal.
_SHOWN = 80
# Fields by other names that books and users give them.
_MEANT = {
    "base": "support",
    "substrate": "support",
    "h": "thickness",
    "E": "youngs_modulus",
    "nu": "poissons_ratio",
    "mu": "coefficient",
    "gamma": "work_of_adhesion",
}
# One error tells so many problems: as many as a user mends before trying again.
_MOST_LINES = 8


class Record:
    """Base of all records: equality, hash and change by copying, by content (arrays included)."""

    def _content(self) -> tuple[Any, ...]:
        # A class is hashable, whatever its instances are.
        names = _names(type(self))  # type: ignore[arg-type]
        values = [getattr(self, name) for name in names]
        return type(self), *[value.tobytes() if isinstance(value, np.ndarray) else value for value in values]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Record) and self._content() == other._content()

    def __hash__(self) -> int:
        return hash(self._content())

    def replace(self, **changes: Any) -> Self:
        """A copy with some fields changed, validated like a new one."""
        return dataclasses.replace(self, **changes)  # type: ignore[type-var]  # see _content


@functools.cache
def _names(cls: type[Record]) -> tuple[str, ...]:
    """Of a record's fields."""
    # Every subclass is made a dataclass by `record`.
    return tuple(field.name for field in dataclasses.fields(cls))  # type: ignore[arg-type]


R = TypeVar("R", bound=Record)


@dataclass_transform(frozen_default=True, kw_only_default=True, field_specifiers=(dataclasses.field, pydantic.Field))
def record(cls: type[R]) -> type[R]:
    """Make a `Record` subclass a frozen, keyword-only dataclass that validates its fields.

    Raises:
        InvalidInput: At construction, one line for each offending field.
    """
    made: Any = pydantic.dataclasses.dataclass(cls, frozen=True, kw_only=True, eq=False, config=_CONFIG)
    unchecked = made.__init__

    @functools.wraps(unchecked)
    def checked(self: R, *args: Any, **kwargs: Any) -> None:
        """Construct; what pydantic complains of becomes one `InvalidInput`."""
        complete(made)
        try:
            unchecked(self, *args, **kwargs)
        except pydantic.ValidationError as error:
            raise InvalidInput(describe(error, made)) from None

    made.__init__, made.__signature__ = checked, _Signature()
    # pydantic returns the class that it was given.
    return made  # type: ignore[no-any-return]


def complete(cls: type[Record]) -> None:
    """Build the validator of a record's class if that has not happened yet.

    pydantic replaces the class's constructor and signature then, and both are put back.
    """
    if not cls.__pydantic_complete__:  # type: ignore[attr-defined]  # every record is a pydantic dataclass
        constructor = cls.__init__
        pydantic.dataclasses.rebuild_dataclass(cls)  # type: ignore[arg-type]  # as above
        cls.__init__ = constructor  # type: ignore[method-assign]  # as above
        cls.__signature__ = _Signature()  # type: ignore[attr-defined]  # as above


class _Signature:
    """What `help`, editors and notebooks show of a record's constructor: its fields, by name, without validators."""

    def __get__(self, instance: object, owner: type[Any]) -> inspect.Signature:
        return inspect.Signature([_parameter(field) for field in dataclasses.fields(owner)])


def _parameter(field: dataclasses.Field[Any]) -> inspect.Parameter:
    given = field.default
    default, by_name = (given.default, given.kw_only) if isinstance(given, FieldInfo) else (given, True)
    kind = inspect.Parameter.POSITIONAL_OR_KEYWORD if by_name is False else inspect.Parameter.KEYWORD_ONLY
    # As written, and without what checks it.
    written, checked = str(field.type), "Annotated["
    none = default in (dataclasses.MISSING, PydanticUndefined)
    return inspect.Parameter(
        field.name,
        kind,
        default=inspect.Parameter.empty if none else default,
        annotation=written.removeprefix(checked).partition(", ")[0] if written.startswith(checked) else written,
    )


def describe(error: pydantic.ValidationError, cls: type[Any]) -> str:
    """One line for each problem: path of the field, its value, what is required, how to mend it."""
    lines = [_line(dict(detail), cls) for detail in error.errors()[:_MOST_LINES]]
    more = error.error_count() - len(lines)
    return "\n".join([*lines, f"{cls.__name__}: {more} more problems"] if more else lines)


def _line(detail: dict[str, Any], cls: type[Any]) -> str:
    place, kind = _place(detail["loc"], cls), detail["type"]
    if kind.startswith("missing"):
        return f"{place} is missing; add it"
    if kind == "unexpected_keyword_argument":
        meant = _nearest(str(detail["loc"][-1]), [field.name for field in dataclasses.fields(cls)])
        remedy = f"write {meant} instead" if meant else "remove it or correct its spelling"
        return f"{place} = {shown(detail['input'])}: no such field; {remedy}"
    if kind == "unexpected_positional_argument":
        return f"{cls.__name__}: {shown(detail['input'])} came without a name; write the fields as name=value"
    message = detail["msg"].removeprefix("Value error, ")
    return f"{place} = {shown(detail['input'])}: {message}" if detail["loc"] else f"{place}: {message}"


def _nearest(written: str, names: list[str]) -> str | None:
    """The field that was meant by a name that is none; None if no field is close to it."""
    # Only a scene with a mistake pays for this import.
    from difflib import get_close_matches  # noqa: PLC0415

    meant = [name for name in (_MEANT.get(written), *get_close_matches(written, names, n=1)) if name in names]
    return meant[0] if meant else None


def _place(path: tuple[str | int, ...], cls: type[Any]) -> str:
    """The path of a field; an argument that came by position is called by its field's name."""
    names = [field.name for field in dataclasses.fields(cls)]
    steps = [
        names[s] if isinstance(s, int) and s < len(names) and i == 0 else printable(str(s)[:_SHOWN])
        for i, s in enumerate(path)
    ]
    return ".".join([cls.__name__, *steps])


def shown(value: object) -> str:
    """The value as an error message shows it: at most 80 characters, however large it is."""
    head = value[: _SHOWN + 1] if isinstance(value, str | bytes) else value
    try:
        text = np.array2string(head, threshold=8) if isinstance(head, np.ndarray) else repr(head)
    except (ValueError, RecursionError):
        # An integer has more digits than Python prints, or tables are nested too deeply.
        text = f"a huge {type(value).__name__}"
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}..."
