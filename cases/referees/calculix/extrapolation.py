"""Three nested meshes, or layers ever less compressible, become one number with an error (Richardson)."""

import math

import numpy as np

from contact.records.validation import FloatArray

# Safety factor of three grids whose observed order is none that the mesh could have (VERIFICATION, Roache).
SAFETY = 3.0
# Safety factor of a change that shrinks at least like the cells (the same source).
SAFETY_OF_CHANGE = 1.25
# Half a unit of the last of seven printed digits, at worst.
PRINTED = 5e-7


def extrapolated(coarse: float, middle: float, fine: float) -> tuple[float, float]:
    """Return the value at vanishing cells and its error: the whole correction beyond the finest mesh.

    Where the changes do not shrink by at least two, an order below one, nothing is extrapolated.
    """
    change, before = fine - middle, middle - coarse
    digits = PRINTED * abs(fine)
    if change and before / change >= 2.0:
        correction = change / (before / change - 1.0)
        return fine + correction, abs(correction) + digits
    return fine, SAFETY * abs(change) + digits


def last_change(middle: float, fine: float) -> tuple[float, float]:
    """Return the finest value with the last change and a quarter as its error: for what is of first order at least."""
    return fine, SAFETY_OF_CHANGE * abs(fine - middle) + PRINTED * abs(fine)


def observed_order(coarse: float, middle: float, fine: float) -> float:
    """Observed order of a value on meshes whose cells are halved each time; zero where changes do not decrease."""
    change, before = fine - middle, middle - coarse
    return math.log2(before / change) if change and before / change > 1.0 else 0.0


def at_zero(places: FloatArray, values: FloatArray, errors: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the polynomial through values at its zero, with an error.

    Args:
        places: where the values belong to, falling towards zero, shape (n,).
        values: shape (n, m).
        errors: of the values, shape (n, m).

    Returns:
        Values and errors, shape (m,): the distance to the polynomial without the first place, and what the errors of
        the values make of it.
    """
    weights = _weights_at_zero(places)
    shorter = np.concatenate([[0.0], _weights_at_zero(places[1:])])
    return weights @ values, np.abs((weights - shorter) @ values) + np.abs(weights) @ errors


def _weights_at_zero(places: FloatArray) -> FloatArray:
    """Values at zero of the Lagrange polynomials of the given places."""
    return np.array([np.prod([x / (x - own) for x in places if x != own]) for own in places])
