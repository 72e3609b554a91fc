"""`contact-verify solve`: one scene, one trustworthy answer with its error bar."""

from pathlib import Path

from cases.methods import build
from contact import InvalidInput, Solution, load_scene
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
    solver = build(method, {} if accuracy is None else {"accuracy": accuracy})
    solution = solver.solve(scene)
    terminal = console()
    show_table(solution_table(solution), on=terminal)
    show_facts(solution_facts(solution), on=terminal)
    for path in outputs:
        _write(solution, path)
        terminal.print(f"written: {path}")


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
