"""Claims of a case. Each kind yields the tasks it needs in addition to the case's own, and judges the answers."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import ClassVar, Literal, TypeAlias

import numpy as np

from cases.answers import Answer, Table, Values
from cases.case import Case, CaseScene, Task
from cases.declare.methods import MethodUse
from cases.declare.shared import in_common
from cases.declare.uncertain_inputs import read_inputs
from cases.norms import relative_difference, ring_load_difference
from cases.rules import (
    Judgement,
    judge_agreement,
    judge_exact,
    judge_order,
    judge_residual,
    nothing_compared,
    positive_tolerance,
    worst_judgement,
)
from cases.studies import Record
from cases.verdicts import Kind, Origin, Status, Verdict, Why
from contact import InvalidInput, Scene
from contact.records.validation import FloatArray

# One number, one per step, or either of them by quantity.
Numbers: TypeAlias = float | Sequence[float] | FloatArray | Mapping[str, float] | Mapping[str, FloatArray]
Expected: TypeAlias = Mapping[str, Numbers] | Callable[[Scene], Numbers]
Norm: TypeAlias = Literal["", "weighted L2", "ring loads", "largest", "root mean square"]

# On the half-space, MDR on a table uses no table and equals MDR by construction.
TABLE, NO_TABLE = "mdr_table", "on the half-space no table is read"
# Coverage factor of the uncertainty of printed inputs: 2 covers 95 % of the values (GUM 6.3.3), 1 only 68 %.
COVERAGE = 2.0


@dataclass(frozen=True, kw_only=True)
class Study:
    """Tasks of a case in addition to its scenes, and the verdicts and records of their answers.

    Attributes:
        name: Unique within the case.
        nightly: Whether it takes too long for the suite "ci".
    """

    kind: ClassVar[str] = "study"
    # Whether its tasks are timed, alone on the machine.
    timed: ClassVar[bool] = False

    name: str
    nightly: bool = False

    def check(self, case: Case) -> None:
        """Raise InvalidInput if the study names scenes or methods that the case does not have (here: none)."""

    def in_suite(self, suite: str) -> "Study | None":
        """Return the study as a suite carries it out, or None."""
        return None if self.nightly and suite == "ci" else self

    def tasks(self, case: Case) -> Iterator[Task]:
        """Yield the tasks that are needed in addition to the case's own."""
        yield from ()

    def judge(self, case: Case, answers: Table) -> Iterator[Verdict]:
        """Yield the verdicts whose answers are present."""
        yield from ()

    def records(self, case: Case, answers: Table) -> Iterator[Record]:
        """Yield what was measured, for tables and figures."""
        yield from ()


