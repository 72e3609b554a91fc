"""`Record`: a frozen, keyword-only dataclass of pydantic whose errors give value, place and remedy."""

from __future__ import annotations

import dataclasses
import functools
import inspect
import re
from abc import ABCMeta
from collections.abc import Iterable, Mapping, Sequence
from typing import (
    TYPE_CHECKING,
    Annotated,
    Any,
    ClassVar,
    Self,
    TypeVar,
    Union,
    cast,
    dataclass_transform,
    get_args,
    get_type_hints,
)

import numpy as np
import pydantic
import pydantic.dataclasses
from pydantic import Discriminator, InstanceOf, Tag, TypeAdapter, model_validator
from pydantic.json_schema import SkipJsonSchema
from pydantic_core import ArgsKwargs

from contact.records.errors import OF_PARTS, SHOWN, InvalidInput, printable, shown
from contact.records.units import Unit

# Validators are built with the first record of a class: scenes use few of the classes.
_CONFIG = pydantic.ConfigDict(arbitrary_types_allowed=True, extra="forbid", strict=True, defer_build=True)
# `Record` itself makes records frozen: methods generated per class would take a tenth of the time of `import contact`.
_OPTIONS: Any = {"kw_only": True, "eq": False, "repr": False, "config": _CONFIG}
# Usual other names of fields, for error messages.
_SYNONYMS = {
    "base": "support",
    "substrate": "support",
    "h": "thickness",
    "E": "youngs_modulus",
    "nu": "poissons_ratio",
    "mu": "coefficient",
    "gamma": "work_of_adhesion",
}
# Largest number of problems in one error; half as many omit problems of an ordinary scene, twice fill a screen.
_MOST_LINES = 8
# Prefix of a union's members in the paths of pydantic's errors; paths are shown without them.
_TAG = "kind:"
# Type of pydantic's error for an unknown field name.
_UNKNOWN = "unexpected_keyword_argument"


@dataclass_transform(frozen_default=True, kw_only_default=True, field_specifiers=(dataclasses.field, pydantic.Field))
class _RecordType(ABCMeta):
    """Type of all records: dataclasses of pydantic; constructors raise `InvalidInput`, and `help` is short."""

    if not TYPE_CHECKING:  # type checkers read the fields

        def __init__(cls, *args: Any, **kwargs: Any) -> None:
            super().__init__(*args, **kwargs)
            if inspect.get_annotations(cls):  # classes without new fields need no dataclass, which saves time
                pydantic.dataclasses.dataclass(cls, **_OPTIONS)

        def __call__(cls, *args: Any, **kwargs: Any) -> Any:
            try:
                return super().__call__(*args, **kwargs)
            except pydantic.ValidationError as error:
                raise InvalidInput(describe(error, cls, cls.__name__)) from None

        @property
        def __signature__(cls) -> inspect.Signature:
            return inspect.Signature([_parameter(field) for field in dataclasses.fields(cls)])

        @__signature__.setter
        def __signature__(cls, of_pydantic: object) -> None:
            """Ignore the signature of pydantic, which lists validators."""


def _parameter(field: dataclasses.Field[Any]) -> inspect.Parameter:
    """Parameter of the constructor for a field, with its plain type."""
    return inspect.Parameter(
        field.name,
        inspect.Parameter.KEYWORD_ONLY if field.kw_only else inspect.Parameter.POSITIONAL_OR_KEYWORD,
        default=inspect.Parameter.empty if field.default is dataclasses.MISSING else field.default,
        annotation=re.sub(r"Annotated\[([^,]+), .*", r"\1", str(field.type)),
    )


