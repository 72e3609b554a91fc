"""Cost of each effect of a scene and its change of the answer, from a further solution without the effect."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from cases.advice import NOTHING_PULLS, changes, nothing_left, parts_of, without
from cases.answers import Answer, Table
from cases.case import Case, Task
from cases.claims import Study
from cases.studies import Effect


@dataclass(frozen=True, kw_only=True)
class Ablation(Study):
    """Every part of one scene left out in turn.

    Attributes:
        name: "effects" where a case has one such study.
        scene: Name of the scene.
        methods: Labels of the methods that solve the scene with and without each part.
        slow: Labels of further methods, in the nightly suite only.
    """

    kind: ClassVar[str] = "effects"

    name: str = "effects"
    scene: str
    methods: tuple[str, ...] = ("mdr",)
    slow: tuple[str, ...] = ()

    def in_suite(self, suite: str) -> "Ablation":
        """Return the study as a suite carries it out."""
        return replace(self, methods=(*self.methods, *self.slow), slow=()) if suite == "nightly" else self

    def tasks(self, case: Case) -> Iterator[Task]:
        """Yield the whole scene and the scene without each of its parts, as first solutions."""
        for whole in self._wholes(case):
            yield whole
            yield from (task for _, task in _ablated(whole))

    def records(self, case: Case, answers: Table) -> Iterator[Effect]:
        """Yield one effect for each part and method; nothing for a method that does not solve the whole scene."""
        for task in self._wholes(case):
            whole = answers.get(task.identity)
            if whole is None or not whole.solved:
                continue
            for part, changed in _ablated(task):
                reduced = answers.get(changed.identity)
                if reduced is not None:
                    yield _effect(whole, part, reduced)
            for part in parts_of(task.problem):
                if nothing_left(task.problem, part):
                    yield _unanswered(whole, part, NOTHING_PULLS)

    def _wholes(self, case: Case) -> Iterator[Task]:
        """The task of the whole scene for each method of this claim that solves it."""
        scene = case.by_name.get(self.scene)
        for use in case.methods_of(scene) if scene else ():
            if scene and use.label in self.methods:
                yield replace(case.task(scene, use), variant="whole, as a first solution", first=True)


def _ablated(whole: Task) -> Iterator[tuple[str, Task]]:
    """Each part of the scene with the task that solves the scene without it."""
    for part in parts_of(whole.problem):
        if not nothing_left(whole.problem, part):
            yield part, whole.changed(f"without {part}", without(whole.problem, [part]))


def _effect(whole: Answer, part: str, reduced: Answer) -> Effect:
    """Effect of a part: the changes from the answer to the whole scene to that without the part, and its run time."""
    if not reduced.solved:
        return _unanswered(whole, part, reduced.reason)
    relative = changes(
        *({name: np.array(q.values) for name, q in answer.quantities.items()} for answer in (whole, reduced))
    )
    return replace(_unanswered(whole, part, ""), seconds_without=reduced.seconds, changes=relative)


def _unanswered(whole: Answer, part: str, remark: str) -> Effect:
    """An effect without changes; the remark says why the scene without the part was not solved."""
    place = {name: getattr(whole, name) for name in ("case", "scene", "method", "seconds")}
    return Effect(**place, part=part, remark=remark)
