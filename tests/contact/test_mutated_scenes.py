"""Scene files with one mistake each: one clear message, or the scene that the file says; never a traceback."""

import random
import tomllib
from pathlib import Path

import numpy as np
import pint
import pytest

from contact import InvalidInput, Scene, load_scene, scene_from_mapping, scene_to_mapping

FILES = sorted((Path(__file__).parents[2] / "examples").rglob("*.toml"))
EXAMPLES = [file for file in FILES if "indenter" in tomllib.loads(file.read_text(encoding="utf-8"))]
UNITS = pint.UnitRegistry()
DERIVED = {"slope", "youngs_modulus", "smoothing"}  # from half angles, relaxation functions and noise
IN_TESTS = 300
LONGEST_MESSAGE = 1500


def leaves(value, above=()):
    """Place and value of every number, text and truth value of nested tables."""
    entries = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, entry in entries:
        yield from leaves(entry, (*above, key))
    if not isinstance(value, dict | list):
        yield above, value


def written(value):
    """A value as TOML."""
    if isinstance(value, dict):
        return "{" + ", ".join(f'"{key}" = {written(entry)}' for key, entry in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(written, value)) + "]"
    if isinstance(value, bool):
        return str(value).lower()
    return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"' if isinstance(value, str) else repr(value)


def file_of(tables):
    return "\n".join(f"{key} = {written(value)}" for key, value in tables.items())


def changed(draw, tables):
    """The tables with one mistake, and its name."""
    place, value = draw.choice(list(leaves(tables)))
    *above, key = place
    table = tables
    for step in above:
        table = table[step]
    number = value if isinstance(value, int | float) else 1.0
    mistakes = {
        "name": lambda: table.update({misspelt(draw, key): table.pop(key)}),
        "missing": lambda: table.pop(key),
        "negative": lambda: table.update({key: f"-{value}" if isinstance(value, str) else -value}),
        "text": lambda: table.update({key: draw.choice(["", "soft", "1e-6", "ten um", "5 furlongs/fortnight"])}),
        "unit": lambda: table.update({key: draw.choice(["3 kg", "5 K", "1 V", "2 lux", "7 bananas"])}),
        "bare": lambda: table.update({key: number + 1.5}),
        "huge": lambda: table.update({key: draw.choice([1e300, 1e-300, 10**400, float("nan"), float("-inf")])}),
        "nested": lambda: table.update({key: draw.choice([[], [[1.0]], {}, {"value": value}, [value, "x"]])}),
        "truth": lambda: table.update({key: draw.choice([True, False])}),
        "further": lambda: table.update({draw.choice(["E", "nu", "colour", "base", "radus"]): 1.0}),
    }
    kinds = list(mistakes) if isinstance(table, dict) else ["negative", "text", "unit", "bare", "huge", "nested"]
    if isinstance(table, list):
        box = {key: value}
        table, items = box, table
    kind = draw.choice(kinds)
    mistakes[kind]()
    if not isinstance(key, str):
        items[key] = box[key]
    return kind, place


def misspelt(draw, name):
    at = draw.randrange(len(name))
    return name[:at] + draw.choice(["", name[at] * 2, "q"]) + name[at + 1 :]


def in_base_units(place, value):
    """A number of a file in SI; None for a name, for a count and for what the scene does not keep."""
    if {"count", "half_angle", "noise", "kind", "file", "column", "unit"} & set(place) or isinstance(value, bool):
        return None
    if not isinstance(value, str):
        return value
    try:
        return UNITS.Quantity(value).to_base_units().magnitude
    except (pint.PintError, ValueError):  # an empty text is no quantity
        return None


def is_read_as_written(scene, tables):
    """Whether each number of the tables is in the scene, and a round trip gives the scene again."""
    said = np.array([value for _, value in leaves(scene_to_mapping(scene)) if isinstance(value, int | float)])
    numbers = [number for place, value in leaves(tables) if (number := in_base_units(place, value)) is not None]
    lost = [number for number in numbers if not np.isclose(said, float(number), rtol=1e-12, atol=0.0).any()]
    written = np.array([float(number) for number in numbers])
    alone = [(place, value) for place, value in leaves(scene_to_mapping(scene)) if isinstance(place[-1], str)]
    invented = [
        place
        for place, value in alone
        if isinstance(value, float) and place[-1] not in DERIVED and not np.isclose(written, value, rtol=1e-12).any()
    ]
    return not lost and not invented and scene_from_mapping(scene_to_mapping(scene)) == scene


def judged(draw, folder, read=load_scene):
    """Kind of the mistake, and "" or what was wrong with its treatment."""
    example = draw.choice(EXAMPLES)
    tables = tomllib.loads(example.read_text(encoding="utf-8"))
    before = load_scene(example)
    kind, place = changed(draw, tables)
    for table in example.parent.glob("*.csv"):
        (folder / table.name).write_bytes(table.read_bytes())
    file = folder / "scene.toml"
    file.write_text(file_of(tables), encoding="utf-8")
    told = f"{example.name}: {kind} at {place}"
    try:
        scene = read(file)
    except InvalidInput as refusal:
        message = str(refusal).removeprefix(f"{file}: ")
        is_clear = len(message) <= LONGEST_MESSAGE and message.isprintable() | ("\n" in message)
        return kind, "" if is_clear else f"{told}: {message!r}"
    except Exception as error:
        return kind, f"{told}: {type(error).__name__}: {error}"
    harmless = scene == before or is_read_as_written(scene, tables)
    return kind, "" if isinstance(scene, Scene) and harmless else f"{told}: read as {scene_to_mapping(scene)}"


@pytest.mark.first(1)
@pytest.mark.parametrize("seed", range(3))
def test_a_mistake_is_one_message_or_the_scene_that_the_file_says(tmp_path, seed):
    draw = random.Random(seed)
    wrong = [fault for _, fault in (judged(draw, tmp_path) for _ in range(IN_TESTS // 3)) if fault]
    assert wrong == []


def test_a_scene_that_is_read_otherwise_and_a_traceback_are_seen(tmp_path):
    """Each example read as another one, or with an error of Python."""
    other = load_scene(EXAMPLES[0]).replace(beyond_small_strains=True)
    for reader in (lambda _: other, lambda _: {}["place"]):
        draw = random.Random(1)
        assert sum(bool(fault) for _, fault in (judged(draw, tmp_path, reader) for _ in range(20))) >= 15
