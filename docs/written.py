"""Pages that the build writes: one per command from its help, tasks with pictures, accuracy and figures of cases.

Accuracy and figures come from the accepted answers in `baselines/`; nothing is copied by hand.
"""

import argparse
import json
import re
from collections import defaultdict
from collections.abc import Iterator, Sequence
from pathlib import Path
from statistics import median
from typing import NamedTuple

from matplotlib.figure import Figure

from contact import load_scene
from mdr import Mdr
from reports.command_line import COMMANDS, EXIT_CODES, command_parser
from reports.pictures import between, solution_figure
from reports.style import figure_style, look_of, mark_decades, svg_text
from reports.words import display_name

ROOT = Path(__file__).resolve().parents[1]
SOLVERS = ("contact", "bem", "mdr", "fem_reference")
CITED = re.compile(r"Eqs?\. \((\d+)\)(?: to \((\d+)\))?(?:, \((\d+)\))?")
# Differences below are drawn here: double precision has sixteen digits.
SMALLEST = 1e-16


def write_commands(folder: Path) -> None:
    """Write a page per command, and their list."""
    folder.mkdir(parents=True, exist_ok=True)
    parsers = {name: command_parser(name) for name in COMMANDS}
    for name, parser in parsers.items():
        (folder / f"{name}.md").write_text(command_page(name, parser), encoding="utf-8")
    entries = "\n".join(f"| [{name}]({name}.md) | {_first(one.description)} |" for name, one in parsers.items())
    contents = "\n".join(parsers)
    text = f"# Commands\n\n| command | what it does |\n|---|---|\n{entries}\n\n{EXIT_CODES}\n"
    (folder / "index.md").write_text(f"{text}\n```{{toctree}}\n:hidden:\n\n{contents}\n```\n", encoding="utf-8")


def command_page(name: str, parser: argparse.ArgumentParser) -> str:
    """The help of one command as Markdown."""
    actions = parser._actions
    usage = " ".join(str(one.metavar) for one in actions if not one.option_strings)
    rows = "\n".join(f"{_parameter(one)}\n: {_cell((one.help or '').replace('%%', '%'))}\n" for one in actions)
    return (
        f"# {name}\n\n{_text(parser.description)}\n\n```text\ncontact-verify {name} {usage} [options]\n```\n\n"
        f"{rows}\n{EXIT_CODES}\n"
    )


def _text(text: str | None) -> str:
    return (text or "").strip().replace("<", "&lt;")


def _first(text: str | None) -> str:
    return _cell(_text(text).split("\n\n")[0])


def _cell(text: str) -> str:
    return re.sub(r"(?<![\w`-])--[a-z-]+", r"`\g<0>`", " ".join(_text(text).split()).replace("|", "&#124;"))


def _parameter(one: argparse.Action) -> str:
    return ", ".join(f"`{name}`" for name in one.option_strings or [one.metavar])


def write_tasks(folder: Path) -> None:
    """Write the page of tasks: each file of `examples/tasks`, scenes with the picture of their answer."""
    folder.mkdir(parents=True, exist_ok=True)
    tasks, parts = ROOT / "examples" / "tasks", ["# Tasks of ten lines"]
    parts.append("The pictures are those of `contact-verify solve FILE.toml --write FILE.svg`.")
    for file in sorted(tasks.glob("*.toml")):
        text = file.read_text(encoding="utf-8").partition("\n")[2]
        parts += [f"## {file.stem.replace('_', ' ')}", f"```toml\n{text}```", _picture(file, folder)]
    for file in sorted(tasks.glob("*.py")):
        text = file.read_text(encoding="utf-8")
        parts += [f"## {file.stem.replace('_', ' ')}", f"```python\n{text}```", _printed(file.name)]
    (folder / "index.md").write_text("\n\n".join(filter(None, parts)) + "\n", encoding="utf-8")


def _printed(name: str) -> str:
    """What a script prints, as the page of the folder has it; a test runs each."""
    page = (ROOT / "examples" / "tasks" / "README.md").read_text(encoding="utf-8")
    found = re.search(rf"`{name}`[^\n]*\n(```text\n.*?```)", page, re.DOTALL)
    return found[1] if found else ""


def _picture(file: Path, folder: Path) -> str:
    """The picture of a scene's answer, as `solve --write` draws it, written into the folder."""
    scene, method = load_scene(file), Mdr(accuracy=1e-4)
    answer, finer = method.solve(scene), between(scene)
    with figure_style():
        drawn = solution_figure(answer, None if finer is None else method.solve(finer))
        (folder / f"{file.stem}.svg").write_text(svg_text(drawn, key=file.stem), encoding="utf-8")
    return f"![{file.stem.replace('_', ' ')}]({file.stem}.svg)"


