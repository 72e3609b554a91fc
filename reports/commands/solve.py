"""`contact-verify solve`: one scene, one answer with its error estimates; or a range, uncertain inputs, advice."""

import inspect
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cases.accuracy import solve as solve_to_accuracy
from cases.declare.guarded_method import build_guarded
from cases.declare.methods import load
from cases.declare.uncertain_inputs import read_inputs
from cases.sweep import read_range, sweep
from cases.validity import validity_lines
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
from contact.answer.accuracy import shortfalls, with_accuracy_note
from contact.answer.small_strains import depth_note, depth_share, depths_of
from contact.files.scene_file import uses_units
from reports.answer import (
    critical_facts,
    difference_table,
    propagated_table,
    solution_csv,
    solution_facts,
    solution_notes,
    solution_table,
    sweep_table,
)
from reports.files import PICTURES, Writers, check_outputs, csv_writer, picture_writers, write_outputs, write_picture
from reports.terminal import console, progress_bar, show_facts, show_table
from reports.words import small, with_prefix

MESHES = {".vtu": "VTU for ParaView", ".xdmf": "XDMF for ParaView"}
ENDINGS = {".csv": "CSV", ".h5": "HDF5", **PICTURES, **MESHES}
# A picture of this name shows the layer inside, by MDR and finite elements where both model the scene.
INSIDE = "inside"
OTHER_METHOD = {"fem": "mdr"}
# Accuracy of advice where none is given.
ADVISED_AT = 1e-2


@dataclass(frozen=True, kw_only=True)
class Request:
    """Options of `contact-verify solve`.

    Attributes:
        method: Name of the method, empty for the default.
        accuracy: Relative accuracy of the numbers, or None.
        pressure_accuracy: Relative accuracy of the pressure, or None.
        uncertain: Uncertain inputs in words, or empty.
        samples: Number of scenes to draw for uncertain inputs, 0 for differences.
        over: Number that is varied and its range in words, or empty.
        advise: Whether effects are left out in turn.
        against: Name of a second method, or empty.
        outputs: Files to write.
    """

    method: str = ""
    accuracy: float | None = None
    pressure_accuracy: float | None = None
    uncertain: str = ""
    samples: int = 0
    over: str = ""
    advise: bool = False
    against: str = ""
    outputs: Sequence[Path] = ()

    def check(self) -> None:
        """Refuse wrong values and combinations of options, before anything is solved.

        Raises:
            InvalidInput: For a wrong accuracy, file or combination.
        """
        check_outputs(self.outputs, {".csv": "CSV", **PICTURES} if self.over else ENDINGS)
        for name, wanted in (("accuracy", self.accuracy), ("pressure-accuracy", self.pressure_accuracy)):
            if wanted is not None and not 0.0 < wanted < 1.0:
                raise InvalidInput(f"--{name} {wanted:g}: a relative accuracy lies between 0 and 1")
        if self.pressure_accuracy is not None and self.accuracy is None:
            raise InvalidInput("--pressure-accuracy is asked besides an --accuracy of the numbers; give both")
        if self.samples and not self.uncertain:
            raise InvalidInput("--samples: of what? name the inputs with --uncertain")
        if self.advise and self.outputs:
            raise InvalidInput("--write: --advise writes no file; leave one of them out")
        if self.over and self.accuracy is not None:
            raise InvalidInput("--accuracy: --over states the error of each answer instead; leave one of them out")
        modes = ("over", "advise", "uncertain", "against")
        several = [f"--{name}" for name in modes if getattr(self, name)]
        if len(several) > 1:
            raise InvalidInput(f"{' and '.join(several)}: ask one at a time")

    def solver(self) -> Method:
        """The method, with the accuracies as settings where it has such settings."""
        name = self.method or "mdr"
        accuracies = {"accuracy": self.accuracy, "pressure_accuracy": self.pressure_accuracy}
        settable = inspect.signature(load(name)).parameters
        settings = {key: value for key, value in accuracies.items() if key in settable and value is not None}
        return build_guarded(name, settings)


def solve(scene_file: Path, **options: Any) -> None:
    """Solve the scene of a TOML file, print the answer, and write the files, as the options of `Request` say.

    Raises:
        InvalidInput: For a wrong scene, method or ending; before anything is solved.
    """
    request = Request(**options)
    request.check()
    scene = load_scene(scene_file)
    if request.advise:
        _advise(scene, request)
    elif request.over:
        _sweep(scene, scene_file, request)
    else:
        solution = _uncertain(scene, scene_file, request) if request.uncertain else _answer(scene, request)
        write_outputs(request.outputs, _writers(solution))


def _answer(scene: Scene, request: Request) -> Solution:
    """Solve and print the answer, and its differences from a second method where one is named."""
    with progress_bar("solving"):
        solution, facts = _solved(scene, request)
        other = build_guarded(request.against, {}).solve(scene) if request.against else None
        facts = solution_facts(solution) + facts + _notes(solution)
    _show_answer(solution)
    if other is not None:
        show_table(difference_table(solution, other), on=console())
    show_facts(facts, on=console())
    return solution


def _solved(scene: Scene, request: Request) -> tuple[Solution, list[tuple[str, str]]]:
    """The answer and facts about it; with an accuracy and no method, methods are tried from cheap to fine."""
    if request.accuracy is None or request.method:
        return _accurate(request.solver().solve(scene), request), []
    reached = solve_to_accuracy(scene, accuracy=request.accuracy, pressure_accuracy=request.pressure_accuracy)
    stated = f"stated error {small(reached.stated_error)}, asked for {small(request.accuracy)}, by {reached.method}"
    return reached.answer, [("achieved", stated)]


