"""`contact-verify solve`: one scene, one trustworthy answer with its error bar."""

import inspect
from pathlib import Path

import numpy as np

from cases.methods import build, load
from contact import InvalidInput, Method, NotConvergedError, Solution, load_scene
from reports.solution_table import solution_csv, solution_facts, solution_table
from reports.terminal import console, show_facts, show_table

ENDINGS = {".csv": "CSV", ".h5": "HDF5", ".svg": "SVG"}


def solve(scene_file: Path, *, method: str, accuracy: float | None, outputs: list[Path]) -> None:
    """Solve the scene of a TOML file, print the answer and write it to `outputs`, whose endings choose the format.

    Raises:
        InvalidInput: for a wrong scene, method or ending; before anything is solved.
    """
    for path in outputs:
        _check_ending(path)
    scene = load_scene(scene_file)
    solution = _solver(method, accuracy).solve(scene)
    if accuracy is not None:
        _refuse_less(solution, accuracy)
    terminal = console()
    show_table(solution_table(solution), on=terminal)
    show_facts(solution_facts(solution), on=terminal)
    for path in outputs:
        _write(solution, path)
        terminal.print(f"written: {path}")


def _solver(name: str, accuracy: float | None) -> Method:
    """The method, with the accuracy as a setting where it has such a setting."""
    if accuracy is not None and not 0.0 < accuracy < 1.0:
        raise InvalidInput(f"--accuracy {accuracy:g}: a relative accuracy lies between 0 and 1")
    settable = "accuracy" in inspect.signature(load(name)).parameters
    return build(name, {"accuracy": accuracy} if settable and accuracy is not None else {})


def _refuse_less(solution: Solution, accuracy: float) -> None:
    """Refuse an answer whose own error estimate is larger than what was asked for."""
    estimate = float(np.max(solution.error_estimate.get("normal_force", np.inf)))
    if estimate > accuracy:
        raise NotConvergedError(
            f"{solution.method} estimates the relative error of its force at {estimate:.1e}, asked for {accuracy:.1e}; "
            "name another method with --method, or ask for less"
        )


def _check_ending(path: Path) -> None:
    if path.suffix not in ENDINGS:
        known = ", ".join(f"{ending} ({name})" for ending, name in ENDINGS.items())
        raise InvalidInput(f"--write {path}: the ending says the format; use one of {known}")


def _write(solution: Solution, path: Path) -> None:
    if path.suffix == ".csv":
        path.write_text(solution_csv(solution), encoding="utf-8")
    elif path.suffix == ".h5":
        from contact.storage import save_solution  # noqa: PLC0415 - h5py only where it is asked for

        save_solution(path, solution)
    else:
        from reports.charts.solution import solution_figure  # noqa: PLC0415 - Matplotlib only where it is asked for
        from reports.drawing import figure_svg  # noqa: PLC0415 - as above

        path.write_text(figure_svg(solution_figure(solution)), encoding="utf-8")