@dataclass(frozen=True, kw_only=True)
class Claim(Study, ABC):
    """Base of all claims, which are stated before anything is computed.

    Attributes:
        quantity: Name of the quantity that is compared.
        tolerance: Largest permitted error, relative.
        why: Reasons of the claim, and the origin of its numbers.
        scenes: Names of the scenes that it is about; empty for all.
        methods: Labels of the methods that it is about; empty for every method that solves a scene.
        tolerances: Tolerances of methods that need another one, by label.
        identities: Reasons why it holds by construction, by label of the method; such checks are not counted.
    """

    kind: ClassVar[Kind]

    quantity: str
    tolerance: float
    why: Why
    scenes: tuple[str, ...] = ()
    methods: tuple[str, ...] = ()
    tolerances: Mapping[str, float] = field(default_factory=dict)
    identities: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Refuse a claim without words, and a tolerance of the wrong sign."""
        for tolerance in (self.tolerance, *self.tolerances.values()):
            positive_tolerance(tolerance)
        if not (self.name.strip() and self.quantity.strip()):
            raise InvalidInput(f"claim {self.name!r}: name or quantity is empty; say what is claimed of what")

    def check(self, case: Case) -> None:
        """Refuse scenes that the case does not have, and named methods that solve none of the claim's scenes.

        Raises:
            InvalidInput: Naming the first of them.
        """
        scenes = [case.scene(name) for name in self.scenes] or case.scenes
        solving = {use.label for scene in scenes for use in case.methods_of(scene)}
        for label in self.methods:
            if label not in solving:
                case.use(scenes[0], label)
        for scene in scenes if self.together else ():
            for label in self.together:
                case.use(scene, label)

    @property
    def together(self) -> tuple[str, ...]:
        """Labels of the methods that must all solve a scene, the judged one first; empty where each is judged alone."""
        return ()

    def scenes_of(self, case: Case) -> tuple[CaseScene, ...]:
        """Return the scenes of the case that this claim is about."""
        return tuple(case.by_name[name] for name in self.scenes if name in case.by_name) if self.scenes else case.scenes

    def places(self, case: Case) -> Iterator[tuple[CaseScene, MethodUse]]:
        """Yield each scene of the claim with each method of the claim that solves it."""
        for scene in self.scenes_of(case):
            uses = {use.label: use for use in case.methods_of(scene)}
            labels = self.together[:1] or self.methods or tuple(uses)
            if set(self.together) <= set(uses):
                yield from ((scene, use) for label, use in uses.items() if label in labels)

    def tasks(self, case: Case) -> Iterator[Task]:
        """Yield the tasks that the verdicts need."""
        for scene, use in self.places(case):
            yield from self.needed(case, scene, use)

    def needed(self, case: Case, scene: CaseScene, use: MethodUse) -> Iterator[Task]:
        """Yield the tasks whose answers one verdict needs, that of the judged answer first."""
        yield case.task(scene, use)

    def answered(self, case: Case, answers: Table) -> Iterator[tuple[CaseScene, MethodUse, list[Answer]]]:
        """Yield each scene and method of the claim whose needed answers are all present, with these answers."""
        for scene, use in self.places(case):
            present = [answers.get(task.identity) for task in self.needed(case, scene, use)]
            if None not in present:
                yield scene, use, [answer for answer in present if answer is not None]

    def judge(self, case: Case, answers: Table) -> Iterator[Verdict]:
        """Yield the verdict of each scene and method whose answers are present."""
        for scene, use, present in self.answered(case, answers):
            judged = self.missing(present) or self.judged(case, scene, present)
            yield self._verdict(case, scene, use, present, judged)

    def missing(self, answers: list[Answer]) -> Judgement | None:
        """Return why the first answer without the quantity cannot be compared; None if all have it."""
        for answer in answers:
            if not answer.solved:
                return nothing_compared(answer.status, f"{answer.method}: {answer.reason}")
            if self.quantity not in answer.quantities:
                return nothing_compared(Status.SKIP, f"{answer.method} gives no {self.quantity.replace('_', ' ')}")
        return None

    @abstractmethod
    def judged(self, case: Case, scene: CaseScene, answers: list[Answer]) -> Judgement:
        """Judge the answers of the needed tasks, which all have numbers, the judged one first."""

    def tolerance_of(self, label: str) -> float:
        """Return the tolerance of one method."""
        return self.tolerances.get(label, self.tolerance)

    def labels(self, use: MethodUse) -> tuple[str, ...]:
        """Return the labels of the methods of a verdict."""
        return (use.label,)

    def expected(self, scene: CaseScene) -> float | None:
        """Return the number compared with, if it is a single one."""
        return None

    def identity(self, scene: CaseScene, labels: Iterable[str]) -> str:
        """Return why the comparison cannot fail on ``scene``, empty where it can."""
        on_half_space = {TABLE: NO_TABLE} if scene.scene.layer.is_half_space else {}
        return next((why[label] for why in (self.identities, on_half_space) for label in labels if label in why), "")

    def _verdict(
        self, case: Case, scene: CaseScene, use: MethodUse, answers: list[Answer], judged: Judgement
    ) -> Verdict:
        """The verdict of a judgement; two methods that share code or data are related, not independent."""
        why, common = self.why, tuple[str, ...]()
        if self.kind is Kind.AGREEMENT:
            common = in_common(answers[0].shared, answers[1].shared, quantity=self.quantity, case=case.name)
        if common and why.origin is Origin.INDEPENDENT_METHOD:
            why = replace(why, origin=Origin.RELATED_METHOD)
        return Verdict(
            case=case.name,
            claim=self.name,
            kind=self.kind,
            scene=scene.name,
            methods=self.labels(use),
            quantity=self.quantity,
            expected=self.expected(scene),
            tolerance=self.tolerance_of(use.label),
            why=why,
            shared=common,
            identity="" if judged.error is None else self.identity(scene, self.labels(use)),
            **vars(judged),
        )


def numbers_of(numbers: Numbers, quantity: str) -> list[float]:
    """Return the numbers of a quantity, one per step."""
    values = numbers[quantity] if isinstance(numbers, Mapping) else numbers
    return [float(value) for value in np.atleast_1d(np.asarray(values))]


@dataclass(frozen=True, kw_only=True)
class Equal(Claim):
    """The values along the steps equal expected ones, of a closed form or the literature.

    Attributes:
        to: Expected values by name of the scene, or a function of the scene.
        uncertain: Printed inputs with their uncertainties, as text for `read_inputs`; the effect of these counts as a
            stated error, twice.
    """

    kind: ClassVar[Kind] = Kind.EXACT

    to: Expected
    uncertain: str = ""

    def scenes_of(self, case: Case) -> tuple[CaseScene, ...]:
        """Return the scenes named, or those that have an expected value."""
        if isinstance(self.to, Mapping) and not self.scenes:
            return tuple(case.by_name[name] for name in self.to if name in case.by_name)
        return super().scenes_of(case)

    def check(self, case: Case) -> None:
        """Refuse expected values of scenes that the case does not have."""
        super().check(case)
        for name in self.to if isinstance(self.to, Mapping) else ():
            case.scene(name)

    def values(self, scene: CaseScene) -> list[float]:
        """Return the expected values on one scene."""
        if isinstance(self.to, Mapping) and scene.name not in self.to:
            raise InvalidInput(f"claim {self.name!r}: no expected value for scene {scene.name!r}")
        numbers = self.to[scene.name] if isinstance(self.to, Mapping) else self.to(scene.scene)
        return numbers_of(numbers, self.quantity)

    def needed(self, case: Case, scene: CaseScene, use: MethodUse) -> Iterator[Task]:
        """Yield the scene, then with each uncertain input one standard deviation up and down."""
        yield from super().needed(case, scene, use)
        if not self.uncertain:
            return
        inputs, task = read_inputs(self.uncertain), case.task(scene, use)
        for uncertain, unit in zip(inputs.inputs, np.eye(len(inputs.inputs)), strict=True):
            for side, deviations in (("up", unit), ("down", -unit)):
                problem = inputs.scene_at(task.problem, deviations)
                yield task.changed(f"{self.name}, {uncertain.name} {side}", problem)

    def judged(self, case: Case, scene: CaseScene, answers: list[Answer]) -> Judgement:
        """Judge the worst step against the expected values, with the stated error and the uncertainty by the inputs."""
        values, q = np.array(self.values(scene)), answers[0].quantities[self.quantity]
        if len(values) != len(q.values):
            message = f"{len(q.values)} steps for {len(values)} expected values of {self.quantity}"
            return nothing_compared(Status.INCOMPARABLE, message)
        scale = q.scale if 0.0 in values else 0.0
        size = np.maximum(np.abs(values), scale)
        numerical = np.array(q.error or np.zeros_like(values))
        stated = {answers[0].method: numerical} if q.error or self.uncertain else {}
        if self.uncertain:
            stated["inputs"] = self._by_inputs(answers[1:])
        total = np.hypot(numerical, COVERAGE * stated.get("inputs", np.zeros_like(values)))
        words = {"scale": scale, "tolerance": self.tolerance_of(answers[0].method)}
        judgements = [
            replace(
                judge_exact(q.values[step], values[step], stated=total[step], **words),
                uncertainty={name: float(errors[step] / size[step]) for name, errors in stated.items()},
            )
            for step in range(len(values))
        ]
        return worst_judgement(judgements)

    def _by_inputs(self, others: list[Answer]) -> FloatArray:
        """Standard uncertainty by the inputs at every step, from answers with each input up and then down."""
        values = [np.array(other.quantities[self.quantity].values) for other in others]
        changes = np.array([(up - down) / 2 for up, down in zip(values[::2], values[1::2], strict=True)])
        return read_inputs(self.uncertain).spread(changes)

    def expected(self, scene: CaseScene) -> float | None:
        """Return the single expected value."""
        values = self.values(scene)
        return values[0] if len(values) == 1 else None


@dataclass(frozen=True, kw_only=True)
class Agree(Claim):
    """Difference of two methods plus both stated errors within the tolerance, of values or of a field in a norm.

    Attributes:
        fast: Label of the method under test.
        reference: Label of the method that it is compared with.
        norm: Norm in which fields are compared; empty for quantities, whose worst step counts.
        refined: Labels of methods that state no error of the field; the change on halving their discretisation length
            takes its place.
    """

    kind: ClassVar[Kind] = Kind.AGREEMENT

    fast: str
    reference: str
    norm: Norm = ""
    refined: tuple[str, ...] = ()

    @property
    def together(self) -> tuple[str, ...]:
        """Both methods."""
        return self.fast, self.reference

    def needed(self, case: Case, scene: CaseScene, use: MethodUse) -> Iterator[Task]:
        """Yield both methods' tasks, then those of the methods ``refined`` with half the discretisation length."""
        yield from super().needed(case, scene, use)
        yield case.task(scene, case.use(scene, self.reference))
        for label in self.refined:
            yield case.task(scene, case.use(scene, label)).changed("refined", refined=1)

    def missing(self, answers: list[Answer]) -> Judgement | None:
        """Return why the two methods cannot be compared; a refined solution may be missing."""
        return super().missing(answers[:2])

    def judged(self, case: Case, scene: CaseScene, answers: list[Answer]) -> Judgement:
        """Judge the field, or the worst step; without a stated error there is no pass."""
        a, b = (answer.quantities[self.quantity] for answer in answers[:2])
        if a.unit != b.unit or len(a.values) != len(b.values):
            message = f"{len(a.values)} values in {a.unit} against {len(b.values)} in {b.unit}"
            return nothing_compared(Status.INCOMPARABLE, message)
        judged = self._field(scene, answers) if self.norm else self._steps(answers)
        without_error = [answer.method for answer in answers[:2] if answer.method not in judged.uncertainty]
        if not without_error or judged.status.is_failure:
            return judged
        message = f"{without_error[0]} states no uncertainty of {self.quantity}: no verdict is possible"
        return nothing_compared(Status.INCONCLUSIVE, message)

    def _steps(self, answers: list[Answer]) -> Judgement:
        """Judgement of the worst step."""
        a, b = (answer.quantities[self.quantity] for answer in answers[:2])
        x, y = np.array(a.values), np.array(b.values)
        size = np.where(y == 0.0, b.scale, np.abs(y))
        stated = {
            answer.method: np.array(q.error) / np.maximum(np.abs(q.values), size)
            for answer, q in zip(answers, (a, b), strict=False)
            if q.error
        }
        differences = ((x - y) / size).tolist()
        steps = [{label: float(u[i]) for label, u in stated.items()} for i in range(len(x))]
        return worst_judgement(
            [judge_agreement(d, u, tolerance=self.tolerance) for d, u in zip(differences, steps, strict=True)]
        )

    def _field(self, scene: CaseScene, answers: list[Answer]) -> Judgement:
        """Judgement of the difference of two fields in the norm."""
        fields = {answer.method: answer.quantities[self.quantity] for answer in answers[:2]}
        stated = {label: q.error[0] for label, q in fields.items() if q.error and label not in self.refined}
        for label, finer in zip(self.refined, answers[2:], strict=True):
            if finer.solved:
                stated[label] = self.distance(scene, fields[label], finer.quantities[self.quantity])
        return judge_agreement(self.distance(scene, *fields.values()), stated, tolerance=self.tolerance)

    def distance(self, scene: CaseScene, first: Values, second: Values) -> float:
        """Return the difference of two fields in the norm, without unit.

        "weighted L2" and "ring loads" compare pressures and divide by the norm and the load of the second one.
        "largest" and "root mean square" compare values at points that were divided by their scale when recorded.
        """
        a, b = np.array(first.values), np.array(second.values)
        match self.norm:
            case "weighted L2":
                return relative_difference(a, b, scene.sampling.rings)
            case "ring loads":
                return ring_load_difference(a, b, scene.sampling.rings)
            case "largest":
                return float(np.abs(a - b).max())
        return float(np.sqrt(np.mean((a - b) ** 2)))

    def labels(self, use: MethodUse) -> tuple[str, ...]:
        """Return both labels."""
        return self.together

    def expected(self, scene: CaseScene) -> float | None:
        """Return the difference that is expected: none."""
        return 0.0


