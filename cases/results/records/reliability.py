"""Where methods break: stability ladders."""

from dataclasses import field

from pydantic.dataclasses import dataclass

from cases.results.records.field_types import RECORD, NotNegative, Positive
from cases.results.status import Status


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
