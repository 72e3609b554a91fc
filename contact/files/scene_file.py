"""Scenes as nested tables, so that they can be written in TOML and kept in HDF5 and JSON, and their JSON Schema."""

from __future__ import annotations

import dataclasses
import math
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
from pydantic import TypeAdapter

from contact.files.columns import column, read_text
from contact.records.errors import InvalidInput, shown
from contact.records.record import Record, read, unit_of
from contact.records.units import MEASURES
from contact.records.validation import COLUMN, RANGE
from contact.scene.depth_functions import DEPTH_FUNCTIONS
from contact.scene.effects import EFFECTS, Viscoelasticity
from contact.scene.elastic_layer import ElasticLayer
from contact.scene.graded_layer import GradedLayer
from contact.scene.layer import Layer
from contact.scene.layer_stack import ElasticBase, LayerStack, Sublayer
from contact.scene.loading import LOADINGS
from contact.scene.profiles import PROFILES, PYRAMID_NOTE
from contact.scene.scene import AnyScene, Scene

_RECORDS: Final = (
    Layer,
    LayerStack,
    GradedLayer,
    Sublayer,
    ElasticBase,
    *PROFILES,
    *LOADINGS,
    *EFFECTS,
    *DEPTH_FUNCTIONS,
)
# A message names so many bare fields.
_MOST_NAMED: Final = 8


def load_scene(path: str | Path) -> Scene:
    """Read a scene from a TOML file.

    Raises:
        InvalidInput: If the file is missing, empty, too large, not TOML, or not a scene.
    """
    file = Path(path)
    mapping = _tables(file)
    try:
        return scene_from_mapping(mapping, file.parent)
    except InvalidInput as error:
        raise InvalidInput(f"{file}: {error}") from None


def _tables(file: Path) -> dict[str, Any]:
    text = read_text(file, "a scene")
    if not text.strip():
        raise InvalidInput(f"{file}: the file is empty; a scene needs [layer], [indenter] and [loading]")
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
        folder: That CSV files are named relative to; None where no file may be named.

    Raises:
        InvalidInput: All that is wrong, a line each: path of the offending entry, its value and the remedy.
    """
    if not isinstance(mapping, Mapping):
        raise InvalidInput(f"{shown(mapping)}: a scene is a table of layer, indenter, loading and effects")
    scene = read(Scene, _with_modulus(mapping, folder), "scene", folder)
    _refuse_mixed_units(mapping, folder)
    return scene


def _with_modulus(mapping: Mapping[str, Any], folder: Path | None) -> Mapping[str, Any]:
    """The tables of a scene; the modulus of a plain layer may be left out where a viscoelastic effect gives it."""
    layer, effects = mapping.get("layer"), mapping.get("effects")
    if not isinstance(layer, Mapping) or {"kind", "youngs_modulus"} & layer.keys() or not isinstance(effects, list):
        return mapping
    names = {cls.kind(): cls for cls in EFFECTS if issubclass(cls, Viscoelasticity)}
    given = [one for one in effects if isinstance(one, Mapping) and str(one.get("kind")) in names]
    if not given:
        return mapping
    try:
        model = read(names[given[0]["kind"]], given[0], "effect", folder)
    except InvalidInput:
        # The scene refuses it, with its place; any modulus will do until then.
        return {**mapping, "layer": {**layer, "youngs_modulus": 1.0}}
    ratio = layer.get("poissons_ratio")
    # A ratio that is none is refused by the layer itself, not as a modulus that nobody wrote.
    nu = ratio if isinstance(ratio, int | float) and 0 <= ratio <= 0.5 else 0.5
    return {**mapping, "layer": {**layer, "youngs_modulus": 2 * (1 + nu) * model.relaxation.instantaneous_modulus}}


def scene_notes(path: str | Path) -> list[str]:
    """What a reader should know about how a scene file was read."""
    return [PYRAMID_NOTE] if _tables(Path(path)).get("indenter", {}).get("kind") == "pyramid" else []


def scene_to_mapping(scene: AnyScene) -> dict[str, Any]:
    """The scene as nested dictionaries of plain numbers, strings and lists; nothing is lost."""
    flags = {"beyond_small_strains": True} if scene.beyond_small_strains else {}
    return flags | {
        "layer": table_of(scene.layer),
        "indenter": table_of(scene.indenter),
        "loading": table_of(scene.loading),
        "effects": [table_of(effect) for effect in scene.effects],
    }


def layer_of(table: Mapping[str, Any]) -> ElasticLayer:
    """The layer that `table_of` wrote.

    Raises:
        InvalidInput: With the path of the offending entry, its value and the remedy.
    """
    kinds: dict[object, type[ElasticLayer]] = {cls.kind(): cls for cls in (LayerStack, GradedLayer)}
    return read(kinds.get(table.get("kind"), Layer), table, "layer")


def table_of(item: Record) -> dict[str, Any]:
    """A record's fields as numbers, texts, lists and tables; what is None is left out."""
    values = ((field.name, getattr(item, field.name)) for field in dataclasses.fields(item))
    table = {name: _written(value) for name, value in values if value is not None}
    if isinstance(item, Layer) and item.is_half_space:
        # JSON and TOML share no infinity.
        del table["thickness"], table["support"]
        table["half_space"] = True
    return {"kind": item.kind(), **table} if item.NAMED else table


