"""Seeded input that nobody should trust: damaged scenes, TOML, HDF5 and JSON. The only good answers are named.

Every trial damages something that was valid and hands it to the reader. It ends as

- "refused": `InvalidInput` with a message of bearable length, nothing written;
- "accepted": the damage happened to leave something valid, and what was read is a scene that survives a round trip
  or, for stored arrays, exactly what was written;
- "altered": numbers were read that nobody wrote, without a word: the worst end;
- "crashed": any other exception or a warning.
"""

from __future__ import annotations

import codecs
import datetime
import html
import json
import math
import tempfile
import warnings
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path
from typing import Any, Literal, TypeAlias, get_args

import numpy as np

from cases.declare.foreign_methods import check_claim
from cases.declare.methods import check_name
from cases.results.files import from_json
from cases.results.strict_json import json_text
from contact import ContactPath, ContactRadii, Cost, InvalidInput, Scene, Solution, StageRecord
from contact.files.scene_file import load_scene, scene_from_mapping, scene_to_mapping
from contact.files.storage import read_tree, write_tree
from contact.records.errors import printable
from tests.drawn_scenes import FAMILIES, random_scene

End: TypeAlias = Literal["refused", "accepted", "altered", "crashed"]
Kind: TypeAlias = Literal["mapping", "toml", "hdf5", "json", "writing", "file", "method"]
KINDS: tuple[Kind, ...] = get_args(Kind)

HUGE_INTEGER = "9" * 5000
LONGEST_MESSAGE = 2000  # characters; a message is for a person

Draw: TypeAlias = np.random.Generator


@dataclass(frozen=True, kw_only=True)
class HostileTrial:
    """One damaged input and how it ended.

    Attributes:
        kind: What was damaged.
        number: Its number; together with kind and seed it repeats the trial.
        end: How it ended.
        message: What the reader said, or what crashed.
    """

    kind: Kind
    number: int
    end: End
    message: str


def hostile_trial(kind: Kind, seed: int, number: int) -> HostileTrial:
    """Damage one input and read it; any end but "refused" and "accepted" is a defect."""
    draw = np.random.default_rng([seed, KINDS.index(kind), number])
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            end, message = _TRIALS[kind](draw)
    except InvalidInput as error:
        end, message = _judged(str(error))
    except Exception as error:  # any other exception is what this trial looks for
        end, message = "crashed", f"{type(error).__name__}: {error!s:.200}"
    return HostileTrial(kind=kind, number=number, end=end, message=message)


def _judged(message: str) -> tuple[End, str]:
    """A refusal is for a person at a terminal: short, and without characters that the terminal obeys."""
    if len(message) > LONGEST_MESSAGE:
        return "crashed", f"message of {len(message)} characters"
    if printable(message, keep="\n") != message:
        return "crashed", f"message with control characters: {message!r:.200}"
    return "refused", message


def hostile_trials(seed: int, count: int) -> list[HostileTrial]:
    """`count` trials, the kinds in turn."""
    return [hostile_trial(KINDS[n % len(KINDS)], seed, n) for n in range(count)]


# -- values that have broken programs --------------------------------------------------------------------------------


# Texts that a terminal would obey: colours, bells, erased lines, reversed reading, faked lines.
_STEERING = ("\x1b[31m", "\x07", "\x9b2J", "\u202e", "a\rPASSED", "a\nPASSED: all checks", "\u2028", "\x7f")


class _Liar(list[float]):
    """A list that says it is short."""

    def __len__(self) -> int:
        return 3


def _hostile_values() -> tuple[Any, ...]:
    plain = (None, True, math.nan, math.inf, -math.inf, -1.0, 0.0, 5e-324, 1.7e308, -1e-300, 10**400, 10**5000)
    texts = ("", "1e-3", "nan", "x" * 100_000, "\x00", b"1", "é̀", "{}", *_STEERING)
    lists: tuple[Any, ...] = (
        [],
        [math.nan],
        [None],
        [[1.0]],
        [1.0, "2"],
        [2.0, 1.0],
        [1.0, 1.0],
        range(10**12),
        _Liar([1.0] * 9),
        (),
    )
    arrays = (
        np.array([]),
        np.array(["1"]),
        np.array([None, 1.0]),
        np.zeros((2, 2)),
        np.array(1.0),
        np.ma.array([1.0, 2.0], mask=[False, True]),
        np.array([1.0, np.nan]),
        np.array([np.longdouble("1e4000")]),
        np.array([1], dtype="m8[s]"),
        np.array([True, False]),
    )
    others: tuple[Any, ...] = (
        {},
        {"kind": "cone"},
        {1: 2, "a": 3},
        {None: 1},
        1j,
        object(),
        Decimal(1),
        datetime.date(2020, 1, 1),
        len,
    )
    return (*plain, *texts, *lists, *arrays, *others)


