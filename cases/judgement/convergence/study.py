"""Everything this package can say about one sequence of refinements."""

from dataclasses import dataclass

from cases.judgement.convergence.asymptotic import is_asymptotic
from cases.judgement.convergence.behaviour import behaviour
from cases.judgement.convergence.extrapolation import extrapolated, grid_convergence_index, safety_factor
from cases.judgement.convergence.least_squares import fit
from cases.judgement.convergence.observed_order import observed_order
from cases.judgement.convergence.spectral import digits_per_refinement
from cases.results.records.convergence import ConvergenceClass, ConvergenceStudy, Grid
from cases.results.records.scene_run import Quantity
from contact import InvalidInput

_HAS_ORDER = {ConvergenceClass.MONOTONE, ConvergenceClass.OSCILLATORY, ConvergenceClass.DIVERGENT}


@dataclass(frozen=True, kw_only=True)
class Refinements:
    """A quantity on successive grids, finest first; lengths are relative to the coarsest."""

    lengths: tuple[float, ...]
    values: tuple[float, ...]
    unknowns: tuple[int, ...]
    seconds: tuple[float, ...]


def study_of(
    sequence: Refinements,
    *,
    scene: str,
    method: str,
    quantity: Quantity,
    formal_order: float | None,
    mesh_family: str,
    reference: float | None,
    reference_uncertainty: float,
    reference_source: str,
    floor: float,
) -> ConvergenceStudy:
    """Return the study of ``sequence``; ``formal_order`` None means spectral convergence."""
    errors = tuple(None if reference is None else abs(value - reference) for value in sequence.values)
    if formal_order is None:
        kind, order, limit = ConvergenceClass.SPECTRAL, None, None
    else:
        kind = behaviour(sequence.values, floor=floor * quantity.scale)
        order, limit = _order_and_limit(sequence, formal_order) if kind in _HAS_ORDER else (None, None)
    indices = _indices(sequence, order, formal_order, quantity.scale)
    return ConvergenceStudy(
        scene=scene,
        method=method,
        quantity=quantity.name,
        unit=quantity.unit,
        scale=quantity.scale,
        mesh_family=mesh_family,
        kind=kind,
        grids=tuple(
            Grid(length=h, unknowns=n, seconds=s, value=v, error=e, gci=g)
            for h, n, s, v, e, g in zip(
                sequence.lengths, sequence.unknowns, sequence.seconds, sequence.values, errors, indices, strict=True
            )
        ),
        formal_order=formal_order,
        observed_order=order,
        digits_per_refinement=None if formal_order else _digits(errors, sequence, quantity.scale, floor),
        extrapolated=limit,
        asymptotic=is_asymptotic(sequence.values, sequence.lengths, formal_order) if order and formal_order else None,
        reference=reference,
        reference_uncertainty=reference_uncertainty * quantity.scale,
        reference_source=reference_source,
    )


def _order_and_limit(sequence: Refinements, formal: float) -> tuple[float, float | None]:
    """Three grids by the fixed-point formula; four and more by least squares."""
    if len(sequence.values) > 3:
        fitted = fit(sequence.values, sequence.lengths, formal)
        return fitted.observed_order, fitted.limit
    order = observed_order(sequence.values, sequence.lengths)
    ratio = sequence.lengths[1] / sequence.lengths[0]
    return order, extrapolated(sequence.values[0], sequence.values[1], ratio, order) if order > 0 else None


def _indices(
    sequence: Refinements, order: float | None, formal: float | None, scale: float
) -> tuple[float | None, ...]:
    """The grid convergence index of each grid against the next coarser one; None for the coarsest."""
    grids = len(sequence.values)
    if order is None or formal is None:
        return (None,) * grids
    safety, used = safety_factor(order, formal)
    pairs = zip(range(grids - 1), range(1, grids), strict=True)
    return (
        *(
            grid_convergence_index(
                sequence.values[i],
                sequence.values[j],
                sequence.lengths[j] / sequence.lengths[i],
                used,
                safety=safety,
                scale=scale,
            )
            for i, j in pairs
        ),
        None,
    )


def _digits(errors: tuple[float | None, ...], sequence: Refinements, scale: float, floor: float) -> float | None:
    """Digits per refinement against the reference, or else against the finest grid; None when all are at the floor."""
    known = [abs(value - sequence.values[0]) for value in sequence.values[1:]] if None in errors else list(errors)
    try:
        return digits_per_refinement([error / scale for error in known if error is not None], floor=floor)
    except InvalidInput:
        return None
