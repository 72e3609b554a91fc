"""Settings of registered methods from the command line or a file, for all scenes or one, or from coarse to fine."""

import re
import tomllib
from collections.abc import Collection, Iterable, Mapping
from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from typing import Any, Final, TypeAlias

from cases.case import Case
from cases.declare.methods import MethodUse, build, load, registered
from contact import InvalidInput
from contact.records.errors import shown

# Settings by method and name. A nested table has the settings for the scene of its name.
Settings: TypeAlias = Mapping[str, Mapping[str, Any]]

WORDS: Final = re.compile(r"(?:(?P<method>[^=]+)\.)?(?P<name>\w+)=(?P<value>.*)", re.DOTALL)


def read_settings(texts: Iterable[str], methods: Collection[str]) -> dict[str, dict[str, Any]]:
    """Return settings by method and name; the later of two equal names counts.

    Args:
        texts: Each is ``name=value``, ``method.name=value``, or a TOML file with a table per method. Values are
            written as in TOML; any other value is a string.
        methods: Chosen methods; a setting without a method belongs to the only registered one among them.

    Raises:
        InvalidInput: If a text is none of these, or if its method is not registered.
    """
    settings: dict[str, dict[str, Any]] = {}
    for text in texts:
        for method, values in (_of_words(text, methods) if "=" in text else _of_file(text)).items():
            if method not in registered():
                raise InvalidInput(
                    f"--setting {shown(text)}: {method!r} is no method of an installed package; "
                    f"those are {', '.join(registered())}"
                )
            settings.setdefault(method, {}).update(values)
    return settings


def _of_words(text: str, methods: Collection[str]) -> dict[str, dict[str, Any]]:
    """Setting in a text "name=value" or "method.name=value", by method and name."""
    words = WORDS.fullmatch(text)
    if words is None:
        raise InvalidInput(f"--setting {shown(text)}: write name=value, method.name=value, or the name of a TOML file")
    chosen = [name for name in methods if name in registered()]
    if not words["method"] and len(chosen) != 1:
        raise InvalidInput(f"--setting {shown(text)}: name the method, as in {(*chosen, 'mine')[0]}.{text}")
    return {words["method"] or chosen[0]: {words["name"]: _value(words["value"])}}


def _value(text: str) -> Any:
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text


def _of_file(text: str) -> dict[str, dict[str, Any]]:
    """Settings in a TOML file, one table per method."""
    try:
        tables = tomllib.loads(Path(text).read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise InvalidInput(f"--setting {shown(text)}: no such file of settings can be read: {error}") from None
    if loose := [name for name, table in tables.items() if not isinstance(table, dict)]:
        raise InvalidInput(f"--setting {shown(text)}: {loose[0]} stands outside a table; put it under [method]")
    return tables


def with_settings(case: Case, settings: Settings) -> Case:
    """Return ``case`` with these settings of its methods on top of its own.

    Raises:
        InvalidInput: If a method does not take them.
    """
    methods = tuple(_changed(use, settings, "") for use in case.methods)
    scenes = []
    for scene in case.scenes:
        uses = case.methods_of(scene)
        changed = tuple(_changed(use, settings, scene.name) for use in uses)
        scenes.append(scene if changed == uses else replace(scene, methods=changed))
    return replace(case, methods=methods, scenes=tuple(scenes))


def _changed(use: MethodUse, settings: Settings, scene: str) -> MethodUse:
    """The method with its settings for all scenes, overridden by those for the scene."""
    of_method = settings.get(use.method or use.label, {})
    of_scene = of_method.get(scene, {})
    wanted = {key: value for key, value in of_method.items() if not isinstance(value, dict)}
    wanted |= of_scene if isinstance(of_scene, dict) else {}
    return _checked(replace(use, settings={**use.settings, **wanted})) if wanted else use


def ladder(name: str, settings: Mapping[str, Any]) -> tuple[MethodUse, ...]:
    """Return the settings that ``cost`` times: one per entry of the lists; other values belong to all of them.

    Raises:
        InvalidInput: If lists differ in length, or if the method does not take a value.
    """
    plain = {key: value for key, value in settings.items() if not isinstance(value, dict)}
    lists = {key: value for key, value in plain.items() if isinstance(value, list)}
    lengths = {len(values) for values in lists.values()}
    if len(lengths) > 1 or 0 in lengths:
        raise InvalidInput(f"settings of {name!r}: lists must have the same length, at least one entry")
    steps = [plain | {key: values[step] for key, values in lists.items()} for step in range(max(lengths, default=1))]
    return tuple(_checked(MethodUse(label=_words(step), method=name, settings=step)) for step in steps)


def _words(settings: Mapping[str, Any]) -> str:
    return ", ".join(f"{name}={value}" for name, value in settings.items()) or "as it comes"


def _checked(use: MethodUse) -> MethodUse:
    """The use itself; refuses settings that its method does not accept."""
    name = use.method or use.label
    try:
        build(name, use.settings)
    except InvalidInput:
        raise
    except Exception as error:
        # A method of another package may raise anything.
        kind = load(name)
        names = [field.name for field in fields(kind) if field.init] if is_dataclass(kind) else None
        known = "" if names is None else f"; it has {', '.join(names) or 'none'}"
        raise InvalidInput(f"method {name!r} does not take {_words(use.settings)}: {error}{known}") from error
    return use
