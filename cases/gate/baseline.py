"""What was accepted: one file a case and method, ``baselines/<case>/<method>.json``, every float with all its digits.

A file is written by ``accept`` alone.
"""

import math
from pathlib import Path
from typing import Any, Self

from pydantic import ConfigDict, TypeAdapter, model_validator
from pydantic.dataclasses import dataclass

from cases.judgement.rules.tolerance import relative_tolerance
from cases.results.files import write_whole
from cases.results.records.claim import Kind
from cases.results.records.field_types import Finite, NotNegative, Positive, Vector
from cases.results.strict_json import json_text, read_json, validated
from contact import InvalidInput

# Files of another version are refused.
BASELINE_VERSION = 2
REMEDY = "restore it from the repository, or accept the case anew"
_ENTRY = "baseline"

_RECORD = ConfigDict(extra="forbid")


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class AcceptedQuantity:
    """An accepted quantity of one scene at one choice of settings.

    Attributes:
        scene: name of the scene within its case.
        specification: hash of the scene and of the settings asked for; another hash means another problem.
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
    """What a solution costs in counts that repeat: unknowns, factorisations, iterations, transforms, steps.

    Attributes:
        scene: name of the scene within its case.
        specification: hash of the scene and of the settings asked for.
        counters: by name.
        curves: relative uncertainty that the method states of a field or history, by its name; None where the case was
            accepted before these were watched.
    """

    scene: str
    specification: str
    counters: dict[str, int]
    curves: dict[str, NotNegative] | None = None


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class AcceptedClaim:
    """A claim that was judged when its case was accepted.

    Attributes:
        name: of the claim.
        kind: what it compares with.
        quantity: what is compared.
        methods: the method, or the two methods compared.
        judged: on how many scenes, or groups of them.
    """

    name: str
    kind: Kind
    quantity: str
    methods: tuple[str, ...]
    judged: int

    @property
    def identity(self) -> tuple[str, Kind, str, tuple[str, ...]]:
        """Everything but the count."""
        return self.name, self.kind, self.quantity, self.methods


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class Baseline:
    """All that was accepted of one method on one case.

    ``suites`` are the runs that must contain it; ``claims`` speak of the method, alone or beside another one, and are
    None where the case was accepted before claims were watched.
    """

    version: int = BASELINE_VERSION
    case: str
    method: str
    suites: tuple[str, ...]
    records: tuple[AcceptedQuantity, ...]
    counters: tuple[AcceptedCounters, ...]
    claims: tuple[AcceptedClaim, ...] | None = None


_BASELINE: TypeAdapter[Baseline] = TypeAdapter(Baseline)


def baseline_path(folder: Path, case: str, method: str) -> Path:
    """Return where the baseline of ``method`` on ``case`` lies."""
    return folder / case / f"{method}.json"


def write_baseline(folder: Path, baseline: Baseline) -> None:
    """Write the file of ``baseline``, whole or not at all; only ``accept`` calls this."""
    path = baseline_path(folder, baseline.case, baseline.method)
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, json_text({_ENTRY: _BASELINE.dump_python(baseline, mode="json")}))


def read_baselines(folder: Path) -> tuple[Baseline, ...]:
    """Return every baseline below ``folder``, ordered by case and method; none if there is no folder.

    Raises:
        InvalidInput: if a file is damaged, non-finite or of another version.
    """
    return tuple(_read(path) for path in sorted(folder.glob("*/*.json")))


def _read(path: Path) -> Baseline:
    tree: Any = read_json(path, remedy=REMEDY).get(_ENTRY)
    version = tree.get("version") if isinstance(tree, dict) else None
    if version != BASELINE_VERSION:
        raise InvalidInput(f"{path} has version {version!r}, this program reads {BASELINE_VERSION}; accept it anew")
    return _validated(tree, path)


def _validated(tree: dict[str, Any], path: Path) -> Baseline:
    baseline = validated(_BASELINE, tree, place=str(path), remedy=REMEDY)
    if path.parts[-2:] != (baseline.case, f"{baseline.method}.json"):
        raise InvalidInput(f"{path} holds {baseline.method} on {baseline.case}; move it to where it belongs")
    return baseline