class Record(metaclass=_RecordType):
    """Base of all records: frozen, keyword-only dataclasses; equality and hash are those of the content.

    Raises:
        InvalidInput: A field is wrong at construction; one line per offending field.
    """

    NAMED: ClassVar[bool] = False
    """Whether the table of the record in files has the entry `kind`."""
    SHORTHANDS: ClassVar[Mapping[str, Any]] = {}
    """Entries of files that replace fields, with their JSON schemas."""
    REPLACED: ClassVar[Mapping[str, str]] = {}
    """Fields that files may omit, with the shorthand that replaces them; "" for another part of the scene."""

    if not TYPE_CHECKING:  # type checkers know that records are frozen

        def __setattr__(self, name: str, value: object) -> None:
            raise dataclasses.FrozenInstanceError(f"cannot assign to field {name!r}")

        def __delattr__(self, name: str) -> None:
            raise dataclasses.FrozenInstanceError(f"cannot delete field {name!r}")

    def __repr__(self) -> str:
        fields = (f"{field.name}={getattr(self, field.name)!r}" for field in dataclasses.fields(self))
        return f"{type(self).__qualname__}({', '.join(fields)})"

    def _content(self) -> tuple[Any, ...]:
        """Class and field values in a hashable form, for equality and hash."""
        values = [getattr(self, field.name) for field in dataclasses.fields(self)]
        return type(self), *[value.tobytes() if isinstance(value, np.ndarray) else value for value in values]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Record) and self._content() == other._content()

    def __hash__(self) -> int:
        return hash(self._content())

    def replace(self, **changes: Any) -> Self:
        """A copy with some fields changed, validated like a new one."""
        return dataclasses.replace(self, **changes)

    @classmethod
    def kind(cls) -> str:
        """Name of the record in files: TruncatedCone is "truncated_cone"."""
        return re.sub(r"(?<!^)(?=[A-Z])", "_", cls.__name__).lower()

    @model_validator(mode="before")
    @classmethod
    def _without_kind(cls, given: Any) -> Any:
        """The fields of a table without its entry `kind`."""
        if isinstance(given, Mapping) and given.get("kind") == cls.kind():
            return {name: value for name, value in given.items() if name != "kind"}
        return given

    @classmethod
    def __get_pydantic_json_schema__(cls, core: Any, handler: Any) -> dict[str, Any]:
        """JSON schema of pydantic, with `kind`, shorthands and the line of the docstring per field."""
        schema: dict[str, Any] = handler.resolve_ref_schema(handler(core))
        text = inspect.cleandoc(cls.__doc__ or "")
        lines = dict(re.findall(r"^ *(\w+): (.*)", text, re.MULTILINE))
        for name, field in schema["properties"].items():
            field["description"] = lines.get(name, "")
        required = [name for name in schema.get("required", ()) if name not in cls.REPLACED]
        named = {"kind": {"const": cls.kind()}} if cls.NAMED else {}
        either = [
            {"oneOf": [{"required": [name]}, {"required": [other]}]} for name, other in cls.REPLACED.items() if other
        ]
        return schema | {
            "description": text.partition("\n")[0],
            "properties": named | schema["properties"] | dict(cls.SHORTHANDS),
            "required": [*named, *required],
            **({"allOf": either} if either else {}),
        }


R = TypeVar("R", bound=Record)


class OneOf:
    """Annotation of a field: an instance of its class, or a table whose entry `kind` names one of these records."""

    def __init__(self, *kinds: type[Record], plain: type[Record] | None = None) -> None:
        """Records by their `kind`; a table without this entry is of the class ``plain``."""
        self.kinds, self.plain = kinds, plain
        self.names = {cls.kind(): cls for cls in kinds}

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        """Schema of the union of all kinds, chosen by their names."""
        members = [Annotated[cls, Tag(f"{_TAG}{cls.kind()}")] for cls in self.kinds]
        instance = Annotated[SkipJsonSchema[InstanceOf[source]], Tag(f"{_TAG}instance")]
        return handler.generate_schema(Annotated[Union[*members, instance], Discriminator(self._tag)])

    def _tag(self, value: object) -> str:
        """Tag of the member of the union that validates a value."""
        if not isinstance(value, Mapping):
            return f"{_TAG}instance"
        kind = value.get("kind")
        chosen = self.plain if kind is None else self.names.get(kind) if isinstance(kind, str) else None
        return f"{_TAG}{chosen.kind()}" if chosen else "none of them"


def read(cls: type[R], table: Mapping[str, Any], name: str, context: object = None) -> R:
    """Record from nested tables of a file.

    Raises:
        InvalidInput: One line per problem, with its path in the tables; ``name`` stands for all of them.
    """
    try:
        return cast(R, _adapter(cls).validate_python(table, strict=False, context=context))
    except pydantic.ValidationError as error:
        raise InvalidInput(describe(error, cls, "", top=name)) from None


@functools.cache
def _adapter(cls: type[Record]) -> TypeAdapter[Any]:
    return TypeAdapter(cls)


def unit_of(cls: type[Record], field: str) -> str | None:
    """SI unit of a field of a record; None for a pure number and for a field that is no number."""
    return _units(cls).get(field)


@functools.cache
def _units(cls: type[Record]) -> dict[str, str]:
    """SI units of the fields of a record class, by name; without fields of pure numbers."""
    hints = get_type_hints(cls, include_extras=True)
    return {name: part.name for name, hint in hints.items() for part in _parts(hint) if isinstance(part, Unit)}


def _parts(annotation: Any) -> Iterable[Any]:
    """An annotation and all its nested arguments."""
    yield annotation
    for part in get_args(annotation):
        yield from _parts(part)


