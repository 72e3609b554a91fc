"""Settings for a requested accuracy: a first guess from measured error laws, refined until the stated errors hold."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import TypeVar

import numpy as np

from contact import NotConvergedError, Solution, UnsupportedSceneError
from contact.answer.accuracy import shortfalls
from fem_reference.settings import Discretisation

# Stated errors of P4P3 fall like this power of the growth on graded meshes.  It chooses the next mesh only: a wrong
# value costs attempts, no accuracy.
ERROR_ORDER = 7.0
# Stated error of P4P3 at growth 1/2 on punches, cones and paraboloids.  It chooses the first mesh only.
ERROR_AT_HALF = 2e-5
# Share of the accuracy that the outer edge may cost.  At a load most other errors cancel to a hundredth of the
# accuracy, and this does not: with a hundred times as much it is most of what is stated of unbonded layers.
FAR_SHARE = 1e-5
# The error of the pressure falls like this power of the growth.
PRESSURE_ORDER = 3.0
# Growth of the first mesh of a motion: its cells and steps err like powers of one to two.
MOTION_GROWTH = 1.0
# Refinements that are tried before an accuracy counts as out of reach.
ATTEMPTS = 6
# A finer mesh that leaves more than this share of the excess was in vain; after two in a row the accuracy is refused,
# before a mesh fills the memory.
LEFT, IN_VAIN = 0.8, 2

S = TypeVar("S", bound=Solution)


def settings_for(accuracy: float) -> Discretisation:
    """A discretisation that usually meets ``accuracy`` (relative) at the first attempt."""
    # Beyond a growth of one a mesh has fewer than a hundred triangles, on which errors follow no law.
    growth = float(np.clip(0.5 * (accuracy / ERROR_AT_HALF) ** (1 / ERROR_ORDER), 0.05, 1.0))
    return Discretisation(
        order=4,
        growth=growth,
        edge_cell=float(np.clip(accuracy / 20, 1e-11, 1e-3)),
        truncation=max(FAR_SHARE * accuracy, 1e-13),
        half_space_thickness=float(np.clip(1000 / accuracy, 1e3, 1e12)),
    )


def solve_to_accuracy(
    attempt: Callable[[Discretisation], S], accuracy: float, pressure_accuracy: float | None, *, moves: bool
) -> S:
    """Refine until no stated error is above what is wanted.

    Args:
        attempt: solves with settings.
        accuracy: relative accuracy of the numbers that are asked for.
        pressure_accuracy: the same of the pressure, if that is asked for.
        moves: whether the scene is a motion, whose errors fall slowly.

    Raises:
        NotConvergedError: `ATTEMPTS` did not suffice, or finer meshes do not lessen the error.
    """
    settings = settings_for(accuracy)
    if moves:
        settings = replace(settings, growth=MOTION_GROWTH)
    before, in_vain = np.inf, 0
    for left in reversed(range(ATTEMPTS)):
        try:
            answer = attempt(settings)
        except NotConvergedError:
            # On coarse meshes the radius of a load near a flat end may not settle.
            in_vain += 1
            if not left or in_vain == IN_VAIN:
                raise
            settings = _finer(settings, 1e3, 0.0)
            continue
        over = shortfalls(answer, accuracy, pressure_accuracy)
        if not over:
            return answer
        excess = {n: e / (accuracy if n != "pressure" else pressure_accuracy or accuracy) for n, e in over.items()}
        worst = max(excess, key=lambda name: excess[name])
        in_vain = in_vain + 1 if excess[worst] > LEFT * before else 0
        if in_vain == IN_VAIN:
            break
        before, pressure = excess[worst], excess.pop("pressure", 0.0)
        numbers = max(excess.values(), default=0.0)
        settings = replace(settings, growth=settings.growth / 2) if moves else _finer(settings, numbers, pressure)
    why = "; finer meshes do not lessen its error" if in_vain == IN_VAIN else ""
    wanted = pressure_accuracy if worst == "pressure" else accuracy
    raise NotConvergedError(
        f"accuracy {wanted:g} of the {worst.replace('_', ' ')} was not reached{why}", {"estimated_error": over[worst]}
    )


def _finer(settings: Discretisation, numbers: float, pressure: float) -> Discretisation:
    """Settings for the next attempt, from errors over what is wanted; zero where nothing is above."""
    factor = min(max(numbers, 1.0) ** (-1 / ERROR_ORDER), max(pressure, 1.0) ** (-1 / PRESSURE_ORDER))
    edge = min(0.25, max(pressure, 1.0) ** -2)
    return replace(
        settings,
        growth=float(max(settings.growth * np.clip(0.9 * factor, 0.5, 0.9), 0.02)),
        edge_cell=float(max(settings.edge_cell * max(edge, 1e-4), 1e-12)),
        truncation=max(settings.truncation / 10, 1e-13),
    )


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
