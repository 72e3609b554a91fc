"""What was measured: how accurate and how fast each setting was on random scenes of one kind."""

from __future__ import annotations

import json
import statistics
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Annotated, Any

from pydantic import ConfigDict, Field, TypeAdapter, ValidationError
from pydantic.dataclasses import dataclass

from cases.results.files import write_whole
from contact import InvalidInput
from contact.records.record import shown

_RECORD = ConfigDict(extra="forbid")
_Positive = Annotated[float, Field(allow_inf_nan=False, gt=0)]


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class Measurement:
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
    measurements: tuple[Measurement, ...]


_ADAPTER: TypeAdapter[Evidence] = TypeAdapter(Evidence)


@cache
def shipped() -> Evidence:
    """The evidence that comes with the package."""
    return _parsed(
        files("cases.measurements.evidence").joinpath("measured.json").read_text(encoding="utf-8"), "measured.json"
    )


def read(path: Path) -> Evidence:
    """Evidence from a file that `write` wrote.

    Raises:
        InvalidInput: If the file is none.
    """
    try:
        return _parsed(path.read_text(encoding="utf-8"), str(path))
    except (OSError, UnicodeDecodeError) as error:
        raise InvalidInput(
            f"{path}: cannot be read ({error!s:.160}); measure it with contact-verify calibrate"
        ) from None


def write(path: Path, evidence: Evidence) -> None:
    """Write evidence as JSON, whole or not at all."""
    write_whole(path, json.dumps(_ADAPTER.dump_python(evidence, mode="json"), indent=1, sort_keys=True) + "\n")


def _parsed(text: str, place: str) -> Evidence:
    try:
        tree: Any = json.loads(text)
        return _ADAPTER.validate_python(tree)
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"])
        wrong = f"{place}: {where:.200}: {first['msg']}, got {shown(first['input'])}"
        raise InvalidInput(f"{wrong}; measure it anew with contact-verify calibrate") from None
    except ValueError as error:
        raise InvalidInput(f"{place}: not readable as JSON ({error!s:.160})") from None
