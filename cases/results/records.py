"""What a run produces: frozen, validated records, from the single number up to the whole run.

Everything a report shows is one of these records; a report computes nothing.  Lengths, forces and stresses are SI.
A non-finite number cannot be stored: what could not be computed is ``None`` beside a status that says why.
"""

from dataclasses import field
from enum import StrEnum
from typing import Annotated, Literal, Self

from pydantic import ConfigDict, Field, model_validator
from pydantic.dataclasses import dataclass

from cases.results.status import Status, worst

SCHEMA_VERSION = 1

Finite = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(allow_inf_nan=False, gt=0)]
NotNegative = Annotated[float, Field(allow_inf_nan=False, ge=0)]
Vector = tuple[Finite, ...]
Scalar = bool | int | Finite | str
Mapping = dict[str, Scalar]

_RECORD = ConfigDict(extra="forbid")


class Kind(StrEnum):
    """What a claim compares with."""

    EXACT = "exact"  # closed form or literature
    ORDER = "order"  # observed order of convergence against the formal one
    AGREEMENT = "agreement"  # two methods, both uncertainties known
    INVARIANT = "invariant"  # a law of the mechanics
    REGRESSION = "regression"  # own earlier output; never verification


class Origin(StrEnum):
    """Where an expected number comes from; the four are never mixed."""

    CLOSED_FORM = "closed form"
    LITERATURE = "literature"
    INDEPENDENT_METHOD = "independent method"
    OWN_EARLIER_OUTPUT = "own earlier output"


class Verdict(StrEnum):
    """The word a claim is reported with."""

    PASS = "PASS"
    FAIL = "FAIL"
    AGREE = "AGREE"
    DISAGREE = "DISAGREE"
    MARGINAL = "MARGINAL"
    INCONCLUSIVE = "INCONCLUSIVE"
    NONE = "NONE"  # nothing could be compared: the status says why


class ConvergenceClass(StrEnum):
    """How a sequence of refinements behaves."""

    MONOTONE = "monotone"
    OSCILLATORY = "oscillatory"
    DIVERGENT = "divergent"
    FLOOR = "floor"  # differences within ten times the round-off floor
    TOO_FEW = "too-few"
    SPECTRAL = "spectral"  # digits per refinement


