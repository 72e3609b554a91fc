"""`contact-verify list`, `show` and `validate`: what the library of cases holds."""

from rich.padding import Padding
from rich.text import Text

from cases.declare.case import Case
from cases.declare.foreign_methods import with_registered
from cases.declare.registry import load_cases, select
from reports.tables.declaration_tables import claim_table, method_table, scene_table
from reports.tables.table import Table
from reports.terminal.terminal import console, show_table
from reports.words.method_names import display_name


def list_cases(suite: str) -> None:
    """Print the cases of a suite, or all."""
    cases = select(load_cases(), suite=suite)
    table = Table(
        title="",
        note="contact-verify show CASE prints one of them in full.",
        heads=("case", "suites", "methods", "scenes", "claims", "question"),
        rows=tuple(_line(case) for case in cases),
        words=6,
    )
    show_table(table, on=console())


def _line(case: Case) -> tuple[str, ...]:
    methods = ", ".join(display_name(use.label) for use in case.methods)
    return case.name, ", ".join(case.suites), methods, f"{len(case.scenes)}", f"{len(case.claims)}", case.question


def show_case(name: str) -> None:
    """Print a case as a short paper: question, equations, text, scenes, methods, claims."""
    (case,) = select(load_cases(), names=[name])
    terminal = console()
    terminal.print(Text(case.title, style="bold"))
    terminal.print(Text(f"{case.question}  [{', '.join(case.equations)}]\n"))
    for paragraph in case.text.split("\n\n"):
        terminal.print(Padding(Text(" ".join(paragraph.split())), (0, 0, 1, 0)))
    for table in (scene_table(case), method_table(case), claim_table(case)):
        show_table(table, on=terminal)
        terminal.print()


def validate_cases() -> None:
    """Load every case, with every installed method, and build its tasks; the first error ends it with exit code 4.

    Raises:
        InvalidInput: naming the case and what is wrong with it.
    """
    cases = {name: with_registered(case) for name, case in load_cases().items()}
    tasks = sum(1 for case in cases.values() for _ in case.tasks())
    claims = sum(len(case.claims) for case in cases.values())
    console().print(f"{len(cases)} cases, {claims} claims, {tasks} solutions: all valid")
