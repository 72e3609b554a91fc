"""`contact-verify list`, `show` and `validate`: what the library of cases holds."""

from rich.padding import Padding
from rich.text import Text

from cases.declare.case import Case, CaseScene, ClaimOfCase
from cases.declare.foreign_methods import with_registered
from cases.declare.registry import load_cases, select
from reports.tables.table import Table
from reports.terminal.terminal import console, show_table
from reports.words.method_names import display_name
from reports.words.numbers import small


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


def scene_table(case: Case) -> Table:
    """The scenes with the parameters that set them apart, and who solves them."""
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
    """The claims with tolerance, reason and origin."""
    heads = ("kind", "claim", "quantity", "tolerance", "expected because", "tolerance from", "origin")
    return Table(title="Claims", note="", heads=heads, rows=tuple(_claim_row(c) for c in case.claims), words=7)


def _claim_row(claim: ClaimOfCase) -> tuple[str, ...]:
    reason = claim.reason
    origin = f"{reason.origin}: {reason.source}"
    names = (str(claim.kind), claim.name, claim.quantity, small(claim.tolerance))
    return *names, reason.because, reason.derived_from, origin


def validate_cases() -> None:
    """Load every case, with every installed method, and build its tasks; the first error ends it with exit code 4.

    Raises:
        InvalidInput: naming the case and what is wrong with it.
    """
    cases = {name: with_registered(case) for name, case in load_cases().items()}
    tasks = sum(1 for case in cases.values() for _ in case.tasks())
    claims = sum(len(case.claims) for case in cases.values())
    console().print(f"{len(cases)} cases, {claims} claims, {tasks} solutions: all valid")
