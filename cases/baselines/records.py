"""Accepted numbers of one case and method: quantities with their tolerance, and deterministic counters."""

import hashlib
import json
from dataclasses import field
from pathlib import Path
from typing import Literal

from pydantic import ConfigDict, TypeAdapter, ValidationError
from pydantic.dataclasses import dataclass

from cases.results import NotNegative, Positive, SceneDescription, SceneRun, Vector
from cases.results_files import write_whole
from contact import InvalidInput

_RECORD = ConfigDict(extra="forbid")
_OUTCOMES = {"mesh"}  # settings that report what was made, not what was asked for


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class AcceptedQuantity:
    """One accepted quantity of one scene.

    Attributes:
        scene: name of the scene.
        quantity: its name.
        unit: SI unit.
        scale: declared size.
        values: accepted values along the steps.
        uncertainty: the method's own, when accepted; empty when it states none.
        spread: measured relative spread under perturbed repeats.
        rtol: permitted relative change, max(10 x spread, 1e-12).
        atol: permitted absolute change.
        reason: why the number was accepted.
        specification: hash of scene and settings; another one cannot be compared.
    """

    scene: str
    quantity: str
    unit: str
    scale: Positive
    values: Vector
    uncertainty: tuple[NotNegative, ...]
    spread: NotNegative
    rtol: Positive
    atol: NotNegative = 0.0
    reason: str
    specification: str


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class AcceptedCounters:
    """Deterministic counters of one scene: unknowns, factorisations, iterations, transforms, steps."""

    scene: str
    specification: str
    counters: dict[str, int]


@dataclass(frozen=True, kw_only=True, config=_RECORD)
class Baseline:
    """Everything accepted of one case and method."""

    schema_version: Literal[1] = 1
    case: str
    method: str
    quantities: tuple[AcceptedQuantity, ...] = ()
    counters: tuple[AcceptedCounters, ...] = field(default=())


_BASELINE: TypeAdapter[Baseline] = TypeAdapter(Baseline)


def baseline_path(directory: Path, case: str, method: str) -> Path:
    """Return ``directory/case/method.json``."""
    return directory / case / f"{method}.json"


def accepted_methods(directory: Path, case: str) -> set[str]:
    """Return the methods that have a baseline for ``case``."""
    return {path.stem for path in (directory / case).glob("*.json")}


def read_baseline(directory: Path, case: str, method: str) -> Baseline | None:
    """Return what is accepted of a case and method; None when nothing is.

    Raises:
        InvalidInput: if the file is damaged or holds a non-finite number.
    """
    path = baseline_path(directory, case, method)
    if not path.is_file():
        return None
    try:
        return _BASELINE.validate_python(json.loads(path.read_text(encoding="utf-8")))
    except (ValidationError, ValueError) as error:
        raise InvalidInput(f"{path} is no baseline: {error}; restore it from version control") from error


def write_baseline(directory: Path, baseline: Baseline) -> None:
    """Write a baseline: sorted keys, every digit."""
    path = baseline_path(directory, baseline.case, baseline.method)
    path.parent.mkdir(parents=True, exist_ok=True)
    tree = _BASELINE.dump_python(baseline, mode="json")
    write_whole(path, json.dumps(tree, sort_keys=True, indent=1, allow_nan=False) + "\n")


def specification(scene: SceneDescription, run: SceneRun) -> str:
    """Return the hash of what was asked for: the scene and the settings, not the code that answered."""
    asked = {name: value for name, value in run.settings.items() if name not in _OUTCOMES}
    text = json.dumps({"scene": scene.canonical, "settings": asked}, sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def counters_of(run: SceneRun) -> dict[str, int]:
    """Return the counters of a run, unknowns among them."""
    return {} if run.cost is None else {"unknowns": run.cost.unknowns, **run.cost.counters}
