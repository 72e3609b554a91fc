"""What accuracy costs: error against seconds, growth with size, and what an effect costs and moves."""

from dataclasses import field

from pydantic.dataclasses import dataclass

from cases.results.records.field_types import RECORD, Finite, Mapping, NotNegative, Positive
from cases.results.records.scene_run import Stage
from cases.results.status import Status


@dataclass(frozen=True, kw_only=True, config=RECORD)
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


@dataclass(frozen=True, kw_only=True, config=RECORD)
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
    # The first solution with the same setting took this long.
    cold_seconds: NotNegative | None = None
    bound: NotNegative | None
    peak_memory_bytes: int | None
    # Relative to the reference method's T* at the same tolerance; None where either is missing.
    speed_up: Positive | None


@dataclass(frozen=True, kw_only=True, config=RECORD)
class DigitPrice:
    """What the next digit costs on the front: decades of time per digit between neighbours."""

    method: str
    from_label: str
    to_label: str
    decades_per_digit: Finite


@dataclass(frozen=True, kw_only=True, config=RECORD)
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


@dataclass(frozen=True, kw_only=True, config=RECORD)
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

    @property
    def largest_change(self) -> float:
        """Over all quantities; infinite where nothing is left without the part."""
        return max(self.changes.values(), default=float("inf"))

    def may_be_dropped(self, accuracy: float) -> bool:
        """Whether leaving the part out moves no quantity by more than the accuracy."""
        return self.largest_change <= accuracy

    @property
    def line(self) -> str:
        """In words: "viscosity: 61 % of the time, moves peak force by 0.02 %"."""
        if not self.changes:
            return f"{self.effect}: {self.remark}"
        quantity = max(self.changes, key=lambda name: self.changes[name])
        moved = f"moves {quantity.replace('_', ' ')} by {100 * self.changes[quantity]:.2g} %"
        return f"{self.effect}: {100 * self.share_of_time:.0f} % of the time, {moved}"
