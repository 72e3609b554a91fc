"""Records of studies: convergence, cost of accuracy, stress tests, effects of the parts of a scene."""

from dataclasses import field
from typing import TypeAlias

from pydantic.dataclasses import dataclass

from cases.verdicts import RECORD, Finite, Mapping, NotNegative, Positive, Status


@dataclass(frozen=True, kw_only=True, config=RECORD)
class Grid:
    """One refinement: length relative to the coarsest, value, error against the reference, error that is stated."""

    length: Positive
    unknowns: int
    seconds: NotNegative
    value: Finite
    error: NotNegative | None
    stated: NotNegative | None = None


@dataclass(frozen=True, kw_only=True, config=RECORD)
class Convergence:
    """A quantity of one scene and method under refinement, finest grid first.

    Attributes:
        refined: Family of meshes or setting that is refined; the formal order belongs to it.
        kind: Monotone, oscillatory, divergent, floor, too-few or spectral.
        grids: Refinements, finest first; errors are absolute.
        scale: Value by which errors are divided, unit of the quantity.
        formal_order: Formal order; None for spectral convergence.
        observed_order: Observed order; None where ``kind`` has none.
        digits: Digits per refinement of spectral convergence; None otherwise.
        reference: Value of the reference solution; None without one.
        reference_error: Absolute error of the reference.
        source: Method or closed form that gives the reference.
    """

    case: str
    scene: str
    method: str
    quantity: str
    unit: str
    refined: str
    kind: str
    grids: tuple[Grid, ...]
    scale: Positive
    formal_order: Positive | None
    observed_order: Finite | None
    digits: Finite | None
    reference: Finite | None
    reference_error: NotNegative
    source: str


@dataclass(frozen=True, kw_only=True, config=RECORD)
class Point:
    """One setting of one method, timed: relative error, bound U = error + error of the reference, median seconds.

    Attributes:
        setting: Setting in words.
        error: Relative error; None where the setting has no answer, for the reason in ``reason``.
        bound: U; None where the error is None.
        quartiles: Lower and upper quartile of the seconds.
        cold_seconds: Time of the first solution, with empty caches.
        on_front: Whether no other setting of any method is at least as accurate and clearly faster.
    """

    method: str
    setting: str
    settings: Mapping = field(default_factory=dict)
    reason: str = ""
    error: NotNegative | None = None
    bound: NotNegative | None = None
    seconds: NotNegative = 0.0
    quartiles: tuple[NotNegative, NotNegative] = (0.0, 0.0)
    cold_seconds: NotNegative = 0.0
    unknowns: int = 0
    memory: int = 0
    on_front: bool = False


@dataclass(frozen=True, kw_only=True, config=RECORD)
class CostOfAccuracy:
    """Error against seconds of all methods on one scene; errors are relative, nothing is interpolated.

    Attributes:
        reference: Name of the reference solution that errors are measured against.
        reference_error: Relative error of the reference.
        noise: Relative spread of repeated times.
    """

    case: str
    scene: str
    quantity: str
    reference: str
    reference_error: NotNegative
    noise: NotNegative
    points: tuple[Point, ...]


@dataclass(frozen=True, kw_only=True, config=RECORD)
class Step:
    """One step of a stress test: value of the parameter, digits that repeats share (None if refused), the reason."""

    value: Positive
    status: Status
    digits: NotNegative | None
    reason: str = ""
    residuals: dict[str, NotNegative] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True, config=RECORD)
class StressTest:
    """A parameter made harder step by step, from easy to hard; ``parameter`` has its symbol, "1/2 - nu"."""

    case: str
    name: str
    parameter: str
    unit: str
    method: str
    quantity: str
    steps: tuple[Step, ...]


@dataclass(frozen=True, kw_only=True, config=RECORD)
class Effect:
    """Cost of a part of a scene ("Adhesion", "finite thickness"), and change of the answer without it.

    Attributes:
        seconds: Processor time of a first solution of the whole scene [s].
        seconds_without: Processor time without the part [s]; None where the scene has no answer without it.
        changes: Relative change of each quantity without the part, largest over the steps.
        remark: Reason why there is no answer without the part, or "".
    """

    case: str
    scene: str
    method: str
    part: str
    seconds: NotNegative
    seconds_without: NotNegative | None = None
    changes: dict[str, NotNegative] = field(default_factory=dict)
    remark: str = ""

    @property
    def share_of_time(self) -> float:
        """Share of the time that the part takes, at least zero; one where the scene has no answer without it."""
        if self.seconds_without is None:
            return 1.0
        return max(0.0, 1.0 - self.seconds_without / self.seconds) if self.seconds else 0.0

    @property
    def largest_change(self) -> float:
        """Largest relative change over all quantities; infinite where the scene has no answer without the part."""
        return max(self.changes.values(), default=float("inf"))

    def may_be_dropped(self, accuracy: float) -> bool:
        """Whether leaving the part out changes no quantity by more than the accuracy."""
        return self.largest_change <= accuracy

    @property
    def line(self) -> str:
        """In words: "without it peak force changes by 0.02 %. It takes 61 % of the run time."."""
        if not self.changes:
            return self.remark
        quantity = max(self.changes, key=lambda name: self.changes[name])
        changed = f"without it {quantity.replace('_', ' ')} changes by {100 * self.changes[quantity]:.2g} %"
        return f"{changed}. It takes {100 * self.share_of_time:.0f} % of the run time."


Record: TypeAlias = Convergence | CostOfAccuracy | StressTest | Effect