def _written(value: object) -> Any:
    if isinstance(value, tuple):
        return [_written(one) for one in value]
    if isinstance(value, Record):
        return table_of(value)
    if isinstance(value, np.ndarray):
        return value.tolist()
    # JSON has no infinity: it stands there as the text that the records read.
    return "inf" if isinstance(value, float) and math.isinf(value) else value


def scene_schema() -> dict[str, Any]:
    """The JSON Schema of what `load_scene` reads; what depends on several entries only `load_scene` checks."""
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **TypeAdapter(Scene).json_schema()}


# -- numbers with and without a unit ---------------------------------------------------------------------------------


def uses_units(path: str | Path) -> bool:
    """Whether some number of a scene file has a unit."""
    return any(isinstance(value, str) for _, value in _dimensional(_tables(Path(path)), "", "", Path(path).parent))


def _refuse_mixed_units(mapping: Mapping[str, Any], folder: Path | None) -> None:
    """Refuse a scene in which some dimensional numbers have units and others are bare; 0 and inf need none.

    Raises:
        InvalidInput: With the bare fields, their values and the remedy.
    """
    numbers = list(_dimensional(mapping, "", "", folder))
    bare = {place: value for place, value in numbers if not isinstance(value, str)}
    example = next((value for _, value in numbers if isinstance(value, str)), None)
    if bare and example is not None:
        named = ", ".join(f"{place} = {shown(value)}" for place, value in list(bare.items())[:_MOST_NAMED])
        raise InvalidInput(
            f"{named}: no unit, but other numbers of this scene have one ({shown(example)}); write every length, "
            f'time, force, .. with its unit, as in "{MEASURES["m"][1]}", or none of them (SI)'
        )


def _dimensional(value: object, field: str, place: str, folder: Path | None) -> Iterator[tuple[str, object]]:
    """Place (without the number in a list) and value of each dimensional number that is neither zero nor infinite.

    A column of a file stands for its numbers: as the text of its unit, or as its largest number.
    """
    if isinstance(value, Mapping) and "file" in value and value.keys() <= COLUMN:
        one = column(value, folder)
        value = one.unit or float(np.max(np.abs(one.values)))
    if isinstance(value, Mapping):
        span = bool(value) and value.keys() <= RANGE
        for key, entry in value.items():
            where = f"{place}.{key}" if place else str(key)
            yield from _dimensional(entry, field if span else str(key), where, folder)
    elif isinstance(value, Sequence) and not isinstance(value, str | bytes):
        for number, entry in enumerate(value):
            where = f"{place}[{number}]" if isinstance(entry, Mapping) else place
            yield from _dimensional(entry, field, where, folder)
    elif _has_dimension(field, place) and not _needs_no_unit(value):
        yield place, value


def _has_dimension(field: str, place: str) -> bool:
    pure = place.endswith((".count", ".spacing")) or (field == "values" and "poissons_ratio" in place)
    # The noise of a measured tip is no field of a record.
    return not pure and (field == "noise" or any(unit_of(cls, field) for cls in _RECORDS))


def _needs_no_unit(value: object) -> bool:
    if isinstance(value, str):
        return value == "inf"
    return isinstance(value, bool) or not isinstance(value, int | float) or value in (0, math.inf)
