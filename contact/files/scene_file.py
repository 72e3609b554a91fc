"""Scenes as plain mappings, so that they can be written in TOML and kept in HDF5 and JSON."""

from __future__ import annotations

import dataclasses
import math
import re
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from contact.files.scene_text import scene_text
from contact.records.errors import InvalidInput
from contact.records.plain_text import printable
from contact.records.record import Record, shown
from contact.scene.effects import EFFECTS, Effect
from contact.scene.layer import Layer
from contact.scene.loading import LOADINGS, Loading
from contact.scene.profiles import PROFILES, Profile
from contact.scene.scene import Scene

R = TypeVar("R", bound=Record)


def kind_of(cls: type[Record]) -> str:
    """The name by which files call a record: TruncatedCone is "truncated_cone"."""
    return re.sub(r"(?<!^)(?=[A-Z])", "_", cls.__name__).lower()


def load_scene(path: str | Path) -> Scene:
    """Read a scene from a TOML file.

    Raises:
        InvalidInput: If the file is missing, silent, empty, too large, not TOML, or not a scene.
    """
    file = Path(path)
    text = scene_text(file)
    try:
        mapping = tomllib.loads(text)
    except ValueError as error:
        # The syntax is wrong, or an integer has more digits than Python reads.
        raise InvalidInput(f"{file}: not valid TOML: {error!s:.200}") from None
    except RecursionError:
        raise InvalidInput(f"{file}: nested too deeply for a scene") from None
    try:
        return scene_from_mapping(mapping)
    except InvalidInput as error:
        raise InvalidInput(f"{file}: {error}") from None


def scene_from_mapping(mapping: Mapping[str, Any]) -> Scene:
    """Build a scene from nested mappings; the inverse of `scene_to_mapping`.

    Raises:
        InvalidInput: With the path of the offending entry, its value and the remedy.
    """
    if not isinstance(mapping, Mapping):
        raise InvalidInput(f"{shown(mapping)}: a scene is a table of layer, indenter, loading and effects")
    unknown = [name for name in mapping if name not in ("layer", "indenter", "loading", "effects")]
    if unknown:
        raise InvalidInput(f"{_key(unknown[0])}: no such table; a scene has layer, indenter, loading and effects")
    effects = mapping.get("effects", [])
    if isinstance(effects, str | bytes | Mapping) or not isinstance(effects, Sequence):
        raise InvalidInput(f"effects = {shown(effects)}: must be a list of tables; write [[effects]]")
    if len(effects) > len(EFFECTS):
        raise InvalidInput(f"effects: {len(effects)} are listed, but each of the {len(EFFECTS)} kinds stands only once")
    return _build(
        Scene,
        "scene",
        {
            "layer": _layer(_table(mapping, "layer")),
            "indenter": _tagged(PROFILES, _table(mapping, "indenter"), "indenter"),
            "loading": _tagged(LOADINGS, _table(mapping, "loading"), "loading"),
            "effects": tuple(_tagged(EFFECTS, effect, f"effects[{i}]") for i, effect in enumerate(effects)),
        },
    )


def scene_to_mapping(scene: Scene) -> dict[str, Any]:
    """The scene as nested dictionaries of plain numbers, strings and lists; nothing is lost."""
    layer = _plain(scene.layer)
    if math.isinf(scene.layer.thickness):
        del layer["thickness"], layer["support"]  # JSON and TOML share no infinity
        layer["half_space"] = True
    return {
        "layer": layer,
        "indenter": _named(scene.indenter),
        "loading": _named(scene.loading),
        "effects": [_named(effect) for effect in scene.effects],
    }


def _key(key: object) -> str:
    return printable(key[:80]) if isinstance(key, str) else shown(key)


def _table(mapping: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    if name not in mapping:
        raise InvalidInput(f"{name} is missing; add a table [{name}]")
    return _mapping(mapping[name], name)


def _mapping(value: object, place: str) -> Mapping[str, Any]:
    if not isinstance(value, Mapping):
        raise InvalidInput(f"{place} = {shown(value)}: must be a table of named values; write [{place}]")
    return value


def _layer(table: Mapping[str, Any]) -> Layer:
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
    return _build(Layer, "layer", fields)


def _tagged(kinds: Sequence[type[R]], value: object, place: str) -> R:
    """Build the record that the entry `kind` names."""
    fields = dict(_mapping(value, place))
    names = {kind_of(cls): cls for cls in kinds}
    kind = fields.pop("kind", None)
    if not isinstance(kind, str) or kind not in names:
        raise InvalidInput(f"{place}.kind = {shown(kind)}: must be one of {', '.join(sorted(names))}")
    return _build(names[kind], place, fields)


def _build(cls: type[R], place: str, fields: Mapping[str, Any]) -> R:
    """Construct a record; errors name the place in the file instead of the class."""
    for key in fields:
        if not isinstance(key, str):
            raise InvalidInput(f"{place}: the key {shown(key)} is no name")
    try:
        return cls(**fields)
    except InvalidInput as error:
        raise InvalidInput(re.sub(rf"^{cls.__name__}\b", place, str(error), flags=re.MULTILINE)) from None


def _named(item: Profile | Loading | Effect) -> dict[str, Any]:
    return {"kind": kind_of(type(item)), **_plain(item)}


def _plain(item: Record) -> dict[str, Any]:
    # All records are dataclasses.
    values = ((f.name, getattr(item, f.name)) for f in dataclasses.fields(item))  # type: ignore[arg-type]
    return {name: _plain_value(v) for name, v in values if v is not None}


def _plain_value(value: Any) -> Any:
    """JSON has no infinity: it stands there as the text that the records read."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    return "inf" if isinstance(value, float) and math.isinf(value) else value
