"""Pages of the documentation that are written from the cases, one per case, and the tables of a case in words."""

from collections.abc import Iterable
from pathlib import Path

from cases.case import Case, CaseScene
from cases.claims import Claim, Study
from contact.files.whole import write_whole
from reports.words import Table, display_name, file_name, markdown_table, small

HEAD = """\
# Verification book

One page per case: the question, the scenes, what is claimed and why. Nothing is computed for these pages: they come
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
    body = markdown_table(table.heads, ([cell.replace("|", "&#124;") for cell in row] for row in table.rows))
    return f"## {table.title}\n\n{body}\n{table.note}".rstrip()


def scene_table(case: Case) -> Table:
    """The scenes with their parameters and the methods that solve them."""
    names = tuple(dict.fromkeys(name for scene in case.scenes for name in scene.parameters))
    rows = tuple(
        (scene.name, *(f"{scene.parameters.get(name, '')}" for name in names), _solvers(case, scene))
        for scene in case.scenes
    )
    note = "In brackets: in the nightly suite only."
    return Table(title="Scenes", note=note, heads=("scene", *names, "methods"), rows=rows, words=2 + len(names))


def _solvers(case: Case, scene: CaseScene) -> str:
    names = ((use.label, display_name(use.label)) for use in case.methods_of(scene))
    return ", ".join(f"({name})" if label in scene.nightly else name for label, name in names)


def method_table(case: Case) -> Table:
    """The methods with the settings that differ from their defaults."""
    rows = tuple(
        (display_name(use.label), ", ".join(f"{name} = {value}" for name, value in use.settings.items()) or "defaults")
        for use in case.methods
    )
    return Table(title="Methods", note="", heads=("method", "settings"), rows=rows, words=2)


def claim_table(case: Case) -> Table:
    """The claims with tolerance, reason and origin, and the studies of cost, effects and hard parameters by name."""
    heads = ("kind", "claim", "quantity", "tolerance", "expected because", "tolerance from", "origin")
    return Table(
        title="Claims",
        note="",
        heads=heads,
        rows=tuple(map(_claim_row, case.claims)),
        words=7,
    )


def _claim_row(claim: Study) -> tuple[str, ...]:
    """Cells of a claim, or of a study, which has neither tolerance nor reason."""
    if not isinstance(claim, Claim):
        return claim.kind, claim.name, getattr(claim, "quantity", ""), "", "", "", ""
    why = claim.why
    names = (str(claim.kind), claim.name, claim.quantity, small(claim.tolerance))
    return *names, why.because, why.tolerance, f"{why.origin}: {why.source}"
