"""A printed value of the literature, whose inputs were printed as well: to a few digits, and so uncertain."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from cases.declare.case import Case
from cases.declare.task import Answers, Task
from cases.declare.uncertain_inputs import read_inputs
from cases.judgement.claims.declared import first_missing
from cases.judgement.claims.exact import Exact, worst_step
from cases.results.records.claim import Claim
from cases.results.records.scene_run import SceneRun
from contact.records.validation import FloatArray

# What a printed value may be off by its inputs: two standard uncertainties, which cover 95 % (GUM 6.3.3).
COVERAGE = 2.0


@dataclass(frozen=True, kw_only=True)
class Printed(Exact):
    """The values equal printed ones within the reading accuracy, or within what the printed inputs leave open.

    Attributes:
        uncertain: the inputs, as `cases.declare.uncertain_inputs.read_inputs` takes them.
    """

    uncertain: str

    def tasks(self, case: Case) -> Iterable[Task]:
        """Return the scenes with each input one standard deviation up and down."""
        for scene in self.scenes_of(case):
            for label in self.labels(case, scene):
                for up, down in self._moved(case.task(scene, case.use(scene, label))):
                    yield from (up, down)

    def judge(self, case: Case, answers: Answers) -> Iterator[Claim]:
        """Judge each scene and method by its worst step."""
        for scene, label, run, tolerance in self.answered(case, answers):
            pairs = self._moved(case.task(scene, case.use(scene, label)))
            moved = [(answers.of(up), answers.of(down)) for up, down in pairs]
            judged, stated = first_missing(run, *(one for pair in moved for one in pair)), dict[str, float]()
            expected = self.expected_on(scene)
            if judged is None:
                by_inputs = self._by_inputs(moved)
                quantity = run.quantity(self.quantity)
                judged, own, step = worst_step(quantity, expected, tolerance, COVERAGE * by_inputs)
                stated = {label: own or 0.0, "inputs": float(by_inputs[step] / abs(expected[step]))}
            single = expected[0] if len(expected) == 1 else None
            yield self.record(judged, scene.name, (label,), expected=single, uncertainty=stated, tolerance=tolerance)

    def _moved(self, task: Task) -> list[tuple[Task, Task]]:
        inputs = read_inputs(self.uncertain)
        units = np.eye(len(inputs.inputs))

        def moved(name: str, deviations: FloatArray, side: str) -> Task:
            return task.changed(f"{self.name}, {name} {side}", problem=inputs.moved(task.problem, deviations))

        named = zip((one.name for one in inputs.inputs), units, strict=True)
        return [(moved(name, unit, "up"), moved(name, -unit, "down")) for name, unit in named]

    def _by_inputs(self, moved: list[tuple[SceneRun, SceneRun]]) -> FloatArray:
        """Standard uncertainty of every step: the root of D R D^T."""
        changes = np.array(
            [
                np.subtract(up.quantity(self.quantity).values, down.quantity(self.quantity).values) / 2
                for up, down in moved
            ]
        )
        correlation = read_inputs(self.uncertain).correlation
        return np.asarray(np.sqrt(np.einsum("is,ij,js->s", changes, correlation, changes)))
