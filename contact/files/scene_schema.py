"""The JSON Schema of a scene file, from the records themselves: editors complete and check scenes with it."""

from __future__ import annotations

import inspect
from collections.abc import Iterable
from typing import Any

from pydantic import TypeAdapter

from contact.files.scene_file import kind_of
from contact.records.record import Record
from contact.scene.effects import EFFECTS
from contact.scene.layer import Layer
from contact.scene.loading import LOADINGS
from contact.scene.profiles import PROFILES

DRAFT = "http://json-schema.org/draft-07/schema#"


def scene_schema() -> dict[str, Any]:
    """Return the schema of what `load_scene` reads; what depends on several entries only `load_scene` checks."""
    parts = {
        "layer": _layer(),
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
