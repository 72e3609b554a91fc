"""Everything this package can say about one sequence of refinements."""

from collections.abc import Sequence
from dataclasses import dataclass

from cases.judgement.convergence.asymptotic import is_asymptotic
from cases.judgement.convergence.behaviour import behaviour
from cases.judgement.convergence.extrapolation import extrapolated, grid_convergence_index, safety_factor
from cases.judgement.convergence.known_errors import (
    behaviour_of_errors,
    digits_per_refinement,
    errors_follow_order,
    order_of_errors,
)
from cases.judgement.convergence.least_squares import fit
from cases.judgement.convergence.observed_order import observed_order
from cases.results.records.convergence import ConvergenceClass, ConvergenceStudy, Grid
from cases.results.records.scene_run import Quantity
from contact import InvalidInput

_HAS_ORDER = {ConvergenceClass.MONOTONE, ConvergenceClass.OSCILLATORY, ConvergenceClass.DIVERGENT}


@dataclass(frozen=True, kw_only=True)
class Refinements:
    """A quantity on successive refinements, finest first.

    Attributes:
        lengths: of the discretisation, relative to the coarsest.
        values: of the first grid of each refinement.
        unknowns: of that grid.
        seconds: of that grid.
        errors: absolute, against the reference; empty without one.
        stated: errors that the method states, absolute; None where it states none; empty where none are kept.
    """

    lengths: tuple[float, ...]
    values: tuple[float, ...]
    unknowns: tuple[int, ...]
    seconds: tuple[float, ...]
    errors: tuple[float, ...] = ()
    stated: tuple[float | None, ...] = ()


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
    """Return the study of ``sequence``; ``formal_order`` None means spectral convergence.

    The order is that of the errors where the reference is ten times as exact as the finest grid, else of the values.
    """
    measured = sequence.errors or tuple(abs(value - reference) for value in sequence.values if reference is not None)
    errors: tuple[float | None, ...] = measured or (None,) * len(sequence.values)
    is_known = bool(measured) and measured[0] > 10 * reference_uncertainty * quantity.scale
    if formal_order is None:
        found = _Found(ConvergenceClass.SPECTRAL)
    elif is_known:
        found = _of_errors(measured, sequence.lengths, formal_order, floor * quantity.scale)
    else:
        found = _of_values(sequence, formal_order, floor * quantity.scale)
    grids = zip(
        sequence.lengths,
        sequence.unknowns,
        sequence.seconds,
        sequence.values,
        errors,
        _indices(sequence, found.order, formal_order, quantity.scale),
        sequence.stated or (None,) * len(errors),
        strict=True,
    )
    return ConvergenceStudy(
        scene=scene,
        method=method,
        quantity=quantity.name,
        unit=quantity.unit,
        scale=quantity.scale,
        mesh_family=mesh_family,
        kind=found.kind,
        grids=tuple(
            Grid(length=h, unknowns=n, seconds=s, value=v, error=e, gci=g, stated=u) for h, n, s, v, e, g, u in grids
        ),
        formal_order=formal_order,
        observed_order=found.order,
        digits_per_refinement=None if formal_order else _digits(errors, sequence, quantity.scale, floor),
        extrapolated=found.limit,
        asymptotic=found.asymptotic,
        reference=reference,
        reference_uncertainty=reference_uncertainty * quantity.scale,
        reference_source=reference_source,
    )


@dataclass(frozen=True)
class _Found:
    """Class, order, limit and asymptotic range of one sequence."""

    kind: ConvergenceClass
    order: float | None = None
    limit: float | None = None
    asymptotic: bool | None = None


def _of_errors(errors: Sequence[float], lengths: Sequence[float], formal: float, floor: float) -> _Found:
    kind = behaviour_of_errors(errors, floor=floor)
    if kind not in _HAS_ORDER:
        return _Found(kind)
    return _Found(kind, order_of_errors(errors, lengths), None, errors_follow_order(errors, lengths, formal))


def _of_values(sequence: Refinements, formal: float, floor: float) -> _Found:
    kind = behaviour(sequence.values, floor=floor)
    if kind not in _HAS_ORDER:
        return _Found(kind)
    return _Found(kind, *_order_and_limit(sequence, formal), is_asymptotic(sequence.values, sequence.lengths, formal))


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