def _show_answer(solution: Solution) -> None:
    """Warnings and notes, critical numbers, and the table."""
    show_facts(solution_notes(solution) + critical_facts(solution), on=console())
    show_table(solution_table(solution), on=console())


def _notes(solution: Solution) -> list[tuple[str, str]]:
    """Notes on the effect of a smoothed tip, and on the validity of the theory."""
    notes: list[tuple[str, str]] = []
    indenter = solution.scene.indenter
    if isinstance(indenter, Tabulated) and indenter.smoothing and isinstance(solution, ContactPath):
        force_change = float(solution.contact_stiffness.max()) * indenter.smoothing
        tip = f"smoothing changed the tip by at most {with_prefix(indenter.smoothing, 'm')}"
        notes = [("note", f"{tip}, and so the force by at most about {with_prefix(force_change, 'N')}")]
    return notes + [("validity", line) for line in validity_lines(solution.scene, solution)]


def _accurate(solution: Solution, request: Request) -> Solution:
    """The answer with a note on quantities less accurate than asked for, if the request has an accuracy.

    Raises:
        NotConvergedError: If the answer states a larger error of its numbers or its pressure, or none at all.
    """
    if request.accuracy is None:
        return solution
    if too_large := shortfalls(solution, request.accuracy, request.pressure_accuracy):
        worst = max(too_large, key=lambda name: too_large[name])
        wanted = request.pressure_accuracy if worst == "pressure" else request.accuracy
        raise NotConvergedError(
            f"{solution.method} estimates the relative error of {worst.replace('_', ' ')} at {too_large[worst]:.1e}, "
            f"asked for {wanted:.1e}; name another method with --method, or ask for less"
        )
    return with_accuracy_note(solution, request.accuracy, request.pressure_accuracy)


def _uncertain(scene: Scene, scene_file: Path, request: Request) -> Solution:
    """Print the effect of uncertain inputs on the answer, and return the answer at their middle."""
    from cases.run.propagation import propagate  # noqa: PLC0415 - loaded only for this option

    inputs = read_inputs(request.uncertain, scene, with_units=uses_units(scene_file))
    with progress_bar("solving"):
        propagated = propagate(scene, inputs, method=request.solver(), samples=request.samples)
    answer = _accurate(propagated.answer, request)
    _show_answer(answer)
    show_table(propagated_table(propagated), on=console())
    return answer


def _advise(scene: Scene, request: Request) -> None:
    """Print which effects, and whether the finite thickness, change the answer by more than the accuracy."""
    from cases.advice import advise  # noqa: PLC0415 - loaded only for this option

    with progress_bar("solving without each effect"):
        lines = advise(build_guarded(request.method or "mdr", {}), scene, request.accuracy or ADVISED_AT).lines
    for line in lines:
        console().print(line, soft_wrap=True)


def _sweep(scene: Scene, scene_file: Path, request: Request) -> None:
    """Solve the scene over a range of one of its numbers, print the table and write the files.

    Raises:
        InvalidInput: If every value is refused.
    """
    swept = read_range(request.over, scene, with_units=uses_units(scene_file))
    with progress_bar("solving") as progress:
        result = sweep(scene, swept, request.solver(), progress)
    if not result.answers:
        raise InvalidInput(f"over {request.over}: no value was answered; the first refusal: {result.refused[0][1]}")
    pressed = [(answer.scene, depths_of(answer)) for _, answer in result.answers]
    note = depth_note(*max(pressed, key=lambda pair: depth_share(*pair)))
    show_facts([("warning", f"at its deepest, {note}")] * bool(note), on=console())
    show_table(sweep_table(result), on=console())
    show_facts([("refused", f"{value:g}: {reason}") for value, reason in result.refused], on=console())
    pictures = picture_writers(lambda: _pictures().sweep_figure(result), key="sweep")
    write_outputs(request.outputs, {**csv_writer(result.to_csv), **pictures})


def _pictures() -> Any:
    from reports import pictures  # noqa: PLC0415 - Matplotlib is loaded only for pictures

    return pictures


def _writers(solution: Solution) -> Writers:
    """Writers of an answer by the ending of a file."""

    def mesh(path: Path) -> None:
        """Write the fields on a mesh."""
        write = getattr(solution.inside(-1).fields, "write", None) if isinstance(solution, ContactPath) else None
        if write is None:
            raise InvalidInput(
                f"--write {path}: {solution.method} has no mesh of this scene; add --method fem, or take .csv"
            )
        write(path)

    def picture(path: Path) -> None:
        """Draw the fields inside where the name says so, else the answer."""
        if path.stem.startswith(INSIDE):
            other = _answer_or_none(OTHER_METHOD.get(solution.method, "fem"), solution.scene)
            return write_picture(path, lambda: _pictures().draw_inside(solution, other), key=INSIDE)
        # Other methods than MDR would take longer for states between than for the answer.
        finer = _pictures().between(solution.scene) if solution.method == "mdr" else None
        curve = None if finer is None else _answer_or_none("mdr", finer)
        return write_picture(path, lambda: _pictures().solution_figure(solution, curve), key="solution")

    pictures, meshes = dict.fromkeys(PICTURES, picture), dict.fromkeys(MESHES, mesh)
    return {**csv_writer(lambda: solution_csv(solution)), ".h5": solution.save, **pictures, **meshes}


def _answer_or_none(method: str, scene: Scene) -> Solution | None:
    """The answer of a method, None where it does not model the scene or does not converge."""
    try:
        return build_guarded(method, {}).solve(scene)
    except (UnsupportedSceneError, NotConvergedError):
        return None
