"""Scenes as plain mappings, so that they can be written in TOML and kept in HDF5 and JSON."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, Final

from contact.files.layer_table import as_mapping, build, key_shown, kind_of, layer_mapping, layer_of, named, tagged
from contact.files.mixed_units import has_units, refuse_mixed_units
from contact.files.scene_text import scene_text
from contact.files.shorthands import notes_on, written_out
from contact.files.units import in_si
from contact.files.values import with_columns
from contact.records.errors import InvalidInput
from contact.records.record import shown
from contact.scene.effects import EFFECTS, Effect, Viscoelasticity
from contact.scene.elastic_layer import ElasticLayer
from contact.scene.loading import LOADINGS, Loading
from contact.scene.profiles import PROFILES, Profile, Tabulated
from contact.scene.scene import AnyScene, Scene

PARTS: Final = ("beyond_small_strains", "layer", "indenter", "loading", "effects")
# So many unknown tables and wrong parts are told at once; each part tells at most eight lines.
_MOST_PROBLEMS: Final = 8


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
        return scene_from_mapping(mapping, file.parent)
    except InvalidInput as error:
        raise InvalidInput(f"{file}: {error}") from None


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
    wrong = [
        f"{key_shown(name)}: no such table; a scene has {', '.join(PARTS)}" for name in mapping if name not in PARTS
    ]
    readers = {"effects": _effect_tables, "layer": _layer_table, "indenter": _indenter_table, "loading": _loading_table}
    makers = {"effects": _effects, "layer": _layer, "indenter": _indenter, "loading": _loading}
    tables = _each({name: partial(read, mapping, folder) for name, read in readers.items()}, wrong)
    made = _each({name: partial(makers[name], tables) for name in tables}, wrong)
    if wrong:
        raise InvalidInput("\n".join(wrong[:_MOST_PROBLEMS]))
    refuse_mixed_units(tables)
    flags = {name: mapping[name] for name in ("beyond_small_strains",) if name in mapping}
    return build(Scene, "scene", made | flags)


def _each(calls: Mapping[str, Callable[[], Any]], wrong: list[str]) -> dict[str, Any]:
    """Results of the calls by name; the messages of those that refuse their input are appended to `wrong`."""
    results = {}
    for name, call in calls.items():
        try:
            results[name] = call()
        except InvalidInput as error:
            wrong.append(str(error))
    return results


def scene_notes(path: str | Path) -> list[str]:
    """What a reader should know about how a scene file was read."""
    return notes_on(tomllib.loads(scene_text(Path(path))))


def uses_units(path: str | Path) -> bool:
    """Whether some number of a scene file has a unit."""
    return has_units(tomllib.loads(scene_text(Path(path))))


def scene_to_mapping(scene: AnyScene) -> dict[str, Any]:
    """The scene as nested dictionaries of plain numbers, strings and lists; nothing is lost."""
    flags = {"beyond_small_strains": True} if scene.beyond_small_strains else {}
    return flags | {
        "layer": layer_mapping(scene.layer),
        "indenter": named(scene.indenter),
        "loading": named(scene.loading),
        "effects": [named(effect) for effect in scene.effects],
    }


def _effect_tables(mapping: Mapping[str, Any], folder: Path | None) -> list[Mapping[str, Any]]:
    effects = mapping.get("effects", [])
    if isinstance(effects, str | bytes | Mapping) or not isinstance(effects, Sequence):
        raise InvalidInput(f"effects = {shown(effects)}: must be a list of tables; write [[effects]]")
    if len(effects) > len(EFFECTS):
        raise InvalidInput(f"effects: {len(effects)} are listed, but each of the {len(EFFECTS)} kinds stands only once")
    return [with_columns(as_mapping(effect, f"effects[{i}]"), folder) for i, effect in enumerate(effects)]


def _layer_table(mapping: Mapping[str, Any], folder: Path | None) -> Mapping[str, Any]:
    return with_columns(_table(mapping, "layer"), folder)


def _indenter_table(mapping: Mapping[str, Any], folder: Path | None) -> Mapping[str, Any]:
    return with_columns(written_out(_table(mapping, "indenter")), folder)


def _loading_table(mapping: Mapping[str, Any], folder: Path | None) -> Mapping[str, Any]:
    return with_columns(_table(mapping, "loading"), folder)


def _effects(tables: Mapping[str, Any]) -> tuple[Effect, ...]:
    return tuple(tagged(EFFECTS, table, f"effects[{i}]") for i, table in enumerate(tables.get("effects", [])))


def _layer(tables: Mapping[str, Any]) -> ElasticLayer:
    """The layer; its modulus may be left out where a viscoelastic effect gives it."""
    table = dict(tables["layer"])
    if "kind" in table or "youngs_modulus" in table:
        return layer_of(table)
    models = [effect for effect in _effects(tables) if isinstance(effect, Viscoelasticity)]
    ratio = table.get("poissons_ratio")
    if models:
        # A ratio that is none is refused by the layer itself, not as a modulus that nobody wrote.
        nu = ratio if isinstance(ratio, int | float) and 0 <= ratio <= 0.5 else 0.5
        table["youngs_modulus"] = 2 * (1 + nu) * models[0].relaxation.instantaneous_modulus
    return layer_of(table)


def _indenter(tables: Mapping[str, Any]) -> Profile:
    """The indenter; a table of a tip may name the noise that is smoothed away."""
    table = dict(tables["indenter"])
    noise = table.pop("noise", None) if table.get("kind") == kind_of(Tabulated) else None
    profile = tagged(PROFILES, table, "indenter")
    if noise is None or not isinstance(profile, Tabulated):
        return profile
    return profile.smoothed(noise=in_si(noise, "m", "indenter.noise"))


def _loading(tables: Mapping[str, Any]) -> Loading:
    return tagged(LOADINGS, tables["loading"], "loading")


def _table(mapping: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    if name not in mapping:
        raise InvalidInput(f"{name} is missing; add a table [{name}]")
    return as_mapping(mapping[name], name)
