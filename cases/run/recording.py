"""From a method's answer to the records a run keeps: quantities with units and uncertainties, sampled curves."""

from collections.abc import Iterator

import numpy as np

from cases.declare.quantities import IMPACT_NUMBERS, values_of
from cases.declare.task import Sampling
from cases.results.records.scene_run import CostRecord, Curve, Quantity, Stage
from cases.run.inside.points import inside_curves, inside_quantities
from contact import (
    UNITS,
    ContactPath,
    Cost,
    DetachmentPath,
    ForcePath,
    HistoryPath,
    ImpactHistory,
    Solution,
    StageRecord,
)
from contact.records.validation import FloatArray

_SCALES = {"energy_residual": 1.0}  # already over the initial energy: its own size is rounding
_ON_BRANCH = {"pull_off_force": "normal_force", "pull_off_depth": "indentation_depth", "force_at_loss": "normal_force"}


def quantities(solution: Solution, sampling: Sampling) -> tuple[Quantity, ...]:
    """Return every quantity of the answer, along its steps; of an impact what sums it up, of a history its end."""
    if isinstance(solution, ImpactHistory):
        names = [*IMPACT_NUMBERS, "energy_residual"]
    else:
        names = [*(n for n in solution.ARRAYS if n != "time"), *solution.SCALARS]
    end = slice(-1, None) if isinstance(solution, HistoryPath) else slice(None)
    own_checks = [name for name in solution.error_estimate if name not in UNITS]
    return (
        *(_quantity(solution, name, sampling, end) for name in names),
        *(_check(solution, name) for name in own_checks),
        *(inside_quantities(solution, sampling) if sampling.inside and isinstance(solution, ContactPath) else ()),
    )


def _quantity(solution: Solution, name: str, sampling: Sampling, steps: slice) -> Quantity:
    values = values_of(solution, name)
    uncertainty = _uncertainty(solution, name, values.size)[steps]
    values = values[steps]
    return Quantity(
        name=name,
        unit=UNITS.get(name, "1"),
        scale=sampling.scales.get(name) or _SCALES.get(name) or _size(values),
        values=tuple(values.tolist()),
        uncertainty=uncertainty,
    )


def _check(solution: Solution, name: str) -> Quantity:
    """A residual that the method publishes beside its answer, such as an energy defect."""
    values = np.atleast_1d(solution.error_estimate[name])
    return Quantity(name=name, unit="1", scale=1.0, values=tuple(values.tolist()))


def _uncertainty(solution: Solution, name: str, size: int) -> tuple[float, ...]:
    if name not in solution.error_estimate:
        return _of_the_branch(solution, name)
    stated = np.abs(np.atleast_1d(solution.uncertainty(name)))
    if stated.size != size:
        # There is one number for all steps, or one for each step of a history whose peak is the quantity.
        return (float(np.max(stated)),) * size
    return tuple(stated.tolist())


def _of_the_branch(solution: Solution, name: str) -> tuple[float, ...]:
    """A critical point lies on the branch and is as uncertain as the state of the branch nearest to it."""
    branch = _ON_BRANCH.get(name, "")
    if branch not in solution.error_estimate or not isinstance(solution, DetachmentPath):
        return ()
    nearest = np.argmin(np.abs(solution.contact_radius - solution.pull_off_contact_radius))
    stated = np.broadcast_to(np.abs(solution.uncertainty(branch)), solution.contact_radius.shape)
    return (float(stated[nearest]),)


def _size(values: FloatArray) -> float:
    largest = float(np.max(np.abs(values)))
    return largest if largest > 0 else 1.0


def curves(solution: Solution, sampling: Sampling) -> tuple[Curve, ...]:
    """Return the sampled fields of a path's last step, or a history's channels over time."""
    if isinstance(solution, ContactPath):
        pressure = _pressure(solution, sampling) if sampling.ring_edges else ()
        return (*pressure, *(inside_curves(solution, sampling) if sampling.inside else ()))
    if isinstance(solution, ImpactHistory | HistoryPath):
        return tuple(_over(solution, "time", channel) for channel in solution.ARRAYS if channel != "time")
    if isinstance(solution, ForcePath):
        return ()
    return tuple(_over(solution, "contact_radius", channel) for channel in ("indentation_depth", "normal_force"))


def _pressure(path: ContactPath, sampling: Sampling) -> Iterator[Curve]:
    if path.fields is None:
        return
    radius = sampling.rings.radius.ravel()
    step = len(path) - 1
    estimate = path.error_estimate.get("pressure")
    yield Curve(
        name="pressure",
        x_name="radius",
        x_unit="m",
        x=tuple(radius.tolist()),
        unit=UNITS["pressure"],
        y=tuple(path.pressure(radius, step).tolist()),
        relative_uncertainty=None if estimate is None else float(np.broadcast_to(estimate, (len(path),))[step]),
    )


def _over(solution: Solution, x_name: str, channel: str) -> Curve:
    return Curve(
        name=channel,
        x_name=x_name,
        x_unit=UNITS[x_name],
        x=tuple(np.asarray(getattr(solution, x_name)).tolist()),
        unit=UNITS[channel],
        y=tuple(np.asarray(getattr(solution, channel)).tolist()),
    )


def cost_record(cost: Cost) -> CostRecord:
    """Return a method's cost as a record."""
    return CostRecord(
        wall_seconds=cost.wall_seconds,
        cpu_seconds=cost.cpu_seconds,
        peak_memory_bytes=cost.peak_memory_bytes,
        unknowns=cost.unknowns,
        counters=dict(cost.counters),
    )


def stage_records(stages: tuple[StageRecord, ...]) -> tuple[Stage, ...]:
    """Return a method's stages as records."""
    return tuple(
        Stage(name=s.name, calls=s.calls, seconds=s.wall_seconds, cpu_seconds=s.cpu_seconds, bytes=s.bytes)
        for s in stages
    )