@dataclass(frozen=True, kw_only=True)
class Changed(Claim, ABC):
    """A claim that compares an answer with that of a changed scene.

    Attributes:
        change: Function that returns the changed scene.
    """

    kind: ClassVar[Kind] = Kind.INVARIANT

    change: Callable[[Scene], Scene]

    def needed(self, case: Case, scene: CaseScene, use: MethodUse) -> Iterator[Task]:
        """Yield the task of the scene and that of the changed one."""
        yield from super().needed(case, scene, use)
        yield case.task(scene, use).changed(self.name, self.change(scene.scene))


@dataclass(frozen=True, kw_only=True)
class Law(Changed):
    """A changed scene gives the same answer times known factors: the modulus doubled, the units changed.

    Attributes:
        factors: Expected answer of the changed scene over that of the original, by name of the quantity.
    """

    factors: Mapping[str, float]

    def judged(self, case: Case, scene: CaseScene, answers: list[Answer]) -> Judgement:
        """Judge the residuals of all quantities and steps."""
        tolerance = self.tolerance_of(answers[0].method)
        residuals: list[float] = []
        for name, factor in self.factors.items():
            a, b = (answer.quantities[name] for answer in answers)
            if len(a.values) != len(b.values):
                return nothing_compared(Status.INCOMPARABLE, f"the changed scene has {len(b.values)} steps of {name}")
            residuals += [(y - factor * x) / (factor * a.scale) for x, y in zip(a.values, b.values, strict=True)]
        return worst_judgement([judge_residual(r, tolerance=tolerance) for r in residuals])


