"""`record`: a frozen, keyword-only dataclass of pydantic whose errors say value, place and remedy."""

from __future__ import annotations

import dataclasses
import functools
import inspect
import re
from collections.abc import Iterable, Mapping
from typing import Annotated, Any, ClassVar, Self, TypeVar, Union, dataclass_transform, get_args, get_type_hints

import numpy as np
import pydantic
import pydantic.dataclasses
from pydantic import Discriminator, InstanceOf, Tag, TypeAdapter, model_validator
from pydantic.fields import FieldInfo
from pydantic.json_schema import SkipJsonSchema
from pydantic_core import ArgsKwargs, PydanticUndefined

from contact.records.errors import OF_PARTS, SHOWN, InvalidInput, printable, refused, shown
from contact.records.units import Unit

# Validators are built when the first record of a class is made: scenes use few of the classes.
_CONFIG = pydantic.ConfigDict(arbitrary_types_allowed=True, extra="forbid", strict=True, defer_build=True)
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
# How pydantic calls the members of a union in the path of an error; users do not see it.
_TAG = "kind:"


@pydantic.dataclasses.dataclass(frozen=True, kw_only=True, eq=False, config=_CONFIG)
class Record:
    """Base of all records: equality, hash and change by copying, by content (arrays included)."""

    NAMED: ClassVar[bool] = False
    """Whether files tell by the entry `kind` which record is meant."""
    WRITTEN: ClassVar[Mapping[str, Any]] = {}
    """Of the JSON Schema: properties that files may have instead of fields, and which fields those may replace."""

    def _content(self) -> tuple[Any, ...]:
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
        """The name by which files call a record: TruncatedCone is "truncated_cone"."""
        return re.sub(r"(?<!^)(?=[A-Z])", "_", cls.__name__).lower()

    @model_validator(mode="before")
    @classmethod
    def _known_fields(cls, given: Any) -> Any:
        """Fields without the entry `kind` that chose the class, or one message on all that are none."""
        fields = given.kwargs if isinstance(given, ArgsKwargs) else given
        if not isinstance(fields, Mapping):
            return given
        if not isinstance(given, ArgsKwargs) and fields.get("kind") == cls.kind():
            given = fields = {name: value for name, value in fields.items() if name != "kind"}
        known = [field.name for field in dataclasses.fields(cls)]
        unknown = [name for name in fields or () if name not in known]
        if unknown:
            raise refused(*(f"{_key(name)} = {shown(fields[name])}: {_no_such(name, known)}" for name in unknown))
        return given

    @classmethod
    def __get_pydantic_json_schema__(cls, core: Any, handler: Any) -> dict[str, Any]:
        """Its fields, each with its line of the docstring, and `kind`."""
        schema: dict[str, Any] = handler.resolve_ref_schema(handler(core))
        text = inspect.cleandoc(cls.__doc__ or "")
        schema["description"] = text.partition("\n")[0]
        for name, field in schema.get("properties", {}).items():
            lines = [line for line in text.splitlines() if line.strip().startswith(f"{name}: ")]
            field["description"] = lines[0].partition(": ")[2] if lines else ""
        further = dict(cls.WRITTEN)
        own = {"kind": {"const": cls.kind()}} if cls.NAMED else {}
        schema["properties"] = own | schema.get("properties", {}) | further.pop("properties", {})
        replaced = further.pop("replaced", ())
        required = [name for name in schema.get("required", ()) if name not in replaced]
        return schema | further | {"required": [*(["kind"] if cls.NAMED else []), *required]}


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
            names = [field.name for field in dataclasses.fields(made)]
            raise InvalidInput(describe(error, made.__name__, names)) from None

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


class OneOf:
    """Annotation of a field: an instance of its class, or a table whose entry `kind` names one of these records."""

    def __init__(self, *kinds: type[Record], plain: type[Record] | None = None, **further: type[Record]) -> None:
        """`plain` is meant where the table has no kind; `further` are other names of kinds."""
        self.kinds, self.plain = kinds, plain
        self.names = {cls.kind(): cls for cls in kinds} | further

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        """A union of the kinds, by their names."""
        members = [Annotated[cls, Tag(f"{_TAG}{cls.kind()}")] for cls in self.kinds]
        instance = Annotated[SkipJsonSchema[InstanceOf[source]], Tag(f"{_TAG}instance")]
        return handler.generate_schema(Annotated[Union[*members, instance], Discriminator(self._tag)])

    def _tag(self, value: object) -> str:
        if not isinstance(value, Mapping):
            return f"{_TAG}instance"
        kind = value.get("kind")
        if kind is None and self.plain is not None:
            return f"{_TAG}{self.plain.kind()}"
        return f"{_TAG}{self.names[kind].kind()}" if isinstance(kind, str) and kind in self.names else "none of them"