_VALUES = _hostile_values()
_JSON_VALUES: tuple[Any, ...] = (
    None,
    True,
    math.nan,
    -math.inf,
    -1.0,
    5e-324,
    10**4000,
    "",
    "x" * 100_000,
    "\x00",
    [],
    [[1.0]],
    {"a": {}},
)
_KEYS = ("kind", "", "thickness", "x" * 100_000, "__class__", "values", "half_space", 1, None, ("a",), *_STEERING)


def _scene(draw: Draw) -> Scene:
    return random_scene(draw, FAMILIES[draw.integers(len(FAMILIES))])


def _places(tree: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Paths of all nodes."""
    children = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    return [path, *(place for key, child in children for place in _places(child, (*path, key)))]


def _at(tree: Any, path: tuple[Any, ...]) -> Any:
    for key in path:
        tree = tree[key]
    return tree


def damaged_tree(draw: Draw, tree: dict[Any, Any], values: tuple[Any, ...] = _VALUES) -> Any:
    """The tree with one node replaced, removed, renamed or added."""
    places = _places(tree)
    path = places[draw.integers(len(places))]
    value = values[draw.integers(len(values))]
    if not path:
        return value
    parent, key = _at(tree, path[:-1]), path[-1]
    deed = draw.integers(4)
    if deed == 0 and isinstance(parent, dict):
        del parent[key]
    elif deed == 1 and isinstance(parent, dict):
        parent[_KEYS[draw.integers(len(_KEYS))]] = parent.pop(key)
    elif deed == 2 and isinstance(parent, dict):
        parent[_KEYS[draw.integers(len(_KEYS))]] = value
    else:
        parent[key] = value
    return tree


# -- one trial of each kind ------------------------------------------------------------------------------------------


def _round_trip(scene: Scene) -> tuple[End, str]:
    again = scene_from_mapping(scene_to_mapping(scene))
    return ("accepted", "") if again == scene else ("altered", "the scene does not survive a round trip")


def _mapping_trial(draw: Draw) -> tuple[End, str]:
    return _round_trip(scene_from_mapping(damaged_tree(draw, scene_to_mapping(_scene(draw)))))


def damaged_bytes(draw: Draw, content: bytes) -> bytes:
    """The content cut off, with bytes flipped, a piece repeated, removed or replaced by noise."""
    data = bytearray(content)
    first, last = sorted(int(n) for n in draw.integers(0, len(data) + 1, 2))
    deed = draw.integers(5)
    if deed == 0:
        return bytes(data[:first])
    if deed == 1:
        for place in draw.integers(0, len(data), int(draw.integers(1, 9))):
            data[place] ^= 1 << int(draw.integers(8))
    elif deed == 2:
        data[first:first] = data[first:last]
    elif deed == 3:
        del data[first:last]
    else:
        data[first : first + 16] = draw.bytes(16)
    return bytes(data)


def _toml_trial(draw: Draw) -> tuple[End, str]:
    tree = scene_to_mapping(_scene(draw))
    text = to_toml(damaged_tree(draw, tree) if draw.random() < 0.3 else tree).encode("utf-8", "surrogatepass")
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scene.toml"
        file.write_bytes(damaged_bytes(draw, text) if draw.random() < 0.8 else text)
        return _round_trip(load_scene(file))


def to_toml(tree: Any) -> str:
    """A scene's mapping as TOML; what has no TOML form is written as it prints."""
    if not isinstance(tree, Mapping):
        return _printed(tree)
    tables = []
    for name, table in tree.items():
        many = name == "effects" and isinstance(table, list)
        tables += [_toml_table(f"[[{name}]]" if many else f"[{name}]", t) for t in (table if many else [table])]
    return "\n".join(tables)


def _toml_table(title: str, table: Any) -> str:
    if not isinstance(table, Mapping):
        return f"{title}\n{_printed(table)}"
    return "\n".join([title, *(f"{key} = {_toml_value(value)}" for key, value in table.items())])


def _toml_value(value: Any) -> str:
    try:
        return json.dumps(value)
    except (TypeError, ValueError):
        return _printed(value)


def _printed(value: Any) -> str:
    if isinstance(value, int):
        return HUGE_INTEGER
    try:
        return f"{value!s:.1000}"
    except ValueError:  # it holds an integer that Python itself does not print
        return HUGE_INTEGER


def _stored(draw: Draw) -> ContactPath:
    """Some numbers as a solution."""
    scene = random_scene(draw, "elastic")
    loading = ContactRadii(values=np.sort(draw.random(5)) + scene.indenter.flat_radius)
    numbers = draw.random(5)
    scene = scene if scene.indenter.max_radius < math.inf else scene.replace(loading=loading)
    return ContactPath(
        scene=scene,
        method="mdr",
        settings={"nodes": 16},
        error_estimate={"normal_force": np.full(5, 1e-9)},
        cost=Cost(wall_seconds=1.0, cpu_seconds=1.0, peak_memory_bytes=1, unknowns=5, counters={"factorisations": 1}),
        stages=(StageRecord(name="solve", calls=1, wall_seconds=1.0, cpu_seconds=1.0, bytes=40),),
        contact_radius=loading.values,
        indentation_depth=numbers,
        normal_force=numbers,
        contact_stiffness=numbers,
    )


def _hdf5_trial(draw: Draw) -> tuple[End, str]:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "solution.h5"
        _stored(draw).save(file)
        before = read_tree(file)
        file.write_bytes(damaged_bytes(draw, file.read_bytes()))
        Solution.load(file)
        same = _equal(before, read_tree(file))
        return ("accepted", "") if same else ("altered", "other numbers were read than were stored")


def _equal(first: Any, second: Any) -> bool:
    if isinstance(first, dict):
        return (
            isinstance(second, dict)
            and first.keys() == second.keys()
            and all(_equal(first[k], second[k]) for k in first)
        )
    return type(first) is type(second) and bool(np.array_equal(first, second))


_RUN = {"schema_version": 2, "suite": "ci", "complete": True, "cases": []}
_STAMP = {"started": "2020-01-01T00:00:00Z", "wall_seconds": 1.0, "revision": "x", "dirty": False, "python": "3"}
_MACHINE = {"platform": "x", "processor": "x", "cores": 1, "threads": {}, "versions": {}, "mesh_hashes": {}}


def _json_trial(draw: Draw) -> tuple[End, str]:
    tree = damaged_tree(draw, json.loads(json.dumps(_RUN | {"stamp": _STAMP | _MACHINE})), _JSON_VALUES)
    text = _sealed(tree)
    if draw.random() < 0.5:
        text = damaged_bytes(draw, text.encode()).decode("utf-8", "replace")
    from_json(text)
    return "accepted", ""


def _sealed(tree: Any) -> str:
    """Under a right seal where there can be one, so that the reader looks at the content."""
    try:
        return json_text(tree) if isinstance(tree, dict) else json.dumps(tree)
    except (TypeError, ValueError):
        return json.dumps(tree, skipkeys=True)


def _writing_trial(draw: Draw) -> tuple[End, str]:
    """A tree with something that HDF5 cannot hold: nothing may be left behind."""
    leaves = {f"a{n}": draw.random(4) for n in range(int(draw.integers(1, 6)))}
    tree = damaged_tree(draw, {"group": {"inner": leaves}, "number": 1.0})
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "tree.h5"
        try:
            write_tree(file, tree)
        except InvalidInput:
            left = [entry.name for entry in Path(folder).iterdir()]
            if left:
                return "crashed", f"left behind: {left}"
            raise
        return ("accepted", "") if isinstance(read_tree(file), dict) else ("altered", "")


def _file_trial(draw: Draw) -> tuple[End, str]:
    """A scene under a path or with a beginning that has stopped readers: folders, devices, marks, long keys."""
    text = to_toml(scene_to_mapping(_scene(draw))).encode()
    chain = b".".join([(b"a", b'"a"', b"'a'")[draw.integers(3)]] * int(draw.integers(10, 2_000)))
    deed = draw.integers(7)
    with ExitStack() as stack:
        folder = stack.enter_context(tempfile.TemporaryDirectory())
        file = Path(folder) / f"scene{_STEERING[draw.integers(len(_STEERING))]}.toml"
        if deed <= 1:
            file.mkdir()
        elif deed == 2:
            file.symlink_to(file if draw.random() < 0.5 else Path("/dev/zero"))
        elif deed == 3:
            file.write_bytes(codecs.BOM_UTF8 + text)
        elif deed == 4:
            file.write_bytes(text.decode().encode(("utf-16", "utf-32", "utf-16-be")[draw.integers(3)]))
        elif deed == 5:
            file.write_bytes(text + b"\n" + chain + b" = 1\n")
        else:
            file.write_bytes(b"[" + chain + b"]\n" + text)
        return _round_trip(load_scene(file))


def _method_trial(draw: Draw) -> tuple[End, str]:
    """A package whose method has a name that is no name, or claims an accuracy that is none."""
    pieces = (*_STEERING, "/", "..", "<b>", "&", '"', " ", "|", "x" * 70, "a", "Z", "-", ".", "_1")
    name = "".join(pieces[n] for n in draw.integers(0, len(pieces), int(draw.integers(0, 4))))
    check_name(name, "package:Method")
    check_claim(name, _VALUES[draw.integers(len(_VALUES))])
    safe = Path(name).name == name and html.escape(name) == name and printable(name) == name
    return ("accepted", "") if safe else ("altered", f"{name!r} was taken for a name")


_TRIALS: dict[Kind, Callable[[Draw], tuple[End, str]]] = {
    "mapping": _mapping_trial,
    "toml": _toml_trial,
    "hdf5": _hdf5_trial,
    "json": _json_trial,
    "writing": _writing_trial,
    "file": _file_trial,
    "method": _method_trial,
}
