"""What was measured: how accurate and how fast each setting was on random scenes of one kind."""

import statistics
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Annotated

from pydantic import ConfigDict, Field, TypeAdapter
from pydantic.dataclasses import dataclass

from cases.results.files import write_whole
from cases.results.sealed import read_sealed, sealed_text, unsealed, validated

_RECORD = ConfigDict(extra="forbid")
_REMEDY = "measure it anew with contact-verify calibrate"
_Positive = Annotated[float, Field(allow_inf_nan=False, gt=0)]


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class MeasuredSetting:
    """One setting on a sample of scenes.

    Attributes:
        kind: Of scenes.
        band: Largest a/h of the sample.
        method: Name in the method table.
        settings: Of the method.
        bounds: Of each answer, in ascending order: the larger of U = error + reference uncertainty and of the stated
            error, relative, over all quantities.
        seconds: Median processor time of a first solution [s].
        refused: How many scenes the method refused by name.
    """

    kind: str
    band: _Positive
    method: str
    settings: dict[str, bool | int | float | str]
    bounds: Annotated[tuple[_Positive, ...], Field(min_length=1)]
    seconds: _Positive
    refused: Annotated[int, Field(ge=0)] = 0

    @property
    def scenes(self) -> int:
        """Size of the sample."""
        return len(self.bounds) + self.refused

    @property
    def best(self) -> float:
        """Smallest bound of the sample."""
        return min(self.bounds)

    @property
    def typical(self) -> float:
        """Median bound of the sample."""
        return statistics.median(self.bounds)

    @property
    def worst(self) -> float:
        """Largest bound of the sample; refused scenes have none."""
        return max(self.bounds)

    def reached(self, accuracy: float) -> int:
        """In how many scenes the bound is within a relative accuracy; in refused ones it is not."""
        return sum(bound <= accuracy for bound in self.bounds)

    def share(self, accuracy: float) -> float:
        """In which share of the sample the bound is within a relative accuracy."""
        return self.reached(accuracy) / self.scenes


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class Evidence:
    """All measurements of one machine.

    Attributes:
        machine: Processor.
        revision: Of the source that was measured.
        seed: Of the scenes.
        measurements: In any order.
    """

    machine: str
    revision: str
    seed: int
    measurements: tuple[MeasuredSetting, ...]


_ADAPTER: TypeAdapter[Evidence] = TypeAdapter(Evidence)


@cache
def shipped() -> Evidence:
    """The evidence that comes with the package."""
    place = "measured.json"
    data = files("cases.measurements.evidence").joinpath(place).read_bytes()
    return validated(_ADAPTER, unsealed(data, place=place, remedy=_REMEDY), place=place, remedy=_REMEDY)


def read(path: Path) -> Evidence:
    """Evidence from a file that `write` wrote.

    Raises:
        InvalidInput: In one line, if the file is none, or was changed after it was written.
    """
    return validated(_ADAPTER, read_sealed(path, remedy=_REMEDY), place=str(path), remedy=_REMEDY)


def write(path: Path, evidence: Evidence) -> None:
    """Write evidence as sealed JSON, whole or not at all."""
    write_whole(path, sealed_text(_ADAPTER.dump_python(evidence, mode="json")))
