"""Accuracy is asked per quantity: of the numbers of an answer, and of its pressure by a request of its own."""

from __future__ import annotations

import dataclasses
from typing import Final, TypeVar

import numpy as np

from contact.answer.solution import Solution

S = TypeVar("S", bound=Solution)
# Fields of an answer. They are less accurate near edges and must meet the accuracy of the pressure.
FIELDS: Final = ("pressure", "surface_displacement")


def asked_errors(answer: Solution) -> dict[str, float]:
    """Largest stated relative error of each number that an accuracy is asked of, as far as the method states any."""
    return {name: _worst(answer, name) for name in answer.ASKED if name in answer.error_estimate}


def shortfalls(answer: Solution, accuracy: float, pressure_accuracy: float | None = None) -> dict[str, float]:
    """Stated relative errors above what was asked of these quantities; infinite where none is stated at all."""
    stated = asked_errors(answer) or {"all quantities": np.inf}
    over = {name: error for name, error in stated.items() if error > accuracy}
    if pressure_accuracy is not None:
        pressure = _worst(answer, "pressure")
        over |= {"pressure": pressure} if pressure > pressure_accuracy else {}
    return over


def told_where_less(answer: S, accuracy: float, pressure_accuracy: float | None = None) -> S:
    """The answer with a note that names every quantity whose stated error is above the accuracy asked for."""
    # Residuals among the stated errors of a method are no quantities of the answer.
    wanted = {name: accuracy for name in answer.error_estimate if hasattr(answer, name)}
    if pressure_accuracy is not None:
        wanted |= {name: pressure_accuracy for name in FIELDS if name in wanted}
    over = [
        f"{name.replace('_', ' ')} {_worst(answer, name):.1e}" for name in wanted if wanted[name] < _worst(answer, name)
    ]
    if not over:
        return answer
    note = f"less accurate than the {accuracy:g} asked for, by the stated relative errors: {', '.join(over)}"
    return dataclasses.replace(answer, notes=(*(other for other in answer.notes if other != note), note))


def _worst(answer: Solution, name: str) -> float:
    """The largest relative error that is stated of a quantity; infinite where none is."""
    return float(np.max(answer.error_estimate.get(name, np.inf), initial=0.0))
