"""Stored files of every kind, damaged by the thousand: each must be refused in one line.

`python -m tests.cases.mutations [COUNT] [SEED] [KIND]...` prints how COUNT damaged files of each kind end:

- "refused": `InvalidInput` with a message of one line;
- "rewritten": only the writing changed, and what was read is what was stored;
- "accepted": something else was read than was stored;
- "crashed": any other exception, a warning, or a message of several lines.
"""

import collections
import dataclasses
import json
import re
import sys
import tempfile
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from bem.tables.file import read_table, write_table
from bem.tables.table import FlatPunchTable, chebyshev_radii
from cases.declare.task import Task
from cases.gate.baseline import baseline_path, read_baselines
from cases.gate.history import append_history, history_path, read_history
from cases.results.files import read_run, write_run
from cases.results.records.run import Acceptance
from cases.run.keys import content_key, key_parts
from cases.run.store import TaskStore
from contact import ContactPath, Cost, InvalidInput
from contact.files.storage import load_solution, save_solution
from tests.cases.example_run import SCENE, example_run, fast_run
from tests.cases.fake_case import scene_of
from tests.cases.fake_method import FakeHertz
from tests.cases.gate.example_baselines import CASE, accepted

LONGEST_MESSAGE = 1000

Draw = np.random.Generator


@dataclass(frozen=True)
class Stored:
    """A file as the program writes it, and how the program reads it: `content` is None where nothing was found."""

    file: Path
    content: Callable[[], Any]


# -- one file of each kind -------------------------------------------------------------------------------------------


def stored_results(folder: Path) -> Stored:
    write_run(example_run(), folder)
    return Stored(folder / "results.json", lambda: read_run(folder))


def stored_task(folder: Path) -> Stored:
    task = Task(case="fake", scene=SCENE, method="fast", problem=scene_of(0.3), solver=FakeHertz())
    parts = key_parts(task)
    store, key = TaskStore(folder), content_key(parts)
    store.put(key, parts, dataclasses.replace(fast_run(SCENE), key=key))
    return Stored(folder / f"{key}.json", lambda: store.get(key))


def stored_table(folder: Path) -> Stored:
    ratios, radii = np.geomspace(0.1, 10.0, 8), chebyshev_radii(6)
    pressure = 0.5 / np.sqrt(1.0 - radii**2) * np.ones((8, 1))
    table = FlatPunchTable(
        support="bonded",
        poissons_ratio=0.3,
        ratios=ratios,
        radii=radii,
        stiffness=1.0 + ratios,
        pressure=pressure,
        error=np.full(8, 1e-3),
        pressure_error=np.full(8, 1e-3),
        mean_error=np.full((8, 6), 1e-3),
    )
    write_table(folder / "table.h5", table)
    return Stored(folder / "table.h5", lambda: _plain(vars(read_table(folder / "table.h5"))))


def stored_baseline(folder: Path) -> Stored:
    return Stored(baseline_path(accepted(folder), CASE, "mdr"), lambda: read_baselines(folder))


def stored_history(folder: Path) -> Stored:
    entries = [
        Acceptance(
            date="2026-11-22",
            case=CASE,
            method=method,
            quantity="normal_force of half-space",
            old=1.5,
            new=1.25,
            old_tolerance=1e-12,
            new_tolerance=1e-12,
            reason="a better quadrature",
            revision="0" * 40,
        )
        for method in ("mdr", "fem", "bem")
    ]
    append_history(folder, entries)
    return Stored(history_path(folder), lambda: read_history(folder))


def stored_solution(folder: Path) -> Stored:
    scene, numbers = scene_of(0.3), np.array([1.0, 2.0])
    solution = ContactPath(
        scene=scene,
        method="mdr",
        settings={"nodes": 16},
        error_estimate={"normal_force": np.full(2, 1e-9)},
        cost=Cost(wall_seconds=1.0, cpu_seconds=1.0, peak_memory_bytes=1, unknowns=5, counters={}),
        stages=(),
        contact_radius=scene.loading.values,
        indentation_depth=numbers,
        normal_force=numbers,
        contact_stiffness=numbers,
    )
    save_solution(folder / "solution.h5", solution)
    return Stored(folder / "solution.h5", lambda: _plain(vars(load_solution(folder / "solution.h5"))))


