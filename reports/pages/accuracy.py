"""The page `docs/accuracy.md`: stated errors and observed agreement, from accepted numbers and measurements."""

from collections.abc import Iterable, Sequence
from itertools import groupby
from operator import attrgetter

from cases.gate.accuracy_figures import AccuracyFigure, median_and_largest
from cases.measurements.evidence.records import Evidence, MeasuredSetting

HEAD = """\
# Accuracy

Written by `contact-verify accuracy-page` from the accepted numbers in `baselines/` and the measurements behind
`contact-verify solve --accuracy`; do not edit.
All errors are relative; "median, largest" are over the states of all accepted scenes of a case. Prescribed quantities
have no error and no row. `mdr` is compared with `fem`, which shares no code with it; every other method with `mdr`.
"Within both" counts the states where the difference is no larger than the two stated errors together (differences
below 2e-14 are rounding). Along a detachment each method chooses its own states: only its pull-off is compared.
"""
EVIDENCE = """\
## Random scenes
Settings on random scenes of one kind (`contact-verify calibrate`, seed {seed}, {machine}, revision {revision:.12}).
The error of a scene is the larger of what the answer states and of what an independent reference finds, its own
uncertainty added. Seconds are the median processor time of a first solution.
"""


def accuracy_page(figures: Iterable[AccuracyFigure], evidence: Evidence) -> str:
    """The whole page in Markdown."""
    parts = [HEAD]
    for case, rows in groupby(figures, key=attrgetter("case")):
        parts += [f"## {case}", figure_table(rows)]
    said = EVIDENCE.format(seed=evidence.seed, machine=evidence.machine, revision=evidence.revision)
    ordered = sorted(evidence.measurements, key=lambda m: (m.kind, m.method, m.band, -m.typical))
    return "\n".join([*parts, said, _table(_EVIDENCE_HEAD, [_measured_row(m) for m in ordered])])


_FIGURE_HEAD = ("method", "quantity", "states", "stated: median, largest", "difference: median, largest", "within both")
_EVIDENCE_HEAD = (
    "scenes",
    "a/h up to",
    "method",
    "settings",
    "answered",
    "refused",
    "error: median, largest",
    "seconds",
)


def figure_table(figures: Iterable[AccuracyFigure]) -> str:
    """Stated errors and differences, one row a method and quantity."""
    return _table(_FIGURE_HEAD, [_figure_row(row) for row in figures])


def _figure_row(row: AccuracyFigure) -> list[str]:
    within = f"{row.within} of {len(row.differences)} ({row.partner})" if row.differences else ""
    stated, apart = _range(row.stated), _range(row.differences)
    return [row.method, row.quantity, str(len(row.stated)), stated or "none", apart or "not compared", within]


def _measured_row(m: MeasuredSetting) -> list[str]:
    settings = ", ".join(f"{name} = {value}" for name, value in sorted(m.settings.items()))
    counts = [str(len(m.bounds)), str(m.refused)]
    return [m.kind, f"{m.band:g}", m.method, settings, *counts, _range(m.bounds), f"{m.seconds:.2g}"]


def _range(errors: tuple[float, ...]) -> str:
    ends = median_and_largest(errors)
    return "" if ends is None else ", ".join(f"{end:.0e}" if end else "0" for end in ends)


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)
