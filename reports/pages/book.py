"""Pages of the documentation that are written from the project: a page a case, and where each equation stands."""

import re
from collections.abc import Iterable
from pathlib import Path

from cases.declare.case import Case
from cases.results.files import write_whole
from reports.tables.declaration_tables import claim_table, method_table, scene_table
from reports.words import Table, file_name

SOLVERS = ("contact", "bem", "mdr", "fem_reference")
CITED = re.compile(r"Eqs?\. \((\d+)\)(?: to \((\d+)\))?(?:, \((\d+)\))?")

HEAD = """\
# Verification book

One page a case: the question, the scenes, what is claimed and why. Nothing is computed for these pages: they come
from the declarations of the cases.

```{toctree}
:maxdepth: 1

"""


def write_book(cases: Iterable[Case], folder: Path) -> None:
    """Write the contents and a page for each case into `folder`, which is made."""
    folder.mkdir(parents=True, exist_ok=True)
    names = []
    for case in cases:
        names.append(file_name(case.name))
        write_whole(folder / f"{names[-1]}.md", case_page(case))
    write_whole(folder / "index.md", HEAD + "\n".join(names) + "\n```\n")


def case_page(case: Case) -> str:
    """The page of a case as Markdown."""
    parts = [f"# {case.title}", f"**{case.question}** {', '.join(case.equations)}".rstrip(), case.text.strip()]
    parts += [_section(table) for table in (scene_table(case), method_table(case), claim_table(case)) if table.rows]
    return "\n\n".join(parts) + "\n"


def _section(table: Table) -> str:
    """A table under its heading."""
    lines = [table.heads, ["---"] * len(table.heads), *table.rows]
    body = "".join(f"| {' | '.join(cell.replace('|', '&#124;') for cell in line)} |\n" for line in lines)
    return f"## {table.title}\n\n{body}\n{table.note}".rstrip()


def write_equations(root: Path, page: Path) -> None:
    """Write the table of equations of the paper and the modules under `root` that cite them."""
    page.parent.mkdir(parents=True, exist_ok=True)
    found: dict[int, dict[str, None]] = {}
    for package in SOLVERS:
        for path in sorted((root / package).rglob("*.py")):
            for number in _cited(path.read_text(encoding="utf-8")):
                found.setdefault(number, {})[path.relative_to(root).as_posix()] = None
    rows = "".join(f"| ({number}) | {', '.join(f'`{file}`' for file in found[number])} |\n" for number in sorted(found))
    write_whole(page, f"| equation | modules |\n|---|---|\n{rows}")


def _cited(text: str) -> set[int]:
    """The numbers of the equations that a text cites; "(36) to (38)" names three."""
    numbers: set[int] = set()
    for first, last, other in CITED.findall(text):
        numbers |= set(range(int(first), int(last or first) + 1)) | ({int(other)} if other else set())
    return numbers
