"""Comparison of stated errors with a required accuracy of the numbers of an answer, and with one of its pressure."""

from __future__ import annotations

import dataclasses
from typing import Final, TypeVar

import numpy as np

from contact.answer.solution import Solution

S = TypeVar("S", bound=Solution)
# Fields of an answer, which are less accurate near edges; the accuracy of the pressure applies to them.
FIELDS: Final = ("pressure", "surface_displacement")


def number_errors(answer: Solution) -> dict[str, float]:
    """Largest stated relative error of each quantity in `Solution.ACCURACY_OF` for which the method states one."""
    return {name: _worst(answer, name) for name in answer.ACCURACY_OF if name in answer.error_estimate}


def shortfalls(answer: Solution, accuracy: float, pressure_accuracy: float | None = None) -> dict[str, float]:
    """Stated relative errors above the required accuracy, by quantity; infinite if the method states no error."""
    stated = number_errors(answer) or {"all quantities": np.inf}
    missed = {name: error for name, error in stated.items() if error > accuracy}
    if pressure_accuracy is not None:
        pressure = _worst(answer, "pressure")
        missed |= {"pressure": pressure} if pressure > pressure_accuracy else {}
    return missed


def with_accuracy_note(answer: S, accuracy: float, pressure_accuracy: float | None = None) -> S:
    """The answer with a note that lists every quantity whose stated relative error is above the required accuracy."""
    # Residuals in `error_estimate` are no quantities of the answer.
    required = {name: accuracy for name in answer.error_estimate if hasattr(answer, name)}
    if pressure_accuracy is not None:
        required |= {name: pressure_accuracy for name in FIELDS if name in required}
    missed = [
        f"{name.replace('_', ' ')} {_worst(answer, name):.1e}"
        for name in required
        if required[name] < _worst(answer, name)
    ]
    if not missed:
        return answer
    note = f"less accurate than the {accuracy:g} asked for, by the stated relative errors: {', '.join(missed)}"
    return dataclasses.replace(answer, notes=(*(other for other in answer.notes if other != note), note))


def _worst(answer: Solution, name: str) -> float:
    """Largest stated relative error of a quantity; infinite if the method states none."""
    return float(np.max(answer.error_estimate.get(name, np.inf), initial=0.0))
