"""Repeated solutions that should all be equal, and the digits that they share."""

import math
from collections.abc import Iterator, Sequence
from typing import Any, Final

import numpy as np
from threadpoolctl import threadpool_limits  # type: ignore[import-untyped]  # ships no types

from cases.declare.quantities import values_of
from cases.measurements.ladders.units import Units, in_units, with_numbers
from contact import ContactRadii, DepthFunction, IndentationDepths, Method, NormalForces, Scene, Solution

DOUBLE_DIGITS: Final = -float(np.log10(2.0**-53))
NUDGES: Final = 3
# Millimetres and megapascals have other mantissas.
_UNITS: Final = Units(length=1e-3, stress=1e-6, time=1e-3)
_THREADS: Final = 2


def repeated(method: Method, scene: Scene, quantity: str) -> Iterator[float]:
    """Yield the last value of a quantity from repeated solutions.

    The scene itself; with every input changed by one unit in the last place at random; in other units; with other steps
    before the last; on two threads.
    """
    yield _last(method.solve(scene), quantity)
    for seed in range(NUDGES):
        yield _last(method.solve(nudged(scene, np.random.default_rng(seed))), quantity)
    yield _last(method.solve(in_units(scene, _UNITS)), quantity) / _UNITS.factor(quantity)
    among = amid_other_steps(scene)
    if among is not None:
        yield _last(method.solve(among), quantity)
    with threadpool_limits(_THREADS):
        yield _last(method.solve(scene), quantity)


def relative_spread(values: Sequence[float]) -> float:
    """Largest distance from the median over the median; zero where all agree."""
    middle = float(np.median(values))
    spread = float(np.max(np.abs(np.asarray(values) - middle)))
    return 0.0 if spread == 0.0 else spread / abs(middle) if middle else math.inf


def digits_of(spread: float) -> float:
    """Significant digits that values with this relative spread share, at most those of double precision."""
    return float(np.clip(-np.log10(spread), 0.0, DOUBLE_DIGITS)) if spread else DOUBLE_DIGITS


def nudged(scene: Scene, draw: np.random.Generator) -> Scene:
    """Every number of the scene one unit in the last place up or down, or left alone, at random; no moduli of depth."""
    return with_numbers(scene, lambda _, name, value: _one_ulp(name, value, draw))


def _one_ulp(name: str, value: Any, draw: np.random.Generator) -> Any:
    if isinstance(value, DepthFunction):
        return value
    steps = draw.integers(-1, 2, np.shape(value))
    moved = np.where(steps == 0, value, np.nextafter(value, np.where(steps > 0, np.inf, -np.inf)))
    # Zero has no last place.
    moved = np.where(np.asarray(value) == 0.0, value, moved)
    if name == "poissons_ratio":
        # Exactly incompressible is another problem.
        return float(min(float(moved), 0.5)) if value != 0.5 else 0.5
    return moved if isinstance(value, np.ndarray) else float(moved)


def amid_other_steps(scene: Scene) -> Scene | None:
    """The scene with other steps before its last one; None where steps are not independent."""
    loading = scene.loading
    if isinstance(loading, ContactRadii):
        flat, last = scene.indenter.flat_radius, float(loading.values[-1])
        return scene.replace(loading=ContactRadii(values=flat + (last - flat) * np.array([0.3, 0.8, 1.0])))
    if isinstance(loading, IndentationDepths | NormalForces):
        values = np.array([0.4, 1.0, 0.7, 1.0]) * loading.values[-1]
        return scene.replace(loading=type(loading)(values=values))
    return None


def _last(answer: Solution, quantity: str) -> float:
    return float(values_of(answer, quantity)[-1])
