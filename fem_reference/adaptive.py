"""Settings for a requested accuracy: a first guess from measured error laws, refined until the estimate holds."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from typing import TypeVar

import numpy as np

from contact import HistoryPath, ImpactHistory, NotConvergedError, UnsupportedSceneError
from contact.answer.accuracy import asked_errors
from fem_reference.discrete_layer.settings import Discretisation

# The error of P4P3 falls like this power of the growth on graded meshes: measured, the theoretical 2k = 8 less what
# irregular meshes lose.  It chooses the next mesh only; a wrong value costs attempts, no accuracy.
ERROR_ORDER = 7.0
# An error above all that were estimated for P4P3 at growth 1/2 on punches, cones and paraboloids (measured).  It
# chooses the first mesh only.
ERROR_AT_HALF = 8e-6

# Share of the accuracy that the outer edge may cost.  At a load most other errors cancel to a hundredth of the accuracy
# or less (random elastic scenes at accuracy 1e-2, 2026-11-22), and this does not: with 3e-3 it was most of what was
# stated of unbonded layers.
FAR_SHARE = 1e-5
# The error of the pressure falls like this power of the growth.
PRESSURE_ORDER = 3.0
# Errors over what is wanted that count where an attempt did not converge: cells become half as large.
UNSETTLED = {"normal_force": 1e3}
# A finer mesh that leaves more than this share of the error was in vain; chosen: even the smallest step, cells of 0.9
# of their size, leaves 0.9^7 = 0.48 of it by the law above, 0.9^3 = 0.73 of the error of the pressure.
LEFT = 0.8
# After so many in a row the accuracy is refused, before a mesh fills the memory; chosen.
IN_VAIN = 2
# Refinements that are tried before an accuracy counts as out of reach.
ATTEMPTS = 6

S = TypeVar("S")
H = TypeVar("H", bound=HistoryPath | ImpactHistory)


def settings_for(accuracy: float) -> Discretisation:
    """A discretisation that usually meets ``accuracy`` (relative) at the first attempt."""
    # Beyond a growth of one a mesh has fewer than a hundred triangles, on which the errors of three degrees say little.
    growth = float(np.clip(0.5 * (accuracy / ERROR_AT_HALF) ** (1 / ERROR_ORDER), 0.05, 1.0))
    return Discretisation(
        order=4,
        growth=growth,
        edge_cell=float(np.clip(accuracy / 2, 1e-11, 1e-3)),
        truncation=max(FAR_SHARE * accuracy, 1e-13),
        half_space_thickness=float(np.clip(100 / accuracy, 1e3, 1e12)),
    )


def solve_to_accuracy(
    attempt: Callable[[Discretisation], S], errors: Callable[[S], Mapping[str, float]], wanted: Mapping[str, float]
) -> S:
    """Refine until no estimated error is above what is wanted.

    Args:
        attempt: solves with settings.
        errors: relative errors of an answer, by quantity.
        wanted: relative accuracy of each quantity that is asked for; that of the pressure may be another.

    Raises:
        NotConvergedError: `ATTEMPTS` did not suffice, or finer meshes do not lessen the error.
    """
    settings = settings_for(min(error for name, error in wanted.items() if name != "pressure"))
    before, in_vain = np.inf, 0
    for left in reversed(range(ATTEMPTS)):
        try:
            answer = attempt(settings)
        except NotConvergedError:
            # On coarse meshes the radius of a load beside a flat end may not settle.
            in_vain += 1
            if not left or in_vain == IN_VAIN:
                raise
            settings = _finer(settings, UNSETTLED)
            continue
        found = errors(answer)
        excess = {name: found[name] / accuracy for name, accuracy in wanted.items()}
        worst = max(excess, key=lambda name: excess[name])
        if excess[worst] <= 1:
            return answer
        in_vain = in_vain + 1 if excess[worst] > LEFT * before else 0
        if in_vain == IN_VAIN:
            break
        before, settings = excess[worst], _finer(settings, excess)
    why = "; finer meshes do not lessen its error" if in_vain == IN_VAIN else ""
    raise NotConvergedError(
        f"accuracy {wanted[worst]:g} of the {worst.replace('_', ' ')} was not reached{why}",
        {"estimated_error": excess[worst] * wanted[worst]},
    )


def _finer(settings: Discretisation, excess: Mapping[str, float]) -> Discretisation:
    """Settings for the next attempt, from errors over what is wanted."""
    numbers = max(error for name, error in excess.items() if name != "pressure")
    pressure = max(excess.get("pressure", 0.0), 1e-9)
    factor = min(numbers ** (-1 / ERROR_ORDER), pressure ** (-1 / PRESSURE_ORDER))
    edge = min(0.25, pressure**-2)
    return replace(
        settings,
        growth=float(max(settings.growth * np.clip(0.9 * factor, 0.5, 0.9), 0.02)),
        edge_cell=float(max(settings.edge_cell * max(edge, 1e-4), 1e-12)),
        truncation=max(settings.truncation / 10, 1e-13),
    )


def solve_history_to_accuracy(attempt: Callable[[Discretisation], H], accuracy: float) -> H:
    """Halve cells and time steps until the estimated errors of what an accuracy is asked of are below it.

    Raises:
        NotConvergedError: five attempts did not suffice.
    """
    settings = replace(settings_for(accuracy), growth=1.0)
    for _ in range(5):
        history = attempt(settings)
        worst = max(asked_errors(history).values())
        if worst <= accuracy:
            return history
        settings = replace(settings, growth=settings.growth / 2)
    raise NotConvergedError(f"accuracy {accuracy:g} was not reached in time", {"estimated_error": worst})


@contextmanager
def meshes_that_fit() -> Iterator[None]:
    """Turns the end of the memory into words.

    Raises:
        UnsupportedSceneError: the memory ended.
    """
    try:
        yield
    except MemoryError:
        raise UnsupportedSceneError(
            "the mesh does not fit into memory: ask fem for a less strict accuracy, or give it a larger growth"
        ) from None
