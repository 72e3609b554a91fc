"""The unit of work: one method on one scene, and what is kept of its answer."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from cases.judgement.rules.norms import RingQuadrature, ring_quadrature
from cases.results.records.scene_run import SceneRun
from contact import Method, Scene


@dataclass(frozen=True, kw_only=True)
class Sampling:
    """What is kept of an answer beside its quantities.

    Attributes:
        ring_edges: the pressure of the last step is kept at the Gauss nodes of the rings between these radii [m];
            empty keeps no pressure.
        nodes: Gauss nodes on each ring.
        scales: declared size of a quantity, by name; otherwise its largest magnitude.
        inside: points of the body where fields of the last step are kept: r over the contact radius, z over the smaller
            of contact radius and thickness; empty keeps none.
        laws: whether the laws of elastic bodies are checked on these fields.
    """

    ring_edges: tuple[float, ...] = ()
    nodes: int = 12
    scales: dict[str, float] = field(default_factory=dict)
    inside: tuple[tuple[float, float], ...] = ()
    laws: bool = True

    @property
    def rings(self) -> RingQuadrature:
        """Nodes and weights."""
        return ring_quadrature(self.ring_edges, self.nodes)


@dataclass(frozen=True, kw_only=True)
class Task:
    """One method on one scene.

    Attributes:
        case: name of the case.
        scene: name of the scene within the case.
        variant: "" for the scene itself, else what was changed ("doubled E", "refined 2").
        method: label of the method in the case.
        problem: the scene that is solved.
        solver: the method with its settings.
        settings: those that the case asks for; the method has defaults for the others.
        sampling: what is kept.
        timed: whether the solve is repeated for its time, alone on the machine.
        forgetful: whether it is a first solution: imports are done before, caches are empty.
    """

    case: str
    scene: str
    variant: str = ""
    method: str
    problem: Scene
    solver: Method
    settings: Mapping[str, Any] = field(default_factory=dict)
    sampling: Sampling = field(default_factory=Sampling)
    timed: bool = False
    forgetful: bool = False

    @property
    def identity(self) -> tuple[str, str, str, str]:
        """Case, scene, variant and method: unique within a run."""
        return self.case, self.scene, self.variant, self.method

    @property
    def label(self) -> str:
        """The identity in words."""
        return " / ".join(part for part in self.identity if part)

    def changed(self, variant: str, problem: Scene | None = None, solver: Method | None = None) -> "Task":
        """Return a variant of this task: another scene, other settings, or both."""
        return replace(self, variant=variant, problem=problem or self.problem, solver=solver or self.solver)


class MissingAnswer(KeyError):
    """A task that did not run."""


class Answers:
    """The finished tasks of a run by identity."""

    def __init__(self, runs: dict[tuple[str, str, str, str], SceneRun]) -> None:
        self._runs = runs

    def of(self, task: Task) -> SceneRun:
        """Return what became of ``task``.

        Raises:
            MissingAnswer: if it did not run; an interrupted run judges only claims whose tasks are all there.
        """
        if task.identity not in self._runs:
            raise MissingAnswer(task.label)
        return self._runs[task.identity]

    def has(self, task: Task) -> bool:
        """Whether ``task`` is finished."""
        return task.identity in self._runs
