"""`contact-verify solve`: one scene, one trustworthy answer with its error bar."""

import inspect
from pathlib import Path

from cases.declare.guarded_method import build_guarded
from cases.declare.methods import load
from cases.declare.uncertain_inputs import UncertainInputs, read_inputs
from contact import (
    ContactPath,
    InvalidInput,
    Method,
    NotConvergedError,
    Scene,
    Solution,
    Tabulated,
    UnsupportedSceneError,
    load_scene,
)
from contact.answer.accuracy import shortfalls, told_where_less
from contact.answer.small_strains import depth_note, depths_of
from contact.files.scene_file import scene_notes, uses_units
from reports.tables.solution_table import solution_csv, solution_facts, solution_table
from reports.terminal.terminal import console, show_facts, show_table
from reports.words.numbers import with_prefix

ENDINGS = {".csv": "CSV", ".h5": "HDF5", ".svg": "SVG", ".vtu": "VTU for ParaView", ".xdmf": "XDMF for ParaView"}
MESHES = (".vtu", ".xdmf")
# A picture of that name shows the layer inside, by these two methods where both model the scene.
INSIDE = "inside"
SHOWN_BESIDE = {"fem": "mdr"}


def solve(
    scene_file: Path,
    *,
    method: str,
    accuracy: float | None,
    outputs: list[Path],
    pressure_accuracy: float | None = None,
    uncertain: str = "",
    samples: int = 0,
) -> None:
    """Solve the scene of a TOML file, print the answer and write it to `outputs`, whose endings choose the format.

    With an accuracy and no method, methods are tried from cheap to fine.

    Raises:
        InvalidInput: for a wrong scene, method or ending; before anything is solved.
    """
    for path in outputs:
        _check_ending(path)
    _check_accuracies(accuracy, pressure_accuracy)
    if samples and not uncertain:
        raise InvalidInput("--samples: of what? name the inputs with --uncertain")
    scene = load_scene(scene_file)
    if uncertain:
        inputs = read_inputs(uncertain, scene, with_units=uses_units(scene_file))
        answer = _solve_uncertain(scene, inputs, samples, _solver(method or "mdr", accuracy, pressure_accuracy))
        _write_all(answer, outputs)
        return
    facts: list[tuple[str, str]] = []
    if accuracy is not None and not method:
        from cases.measurements.accuracy import solve as solve_to_accuracy  # noqa: PLC0415 - only where it is asked for

        found = solve_to_accuracy(scene, accuracy=accuracy, pressure_accuracy=pressure_accuracy)
        solution: Solution = found.answer
        facts = [("achieved", f"stated error {found.stated_error:.1e}, asked for {accuracy:g}, by {found.method}")]
    else:
        solution = _solver(method or "mdr", accuracy, pressure_accuracy).solve(scene)
        if accuracy is not None:
            _refuse_less(solution, accuracy, pressure_accuracy)
            solution = told_where_less(solution, accuracy, pressure_accuracy)
    terminal = console()
    _show_answer(solution)
    show_facts(solution_facts(solution) + facts + _notes(scene_file, solution), on=terminal)
    _write_all(solution, outputs)


def _show_answer(solution: Solution) -> None:
    """The table, below a warning where the layer is pressed deeper than small strains allow."""
    warning = depth_note(solution.scene, depths_of(solution))
    show_facts([("warning", warning)] if warning else [], on=console())
    show_table(solution_table(solution), on=console())


def _notes(scene_file: Path, solution: Solution) -> list[tuple[str, str]]:
    """How the file was read, what smoothing a tip may move, and how far the theory reaches."""
    from cases.measurements.advice import validity_lines  # noqa: PLC0415 - MDR only where it is asked for

    lines = scene_notes(scene_file)
    indenter = solution.scene.indenter
    if isinstance(indenter, Tabulated) and indenter.smoothing and isinstance(solution, ContactPath):
        moved = float(solution.contact_stiffness.max()) * indenter.smoothing
        lines.append(
            f"smoothing moved the tip by at most {with_prefix(indenter.smoothing, 'm')}, and so the force by at most "
            f"about {with_prefix(moved, 'N')}"
        )
    told = [("note", line) for line in lines]
    return told + [("validity", line) for line in validity_lines(solution.scene, solution)]


def _write_all(solution: Solution, outputs: list[Path]) -> None:
    for path in outputs:
        _write(solution, path)
        console().print(f"written: {path}")


