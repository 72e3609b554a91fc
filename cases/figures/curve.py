"""What a figure is before anyone draws it: labelled curves with their error, axes as printed, and a note."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contact import InvalidInput

Style = Literal["solid", "dashed", "dotted", "symbols"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Curve:
    """One curve or one set of symbols.

    Attributes:
        label: What it shows and by which method.
        x: Abscissae in the figure's unit, shape (n,).
        y: Ordinates, shape (n,).
        style: Line style; "symbols" for values read elsewhere.
        error: Bound or estimate of the absolute error of y, in the figure's unit, shape (n,).
        source: Where values come from that we did not compute.
    """

    label: str
    x: NDArray[np.float64]
    y: NDArray[np.float64]
    style: Style = "solid"
    error: NDArray[np.float64]
    source: str = ""

    def __post_init__(self) -> None:
        """Freeze the arrays; refuse unequal lengths and non-finite numbers."""
        for name in ("x", "y", "error"):
            values = np.array(np.broadcast_to(getattr(self, name), np.shape(self.x)), dtype=np.float64)
            if not np.all(np.isfinite(values)):
                raise InvalidInput(f"curve {self.label!r}: {name} holds a number that is not finite")
            values.setflags(write=False)
            object.__setattr__(self, name, values)
        if self.x.shape != self.y.shape:
            raise InvalidInput(f"curve {self.label!r}: x and y need one length, got {self.x.size} and {self.y.size}")


def curve(
    label: str, x: ArrayLike, y: ArrayLike, error: ArrayLike = 0.0, *, style: Style = "solid", source: str = ""
) -> Curve:
    """A `Curve` from anything array-like; a scalar error holds for every point."""
    abscissae, ordinates = np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64)
    bounds = np.broadcast_to(np.asarray(error, dtype=np.float64), abscissae.shape)
    return Curve(label=label, x=abscissae, y=ordinates, style=style, error=bounds, source=source)


@dataclass(frozen=True, kw_only=True)
class FigureData:
    """One panel of a figure of the paper.

    Attributes:
        name: Such as "figure_07a"; also the name of its data file.
        title: One line.
        x_label: With unit in brackets.
        y_label: With unit in brackets.
        x_range: As printed.
        y_range: As printed.
        log_x: Logarithmic abscissa.
        log_y: Logarithmic ordinate.
        curves: What is drawn.
        note: Where the paper's statement is looser than the truth, with the number; empty if nowhere.
    """

    name: str
    title: str
    x_label: str
    y_label: str
    x_range: tuple[float, float]
    y_range: tuple[float, float]
    log_x: bool = False
    log_y: bool = False
    curves: tuple[Curve, ...]
    note: str = ""