# -- one method on one scene ---------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class Quantity:
    """A computed quantity along the steps of the loading.

    Attributes:
        name: for example "normal_force".
        unit: SI unit, "1" for a ratio.
        scale: declared size that errors are relative to, same unit; positive, so a zero crossing does no harm.
        values: shape (n,).
        uncertainty: the method's own numerical uncertainty, same unit, shape (n,); empty when the method states none.
    """

    name: str
    unit: str
    scale: Positive
    values: Vector
    uncertainty: tuple[NotNegative, ...] = ()

    @model_validator(mode="after")
    def _one_uncertainty_per_value(self) -> Self:
        if self.uncertainty and len(self.uncertainty) != len(self.values):
            message = f"{self.name}: {len(self.uncertainty)} uncertainties for {len(self.values)} values; give one each"
            raise ValueError(message)
        return self


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class Curve:
    """A sampled field or history, y(x), for example the pressure over the radius.

    Attributes:
        name: for example "pressure".
        x_name: for example "radius".
        x_unit: SI unit of x.
        x: shape (n,).
        unit: SI unit of y.
        y: shape (n,).
        relative_uncertainty: the method's own, of y in the norm of its area or history; None when it states none.
    """

    name: str
    x_name: str
    x_unit: str
    x: Vector
    unit: str
    y: Vector
    relative_uncertainty: NotNegative | None = None

    @model_validator(mode="after")
    def _equal_lengths(self) -> Self:
        if len(self.x) != len(self.y):
            message = f"{self.name}: {len(self.x)} abscissae for {len(self.y)} ordinates; they must match"
            raise ValueError(message)
        return self


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class Stage:
    """One stage of a solution: the raw data of the effect ledger."""

    name: str
    calls: int
    seconds: NotNegative
    cpu_seconds: NotNegative = 0.0
    bytes: int = 0


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class CostRecord:
    """What a solution cost: seconds, peak memory [bytes], unknowns, and counters that repeat exactly."""

    wall_seconds: NotNegative
    cpu_seconds: NotNegative
    peak_memory_bytes: int
    unknowns: int
    counters: dict[str, int] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class SceneRun:
    """One method on one scene: PASS with quantities, or another status with its reason.

    Attributes:
        key: content key; equal keys mean equal scene, settings, code and versions.
        scene: name of the scene within its case.
        method: name of the method in the method table.
        settings: numerical settings of the method.
        status: PASS when solved.
        reason: why not, when not solved; one sentence.
        shared_inputs: names of the inputs (a flat-punch table, a kernel) other methods may use as well.
        samples: seconds of each repeated solve of a timing run; empty for any other.
        cold_seconds: first solve of a timing run, with nothing kept from earlier ones; None for any other.
    """

    key: str
    scene: str
    method: str
    settings: Mapping
    status: Status
    reason: str
    quantities: tuple[Quantity, ...] = ()
    curves: tuple[Curve, ...] = ()
    cost: CostRecord | None
    stages: tuple[Stage, ...] = ()
    shared_inputs: tuple[str, ...] = ()
    samples: tuple[NotNegative, ...] = ()
    cold_seconds: NotNegative | None = None
    notes: tuple[str, ...] = ()

    @property
    def solved(self) -> bool:
        """Whether this run has numbers."""
        return self.status is Status.PASS

    def quantity(self, name: str) -> Quantity:
        """Return the quantity called ``name``.

        Raises:
            KeyError: if this run has none of that name.
        """
        return {q.name: q for q in self.quantities}[name]

    def curve(self, name: str) -> Curve:
        """Return the curve called ``name``.

        Raises:
            KeyError: if this run has none of that name.
        """
        return {c.name: c for c in self.curves}[name]


# -- what is claimed of them ---------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class Claim:
    """A claim and its end.

    Attributes:
        name: unique within the case.
        kind: what it compares with.
        scene: name of the scene, or of the group of scenes it speaks about.
        methods: the method, or the two methods compared.
        quantity: what is compared.
        unit: unit of observed, expected and tolerance; "1" when they are relative.
        status: how it ended; decides the exit code.
        verdict: the word for the reader.
        observed: measured error, difference or order; None when nothing could be compared.
        expected: the number it is compared with, None where there is none (an invariant's residual is compared with 0).
        tolerance: largest permitted error, same unit as observed.
        fraction: error divided by tolerance; at most 1 passes.
        uncertainty: numerical uncertainty of each method that took part, same unit as observed.
        origin: where the expected number comes from.
        source: closed form, page and table, or method.
        because: why the claim should hold.
        derived_from: how the tolerance was chosen.
        shared_inputs: what the compared answers share; agreement says nothing about those.
        message: what was seen, one sentence.
        relaxed: whose own claim of accuracy has widened the tolerance, and from what; empty when nobody's has.
    """

    name: str
    kind: Kind
    scene: str
    methods: tuple[str, ...]
    quantity: str
    unit: str
    status: Status
    verdict: Verdict
    observed: Finite | None
    expected: Finite | None
    tolerance: Positive
    fraction: NotNegative | None
    uncertainty: dict[str, NotNegative] = field(default_factory=dict)
    origin: Origin
    source: str
    because: str
    derived_from: str
    shared_inputs: tuple[str, ...] = ()
    message: str
    relaxed: str = ""


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class Grid:
    """One refinement of a convergence study; ``gci`` is relative, None where it is not defined."""

    length: Positive
    unknowns: int
    seconds: NotNegative
    value: Finite
    error: NotNegative | None
    gci: NotNegative | None


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class ConvergenceStudy:
    """A quantity under refinement, finest grid first.

    Attributes:
        grids: finest first; ``error`` is absolute, against the reference.
        scale: size that errors are relative to, unit of the quantity.
        mesh_family: the formal order belongs to it.
        kind: class of behaviour.
        observed_order: of the three finest grids or the least-squares fit; None where the class has none.
        formal_order: None for spectral convergence, which has no order.
        digits_per_refinement: of spectral convergence; None otherwise.
        extrapolated: value at vanishing length; None where the class has none.
        asymptotic: whether the honest asymptotic test passed; None with too few grids.
        reference: closed form or finest independent answer; None without one.
        reference_uncertainty: of the reference.
    """

    scene: str
    method: str
    quantity: str
    unit: str
    scale: Positive
    mesh_family: str
    kind: ConvergenceClass
    grids: tuple[Grid, ...]
    formal_order: Positive | None
    observed_order: Finite | None
    digits_per_refinement: Finite | None
    extrapolated: Finite | None
    asymptotic: bool | None
    reference: Finite | None
    reference_uncertainty: NotNegative
    reference_source: str


