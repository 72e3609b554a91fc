"""The JSON Schema of a scene file, from the records themselves: editors complete and check scenes with it."""

from __future__ import annotations

import inspect
from collections.abc import Iterable
from typing import Any

from pydantic import TypeAdapter

from contact.files.layer_table import kind_of
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
    parts = {
        "layer": {"type": "object", "oneOf": [_layer(), _stack(), _graded()]},
        "indenter": _one_of(PROFILES),
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
    return {name: entry for name, entry in schema.items() if name != "title"}
