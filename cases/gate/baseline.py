"""What was accepted: one file a case and method, ``baselines/<case>/<method>.json``, every float with all its digits.

A file is written by ``accept`` alone.  Its digest covers every record, so that a tolerance edited by hand is refused.
"""

import hashlib
import json
import math
from pathlib import Path
from typing import Any, Self

from pydantic import ConfigDict, TypeAdapter, ValidationError, model_validator
from pydantic.dataclasses import dataclass

from cases.judgement.rules.tolerance import relative_tolerance
from cases.results.files import write_whole
from cases.results.records import Finite, Mapping, NotNegative, Positive, Vector
from contact import InvalidInput

BASELINE_VERSION = 1
REMEDY = "restore it from the repository, or accept the case anew"

_RECORD = ConfigDict(extra="forbid")


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class AcceptedQuantity:
    """An accepted quantity of one scene at one choice of settings.

    Attributes:
        scene: name of the scene within its case.
        settings: numerical settings of the method.
        specification: hash of scene and settings; other than this means another problem, not another answer.
        quantity: its name.
        unit: SI unit.
        scale: size that differences are relative to where the value is smaller, same unit.
        values: shape (n,).
        uncertainty: the method's own numerical uncertainty U, same unit, shape (n,); empty where it states none.
        spread: largest relative difference measured between solutions that should be equal.
        tolerance: relative, max(10 x spread, 1e-12).
        reason: why these values were accepted.
    """

    scene: str
    settings: Mapping
    specification: str
    quantity: str
    unit: str
    scale: Positive
    values: Vector
    uncertainty: tuple[NotNegative, ...]
    spread: NotNegative
    tolerance: Finite
    reason: str

    @model_validator(mode="after")
    def _tolerance_follows_from_spread(self) -> Self:
        expected = relative_tolerance(self.spread)
        if not math.isclose(self.tolerance, expected, rel_tol=1e-15):
            raise ValueError(f"tolerance {self.tolerance} is not max(10 x spread, 1e-12) = {expected}; {REMEDY}")
        return self

    @property
    def place(self) -> tuple[str, str]:
        """Scene and quantity: unique within a file."""
        return self.scene, self.quantity


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class AcceptedCounters:
    """What a solution costs in counts that repeat: unknowns, factorisations, iterations, transforms, steps."""

    scene: str
    specification: str
    counters: dict[str, int]


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class Baseline:
    """All that was accepted of one method on one case; ``suites`` are the runs that must contain it."""

    version: int = BASELINE_VERSION
    case: str
    method: str
    suites: tuple[str, ...]
    records: tuple[AcceptedQuantity, ...]
    counters: tuple[AcceptedCounters, ...]


_BASELINE: TypeAdapter[Baseline] = TypeAdapter(Baseline)


def baseline_path(folder: Path, case: str, method: str) -> Path:
    """Return where the baseline of ``method`` on ``case`` lies."""
    return folder / case / f"{method}.json"


def write_baseline(folder: Path, baseline: Baseline) -> None:
    """Write the file of ``baseline``, whole or not at all; only ``accept`` calls this."""
    path = baseline_path(folder, baseline.case, baseline.method)
    path.parent.mkdir(parents=True, exist_ok=True)
    tree = _BASELINE.dump_python(baseline, mode="json")
    write_whole(path, _text({"digest": digest_of(tree), "baseline": tree}))


def read_baselines(folder: Path) -> tuple[Baseline, ...]:
    """Return every baseline below ``folder``, ordered by case and method; none if there is no folder.

    Raises:
        InvalidInput: if a file is damaged, non-finite, of another version or edited by hand.
    """
    return tuple(_read(path) for path in sorted(folder.glob("*/*.json")))


def _read(path: Path) -> Baseline:
    try:
        stored = json.loads(path.read_text(encoding="utf-8"), parse_constant=_refuse_constant)
        tree, digest = stored["baseline"], stored["digest"]
        version = tree["version"]
    except (ValueError, KeyError, TypeError) as error:
        raise InvalidInput(f"{path} is no baseline ({error}); {REMEDY}") from error
    if version != BASELINE_VERSION:
        raise InvalidInput(f"{path} has version {version!r}, this program reads {BASELINE_VERSION}; accept it anew")
    if digest != digest_of(tree):
        raise InvalidInput(f"{path} was changed by something else than accept; {REMEDY}")
    return _validated(tree, path)


def _validated(tree: dict[str, Any], path: Path) -> Baseline:
    try:
        baseline = _BASELINE.validate_python(tree)
    except ValidationError as error:
        first = error.errors()[0]
        raise InvalidInput(f"{path}: {'.'.join(map(str, first['loc']))}: {first['msg']}; {REMEDY}") from error
    if path.parts[-2:] != (baseline.case, f"{baseline.method}.json"):
        raise InvalidInput(f"{path} holds {baseline.method} on {baseline.case}; move it to where it belongs")
    return baseline


def _refuse_constant(name: str) -> float:
    raise ValueError(f"non-finite number {name}")


def _text(tree: dict[str, Any]) -> str:
    return json.dumps(tree, sort_keys=True, indent=1, allow_nan=False) + "\n"


def digest_of(tree: dict[str, Any]) -> str:
    """Return the digest that tells whether a file was edited by hand."""
    return hashlib.sha256(_text(tree).encode()).hexdigest()[:32]
