"""Scenes as nested tables, for files in TOML, HDF5 and JSON, and their JSON Schema."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import TypeAdapter

from contact.records.errors import InvalidInput, shown
from contact.records.record import Record, read
from contact.records.tables import read_bytes
from contact.records.validation import Derived, Reading
from contact.scene.effects import EFFECTS, Viscoelasticity
from contact.scene.layer import Layer
from contact.scene.scene import AnyScene, Scene


def load_scene(path: str | Path) -> Scene:
    """Read a scene from a TOML file.

    Raises:
        InvalidInput: If the file is missing, empty, too large, not TOML, or not a scene.
    """
    file = Path(path)
    try:
        return _read(_tables(file), Reading(file.parent))
    except InvalidInput as error:
        raise InvalidInput(str(error) if str(error).startswith(str(file)) else f"{file}: {error}") from None


def _tables(file: Path) -> dict[str, Any]:
    """Tables of a TOML file."""
    try:
        text = read_bytes(file, "a scene").decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InvalidInput(f"{file}: not a text file in UTF-8 (byte {error.start}); save it in UTF-8") from None
    if not text.strip():
        raise InvalidInput(f"{file}: the file is empty; a scene needs [layer], [indenter] and [loading]")
    import tomllib  # noqa: PLC0415  # scenes written in Python do not need it

    try:
        return tomllib.loads(text)
    except ValueError as error:
        # The syntax is wrong, or an integer has more digits than Python reads.
        raise InvalidInput(f"{file}: not valid TOML: {error!s:.200}") from None
    except RecursionError:
        raise InvalidInput(f"{file}: nested too deeply for a scene") from None


def scene_from_mapping(mapping: Mapping[str, Any], folder: Path | None = None) -> Scene:
    """Build a scene from nested mappings; the inverse of `scene_to_mapping`.

    Args:
        mapping: Tables layer, indenter, loading and effects; numbers may have units, as in "5 um".
        folder: Folder of the CSV files that the scene names; None if it may name no file.

    Raises:
        InvalidInput: One line per problem: path of the offending entry, its value and the remedy.
    """
    if not isinstance(mapping, Mapping):
        raise InvalidInput(f"{shown(mapping)}: a scene is a table of layer, indenter, loading and effects")
    return _read(mapping, Reading(folder))


def _read(mapping: Mapping[str, Any], reading: Reading) -> Scene:
    """Scene of a mapping. If one dimensional number has a unit, all need one (0 and inf excepted)."""
    scene = read(Scene, _with_modulus(mapping, reading), "scene", reading)
    if reading.bare and reading.example:
        read(Scene, _with_modulus(mapping, reading), "scene", dataclasses.replace(reading, units_required=True))
    return scene


def _with_modulus(mapping: Mapping[str, Any], reading: Reading) -> Mapping[str, Any]:
    """Tables of a scene, with E of a `Layer` from its viscoelastic effect if the table has none."""
    layer, effects = mapping.get("layer"), mapping.get("effects")
    if not isinstance(layer, Mapping) or {"kind", "youngs_modulus"} & layer.keys() or not isinstance(effects, list):
        return mapping
    names = {cls.kind(): cls for cls in EFFECTS if issubclass(cls, Viscoelasticity)}
    models = [effect for effect in effects if isinstance(effect, Mapping) and str(effect.get("kind")) in names]
    if not models:
        return mapping
    try:
        model = read(names[models[0]["kind"]], models[0], "effect", Reading(reading.folder))
        shear = model.relaxation.instantaneous_modulus
    except InvalidInput:
        shear = 1.0  # validation of the scene refuses the effect, with its path
    ratio = layer.get("poissons_ratio")
    nu = ratio if isinstance(ratio, int | float) and 0 <= ratio <= 0.5 else 0.5
    return {**mapping, "layer": {**layer, "youngs_modulus": Derived(2 * (1 + nu) * shear)}}


def uses_units(path: str | Path) -> bool:
    """Whether any number of a scene file has a unit."""
    reading = Reading(Path(path).parent)
    _read(_tables(Path(path)), reading)
    return bool(reading.example)


def scene_to_mapping(scene: AnyScene) -> dict[str, Any]:
    """The scene as nested dictionaries of numbers, strings and lists; `scene_from_mapping` restores it exactly."""
    flags = {"beyond_small_strains": True} if scene.beyond_small_strains else {}
    return flags | {
        "layer": table_of(scene.layer),
        "indenter": table_of(scene.indenter),
        "loading": table_of(scene.loading),
        "effects": [table_of(effect) for effect in scene.effects],
    }


def table_of(item: Record) -> dict[str, Any]:
    """Fields of a record as numbers, texts, lists and tables; fields that are None are omitted."""
    values = ((field.name, getattr(item, field.name)) for field in dataclasses.fields(item))
    table = {name: _written(value) for name, value in values if value is not None}
    if isinstance(item, Layer) and item.is_half_space:
        # JSON and TOML share no infinity, and a half-space has no base.
        table = {name: value for name, value in table.items() if name != "thickness" and value != "bonded"}
        table["half_space"] = True
    return {"kind": item.kind(), **table} if item.NAMED else table


def _written(value: object) -> Any:
    """Value of a field as a number, text, list or table."""
    if isinstance(value, tuple):
        return [_written(part) for part in value]
    if isinstance(value, Record):
        return table_of(value)
    if isinstance(value, np.ndarray):
        return value.tolist()
    # JSON has no infinity: it is written as a text that records accept.
    return "inf" if isinstance(value, float) and math.isinf(value) else value


def scene_schema() -> dict[str, Any]:
    """JSON Schema of scene files; only `load_scene` checks relations between entries."""
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **TypeAdapter(Scene).json_schema()}
