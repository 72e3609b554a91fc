"""`contact-verify explain`: why a stored solution would be computed again."""

from pathlib import Path

from cases.declare.foreign_methods import with_registered
from cases.declare.registry import load_cases
from cases.declare.task import Task
from cases.results.files import read_run
from cases.run.keys import content_key, key_parts
from cases.run.store import TaskStore
from contact import InvalidInput
from reports.terminal.terminal import console


def explain(key: str, out: Path) -> None:
    """Print what differs between the stored solution and the same task today, one line each.

    Raises:
        InvalidInput: if the run has no such key, or its task no longer exists.
    """
    task = _task_of(key, out)
    parts = key_parts(task)
    terminal = console()
    terminal.print(task.label)
    changes = TaskStore(out / "tasks").explain(key, parts)
    for change in changes:
        terminal.print(f"  {change}")
    if not changes:
        same = content_key(parts) == key
        terminal.print("  nothing: it would be used again" if same else "  only the form of the key")


def _task_of(key: str, out: Path) -> Task:
    """Today's task of the case, scene and method that the key had in the run."""
    places = {row.key: (case.name, row.scene, row.method) for case in read_run(out).cases for row in case.runs}
    if key not in places:
        raise InvalidInput(
            f"no solution with key {key!r} in {out / 'results.json'}; keys stand there beside each scene"
        )
    case, scene, method = places[key]
    cases = load_cases()
    tasks = with_registered(cases[case], [method]).tasks() if case in cases else ()
    for task in tasks:
        if task.identity == (case, scene, "", method):
            return task
    raise InvalidInput(f"the task {case} / {scene} / {method} no longer exists; run the case again")
