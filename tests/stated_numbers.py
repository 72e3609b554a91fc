"""The significant numbers of an answer, each with its stated error, in one form for all kinds of answers."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contact import ContactPath, DetachmentPath, HistoryPath, ImpactHistory, Solution

Array = NDArray[np.float64]

# Radii of pressures and displacements over the contact radius of the last state. The last two are next to the edge,
# where errors of displacements are largest.
PRESSED, MOVED = (0.23, 0.57, 0.88), (0.5, 1.7, 1.002, 1.02)
# Fields inside by the kind of their stated error.
_INSIDE = {
    "displacement": ("radial_displacement", "axial_displacement"),
    "stress": ("radial_stress", "hoop_stress", "axial_stress", "shear_stress"),
    "hydrostatic_pressure": ("hydrostatic_pressure",),
}
# Paths with more states are represented by so many.
_MOST_STATES = 4
# Least allowance for the difference of two answers, over the scale of the quantity: roundings of both.
ROUNDING = 1e-11


class Stated(NamedTuple):
    """Values of one quantity, their absolute stated errors, and the scale of relative ones; each of shape (n,)."""

    values: Array
    error: Array
    scale: Array


def stated_numbers(answer: Solution, radius: float | None = None) -> dict[str, Stated]:
    """All quantities whose errors the answer states, at a few significant states.

    Args:
        answer: Answer of one method.
        radius: Length [m] whose shares are the places of fields; the last contact radius by default.
    """
    if isinstance(answer, ImpactHistory | DetachmentPath):
        names = ("coefficient_of_restitution", "contact_time", *answer.SCALARS)
        return {name: _single(answer, name) for name in names if name in answer.error_estimate}
    numbers = {name: _along(answer, name) for name in answer.ARRAYS if name in answer.error_estimate}
    return numbers | (_fields(answer, radius) if isinstance(answer, ContactPath) else {})


def _single(answer: Solution, name: str) -> Stated:
    """A number of the whole answer; its error may be stated along the path, and the largest holds."""
    error = float(np.max(answer.error_estimate[name])) * float(np.max(answer.scale(name)))
    value = np.array([float(getattr(answer, name))])
    return Stated(value, np.array([error]), np.maximum(np.abs(value), np.max(answer.scale(name))))


def _along(answer: Solution, name: str) -> Stated:
    chosen = _states(answer)
    values = np.asarray(getattr(answer, name))
    parts = (values, answer.uncertainty(name), answer.scale(name))
    return Stated(*(np.broadcast_to(part, values.shape)[chosen] for part in parts))


def _states(answer: Solution) -> Array:
    """The instants that the loading names, or a few states from the first to the last."""
    if isinstance(answer, HistoryPath):
        given = np.asarray(answer.scene.loading.time)
        return np.abs(answer.time[:, None] - given).argmin(axis=0)
    count = len(answer)
    return np.unique(np.linspace(0, count - 1, min(count, _MOST_STATES)).round().astype(int))


def _fields(answer: ContactPath, radius: float | None) -> dict[str, Stated]:
    """Pressure and displacement of the last state at a few radii."""
    step = len(answer) - 1
    a = float(answer.contact_radius[-1]) if radius is None else radius
    wanted = {"pressure": PRESSED, "surface_displacement": MOVED}
    found = {}
    for name, shares in wanted.items():
        if name in answer.error_estimate and answer.fields is not None and a > 0.0:
            values = getattr(answer, name)(a * np.array(shares), step)
            parts = (
                np.broadcast_to(part, len(answer))[step] for part in (answer.uncertainty(name), answer.scale(name))
            )
            found[name] = Stated(values, *(np.full_like(values, part) for part in parts))
    return found


def last_contact(answer: Solution) -> int:
    """Index of the last state in contact, of those that the loading names."""
    states = _states(answer)
    return int(states[np.asarray(answer.contact_radius)[states] > 0.0][-1])


def inside_numbers(answer: Solution, radius: Array, depth: Array) -> dict[str, Stated]:
    """Fields inside at the last state in contact, at points [m] of shape (n,)."""
    step = last_contact(answer)
    found = answer.inside(step).at(radius, depth)
    values = {kind: np.concatenate([getattr(found, name) for name in names]) for kind, names in _INSIDE.items()}
    scales = dict.fromkeys(values, np.abs(values["stress"]).max()) | {"displacement": answer.indentation_depth[step]}
    return {
        f"{kind} inside": Stated(
            v, *np.multiply.outer([found.error_estimate[kind] * scales[kind], scales[kind]], np.ones_like(v))
        )
        for kind, v in values.items()
    }


def differences(first: dict[str, Stated], second: dict[str, Stated]) -> dict[str, tuple[float, float]]:
    """Of each common quantity at its worst value: the difference, and the sum of both stated errors, over the scale."""
    return {name: _worst(first[name], second[name]) for name in first if name in second}


def _worst(first: Stated, second: Stated) -> tuple[float, float]:
    scale = np.maximum(np.maximum(first.scale, second.scale), np.finfo(float).tiny)
    apart = np.abs(first.values - second.values) / scale
    allowed = (first.error + second.error) / scale + ROUNDING
    worst = int(np.argmax(apart - allowed))
    return float(apart[worst]), float(allowed[worst])
