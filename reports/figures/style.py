"""How figures look, decided once: colours, lines, fonts, and files that come out the same byte for byte.

Colours are those of Okabe and Ito (2008), told apart by readers with any colour vision; lines also differ in dash and
marker, so that a grey print still reads. Text stays text (not outlines): it can be searched and copied, and files stay
small. The font list starts with two families of equal letter widths, so nothing clips where one of them is missing.
"""

import io
import math
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any, Literal

import matplotlib as mpl
from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter, NullLocator

from reports.words.method_names import base_of

BLACK, GREY, FAINT, TINT = "#1a1a1a", "#767676", "#c8c8c8", "#eef4ee"
BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY = "#0072b2", "#d55e00", "#009e73", "#b0509a", "#e69f00", "#56b4e9"
# Resolution of the PNG beside each SVG: sharp on a slide.
PNG_DOTS_PER_INCH = 150

SETTINGS: dict[Any, Any] = {
    "font.family": ["DejaVu Sans"],
    "font.size": 9.0,
    "axes.titlesize": 9.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelsize": 9.0,
    "axes.linewidth": 0.7,
    "axes.edgecolor": "#444444",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.formatter.use_mathtext": True,
    "grid.color": "#e2e2e2",
    "grid.linewidth": 0.6,
    "legend.fontsize": 8.0,
    "legend.frameon": False,
    "lines.linewidth": 1.5,
    "lines.markersize": 4.5,
    "mathtext.fontset": "dejavusans",
    "path.simplify_threshold": 0.2,
    "svg.fonttype": "none",
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
}
FONT_FAMILY = "'DejaVu Sans', Verdana, 'Liberation Sans', Arial, sans-serif"


Dash = Literal["-", "--", "-.", ":", "none"] | tuple[float, tuple[float, ...]]
SpareLook = tuple[str, Dash, str]


@dataclass(frozen=True, kw_only=True)
class Look:
    """Colour, dash and marker of one method, the same in every figure and table."""

    colour: str
    dash: Dash
    marker: str


LOOKS: Mapping[str, Look] = {
    "mdr": Look(colour=BLUE, dash="-", marker="o"),
    "mdr_table": Look(colour=SKY, dash="--", marker="v"),
    "fem": Look(colour=VERMILLION, dash="--", marker="s"),
    "bem": Look(colour=GREEN, dash="-.", marker="^"),
    "integral_equation": Look(colour=PURPLE, dash=":", marker="D"),
}
SPARE_LOOKS: tuple[SpareLook, ...] = ((ORANGE, "-", "P"), (GREY, "-.", "X"))


def look_of(method: str) -> Look:
    """The look of a method; a variant has its method's colour, a method from elsewhere always the same spare look."""
    base = base_of(method)
    if base in LOOKS:
        return LOOKS[base] if base == method else replace(LOOKS[base], dash=":", marker="P")
    colour, dash, marker = SPARE_LOOKS[sum(method.encode()) % len(SPARE_LOOKS)]
    return Look(colour=colour, dash=dash, marker=marker)


SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
# An axis of fewer decades (first number) labels steps between them, one of more (second) marks every decade.
FEW_DECADES, MANY_DECADES = 2, 4
# Labels from this number on are long: they are grouped, and fewer are shown.
LONG_NUMBER = 1e4


def power_of_ten(value: float, _position: int | None = None) -> str:
    """Tick label 10⁻³ in plain letters, so that it stays one searchable word; 0.1, 1 and 10 as such."""
    exponent = round(math.log10(value))
    return f"{10.0**exponent:g}" if -2 <= exponent <= 2 else "10" + str(exponent).translate(SUPERSCRIPTS)


def mark_decades(axis: Axis) -> None:
    """Label a logarithmic axis: whole decades, ten at most; 1, 2 and 5 where there are few."""
    low, high = sorted(axis.get_view_interval())
    decades = math.log10(high / low)
    axis.set_minor_formatter(NullFormatter())
    if decades < FEW_DECADES:
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if high < LONG_NUMBER else (1.0, 3.0)))
        axis.set_major_formatter(FuncFormatter(lambda value, _position: _grouped(value)))
        return
    axis.set_major_locator(LogLocator(base=10.0 ** max(1, math.ceil(decades / 10)), numticks=12))
    axis.set_major_formatter(FuncFormatter(power_of_ten))
    if decades > MANY_DECADES:
        axis.set_minor_locator(LogLocator(base=10.0, subs=(1.0,), numticks=99))


