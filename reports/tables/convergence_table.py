"""All studies of convergence of a run in one table: observed order beside formal order, error bars beside errors."""

from collections.abc import Iterator

from cases.results.records.convergence import ConvergenceStudy
from cases.results.records.run import RunResult
from reports.words import Table, display_name, small

NOTE = (
    "Order: of the errors against the reference where one is exact enough, else of the values. Asymptotic: whether the "
    "finest grids show a stable or the formal order. Estimated and stated: error suggested by the refinements (grid "
    "convergence index) and stated by the method, over the true error of the finest grid; from 1 on they cover it. "
    "Convergence that is exponential has digits per refinement in place of an order."
)
HEADS = (
    "quantity",
    "scene",
    "method",
    "refined",
    "reference",
    "formal",
    "observed",
    "asymptotic",
    "finest error",
    "estimated",
    "stated",
)


def orders(run: RunResult) -> Table | None:
    """One row a study, under the title of its case; None without any."""
    rows: list[tuple[str, ...]] = []
    for case in (case for case in run.cases if case.convergence):
        rows += [(case.title,), *map(_row, case.convergence)]
    count = sum(len(case.convergence) for case in run.cases)
    return (
        Table(title=f"{count} studies of convergence", note=NOTE, heads=HEADS, rows=tuple(rows), words=5)
        if rows
        else None
    )


def _row(study: ConvergenceStudy) -> tuple[str, ...]:
    names = study.quantity.replace("_", " "), study.scene, display_name(study.method), study.mesh_family
    reference = display_name(study.reference_source) if study.reference is not None else "none"
    return *names, reference, *_speed(study), *_errors(study)


def _speed(study: ConvergenceStudy) -> tuple[str, str, str]:
    """Formal order, observed order, asymptotic range."""
    if study.formal_order is None:
        digits = study.digits_per_refinement
        return "exponential", "" if digits is None else f"{digits:.1f} digits", ""
    observed = str(study.kind) if study.observed_order is None else f"{study.observed_order:.2f}"
    return f"{study.formal_order:g}", observed, {True: "yes", False: "no", None: ""}[study.asymptotic]


def _errors(study: ConvergenceStudy) -> Iterator[str]:
    """Error of the finest grid, relative; estimated and stated ones over it."""
    finest = study.grids[0]
    if not finest.error:
        yield from ("", "", "")
        return
    yield small(finest.error / study.scale)
    yield f"{finest.gci * study.scale / finest.error:.2g}" if finest.gci else ""
    yield f"{finest.stated / finest.error:.2g}" if finest.stated else ""
