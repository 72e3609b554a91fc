"""Symbols of other methods over the curves of a figure; nothing here loads a method."""

from collections.abc import Iterator, Mapping
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from cases.declare.case import Case
from cases.declare.task import Answers
from cases.library._layers import THICKNESS
from cases.results.records.figure import Series


def series(
    label: str,
    method: str,
    group: str,
    x: ArrayLike,
    y: ArrayLike,
    *,
    half_width: ArrayLike = (),
    style: Literal["by method", "dotted", "symbols"] = "by method",
) -> Series:
    """A record of points from arrays."""
    x, y, half_width = (tuple(np.asarray(values, dtype=np.float64).tolist()) for values in (x, y, half_width))
    return Series(label=label, method=method, group=group, x=x, y=y, half_width=half_width, style=style)


# Of so many samples one method shows one: finite elements, boundary elements and the integral equation in turn.
METHODS_IN_TURN = 3


def pressure_symbols(case: Case, answers: Answers, scenes: Mapping[float, str]) -> Iterator[Series]:
    """Pressure over its mean, over r/a, of every method but MDR, each at other radii, so that none hides another.

    Args:
        case: the case.
        answers: its finished tasks.
        scenes: names by a/h.
    """
    for ratio, name in scenes.items():
        scene = case.scene(name)
        others = [use for use in case.methods_of(scene) if not use.label.startswith("mdr")]
        for number, use in enumerate(others):
            run = answers.of(case.task(scene, use))
            if run.solved and run.curves:
                shown = slice(number % METHODS_IN_TURN, None, METHODS_IN_TURN)
                a = ratio * THICKNESS
                mean = run.quantity("normal_force").values[-1] / (np.pi * a**2)
                curve, group = run.curve("pressure"), f"a/h={ratio:g}"
                x, y = np.array(curve.x[shown]) / a, np.array(curve.y[shown]) / mean
                yield series(f"{use.label} {group}", use.label, group, x, y)
