"""How figures look: one colour and marker per method, one font, files that come out the same byte for byte.

Colours are those of Okabe and Ito (2008), distinct for readers with any colour vision. Methods also differ in marker
and dash, so that a grey print still reads. Text stays text: it can be searched and copied, and files stay small.
"""

import io
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from importlib.resources import as_file, files
from typing import Any, Literal, NamedTuple

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter, NullLocator
from numpy.typing import ArrayLike

from reports.words import base_of, short_exponents

BLACK, GREY, FAINT, TINT = "#1a1a1a", "#767676", "#c8c8c8", "#eef4ee"
BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY = "#0072b2", "#d55e00", "#009e73", "#b0509a", "#e69f00", "#56b4e9"
# Pixels per inch of a PNG: half is blurred on a slide, twice is four times as large.
DOTS_PER_INCH = 150

# Families of equal letter widths first: nothing is clipped where one of them is missing.
FONT_FAMILY = "'DejaVu Sans', Verdana, 'Liberation Sans', Arial, sans-serif"

Dash = Literal["-", "--", "-.", ":"]


class Look(NamedTuple):
    """Colour, dash and marker of one method, the same in every figure and table."""

    colour: str
    dash: Dash
    marker: str


LOOKS: Mapping[str, Look] = {
    "mdr": Look(BLUE, "-", "o"),
    "mdr_table": Look(SKY, "--", "v"),
    "fem": Look(VERMILLION, "--", "s"),
    "bem": Look(GREEN, "-.", "^"),
    "integral_equation": Look(PURPLE, ":", "D"),
}
SPARE_LOOKS = (Look(ORANGE, "-", "P"), Look(GREY, "-.", "X"))


def look_of(method: str) -> Look:
    """The look of a method; a variant has its method's colour, a method from elsewhere always the same spare look."""
    base = base_of(method)
    if base not in LOOKS:
        return SPARE_LOOKS[sum(method.encode()) % len(SPARE_LOOKS)]
    return LOOKS[base] if base == method else Look(LOOKS[base].colour, ":", "P")


def power_of_ten(value: float, _position: int | None = None) -> str:
    """Tick label 10⁻³ in plain letters, so that it stays one searchable word; 0.1, 1 and 10 as such."""
    exponent = round(math.log10(value))
    superscripts = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
    return f"{10.0**exponent:g}" if -2 <= exponent <= 2 else "10" + str(exponent).translate(superscripts)


def mark_decades(*all_axes: Axis) -> None:
    """Label logarithmic axes: whole decades, ten at most; 1, 2 and 5 where there are fewer than two decades."""
    for axis in all_axes:
        low, high = sorted(axis.get_view_interval())
        decades = math.log10(high / low)
        axis.set_minor_formatter(NullFormatter())
        if decades < 2:
            axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
            axis.set_major_formatter(FuncFormatter(lambda value, _position: short_exponents(f"{value:g}")))
        else:
            axis.set_major_locator(LogLocator(base=10.0 ** max(1, math.ceil(decades / 10)), numticks=12))
            axis.set_major_formatter(FuncFormatter(power_of_ten))
        if decades > 4:  # ticks between decades would merge, and take a third of the time of a report
            axis.set_minor_locator(NullLocator())


@contextmanager
def figure_style() -> Iterator[None]:
    """Matplotlib settings of all figures, restored afterwards."""
    defaults: dict[Any, Any] = {name: value for name, value in mpl.rcParamsDefault.items() if name != "backend"}
    style = files("reports").joinpath("templates/figures.mplstyle")
    with as_file(style) as path, mpl.rc_context(defaults), mpl.rc_context(fname=path):
        yield


def panels(count: int, *, size: tuple[float, float], columns: int = 3) -> tuple[Figure, list[Axes]]:
    """A figure of `count` axes in rows of at most `columns`, each axes of `size` [inches]."""
    across = min(columns, count)
    down = math.ceil(count / across)
    drawing = Figure(figsize=(size[0] * across, size[1] * down), layout="constrained")
    axes = list(drawing.subplots(down, across, squeeze=False).flat)
    for unused in axes[count:]:
        unused.set_axis_off()
    return drawing, axes[:count]


def line_with_band(axes: Axes, x: ArrayLike, y: ArrayLike, half_width: Any, **look: Any) -> None:
    """A line with a band of half width `half_width`, shape of `y`; no band where that is None."""
    axes.plot(x, y, **look)
    if half_width is not None:
        axes.fill_between(x, y - half_width, y + half_width, color=look["color"], alpha=0.2, linewidth=0.0)


def svg_text(drawing: Figure, *, key: str) -> str:
    """The figure as SVG that depends on nothing but its data: no date, no random ids, two decimals of a point.

    Ids are hashes of their content and the key: figures of one HTML page do not use each other's clip paths.
    """
    buffer = io.StringIO()
    with mpl.rc_context({"svg.hashsalt": key}):
        canvas: Any = FigureCanvasSVG(drawing)  # `savefig` would draw everything twice
        canvas.print_svg(buffer, metadata=dict.fromkeys(("Date", "Creator", "Format", "Type")))
    svg = buffer.getvalue()
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r"<[^>]*>", lambda tag: re.sub(r"-?\d+\.\d{3,}", lambda n: f"{float(n[0]):.2f}", tag[0]), svg)
    used = set(re.findall(r"(?:xlink:href=\"#|url\(#)([\w.-]+)", svg))
    svg = re.sub(r' id="([^"]*)"', lambda name: name[0] if name[1] in used else "", svg)
    svg = re.sub(
        r"font-family: 'DejaVu Sans'; |; font-family: 'DejaVu Sans'|<!--.*?-->|<g\b[^>]*/>", "", svg, flags=re.DOTALL
    )
    svg = svg.replace("<svg ", f'<svg style="font-family: {FONT_FAMILY}" ', 1)
    # Between the letters of a formula a line end would be shown as a space.
    return re.sub(r"\s+", " ", svg).replace("> <", "><").replace("><path", ">\n<path").strip() + "\n"


def figure_bytes(drawing: Figure, ending: str, *, key: str) -> bytes:
    """The figure as the content of a file with this ending: ".svg", ".png" or ".pdf"."""
    if ending == ".svg":
        return svg_text(drawing, key=key).encode()
    buffer = io.BytesIO()
    metadata: Sequence[str] = ("Software",) if ending == ".png" else ("Creator", "Producer", "CreationDate")
    drawing.savefig(buffer, format=ending[1:], dpi=DOTS_PER_INCH, metadata=dict.fromkeys(metadata))
    return buffer.getvalue()
