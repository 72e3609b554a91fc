"""Scenes as plain mappings, so that they can be written in TOML and kept in HDF5 and JSON."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from contact.files.layer_table import as_mapping, build, key_shown, layer_mapping, layer_of, named, tagged
from contact.files.scene_text import scene_text
from contact.records.errors import InvalidInput
from contact.records.record import shown
from contact.scene.effects import EFFECTS
from contact.scene.loading import LOADINGS
from contact.scene.profiles import PROFILES
from contact.scene.scene import AnyScene, Scene


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
        raise InvalidInput(f"{key_shown(unknown[0])}: no such table; a scene has layer, indenter, loading and effects")
    effects = mapping.get("effects", [])
    if isinstance(effects, str | bytes | Mapping) or not isinstance(effects, Sequence):
        raise InvalidInput(f"effects = {shown(effects)}: must be a list of tables; write [[effects]]")
    if len(effects) > len(EFFECTS):
        raise InvalidInput(f"effects: {len(effects)} are listed, but each of the {len(EFFECTS)} kinds stands only once")
    return build(
        Scene,
        "scene",
        {
            "layer": layer_of(_table(mapping, "layer")),
            "indenter": tagged(PROFILES, _table(mapping, "indenter"), "indenter"),
            "loading": tagged(LOADINGS, _table(mapping, "loading"), "loading"),
            "effects": tuple(tagged(EFFECTS, effect, f"effects[{i}]") for i, effect in enumerate(effects)),
        },
    )


def scene_to_mapping(scene: AnyScene) -> dict[str, Any]:
    """The scene as nested dictionaries of plain numbers, strings and lists; nothing is lost."""
    return {
        "layer": layer_mapping(scene.layer),
        "indenter": named(scene.indenter),
        "loading": named(scene.loading),
        "effects": [named(effect) for effect in scene.effects],
    }


def _table(mapping: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    if name not in mapping:
        raise InvalidInput(f"{name} is missing; add a table [{name}]")
    return as_mapping(mapping[name], name)