def _grouped(value: float) -> str:
    """A label, in groups of three digits where it is long."""
    return f"{value:g}" if value < LONG_NUMBER else f"{value:,.0f}".replace(",", "\N{NARROW NO-BREAK SPACE}")


def mark_signed_decades(axis: Axis, *, smallest: float, largest: float) -> None:
    """Label zero and the decades from `smallest` to `largest` on both sides of it, every second where they are many."""
    powers = range(round(math.log10(smallest)), math.floor(math.log10(largest)) + 1)
    step = 1 + len(powers) // 6
    marked = [10.0**power for power in powers if power % step == 0]
    axis.set_ticks([*(-value for value in reversed(marked)), 0.0, *marked])
    axis.set_major_formatter(FuncFormatter(_signed_power_of_ten))
    axis.set_minor_locator(NullLocator())


def _signed_power_of_ten(value: float, _position: int | None = None) -> str:
    return "0" if value == 0.0 else f"{'−' if value < 0.0 else ''}{power_of_ten(abs(value))}"


@contextmanager
def figure_style() -> Iterator[None]:
    """Matplotlib settings of all figures, restored afterwards."""
    defaults: dict[Any, Any] = {name: value for name, value in mpl.rcParamsDefault.items() if name != "backend"}
    with mpl.rc_context(defaults | SETTINGS):
        yield


def svg_text(figure: Figure, *, key: str) -> str:
    """The figure as SVG that depends on nothing but its data: no date, no random ids, two decimals of a point.

    Ids start with `key`, so that many figures live in one HTML page without meeting each other's clip paths.
    """
    buffer = io.StringIO()
    with mpl.rc_context({"svg.hashsalt": key}):
        metadata = {"Date": None, "Creator": None, "Format": None, "Type": None}
        canvas: Any = FigureCanvasSVG(figure)
        # `savefig` would draw everything twice.
        canvas.print_svg(buffer, metadata=metadata)
    return _compact(buffer.getvalue(), key)


def _compact(svg: str, key: str) -> str:
    """What a page needs of Matplotlib's SVG: no prologue, no unused ids, each thing said once."""
    svg = svg[svg.index("<svg") :]  # an inline figure has no XML declaration and no document type
    svg = re.sub(r"<[^>]*>", lambda tag: _two_decimals(tag[0]), svg)  # places only: the words keep their numbers
    referenced = re.findall(r'(?:xlink:href="#|url\(#)([\w.-]+)', svg)
    short = {name: f"{key}-{number}" for number, name in enumerate(dict.fromkeys(referenced))}
    svg = re.sub(r' id="([^"]*)"', lambda name: f' id="{short[name[1]]}"' if name[1] in short else "", svg)
    svg = re.sub(r'(xlink:href="#|url\(#)([\w.-]+)', lambda place: place[1] + short[place[2]], svg)
    svg = svg.replace("font-family: 'DejaVu Sans'; ", "").replace("; font-family: 'DejaVu Sans'", "")
    svg = svg.replace("<svg ", f'<svg style="font-family: {FONT_FAMILY}" ', 1)
    svg = re.sub(r"<!--.*?-->|<g\b[^>]*/>", "", svg, flags=re.DOTALL)
    svg = re.sub(r"\s+", " ", svg).replace("> <", "><")  # between the letters of a formula a line end would be a space
    svg = re.sub(r' transform="rotate\(-?0 [^)]*\)"', "", svg)
    svg = re.sub(r'style="[^"]*"', lambda style: re.sub(r"([:;]) ", r"\1", style[0]), svg)
    return re.sub(r"><(g|path|use|defs)\b", r">\n<\1", _without_plain_groups(svg)).strip() + "\n"


def _without_plain_groups(svg: str) -> str:
    """The figure without groups that say nothing: Matplotlib opens one around every tick and line."""
    kept: list[bool] = []
    parts: list[str] = []
    for part in re.split(r"(<g\b[^>]*>|</g>)", svg):
        if part.startswith("<g"):
            kept.append(part != "<g>")
        if not part.startswith(("<g", "</g>")) or (kept.pop() if part == "</g>" else kept[-1]):
            parts.append(part)
    return "".join(parts)


def _two_decimals(tag: str) -> str:
    return re.sub(r"-?\d+\.\d{3,}", lambda number: f"{float(number[0]):.2f}", tag)


def png_bytes(figure: Figure) -> bytes:
    """The figure as PNG for slides and for viewers without SVG."""
    buffer = io.BytesIO()
    figure.set_dpi(PNG_DOTS_PER_INCH)
    canvas: Any = FigureCanvasAgg(figure)
    canvas.print_png(buffer, metadata={"Software": None})
    return buffer.getvalue()
