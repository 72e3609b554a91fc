"""The curve of an answer: one of its arrays over another, with units and the stated error."""

from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from contact import UNITS, ForceHistory, Solution
from contact.answer.evidence import SYMBOLS
from contact.records.units import prefix_for
from reports.style import BLACK, look_of, svg_text
from reports.words import display_name

# More prescribed states than these are drawn as a line, fewer as symbols.
_MOST_SYMBOLS: Final = 40
# Value at the loss of contact, by the array to which it belongs.
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
    draw(answer, axes, x, y)
    axes.legend()
    return axes


def draw(answer: Solution, axes: Axes, x: str, y: str, curve: Solution | None = None) -> None:
    """One array over another with the stated error: a line with a band, or symbols with bars at few prescribed states.

    Args:
        answer: Answer; of a detachment the states stable under its control are a line, the whole branch is dotted.
        axes: Axes on which the answer is drawn.
        x: Name of the array on the horizontal axis.
        y: Name of the array on the vertical axis.
        curve: The same scene with states between the prescribed ones, drawn as the line; None where there is none.
    """
    axes.set(xlabel=axis_label(answer, x), ylabel=axis_label(answer, y))
    look, method = look_of(answer.method), display_name(answer.method)
    prescribed = getattr(answer.scene.loading, "time", np.empty(_MOST_SYMBOLS)).size
    is_curve = answer.CURVE_ALONE or len(answer) > prescribed
    drawn = answer if curve is None else curve
    across, up = (getattr(drawn, name) * factor(answer, name) for name in (x, y))
    if (stated := drawn.stated_error(y)) is not None:
        label, error = f"stated error, at most {np.max(stated):.1g} {UNITS[y]}", stated * factor(answer, y)
        if is_curve or curve is not None:
            axes.fill_between(across, up - error, up + error, color=look.colour, alpha=0.25, linewidth=0, label=label)
        else:
            axes.errorbar(across, up, error, fmt="none", ecolor=look.colour, label=label)
    control = getattr(answer.scene.loading, "control", None)
    stable = getattr(answer, f"stable_{control}_control", None)
    if stable is not None:
        label = f"{method}, stable under {control} control"
        axes.plot(across, np.where(stable, up, np.nan), "-", color=look.colour, label=label)
        axes.plot(across, up, ":", color=look.colour, label="whole branch", zorder=0)
        if {x, y} <= _AT_LOSS.keys():
            place = [getattr(answer, _AT_LOSS[name]) * factor(answer, name) for name in (x, y)]
            axes.plot(*place, "o", color=look.colour, label="loss of contact")
        return
    if is_curve or curve is not None:
        axes.plot(across, up, "-", color=look.colour, label=method)
    if not is_curve:
        x_states, y_states = (getattr(answer, name) * factor(answer, name) for name in (x, y))
        label, colour = (method, look.colour) if curve is None else ("prescribed states", BLACK)
        axes.plot(x_states, y_states, look.marker, color=colour, markerfacecolor="white", zorder=3, label=label)


def factor(answer: Solution, name: str) -> float:
    """Values of an array in the unit of its axis over values in SI."""
    return 1.0 / prefix_for(getattr(answer, name))[0]


def axis_label(answer: Solution, name: str) -> str:
    """The axis label of an array: name, symbol and unit with a fitting prefix."""
    symbol = SYMBOLS[name].replace("k_N", "$k_N$")
    return f"{name.replace('_', ' ')} {symbol} [{prefix_for(getattr(answer, name))[1]}{UNITS[name]}]"


def inline_svg(answer: Solution) -> str:
    """The curve of `plot` as SVG within HTML."""
    figure = Figure(figsize=(5.0, 3.2), layout="constrained")
    plot(answer, axes=figure.subplots())
    return svg_text(figure, key="answer")
