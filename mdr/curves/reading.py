"""Force curves from CSV files, columns of depth and force with units in their heads or in SI, and of microscopes."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np

from contact import InvalidInput
from contact.files.values import Column, in_si_units, read_columns
from contact.records.validation import FloatArray
from mdr.curves.microscopes import ENDINGS, read_measured

# How the heads of columns begin, in lower case.
DEPTH_NAMES: Final = ("depth", "indentation", "delta", "tip")
FORCE_NAMES: Final = ("force", "load", "f")


def read_curve(file: str | Path, number: int = 0) -> tuple[FloatArray, FloatArray]:
    """Depth [m] and force [N], each of shape (n,): columns of such names, or else the first two.

    Args:
        file: CSV, or what a microscope has written (`mdr.curves.microscopes`).
        number: Which curve of a microscope's file.

    Raises:
        InvalidInput: If the file cannot be read or has no such columns or curve.
    """
    if Path(file).suffix in ENDINGS:
        curves = read_measured(Path(file))
        if not 0 <= number < len(curves):
            raise InvalidInput(f"{file}: has no curve {number}; it has {len(curves)}, counted from 0")
        return curves[number]
    columns = read_columns(Path(file))
    depth, force = _named(columns, DEPTH_NAMES, 0, file), _named(columns, FORCE_NAMES, 1, file)
    return in_si_units(depth, "m", str(file)), in_si_units(force, "N", str(file))


def read_map(file: str | Path) -> tuple[FloatArray, FloatArray]:
    """Depths [m] of the first column, shape (m,), and forces [N] of a curve in each other one, shape (n, m).

    Curves of a microscope's file have depths of their own, shape (n, m): of each the deepest m points.

    Raises:
        InvalidInput: If the file cannot be read or has a single column.
    """
    if Path(file).suffix in ENDINGS:
        curves = read_measured(Path(file))
        shortest = min(depth.size for depth, _ in curves)
        depths, forces = (np.stack([one[part][-shortest:] for one in curves]) for part in (0, 1))
        return depths, forces
    columns = read_columns(Path(file))
    if len(columns) < 2:
        raise InvalidInput(f"{file}: a map has depths in its first column, and forces of a curve in each other one")
    return in_si_units(columns[0], "m", str(file)), np.stack([in_si_units(one, "N", str(file)) for one in columns[1:]])


def _named(columns: Sequence[Column], names: Sequence[str], number: int, file: str | Path) -> Column:
    """The column whose head begins with one of the names, or else the one of this number."""
    for name in names:
        found = [one for one in columns if one.name.lower().startswith(name)]
        if found:
            return found[0]
    if number >= len(columns):
        raise InvalidInput(f"{file}: needs a column of depths and one of forces")
    return columns[number]