@dataclass(frozen=True, kw_only=True)
class Bound(Changed):
    """q(scene) >= m q(changed scene) at every step, within the tolerance.

    Attributes:
        multiple: Function that returns m for a scene; 1 by default.
        at_most: Whether m q(changed scene) is an upper bound instead.
    """

    multiple: Callable[[Scene], float] | None = None
    at_most: bool = False

    def judged(self, case: Case, scene: CaseScene, answers: list[Answer]) -> Judgement:
        """Judge by how much the worst step violates the bound."""
        multiple = 1.0 if self.multiple is None else self.multiple(scene.scene)
        original, changed = (answer.quantities[self.quantity] for answer in answers)
        tolerance = self.tolerance_of(answers[0].method)
        sign = -1.0 if self.at_most else 1.0
        violations = (
            max(0.0, sign * (multiple * changed_value - value)) / changed.scale
            for value, changed_value in zip(original.values, changed.values, strict=True)
        )
        return worst_judgement([judge_residual(v, tolerance=tolerance) for v in violations])


@dataclass(frozen=True, kw_only=True)
class Zero(Claim):
    """A residual vanishes: a quantity of the answers, or a residual computed from them.

    Attributes:
        derive: Function that returns the relative residuals of an answer; by default the values of the quantity.
    """

    kind: ClassVar[Kind] = Kind.INVARIANT

    derive: Callable[[CaseScene, Answer], Iterable[float]] | None = None

    def missing(self, answers: list[Answer]) -> Judgement | None:
        """Return why there is no residual; one that a method should publish, and does not, is incomparable."""
        (answer,) = answers
        if answer.solved and self.derive is None and self.quantity not in answer.quantities:
            return nothing_compared(Status.INCOMPARABLE, f"{answer.method} publishes no {self.quantity}")
        return super().missing(answers)

    def judged(self, case: Case, scene: CaseScene, answers: list[Answer]) -> Judgement:
        """Judge the worst residual."""
        (answer,) = answers
        tolerance = self.tolerance_of(answer.method)
        residuals = self.derive(scene, answer) if self.derive else answer.quantities[self.quantity].values
        return worst_judgement([judge_residual(float(r), tolerance=tolerance) for r in residuals])

    def identity(self, scene: CaseScene, labels: Iterable[str]) -> str:
        """Return nothing: a residual can always fail."""
        return ""


