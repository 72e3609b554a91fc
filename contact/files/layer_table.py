"""The table `layer` of a scene file, to a record and back: a plain layer, a stack or a graded layer."""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Mapping, Sequence
from typing import Any, TypeVar

import numpy as np

from contact.files.units import in_si, unit_of
from contact.files.values import vector
from contact.records.errors import InvalidInput, printable
from contact.records.record import Record, shown
from contact.scene.depth_functions import DEPTH_FUNCTIONS, TabulatedDepth
from contact.scene.elastic_layer import ElasticLayer
from contact.scene.graded_layer import GradedLayer
from contact.scene.layer import Layer
from contact.scene.layer_stack import MAX_SUBLAYERS, ElasticBase, LayerStack, Sublayer

R = TypeVar("R", bound=Record)


def kind_of(cls: type[Record]) -> str:
    """The name by which files call a record: TruncatedCone is "truncated_cone"."""
    return re.sub(r"(?<!^)(?=[A-Z])", "_", cls.__name__).lower()


def layer_of(table: Mapping[str, Any]) -> ElasticLayer:
    """The layer; without an entry `kind` it is a plain one.

    Raises:
        InvalidInput: With the path of the offending entry, its value and the remedy.
    """
    if "kind" not in table:
        return _plain_layer(table)
    fields = dict(table)
    kind = fields.pop("kind")
    if isinstance(fields.get("support"), Mapping):
        fields["support"] = build(ElasticBase, "layer.support", fields["support"])
    if kind == kind_of(LayerStack):
        return _stack(fields)
    if kind == kind_of(GradedLayer):
        return _graded(fields)
    raise InvalidInput(f"layer.kind = {shown(kind)}: must be graded_layer or layer_stack; leave it out for one layer")


def layer_mapping(layer: ElasticLayer) -> dict[str, Any]:
    """The inverse of `layer_of`."""
    if not isinstance(layer, Layer):
        return named(layer)
    table = plain(layer)
    if math.isinf(layer.thickness):
        # JSON and TOML share no infinity.
        del table["thickness"], table["support"]
        table["half_space"] = True
    return table


def tagged(kinds: Sequence[type[R]], value: object, place: str) -> R:
    """Build the record that the entry `kind` names."""
    fields = dict(as_mapping(value, place))
    names = {kind_of(cls): cls for cls in kinds}
    kind = fields.pop("kind", None)
    if not isinstance(kind, str) or kind not in names:
        raise InvalidInput(f"{place}.kind = {shown(kind)}: must be one of {', '.join(sorted(names))}")
    return build(names[kind], place, fields)


def build(cls: type[R], place: str, fields: Mapping[str, Any]) -> R:
    """Construct a record; errors name the place in the file instead of the class."""
    for key in fields:
        if not isinstance(key, str):
            raise InvalidInput(f"{place}: the key {shown(key)} is no name")
    wrong: dict[str, str] = {}
    converted = dict(fields)
    for key, value in fields.items():
        try:
            converted[key] = _in_si(cls, key, value, f"{place}.{key}")
        except InvalidInput as error:
            wrong[key] = str(error)
    try:
        made = cls(**converted)
    except InvalidInput as error:
        lines = re.sub(rf"^{cls.__name__}\b", place, str(error), flags=re.MULTILINE).splitlines()
        told = tuple(f"{place}.{key}" for key in wrong)
        raise InvalidInput(
            "\n".join([*wrong.values(), *(line for line in lines if not line.startswith(told))])
        ) from None
    return made


def _in_si(cls: type[Record], field: str, value: object, place: str) -> Any:
    """A field's value with units, ranges and columns turned into numbers in SI."""
    pure = field == "values" and "poissons_ratio" in place
    unit = None if pure else unit_of(cls, field)
    known = value if unit is None else in_si(value, unit, place)
    return vector(known, unit, place)


def named(item: Record) -> dict[str, Any]:
    """A record with its kind."""
    return {"kind": kind_of(type(item)), **plain(item)}


def plain(item: Record) -> dict[str, Any]:
    """A record's fields as numbers, texts, lists and tables; what is None is left out."""
    # All records are dataclasses.
    values = ((f.name, getattr(item, f.name)) for f in dataclasses.fields(item))  # type: ignore[arg-type]
    return {name: _value(value) for name, value in values if value is not None}


def as_mapping(value: object, place: str) -> Mapping[str, Any]:
    """The value, if it is a table."""
    if not isinstance(value, Mapping):
        raise InvalidInput(f"{place} = {shown(value)}: must be a table of named values; write [{place}]")
    return value


def _value(value: object) -> Any:
    if isinstance(value, tuple):
        return [_value(one) for one in value]
    if isinstance(value, DEPTH_FUNCTIONS):
        return named(value)
    if isinstance(value, Record):
        return plain(value)
    if isinstance(value, np.ndarray):
        return value.tolist()
    # JSON has no infinity: it stands there as the text that the records read.
    return "inf" if isinstance(value, float) and math.isinf(value) else value


def _plain_layer(table: Mapping[str, Any]) -> Layer:
    fields = dict(table)
    flag = fields.pop("half_space", False)
    if not isinstance(flag, bool):
        raise InvalidInput(f"layer.half_space = {shown(flag)}: must be true or false")
    if flag:
        if "thickness" in fields:
            raise InvalidInput(
                f"layer.thickness = {shown(fields['thickness'])}: a half-space has none; drop one of the two"
            )
        fields["thickness"] = math.inf
    return build(Layer, "layer", fields)


def _stack(fields: dict[str, Any]) -> LayerStack:
    tables = _list(fields.get("sublayers", []), "layer.sublayers", "write [[layer.sublayers]]")
    if len(tables) > MAX_SUBLAYERS:
        raise InvalidInput(f"layer.sublayers: {len(tables)} are more than the {MAX_SUBLAYERS} a stack has")
    places = [f"layer.sublayers[{i}]" for i in range(len(tables))]
    sublayers = (build(Sublayer, p, as_mapping(table, p)) for p, table in zip(places, tables, strict=True))
    interfaces = _list(fields.get("interfaces", []), "layer.interfaces", 'write ["bonded", ...]')
    changed = {"sublayers": tuple(sublayers), "interfaces": tuple(interfaces)}
    return build(LayerStack, "layer", fields | changed)


def _list(value: object, place: str, remedy: str) -> Sequence[Any]:
    if isinstance(value, str | bytes | Mapping) or not isinstance(value, Sequence):
        raise InvalidInput(f"{place} = {shown(value)}: must be a list; {remedy}")
    return value


def _graded(fields: dict[str, Any]) -> GradedLayer:
    if "youngs_modulus" in fields:
        fields["youngs_modulus"] = tagged(DEPTH_FUNCTIONS, fields["youngs_modulus"], "layer.youngs_modulus")
    if isinstance(fields.get("poissons_ratio"), Mapping):
        fields["poissons_ratio"] = tagged((TabulatedDepth,), fields["poissons_ratio"], "layer.poissons_ratio")
    return build(GradedLayer, "layer", fields)


def key_shown(key: object) -> str:
    """A key as messages show it."""
    return printable(key[:80]) if isinstance(key, str) else shown(key)
