"""The inside of stacks by layer and depth within it, for fields under histories."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bem.kernels.stack import Sheet, StackKernel, Transfer
from bem.kernels.stack import half_space_at as half_space_transfer
from contact.records.validation import FloatArray

__all__ = ["Place", "Transfer", "half_space_transfer", "place_of", "sheet_of", "transfer"]


@dataclass(frozen=True)
class Place:
    """A depth in a stack, or several of one layer.

    Attributes:
        sheet: Number of the layer that holds it, the upper one at an interface.
        depth: From that layer's top, over the first layer's thickness; several as a column.
    """

    sheet: int
    depth: float | FloatArray


def place_of(kernel: StackKernel, depth: float) -> Place:
    """Where a depth over the first layer's thickness lies; below a rigid base it counts as on it."""
    number = int(kernel.descent(np.ones(1)).places(np.array([depth]))[0]) // 2
    faces = np.concatenate([[0.0], np.cumsum([sheet.thickness for sheet in kernel.sheets])])
    inside = depth - faces[number]
    return Place(number, min(inside, kernel.sheets[number].thickness) if number < len(kernel.sheets) else inside)


def sheet_of(kernel: StackKernel, place: Place) -> Sheet:
    """The material there: a layer's, or that of the elastic base."""
    sheet = (*kernel.sheets, kernel.base)[place.sheet]
    assert sheet is not None
    return sheet


def transfer(kernel: StackKernel, wavenumber: FloatArray, place: Place) -> Transfer:
    """Fields at wavenumbers k > 0 over the first layer's thickness, shape (k,) or (depths, k)."""
    descent, top = kernel.descent(wavenumber), sum(sheet.thickness for sheet in kernel.sheets[: place.sheet])
    z = np.atleast_1d(place.depth).ravel()
    on_face = z >= sheet_of(kernel, place).thickness * (1 - 1e-14)
    found = np.empty((4, z.size, wavenumber.size))
    for face in {*on_face.tolist()}:
        found[:, on_face == face] = descent.at(2 * place.sheet + int(face), top + z[on_face == face][:, None])
    return Transfer(*(found if np.ndim(place.depth) else found[:, 0]))