def read(cls: type[R], table: Mapping[str, Any], name: str, context: object = None) -> R:
    """A record from nested tables of a file.

    Raises:
        InvalidInput: One line for each problem, with its place in the tables; the record itself is called by the name.
    """
    try:
        return TypeAdapter(cls).validate_python(table, strict=False, context=context)
    except pydantic.ValidationError as error:
        raise InvalidInput(describe(error, "", top=name)) from None


def unit_of(cls: type[Record], field: str) -> str | None:
    """SI unit of a field of a record; None where it is a pure number or no number."""
    return _units(cls).get(field)  # type: ignore[arg-type]  # a class is hashable, whatever its instances are


@functools.cache
def _units(cls: type[Record]) -> dict[str, str]:
    parts = {name: _parts(hint) for name, hint in get_type_hints(cls, include_extras=True).items()}
    return {name: part.name for name, found in parts.items() for part in found if isinstance(part, Unit)}


def _parts(annotation: Any) -> Iterable[Any]:
    yield annotation
    for part in get_args(annotation):
        yield from _parts(part)


def describe(error: pydantic.ValidationError, place: str, names: list[str] | None = None, top: str = "") -> str:
    """One line for each problem: path of the field below a place, its value, what is required, how to mend it.

    Args:
        error: Of pydantic.
        place: What every path begins with.
        names: Of fields that may be given by position.
        top: Name of the whole in a message that is not about one field; by default the place.
    """
    lines: list[str] = []
    for detail in error.errors():
        path = [step for step in detail["loc"] if not str(step).startswith(_TAG)]
        if names and path and isinstance(path[0], int) and path[0] < len(names):
            path[0] = names[path[0]]
        lines += _lines(_path(place, path) or top, dict(detail), in_file=not place, is_top=not place and not path)
    more = len(lines) - _MOST_LINES
    return "\n".join([*lines[:_MOST_LINES], f"{place or top}: {more} more problems"] if more > 0 else lines)


def _path(place: str, steps: Iterable[str | int]) -> str:
    """As in layer.sublayers[0].thickness."""
    text = place
    for step in steps:
        text += f"[{step}]" if isinstance(step, int) else f".{_key(step)}" if text else _key(step)
    return text


def _lines(place: str, detail: dict[str, Any], *, in_file: bool, is_top: bool) -> list[str]:
    value, kind = detail["input"], detail["type"]
    if kind == "union_tag_invalid":
        names = re.findall(rf"{_TAG}(\w+)", detail["ctx"]["expected_tags"])
        known = ", ".join(sorted(name for name in names if name != "instance"))
        return [f"{place}.kind = {shown(value.get('kind'))}: must be one of {known}"]
    if kind == OF_PARTS:
        return [line if is_top else f"{place}.{line}" for line in detail["ctx"]["lines"]]
    if kind.startswith("missing"):
        return [f"{place} is missing; add it"]
    if kind == "unexpected_positional_argument":
        return [f"{place}: {shown(value)} came without a name; write the fields as name=value"]
    message = detail["msg"].removeprefix("Value error, ")
    if kind == "dataclass_type" or (kind == "is_instance_of" and in_file):
        message = f"must be a table of named values; write [{place}]"
    if kind == "tuple_type":
        message = "must be a list"
    is_whole = is_top or isinstance(value, ArgsKwargs | Record)
    return [f"{place}: {message}" if is_whole else f"{place} = {shown(value)}: {message}"]


def _no_such(written: object, names: list[str]) -> str:
    """The remedy for a name that no field has: the one that was meant, if one is close to it."""
    # Only a scene with a mistake pays for this import.
    from difflib import get_close_matches  # noqa: PLC0415

    close = get_close_matches(written, names, n=1) if isinstance(written, str) else []
    meant = [name for name in (_MEANT.get(str(written)), *close) if name in names]
    return f"no such field; {f'write {meant[0]} instead' if meant else 'remove it or correct its spelling'}"


def _key(name: object) -> str:
    """A key as messages show it."""
    return printable(name[:SHOWN]) if isinstance(name, str) else shown(name)