def write_equations(root: Path, page: Path) -> None:
    """Write the table of equations of the paper and the modules under `root` that cite them."""
    page.parent.mkdir(parents=True, exist_ok=True)
    modules: dict[int, dict[str, None]] = {}
    for package in SOLVERS:
        for path in sorted((root / package).rglob("*.py")):
            for number in _cited(path.read_text(encoding="utf-8")):
                modules.setdefault(number, {})[path.relative_to(root).as_posix()] = None
    rows = "".join(
        f"| ({number}) | {', '.join(f'`{file}`' for file in modules[number])} |\n" for number in sorted(modules)
    )
    page.write_text(f"| equation | modules |\n|---|---|\n{rows}", encoding="utf-8")


def _cited(text: str) -> set[int]:
    """The numbers of the equations that a text cites; "(36) to (38)" names three."""
    numbers: set[int] = set()
    for first, last, other in CITED.findall(text):
        numbers |= set(range(int(first), int(last or first) + 1)) | ({int(other)} if other else set())
    return numbers


class Compared(NamedTuple):
    """One quantity of one method and scene: unit-free stated error, and difference from MDR with MDR's own."""

    method: str
    quantity: str
    stated: float
    difference: float | None
    stated_by_both: float


def accepted(case: str) -> Iterator[Compared]:
    """The accepted answers of a case, relative to the scale of each quantity."""
    file = ROOT / "baselines" / f"{case}.jsonl"
    answers = [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()[1:]]
    by_mdr = {answer["scene"]: answer["quantities"] for answer in answers if answer["method"] == "mdr"}
    for answer in answers:
        for name, one in answer["quantities"].items():
            if len(one.get("error", ())) != len(one["values"]) or not one["values"]:
                continue
            stated, other = max(one["error"]) / one["scale"], by_mdr.get(answer["scene"], {}).get(name)
            comparable = other and answer["method"] != "mdr" and len(other["values"]) == len(one["values"])
            if not comparable:
                yield Compared(answer["method"], name, stated, None, stated)
                continue
            pairs = zip(one["values"], other["values"], strict=True)
            change = max(abs(x - y) for x, y in pairs) / one["scale"]
            both = stated + max(other.get("error", [0.0])) / one["scale"]
            yield Compared(answer["method"], name, stated, change, both)


def write_case_figure(case: str, folder: Path) -> str:
    """Write the picture of differences from MDR of a case; returns its section, empty without a second method."""
    found = defaultdict(list)
    for one in accepted(case) if (ROOT / "baselines" / f"{case}.jsonl").is_file() else ():
        if one.difference is not None:
            found[one.method].append((max(one.stated_by_both, SMALLEST), max(one.difference, SMALLEST)))
    if not found:
        return ""
    with figure_style():
        (folder / f"{case}.svg").write_text(svg_text(_agreement(found), key=case), encoding="utf-8")
    text = "Accepted answers: each symbol is one quantity of one scene. Where methods agree it lies in the shaded half."
    return f"\n## Differences from MDR\n\n{text}\n\n![Differences from MDR over stated errors]({case}.svg)\n"


def _agreement(found: dict[str, list[tuple[float, float]]]) -> Figure:
    figure = Figure(figsize=(5.0, 3.8), layout="constrained")
    axes = figure.subplots()
    axes.set(xscale="log", yscale="log", xlabel="error stated by both, relative", ylabel="relative difference from MDR")
    for method, places in found.items():
        look, (x, y) = look_of(method), zip(*places, strict=True)
        label = display_name(method)
        axes.plot(x, y, look.marker, color=look.colour, markersize=4, markerfacecolor="none", label=label)
    ends = [SMALLEST / 3, 3 * max(max(place) for places in found.values() for place in places)]
    axes.fill_between(ends, ends, ends[0], color="#eef4ee", zorder=0.5)
    axes.set(xlim=ends, ylim=ends)
    mark_decades(axes.xaxis, axes.yaxis)
    figure.legend(loc="outside lower center", ncols=2)
    return figure


def write_accuracy(page: Path) -> None:
    """Write one table per method: stated errors and differences from MDR by quantity, over all accepted answers."""
    page.parent.mkdir(parents=True, exist_ok=True)
    found: dict[str, dict[str, list[Compared]]] = defaultdict(lambda: defaultdict(list))
    for file in sorted((ROOT / "baselines").glob("*.jsonl")):
        for one in accepted(file.stem):
            found[one.method][one.quantity].append(one)
    parts = []
    for method in sorted(found):
        rows = [_accuracy_row(name, values) for name, values in sorted(found[method].items()) if len(values) >= 3]
        if rows:
            head = "| quantity | answers | stated error | difference from MDR |"
            parts.append("\n".join([f"## {display_name(method)}\n", head, "|---|--:|--:|--:|", *rows]))
    page.write_text("\n\n".join(parts) + "\n", encoding="utf-8")


def _accuracy_row(name: str, values: Sequence[Compared]) -> str:
    stated, change = [one.stated for one in values], [one.difference for one in values if one.difference is not None]
    shown = f"{_small(median(change))}, {_small(max(change))}" if change else ""
    return f"| {name.replace('_', ' ')} | {len(values)} | {_small(median(stated))}, {_small(max(stated))} | {shown} |"


def _small(value: float) -> str:
    return "0" if value == 0 else f"{value:.0e}"