KINDS: dict[str, Callable[[Path], Stored]] = {
    "results": stored_results,
    "task": stored_task,
    "table": stored_table,
    "baseline": stored_baseline,
    "h5": stored_solution,
    "history": stored_history,
}


def _plain(value: Any) -> Any:
    """Arrays as their bytes, so that contents compare."""
    if isinstance(value, dict):
        return {name: _plain(entry) for name, entry in value.items() if not name.startswith("_")}
    return (value.shape, value.tobytes()) if isinstance(value, np.ndarray) else value


# -- damage to any file ----------------------------------------------------------------------------------------------


def _piece(draw: Draw, data: bytes, longest: int = 64) -> tuple[int, int]:
    first = int(draw.integers(len(data)))
    return first, min(len(data), first + 1 + int(draw.integers(longest)))


def flipped(draw: Draw, data: bytes) -> bytes:
    changed = bytearray(data)
    for place in draw.integers(0, len(data), int(draw.integers(1, 9))):
        changed[place] ^= 1 << int(draw.integers(8))
    return bytes(changed)


def deleted(draw: Draw, data: bytes) -> bytes:
    first, last = _piece(draw, data)
    return data[:first] + data[last:]


def inserted(draw: Draw, data: bytes) -> bytes:
    first, last = _piece(draw, data)
    return data[:first] + draw.bytes(last - first) + data[first:]


def truncated(draw: Draw, data: bytes) -> bytes:
    return data[: int(draw.integers(len(data)))]


def repeated(draw: Draw, data: bytes) -> bytes:
    first, last = _piece(draw, data, 512)
    return data[:last] + data[first:]


def swapped_pieces(draw: Draw, data: bytes) -> bytes:
    a, b, c = sorted(int(place) for place in draw.integers(0, len(data) + 1, 3))
    return data[:a] + data[b:c] + data[a:b] + data[c:]


def appended(draw: Draw, data: bytes) -> bytes:
    return data + (b"\0", b" ", b"\n", b"{}", data)[draw.integers(5)]


ANY = (flipped, deleted, inserted, truncated, repeated, swapped_pieces, appended)


# -- damage that leaves JSON readable, or nearly ---------------------------------------------------------------------

_NUMBER = re.compile(r"(?<=[ \[])-?\d[\d.e+-]*(?=,?\n|[,}\]])")
_WORDS = ("NaN", "Infinity", "-Infinity", "1e999", "9" * 5000, "9" * 300, "1e-999", "[" * 100_000, '{"a":' * 50_000)


def _replaced(draw: Draw, text: str, pattern: re.Pattern[str], change: Callable[[str], str]) -> str:
    found = list(pattern.finditer(text))
    one = found[draw.integers(len(found))]
    return text[: one.start()] + change(one[0]) + text[one.end() :]


def digit_changed(draw: Draw, text: str) -> str:
    return _replaced(draw, text, re.compile(r"\d"), lambda digit: str((int(digit) + int(draw.integers(1, 10))) % 10))


def number_multiplied(draw: Draw, text: str) -> str:
    factor = (1e6, -1.0, 0.5, 1 + 1e-15, 2)[draw.integers(5)]
    return _replaced(draw, text, _NUMBER, lambda number: repr(factor * float(number)))


def number_written_otherwise(draw: Draw, text: str) -> str:
    return _replaced(draw, text, _NUMBER, lambda number: f"{float(number):.17e}")


def number_replaced(draw: Draw, text: str) -> str:
    return _replaced(draw, text, _NUMBER, lambda number: _WORDS[draw.integers(len(_WORDS))])