# -- what accuracy costs -------------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class WorkPoint:
    """One setting of one method, timed: relative error, its bound U = error + reference uncertainty, and the cost.

    A failed setting has no error and no bound; its ``reason`` says why, its ``seconds`` what it took to fail.
    ``cold_seconds``: the first solution, which prepares what later ones of the same layer reuse.
    ``on_front``: no other setting of any method is at least as accurate and clearly faster.
    """

    method: str
    settings: Mapping
    label: str
    status: Status
    reason: str
    error: NotNegative | None
    bound: NotNegative | None
    samples: tuple[NotNegative, ...]
    seconds: NotNegative
    cold_seconds: NotNegative = 0.0
    lower_quartile: NotNegative
    upper_quartile: NotNegative
    unknowns: int
    peak_memory_bytes: int
    counters: dict[str, int] = field(default_factory=dict)
    stages: tuple[Stage, ...] = ()
    on_front: bool


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class CheapestRun:
    """T*(tau) of one method: the smallest time with U <= tau, never interpolated.

    Where the tolerance was not reached ``reached`` is False and the numbers are those of the most accurate run
    ("not reached, best U = .."); a method without any successful run has None.
    """

    tolerance: Positive
    method: str
    reached: bool
    label: str
    seconds: NotNegative | None
    cold_seconds: NotNegative | None = None  # of the first solution with the same setting
    bound: NotNegative | None
    peak_memory_bytes: int | None
    speed_up: Positive | None  # over the reference method's T* at the same tolerance; None where either is missing


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class DigitPrice:
    """What the next digit costs on the front: decades of time per digit between neighbours."""

    method: str
    from_label: str
    to_label: str
    decades_per_digit: Finite


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class WorkPrecision:
    """Error against seconds for the methods on one scene; errors relative.

    Attributes:
        reference_source: what the errors are measured against.
        reference_uncertainty: u_ref, relative.
        baseline_method: the method speed-ups are relative to ("fem").
        fast_method: the method the crossover is about ("mdr").
        null_spread: relative spread d of repeated times.
        crossover: smallest tolerance where the fast method still wins; None where it never does.
    """

    scene: str
    quantity: str
    reference_source: str
    reference_uncertainty: NotNegative
    baseline_method: str
    fast_method: str
    null_spread: NotNegative
    points: tuple[WorkPoint, ...]
    cheapest: tuple[CheapestRun, ...]
    prices: tuple[DigitPrice, ...]
    crossover: Positive | None


