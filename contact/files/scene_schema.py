"""The JSON Schema of a scene file, from the records themselves: editors complete and check scenes with it."""

from __future__ import annotations

import inspect
from collections.abc import Iterable
from typing import Any

from pydantic import TypeAdapter

from contact.files.layer_table import kind_of
from contact.files.units import unit_of
from contact.records.record import Record
from contact.scene.depth_functions import DEPTH_FUNCTIONS, TabulatedDepth
from contact.scene.effects import EFFECTS
from contact.scene.graded_layer import GradedLayer
from contact.scene.layer import Layer
from contact.scene.layer_stack import MAX_SUBLAYERS, ElasticBase, LayerStack, Sublayer
from contact.scene.loading import LOADINGS
from contact.scene.profiles import PROFILES

DRAFT = "http://json-schema.org/draft-07/schema#"


def scene_schema() -> dict[str, Any]:
    """Return the schema of what `load_scene` reads; what depends on several entries only `load_scene` checks."""
    text = "Whether depths from the thickness of the layer on are solved all the same"
    parts: dict[str, Any] = {
        "beyond_small_strains": {"type": "boolean", "description": text},
        "layer": {"type": "object", "oneOf": [_layer(), _stack(), _graded()]},
        "indenter": {"type": "object", "oneOf": [*(_tagged(cls) for cls in PROFILES), *_shorthands()]},
        "loading": _one_of(LOADINGS),
        "effects": {"type": "array", "items": _one_of(EFFECTS), "maxItems": len(EFFECTS)},
    }
    return {
        "$schema": DRAFT,
        "title": "Scene of an axisymmetric contact",
        "type": "object",
        "properties": parts,
        "required": ["layer", "indenter", "loading"],
        "additionalProperties": False,
    }


def _layer() -> dict[str, Any]:
    """A layer has a thickness, a half-space says `half_space = true` instead."""
    schema = _record(Layer)
    schema["properties"]["half_space"] = {"type": "boolean", "description": "instead of a thickness"}
    schema["required"].remove("thickness")
    # A viscoelastic effect may give the modulus in its place.
    schema["required"].remove("youngs_modulus")
    thick: dict[str, Any] = {"required": ["thickness"]}
    infinite: dict[str, Any] = {"properties": {"half_space": {"const": True}}, "required": ["half_space"]}
    return schema | {"oneOf": [thick | {"not": infinite}, infinite | {"not": thick}]}


def _stack() -> dict[str, Any]:
    schema = _shallow(LayerStack)
    one, name = _record(Sublayer), {"enum": ["bonded", "unbonded"]}
    schema["properties"] |= {
        "sublayers": {"type": "array", "items": one, "minItems": 1, "maxItems": MAX_SUBLAYERS},
        "interfaces": {"type": "array", "items": name},
        "support": _support(),
    }
    return schema | {"required": ["kind", "sublayers"]}


def _graded() -> dict[str, Any]:
    schema = _shallow(GradedLayer)
    number = {"type": "number", "minimum": 0.0, "maximum": 0.5}
    schema["properties"] |= {
        "thickness": {"type": "number", "exclusiveMinimum": 0},
        "youngs_modulus": _one_of(DEPTH_FUNCTIONS),
        "poissons_ratio": {"oneOf": [number, _tagged(TabulatedDepth)]},
        "support": _support(),
    }
    return schema | {"required": ["kind", "thickness", "youngs_modulus", "poissons_ratio"]}


def _support() -> dict[str, Any]:
    return {"oneOf": [{"enum": ["bonded", "unbonded"]}, _record(ElasticBase)]}


def _shallow(cls: type[Record]) -> dict[str, Any]:
    """A record with its kind, and no field yet."""
    text = inspect.cleandoc(cls.__doc__ or "").partition("\n")[0]
    properties = {"kind": {"const": kind_of(cls)}}
    return {"type": "object", "description": text, "properties": properties, "additionalProperties": False}


def _one_of(kinds: Iterable[type[Record]]) -> dict[str, Any]:
    return {"type": "object", "oneOf": [_tagged(cls) for cls in kinds]}


def _tagged(cls: type[Record]) -> dict[str, Any]:
    """A record with the entry `kind` that names it."""
    schema = _record(cls)
    schema["properties"] = {"kind": {"const": kind_of(cls)}} | schema["properties"]
    return schema | {"required": ["kind", *schema.get("required", [])]}


def _record(cls: type[Record]) -> dict[str, Any]:
    """The schema of a record, each field with its line of the docstring."""
    schema = TypeAdapter(cls).json_schema()
    text = inspect.cleandoc(cls.__doc__ or "")
    schema["description"] = text.partition("\n")[0]
    for name, field in schema["properties"].items():
        field.pop("title", None)
        lines = [line for line in text.splitlines() if line.strip().startswith(f"{name}: ")]
        field["description"] = lines[0].partition(": ")[2] if lines else ""
        if unit_of(cls, name) is not None:
            schema["properties"][name] = _with_units(field)
    return {name: entry for name, entry in schema.items() if name != "title"}


def _shorthands() -> list[dict[str, Any]]:
    """Tables that `contact.files.shorthands` writes out: half angles in place of slopes, pyramids, tips from files."""
    angle = {"type": "string", "description": 'from the axis to the flank, as in "35 deg"'}
    length = {"anyOf": [{"type": "number"}, {"type": "string"}]}
    file, unit = {"type": "string", "description": "CSV: radii, heights"}, {"type": "string"}
    return [
        _shorthand("cone", {"half_angle": angle}),
        _shorthand("truncated_cone", {"half_angle": angle, "flat_radius": length}),
        _shorthand("spheroconical", {"half_angle": angle, "radius": length}),
        _shorthand("pyramid", {"half_angle": angle}),
        _shorthand("tabulated", {"file": file}, unit=unit, noise=length),
    ]


def _shorthand(kind: str, required: dict[str, Any], **optional: Any) -> dict[str, Any]:
    return _table({"kind": {"const": kind}} | required | optional, ["kind", *required])


def _with_units(field: dict[str, Any]) -> dict[str, Any]:
    """A number or a list, or the same with a unit, as a range, or as a column of a file."""
    # Bounds are for numbers only, and the pattern for texts only.
    quantity = {"type": ["number", "string"], "pattern": r"^\s*[-+.\d]"}
    text = field.pop("description")
    if field.get("type") != "array":
        numbers = next((one for one in field.get("anyOf", []) if one.get("type") == "number"), field)
        return {"description": text} | numbers | quantity
    field["items"] = field["items"] | quantity
    end = quantity
    spacing = {"enum": ["linear", "log"]}
    count = {"type": "integer", "minimum": 2}
    span = _table({"start": end, "stop": end, "count": count, "spacing": spacing}, ["start", "stop", "count"])
    column = {"type": ["string", "integer"]}
    file = _table({"file": {"type": "string"}, "column": column, "unit": {"type": "string"}}, ["file"])
    return {"description": text, "anyOf": [field, quantity, span, file]}


def _table(properties: dict[str, Any], required: list[str]) -> dict[str, Any]:
    return {"type": "object", "properties": properties, "required": required, "additionalProperties": False}