def letter_changed(draw: Draw, text: str) -> str:
    return _replaced(draw, text, re.compile("[a-zA-Z]"), lambda letter: chr(ord(letter) ^ 1))


def word_changed(draw: Draw, text: str) -> str:
    """A verdict, a truth, or another word of a record turned into another one."""
    words = ("PASS", "FAIL", "INVALID", "true", "false", "null", "mdr", "fem")
    return _replaced(draw, text, re.compile(r"\b\w{3,}\b"), lambda _: words[draw.integers(len(words))])


def key_repeated(draw: Draw, text: str) -> str:
    """A key once more in front of itself, with another value: readers take the last without a word."""
    return _replaced(draw, text, re.compile(r'"\w+": '), lambda key: f"{key}1.5, {key}")


def space_added(draw: Draw, text: str) -> str:
    return _replaced(draw, text, re.compile(r'\n|: "|,'), lambda mark: mark + " \t\r\n"[draw.integers(4)])


def _tree_changed(change: Callable[[Draw, Any], Any]) -> Callable[[Draw, str], str]:
    def changed(draw: Draw, text: str) -> str:
        tree = change(draw, json.loads(text))
        return json.dumps(tree, sort_keys=True, indent=1) + "\n"

    changed.__name__ = change.__name__
    return changed


def _nodes(tree: Any, of: type) -> list[Any]:
    children = tree.values() if isinstance(tree, dict) else tree if isinstance(tree, list) else ()
    here = [tree] if isinstance(tree, of) and tree else []
    return here + [node for child in children for node in _nodes(child, of)]


def records_swapped(draw: Draw, tree: Any) -> Any:
    lists = [node for node in _nodes(tree, list) if len(node) > 1] or [[0, 0]]
    chosen = lists[draw.integers(len(lists))]
    first, second = draw.choice(len(chosen), 2, replace=False)
    chosen[first], chosen[second] = chosen[second], chosen[first]
    return tree


def values_swapped(draw: Draw, tree: Any) -> Any:
    tables = [node for node in _nodes(tree, dict) if len(node) > 1]
    chosen = tables[draw.integers(len(tables))]
    first, second = draw.choice(sorted(chosen), 2, replace=False)
    chosen[first], chosen[second] = chosen[second], chosen[first]
    return tree


def entry_removed(draw: Draw, tree: Any) -> Any:
    nodes = [*_nodes(tree, dict), *_nodes(tree, list)]
    chosen = nodes[draw.integers(len(nodes))]
    place = sorted(chosen)[draw.integers(len(chosen))] if isinstance(chosen, dict) else draw.integers(len(chosen))
    del chosen[place]
    return tree


def claims_removed(draw: Draw, tree: Any) -> Any:
    chosen = _nodes(tree, dict)
    for node in chosen:
        if "claims" in node:
            node["claims"] = []
    return tree if any("claims" in node for node in chosen) else entry_removed(draw, tree)


def seal_removed(draw: Draw, tree: Any) -> Any:
    return {name: value for name, value in tree.items() if name != "digest"} if "digest" in tree else None


def all_rewritten(draw: Draw, text: str) -> str:
    return json.dumps(json.loads(text), indent=(None, 2, 0)[draw.integers(3)])


def other_newlines(draw: Draw, text: str) -> str:
    return ("\ufeff" + text, text.replace("\n", "\r\n"), text.rstrip("\n"))[draw.integers(3)]


JSON = (
    digit_changed,
    number_multiplied,
    number_written_otherwise,
    number_replaced,
    letter_changed,
    word_changed,
    key_repeated,
    space_added,
    all_rewritten,
    other_newlines,
    *map(_tree_changed, (records_swapped, values_swapped, entry_removed, claims_removed, seal_removed)),
)


def line_removed(draw: Draw, text: str) -> str:
    lines = text.splitlines(keepends=True)
    del lines[draw.integers(len(lines))]
    return "".join(lines)