@dataclass(frozen=True, kw_only=True)
class Approach(Claim):
    """Between the two last scenes the relative distance from a limit falls like a parameter to the formal order.

    Attributes:
        scenes: Names, the one closest to the limit last.
        parameter: Parameter that tends to zero, for example h/a.
        limit: Closed form of a scene to which the quantity's last step tends.
        formal_order: Order of the distance in the parameter.
        largest: Largest permitted relative distance of the last scene from the limit.
    """

    kind: ClassVar[Kind] = Kind.ORDER

    # The band of an observed order around the formal one.
    tolerance: float = 0.2
    parameter: Callable[[Scene], float]
    limit: Callable[[Scene], Numbers]
    formal_order: float = 1.0
    largest: float

    def places(self, case: Case) -> Iterator[tuple[CaseScene, MethodUse]]:
        """Yield the last scene with each method that solves it and the one before."""
        scenes = self.scenes_of(case)
        if len(scenes) == max(len(self.scenes), 2):
            before = {use.label for use in case.methods_of(scenes[-2])}
            for scene, use in super().places(case):
                if scene is scenes[-1] and use.label in before:
                    yield scene, use

    def needed(self, case: Case, scene: CaseScene, use: MethodUse) -> Iterator[Task]:
        """Yield the tasks of the last scene and of the one before."""
        yield from super().needed(case, scene, use)
        before = self.scenes_of(case)[-2]
        yield case.task(before, case.use(before, use.label))

    def expected(self, scene: CaseScene) -> float | None:
        """Return the formal order."""
        return self.formal_order

    def identity(self, scene: CaseScene, labels: Iterable[str]) -> str:
        """Return nothing: an order can always fail."""
        return ""

    def judged(self, case: Case, scene: CaseScene, answers: list[Answer]) -> Judgement:
        """Judge the rate; a failure that the stated error explains is inconclusive."""
        scenes, answers = (self.scenes_of(case)[-2], scene), answers[::-1]
        pairs = [
            (answer.quantities[self.quantity], numbers_of(self.limit(place.scene), self.quantity)[0])
            for place, answer in zip(scenes, answers, strict=True)
        ]
        far, near = (q.values[-1] / limit - 1 for q, limit in pairs)
        # A value that is too large does not widen its own error.
        errors = [q.error[-1] / max(abs(q.values[-1]), abs(limit)) if q.error else 0.0 for q, limit in pairs]
        ratio = self.parameter(scenes[0].scene) / self.parameter(scenes[1].scene)
        judged = self._rate(far, near, ratio)
        if judged.status is not Status.FAIL or not self._may_hold((far, near), errors, ratio):
            return judged
        return nothing_compared(Status.INCONCLUSIVE, f"{judged.message}; error {max(errors):.1e}: refine")

    def _rate(self, far: float, near: float, ratio: float) -> Judgement:
        """Judge the order ln|far/near|/ln(ratio) from the relative distances from the limit of two scenes."""
        if abs(near) > self.largest:
            message = f"{near:+.1e} from the limit, at most {self.largest:g} claimed"
            return nothing_compared(Status.FAIL, message)
        if near == 0 or far == 0:
            return nothing_compared(Status.INCONCLUSIVE, "at the limit to the last bit: no rate to measure")
        order = math.log(abs(far / near)) / math.log(ratio)
        judged = judge_order(order, self.formal_order, "monotone" if far * near > 0 else "oscillatory")
        return replace(judged, message=f"{judged.message}; {near:+.1e} from the limit")

    def _may_hold(self, distances: tuple[float, float], errors: list[float], ratio: float) -> bool:
        """Whether true distances within the errors could be near the limit and fall at the formal order."""
        (least_far, least_near), (most_far, most_near) = (
            [max(abs(d) + sign * e, 0.0) for d, e in zip(distances, errors, strict=True)] for sign in (-1, 1)
        )
        fall = ratio**self.formal_order
        return least_near <= self.largest and least_far <= fall * most_near and fall * least_near <= most_far