def describe(error: pydantic.ValidationError, cls: type[Record], place: str, top: str = "") -> str:
    """One line per problem: path of the field, its value, the requirement and the remedy.

    Args:
        error: Error that pydantic raised.
        cls: Class of the record.
        place: Beginning of every path.
        top: Name of the record in a message that is not about one field; by default the place.
    """
    lines: list[str] = []
    details = error.errors(include_url=False)
    # pydantic reports a misspelt field twice, as unknown and as missing: only the first is printed.
    meant = {(*detail["loc"][:-1], _meant(cls, detail["loc"])) for detail in details if detail["type"] == _UNKNOWN}
    for detail in details:
        steps = [step for step in detail["loc"] if not str(step).startswith(_TAG)]
        if place and steps and isinstance(steps[0], int) and steps[0] < len(_names(cls)):
            steps[0] = _names(cls)[steps[0]]
        path = functools.reduce(_below, steps, place)
        if detail["type"] == _UNKNOWN:
            lines.append(f"{path} = {shown(detail['input'])}: {_no_such(cls, detail['loc'])}")
        elif not (detail["type"].startswith("missing") and detail["loc"] in meant):
            lines += _lines(path or top, dict(detail), in_file=not place, is_whole=not steps)
    more = len(lines) - _MOST_LINES
    return "\n".join([*lines[:_MOST_LINES], f"{place or top}: {more} more problems"] if more > 0 else lines)


def _names(cls: type[Record]) -> list[str]:
    return [field.name for field in dataclasses.fields(cls)]


def _class_at(cls: type[Record], steps: Sequence[str | int]) -> type[Record]:
    """Class of the record that the steps of a path of pydantic lead to."""
    offered: dict[str, type[Record]] = {}
    for step in map(str, steps):
        if step.startswith(_TAG):
            cls = offered.get(step.removeprefix(_TAG), cls)
        elif step in _names(cls):
            parts = list(_parts(get_type_hints(cls, include_extras=True)[step]))
            offered = {kind: record for part in parts if isinstance(part, OneOf) for kind, record in part.names.items()}
            cls = next((part for part in parts if isinstance(part, type) and issubclass(part, Record)), cls)
    return cls


def _meant(cls: type[Record], path: Sequence[str | int]) -> str:
    """Field name closest to an unknown name at the end of a path; empty if none is close."""
    from difflib import get_close_matches  # noqa: PLC0415  # only records with errors need it

    names, written = _names(_class_at(cls, path[:-1])), str(path[-1])
    close = [_SYNONYMS.get(written, ""), *get_close_matches(written, names, n=1)]
    return next((name for name in close if name in names), "")


def _no_such(cls: type[Record], path: Sequence[str | int]) -> str:
    """Remedy for an unknown field name: the closest name, or all names."""
    if meant := _meant(cls, path):
        return f"no such field; write {meant} instead"
    names = ", ".join(_names(_class_at(cls, path[:-1])))
    return f"no such field; remove it or correct its spelling (there are {names})"


def _below(place: str, step: str | int) -> str:
    """Path of an entry of a table or list, as in layer.sublayers[0].thickness."""
    return f"{place}[{step}]" if isinstance(step, int) else f"{place}.{_key(step)}" if place else _key(step)


def _lines(place: str, detail: dict[str, Any], *, in_file: bool, is_whole: bool) -> list[str]:
    """Lines of a message for one error of pydantic: path, value, requirement and remedy."""
    value, kind = detail["input"], detail["type"]
    if kind == "union_tag_invalid":
        known = sorted({*re.findall(rf"{_TAG}(\w+)", detail["ctx"]["expected_tags"])} - {"instance"})
        return [f"{place}.kind = {shown(value.get('kind'))}: must be one of {', '.join(known)}"]
    if kind == OF_PARTS:
        return [line if is_whole and in_file else f"{place}.{line}" for line in detail["ctx"]["lines"]]
    if kind.startswith("missing"):
        return [f"{place} is missing; add it"]
    if kind == "unexpected_positional_argument":
        return [f"{place}: {shown(value)} came without a name; write the fields as name=value"]
    message = detail["msg"].removeprefix("Value error, ")
    if kind == "dataclass_type" or (kind == "is_instance_of" and in_file):
        message = f"must be a table of named values; write [{place}]"
    message = {"tuple_type": "must be a list", "bool_type": "must be true or false"}.get(kind, message)
    whole = (is_whole and in_file) or isinstance(value, ArgsKwargs | Record)
    return [f"{place}: {message}" if whole else f"{place} = {shown(value)}: {message}"]


def _key(name: object) -> str:
    """A key as text for messages."""
    return printable(name[:SHOWN]) if isinstance(name, str) else shown(name)
