"""`contact-verify accuracy-page`: the page of accuracy figures, from stored numbers alone."""

from pathlib import Path

from cases.gate.accuracy_figures import accuracy_figures
from cases.gate.baseline import read_baselines
from cases.measurements.evidence.records import shipped
from cases.results.files import write_whole
from contact import InvalidInput
from reports.pages.accuracy import accuracy_page
from reports.terminal.terminal import console


def current_page(baselines: Path) -> str:
    """The page as the accepted numbers give it now.

    Raises:
        InvalidInput: If the folder holds no accepted numbers.
    """
    accepted = read_baselines(baselines)
    if not accepted:
        raise InvalidInput(f"{baselines}: no accepted numbers here; name the folder with --baseline")
    return accuracy_page(accuracy_figures(accepted), shipped())


def write_page(baselines: Path, out: Path) -> None:
    """Write the page, whole or not at all."""
    write_whole(out, current_page(baselines))
    console().print(f"written: {out}", markup=False, highlight=False)