def _solve_uncertain(scene: Scene, uncertain: UncertainInputs, samples: int, method: Method) -> Solution:
    """Solve a scene with uncertain inputs, print what they make of the answer, and return the one at their middle."""
    from cases.run.propagation import propagate  # noqa: PLC0415 - only where it is asked for
    from reports.tables.uncertain_tables import propagated_table  # noqa: PLC0415 - as above

    found = propagate(scene, uncertain, method=method, samples=samples)
    _show_answer(found.answer)
    show_table(propagated_table(found), on=console())
    return found.answer


def _check_accuracies(accuracy: float | None, pressure_accuracy: float | None) -> None:
    for name, wanted in (("accuracy", accuracy), ("pressure-accuracy", pressure_accuracy)):
        if wanted is not None and not 0.0 < wanted < 1.0:
            raise InvalidInput(f"--{name} {wanted:g}: a relative accuracy lies between 0 and 1")
    if pressure_accuracy is not None and accuracy is None:
        raise InvalidInput("--pressure-accuracy is asked besides an --accuracy of the numbers; give both")


def _solver(name: str, accuracy: float | None, pressure_accuracy: float | None) -> Method:
    """The method, with the accuracies as settings where it has such settings."""
    asked = {"accuracy": accuracy, "pressure_accuracy": pressure_accuracy}
    settable = inspect.signature(load(name)).parameters
    return build_guarded(name, {key: value for key, value in asked.items() if key in settable and value is not None})


def _refuse_less(solution: Solution, accuracy: float, pressure_accuracy: float | None) -> None:
    """Refuse an answer that states a larger error than was asked for of what was asked, or none at all."""
    less = shortfalls(solution, accuracy, pressure_accuracy)
    if less:
        worst = max(less, key=lambda name: less[name])
        wanted = pressure_accuracy if worst == "pressure" else accuracy
        raise NotConvergedError(
            f"{solution.method} estimates the relative error of {worst.replace('_', ' ')} at {less[worst]:.1e}, asked "
            f"for {wanted:.1e}; name another method with --method, or ask for less"
        )


def _check_ending(path: Path) -> None:
    if path.suffix not in ENDINGS:
        known = ", ".join(f"{ending} ({name})" for ending, name in ENDINGS.items())
        raise InvalidInput(f"--write {path}: the ending says the format; use one of {known}")
    if path.is_dir() or not path.parent.is_dir():
        raise InvalidInput(f"--write {path}: no file can be there; check that the folder exists")


def _put(path: Path, content: str | bytes) -> None:
    from cases.results.files import write_whole  # noqa: PLC0415 - runs and their storage only where a file is written

    write_whole(path, content)


def _write(solution: Solution, path: Path) -> None:
    if path.suffix == ".csv":
        _put(path, solution_csv(solution))
    elif path.suffix == ".h5":
        solution.save(path)
    elif path.suffix in MESHES:
        _write_mesh(solution, path)
    elif path.stem.startswith(INSIDE):
        from reports.charts.inside import inside_svg  # noqa: PLC0415 - as below

        _put(path, inside_svg(solution, _compared(solution)))
    else:
        from reports.charts.solution import between, solution_figure  # noqa: PLC0415 - Matplotlib only where it is asked for
        from reports.figures.renderer import figure_svg  # noqa: PLC0415 - as above

        _put(path, figure_svg(solution_figure(solution, _between(solution, between(solution.scene)))))


def _write_mesh(solution: Solution, path: Path) -> None:
    """The fields inside on the mesh that solved the last state of a path."""
    write = getattr(solution.inside(-1).fields, "write", None) if isinstance(solution, ContactPath) else None
    if write is None:
        raise InvalidInput(
            f"--write {path}: {solution.method} has no mesh of this scene; add --method fem, or take .csv"
        )
    write(path)


def _between(solution: Solution, finer: Scene | None) -> Solution | None:
    """The answer by MDR with states between the prescribed ones; None for other methods, which take longer."""
    if finer is None or solution.method != "mdr":
        return None
    try:
        return build_guarded(solution.method, {}).solve(finer)
    except (UnsupportedSceneError, NotConvergedError):
        return None


def _compared(solution: Solution) -> Solution | None:
    """The scene by a second method, where that models it."""
    try:
        return build_guarded(SHOWN_BESIDE.get(solution.method, "fem"), {}).solve(solution.scene)
    except (UnsupportedSceneError, NotConvergedError):
        return None
