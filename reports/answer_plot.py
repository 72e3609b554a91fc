"""The curve of an answer: one of its arrays over another, with units and the stated error."""

from io import StringIO
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from contact import UNITS, ForceHistory, Solution
from contact.answer.evidence import SYMBOLS
from contact.records.units import prefix_for

# More prescribed states than these are drawn as a line, fewer as symbols.
_MOST_SYMBOLS: Final = 40
# Values where contact is lost, by the array that they lie on.
_AT_LOSS: Final = {
    "indentation_depth": "pull_off_depth",
    "normal_force": "force_at_loss",
    "contact_radius": "pull_off_contact_radius",
}


def plot(answer: Solution, y: str | None = None, x: str | None = None, axes: Axes | None = None) -> Axes:
    """The axes on which an answer is drawn, as `Solution.plot` says.

    Raises:
        ValueError: If the answer has no such array.
    """
    y = y or ("indentation_depth" if isinstance(answer.scene.loading, ForceHistory) else "normal_force")
    x = x or ("time" if "time" in answer.ARRAYS else "indentation_depth")
    for name in (x, y):
        if name not in answer.ARRAYS:
            raise ValueError(f"{type(answer).__name__} has no array {name!r}; it has {', '.join(answer.ARRAYS)}")
    if axes is None:
        from matplotlib import pyplot as plt  # noqa: PLC0415  # looks for a screen, which files need not

        axes = plt.subplots(layout="constrained")[1]
    stated = answer.stated_error(y)
    if stated is not None:
        label = f"stated error, at most {np.max(stated):.1g} {UNITS[y]}"
        ends = ((getattr(answer, y) + side * stated) * factor(answer, y) for side in (-1, 1))
        axes.fill_between(getattr(answer, x) * factor(answer, x), *ends, alpha=0.25, linewidth=0, label=label)
    _draw(answer, axes, x, y)
    axes.set(xlabel=axis_label(answer, x), ylabel=axis_label(answer, y))
    axes.legend()
    return axes


def _draw(answer: Solution, axes: Axes, x: str, y: str) -> None:
    """The curve, or symbols at few prescribed states; of a detachment, the states stable under its control."""
    across, up = (getattr(answer, name) * factor(answer, name) for name in (x, y))
    control = getattr(answer.scene.loading, "control", None)
    stable = getattr(answer, f"stable_{control}_control", None)
    if stable is None:
        is_curve = answer.CURVE_ALONE or len(answer) > _MOST_SYMBOLS
        axes.plot(across, up, "-" if is_curve else "o", label=answer.method)
        return
    label = f"{answer.method}, stable under {control} control"
    (line,) = axes.plot(across, np.where(stable, up, np.nan), "-", label=label)
    axes.plot(across, up, ":", color=line.get_color(), label="whole branch", zorder=0)
    if {x, y} <= _AT_LOSS.keys():
        place = [getattr(answer, _AT_LOSS[name]) * factor(answer, name) for name in (x, y)]
        axes.plot(*place, "o", color=line.get_color(), label="loss of contact")


def factor(answer: Solution, name: str) -> float:
    """Values of an array in the unit of its axis over values in SI."""
    return 1.0 / prefix_for(getattr(answer, name))[0]


def axis_label(answer: Solution, name: str) -> str:
    """The axis label of an array: name, symbol and unit with a fitting prefix."""
    symbol = SYMBOLS[name].replace("k_N", "$k_N$")
    return f"{name.replace('_', ' ')} {symbol} [{prefix_for(getattr(answer, name))[1]}{UNITS[name]}]"


def inline_svg(answer: Solution) -> str:
    """The curve of `plot` as SVG within HTML."""
    figure, text = Figure(figsize=(5.0, 3.2), layout="constrained"), StringIO()
    plot(answer, axes=figure.subplots())
    figure.savefig(text, format="svg")
    return text.getvalue()[text.getvalue().index("<svg") :]