def lines_swapped(draw: Draw, text: str) -> str:
    lines = text.splitlines(keepends=True)
    first, second = draw.choice(len(lines), 2, replace=False)
    lines[first], lines[second] = lines[second], lines[first]
    return "".join(lines)


LINES = (
    digit_changed,
    number_multiplied,
    letter_changed,
    word_changed,
    key_repeated,
    space_added,
    other_newlines,
    line_removed,
    lines_swapped,
)


def _of_text(change: Callable[[Draw, str], str]) -> Callable[[Draw, bytes], bytes]:
    def changed(draw: Draw, data: bytes) -> bytes:
        return change(draw, data.decode("utf-8")).encode("utf-8")

    changed.__name__ = change.__name__
    return changed


# -- damage that leaves HDF5 readable --------------------------------------------------------------------------------


def number_stored(draw: Draw, data: bytes) -> bytes:
    """One number of one array changed by the library itself."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "changed.h5"
        file.write_bytes(data)
        with h5py.File(file, "r+") as root:
            sets: list[h5py.Dataset] = []
            root.visititems(lambda _, item: sets.append(item) if isinstance(item, h5py.Dataset) else None)
            chosen = sets[draw.integers(len(sets))]
            values = chosen[()]
            values.flat[draw.integers(values.size)] *= 1 + 1e-12
            values.flat[draw.integers(values.size)] += 1.0
            chosen[...] = values
        return file.read_bytes()


# -- the campaign ----------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Trial:
    """How a damaged file ended."""

    kind: str
    number: int
    damage: str
    end: str
    message: str


def trials(kind: str, seed: int, count: int) -> list[Trial]:
    """`count` damaged files of one kind, each damage in turn."""
    with tempfile.TemporaryDirectory() as folder:
        stored = KINDS[kind](Path(folder))
        sound, content = stored.file.read_bytes(), stored.content()
        own = {".json": map(_of_text, JSON), ".jsonl": map(_of_text, LINES)}.get(stored.file.suffix, (number_stored,))
        damages = (*ANY, *own)
        found = []
        for number in range(count):
            draw = np.random.default_rng([seed, list(KINDS).index(kind), number])
            damage = damages[number % len(damages)]
            stored.file.write_bytes(_other_than(sound, damage, draw))
            end, message = _end(stored, content)
            found.append(Trial(kind, number, damage.__name__, end, message))
    return found


def _other_than(sound: bytes, damage: Callable[[Draw, bytes], bytes], draw: Draw) -> bytes:
    for _ in range(100):
        if (data := damage(draw, sound)) != sound:
            return data
    return sound[:-1]


def _end(stored: Stored, content: Any) -> tuple[str, str]:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            found = stored.content()
    except InvalidInput as error:
        text = str(error)
        good = text.isprintable() and len(text) <= LONGEST_MESSAGE
        return ("refused" if good else "crashed"), f"{text:.200}"
    except Exception as error:  # whatever it is: the reader did not name it
        return "crashed", f"{type(error).__name__}: {error!s:.200}"
    return "rewritten" if found == content else "accepted", ""


def main(count: int, seed: int, kinds: list[str]) -> None:
    """Print the ends by kind, and of those not refused the damage and one example."""
    for kind in kinds:
        done = trials(kind, seed, count)
        print(kind, dict(collections.Counter(trial.end for trial in done)))  # noqa: T201 - a script's output
        for (end, damage), number in collections.Counter((t.end, t.damage) for t in done if t.end != "refused").items():
            one = next(t for t in done if (t.end, t.damage) == (end, damage))
            print(f"  {end} {number} x {damage}, first number {one.number}: {one.message}")  # noqa: T201


if __name__ == "__main__":
    main(
        int(sys.argv[1]) if len(sys.argv) > 1 else 3000,
        int(sys.argv[2]) if len(sys.argv) > 2 else 1,
        sys.argv[3:] or list(KINDS),
    )
