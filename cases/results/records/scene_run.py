"""What one method answers on one scene: quantities, curves, and what they cost.  SI units."""

from dataclasses import field
from typing import Self

from pydantic import model_validator
from pydantic.dataclasses import dataclass

from cases.results.records.field_types import RECORD, Mapping, NotNegative, Positive, Vector
from cases.results.status import Status


@dataclass(frozen=True, kw_only=True, config=RECORD)
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


@dataclass(frozen=True, kw_only=True, config=RECORD)
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


@dataclass(frozen=True, kw_only=True, config=RECORD)
class Stage:
    """One stage of a solution: the raw data of the effect ledger."""

    name: str
    calls: int
    seconds: NotNegative
    cpu_seconds: NotNegative = 0.0
    bytes: int = 0


@dataclass(frozen=True, kw_only=True, config=RECORD)
class CostRecord:
    """What a solution cost: seconds, peak memory [bytes], unknowns, and counters that repeat exactly."""

    wall_seconds: NotNegative
    cpu_seconds: NotNegative
    peak_memory_bytes: int
    unknowns: int
    counters: dict[str, int] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True, config=RECORD)
class SceneRun:
    """One method on one scene: PASS with quantities, or another status with its reason.

    Attributes:
        key: content key; equal keys mean equal scene, settings, code and versions.
        scene: name of the scene within its case.
        method: name of the method in the method table.
        settings: numerical settings that the answer reports.
        specification: hash of the scene and of the settings asked for; empty where nothing was solved.
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
    specification: str = ""
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