# -- where methods break -------------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class Rung:
    """One step of a stability ladder.

    Attributes:
        value: of the hard parameter.
        status: PASS when solved; otherwise the reason names the error.
        reason: of a status other than PASS.
        digits: significant digits that perturbed repeats share; None when nothing was solved.
        iterations: of the hardest iteration; None for a method without any.
        residuals: largest relative residual of each invariant, by name.
    """

    value: Positive
    status: Status
    reason: str = ""
    digits: NotNegative | None
    iterations: int | None = None
    residuals: dict[str, NotNegative] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class Ladder:
    """A hard parameter walked in steps until something breaks.

    Attributes:
        name: unique within the case, for example "nearly incompressible".
        parameter: what is walked, with its symbol, for example "1/2 - nu".
        unit: "1" for a ratio.
        method: label of the method that climbs.
        quantity: whose digits are counted.
        rungs: in the order of walking, from easy to hard.
    """

    name: str
    parameter: str
    unit: str
    method: str
    quantity: str
    rungs: tuple[Rung, ...]


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class CoverageRecord:
    """Stated against true errors of one quantity over random scenes.

    Attributes:
        method: name in the method table.
        settings: numerical settings of the method.
        family: kind of scenes.
        quantity: whose errors.
        scenes: how many were drawn.
        refused: how many the method refused by name.
        crashed: how many ended with an error that has no name.
        checks: how many answers were compared with the referee's.
        covered: share of them whose stated error holds.
        decided: how many the referee could tell from its own uncertainty.
        sharpness: median of stated over true error among those; None without any.
        percentiles: stated over true error at 0, 2, .. 100 percent of those.
    """

    method: str
    settings: Mapping
    family: str
    quantity: str
    scenes: int
    refused: int
    crashed: int
    checks: int
    covered: NotNegative
    decided: int
    sharpness: NotNegative | None
    percentiles: tuple[NotNegative, ...] = ()


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class ErrorMap:
    """Signed relative errors over a/h and Poisson's ratio.

    Attributes:
        name: of the formula or method.
        title: for readers.
        quantity: whose error.
        reference: what it is relative to.
        ratios: a/h, shape (n,).
        rows: Poisson's ratios as words, or "unbonded", shape (m,).
        errors: shape (m, n); None where there is no answer.
    """

    name: str
    title: str
    quantity: str
    reference: str
    ratios: Vector
    rows: tuple[str, ...]
    errors: tuple[tuple[Finite | None, ...], ...]

    @model_validator(mode="after")
    def _full(self) -> Self:
        if len(self.errors) != len(self.rows) or any(len(row) != len(self.ratios) for row in self.errors):
            raise ValueError(f"{self.name}: a map needs one error for each row and ratio")
        return self


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class ScalingFit:
    """Seconds against size, and the exponent of what grows beyond a fixed cost.

    Attributes:
        method: name in the method table.
        size: what grows.
        sizes: shape (n,).
        seconds: processor time of a first solution, shape (n,).
        exponent: fitted.
        half_width: of its 95 % interval.
        fixed: seconds that do not grow, fitted.
        growing: seconds beyond them at the largest size, fitted.
        theory: exponent of the most expensive stage.
        because: which stage that is.
        counters: of unknowns, iterations and the like, which no noise disturbs: the exponent of those that grow.
    """

    method: str
    size: str
    sizes: tuple[Positive, ...]
    seconds: tuple[Positive, ...]
    exponent: Finite
    half_width: NotNegative
    theory: Finite
    because: str
    fixed: NotNegative = 0.0
    growing: NotNegative = 0.0
    counters: dict[str, Finite] = field(default_factory=dict)


# -- figures: all numbers, no ink ----------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class Series:
    """One line or set of symbols; ``group`` lines of one scene share a colour, ``method`` chooses line or symbol.

    ``half_width`` is the uncertainty of y (shape as y) or empty; ``style`` overrides the line the method would get.
    """

    label: str
    method: str
    group: str
    x: Vector
    y: Vector
    half_width: Vector = ()
    style: Literal["by method", "solid", "dashed", "dotted", "symbols"] = "by method"


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class Panel:
    """One pair of axes; labels carry symbol and unit in mathtext, ranges (as printed in a paper) are optional."""

    title: str
    x_label: str
    y_label: str
    x_scale: Literal["linear", "log"] = "linear"
    y_scale: Literal["linear", "log"] = "linear"
    x_range: tuple[Finite, Finite] | None = None
    y_range: tuple[Finite, Finite] | None = None
    series: tuple[Series, ...]


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class Figure:
    """A figure of a case, for example Fig. 7 of the paper redrawn from both methods."""

    name: str
    title: str
    caption: str
    panels: tuple[Panel, ...]


