"""Where methods break and how well they state their errors: ladders, coverage, maps of errors."""

from dataclasses import field
from itertools import groupby
from typing import Self

from pydantic import model_validator
from pydantic.dataclasses import dataclass

from cases.results.records.field_types import RECORD, Finite, Mapping, NotNegative, Positive, Vector
from cases.results.status import Status

# Where the distribution of stated over true errors is kept, in per cent.
PERCENTILES = tuple(range(0, 101, 2))
# The row of a map for the layer that does not see Poisson's ratio.
UNBONDED = "unbonded"


@dataclass(frozen=True, kw_only=True, config=RECORD)
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


@dataclass(frozen=True, kw_only=True, config=RECORD)
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

    @property
    def breakdown(self) -> Rung | None:
        """The first rung that was refused or failed; None if the whole ladder was climbed."""
        return next((rung for rung in self.rungs if rung.status is not Status.PASS), None)

    @property
    def fewest_digits(self) -> float | None:
        """The fewest digits of a rung that was climbed; None if none was."""
        return min((rung.digits for rung in self.rungs if rung.digits is not None), default=None)

    def worse_than(self, accepted: "Ladder") -> list[str]:
        """What is worse than an accepted ladder: an earlier breakdown, a digit lost on a rung, or a rung not walked."""
        walked = {rung.value: rung for rung in self.rungs}
        found = []
        for before in accepted.rungs:
            if before.digits is None:
                continue
            missing = Rung(value=before.value, status=Status.INVALID, reason="not walked", digits=None)
            rung = walked.get(before.value, missing)
            place = f"{self.name}, {self.method}, {self.parameter} = {rung.value:g}"
            if rung.digits is None:
                found.append(f"{place}: {rung.reason or rung.status}, but {before.digits:.1f} digits were accepted")
            elif rung.digits < before.digits - 1.0:
                found.append(f"{place}: {rung.digits:.1f} digits, but {before.digits:.1f} were accepted")
        return found


@dataclass(frozen=True, kw_only=True, config=RECORD)
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

    @property
    def at_90(self) -> float:
        """Stated over true error at 90 %, zero where no true error could be told."""
        return self.percentiles[PERCENTILES.index(90)] if self.percentiles else 0.0


@dataclass(frozen=True, kw_only=True, config=RECORD)
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

    def good_ranges(self, row: str, limit: float = 1e-2) -> tuple[tuple[float, float], ...]:
        """Smallest and largest a/h of each run of neighbours of a row with errors within the limit."""
        errors = zip(self.ratios, self.errors[self.rows.index(row)], strict=True)
        runs = groupby(errors, key=lambda place: place[1] is not None and abs(place[1]) <= limit)
        found = [[ratio for ratio, _ in run] for good, run in runs if good]
        return tuple((run[0], run[-1]) for run in found)

    @model_validator(mode="after")
    def _full(self) -> Self:
        if len(self.errors) != len(self.rows) or any(len(row) != len(self.ratios) for row in self.errors):
            raise ValueError(f"{self.name}: a map needs one error for each row and ratio")
        return self
