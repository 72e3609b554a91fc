"""`contact-verify paper-page`: the page of the paper's statements, with numbers computed now."""

from pathlib import Path

from cases.library._paper import statements
from cases.results.files import write_whole
from reports.pages.paper import paper_page
from reports.terminal.terminal import console


def write_page(out: Path) -> None:
    """Write the page, whole or not at all."""
    write_whole(out, paper_page(statements()))
    console().print(f"written: {out}", markup=False, highlight=False)