# -- a case and a run ----------------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class SceneDescription:
    """A scene of a case: its name, the parameters that set it apart, and the scene itself as canonical JSON."""

    name: str
    parameters: Mapping
    canonical: str


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class EffectEntry:
    """What a part of a scene costs and moves: the scene solved with it and without.

    Attributes:
        scene: name of the scene.
        method: label of the method.
        effect: "Adhesion", "StandardSolid", .., or "finite thickness".
        seconds: processor time of a first solution of the whole scene.
        seconds_without: the same without the part; None where the scene has no answer without it.
        changes: relative change of each quantity without it, largest over the steps.
        remark: why there is no answer without it, or "".
    """

    scene: str
    method: str
    effect: str
    seconds: NotNegative
    seconds_without: NotNegative | None
    changes: dict[str, NotNegative] = field(default_factory=dict)
    remark: str = ""

    @property
    def share_of_time(self) -> float:
        """How much of the time goes into the part, not below zero; all of it where nothing is left without it."""
        if self.seconds_without is None:
            return 1.0
        return max(0.0, 1.0 - self.seconds_without / self.seconds) if self.seconds else 0.0

    def may_be_dropped(self, accuracy: float) -> bool:
        """Whether leaving the part out moves no quantity by more than the accuracy."""
        return bool(self.changes) and max(self.changes.values()) <= accuracy


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class CaseResult:
    """A case: its text, what each method answered, and how its claims ended."""

    name: str
    title: str
    question: str
    equations: tuple[str, ...]
    text: str
    scenes: tuple[SceneDescription, ...]
    runs: tuple[SceneRun, ...]
    claims: tuple[Claim, ...]
    convergence: tuple[ConvergenceStudy, ...] = ()
    work_precision: tuple[WorkPrecision, ...] = ()
    effects: tuple[EffectEntry, ...] = ()
    ladders: tuple[Ladder, ...] = ()
    coverage: tuple[CoverageRecord, ...] = ()
    maps: tuple[ErrorMap, ...] = ()
    scaling: tuple[ScalingFit, ...] = ()
    figures: tuple[Figure, ...] = ()

    @property
    def status(self) -> Status:
        """The status that decides for this case, of solutions that broke down and of claims."""
        return worst([claim.status for claim in self.claims] + [run.status for run in self.runs])


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class Acceptance:
    """An entry of the baseline history: who accepted which change, and why; tolerances are relative."""

    date: str
    case: str
    method: str
    quantity: str
    old: Finite | None
    new: Finite | None
    old_tolerance: NotNegative | None
    new_tolerance: NotNegative | None
    reason: str
    revision: str


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class Stamp:
    """Where and with what a run was made.

    Attributes:
        started: UTC, ISO 8601.
        wall_seconds: duration of the run.
        revision: commit of the source; "unknown" outside a repository.
        dirty: whether the working tree had changes.
        python: version.
        platform: operating system and machine.
        processor: model name.
        cores: processors this run could use.
        threads: threads of each numerical library really loaded, by name ("openblas 0.3.27 Haswell": 1).
        versions: of the packages computed with.
        mesh_hashes: by case, scene and method.
    """

    started: str
    wall_seconds: NotNegative
    revision: str
    dirty: bool
    python: str
    platform: str
    processor: str
    cores: int
    threads: dict[str, int]
    versions: dict[str, str]
    mesh_hashes: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class RunResult:
    """A whole run; ``complete`` is False when it was interrupted, and its records are valid all the same."""

    schema_version: Literal[1] = 1
    suite: str
    complete: bool
    stamp: Stamp
    cases: tuple[CaseResult, ...]
    acceptances: tuple[Acceptance, ...] = ()

    def case(self, name: str) -> CaseResult:
        """Return the case called ``name``.

        Raises:
            KeyError: if the run has none of that name.
        """
        return {case.name: case for case in self.cases}[name]

    @property
    def statuses(self) -> tuple[Status, ...]:
        """Every status of the run: of solutions and of claims."""
        runs = [run.status for case in self.cases for run in case.runs]
        claims = [claim.status for case in self.cases for claim in case.claims]
        return tuple(runs + claims)
